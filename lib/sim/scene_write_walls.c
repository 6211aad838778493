// The walls of a scene as a file, see scene_write.c.
#include <math.h>
#include <string.h>

#include "math/vec.h"
#include "sim/scene_writer.h"
#include "sim/wall_motion.h"

// how the wall was given; one made by hand turns about its spin, and its mesh file is in metres
static dem_wall_source source_of(const dem_scene *scene, size_t index)
{
    const dem_wall_def *wall = &scene->walls[index];
    const struct dem_scene_owner *o = scene->owner;
    if (o && index < o->wall_count && scene->walls == o->walls) {
        dem_wall_source source = o->wall_sources[index];
        dem_vec3 spin = v3_scale(source.axis, source.rate);
        if (spin.x == wall->spin.x && spin.y == wall->spin.y && spin.z == wall->spin.z)
            return source;
    }
    return (dem_wall_source){.unit = "m", .axis = v3_unit(wall->spin), .rate = v3_norm(wall->spin)};
}

static void put_axis(dem_json_writer *w, const dem_wall_def *wall)
{
    dem_wall_motion motion = dem_wall_motion_of(wall);
    put_vec(w, "axis", motion.axis);
    put_vec(w, "through", wall->through);
}

static void put_oscillations(dem_json_writer *w, const dem_wall_def *wall)
{
    dem_json_open_array(w, "oscillate", true);
    for (size_t i = 0; i < wall->oscillation_count; i++) {
        const dem_oscillation *o = &wall->oscillations[i];
        dem_json_open_object(w, NULL);
        put_vec(w, "amplitude", o->shift);
        if (!(v3_norm2(o->shift) > 0))
            put_vec(w, "direction", v3(0, 0, 1));
        if (o->turn != 0) {
            dem_json_put_number(w, "angle", o->turn);
            put_axis(w, wall);
        }
        dem_json_put_number(w, "frequency", o->frequency);
        dem_json_put_number(w, "phase", o->phase);
        dem_json_close(w, '}');
    }
    dem_json_close(w, ']');
}

static void put_table_of_motion(dem_json_writer *w, const dem_wall_def *wall)
{
    dem_json_open_object(w, "table");
    dem_json_put_string(w, "file", wall->table.file);
    dem_json_put_string(w, "interpolation", wall->table.cubic ? "cubic" : "linear");
    if (wall->table.turn)
        put_axis(w, wall);
    dem_json_close(w, '}');
}

static void put_motion(dem_json_writer *w, const dem_wall_def *wall, const dem_wall_source *source)
{
    dem_json_open_object(w, "motion");
    dem_json_open_object(w, "translate");
    put_vec(w, "velocity", wall->velocity);
    dem_json_close(w, '}');
    dem_json_open_object(w, "rotate");
    put_vec(w, "axis", source->axis);
    put_vec(w, "through", wall->through);
    dem_json_put_number(w, "rate", source->rate);
    dem_json_close(w, '}');
    if (wall->oscillation_count)
        put_oscillations(w, wall);
    if (wall->table.count)
        put_table_of_motion(w, wall);
    dem_json_put_number(w, "start", wall->start);
    if (wall->stop > 0)
        dem_json_put_number(w, "stop", wall->stop);
    dem_json_close(w, '}');
}

static void put_extents(dem_json_writer *w, const dem_scene *scene, const dem_servo_def *servo)
{
    bool some = false;
    for (int k = 0; k < 2; k++)
        some |= servo->extent[k].length > 0 || servo->extent[k].walls[0] != servo->extent[k].walls[1];
    if (!some)
        return;
    dem_json_open_array(w, "extents", false);
    for (int k = 0; k < 2; k++) {
        const dem_servo_extent *e = &servo->extent[k];
        if (e->length > 0) {
            dem_json_put_number(w, NULL, e->length);
            continue;
        }
        dem_json_open_array(w, NULL, false);
        for (int i = 0; i < 2; i++)
            dem_json_put_string(w, NULL, text_of(scene->walls[e->walls[i]].name));
        dem_json_close(w, ']');
    }
    dem_json_close(w, ']');
}

static void put_servo(dem_json_writer *w, const dem_scene *scene, const dem_servo_def *servo)
{
    dem_json_open_object(w, "servo");
    dem_json_put_number(w, servo->stress ? "stress" : "force", servo->target);
    put_vec(w, "direction", servo->direction);
    if (servo->area > 0)
        dem_json_put_number(w, "area", servo->area);
    put_extents(w, scene, servo);
    dem_json_put_number(w, "gain", servo->gain);
    dem_json_put_number(w, "max_velocity", servo->max_velocity);
    dem_json_put_number(w, "mass", servo->mass);
    if (servo->mass > 0)
        dem_json_put_number(w, "damping_rate", servo->damping_rate);
    if (servo->partner)
        dem_json_put_string(w, "partner", text_of(scene->walls[servo->partner - 1].name));
    dem_json_close(w, '}');
}

static void put_wear(dem_json_writer *w, const dem_wear_def *wear)
{
    bool finnie = wear->law == DEM_WEAR_FINNIE;
    dem_json_open_object(w, "wear");
    dem_json_put_string(w, "law", finnie ? "finnie" : "archard");
    if (finnie) {
        dem_json_put_number(w, "pressure", wear->pressure);
        dem_json_put_number(w, "constant", wear->constant);
        dem_json_put_number(w, "psi", wear->psi);
        dem_json_put_number(w, "roughness", wear->roughness);
    } else {
        dem_json_put_number(w, "coefficient", wear->coefficient);
        dem_json_put_number(w, "hardness", wear->hardness);
    }
    dem_json_close(w, '}');
}

static void put_form(dem_json_writer *w, const dem_wall_def *wall, const dem_wall_source *source)
{
    if (wall->kind == DEM_WALL_MESH) {
        dem_json_put_string(w, "mesh", wall->mesh_file);
        dem_json_put_string(w, "unit", source->unit ? source->unit : "m");
        return;
    }
    static const char *const keys[] = {
        [DEM_WALL_PLANE] = "plane", [DEM_WALL_DISC] = "plane",    [DEM_WALL_RECTANGLE] = "plane",
        [DEM_WALL_CONE] = "cone",   [DEM_WALL_SPHERE] = "sphere", [DEM_WALL_CYLINDER] = "cylinder"};
    bool plane = strcmp(keys[wall->kind], "plane") == 0, sphere = wall->kind == DEM_WALL_SPHERE;
    bool cone = wall->kind == DEM_WALL_CONE, endless = cone && isinf(wall->length);
    dem_json_open_object(w, keys[wall->kind]);
    put_vec(w, sphere ? "centre" : endless ? "apex" : "point", wall->point);
    if (!sphere)
        put_vec(w, plane ? "normal" : "axis", wall->normal);
    if (wall->kind == DEM_WALL_DISC || sphere || wall->kind == DEM_WALL_CYLINDER)
        dem_json_put_number(w, "radius", wall->radius);
    if (wall->kind == DEM_WALL_RECTANGLE) {
        dem_json_put_numbers(w, "size", wall->size, 2);
        put_vec(w, "along", wall->along);
    }
    if (endless)
        dem_json_put_number(w, "angle", wall->angle);
    else if (cone) {
        dem_json_put_numbers(w, "radii", (double[]){wall->radius, wall->end_radius}, 2);
        dem_json_put_number(w, "length", wall->length);
    }
    if (sphere || endless || wall->kind == DEM_WALL_CYLINDER)
        dem_json_put_string(w, "side", wall->outside ? "outside" : "inside");
    dem_json_close(w, '}');
}

dem_status dem_scene_put_walls(dem_json_writer *w, const dem_scene *scene, dem_error *error)
{
    open_map(w, "walls");
    for (size_t i = 0; i < scene->wall_count; i++) {
        const dem_wall_def *wall = &scene->walls[i];
        if (wall->generator)
            continue;
        if (wall->kind == DEM_WALL_MESH && !wall->mesh_file)
            return dem_fail(error, DEM_USAGE,
                            "the mesh of wall \"%.60s\" is in no file; write it and name it in mesh_file",
                            text_of(wall->name));
        if (wall->table.count && !wall->table.file)
            return dem_fail(
                error, DEM_USAGE,
                "the table of the motion of wall \"%.60s\" is in no file; write it and name it in table.file",
                text_of(wall->name));
        dem_wall_source source = source_of(scene, i);
        dem_json_open_object(w, text_of(wall->name));
        dem_json_put_string(w, "material", material_of(scene, wall->material));
        put_form(w, wall, &source);
        put_motion(w, wall, &source);
        if (wall->servo.on)
            put_servo(w, scene, &wall->servo);
        if (wall->wear.law != DEM_WEAR_NONE)
            put_wear(w, &wall->wear);
        dem_json_close(w, '}');
    }
    dem_json_close(w, '}');
    return DEM_OK;
}
