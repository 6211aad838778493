// "bonds": parallel bonds by name.
#include <math.h>
#include <string.h>

#include "sim/scene_reader.h"

// groups first, then shapes
typedef struct named {
    const dem_scene *scene;
} named;

static const char *group_or_shape(const void *user, size_t index)
{
    const dem_scene *s = ((const named *)user)->scene;
    const dem_bodies_def *b = &s->bodies;
    if (index < b->count)
        return b->bodies[index].group ? b->bodies[index].group : s->shapes[b->bodies[index].shape].name;
    index -= b->count;
    if (index < b->fill_count)
        return b->fills[index].group ? b->fills[index].group : s->shapes[b->fills[index].mix[0].shape].name;
    index -= b->fill_count;
    return index < s->shape_count ? s->shapes[index].name : NULL;
}

static bool is_known(const dem_scene *scene, const char *name)
{
    named n = {scene};
    const char *have;
    for (size_t i = 0; (have = group_or_shape(&n, i)); i++)
        if (strcmp(have, name) == 0)
            return true;
    return false;
}

static dem_status read_between(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    const char **between = into;
    named known = {r->scene};
    const char *all = dem_json_string(v->json);
    if (all && strcmp(all, "all") == 0)
        return DEM_OK;
    DEM_TRY(dem_read_array(r, v, 2, "groups or shapes, as [\"beam\", \"plate\"]; or write \"all\""));
    for (size_t i = 0; i < 2; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(dem_field_text(r, &item, field, &between[i]));
        if (!is_known(r->scene, between[i]))
            return dem_scene_unknown(r, &item, DEM_JSON_VALUE, "group or shape", between[i], group_or_shape, &known);
    }
    return DEM_OK;
}

static const dem_choice contacts[] = {{"parallel", DEM_BOND_PARALLEL}, {"instead", DEM_BOND_INSTEAD}, {NULL, 0}};

#define PURE(name, member, interval)                                                                                   \
    {                                                                                                                  \
        name, dem_field_quantity, .at = offsetof(dem_bond_def, member), .dimension = DEM_DIMENSION_NONE,               \
                                  .range = interval                                                                    \
    }
#define PRESSURE(name, member, must)                                                                                   \
    {                                                                                                                  \
        name, dem_field_quantity, .at = offsetof(dem_bond_def, member), .needed = must,                                \
                                  .dimension = DEM_DIMENSION_PRESSURE, .range = DEM_RANGE_POSITIVE                     \
    }
static const dem_field bond_table[] = {
    {"between", read_between, .at = offsetof(dem_bond_def, between)},
    {"gap", dem_field_quantity, .at = offsetof(dem_bond_def, gap), .dimension = DEM_DIMENSION_LENGTH,
     .range = DEM_RANGE_FROM_0},
    {"at", dem_field_quantity, .at = offsetof(dem_bond_def, at), .dimension = DEM_DIMENSION_TIME,
     .range = DEM_RANGE_FROM_0},
    PURE("radius_multiplier", radius_multiplier, DEM_RANGE_POSITIVE),
    PRESSURE("young", young, true),
    PURE("shear_ratio", shear_ratio, DEM_RANGE_POSITIVE),
    PRESSURE("tensile_strength", tensile_strength, false),
    PRESSURE("shear_strength", shear_strength, false),
    {"moment_contribution", dem_field_quantity, .at = offsetof(dem_bond_def, moment_contribution),
     .dimension = DEM_DIMENSION_NONE, .range = {.high = 1}},
    PURE("damping", damping, DEM_RANGE_FROM_0),
    {"contact", dem_field_choice, .at = offsetof(dem_bond_def, contact), .choices = contacts},
};
const dem_fields dem_bond_fields = DEM_FIELDS(bond_table);

dem_status dem_section_bonds(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    size_t count = 0;
    bool nothing = dem_json_is_array(v->json) && !dem_json_length(v->json);
    if (nothing || dem_json_is_null(v->json))
        return DEM_OK;
    if (!dem_json_is_object(v->json))
        return dem_scene_refuse(r, v, "write { \"NAME\": { ... }, ... }", "needs an object of bonds by name");
    for (const char *name = NULL; (name = dem_json_next(v->json, name));)
        count++;
    dem_bond_def *bonds = dem_scene_take(r, count, sizeof *bonds);
    if (!bonds)
        return dem_fail_memory(r->error);
    r->scene->bonds = bonds;
    for (const char *name = NULL; (name = dem_json_next(v->json, name)); r->scene->bond_count++) {
        dem_scene_value member = dem_scene_member(v, name);
        *bonds = dem_bond_defaults();
        bonds->name = name;
        DEM_TRY(dem_fields_read(r, &member, field->fields, bonds++, NULL));
    }
    return DEM_OK;
}
