// "inlets": where bodies come from while the scene runs.
#include <math.h>

#include "math/vec.h"
#include "sim/scene_wall.h"

static const uint32_t NO_MATERIAL = UINT32_MAX;

// the mix and the box are read as those of a fill
typedef struct inlet_text {
    dem_fill_def fill;
    dem_inlet_def inlet;
    double mass_rate;
} inlet_text;

static const dem_field sphere_table[] = {
    {"centre", dem_field_vector, .at = offsetof(inlet_text, inlet.centre), true, DEM_DIMENSION_LENGTH},
    {"radius", dem_field_quantity, .at = offsetof(inlet_text, inlet.radius), true, DEM_DIMENSION_LENGTH,
     DEM_RANGE_POSITIVE},
    {"solid", dem_field_flag, .at = offsetof(inlet_text, inlet.solid)},
    {"material", dem_field_material, .at = offsetof(inlet_text, inlet.material)},
};
static const dem_fields sphere_fields = DEM_FIELDS(sphere_table);

enum { INLET_BOX, INLET_SPHERE, INLET_RATE, INLET_MASS_RATE, INLET_VELOCITY, INLET_START, INLET_STOP };
static const dem_field inlet_table[] = {
    [INLET_BOX] = {"box", dem_field_corners, .at = offsetof(inlet_text, fill), .dimension = DEM_DIMENSION_LENGTH},
    [INLET_SPHERE] = {"sphere", dem_field_object, .fields = &sphere_fields},
    [INLET_RATE] = {"rate", dem_field_quantity, .at = offsetof(inlet_text, inlet.rate),
                    .dimension = DEM_DIMENSION_RATE, .range = DEM_RANGE_POSITIVE},
    [INLET_MASS_RATE] = {"mass_rate", dem_field_quantity, .at = offsetof(inlet_text, mass_rate),
                         .dimension = DEM_DIMENSION_MASS_RATE, .range = DEM_RANGE_POSITIVE},
    [INLET_VELOCITY] = {"velocity", dem_field_vector, .at = offsetof(inlet_text, inlet.velocity),
                        .dimension = DEM_DIMENSION_VELOCITY},
    [INLET_START] = {"start", dem_field_quantity, .at = offsetof(inlet_text, inlet.start),
                     .dimension = DEM_DIMENSION_TIME, .range = DEM_RANGE_FROM_0},
    [INLET_STOP] = {"stop", dem_field_quantity, .at = offsetof(inlet_text, inlet.stop),
                    .dimension = DEM_DIMENSION_TIME, .range = DEM_RANGE_POSITIVE},
    {"mix", dem_field_mix, .at = offsetof(inlet_text, fill), .needed = true, .fields = &dem_mix_fields},
    {"share_by", dem_field_share_by, .at = offsetof(inlet_text, fill.share_by_mass), .choices = dem_shares_by},
    {"velocity_spread", dem_field_quantity, .at = offsetof(inlet_text, inlet.velocity_spread),
     .dimension = DEM_DIMENSION_VELOCITY, .range = DEM_RANGE_FROM_0},
    {"spin", dem_field_vector, .at = offsetof(inlet_text, inlet.spin), .dimension = DEM_DIMENSION_ANGULAR_VELOCITY},
    {"spin_spread", dem_field_quantity, .at = offsetof(inlet_text, inlet.spin_spread),
     .dimension = DEM_DIMENSION_ANGULAR_VELOCITY, .range = DEM_RANGE_FROM_0},
    {"count", dem_field_whole, .at = offsetof(inlet_text, inlet.count), .range = {.low = 1, .high = 4e9}},
    {"gap", dem_field_quantity, .at = offsetof(inlet_text, inlet.gap), .dimension = DEM_DIMENSION_LENGTH,
     .range = DEM_RANGE_FROM_0},
    {"seed", dem_field_whole, .at = offsetof(inlet_text, inlet.seed)},
};
const dem_fields dem_inlet_fields = DEM_FIELDS(inlet_table);

static dem_status one_of(dem_scene_reader *r, const dem_scene_value *v, bool a, bool b, const char *names)
{
    if (a != b)
        return DEM_OK;
    return dem_scene_refuse(r, v, "give one of them", a ? "has both of %s" : "needs one of %s", names);
}

static dem_status read_inlet(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, const char *name,
                             dem_inlet_def *inlet)
{
    inlet_text text = {.fill.seed = 1, .inlet = {.name = name, .stop = INFINITY, .solid = true, .material = NO_MATERIAL, .seed = 1}};
    uint64_t given;
    DEM_TRY(dem_fields_read(r, v, field->fields, &text, &given));
    bool sphere = dem_given(given, INLET_SPHERE), by_mass = dem_given(given, INLET_MASS_RATE);
    DEM_TRY(one_of(r, v, dem_given(given, INLET_BOX), sphere, "\"box\" and \"sphere\""));
    DEM_TRY(one_of(r, v, dem_given(given, INLET_RATE), by_mass, "\"rate\" and \"mass_rate\""));
    dem_inlet_def *i = &text.inlet;
    if (sphere && !(v3_norm2(i->velocity) > 0))
        return dem_scene_refuse(r, v, "give it a \"velocity\"", "bodies never get out of the sphere");
    if (!(i->start < i->stop))
        return dem_scene_refuse(r, v, "exchange or correct them", "\"start\" must be before \"stop\"");
    i->kind = sphere ? DEM_INLET_SPHERE : DEM_INLET_BOX;
    i->by_mass = by_mass;
    i->rate = by_mass ? text.mass_rate : i->rate;
    i->mix = text.fill.mix;
    i->mix_count = text.fill.mix_count;
    i->share_by_mass = text.fill.share_by_mass;
    i->low = text.fill.low;
    i->high = text.fill.high;
    i->solid = i->solid && sphere;
    if (i->material == NO_MATERIAL)
        i->material = r->scene->shapes[i->mix[0].shape].material;
    *inlet = *i;
    return inlet->solid ? dem_wall_add_generator(r, inlet) : DEM_OK;
}

dem_status dem_section_inlets(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    size_t count = 0;
    // an empty list is nothing, too
    if (dem_json_is_array(v->json) && dem_json_length(v->json) == 0)
        return DEM_OK;
    if (!dem_json_is_object(v->json))
        return dem_scene_refuse(r, v, "write { \"NAME\": { ... }, ... }", "needs an object of inlets by name");
    for (const char *name = NULL; (name = dem_json_next(v->json, name));)
        count++;
    dem_inlet_def *inlets = dem_scene_take(r, count, sizeof *inlets);
    if (!inlets)
        return dem_fail_memory(r->error);
    r->scene->inlets = inlets;
    for (const char *name = NULL; (name = dem_json_next(v->json, name));) {
        dem_scene_value member = dem_scene_member(v, name);
        DEM_TRY(read_inlet(r, &member, field, name, &inlets[r->scene->inlet_count]));
        r->scene->inlet_count++;
    }
    return DEM_OK;
}
