#include "clump/pack_breathe.h"

#include "base/status.h"
#include "clump/pack_connect.h"
#include "clump/pack_prune.h"

enum { TRIES = 12 };

static const double largest_share = 0.05;  // of the balls exchanged in one breath, on average; twice that at most
static const double hopeless = 1.05;       // energy after a short relaxation, against the one to beat
static const double jitter = 0.6;          // of the removal costs

static double surface_energy(const dem_packing *p, const dem_pack_state *state)
{
    double total = 0;
    for (size_t b = 0; b < p->samples.surface_blocks; b++)
        total += state->block_energy[b];
    return total;
}

// a surface block drawn by its energy
static size_t draw_block(dem_packing *p, const dem_pack_state *state, double total)
{
    double mark = random_uniform(&p->random) * total;
    for (size_t b = 0; b < p->samples.surface_blocks; b++) {
        mark -= state->block_energy[b];
        if (mark < 0)
            return b;
    }
    return p->samples.surface_blocks - 1;
}

static bool out_of_reach(const dem_block_bound *bound, const float ball[4], float farther)
{
    float x = bound->x - ball[0], y = bound->y - ball[1], z = bound->z - ball[2];
    float reach = ball[3] + bound->radius + farther;
    return x * x + y * y + z * z > reach * reach;
}

static dem_charge block_charge(const dem_packing *p, size_t block)
{
    dem_charge charge = p->charge;
    charge.interior = block >= p->samples.surface_blocks;
    return charge;
}

// how far a sample may lie outside the union for a ball that does not reach its block to matter [d_eq]
static const float farthest_sample = 0.3f;

// by how much the energy would fall with one more ball
static double insertion_gain(const dem_packing *p, const dem_pack_state *state, dem_ball ball)
{
    double gain = 0;
    float columns[4] = {(float)ball.centre.x, (float)ball.centre.y, (float)ball.centre.z, (float)ball.radius};
    for (size_t b = 0; b < p->samples.block_count; b++) {
        float f[DEM_BLOCK];
        if (out_of_reach(&p->samples.bounds[b], columns, 0.08f))
            continue;
        dem_charge charge = block_charge(p, b);
        if (p->kernels->with_ball(&p->samples.blocks[b], columns, state->f + b * DEM_BLOCK, f))
            gain += state->block_energy[b] - (double)p->kernels->energy(&p->samples.blocks[b], f, &charge);
    }
    return gain;
}

static void take_in(dem_packing *p, dem_pack_state *state, dem_ball ball)
{
    float columns[4] = {(float)ball.centre.x, (float)ball.centre.y, (float)ball.centre.z, (float)ball.radius};
    for (size_t b = 0; b < p->samples.block_count; b++) {
        float f[DEM_BLOCK], *old = state->f + b * DEM_BLOCK;
        if (out_of_reach(&p->samples.bounds[b], columns, farthest_sample) ||
            !p->kernels->with_ball(&p->samples.blocks[b], columns, old, f))
            continue;
        for (int l = 0; l < DEM_BLOCK; l++)
            if (f[l] < old[l]) {
                old[l] = f[l];
                state->owner[b * DEM_BLOCK + (size_t)l] = (int32_t)state->count;
            }
        dem_charge charge = block_charge(p, b);
        double energy = (double)p->kernels->energy(&p->samples.blocks[b], f, &charge);
        state->energy += energy - state->block_energy[b];
        state->block_energy[b] = energy;
    }
    dem_pack_state_add(state, ball);
}

// balls that may be inserted, and what each would gain
typedef struct tries {
    const dem_packing *p;
    const dem_pack_state *state;
    dem_ball balls[TRIES];  // radius 0: none
    double gains[TRIES];
} tries;

static void draw_tries(dem_packing *p, tries *t)
{
    double total = surface_energy(p, t->state);
    for (int k = 0; k < TRIES; k++) {
        size_t b = draw_block(p, t->state, total);
        uint32_t first = p->candidates.at_block[b], number = p->candidates.at_block[b + 1] - first;
        t->balls[k].radius = 0;
        if (!number)
            continue;
        t->balls[k] = p->candidates.balls[first + random_below(&p->random, number)];
        t->balls[k].radius += p->inflations[random_below(&p->random, p->inflation_count)];
    }
}

static void try_one(void *user, int part)
{
    tries *t = user;
    t->gains[part] = t->balls[part].radius > 0 ? insertion_gain(t->p, t->state, t->balls[part]) : 0;
}

void dem_pack_insert(dem_packing *p, dem_pack_state *state, size_t count)
{
    tries t = {.p = p, .state = state};
    for (size_t k = 0; k < count && state->count < state->capacity; k++) {
        int best = 0;
        draw_tries(p, &t);
        dem_crew_run(p->crew, TRIES, try_one, &t);
        for (int i = 1; i < TRIES; i++)
            best = t.gains[i] > t.gains[best] ? i : best;
        if (t.gains[best] > 0)
            take_in(p, state, t.balls[best]);
    }
}

// from `state` to `p->moved`
static dem_status try_breath(dem_packing *p, const dem_pack_state *state, bool *better, dem_error *error)
{
    dem_pack_state *moved = &p->moved;
    const dem_relax_options brief = {6, 0.02, 2e-4}, briefer = {3, 0.02, 2e-4}, test = {5, 0.02, 2e-4}, full = {12, 0.02, 2e-4};
    double u = random_uniform(&p->random), v = random_uniform(&p->random);
    size_t target = state->count, count = 1 + (size_t)(u * v * 2 * largest_share * (double)target);
    *better = false;
    dem_pack_state_copy(p, state, moved);
    dem_pack_insert(p, moved, count);
    count = moved->count - target;
    if (count == 0)
        return DEM_OK;
    DEM_TRY(dem_pack_relax(p, moved, brief, error));
    size_t first = count > 3 ? count * 2 / 3 : count;
    DEM_TRY(dem_pack_prune(p, moved, first, jitter, error));
    if (count > first) {
        DEM_TRY(dem_pack_relax(p, moved, briefer, error));
        DEM_TRY(dem_pack_prune(p, moved, count - first, jitter, error));
    }
    DEM_TRY(dem_pack_relax(p, moved, test, error));
    if (moved->energy > hopeless * state->energy)
        return DEM_OK;
    DEM_TRY(dem_pack_relax(p, moved, full, error));
    *better = moved->energy < state->energy;
    return DEM_OK;
}

dem_status dem_pack_breathe(dem_packing *p, dem_pack_state *state, dem_error *error)
{
    bool better;
    DEM_TRY(try_breath(p, state, &better, error));
    if (better && p->connected)
        better = dem_pack_links(p, p->moved.balls, p->moved.count, dem_pack_overlap) == 0;
    if (better) {
        dem_pack_state old = *state;
        *state = p->moved;
        p->moved = old;
    }
    return DEM_OK;
}
