// What is near a place in the room, and whether it is too near.
#include "base/memory.h"
#include "math/quat.h"
#include "sim/fill_room.h"
#include "sim/surface.h"

static double squared(double x)
{
    return x * x;
}

static double wall_clearance(const dem_wall_def *wall, dem_vec3 centre, double radius)
{
    dem_vec3 d = v3_sub(centre, wall->point);
    double along = v3_dot(d, wall->normal);
    if (wall->kind == DEM_WALL_PLANE)
        return along - radius;
    if (wall->kind != DEM_WALL_CYLINDER) {
        dem_surface surface = dem_surface_of(wall);
        return dem_surface_distance(&surface, centre) - radius;
    }
    double off = v3_norm(v3_along(d, -along, wall->normal));
    return (wall->outside ? off - wall->radius : wall->radius - off) - radius;
}

// least distance from a ball to the walls, as far as it is less than `most`
static double clearance(const dem_room *room, dem_vec3 centre, double radius, double most)
{
    const dem_fill_obstacles *there = room->there;
    double least = most;
    for (size_t i = 0; i < there->wall_count; i++)
        if (there->walls[i].kind != DEM_WALL_MESH)
            least = fmin(least, wall_clearance(&there->walls[i], centre, radius));
    return there->clearance ? there->clearance(there->user, centre, radius, least) : least;
}

// a walk over the cells of a grid that a ball reaches
typedef struct walk {
    const dem_room_grid *grid;
    int32_t low[3], high[3];
} walk;

static walk walk_around(const dem_room *room, const dem_room_grid *g, dem_vec3 centre, double reach)
{
    walk w = {.grid = g};
    reach += room->rounding;
    for (int k = 0; k < 3; k++) {
        double x = v3_get(centre, k);
        bool periodic = room->periodic[k];
        double from = floor((x - reach - v3_get(room->origin, k)) / g->size[k]);
        double to = floor((x + reach - v3_get(room->origin, k)) / g->size[k]);
        w.low[k] = (int32_t)(periodic ? from : fmin(fmax(from, 0), g->count[k] - 1));
        w.high[k] = (int32_t)(periodic ? to : fmin(fmax(to, 0), g->count[k] - 1));
    }
    return w;
}

// the stored cell that stands for a counted-on one, and by how much its bodies are shifted
static int32_t stored_cell(const dem_room *room, const dem_room_grid *g, int32_t i, int axis, double *shift)
{
    int32_t n = g->count[axis];
    *shift = 0;
    if (!room->periodic[axis] || (i >= 0 && i < n))
        return i;
    int32_t turns = (i >= 0 ? i : i - n + 1) / n;
    *shift = turns * v3_get(room->period, axis);
    return i - turns * n;
}

// calls `visit` for each body in the cells of a walk until one returns true; `position` of the body's image
typedef bool visitor(dem_room *room, const void *what, uint32_t body, dem_vec3 position);

static bool visit_cells(dem_room *room, const walk *w, visitor *visit, const void *what)
{
    const dem_room_grid *g = w->grid;
    for (int32_t z = w->low[2]; z <= w->high[2]; z++) {
        dem_vec3 shift;
        size_t at_z = (size_t)stored_cell(room, g, z, 2, &shift.z) * (size_t)g->count[1];
        for (int32_t y = w->low[1]; y <= w->high[1]; y++) {
            size_t at_y = (at_z + (size_t)stored_cell(room, g, y, 1, &shift.y)) * (size_t)g->count[0];
            for (int32_t x = w->low[0]; x <= w->high[0]; x++) {
                size_t at = at_y + (size_t)stored_cell(room, g, x, 0, &shift.x);
                for (uint32_t b = g->cells[at]; b != DEM_ROOM_NONE; b = room->bodies[b].next)
                    if (visit(room, what, b, v3_add(room->bodies[b].position, shift)))
                        return true;
            }
        }
    }
    return false;
}

static bool visit_near(dem_room *room, dem_vec3 centre, double reach, visitor *visit, const void *what)
{
    for (int i = 0; i < DEM_ROOM_CLASSES; i++) {
        const dem_room_grid *g = &room->grids[i];
        if (g->held == 0)
            continue;
        walk w = walk_around(room, g, centre, reach + g->largest);
        if (visit_cells(room, &w, visit, what))
            return true;
    }
    return false;
}

typedef struct looking {
    const dem_room_trial *trial;
    dem_vec3 position;
    uint32_t without;
} looking;

// notes a body near the trial; true where the cores overlap
static bool look_at(dem_room *room, const void *what, uint32_t body, dem_vec3 position)
{
    const looking *l = what;
    const dem_room_body *b = &room->bodies[body];
    dem_vec3 offset = v3_sub(l->position, position);
    double distance2 = v3_norm2(offset);
    if (distance2 >= squared(l->trial->radius + b->radius + room->gap) || body == l->without)
        return false;
    if (l->trial->core > 0 && b->core > 0 && distance2 < squared(l->trial->core + b->core + room->gap))
        return true;
    if (!dem_grow(&room->near, &room->near_capacity, room->near_count, sizeof *room->near)) {
        room->failed = true;
        return true;
    }
    room->near[room->near_count++] = (dem_room_near){offset, body};
    return false;
}

// whether some image of the trial is near the trial itself; *blocked: in every orientation
static bool sees_itself(const dem_room *room, const dem_room_trial *trial, bool *blocked)
{
    bool near = false;
    for (int k = 0; k < 3; k++) {
        double period = v3_get(room->period, k);
        near |= room->periodic[k] && 2 * trial->radius + room->gap > period;
        *blocked |= room->periodic[k] && trial->core > 0 && 2 * trial->core + room->gap > period;
    }
    return near;
}

dem_room_sight dem_room_look(dem_room *room, const dem_room_trial *trial, dem_vec3 position, uint32_t without)
{
    bool blocked = false;
    position = room_point(room, position);
    room->near_count = 0;
    room->near_self = sees_itself(room, trial, &blocked);
    looking l = {trial, position, without};
    if (blocked || visit_near(room, position, trial->radius + room->gap, look_at, &l))
        return DEM_ROOM_BLOCKED;
    double clear = clearance(room, position, trial->radius, room->gap);
    room->near_wall = clear < room->gap;
    // a smaller ball is as much farther away
    if (room->near_wall && trial->core > 0 && clear + trial->radius - trial->core < room->gap)
        return DEM_ROOM_BLOCKED;
    return room->near_count || room->near_wall || room->near_self ? DEM_ROOM_NEAR : DEM_ROOM_FREE;
}

// a body of the room or the image of a trial
typedef struct partner {
    uint32_t shape;
    double scale, radius;
    dem_quat orientation;
} partner;

// picks the partner's balls within reach of a ball in its frame
static size_t pick(dem_room *room, const partner *p, dem_vec3 centre, double reach)
{
    const dem_fill_shape *shape = &room->shapes[p->shape];
    size_t picked = 0;
    for (size_t i = 0; i < shape->ball_count; i++) {
        const dem_ball *b = &shape->balls[i];
        if (v3_norm2(v3_along(centre, -p->scale, b->centre)) < squared(b->radius * p->scale + reach))
            room->picked[picked++] = (uint32_t)i;
    }
    return picked;
}

// whether a ball in the partner's frame overlaps one of those picked
static bool ball_overlaps(const dem_room *room, const partner *p, size_t picked, dem_vec3 centre, double reach)
{
    const dem_fill_shape *shape = &room->shapes[p->shape];
    for (size_t i = 0; i < picked; i++) {
        const dem_ball *b = &shape->balls[room->picked[i]];
        if (v3_norm2(v3_along(centre, -p->scale, b->centre)) < squared(b->radius * p->scale + reach))
            return true;
    }
    return false;
}

// `offset` from the partner's centre to the trial's; the partner's balls stay in its own frame
static bool overlaps(dem_room *room, const dem_room_trial *trial, const partner *p, dem_vec3 offset)
{
    size_t picked = pick(room, p, quat_unrotate(p->orientation, offset), trial->radius + room->gap);
    if (picked == 0)
        return false;
    dem_vec3 x = quat_rotate(p->orientation, v3(1, 0, 0)), y = quat_rotate(p->orientation, v3(0, 1, 0));
    dem_vec3 z = quat_rotate(p->orientation, v3(0, 0, 1));
    for (size_t i = 0; i < trial->count; i++) {
        dem_vec3 at = v3_add(offset, trial->balls[i].centre);
        double reach = trial->balls[i].radius + room->gap;
        if (v3_norm2(at) < squared(p->radius + reach) &&
            ball_overlaps(room, p, picked, v3(v3_dot(x, at), v3_dot(y, at), v3_dot(z, at)), reach))
            return true;
    }
    return false;
}

static bool overlaps_itself(dem_room *room, const dem_room_trial *trial)
{
    partner self = {trial->shape, trial->scale, trial->radius, trial->orientation};
    int turns[3];
    for (int k = 0; k < 3; k++)
        turns[k] = room->periodic[k] ? (int)ceil((2 * trial->radius + room->gap) / v3_get(room->period, k)) : 0;
    for (int z = -turns[2]; z <= turns[2]; z++)
        for (int y = -turns[1]; y <= turns[1]; y++)
            for (int x = -turns[0]; x <= turns[0]; x++) {
                dem_vec3 shift = v3(x * room->period.x, y * room->period.y, z * room->period.z);
                if ((x || y || z) && overlaps(room, trial, &self, shift))
                    return true;
            }
    return false;
}

static bool crosses_walls(const dem_room *room, const dem_room_trial *trial, dem_vec3 position)
{
    for (size_t i = 0; i < trial->count; i++)
        if (clearance(room, v3_add(position, trial->balls[i].centre), trial->balls[i].radius, room->gap) < room->gap)
            return true;
    return false;
}

bool dem_room_fits(dem_room *room, const dem_room_trial *trial, dem_vec3 position)
{
    position = room_point(room, position);
    for (size_t i = 0; i < room->near_count; i++) {
        const dem_room_body *b = &room->bodies[room->near[i].body];
        const dem_room_pose *pose = &room->poses[room->near[i].body];
        partner p = {b->shape, pose->scale, b->radius, pose->orientation};
        if (overlaps(room, trial, &p, room->near[i].offset))
            return false;
    }
    return !(room->near_wall && crosses_walls(room, trial, position)) &&
           !(room->near_self && overlaps_itself(room, trial));
}

typedef struct covering {
    dem_vec3 centre;
    double half, core;
} covering;

static bool covers(dem_room *room, const void *what, uint32_t body, dem_vec3 position)
{
    const covering *c = what;
    const dem_room_body *b = &room->bodies[body];
    const dem_room_pose *pose = &room->poses[body];
    dem_vec3 offset = v3_sub(c->centre, position);
    double reach = c->core + room->gap - c->half, distance2 = v3_norm2(offset);
    // the farthest point is still too near
    if (reach + b->radius <= 0 || distance2 >= squared(reach + b->radius))
        return false;
    if (reach + b->core > 0 && b->core > 0 && distance2 < squared(reach + b->core))
        return true;
    const dem_fill_shape *shape = &room->shapes[b->shape];
    dem_vec3 at = quat_unrotate(pose->orientation, offset);
    for (size_t i = 0; i < shape->ball_count; i++) {
        double r = shape->balls[i].radius * pose->scale + reach;
        if (r > 0 && v3_norm2(v3_along(at, -pose->scale, shape->balls[i].centre)) < squared(r))
            return true;
    }
    return false;
}

bool dem_room_covered(dem_room *room, dem_vec3 centre, double half, double core)
{
    if (core <= 0)
        return false;
    centre = room_point(room, centre);
    covering c = {centre, half, core};
    if (clearance(room, centre, core, room->gap - half) < room->gap - half)
        return true;
    return visit_near(room, centre, fmax(core + room->gap - half, 0), covers, &c);
}
