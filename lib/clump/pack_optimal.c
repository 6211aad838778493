// The stages of the default packer. Greedy choice of medial balls, pruned and relaxed on surface samples, gives the
// places; descent on the true symmetric difference gives the fit; moving on the constraint surface gives the moments.
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "clump/pack.h"
#include "clump/pack_breathe.h"
#include "clump/pack_connect.h"
#include "clump/pack_moments.h"
#include "clump/pack_polish.h"
#include "clump/pack_prune.h"

enum { START_FACTOR = 2 };     // balls under way at first, per ball asked for
enum { POLISH_STEPS = 100 };   // far more than it takes
enum { PROJECTIONS = 3 };      // with descent along the constraints in between

static const dem_relax_options settle = {40, 0.02, 2e-5}, settle_linear = {40, 0.05, 1e-5};

// what exact moments may cost: gap <= free gap * (1 + share) + part
static const double dearest_share = 0.25, dearest_part = 0.03;

typedef struct packing_run {
    dem_packing *p;
    dem_pack_state state;
    dem_lines lines;
    dem_moment_rows rows;
    dem_line_volumes volumes;   // of the state
    dem_moments_kept met;
} packing_run;

// the ball to fall back on where nothing was found worth its place
static dem_ball plain_ball(const dem_packing *p)
{
    dem_ball best = {.radius = 0};
    for (size_t i = 0; i < p->candidates.count; i++)
        if (p->candidates.balls[i].radius > best.radius)
            best = p->candidates.balls[i];
    return best.radius > 0 ? best : (dem_ball){v3(0, 0, 0), 0.1};
}

// inserts and relaxes until there are `count` balls or none helps
static dem_status grow_to(dem_packing *p, dem_pack_state *state, size_t count, dem_error *error)
{
    while (state->count < count) {
        size_t before = state->count, some = 1 + before / 4;
        DEM_TRY(dem_pack_assign(p, state, error));
        dem_pack_insert(p, state, some < count - before ? some : count - before);
        if (state->count == before)
            break;
        DEM_TRY(dem_pack_relax(p, state, (dem_relax_options){10, 0.02, 2e-4}, error));
    }
    return DEM_OK;
}

static dem_status place(dem_packing *p, dem_pack_state *state, dem_error *error)
{
    size_t wanted = p->options->spheres;
    DEM_TRY(dem_candidates_greedy(&p->candidates, &p->lattice, p->kernels, p->inflations, p->inflation_count,
                                  START_FACTOR * wanted, 0, p->threads, state->balls, &state->count, error));
    for (size_t i = 0; i < state->count; i++)
        state->clearances[i].distance = -1;
    if (state->count == 0)
        dem_pack_state_add(state, plain_ball(p));
    DEM_TRY(dem_pack_relax(p, state, (dem_relax_options){15, 0.02, 2e-5}, error));
    DEM_TRY(grow_to(p, state, wanted, error));
    DEM_TRY(dem_pack_prune_to(p, state, wanted, error));
    DEM_TRY(dem_pack_relax(p, state, settle, error));
    return dem_pack_join(p, state, error);
}

static dem_status measure(packing_run *run, dem_error *error)
{
    dem_ball_columns_set(&run->p->columns, run->state.balls, run->state.count);
    return dem_lines_measure(&run->lines, &run->p->columns, NULL, &run->volumes, error);
}

static dem_status polish(packing_run *run, size_t tangent_count, dem_error *error)
{
    dem_polish_options options = {.iterations = getenv("PI")?atoi(getenv("PI")):POLISH_STEPS, .tangent_count = tangent_count};
    for (size_t k = 0; k < tangent_count; k++)
        options.tangent[k] = run->rows.rows[k];
    return dem_pack_polish(run->p, &run->lines, &run->state, options, &run->volumes, error);
}

// balls without exposed surface, removed; returns how many
static dem_status drop_hidden(packing_run *run, size_t *dropped, dem_error *error)
{
    dem_pack_state *state = &run->state;
    bool *gone = dem_alloc_zero(state->count, sizeof *gone);
    if (!gone)
        return dem_fail_memory(error);
    size_t before = state->count;
    dem_status status = dem_moment_rows_set(run->p, state, 1, &run->rows, error);
    for (size_t i = 0; i < state->count && status == DEM_OK; i++)
        gone[i] = run->rows.rows[0][i][3] <= 0;
    if (status == DEM_OK)
        dem_pack_state_remove(state, gone);
    *dropped = before - state->count;
    free(gone);
    return status;
}

// hidden balls are spent again where the error is worst
static dem_status respend(packing_run *run, dem_error *error)
{
    for (int k = 0; k < 2; k++) {
        size_t dropped, wanted = run->p->options->spheres;
        DEM_TRY(drop_hidden(run, &dropped, error));
        if (!dropped)
            break;
        DEM_TRY(grow_to(run->p, &run->state, wanted, error));
        DEM_TRY(dem_pack_join(run->p, &run->state, error));
        DEM_TRY(polish(run, 0, error));
    }
    return DEM_OK;
}

static void take_balls(const dem_pack_state *from, dem_pack_state *to)
{
    to->count = from->count;
    memcpy(to->balls, from->balls, from->count * sizeof *to->balls);
    memcpy(to->clearances, from->clearances, from->count * sizeof *to->clearances);
}

// projects on the first `kept` moments and descends along them in turn; leaves the balls as they were unless they can
// be met at a fair price
static dem_status meet_moments(packing_run *run, size_t kept, bool *met, dem_error *error)
{
    dem_packing *p = run->p;
    dem_pack_state *free_state = &p->moved;
    dem_line_volumes free_volumes = run->volumes;
    take_balls(&run->state, free_state);
    for (int k = 0; k < PROJECTIONS; k++) {
        DEM_TRY(dem_pack_project(p, &run->state, kept, &run->rows, met, error));
        DEM_TRY(measure(run, error));
        if (!*met || k + 1 == PROJECTIONS)
            break;
        DEM_TRY(polish(run, kept, error));
    }
    if (*met && run->volumes.gap <= free_volumes.gap * (1 + dearest_share) + dearest_part)
        return DEM_OK;
    *met = false;
    take_balls(free_state, &run->state);
    run->volumes = free_volumes;
    return DEM_OK;
}

static dem_status keep_moments(packing_run *run, dem_error *error)
{
    dem_moments_kept wanted = run->p->options->moments;
    bool met = false;
    if (wanted == DEM_MOMENTS_EXACT) {
        DEM_TRY(meet_moments(run, DEM_MOMENT_COUNT, &met, error));
        if (met)
            run->met = DEM_MOMENTS_EXACT;
        else
            dem_log(run->p->ctx, DEM_LOG_WARNING, "%zu spheres cannot have the grain's inertia at a fair price; its volume "
                    "and centre are kept; use more spheres", run->state.count);
    }
    if (!met && wanted != DEM_MOMENTS_FREE) {
        DEM_TRY(meet_moments(run, 4, &met, error));
        if (met)
            run->met = DEM_MOMENTS_VOLUME;
    }
    return DEM_OK;
}

// stages that keep the moments or the gap may have pulled pieces apart
static dem_status rejoin(packing_run *run, dem_error *error)
{
    dem_packing *p = run->p;
    size_t kept = run->met == DEM_MOMENTS_EXACT ? DEM_MOMENT_COUNT : run->met == DEM_MOMENTS_VOLUME ? 4 : 0;
    for (int k = 0; k < 4; k++) {
        bool met;
        if (!dem_pack_close(p, &run->state) || !kept)
            break;
        DEM_TRY(dem_pack_project(p, &run->state, kept, &run->rows, &met, error));
    }
    dem_pack_close(p, &run->state);
    return DEM_OK;
}

static dem_status hand_over(packing_run *run, dem_pack *pack, dem_error *error)
{
    const dem_pack_state *state = &run->state;
    static const size_t kept[] = {[DEM_MOMENTS_FREE] = 0, [DEM_MOMENTS_VOLUME] = 4, [DEM_MOMENTS_EXACT] = 10};
    size_t dropped;
    DEM_TRY(rejoin(run, error));
    DEM_TRY(drop_hidden(run, &dropped, error));
    DEM_TRY(measure(run, error));
    DEM_TRY(dem_moment_rows_set(run->p, state, kept[run->met], &run->rows, error));
    pack->balls = dem_alloc(state->count, sizeof *pack->balls);
    if (!pack->balls)
        return dem_fail_memory(error);
    pack->count = state->count;
    for (size_t i = 0; i < state->count; i++)
        pack->balls[i] = dem_pack_grain_leave(&run->p->grain, state->balls[i]);
    pack->gap_estimate = run->volumes.gap;
    pack->moments = run->met;
    pack->moment_residual = run->rows.residual;
    pack->reached = true;
    return DEM_OK;
}

static const double line_step = 0.0125;   // [d_eq]

// one ball: the sphere of equal volume about the centroid
static void place_one(dem_pack_state *state)
{
    dem_pack_state_add(state, (dem_ball){v3(0, 0, 0), 0.5});
}

static dem_status pack_stages(packing_run *run, dem_pack *pack, dem_error *error)
{
    dem_packing *p = run->p;
    DEM_TRY(dem_pack_state_init(p, &run->state, error));
    DEM_TRY(dem_moment_rows_init(p, &run->rows, error));
    DEM_TRY(dem_lines_build(&p->grain, p->kernels, getenv("LH")?atof(getenv("LH")):line_step, p->capacity, p->threads, &run->lines, error));
    if (p->options->spheres == 1 && p->options->moments != DEM_MOMENTS_FREE) {
        p->charge.linear = true;
        place_one(&run->state);
        run->met = DEM_MOMENTS_VOLUME;
        return hand_over(run, pack, error);
    }
    DEM_TRY(place(p, &run->state, error));
    DEM_TRY(dem_pack_breathe(p, &run->state, getenv("BR")?atoi(getenv("BR")):p->effort.breaths, error));
    p->charge.linear = true;
    DEM_TRY(dem_pack_relax(p, &run->state, settle_linear, error));
    DEM_TRY(dem_pack_join(p, &run->state, error));
    DEM_TRY(polish(run, 0, error));
    DEM_TRY(respend(run, error));
    DEM_TRY(keep_moments(run, error));
    return hand_over(run, pack, error);
}

static dem_status run_optimal(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *options,
                              dem_pack *pack, dem_error *error)
{
    dem_packing p;
    DEM_TRY(dem_packing_open(ctx, mesh, options, NULL, &p, error));
    packing_run run = {.p = &p, .met = DEM_MOMENTS_FREE};
    dem_status status = pack_stages(&run, pack, error);
    dem_lines_release(&run.lines);
    dem_packing_close(&p);
    return status;
}

const dem_packer dem_packer_optimal = {
    .name = "optimal",
    .about = "Least symmetric difference between grain and union: greedy medial balls, pruned and relaxed, then polished "
             "on line integrals with the union's moments equal to the grain's.",
    .run = run_optimal,
};
