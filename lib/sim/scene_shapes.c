// Shapes: a clump file, a sphere, or spheres written into the scene.
#include <string.h>

#include "clump/union.h"
#include "sim/scene_reader.h"

// what is given of spheres that stand in the scene itself
typedef struct shape_text {
    dem_shape_def *shape;
    dem_ball *balls;
    size_t count;
    double mass, inertia[3];
} shape_text;

// ---- one sphere

typedef struct sphere_text {
    double radius, diameter;
} sphere_text;

enum { SPHERE_RADIUS, SPHERE_DIAMETER };
static const dem_field sphere_table[] = {
    [SPHERE_RADIUS] = {"radius", dem_field_quantity, .at = offsetof(sphere_text, radius),
                       .dimension = DEM_DIMENSION_LENGTH, .range = DEM_RANGE_POSITIVE},
    [SPHERE_DIAMETER] = {"diameter", dem_field_quantity, .at = offsetof(sphere_text, diameter),
                         .dimension = DEM_DIMENSION_LENGTH, .range = DEM_RANGE_POSITIVE},
};
static const dem_fields sphere_fields = DEM_FIELDS(sphere_table);

// `given`: bit 0 the radius, bit 1 the diameter
static dem_status set_radius(dem_scene_reader *r, const dem_scene_value *v, dem_shape_def *shape, uint64_t given,
                             double radius, double diameter)
{
    bool has = dem_given(given, SPHERE_RADIUS);
    if (has == dem_given(given, SPHERE_DIAMETER))
        return dem_scene_refuse(r, v, "give one of them", "%s \"radius\" %s \"diameter\"", has ? "has both" : "needs",
                                has ? "and" : "or");
    shape->sphere_radius = has ? radius : diameter / 2;
    const dem_material *material = &r->scene->materials[shape->material];
    if (isnan(material->density))
        return dem_scene_refuse(r, v, "add it to the material", "needs \"density\" of \"%.60s\"", material->name);
    return shape->sphere_radius > 0 ? DEM_OK : dem_scene_refuse(r, v, "check its unit", "has no size");
}

static dem_status read_sphere(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_shape_def *shape = ((shape_text *)into)->shape;
    sphere_text sphere = {0};
    uint64_t given;
    DEM_TRY(dem_fields_read(r, v, field->fields, &sphere, &given));
    return set_radius(r, v, shape, given, sphere.radius, sphere.diameter);
}

// a disc of two dimensions
typedef struct disc_text {
    double radius, diameter, thickness;
} disc_text;

enum { DISC_RADIUS, DISC_DIAMETER, DISC_THICKNESS };
static const dem_field disc_table[] = {
    [DISC_RADIUS] = {"radius", dem_field_quantity, .at = offsetof(disc_text, radius), .dimension = DEM_DIMENSION_LENGTH,
                     .range = DEM_RANGE_POSITIVE},
    [DISC_DIAMETER] = {"diameter", dem_field_quantity, .at = offsetof(disc_text, diameter),
                       .dimension = DEM_DIMENSION_LENGTH, .range = DEM_RANGE_POSITIVE},
    [DISC_THICKNESS] = {"thickness", dem_field_quantity, .at = offsetof(disc_text, thickness),
                        .dimension = DEM_DIMENSION_LENGTH, .range = DEM_RANGE_POSITIVE},
};
static const dem_fields disc_fields = DEM_FIELDS(disc_table);

static dem_status read_disc(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_shape_def *shape = ((shape_text *)into)->shape;
    disc_text disc = {.thickness = 1};
    uint64_t given;
    DEM_TRY(dem_fields_read(r, v, field->fields, &disc, &given));
    shape->disc_thickness = disc.thickness;
    if (r->scene->dimension != 2)
        return dem_scene_refuse(r, v, "add \"dimension\": 2 to the scene, or write \"sphere\"",
                                "there are no discs in three dimensions");
    return set_radius(r, v, shape, given, disc.radius, disc.diameter);
}

// ---- a clump from a file

static dem_status keep_clump(dem_scene_reader *r, dem_shape_def *shape, dem_clump *clump)
{
    struct dem_scene_owner *o = r->owner;
    if (!dem_grow(&o->clumps, &o->clump_capacity, o->clump_count, sizeof *o->clumps)) {
        dem_clump_destroy(clump);
        return dem_fail_memory(r->error);
    }
    o->clumps[o->clump_count++] = clump;
    shape->clump = clump;
    return DEM_OK;
}

static dem_status read_clump(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_shape_def *shape = ((shape_text *)into)->shape;
    dem_clump *clump;
    DEM_TRY(dem_field_path(r, v, field, &shape->clump_file));
    DEM_TRY(dem_clump_read(shape->clump_file, &clump, r->error));
    return keep_clump(r, shape, clump);
}

// ---- spheres in the scene

static dem_status read_ball(dem_scene_reader *r, const dem_scene_value *v, dem_ball *ball)
{
    double *parts[4] = {&ball->centre.x, &ball->centre.y, &ball->centre.z, &ball->radius};
    DEM_TRY(dem_read_array(r, v, 4, "[x, y, z, r]"));
    for (size_t i = 0; i < 4; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        dem_range range = i == 3 ? (dem_range)DEM_RANGE_POSITIVE : (dem_range){0};
        DEM_TRY(dem_read_quantity(r, &item, DEM_DIMENSION_LENGTH, range, parts[i]));
    }
    return DEM_OK;
}

static dem_status read_balls(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)field;
    shape_text *text = into;
    text->count = dem_json_length(v->json);
    if (!text->count)
        return dem_scene_refuse(r, v, "write [ [x, y, z, r], ... ]", "needs a list of spheres");
    text->balls = dem_scene_take(r, text->count, sizeof *text->balls);
    if (!text->balls)
        return dem_fail_memory(r->error);
    for (size_t i = 0; i < text->count; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(read_ball(r, &item, &text->balls[i]));
    }
    return DEM_OK;
}

static dem_status read_inertia(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    double *inertia = into;
    DEM_TRY(dem_read_array(r, v, 3, "I1 <= I2 <= I3"));
    for (size_t i = 0; i < 3; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(dem_read_quantity(r, &item, field->dimension, field->range, &inertia[i]));
    }
    return DEM_OK;
}

static bool agree(double a, double b, double scale)
{
    return fabs(a - b) <= 1e-9 * scale;
}

// what was written may be the union's own mass, centre and moments, as in a scene that was resolved
static dem_mass_source source_of(const dem_clump_def *def)
{
    bool same = agree(def->mass, def->density * def->union_volume, def->mass);
    for (int i = 0; i < 3; i++)
        same &= agree(def->inertia[i], def->union_inertia[i], def->inertia[2]);
    same &= v3_norm(def->union_centre) <= 1e-9 * cbrt(def->union_volume);
    return same ? DEM_MASS_FROM_UNION : DEM_MASS_GIVEN;
}

// the material's density tells what volume the mass stands for; without one it is that of the union
static dem_status clump_of_mass(const shape_text *text, double density, dem_clump **clump, dem_error *error)
{
    dem_union now;
    DEM_TRY(dem_balls_union(text->balls, text->count, &now, error));
    if (isnan(density))
        density = text->mass / now.solid.volume;
    dem_clump_def def = dem_clump_def_of_balls(text->shape->name, text->balls, text->count, &now, density);
    def.mass = text->mass;
    def.volume = def.mass / def.density;
    for (int i = 0; i < 3; i++)
        def.inertia[i] = text->inertia[i];
    def.mass_from = source_of(&def);
    return dem_clump_create(&def, clump, error);
}

static dem_status make_clump(dem_scene_reader *r, const dem_scene_value *v, shape_text *text, bool mass_given)
{
    const dem_material *material = &r->scene->materials[text->shape->material];
    dem_clump *clump;
    dem_error inner;
    if (!mass_given && isnan(material->density))
        return dem_scene_refuse(r, v, "give \"mass\" and \"inertia\", or the material's density",
                                "needs \"density\" of \"%.60s\"", material->name);
    dem_status status = mass_given ? clump_of_mass(text, material->density, &clump, &inner)
                                   : dem_clump_of_union(text->shape->name, text->balls, text->count, material->density,
                                                        &clump, &inner);
    return status == DEM_OK ? keep_clump(r, text->shape, clump) : dem_scene_pass_on(r, v, &inner);
}

// ---- shapes

static dem_status read_material(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    return dem_field_material(r, v, field, &((shape_text *)into)->shape->material);
}

enum { SHAPE_MATERIAL, SHAPE_CLUMP, SHAPE_SPHERE, SHAPE_DISC, SHAPE_SPHERES, SHAPE_MASS, SHAPE_INERTIA };
static const dem_field shape_table[] = {
    [SHAPE_MATERIAL] = {"material", read_material, .needed = true},
    [SHAPE_CLUMP] = {.name = "clump", .read = read_clump},
    [SHAPE_SPHERE] = {"sphere", read_sphere, .fields = &sphere_fields},
    [SHAPE_DISC] = {"disc", read_disc, .fields = &disc_fields},
    [SHAPE_SPHERES] = {.name = "spheres", .read = read_balls},
    [SHAPE_MASS] = {"mass", dem_field_quantity, .at = offsetof(shape_text, mass), .dimension = DEM_DIMENSION_MASS,
                    .range = DEM_RANGE_POSITIVE},
    [SHAPE_INERTIA] = {"inertia", read_inertia, .at = offsetof(shape_text, inertia), .dimension = DEM_DIMENSION_INERTIA,
                       .range = DEM_RANGE_POSITIVE},
};
const dem_fields dem_shape_fields = DEM_FIELDS(shape_table);

static dem_status read_shape(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field,
                             dem_shape_def *shape)
{
    shape_text text = {.shape = shape};
    uint64_t given;
    DEM_TRY(dem_fields_read(r, v, field->fields, &text, &given));
    int forms = dem_given(given, SHAPE_CLUMP) + dem_given(given, SHAPE_SPHERE) + dem_given(given, SHAPE_DISC) +
                dem_given(given, SHAPE_SPHERES);
    if (forms != 1)
        return dem_scene_refuse(r, v, "give exactly one", "%s \"clump\", \"sphere\", \"disc\" and \"spheres\"",
                                forms ? "has more than one of" : "needs one of");
    bool mass = dem_given(given, SHAPE_MASS), inertia = dem_given(given, SHAPE_INERTIA);
    if ((mass || inertia) && !dem_given(given, SHAPE_SPHERES))
        return dem_scene_refuse(r, v, "leave it out", "only \"spheres\" take \"%s\"", mass ? "mass" : "inertia");
    if (mass != inertia)
        return dem_scene_refuse(r, v, "give both, or none to have them from the spheres",
                                "has \"mass\" or \"inertia\" without the other");
    return dem_given(given, SHAPE_SPHERES) ? make_clump(r, v, &text, mass) : DEM_OK;
}

dem_status dem_section_shapes(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    size_t count = 0;
    if (!dem_json_is_object(v->json))
        return dem_scene_refuse(r, v, "write { \"NAME\": { ... }, ... }", "needs an object of shapes by name");
    for (const char *name = NULL; (name = dem_json_next(v->json, name));)
        count++;
    dem_shape_def *shapes = dem_scene_take(r, count, sizeof *shapes);
    if (!shapes)
        return dem_fail_memory(r->error);
    r->scene->shapes = shapes;
    for (const char *name = NULL; (name = dem_json_next(v->json, name)); r->scene->shape_count++) {
        dem_scene_value member = dem_scene_member(v, name);
        *shapes = (dem_shape_def){.name = name};
        DEM_TRY(read_shape(r, &member, field, shapes++));
    }
    return DEM_OK;
}
