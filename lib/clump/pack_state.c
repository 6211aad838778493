#include <string.h>

#include "base/status.h"
#include "clump/packing.h"

static const double largest_ratio = 1.5, ratio_free = 0.06;  // radius against clearance, [-] and [d_eq]
static const double farthest_outside = 0.015;                // of a centre [d_eq]
static const double largest_radius = 0.6;                    // [d_eq]

dem_status dem_pack_state_init(dem_packing *p, dem_pack_state *state, dem_error *error)
{
    size_t samples = p->samples.block_count * DEM_BLOCK;
    *state = (dem_pack_state){.capacity = p->capacity};
    state->balls = dem_arena_take(&p->arena, p->capacity, sizeof *state->balls);
    state->clearances = dem_arena_take(&p->arena, p->capacity, sizeof *state->clearances);
    state->f = dem_arena_take(&p->arena, samples, sizeof *state->f);
    state->owner = dem_arena_take(&p->arena, samples, sizeof *state->owner);
    state->block_energy = dem_arena_take(&p->arena, p->samples.block_count, sizeof *state->block_energy);
    return p->arena.failed ? dem_fail_memory(error) : DEM_OK;
}

void dem_pack_state_copy(const dem_packing *p, const dem_pack_state *from, dem_pack_state *to)
{
    size_t samples = p->samples.block_count * DEM_BLOCK;
    to->count = from->count;
    to->energy = from->energy;
    memcpy(to->balls, from->balls, from->count * sizeof *to->balls);
    memcpy(to->clearances, from->clearances, from->count * sizeof *to->clearances);
    memcpy(to->f, from->f, samples * sizeof *to->f);
    memcpy(to->owner, from->owner, samples * sizeof *to->owner);
    memcpy(to->block_energy, from->block_energy, p->samples.block_count * sizeof *to->block_energy);
}

void dem_pack_state_add(dem_pack_state *state, dem_ball ball)
{
    DEM_ASSERT(state->count < state->capacity);
    state->clearances[state->count].distance = -1;
    state->balls[state->count++] = ball;
}

void dem_pack_state_remove(dem_pack_state *state, const bool *gone)
{
    size_t kept = 0;
    for (size_t i = 0; i < state->count; i++)
        if (!gone[i]) {
            state->balls[kept] = state->balls[i];
            state->clearances[kept++] = state->clearances[i];
        }
    state->count = kept;
}

// what the clearance known for a place not far away says about a ball
typedef enum verdict { REFUSED, ALLOWED, OPEN } verdict;

static verdict judge(dem_ball ball, const dem_clearance *known)
{
    if (known->distance < 0)
        return OPEN;
    double moved = v3_distance(ball.centre, known->at);
    double least = known->distance - moved, most = known->distance + moved;
    if (ball.radius > largest_ratio * most + ratio_free || (!known->inside && least > farthest_outside))
        return REFUSED;
    bool centre_good = (known->inside && least >= 0) || most <= farthest_outside;
    return centre_good && ball.radius <= largest_ratio * fmax(least, 0) + ratio_free ? ALLOWED : OPEN;
}

bool dem_pack_ball_allowed(const dem_packing *p, dem_ball ball, dem_clearance *clearance)
{
    if (!(ball.radius >= dem_pack_smallest_radius && ball.radius <= largest_radius))
        return false;
    verdict first = judge(ball, clearance);
    if (first != OPEN)
        return first == ALLOWED;
    double known = clearance->distance, limit = INFINITY;
    if (known >= 0)
        limit = (known + v3_distance(ball.centre, clearance->at)) * (1 + 1e-9) + 1e-9;
    clearance->distance = dem_tree_closest(&p->grain->tree, ball.centre, limit, NULL, NULL);
    clearance->at = ball.centre;
    clearance->inside = dem_tree_inside(&p->grain->tree, ball.centre);
    return judge(ball, clearance) == ALLOWED;
}
