// "walls": planes, boxes of six planes, cylinders, meshes, and how they move.
#include <stdio.h>
#include <string.h>

#include "sim/scene_wall.h"

// ---- forms

static dem_status read_two_lengths(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    DEM_TRY(dem_read_array(r, v, 2, "two lengths"));
    for (size_t i = 0; i < 2; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(dem_read_quantity(r, &item, field->dimension, field->range, (double *)into + i));
    }
    return DEM_OK;
}

// a plane without an end, or, with a radius or two sides, one that has some
static dem_status read_plane(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    dem_wall_def *w = &text->wall;
    DEM_TRY(dem_fields_read(r, v, field->fields, text, NULL));
    bool disc = w->radius > 0, rectangle = w->size[0] > 0, along = v3_norm2(w->along) > 0;
    if (disc && rectangle)
        return dem_scene_refuse(r, v, "leave one out", "has both \"radius\", of a disc, and \"size\", of a rectangle");
    if (along && !rectangle)
        return dem_scene_refuse(r, v, "add \"size\" or leave it out", "\"along\" is of a rectangle's first side");
    if (along && !(v3_norm(v3_cross(w->along, w->normal)) > 1e-6))
        return dem_scene_refuse(r, v, "take one along the plane", "\"along\" is the direction of the normal");
    if (rectangle && !along)
        w->along = v3_normal_to(w->normal);
    w->kind = disc ? DEM_WALL_DISC : rectangle ? DEM_WALL_RECTANGLE : DEM_WALL_PLANE;
    return DEM_OK;
}

static const dem_field plane_table[] = {
    {"point", dem_field_vector, .at = offsetof(wall_text, wall.point), true, DEM_DIMENSION_LENGTH},
    {"normal", dem_field_direction, .at = offsetof(wall_text, wall.normal), true, DEM_DIMENSION_NONE},
    {"radius", dem_field_quantity, .at = offsetof(wall_text, wall.radius), .dimension = DEM_DIMENSION_LENGTH,
     .range = DEM_RANGE_POSITIVE},
    {"size", read_two_lengths, .at = offsetof(wall_text, wall.size), .dimension = DEM_DIMENSION_LENGTH,
     .range = DEM_RANGE_POSITIVE},
    {"along", dem_field_direction, .at = offsetof(wall_text, wall.along), .dimension = DEM_DIMENSION_NONE},
};
static const dem_fields plane_fields = DEM_FIELDS(plane_table);

static const dem_field box_table[] = {
    {"min", dem_field_vector, .at = offsetof(wall_text, low), true, DEM_DIMENSION_LENGTH},
    {"max", dem_field_vector, .at = offsetof(wall_text, high), true, DEM_DIMENSION_LENGTH},
};
static const dem_fields box_fields = DEM_FIELDS(box_table);

static dem_status read_box(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    DEM_TRY(dem_fields_read(r, v, field->fields, text, NULL));
    for (int i = 0; i < 3; i++)
        if (!(v3_get(text->low, i) < v3_get(text->high, i)))
            return dem_scene_refuse(r, v, "exchange or correct them", "min must be below max along %c", "xyz"[i]);
    return DEM_OK;
}

static const dem_choice sides[] = {{"inside", false}, {"outside", true}, {NULL, 0}};

static dem_status read_side(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    int side;
    DEM_TRY(dem_field_choice(r, v, field, &side));
    *(bool *)into = side;
    return DEM_OK;
}

static const dem_field cylinder_table[] = {
    {"point", dem_field_vector, .at = offsetof(wall_text, wall.point), true, DEM_DIMENSION_LENGTH},
    {"axis", dem_field_direction, .at = offsetof(wall_text, wall.normal), true, DEM_DIMENSION_NONE},
    {"radius", dem_field_quantity, .at = offsetof(wall_text, wall.radius), true, DEM_DIMENSION_LENGTH,
     DEM_RANGE_POSITIVE},
    {"side", read_side, .at = offsetof(wall_text, wall.outside), .choices = sides},
};
static const dem_fields cylinder_fields = DEM_FIELDS(cylinder_table);

// ---- cones and spheres

enum { CONE_APEX, CONE_ANGLE, CONE_SIDE, CONE_POINT, CONE_RADII, CONE_LENGTH, CONE_AXIS };
static const dem_field cone_table[] = {
    [CONE_APEX] = {"apex", dem_field_vector, .at = offsetof(wall_text, wall.point), .dimension = DEM_DIMENSION_LENGTH},
    [CONE_ANGLE] = {"angle", dem_field_quantity, .at = offsetof(wall_text, wall.angle),
                    .dimension = DEM_DIMENSION_ANGLE, .range = {.high = DEM_PI / 2, .above = true, .below = true}},
    [CONE_SIDE] = {"side", read_side, .at = offsetof(wall_text, wall.outside), .choices = sides},
    [CONE_POINT] = {"point", dem_field_vector, .at = offsetof(wall_text, wall.point), .dimension = DEM_DIMENSION_LENGTH},
    [CONE_RADII] = {"radii", read_two_lengths, .at = offsetof(wall_text, radii), .dimension = DEM_DIMENSION_LENGTH,
                    .range = DEM_RANGE_FROM_0},
    [CONE_LENGTH] = {"length", dem_field_quantity, .at = offsetof(wall_text, wall.length),
                     .dimension = DEM_DIMENSION_LENGTH, .range = DEM_RANGE_FROM_0},
    [CONE_AXIS] = {"axis", dem_field_direction, .at = offsetof(wall_text, wall.normal), true, DEM_DIMENSION_NONE},
};
static const dem_fields cone_fields = DEM_FIELDS(cone_table);

// from its tip on without an end, or between two circles
static dem_status read_cone(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    dem_wall_def *w = &text->wall;
    uint64_t given;
    DEM_TRY(dem_fields_read(r, v, field->fields, text, &given));
    const uint64_t endless = 1u << CONE_APEX | 1u << CONE_ANGLE, ends = 1u << CONE_POINT | 1u << CONE_RADII | 1u << CONE_LENGTH;
    bool first = (given & endless) == endless && !(given & ends), second = (given & ends) == ends && !(given & endless);
    if (!first && !second)
        return dem_scene_refuse(r, v, "give exactly these",
                                "needs \"apex\" and \"angle\", or \"point\", \"radii\" and \"length\"");
    if (second && dem_given(given, CONE_SIDE))
        return dem_scene_refuse(r, v, "leave it out", "a cone with ends is solid on both sides; it has no \"side\"");
    w->kind = DEM_WALL_CONE;
    if (first) {
        w->length = INFINITY;
        return DEM_OK;
    }
    w->radius = text->radii[0];
    w->end_radius = text->radii[1];
    bool point = !(w->length > 0) && w->radius == w->end_radius, line = !(w->radius > 0 || w->end_radius > 0);
    if (point || line)
        return dem_scene_refuse(r, v, "give a radius or a length that is not 0", "has no surface");
    return DEM_OK;
}

static const dem_field sphere_table[] = {
    {"centre", dem_field_vector, .at = offsetof(wall_text, wall.point), true, DEM_DIMENSION_LENGTH},
    {"radius", dem_field_quantity, .at = offsetof(wall_text, wall.radius), true, DEM_DIMENSION_LENGTH,
     DEM_RANGE_POSITIVE},
    {"side", read_side, .at = offsetof(wall_text, wall.outside), .choices = sides},
};
static const dem_fields sphere_fields = DEM_FIELDS(sphere_table);

static dem_status read_sphere(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    text->wall.kind = DEM_WALL_SPHERE;
    text->wall.normal = v3(0, 0, 1);
    return dem_fields_read(r, v, field->fields, text, NULL);
}

// ---- walls

static dem_status read_unit(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    const char **unit = into;
    dem_error inner;
    double factor;
    DEM_TRY(dem_field_text(r, v, field, unit));
    if (dem_unit(*unit, DEM_DIMENSION_LENGTH, &factor, &inner) != DEM_OK)
        return dem_scene_pass_on(r, v, &inner);
    return DEM_OK;
}

enum { WALL_MATERIAL, WALL_PLANE, WALL_BOX, WALL_CYLINDER, WALL_CONE, WALL_SPHERE, WALL_MESH, WALL_UNIT, WALL_MOTION, WALL_SERVO, WALL_WEAR };
static const dem_field wall_table[] = {
    [WALL_MATERIAL] = {"material", dem_field_material, .at = offsetof(wall_text, wall.material), true},
    [WALL_PLANE] = {"plane", read_plane, .fields = &plane_fields},
    [WALL_BOX] = {"box", read_box, .fields = &box_fields},
    [WALL_CYLINDER] = {"cylinder", dem_field_object, .fields = &cylinder_fields},
    [WALL_CONE] = {"cone", read_cone, .fields = &cone_fields},
    [WALL_SPHERE] = {"sphere", read_sphere, .fields = &sphere_fields},
    [WALL_MESH] = {"mesh", dem_field_path, .at = offsetof(wall_text, wall.mesh_file)},
    [WALL_UNIT] = {"unit", read_unit, .at = offsetof(wall_text, source.unit)},
    [WALL_MOTION] = {"motion", dem_wall_read_motion, .fields = &dem_wall_motion_fields},
    [WALL_SERVO] = {"servo", dem_wall_read_servo, .fields = &dem_wall_servo_fields},
    [WALL_WEAR] = {"wear", dem_wall_read_wear, .fields = &dem_wall_wear_fields},
};
const dem_fields dem_wall_fields = DEM_FIELDS(wall_table);

static dem_status keep_wall(dem_scene_reader *r, const dem_wall_def *wall, dem_wall_source source)
{
    struct dem_scene_owner *o = r->owner;
    if (!dem_grow(&o->walls, &o->wall_capacity, o->wall_count, sizeof *o->walls) ||
        !dem_grow(&o->wall_sources, &o->source_capacity, o->wall_count, sizeof *o->wall_sources))
        return dem_fail_memory(r->error);
    o->wall_sources[o->wall_count] = source;
    o->walls[o->wall_count++] = *wall;
    r->scene->walls = o->walls;
    r->scene->wall_count = o->wall_count;
    return DEM_OK;
}

static dem_status add_wall(dem_scene_reader *r, const dem_scene_value *v, const dem_wall_def *wall,
                           dem_wall_source source)
{
    for (size_t i = 0; i < r->owner->wall_count; i++)
        if (strcmp(r->owner->walls[i].name, wall->name) == 0)
            return dem_scene_refuse(r, v, "rename one", "there is a wall \"%.60s\" already, as a side of a box",
                                    wall->name);
    return keep_wall(r, wall, source);
}

dem_status dem_wall_add_generator(dem_scene_reader *r, const dem_inlet_def *inlet)
{
    dem_wall_def wall = {.name = inlet->name,
                         .kind = DEM_WALL_SPHERE,
                         .material = inlet->material,
                         .point = inlet->centre,
                         .normal = {0, 0, 1},
                         .radius = inlet->radius,
                         .outside = true,
                         .generator = true};
    return keep_wall(r, &wall, (dem_wall_source){.axis = {0, 0, 1}});
}

// x-, x+, y-, ... with normals into the box
static dem_status add_box(dem_scene_reader *r, const dem_scene_value *v, const wall_text *text)
{
    size_t first = r->owner->wall_count;
    for (int i = 0; i < 6; i++) {
        dem_wall_def side = text->wall;
        size_t size = strlen(text->wall.name) + 4;
        char *name = dem_scene_take(r, size, 1);
        if (!name)
            return dem_fail_memory(r->error);
        snprintf(name, size, "%s.%c%c", text->wall.name, "xyz"[i / 2], "-+"[i % 2]);
        side.name = name;
        side.kind = DEM_WALL_PLANE;
        side.point = i % 2 ? text->high : text->low;
        v3_set(&side.normal, i / 2, i % 2 ? -1 : 1);
        dem_wall_servo_of_side(&side, text, i, (uint32_t)first);
        DEM_TRY(add_wall(r, v, &side, text->source));
    }
    return DEM_OK;
}

static dem_status add_mesh(dem_scene_reader *r, const dem_scene_value *v, wall_text *text)
{
    dem_mesh mesh;
    double unit = 1;
    if (!text->source.unit)
        text->source.unit = "m";
    DEM_TRY(dem_unit(text->source.unit, DEM_DIMENSION_LENGTH, &unit, r->error));
    DEM_TRY(dem_mesh_read(r->ctx, text->wall.mesh_file, &mesh, r->error));
    if (unit != 1)
        dem_mesh_scale(&mesh, unit);
    text->wall.kind = DEM_WALL_MESH;
    text->wall.mesh = mesh;
    dem_status status = add_wall(r, v, &text->wall, text->source);
    if (status != DEM_OK)
        dem_mesh_free(&mesh);
    return status;
}

static dem_status read_wall(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, const char *name)
{
    wall_text text = {.wall.name = name, .source.axis = {0, 0, 1}};
    uint64_t given;
    DEM_TRY(dem_fields_read(r, v, field->fields, &text, &given));
    int forms = 0;
    for (int i = WALL_PLANE; i <= WALL_MESH; i++)
        forms += dem_given(given, i);
    if (forms != 1)
        return dem_scene_refuse(r, v, "give exactly one", "%s \"plane\", \"box\", \"cylinder\", \"cone\", \"sphere\" and \"mesh\"",
                                forms ? "has more than one of" : "needs one of");
    if (dem_given(given, WALL_UNIT) && !dem_given(given, WALL_MESH))
        return dem_scene_refuse(r, v, "leave it out", "\"unit\" is the unit of a mesh file");
    text.wall.spin = v3_scale(text.source.axis, text.source.rate);
    if (text.wall.servo.on) {
        dem_scene_value servo = dem_scene_member(v, "servo");
        DEM_TRY(dem_wall_check_servo(r, &servo, &text, dem_given(given, WALL_BOX), dem_given(given, WALL_PLANE)));
    }
    bool endless = text.wall.kind == DEM_WALL_PLANE && !dem_given(given, WALL_MESH);
    if (text.wall.wear.law != DEM_WEAR_NONE && (endless || dem_given(given, WALL_CYLINDER)))
        return dem_scene_refuse(r, v, "take a mesh, or a plane with \"size\" or \"radius\", a cone or a sphere",
                                "\"wear\" needs a wall with ends");
    if (dem_given(given, WALL_BOX))
        return add_box(r, v, &text);
    if (dem_given(given, WALL_MESH))
        return add_mesh(r, v, &text);
    if (dem_given(given, WALL_CYLINDER))
        text.wall.kind = DEM_WALL_CYLINDER;
    return add_wall(r, v, &text.wall, text.source);
}

dem_status dem_section_walls(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    if (!dem_json_is_object(v->json))
        return dem_scene_refuse(r, v, "write { \"NAME\": { ... }, ... }", "needs an object of walls by name");
    for (const char *name = NULL; (name = dem_json_next(v->json, name));) {
        dem_scene_value member = dem_scene_member(v, name);
        DEM_TRY(read_wall(r, &member, field, name));
    }
    return dem_wall_find_names(r, v);
}
