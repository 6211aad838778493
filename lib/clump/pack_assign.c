#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "clump/packing.h"

// Near lists take in balls this much farther than needed, so that they hold while balls move [d_eq].
static const double slack = 0.03;

enum { LISTED_TOGETHER = 8 };  // neighbouring blocks

void dem_ball_columns_set(dem_ball_columns *columns, const dem_ball *balls, size_t count)
{
    dem_ball_columns *c = columns;
    c->count = count;
    c->padded = (count + DEM_LANES - 1) / DEM_LANES * DEM_LANES;
    for (size_t i = 0; i < count; i++) {
        c->x[i] = (float)balls[i].centre.x;
        c->y[i] = (float)balls[i].centre.y;
        c->z[i] = (float)balls[i].centre.z;
        c->r[i] = (float)balls[i].radius;
    }
    for (size_t i = count; i < c->padded; i++) {
        c->x[i] = c->y[i] = c->z[i] = 1e9f;
        c->r[i] = 0;
    }
}

// room for one more list
static bool reserve_near(dem_pack_chunk *chunk)
{
    size_t needed = chunk->near_count + chunk->some.padded;
    if (needed <= chunk->near_capacity)
        return true;
    size_t capacity = needed + needed / 2;
    uint32_t *near = realloc(chunk->near, capacity * sizeof *near);
    if (near)
        chunk->near = near;
    float *least = realloc(chunk->near_least, capacity * sizeof *least);
    if (least)
        chunk->near_least = least;
    if (!near || !least)
        return false;
    chunk->near_capacity = capacity;
    return true;
}

// a ball around the bounds of some blocks
static dem_block_bound bound_all(const dem_block_bound *bounds, size_t count)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; k < count; k++) {
        const float at[3] = {bounds[k].x, bounds[k].y, bounds[k].z};
        for (int a = 0; a < 3; a++) {
            low[a] = fminf(low[a], at[a]);
            high[a] = fmaxf(high[a], at[a]);
        }
    }
    dem_block_bound all = {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2, 0};
    for (size_t k = 0; k < count; k++) {
        float x = bounds[k].x - all.x, y = bounds[k].y - all.y, z = bounds[k].z - all.z;
        all.radius = fmaxf(all.radius, sqrtf(x * x + y * y + z * z) + bounds[k].radius);
    }
    all.radius *= 1 + 1e-5f;  // rounding
    return all;
}

// of the balls near `LISTED_TOGETHER` neighbouring blocks those near each
static void list_near(dem_packing *p, dem_pack_chunk *chunk)
{
    chunk->near_count = 0;
    for (size_t first = chunk->begin; first < chunk->end; first += LISTED_TOGETHER) {
        size_t count = chunk->end - first < LISTED_TOGETHER ? chunk->end - first : LISTED_TOGETHER;
        dem_block_bound all = bound_all(p->samples.bounds + first, count);
        p->kernels->gather_near(&p->columns, &all, (float)p->near_slack, &chunk->work, &chunk->some, chunk->ids);
        for (size_t b = first; b < first + count; b++) {
            if (!reserve_near(chunk)) {
                chunk->failed = true;
                return;
            }
            size_t at = chunk->near_count;
            p->near_begin[b] = at;
            p->near_size[b] = (uint32_t)p->kernels->list_near(&chunk->some, &p->samples.bounds[b], (float)p->near_slack,
                                                              &chunk->work, chunk->near + at, chunk->near_least + at);
            for (size_t k = at; k < at + p->near_size[b]; k++)
                chunk->near[k] = chunk->ids[chunk->near[k]];
            chunk->near_count += p->near_size[b];
        }
    }
}

static dem_near_list near_list(const dem_packing *p, const dem_pack_chunk *chunk, size_t block)
{
    static const float rounding = 1e-6f;
    size_t at = p->near_begin[block];
    bool interior = block >= p->samples.surface_blocks;  // covered is covered
    return (dem_near_list){.list = chunk->near + at, .least = chunk->near_least + at, .count = p->near_size[block],
                           .reach = p->samples.bounds[block].radius + (float)p->near_moved + rounding,
                           .enough = interior ? 0 : -INFINITY};
}

static dem_charge charge_of(const dem_packing *p, size_t block)
{
    dem_charge charge = p->charge;
    charge.interior = block >= p->samples.surface_blocks;
    return charge;
}

static void assign_chunk(dem_packing *p, dem_pack_chunk *chunk, dem_pack_state *state)
{
    for (size_t b = chunk->begin; b < chunk->end; b++) {
        float *f = state->f + b * DEM_BLOCK;
        dem_near_list near = near_list(p, chunk, b);
        dem_charge charge = charge_of(p, b);
        p->kernels->nearest(&p->samples.blocks[b], &p->columns, &near, f, state->owner + b * DEM_BLOCK);
        state->block_energy[b] = p->kernels->energy(&p->samples.blocks[b], f, &charge);
    }
}

static void sum_energy(const dem_packing *p, dem_pack_state *state)
{
    state->energy = 0;
    for (size_t b = 0; b < p->samples.block_count; b++)
        state->energy += state->block_energy[b];
}

static bool any_failed(const dem_packing *p)
{
    for (int k = 0; k < DEM_CHUNKS; k++)
        if (p->chunks[k].failed)
            return true;
    return false;
}

// what the crew shares: chunks of one state
typedef struct shared {
    dem_packing *p;
    dem_pack_state *state;
    bool make_lists;
} shared;

static void assign_part(void *user, int part)
{
    const shared *s = user;
    dem_pack_chunk *chunk = &s->p->chunks[part];
    if (s->make_lists)
        list_near(s->p, chunk);
    if (!chunk->failed)
        assign_chunk(s->p, chunk, s->state);
}

// lists will be made of the balls as they are now
static void begin_lists(dem_packing *p, const dem_pack_state *state)
{
    p->near_slack = slack;
    p->near_moved = 0;
    p->near_balls = state->count;
    memcpy(p->near_at, state->balls, state->count * sizeof *p->near_at);
}

// Do the lists hold, of balls of the same numbers? Sets p->near_moved.
static bool lists_hold(dem_packing *p, const dem_pack_state *state)
{
    double farthest = 0;
    for (size_t i = 0; i < state->count; i++) {
        const dem_ball *now = &state->balls[i], *then = &p->near_at[i];
        farthest = fmax(farthest, v3_distance(now->centre, then->centre) + fabs(now->radius - then->radius));
    }
    p->near_moved = farthest;
    return 2 * farthest <= p->near_slack * (1 - 1e-3);
}

static dem_status assign(dem_packing *p, dem_pack_state *state, bool make_lists, dem_error *error)
{
    DEM_ASSERT(state->count > 0);
    dem_ball_columns_set(&p->columns, state->balls, state->count);
    if (make_lists)
        begin_lists(p, state);
    dem_crew_run(p->crew, DEM_CHUNKS, assign_part, &(shared){p, state, make_lists});
    if (any_failed(p))
        return dem_fail_memory(error);
    sum_energy(p, state);
    return DEM_OK;
}

dem_status dem_pack_assign(dem_packing *p, dem_pack_state *state, dem_error *error)
{
    return assign(p, state, true, error);
}

dem_status dem_pack_assign_moved(dem_packing *p, dem_pack_state *state, dem_error *error)
{
    return assign(p, state, !lists_hold(p, state), error);
}

// what the samples of a chunk would be charged more without their nearest ball
static void charge_removal(dem_packing *p, dem_pack_chunk *chunk, dem_pack_state *state)
{
    for (size_t b = chunk->begin; b < chunk->end; b++) {
        const dem_sample_block *block = &p->samples.blocks[b];
        float *f = state->f + b * DEM_BLOCK, *rise = p->rise + b * DEM_BLOCK, now[DEM_BLOCK], then[DEM_BLOCK];
        dem_near_list near = near_list(p, chunk, b);
        dem_charge charge = charge_of(p, b);
        p->kernels->nearest_two(block, &p->columns, &near, f, state->owner + b * DEM_BLOCK, then);
        p->kernels->charges(block, then, &charge, rise);
        p->kernels->charges(block, f, &charge, now);
        for (int l = 0; l < DEM_BLOCK; l++)
            rise[l] -= now[l];
    }
}

static void removal_part(void *user, int part)
{
    const shared *s = user;
    dem_pack_chunk *chunk = &s->p->chunks[part];
    if (s->make_lists)
        list_near(s->p, chunk);
    if (!chunk->failed)
        charge_removal(s->p, chunk, s->state);
}

dem_status dem_pack_removal_costs(dem_packing *p, dem_pack_state *state, dem_error *error)
{
    DEM_ASSERT(state->count > 0);
    dem_ball_columns_set(&p->columns, state->balls, state->count);
    bool make_lists = p->near_balls != state->count || !lists_hold(p, state);
    if (make_lists)
        begin_lists(p, state);
    dem_crew_run(p->crew, DEM_CHUNKS, removal_part, &(shared){p, state, make_lists});
    if (any_failed(p))
        return dem_fail_memory(error);
    for (size_t i = 0; i < state->count; i++)
        p->cost[i] = 0;
    for (size_t i = 0; i < p->samples.block_count * DEM_BLOCK; i++)
        p->cost[state->owner[i]] += p->rise[i];
    return DEM_OK;
}

double dem_pack_gap_estimate(const dem_packing *p, const dem_pack_state *state)
{
    double difference = 0, outside = 0;
    for (size_t b = 0; b < p->samples.surface_blocks; b++)
        for (int l = 0; l < DEM_BLOCK; l++) {
            double f = state->f[b * DEM_BLOCK + (size_t)l], w = p->samples.blocks[b].weight[l];
            difference += w * fabs(f);
            outside += f < 0 ? -w * f : 0;
        }
    return difference / (p->grain->moments.volume + outside);
}
