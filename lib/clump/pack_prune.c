#include "clump/pack_prune.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "clump/pack_connect.h"

static const double neighbourhood = 0.7;  // of a ball's radius: no second ball is removed this near in one go
static const double join_early = 1.3;     // springs are switched on this near to the final number

typedef struct cheapness {
    double cost;
    uint32_t ball;
} cheapness;

static int by_cost(const void *a, const void *b)
{
    const cheapness *x = a, *y = b;
    if (x->cost != y->cost)
        return x->cost < y->cost ? -1 : 1;
    return x->ball < y->ball ? -1 : 1;
}

static bool near_one_gone(const dem_pack_state *state, uint32_t ball, const uint32_t *gone, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (v3_distance(state->balls[gone[k]].centre, state->balls[ball].centre) <
            neighbourhood * state->balls[ball].radius)
            return true;
    return false;
}

dem_status dem_pack_prune(dem_packing *p, dem_pack_state *state, size_t count, double jitter, dem_error *error)
{
    DEM_TRY(dem_pack_removal_costs(p, state, error));
    cheapness *sorted = dem_alloc(state->count, sizeof *sorted);
    bool *marked = dem_alloc_zero(state->count, sizeof *marked);
    uint32_t *gone = p->order;
    size_t gone_count = 0;
    if (!sorted || !marked) {
        free(sorted);
        free(marked);
        return dem_fail_memory(error);
    }
    for (uint32_t i = 0; i < state->count; i++) {
        double factor = jitter > 0 ? 1 + jitter * (random_uniform(&p->random) - 0.5) : 1;
        sorted[i] = (cheapness){p->cost[i] * factor, i};
    }
    qsort(sorted, state->count, sizeof *sorted, by_cost);
    for (int pass = 0; pass < 2; pass++)
        for (size_t k = 0; k < state->count && gone_count < count; k++) {
            uint32_t i = sorted[k].ball;
            if (marked[i] || (pass == 0 && near_one_gone(state, i, gone, gone_count)))
                continue;
            marked[i] = true;
            gone[gone_count++] = i;
        }
    dem_pack_state_remove(state, marked);
    free(sorted);
    free(marked);
    return DEM_OK;
}

dem_status dem_pack_prune_to(dem_packing *p, dem_pack_state *state, size_t count, dem_error *error)
{
    double share = p->effort.prune_share, first = (double)state->count;
    while (state->count > count) {
        DEM_TRY(dem_pack_progress(p, log(first / (double)state->count) / log(first / (double)count), error));
        size_t step = (size_t)((double)state->count * share);
        step = step < 1 ? 1 : step > state->count - count ? state->count - count : step;
        if (p->connected && (double)state->count <= join_early * (double)count && !p->spring)
            p->spring = dem_pack_links(p, state->balls, state->count, dem_pack_overlap) > 0;
        DEM_TRY(dem_pack_prune(p, state, step, 0, error));
        DEM_TRY(dem_pack_relax(p, state, (dem_relax_options){p->effort.prune_iterations, 0.02, 2e-5}, error));
    }
    return DEM_OK;
}
