#include "sim/place.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

static bool finite_vec(dem_vec3 v)
{
    return isfinite(v.x + v.y + v.z);
}

static dem_status check_body(const dem_scene *scene, const dem_body_def *b, size_t index, dem_error *error)
{
    const char *wrong = NULL;
    double norm = b->orientation.w * b->orientation.w + b->orientation.x * b->orientation.x +
                  b->orientation.y * b->orientation.y + b->orientation.z * b->orientation.z;
    if (b->shape >= scene->shape_count)
        wrong = "names a shape that is not there; correct it";
    else if (!finite_vec(b->position) || !finite_vec(b->velocity) || !finite_vec(b->spin))
        wrong = "has a number that is not finite; correct it";
    else if (!(norm > 0 && isfinite(norm)))
        wrong = "has an orientation that is none; give a quaternion w, x, y, z that is not 0";
    else if (!(b->scale > 0 && isfinite(b->scale)))
        wrong = "has a scale that is not positive; correct it";
    return wrong ? dem_fail(error, DEM_BAD_INPUT, "body %zu %s", index, wrong) : DEM_OK;
}

dem_status dem_place_bodies(const dem_world *w, const dem_scene *scene, dem_body_def **bodies, size_t *count,
                            dem_error *error)
{
    (void)w;
    *count = scene->bodies.count;
    *bodies = dem_alloc(*count, sizeof **bodies);
    if (!*bodies)
        return dem_fail_memory(error);
    for (size_t i = 0; i < *count; i++) {
        dem_status status = check_body(scene, &scene->bodies.bodies[i], i, error);
        if (status != DEM_OK) {
            free(*bodies);
            *bodies = NULL;
            return status;
        }
        (*bodies)[i] = scene->bodies.bodies[i];
    }
    return DEM_OK;
}

dem_status dem_sphere_clump(const dem_scene *scene, size_t shape, dem_clump **clump, dem_error *error)
{
    const dem_shape_def *s = &scene->shapes[shape];
    double r = s->sphere_radius, density = scene->materials[s->material].density, volume = 4 * DEM_PI / 3 * r * r * r;
    double mass = density * volume, i = 0.4 * mass * r * r;
    dem_ball ball = {{0, 0, 0}, r};
    dem_clump_def def = {.name = s->name,
                         .density = density,
                         .mass = mass,
                         .volume = volume,
                         .inertia = {i, i, i},
                         .orientation = {1, 0, 0, 0},
                         .union_volume = volume,
                         .union_inertia = {i, i, i},
                         .balls = &ball,
                         .ball_count = 1,
                         .method = "sphere",
                         .seconds = NAN};
    return dem_clump_create(&def, clump, error);
}
