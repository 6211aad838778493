// The outermost object of a scene file and its sections of plain values.
#include <string.h>

#include "math/vec.h"
#include "sim/scene_reader.h"
#include "sim/schemes.h"

#define SCHEMA "dem-scene/"
#define VERSION "1"

// ---- time

// 0: auto
static dem_status read_or_auto(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    double *value = into;
    const char *text = dem_json_string(v->json);
    *value = 0;
    if (text && strcmp(text, "auto") == 0)
        return DEM_OK;
    return dem_field_quantity(r, v, field, into);
}

static const dem_field time_table[] = {
    {"end", dem_field_quantity, .at = offsetof(dem_time_def, end), .dimension = DEM_DIMENSION_TIME,
     .range = DEM_RANGE_FROM_0},
    {"step", read_or_auto, .at = offsetof(dem_time_def, step), .dimension = DEM_DIMENSION_TIME,
     .range = DEM_RANGE_POSITIVE},
    {"safety", dem_field_quantity, .at = offsetof(dem_time_def, safety), .dimension = DEM_DIMENSION_NONE,
     .range = {.high = 1, .above = true}},
    {"contact_steps", dem_field_quantity, .at = offsetof(dem_time_def, contact_steps), .dimension = DEM_DIMENSION_NONE,
     .range = DEM_RANGE_FROM_0},
};
static const dem_fields time_fields = DEM_FIELDS(time_table);

// ---- domain

// null is a side that is open
static dem_status read_corner(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_vec3 *corner = into;
    DEM_TRY(dem_read_array(r, v, 3, "[x, y, z]"));
    for (int i = 0; i < 3; i++) {
        dem_scene_value item = dem_scene_item(v, (size_t)i);
        double value;
        if (dem_json_is_null(item.json))
            continue;
        DEM_TRY(dem_read_quantity(r, &item, field->dimension, field->range, &value));
        v3_set(corner, i, value);
    }
    return DEM_OK;
}

static dem_status read_periodic(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    bool *periodic = into;
    DEM_TRY(dem_read_array(r, v, 3, "true or false for x, y, z"));
    for (size_t i = 0; i < 3; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(dem_field_flag(r, &item, field, &periodic[i]));
    }
    return DEM_OK;
}

static const dem_choice leavings[] = {{"error", DEM_LEAVING_ERROR},
                                      {"ignore", DEM_LEAVING_IGNORE},
                                      {"delete", DEM_LEAVING_DELETE},
                                      {"report", DEM_NOT_BUILT},
                                      {NULL, 0}};

static const dem_field domain_table[] = {
    {"min", read_corner, .at = offsetof(dem_domain_def, low), .dimension = DEM_DIMENSION_LENGTH},
    {"max", read_corner, .at = offsetof(dem_domain_def, high), .dimension = DEM_DIMENSION_LENGTH},
    {"periodic", read_periodic, .at = offsetof(dem_domain_def, periodic)},
    {"leaving", dem_field_choice, .at = offsetof(dem_domain_def, leaving), .choices = leavings},
};
static const dem_fields domain_fields = DEM_FIELDS(domain_table);

static dem_status read_domain(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_domain_def *domain = into;
    DEM_TRY(dem_fields_read(r, v, field->fields, domain, NULL));
    for (int i = 0; i < 3; i++) {
        double low = v3_get(domain->low, i), high = v3_get(domain->high, i);
        if (!(low < high))
            return dem_scene_refuse(r, v, "exchange or correct them", "min must be below max along %c", "xyz"[i]);
        if (domain->periodic[i] && !isfinite(high - low))
            return dem_scene_refuse(r, v, "give both", "min and max are needed along %c, which is periodic", "xyz"[i]);
    }
    return DEM_OK;
}

// ---- damping, integrator, sums of contacts

static const dem_choice local_frames[] = {{"space", DEM_LOCAL_SPACE}, {"vector", DEM_LOCAL_VECTOR}, {NULL, 0}};

static const dem_field drag_table[] = {
    {"density", dem_field_quantity, .at = offsetof(dem_drag_def, density), .needed = true,
     .dimension = DEM_DIMENSION_DENSITY, .range = DEM_RANGE_FROM_0},
    {"viscosity", dem_field_quantity, .at = offsetof(dem_drag_def, viscosity), .needed = true,
     .dimension = DEM_DIMENSION_VISCOSITY, .range = DEM_RANGE_FROM_0},
    {"velocity", dem_field_vector, .at = offsetof(dem_drag_def, velocity), .dimension = DEM_DIMENSION_VELOCITY},
    {"buoyancy", dem_field_flag, .at = offsetof(dem_drag_def, buoyancy)},
};
static const dem_fields drag_fields = DEM_FIELDS(drag_table);

static dem_status read_drag(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    return dem_json_is_null(v->json) ? DEM_OK : dem_field_object(r, v, field, into);
}

static const dem_field damping_table[] = {
    {"local", dem_field_quantity, .at = offsetof(dem_damping_def, local), .dimension = DEM_DIMENSION_NONE,
     .range = {.high = 1, .below = true}},
    {"local_frame", dem_field_choice, .at = offsetof(dem_damping_def, local_frame), .choices = local_frames},
    {"exclude_gravity", dem_field_flag, .at = offsetof(dem_damping_def, exclude_gravity)},
    {"viscous", dem_field_quantity, .at = offsetof(dem_damping_def, viscous), .dimension = DEM_DIMENSION_RATE,
     .range = DEM_RANGE_FROM_0},
    {"drag", read_drag, .at = offsetof(dem_damping_def, drag), .fields = &drag_fields},
};
static const dem_fields damping_fields = DEM_FIELDS(damping_table);

#define CHOICE_OF_TRANSLATION(id, name, half, number, about) {name, DEM_TRANSLATION_##id},
static const dem_choice translations[] = {DEM_TRANSLATIONS(CHOICE_OF_TRANSLATION){NULL, 0}};
#define CHOICE_OF_ROTATION(id, name, half, number, about) {name, DEM_ROTATION_##id},
static const dem_choice rotations[] = {DEM_ROTATIONS(CHOICE_OF_ROTATION){NULL, 0}};

static const dem_field integrator_table[] = {
    {"translation", dem_field_choice, .at = offsetof(dem_integrator_def, translation), .choices = translations},
    {"rotation", dem_field_choice, .at = offsetof(dem_integrator_def, rotation), .choices = rotations},
};
static const dem_fields integrator_fields = DEM_FIELDS(integrator_table);

static const dem_choice multiples[] = {{"sum", DEM_MULTIPLE_SUM},
                                       {"mean", DEM_MULTIPLE_MEAN},
                                       {"merge", DEM_MULTIPLE_MERGE},
                                       {"soft", DEM_MULTIPLE_SOFT},
                                       {NULL, 0}};

static const dem_field soft_table[] = {
    {"tau", read_or_auto, .at = offsetof(dem_soft_def, tau), .dimension = DEM_DIMENSION_LENGTH,
     .range = DEM_RANGE_POSITIVE},
};
static const dem_fields soft_fields = DEM_FIELDS(soft_table);

// ---- output

static dem_status read_directory(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    const char **directory = into;
    DEM_TRY(dem_field_text(r, v, field, directory));
    if (!**directory)
        return dem_scene_refuse(r, v, "name a folder", "is empty");
    return DEM_OK;
}

// "60 s wall" is by the clock on the wall
static dem_status read_checkpoint(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_output_def *output = into;
    const char *text = dem_json_string(v->json);
    size_t length = text ? strlen(text) : 0;
    char quantity[64];
    output->checkpoint_wall = length > 5 && length < sizeof quantity && strcmp(text + length - 5, " wall") == 0;
    if (!output->checkpoint_wall)
        return dem_field_quantity(r, v, field, &output->checkpoint);
    memcpy(quantity, text, length - 5);
    quantity[length - 5] = 0;
    dem_error inner;
    if (dem_quantity(quantity, field->dimension, &output->checkpoint, &inner) != DEM_OK)
        return dem_scene_pass_on(r, v, &inner);
    if (!(output->checkpoint > 0 && output->checkpoint < 1e100))
        return dem_scene_refuse(r, v, "give the time between two, as in \"60 s wall\"", "must be above 0");
    return DEM_OK;
}

static const dem_field output_table[] = {
    {"directory", read_directory, .at = offsetof(dem_output_def, directory)},
    {"frames", dem_field_quantity, .at = offsetof(dem_output_def, frames), .dimension = DEM_DIMENSION_TIME,
     .range = DEM_RANGE_FROM_0},
    {"series", dem_field_quantity, .at = offsetof(dem_output_def, series), .dimension = DEM_DIMENSION_TIME,
     .range = DEM_RANGE_FROM_0},
    {"contacts", dem_field_quantity, .at = offsetof(dem_output_def, contacts), .dimension = DEM_DIMENSION_TIME,
     .range = DEM_RANGE_FROM_0},
    {"checkpoint", read_checkpoint, .dimension = DEM_DIMENSION_TIME, .range = DEM_RANGE_FROM_0},
    {"energy", dem_field_flag, .at = offsetof(dem_output_def, energy)},
};
static const dem_fields output_fields = DEM_FIELDS(output_table);

// ---- the whole

static dem_status read_schema(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    const char *schema;
    DEM_TRY(dem_field_text(r, v, field, &schema));
    if (strcmp(schema, SCHEMA VERSION) == 0)
        return DEM_OK;
    if (strncmp(schema, SCHEMA, strlen(SCHEMA)) == 0)
        return dem_scene_refuse(r, v, "use a newer program", "\"%.40s\" is not known, only " SCHEMA VERSION " is",
                                schema);
    return dem_scene_refuse(r, v, "a scene file says \"" SCHEMA VERSION "\"", "\"%.40s\" is no scene", schema);
}

// for editors that know JSON Schema
static dem_status ignore_text(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    const char *text;
    return dem_field_text(r, v, field, &text);
}

static dem_status read_dimension(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    uint64_t dimension = 0;
    dem_field whole = *field;
    whole.range = (dem_range){.low = 2, .high = 3};
    DEM_TRY(dem_field_whole(r, v, &whole, &dimension));
    *(unsigned *)into = (unsigned)dimension;
    return DEM_OK;
}

static const dem_field scene_table[] = {
    {"schema", read_schema, .needed = true},
    {.name = "$schema", .read = ignore_text},
    {"title", dem_field_text, .at = offsetof(dem_scene, title)},
    {"dimension", read_dimension, .at = offsetof(dem_scene, dimension)},
    {"gravity", dem_field_vector, .at = offsetof(dem_scene, gravity), .dimension = DEM_DIMENSION_ACCELERATION},
    {"time", dem_field_object, .at = offsetof(dem_scene, time), .fields = &time_fields},
    {"domain", read_domain, .at = offsetof(dem_scene, domain), .fields = &domain_fields},
    {"materials", dem_section_materials, .fields = &dem_material_fields},
    {"contacts", dem_section_contacts, .fields = &dem_contact_fields},
    {"shapes", dem_section_shapes, .fields = &dem_shape_fields},
    {"bodies", dem_section_bodies, .fields = &dem_body_fields},
    {"walls", dem_section_walls, .fields = &dem_wall_fields},
    {"inlets", dem_section_inlets, .fields = &dem_inlet_fields},
    {"bonds", dem_section_bonds, .fields = &dem_bond_fields},
    {"damping", dem_field_object, .at = offsetof(dem_scene, damping), .fields = &damping_fields},
    {"integrator", dem_field_object, .at = offsetof(dem_scene, integrator), .fields = &integrator_fields},
    {"contacts_between_clumps", dem_field_choice, .at = offsetof(dem_scene, multiple), .choices = multiples},
    {"soft", dem_field_object, .at = offsetof(dem_scene, soft), .fields = &soft_fields},
    {"measures", dem_section_measures, .fields = &dem_measure_fields},
    {"output", dem_field_object, .at = offsetof(dem_scene, output), .fields = &output_fields},
};
const dem_fields dem_scene_fields = DEM_FIELDS(scene_table);

static bool has_law(const dem_scene *scene, uint32_t a, uint32_t b)
{
    for (size_t i = 0; i < scene->law_count; i++) {
        const uint32_t *m = scene->laws[i].materials;
        if ((m[0] == a && m[1] == b) || (m[0] == b && m[1] == a))
            return true;
    }
    return false;
}

// the place of what is missing: "contacts" if it is there
static dem_status check_laws(dem_scene_reader *r, const dem_scene_value *root)
{
    const dem_scene *scene = r->scene;
    dem_scene_value contacts = dem_scene_member(root, "contacts");
    for (uint32_t a = 0; a < scene->material_count; a++)
        for (uint32_t b = a; b < scene->material_count; b++)
            if (dem_scene_can_meet(scene, a, b) && !has_law(scene, a, b))
                return dem_scene_refuse(r, contacts.json ? &contacts : root, "add an entry for the two to contacts",
                                        "there is no law between \"%.60s\" and \"%.60s\", which can meet",
                                        scene->materials[a].name, scene->materials[b].name);
    return DEM_OK;
}

// soft contacts have no surfaces that hold on to each other
static dem_status check_soft(dem_scene_reader *r, const dem_scene_value *root)
{
    const dem_scene *scene = r->scene;
    dem_scene_value choice = dem_scene_member(root, "contacts_between_clumps"), soft = dem_scene_member(root, "soft");
    if (scene->multiple != DEM_MULTIPLE_SOFT && soft.json)
        return dem_scene_refuse(r, &soft, "set it, or leave this out",
                                "is of contacts_between_clumps \"soft\", which is not set");
    for (size_t i = 0; scene->multiple == DEM_MULTIPLE_SOFT && i < scene->law_count; i++) {
        const dem_pair_law *law = &scene->laws[i];
        const char *what = law->normal == DEM_NORMAL_JKR || law->normal == DEM_NORMAL_DMT ? "adhesion"
                           : law->cohesion != DEM_COHESION_NONE                           ? "cohesion"
                                                                                          : NULL;
        if (what)
            return dem_scene_refuse(r, &choice, "take \"sum\", or leave that out",
                                    "is \"soft\", which does not go with the %s of contacts %zu", what, i);
    }
    return DEM_OK;
}

dem_status dem_scene_finish(dem_scene_reader *r, const dem_scene_value *root)
{
    dem_scene *scene = r->scene;
    DEM_TRY(check_laws(r, root));
    DEM_TRY(check_soft(r, root));
    DEM_TRY(dem_scene_check_measures(r, root));
    scene->time.safety = dem_scene_safety(scene);
    return DEM_OK;  // the output's directory is left alone: results go to where one works, not to where scenes are kept
}
