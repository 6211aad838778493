#include "sim/fill.h"

#include <stdlib.h>

#include "base/memory.h"
#include "sim/fill_stages.h"

enum {
    POSITIONS = 200,   // tried at random before a body is looked for in the voids
    ORIENTATIONS = 4,  // tried at one position
    REPORT = 1 << 12,  // trials between two calls of the progress
};
// no packing of equal balls is denser
static const double DENSEST = 0.7405, DENSEST_FLAT = 0.9069;

bool dem_fill_stop(dem_filling *f)
{
    if (f->turns++ % REPORT != 0)
        return false;
    return dem_progress(f->ctx, "placing", (double)f->done / (double)f->count);
}

double dem_fill_volume(const dem_filling *f, size_t body)
{
    const dem_fill_draw *draw = &f->draws[f->order[body]];
    const dem_fill_shape *shape = &f->room->shapes[draw->shape];
    return shape->volume * fill_bulk(shape, draw->scale);
}

void dem_fill_take(dem_filling *f, size_t body)
{
    const dem_fill_draw *draw = &f->draws[f->order[body]];
    dem_room_take(f->room, &f->trial, draw->shape, draw->scale);
}

bool dem_fill_try(dem_filling *f, dem_random *r, dem_vec3 position, dem_room_sight *sight)
{
    dem_room_trial *trial = &f->trial;
    *sight = dem_room_look(f->room, trial, position, DEM_ROOM_NONE);
    if (*sight != DEM_ROOM_NEAR)
        return *sight == DEM_ROOM_FREE;
    if (dem_room_fits(f->room, trial, position))
        return true;
    // a ball about its centre is the same in every orientation
    for (int i = 1; i < ORIENTATIONS && trial->core < trial->radius; i++) {
        dem_room_turn(f->room, trial, fill_orientation(r));
        if (dem_room_inside(f->room, trial, position) && dem_room_fits(f->room, trial, position))
            return true;
    }
    return false;
}

bool dem_fill_put(dem_filling *f, dem_vec3 position)
{
    uint32_t at = dem_room_add(f->room, &f->trial, position);
    if (at == DEM_ROOM_NONE)
        return false;
    f->held[f->placed++] = at;
    f->done = f->placed;
    return true;
}

dem_filled dem_fill_random(dem_filling *f)
{
    while (f->placed < f->count) {
        dem_random r = random_stream(f->fill->seed, f->order[f->placed]);
        size_t before = f->placed;
        dem_fill_take(f, f->placed);
        for (int i = 0; i < POSITIONS && f->placed == before; i++) {
            dem_vec3 low, high;
            dem_room_sight sight;
            if (dem_fill_stop(f))
                return DEM_FILL_STOPPED;
            dem_room_turn(f->room, &f->trial, fill_orientation(&r));
            if (!dem_room_range(f->room, &f->trial, &low, &high))
                continue;
            dem_vec3 position = fill_point(&r, low, high);
            if (dem_fill_try(f, &r, position, &sight) && !dem_fill_put(f, position))
                return DEM_FILL_NO_MEMORY;
        }
        if (f->placed == before)
            return f->room->failed ? DEM_FILL_NO_MEMORY : DEM_FILL_FULL;
    }
    return DEM_FILLED;
}

// a draw with its size, to be sorted
typedef struct ranked {
    double radius;
    uint32_t draw;
} ranked;

static int larger_first(const void *a, const void *b)
{
    const ranked *x = a, *y = b;
    if (x->radius != y->radius)
        return x->radius > y->radius ? -1 : 1;
    return x->draw < y->draw ? -1 : 1;
}

// everything of a fill that is allocated
typedef struct work {
    dem_fill_draw *draws;
    double *radii;  // of the draws [m]
    ranked *ranks;
    uint32_t *order, *held;
    dem_room room;
    dem_filling f;
    size_t fitted;   // bodies, of the best stage
    double reached;  // their volume [m^3]
} work;

static void release(work *w)
{
    free(w->draws);
    free(w->radii);
    free(w->ranks);
    free(w->order);
    free(w->held);
    free(w->f.trial.balls);
    dem_room_release(&w->room);
}

static dem_status sort_draws(work *w, const dem_fill_shape *shapes, size_t shape_count, size_t count, dem_error *error)
{
    size_t balls = 1;
    for (size_t i = 0; i < shape_count; i++)
        balls = shapes[i].ball_count > balls ? shapes[i].ball_count : balls;
    w->radii = dem_alloc(count, sizeof *w->radii);
    w->ranks = dem_alloc(count, sizeof *w->ranks);
    w->order = dem_alloc(count, sizeof *w->order);
    w->held = dem_alloc(count, sizeof *w->held);
    w->f.trial.balls = dem_alloc(balls, sizeof *w->f.trial.balls);
    if (!w->radii || !w->ranks || !w->order || !w->held || !w->f.trial.balls)
        return dem_fail_memory(error);
    for (size_t i = 0; i < count; i++) {
        w->radii[i] = shapes[w->draws[i].shape].radius_out * w->draws[i].scale;
        w->ranks[i] = (ranked){w->radii[i], (uint32_t)i};
    }
    qsort(w->ranks, count, sizeof *w->ranks, larger_first);
    for (size_t i = 0; i < count; i++)
        w->order[i] = w->ranks[i].draw;
    w->f.draws = w->draws;
    w->f.order = w->order;
    w->f.held = w->held;
    return DEM_OK;
}

// remembers the best
static void note(work *w, size_t fitted, double volume)
{
    if (fitted > w->fitted) {
        w->fitted = fitted;
        w->reached = volume;
    }
}

static void note_placed(work *w)
{
    double volume = 0;
    for (size_t i = 0; i < w->f.placed; i++)
        volume += dem_fill_volume(&w->f, i);
    note(w, w->f.placed, volume);
}

static dem_status stages(work *w, const dem_fill_shape *shapes, size_t shape_count, const dem_fill_obstacles *there,
                         dem_filled *result, dem_error *error)
{
    dem_filling *f = &w->f;
    double solids = 0;
    for (size_t i = 0; i < f->count; i++)
        solids += dem_fill_volume(f, i);
    bool hopeless = solids > (there->flat ? DENSEST_FLAT : DENSEST) * dem_fill_box_volume(f->fill);
    *result = dem_fill_random(f);
    if (*result == DEM_FILL_FULL)
        *result = dem_fill_voids(f);
    note_placed(w);
    // where not even one is placed nothing could give way to it
    if (*result != DEM_FILL_FULL || hopeless || f->placed == 0)
        return DEM_OK;
    double volume;
    *result = dem_fill_grow(f, &volume);
    note(w, f->done, volume);
    if (*result != DEM_FILL_FULL)
        return DEM_OK;
    dem_room_release(&w->room);
    DEM_TRY(dem_room_create(&w->room, f->fill, shapes, shape_count, there, w->radii, f->count, error));
    f->placed = f->done = 0;
    *result = dem_fill_lattice(f);
    note_placed(w);
    if (*result == DEM_FILLED)
        dem_log(f->ctx, DEM_LOG_WARNING,
                "fill: too dense to be placed at random; the bodies stand on a lattice with random orientations");
    return DEM_OK;
}

static dem_status refuse(const work *w, dem_error *error)
{
    const dem_fill_def *fill = w->f.fill;
    const char *advice = "use a larger box or a smaller gap, or fill a taller box and let it settle";
    if (w->fitted == 0)
        return dem_fail(error, DEM_FAILED,
                        "fill: not even the largest body, %.3g m across, found room in the box; use a larger box or "
                        "smaller bodies",
                        2 * w->radii[w->order[0]]);
    double ratio = dem_fill_box_volume(fill) / w->reached - 1;
    if (fill->count > 0)
        return dem_fail(error, DEM_FAILED, "fill: only %zu of %zu bodies fit (void ratio %.3g); lower the count, %s",
                        w->fitted, w->f.count, ratio, advice);
    return dem_fail(error, DEM_FAILED,
                    "fill: the void ratio of %.3g was not reached, %zu bodies came to %.3g; ask for a higher one, %s",
                    fill->void_ratio, w->fitted, ratio, advice);
}

// in the order they were drawn
static dem_status hand_over(work *w, dem_body_def **bodies, dem_error *error)
{
    // member by member, so that equal fills are equal bytes
    *bodies = dem_alloc_zero(w->f.count, sizeof **bodies);
    if (!*bodies)
        return dem_fail_memory(error);
    for (size_t i = 0; i < w->f.count; i++) {
        const dem_room_body *b = &w->room.bodies[w->held[i]];
        dem_body_def *body = &(*bodies)[w->order[i]];
        body->shape = b->shape;
        body->scale = w->draws[w->order[i]].scale;
        body->position = b->position;
        body->orientation = w->room.poses[w->held[i]].orientation;
        body->velocity = w->f.fill->velocity;
        body->hold = w->f.fill->hold;
    }
    return DEM_OK;
}

static dem_status fill_room(work *w, const dem_fill_shape *shapes, size_t shape_count, const dem_fill_obstacles *there,
                            dem_body_def **bodies, dem_error *error)
{
    dem_filled result;
    DEM_TRY(sort_draws(w, shapes, shape_count, w->f.count, error));
    DEM_TRY(dem_room_create(&w->room, w->f.fill, shapes, shape_count, there, w->radii, w->f.count, error));
    w->f.room = &w->room;
    DEM_TRY(stages(w, shapes, shape_count, there, &result, error));
    switch (result) {
    case DEM_FILLED:
        return hand_over(w, bodies, error);
    case DEM_FILL_STOPPED:
        return dem_fail(error, DEM_INTERRUPTED, "stopped while placing bodies");
    case DEM_FILL_NO_MEMORY:
        return dem_fail_memory(error);
    default:
        return refuse(w, error);
    }
}

dem_status dem_fill(const dem_ctx *ctx, const dem_fill_def *fill, const dem_fill_shape *shapes, size_t shape_count,
                    const dem_fill_obstacles *there, dem_body_def **bodies, size_t *count, dem_error *error)
{
    static const dem_fill_obstacles nothing = {0};
    work w = {.f = {.ctx = ctx, .fill = fill}};
    *bodies = NULL;
    *count = 0;
    DEM_TRY(dem_fill_draws(fill, shapes, shape_count, &w.draws, &w.f.count, error));
    dem_status status = fill_room(&w, shapes, shape_count, there ? there : &nothing, bodies, error);
    if (status == DEM_OK)
        *count = w.f.count;
    release(&w);
    return status;
}
