#include "sim/place.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/fill.h"
#include "sim/scene.h"

// ---- listed bodies

enum { LAST_HOLD = 2 * DEM_HOLD_SPIN - 1 };

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
    else if (scene->dimension == 2 && (b->velocity.z != 0 || b->spin.x != 0 || b->spin.y != 0))
        wrong = "leaves the plane, and the scene has two dimensions; set vz, wx and wy to 0";
    else if (!(norm > 0 && isfinite(norm)))
        wrong = "has an orientation that is none; give a quaternion w, x, y, z that is not 0";
    else if (b->hold > LAST_HOLD)
        wrong = "is held by bits that mean nothing; take those of dem_hold";
    else if (!(b->scale > 0 && isfinite(b->scale)))
        wrong = "has a scale that is not positive; correct it";
    return wrong ? dem_fail(error, DEM_BAD_INPUT, "body %zu %s", index, wrong) : DEM_OK;
}

// ---- fills

bool dem_placing_create(const dem_world *w, dem_placing *p)
{
    p->w = w;
    p->shapes = dem_alloc_zero(w->shape_count, sizeof *p->shapes);
    p->balls = dem_alloc(w->templates.sphere_count, sizeof *p->balls);
    if (!p->shapes || !p->balls)
        return false;
    for (size_t i = 0; i < w->shape_count; i++) {
        dem_clump_def def = dem_clump_view(w->clumps[i]);
        const dem_template *t = &w->templates.items[i];
        memcpy(p->balls + t->first, def.balls, def.ball_count * sizeof *def.balls);
        double volume = def.mass / def.density;
        p->shapes[i] = (dem_fill_shape){.balls = p->balls + t->first,
                                        .ball_count = def.ball_count,
                                        .mass = t->mass,
                                        .volume = def.volume > 0 ? def.volume : volume,
                                        .flat = t->flat,
                                        .equivalent_diameter = t->equivalent_diameter,
                                        .radius_out = t->radius_out};
    }
    return true;
}

void dem_placing_release(dem_placing *p)
{
    free(p->shapes);
    free(p->balls);
    free(p->near.items);
}

// from a wall that is no mesh
static double smooth_distance(const dem_world *w, size_t wall, dem_vec3 x)
{
    const dem_wall *about = &w->walls.items[wall];
    if (about->form == DEM_FORM_MESH)
        return dem_surface_distance(&about->surface, wall_from_space(about, x));
    return dem_wall_distance(&w->walls, wall, x);
}

double dem_placing_clearance(void *user, dem_vec3 centre, double radius, double most)
{
    dem_placing *p = user;
    double least = most;
    for (size_t i = 0; i < p->w->walls.count; i++) {
        const dem_wall *wall = &p->w->walls.items[i];
        if (!wall->mesh) {
            if (p->smooth && !wall->generator)  // which inlets let bodies in through
                least = smaller(least, smooth_distance(p->w, i, centre) - radius);
            continue;
        }
        if (!(least + radius > 0))
            continue;
        dem_vec3 x = wall_from_space(wall, centre);
        if (!dem_mesh_wall_near(wall->mesh, x, least + radius, &p->near))
            p->failed = true;
        for (size_t k = 0; k < p->near.count; k++) {
            dem_closest c = triangle_closest(&wall->mesh->triangles[p->near.items[k]], x);
            least = smaller(least, sqrt(c.distance2) - radius);
        }
    }
    return least;
}

static bool has_meshes(const dem_world *w)
{
    for (size_t i = 0; i < w->walls.count; i++)
        if (w->walls.items[i].mesh)
            return true;
    return false;
}

static dem_status add_fill(dem_placing *p, const dem_scene *scene, const dem_fill_def *fill, dem_body_def **bodies,
                           size_t *count, dem_error *error)
{
    dem_body_def *more;
    size_t added;
    bool flat = scene->dimension == 2;
    for (size_t i = 0; flat && i < p->w->shape_count; i++) {
        // the void ratio is one of areas
        double r = p->shapes[i].equivalent_diameter / 2;
        p->shapes[i].volume = DEM_PI * r * r * (fill->high.z - fill->low.z);
        p->shapes[i].flat = true;
    }
    dem_fill_obstacles there = {.bodies = *bodies,
                                .body_count = *count,
                                .domain = &scene->domain,
                                .flat = flat,
                                .walls = scene->walls,
                                .wall_count = scene->wall_count,
                                .clearance = has_meshes(p->w) ? dem_placing_clearance : NULL,
                                .user = p};
    DEM_TRY(dem_fill(p->w->ctx, fill, p->shapes, p->w->shape_count, &there, &more, &added, error));
    dem_body_def *all = realloc(*bodies, (*count + added + 1) * sizeof *all);
    if (!all) {
        free(more);
        return dem_fail_memory(error);
    }
    memcpy(all + *count, more, added * sizeof *more);
    free(more);
    *bodies = all;
    *count += added;
    return DEM_OK;
}

dem_status dem_place_bodies(const dem_world *w, const dem_scene *scene, dem_body_def **bodies, size_t *count,
                            dem_error *error)
{
    dem_placing p = {0};
    *count = scene->bodies.count;
    *bodies = dem_alloc(*count, sizeof **bodies);
    dem_status status = *bodies ? DEM_OK : dem_fail_memory(error);
    for (size_t i = 0; status == DEM_OK && i < *count; i++) {
        status = check_body(scene, &scene->bodies.bodies[i], i, error);
        (*bodies)[i] = scene->bodies.bodies[i];
    }
    if (status == DEM_OK && scene->bodies.fill_count && !dem_placing_create(w, &p))
        status = dem_fail_memory(error);
    for (size_t i = 0; status == DEM_OK && i < scene->bodies.fill_count; i++)
        status = add_fill(&p, scene, &scene->bodies.fills[i], bodies, count, error);
    for (size_t i = 0; status == DEM_OK && scene->dimension == 2 && i < *count; i++)
        (*bodies)[i].hold |= DEM_LOCK_PLANE;
    dem_placing_release(&p);
    if (status != DEM_OK) {
        free(*bodies);
        *bodies = NULL;
    }
    return status;
}

// ---- shapes

dem_status dem_sphere_clump(const dem_scene *scene, size_t shape, dem_clump **clump, dem_error *error)
{
    const dem_shape_def *s = &scene->shapes[shape];
    double r = s->sphere_radius, density = scene->materials[s->material].density, volume = dem_ball_volume(s);
    double mass = density * volume, i = (s->disc_thickness > 0 ? 0.5 : 0.4) * mass * r * r;
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
