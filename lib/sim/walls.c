#include "sim/walls.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/status.h"
#include "sim/mesh_wall.h"
#include "sim/servo.h"

static const double FAR_AWAY = 1e155;  // [m] farther than any dummy body

static const dem_wall_form form_of[] = {
    [DEM_WALL_PLANE] = DEM_FORM_PLANE, [DEM_WALL_CYLINDER] = DEM_FORM_CYLINDER, [DEM_WALL_MESH] = DEM_FORM_MESH,
    [DEM_WALL_CONE] = DEM_FORM_MESH,   [DEM_WALL_SPHERE] = DEM_FORM_MESH,      [DEM_WALL_DISC] = DEM_FORM_MESH,
    [DEM_WALL_RECTANGLE] = DEM_FORM_MESH};

// a surface that moves along itself stays where it is: a plane within itself, a cylinder about its own axis
static bool sweeps(const dem_wall *w)
{
    const dem_wall_motion *m = &w->motion;
    double little = 1e-12;
    if (w->servo.on || w->form == DEM_FORM_MESH)
        return w->moves && (w->servo.on || m->shifts || !dem_surface_turns_in_place(&w->surface, m->through, m->axis));
    if (m->shifts && !(v3_norm2(m->shift_only) > 0))
        return true;
    double across = v3_norm(v3_cross(m->axis, w->normal));
    if (w->form == DEM_FORM_PLANE) {
        // in-plane rotation keeps a plane
        return (m->shifts && fabs(v3_dot(m->shift_only, w->normal)) > little) || (m->turns && across > little);
    }
    dem_vec3 aside = v3_cross(m->shift_only, w->normal), off = v3_cross(v3_sub(w->point, m->through), w->normal);
    bool about_itself = across <= little && v3_norm(off) <= little * fabs(w->radius);
    return (m->shifts && v3_norm(aside) > little) || (m->turns && !about_itself);
}

static dem_status make_wear(const dem_wall_def *def, dem_wall *wall, dem_error *error)
{
    if (wall->wear.law == DEM_WEAR_NONE)
        return DEM_OK;
    if (wall->form != DEM_FORM_MESH)
        return dem_fail(error, DEM_BAD_INPUT,
                        "wall \"%.60s\" has no end and no area to wear; take a mesh, a disc, a rectangle, a cone or a "
                        "sphere",
                        wall->name);
    wall->worn_count = def->kind == DEM_WALL_MESH ? def->mesh.triangle_count : 1;
    wall->worn = dem_alloc_zero(wall->worn_count, sizeof *wall->worn);
    return wall->worn ? DEM_OK : dem_fail_memory(error);
}

static dem_status make_wall(const dem_ctx *ctx, const dem_wall_def *def, dem_wall *wall, dem_error *error)
{
    *wall = (dem_wall){.name = strdup(def->name ? def->name : ""),
                       .form = form_of[def->kind],
                       .material = def->material,
                       .point = def->point,
                       .normal = v3_unit(def->normal),
                       .radius = def->outside ? -def->radius : def->radius,
                       .motion = dem_wall_motion_of(def),
                       .servo = def->servo,
                       .wear = def->wear,
                       .generator = def->generator,
                       .surface = dem_surface_of(def),
                       .orientation = {1, 0, 0, 0}};
    bool owned = dem_wall_motion_own(&wall->motion);
    if (!wall->name || !owned)
        return dem_fail_memory(error);
    DEM_TRY(make_wear(def, wall, error));
    wall->moves = dem_wall_motion_any(&wall->motion) || wall->servo.on;
    wall->sweeps = wall->moves && sweeps(wall);
    if (def->kind == DEM_WALL_MESH)
        return dem_mesh_wall_create(ctx, &def->mesh, wall->name, &wall->mesh, error);
    return DEM_OK;
}

dem_status dem_walls_create(const dem_ctx *ctx, const dem_scene *scene, dem_walls *walls, dem_error *error)
{
    size_t rows = (scene->wall_count + 2) * DEM_WALL_ROW;
    *walls = (dem_walls){.items = dem_alloc_zero(scene->wall_count, sizeof *walls->items),
                         .rows = aligned_alloc(64, rows * sizeof(double))};
    if (!walls->items || !walls->rows)
        return dem_fail_memory(error);
    memset(walls->rows, 0, rows * sizeof(double));
    walls->rows[rows - 2 * DEM_WALL_ROW + 3] = -FAR_AWAY;
    walls->rows[rows - DEM_WALL_ROW + 3] = FAR_AWAY;
    for (size_t i = 0; i < scene->wall_count; i++) {
        walls->count = i + 1;
        DEM_TRY(make_wall(ctx, &scene->walls[i], &walls->items[i], error));
        walls->move |= walls->items[i].moves;
        walls->sweep |= walls->items[i].sweeps;
        walls->servo |= walls->items[i].servo.on;
        walls->wear |= walls->items[i].wear.law != DEM_WEAR_NONE;
        walls->rub |= walls->items[i].wear.law == DEM_WEAR_ARCHARD;
        uint32_t slots = walls->items[i].mesh ? 4 : (uint32_t)dem_surface_most(&walls->items[i].surface);
        walls->slots = slots > walls->slots ? slots : walls->slots;
    }
    dem_walls_place(walls, 0);
    return walls->servo ? dem_servo_prepare(walls, error) : DEM_OK;
}

void dem_walls_release(dem_walls *walls)
{
    for (size_t i = 0; i < walls->count; i++) {
        free(walls->items[i].name);
        free(walls->items[i].worn);
        dem_wall_motion_release(&walls->items[i].motion);
        dem_mesh_wall_destroy(walls->items[i].mesh);
    }
    free(walls->items);
    free(walls->rows);
}

static void place(dem_wall *w, double t, double *row)
{
    dem_wall_moment now = dem_wall_motion_at(&w->motion, t);
    dem_vec3 more = v3_scale(w->servo.direction, w->travel), spin = now.spin;
    w->position = dem_wall_pose(&w->motion, &now, more, &w->orientation);
    dem_vec3 through = v3_add(v3_add(w->motion.through, now.shift), more);
    dem_vec3 normal = wall_turn(w, w->normal), point = wall_to_space(w, w->point);
    dem_vec3 velocity = v3_along(now.velocity, w->speed, w->servo.direction);
    dem_vec3 passing = v3_sub(velocity, v3_cross(spin, through));
    double along = w->form == DEM_FORM_PLANE ? v3_dot(normal, point) : w->radius;
    memcpy(row,
           (double[DEM_WALL_ROW]){normal.x, normal.y, normal.z, along, point.x, point.y, point.z, 0, passing.x,
                                  passing.y, passing.z, spin.x, spin.y, spin.z},
           DEM_WALL_ROW * sizeof *row);
}

void dem_walls_place(dem_walls *walls, double t)
{
    for (size_t i = 0; i < walls->count; i++)
        place(&walls->items[i], t, walls->rows + DEM_WALL_ROW * i);
}

double dem_walls_speed(const dem_walls *walls, dem_vec3 centre, double radius)
{
    double speed = 0;
    for (size_t i = 0; i < walls->count; i++) {
        const double *row = walls->rows + DEM_WALL_ROW * i;
        const dem_wall_motion *m = &walls->items[i].motion;
        if (!walls->items[i].sweeps)
            continue;
        if (m->steady) {
            dem_vec3 v = v3_add(v3(row[8], row[9], row[10]), v3_cross(m->spin, centre));
            speed = larger(speed, v3_norm(v) + v3_norm(m->spin) * radius);
        } else {
            double arm = v3_distance(centre, wall_reference(&walls->items[i])) + radius + m->range;
            speed = larger(speed, m->speed_most + m->rate_most * arm);
        }
    }
    return speed;
}

double dem_wall_distance(const dem_walls *walls, size_t wall, dem_vec3 x)
{
    const double *row = walls->rows + DEM_WALL_ROW * wall;
    dem_vec3 n = v3(row[0], row[1], row[2]);
    if (walls->items[wall].form == DEM_FORM_PLANE)
        return v3_dot(n, x) - row[3];
    dem_vec3 from = v3_sub(x, v3(row[4], row[5], row[6]));
    double r = v3_norm(v3_along(from, -v3_dot(from, n), n));
    return row[3] > 0 ? row[3] - r : r + row[3];
}
