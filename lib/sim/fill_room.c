#include "sim/fill_room.h"

#include <float.h>
#include <stdlib.h>

#include "base/memory.h"
#include "math/quat.h"

static dem_status check_domain(const dem_room *room, const dem_domain_def *domain, dem_error *error)
{
    for (int k = 0; k < 3; k++) {
        double low = v3_get(domain->low, k), high = v3_get(domain->high, k);
        // a domain may be endless
        double slack = 1e-9 * (v3_get(room->high, k) - v3_get(room->low, k));
        if (v3_get(room->low, k) < low - slack || v3_get(room->high, k) > high + slack)
            return dem_fail(error, DEM_USAGE, "fill: the box reaches out of the domain along %c; make it smaller",
                            "xyz"[k]);
    }
    return DEM_OK;
}

static void set_periods(dem_room *room, const dem_domain_def *domain)
{
    room->origin = room->low;
    for (int k = 0; k < 3 && domain; k++) {
        if (!domain->periodic[k])
            continue;
        double low = v3_get(domain->low, k), high = v3_get(domain->high, k), slack = 1e-9 * (high - low);
        room->periodic[k] = true;
        v3_set(&room->origin, k, low);
        v3_set(&room->period, k, high - low);
        room->spans[k] = v3_get(room->low, k) <= low + slack && v3_get(room->high, k) >= high - slack;
    }
}

static uint32_t class_of(const dem_room *room, double radius)
{
    double steps = floor(log2(room->largest / radius));
    return steps < DEM_ROOM_CLASSES - 1 ? (uint32_t)fmax(steps, 0) : DEM_ROOM_CLASSES - 1;
}

static double radius_of(const dem_room *room, const dem_body_def *body)
{
    return room->shapes[body->shape].radius_out * body->scale;
}

// cells that hold a body of the class, larger ones where bodies are few
static dem_status make_grid(const dem_room *room, dem_room_grid *g, dem_error *error)
{
    double cell = 2 * g->largest + room->gap, total;
    do {
        total = 1;
        for (int k = 0; k < 3; k++) {
            double length = room->periodic[k] ? v3_get(room->period, k) : v3_get(room->high, k) - v3_get(room->low, k);
            double n = fmin(fmax(floor(length / cell), 1), 1 << 20);
            g->count[k] = (int32_t)n;
            g->size[k] = length / n;
            total *= n;
        }
        cell *= 1.3;
    } while (total > 2.0 * (double)g->expected + 64);
    size_t cells = (size_t)total;
    g->cells = dem_alloc(cells, sizeof *g->cells);
    if (!g->cells)
        return dem_fail_memory(error);
    for (size_t i = 0; i < cells; i++)
        g->cells[i] = DEM_ROOM_NONE;
    return DEM_OK;
}

static dem_status make_grids(dem_room *room, const double *radii, size_t count, dem_error *error)
{
    const dem_fill_obstacles *there = room->there;
    room->largest = 0;
    for (size_t i = 0; i < count; i++)
        room->largest = fmax(room->largest, radii[i]);
    for (size_t i = 0; i < there->body_count; i++)
        room->largest = fmax(room->largest, radius_of(room, &there->bodies[i]));
    for (size_t i = 0; i < count; i++)
        room->grids[class_of(room, radii[i])].expected++;
    for (size_t i = 0; i < there->body_count; i++)
        room->grids[class_of(room, radius_of(room, &there->bodies[i]))].expected++;
    double largest = room->largest;
    for (int i = 0; i < DEM_ROOM_CLASSES; i++, largest /= 2) {
        // classes are told by a logarithm, which may be off by rounding
        room->grids[i].largest = largest * (1 + 1e-12);
        if (room->grids[i].expected > 0)
            DEM_TRY(make_grid(room, &room->grids[i], error));
    }
    return DEM_OK;
}

// the largest ball about the centre of mass inside of one of the balls
static double core_of(const dem_fill_shape *shape)
{
    double core = 0;
    for (size_t i = 0; i < shape->ball_count; i++)
        core = fmax(core, shape->balls[i].radius - v3_norm(shape->balls[i].centre));
    return core;
}

static size_t most_balls(const dem_fill_shape *shapes, size_t count)
{
    size_t most = 1;
    for (size_t i = 0; i < count; i++)
        most = shapes[i].ball_count > most ? shapes[i].ball_count : most;
    return most;
}

// the largest coordinate that occurs
static double extent_of(const dem_room *room)
{
    double most = 0;
    for (int k = 0; k < 3; k++) {
        double low = fmin(v3_get(room->low, k), v3_get(room->origin, k));
        double high = fmax(v3_get(room->high, k), v3_get(room->origin, k) + v3_get(room->period, k));
        most = fmax(most, fmax(fabs(low), fabs(high)));
    }
    return most;
}

// what is there and can be reached from the box
static void add_obstacles(dem_room *room, dem_room_trial *trial)
{
    for (size_t i = 0; i < room->there->body_count && !room->failed; i++) {
        const dem_body_def *body = &room->there->bodies[i];
        double reach = radius_of(room, body) + room->gap;
        bool far = false;
        for (int k = 0; k < 3; k++) {
            double x = v3_get(body->position, k);
            far |= !room->periodic[k] && (x + reach < v3_get(room->low, k) || x - reach > v3_get(room->high, k));
        }
        if (far)
            continue;
        dem_room_take(room, trial, body->shape, body->scale);
        trial->orientation = body->orientation;
        dem_room_add(room, trial, body->position);
    }
    room->obstacles = room->count;
}

dem_status dem_room_create(dem_room *room, const dem_fill_def *fill, const dem_fill_shape *shapes, size_t shape_count,
                           const dem_fill_obstacles *there, const double *radii, size_t count, dem_error *error)
{
    *room = (dem_room){.shapes = shapes, .low = fill->low, .high = fill->high, .gap = fill->gap, .there = there};
    room->flat = there->flat;
    if (there->domain)
        DEM_TRY(check_domain(room, there->domain, error));
    set_periods(room, there->domain);
    room->cores = dem_alloc(shape_count, sizeof *room->cores);
    room->picked = dem_alloc(most_balls(shapes, shape_count), sizeof *room->picked);
    dem_status status = room->cores && room->picked ? DEM_OK : dem_fail_memory(error);
    if (status == DEM_OK) {
        for (size_t i = 0; i < shape_count; i++)
            room->cores[i] = core_of(&shapes[i]);
        status = make_grids(room, radii, count, error);
    }
    if (status == DEM_OK) {
        // sums of a few coordinates and radii
        room->rounding = 16 * DBL_EPSILON * (extent_of(room) + room->largest);
        room->gap += room->rounding;
        dem_room_trial trial = {0};
        add_obstacles(room, &trial);
        status = room->failed ? dem_fail_memory(error) : DEM_OK;
    }
    if (status != DEM_OK)
        dem_room_release(room);
    return status;
}

void dem_room_release(dem_room *room)
{
    for (int i = 0; i < DEM_ROOM_CLASSES; i++)
        free(room->grids[i].cells);
    free(room->cores);
    free(room->picked);
    free(room->bodies);
    free(room->poses);
    free(room->near);
    *room = (dem_room){0};
}

void dem_room_take(const dem_room *room, dem_room_trial *trial, uint32_t shape, double scale)
{
    trial->shape = shape;
    trial->scale = scale;
    trial->radius = room->shapes[shape].radius_out * scale;
    trial->core = room->cores[shape] * scale;
    trial->grid = class_of(room, trial->radius);
}

void dem_room_turn(const dem_room *room, dem_room_trial *trial, dem_quat orientation)
{
    const dem_fill_shape *shape = &room->shapes[trial->shape];
    if (room->flat)
        orientation = orientation.w != 0 || orientation.z != 0
                          ? quat_unit((dem_quat){orientation.w, 0, 0, orientation.z})
                          : (dem_quat){1, 0, 0, 0};
    dem_vec3 a = quat_rotate(orientation, v3(trial->scale, 0, 0)), b = quat_rotate(orientation, v3(0, trial->scale, 0));
    dem_vec3 c = quat_rotate(orientation, v3(0, 0, trial->scale));
    trial->orientation = orientation;
    trial->count = shape->ball_count;
    trial->low = trial->high = v3(0, 0, 0);
    for (size_t i = 0; i < trial->count; i++) {
        dem_vec3 u = shape->balls[i].centre;
        double r = shape->balls[i].radius * trial->scale;
        u = v3_along(v3_along(v3_scale(a, u.x), u.y, b), u.z, c);
        trial->balls[i] = (dem_ball){u, r};
        trial->low = v3_min(trial->low, v3(u.x - r, u.y - r, u.z - r));
        trial->high = v3_max(trial->high, v3(u.x + r, u.y + r, u.z + r));
    }
}

dem_vec3 dem_room_wrapped(const dem_room *room, dem_vec3 position)
{
    position = room_point(room, position);
    for (int k = 0; k < 3; k++) {
        if (!room->periodic[k])
            continue;
        double low = v3_get(room->origin, k), period = v3_get(room->period, k), x = v3_get(position, k) - low;
        x -= floor(x / period) * period;
        v3_set(&position, k, low + x < low + period ? low + x : low);
    }
    return position;
}

// the cell of a position along one axis, counted on beyond the ends of a periodic one
static int32_t cell_at(const dem_room *room, const dem_room_grid *g, double x, int axis)
{
    double at = floor((x - v3_get(room->origin, axis)) / g->size[axis]);
    if (!room->periodic[axis])
        at = fmin(fmax(at, 0), g->count[axis] - 1);
    return (int32_t)at;
}

static uint32_t *cell_of(const dem_room *room, uint32_t grid, dem_vec3 position)
{
    const dem_room_grid *g = &room->grids[grid];
    size_t at = 0;
    for (int k = 2; k >= 0; k--) {
        int32_t i = cell_at(room, g, v3_get(position, k), k);
        // rounding may put the very end of a period behind the last cell
        i = i < 0 ? 0 : i >= g->count[k] ? g->count[k] - 1 : i;
        at = at * (size_t)g->count[k] + (size_t)i;
    }
    return &g->cells[at];
}

uint32_t dem_room_add(dem_room *room, const dem_room_trial *trial, dem_vec3 position)
{
    size_t capacity = room->capacity;
    if (!dem_grow(&room->bodies, &capacity, room->count, sizeof *room->bodies) ||
        !dem_grow(&room->poses, &room->capacity, room->count, sizeof *room->poses)) {
        room->failed = true;
        return DEM_ROOM_NONE;
    }
    position = dem_room_wrapped(room, position);
    uint32_t index = (uint32_t)room->count++, *cell = cell_of(room, trial->grid, position);
    room->bodies[index] = (dem_room_body){position, trial->radius, trial->core, *cell, trial->shape};
    room->poses[index] = (dem_room_pose){trial->orientation, trial->scale, trial->grid};
    *cell = index;
    room->grids[trial->grid].held++;
    return index;
}

void dem_room_move(dem_room *room, uint32_t body, const dem_room_trial *trial, dem_vec3 position)
{
    dem_room_body *b = &room->bodies[body];
    uint32_t grid = room->poses[body].grid, *link = cell_of(room, grid, b->position);
    while (*link != body)
        link = &room->bodies[*link].next;
    *link = b->next;
    position = dem_room_wrapped(room, position);
    uint32_t *cell = cell_of(room, grid, position);
    *b = (dem_room_body){position, trial->radius, trial->core, *cell, trial->shape};
    room->poses[body] = (dem_room_pose){trial->orientation, trial->scale, grid};
    *cell = body;
}

bool dem_room_inside(const dem_room *room, const dem_room_trial *trial, dem_vec3 position)
{
    for (int k = 0; k < (room->flat ? 2 : 3); k++) {
        double x = v3_get(position, k);
        if (!room->spans[k] && (x + v3_get(trial->low, k) < v3_get(room->low, k) + room->rounding ||
                                x + v3_get(trial->high, k) > v3_get(room->high, k) - room->rounding))
            return false;
    }
    return true;
}

bool dem_room_range(const dem_room *room, const dem_room_trial *trial, dem_vec3 *low, dem_vec3 *high)
{
    *low = v3_sub(room->low, trial->low);
    *high = v3_sub(room->high, trial->high);
    if (room->flat)
        low->z = high->z = room_point(room, *low).z;
    for (int k = 0; k < (room->flat ? 2 : 3); k++) {
        double margin = 2 * room->rounding;
        v3_set(low, k, room->spans[k] ? v3_get(room->low, k) : v3_get(*low, k) + margin);
        v3_set(high, k, room->spans[k] ? v3_get(room->high, k) : v3_get(*high, k) - margin);
        if (!(v3_get(*low, k) <= v3_get(*high, k)))
            return false;
    }
    return true;
}
