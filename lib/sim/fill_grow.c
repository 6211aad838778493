// Bodies that find no room are placed as small as it takes and grow, while all bodies of the fill are moved about at
// random without ever overlapping (Metropolis et al. 1953; growth after Lubachevsky & Stillinger 1990).
#include <stdlib.h>

#include "base/memory.h"
#include "sim/fill_stages.h"

enum {
    MOST_SWEEPS = 2000,
    MOST_JUMPS = 100,  // of a body in one sweep
    WATCHED = 20,      // sweeps, and a quarter of all so far, in which something must have grown
};
// share of what is missing that must have grown in them
static const double PROGRESS = 0.1;

typedef struct growth {
    dem_filling *f;
    double *sizes;  // of the bodies, of their full size
    double step;    // of a move, of the radius
    size_t moved, tried;
    dem_random r;
} growth;

// the trial becomes the body at a part of its size
static void take_part(dem_filling *f, size_t body, double size)
{
    dem_fill_take(f, body);
    uint32_t grid = f->trial.grid;
    dem_room_take(f->room, &f->trial, f->trial.shape, size == 1 ? f->trial.scale : f->trial.scale * size);
    // it stays in the grid it will be in
    f->trial.grid = grid;
}

// places the next body in the size that the place allows
static dem_filled insert(growth *g)
{
    dem_filling *f = g->f;
    size_t body = f->placed;
    for (double size = 1; size > 0.02; size *= 0.97) {
        dem_vec3 low, high;
        dem_room_sight sight;
        if (dem_fill_stop(f))
            return DEM_FILL_STOPPED;
        take_part(f, body, size);
        dem_room_turn(f->room, &f->trial, fill_orientation(&g->r));
        if (!dem_room_range(f->room, &f->trial, &low, &high))
            continue;
        dem_vec3 position = fill_point(&g->r, low, high);
        if (dem_fill_try(f, &g->r, position, &sight)) {
            size_t done = f->done;
            bool put = dem_fill_put(f, position);
            g->sizes[body] = size;
            f->done = done;  // not in full size
            return put ? DEM_FILLED : DEM_FILL_NO_MEMORY;
        }
    }
    return f->room->failed ? DEM_FILL_NO_MEMORY : DEM_FILL_FULL;
}

// whether the trial may take the place of the body
static bool replaces(dem_filling *f, size_t body, dem_vec3 position)
{
    if (!dem_room_inside(f->room, &f->trial, position))
        return false;
    dem_room_sight sight = dem_room_look(f->room, &f->trial, position, f->held[body]);
    if (sight == DEM_ROOM_BLOCKED || (sight == DEM_ROOM_NEAR && !dem_room_fits(f->room, &f->trial, position)))
        return false;
    dem_room_move(f->room, f->held[body], &f->trial, position);
    return true;
}

static void move(growth *g, size_t body)
{
    dem_filling *f = g->f;
    dem_vec3 position = f->room->bodies[f->held[body]].position;
    dem_quat q = f->room->poses[f->held[body]].orientation;
    take_part(f, body, g->sizes[body]);
    double step = g->step * f->trial.radius;
    dem_vec3 to = fill_point(&g->r, v3_sub(position, v3(step, step, step)), v3_add(position, v3(step, step, step)));
    if (f->trial.core < f->trial.radius) {
        dem_quat by = fill_orientation(&g->r);
        double s = g->step;
        q = quat_unit((dem_quat){q.w + s * by.w, q.x + s * by.x, q.y + s * by.y, q.z + s * by.z});
    }
    dem_room_turn(f->room, &f->trial, q);
    g->moved += replaces(f, body, to);
    g->tried++;
}

static void enlarge(growth *g, size_t body)
{
    dem_filling *f = g->f;
    uint32_t held = f->held[body];
    for (double by = 0.3; by > 1e-4 && g->sizes[body] < 1; by /= 3) {
        double size = fmin(1, g->sizes[body] * (1 + by));
        take_part(f, body, size);
        dem_room_turn(f->room, &f->trial, f->room->poses[held].orientation);
        if (replaces(f, body, f->room->bodies[held].position)) {
            g->sizes[body] = size;
            return;
        }
    }
}

// looks for a place elsewhere that lets a body grow
static void jump(growth *g, size_t body, size_t trials)
{
    dem_filling *f = g->f;
    for (size_t i = 0; i < trials && g->sizes[body] < 1; i++) {
        double size = fmin(1, g->sizes[body] * 1.03);
        dem_vec3 low, high;
        take_part(f, body, size);
        dem_room_turn(f->room, &f->trial, fill_orientation(&g->r));
        if (dem_room_range(f->room, &f->trial, &low, &high) && replaces(f, body, fill_point(&g->r, low, high)))
            g->sizes[body] = size;
    }
}

static dem_filled sweep(growth *g)
{
    g->moved = g->tried = 0;
    // jumps cost about as much as the moves, so the fewer grow the more they can try
    size_t jumps = g->f->count / (g->f->count - g->f->done);
    jumps = jumps > MOST_JUMPS ? MOST_JUMPS : jumps;
    for (size_t i = 0; i < g->f->count; i++) {
        if (dem_fill_stop(g->f))
            return DEM_FILL_STOPPED;
        move(g, i);
        enlarge(g, i);
        jump(g, i, jumps);
        if (g->f->room->failed)
            return DEM_FILL_NO_MEMORY;
    }
    g->step = fmin(fmax(g->step * (5 * g->moved > 2 * g->tried ? 1.1 : 0.9), 1e-4), 1);
    return DEM_FILLED;
}

// counts the bodies that have grown up; the size that the others lack
static double missing(const growth *g)
{
    double sum = 0;
    g->f->done = 0;
    for (size_t i = 0; i < g->f->count; i++) {
        sum += 1 - g->sizes[i];
        g->f->done += g->sizes[i] == 1;
    }
    return sum;
}

static dem_filled shake(growth *g)
{
    double before = missing(g);
    for (int i = 1, next = WATCHED; i <= MOST_SWEEPS; i++) {
        dem_filled result = sweep(g);
        double now = missing(g);
        if (result != DEM_FILLED || g->f->done == g->f->count)
            return result;
        if (i == next) {
            if (now > (1 - PROGRESS) * before)
                break;
            before = now;
            next = i + WATCHED + i / 4;
        }
    }
    return DEM_FILL_FULL;
}

dem_filled dem_fill_grow(dem_filling *f, double *volume)
{
    growth g = {.f = f, .step = 0.1, .r = random_stream(f->fill->seed, UINT64_MAX / 2)};
    *volume = 0;
    g.sizes = dem_alloc(f->count, sizeof *g.sizes);
    if (!g.sizes)
        return DEM_FILL_NO_MEMORY;
    for (size_t i = 0; i < f->count; i++)
        g.sizes[i] = 1;
    dem_filled result = DEM_FILLED;
    while (f->placed < f->count && result == DEM_FILLED)
        result = insert(&g);
    if (result == DEM_FILLED)
        result = shake(&g);
    for (size_t i = 0; i < f->placed; i++)
        *volume += g.sizes[i] == 1 ? dem_fill_volume(f, i) : 0;
    free(g.sizes);
    return result;
}
