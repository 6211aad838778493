#include "clump/pack_stages.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "clump/pack_breathe.h"
#include "clump/pack_connect.h"
#include "clump/pack_polish.h"
#include "clump/pack_prune.h"

enum { START_FACTOR = 2 };     // balls under way at first, per ball asked for
enum { PROJECTIONS = 3 };      // with descent along the constraints in between
enum { REJOINS = 30 };

// progress at the end of each stage
static const double placed = 0.3, breathed = 0.7, fitted = 0.85, kept_moments = 0.98;

static const dem_relax_options settle = {40, 0.02, 2e-5}, settle_linear = {40, 0.05, 1e-5};

// what exact moments may cost: gap <= free gap * (1 + share) + part
static const double dearest_share = 0.25, dearest_part = 0.03;
static const double exact_residual = 1e-9;     // moments met
static const double least_exposed = 1e-9;      // of a ball's own surface, for it to add anything
static const double line_offsets[2] = {0.38197, 0.2764};    // generic place of the lines, in steps

static const double rough_step = 2;                       // of the rough lines, in steps of the others

// As of so many balls the lines take most of the time: then the first descent along the moments is on the rough ones
// too, descent on them ends earlier, and that on the fine ones goes on for longer. With fewer balls, and on thin
// grains, the gap would be up to .7 % larger for it.
static const size_t many_balls = 150;
static const double rough_tolerance = 4, last_tolerance = 0.5;

// between lines [d_eq]: so many lines of each axis per ball, in bounds
static double line_step(const dem_pack_grain *grain, double density, size_t balls)
{
    const double widest = 0.0125, narrowest = 0.005, most_lines = 150000;
    double shadow = grain->area / 4;   // mean over directions, of a convex grain (Cauchy)
    double step = fmin(widest, fmax(narrowest, sqrt(shadow / (density * (double)balls))));
    return fmax(step, sqrt(shadow / most_lines));
}

static dem_status build_lines(dem_pack_stages *run, dem_error *error)
{
    const dem_packing *p = &run->p;
    double step = line_step(p->grain, p->effort.line_density, p->options->spheres);
    DEM_TRY(dem_lines_build(p->grain, p->kernels, step, line_offsets, p->capacity, p->crew, &run->lines, error));
    if (p->options->moments == DEM_MOMENTS_FREE)
        return DEM_OK;
    return dem_lines_build(p->grain, p->kernels, rough_step * step, line_offsets, p->capacity, p->crew, &run->rough, error);
}

dem_status dem_pack_stages_open(const dem_ctx *ctx, const dem_pack_grain *grain, const dem_pack_options *options,
                                const dem_pack_kernels *kernels, dem_pack_stages *run, dem_error *error)
{
    memset(run, 0, sizeof *run);
    dem_packing *p = &run->p;
    DEM_TRY(dem_packing_open(ctx, grain, options, kernels, p, error));
    dem_status status = dem_pack_state_init(p, &run->state, error);
    if (status == DEM_OK)
        status = dem_moment_rows_init(p, &run->rows, error);
    if (status == DEM_OK)
        status = dem_moment_rows_init(p, &run->spare_rows, error);
    if (status == DEM_OK)
        status = build_lines(run, error);
    if (status != DEM_OK)
        dem_pack_stages_close(run);
    dem_laps_end(&p->laps, "lines");
    return status;
}

void dem_pack_stages_close(dem_pack_stages *run)
{
    dem_lines_release(&run->lines);
    dem_lines_release(&run->rough);
    dem_packing_close(&run->p);
}

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

dem_status dem_pack_resize(dem_pack_stages *run, size_t count, dem_error *error)
{
    DEM_TRY(grow_to(&run->p, &run->state, count, error));
    DEM_TRY(dem_pack_prune_to(&run->p, &run->state, count, error));
    DEM_TRY(dem_pack_relax(&run->p, &run->state, run->p.charge.linear ? settle_linear : settle, error));
    return dem_pack_join(&run->p, &run->state, error);
}

dem_status dem_pack_place(dem_pack_stages *run, dem_error *error)
{
    dem_packing *p = &run->p;
    dem_pack_state *state = &run->state;
    size_t wanted = p->options->spheres;
    dem_pack_stage(p, placed);
    DEM_TRY(dem_pack_go_on(p, error));
    DEM_TRY(dem_candidates_greedy(&p->candidates, &p->lattice, p->kernels, p->inflations, p->inflation_count,
                                  START_FACTOR * wanted, p->crew, state->balls, &state->count, error));
    dem_laps_end(&p->laps, "choice");
    for (size_t i = 0; i < state->count; i++)
        state->clearances[i].distance = -1;
    if (state->count == 0)
        dem_pack_state_add(state, plain_ball(p));
    DEM_TRY(dem_pack_relax(p, state, (dem_relax_options){15, 0.02, 2e-5}, error));
    DEM_TRY(dem_pack_resize(run, wanted, error));
    dem_laps_end(&p->laps, "pruning");
    dem_pack_stage(p, breathed);
    DEM_TRY(dem_pack_assign(p, state, error));
    for (int k = 0; k < p->effort.breaths; k++) {
        DEM_TRY(dem_pack_progress(p, (double)k / p->effort.breaths, error));
        DEM_TRY(dem_pack_breathe(p, state, error));
    }
    dem_laps_end(&p->laps, "breathing");
    return DEM_OK;
}

dem_status dem_pack_measure(dem_pack_stages *run, dem_error *error)
{
    dem_ball_columns_set(&run->p.columns, run->state.balls, run->state.count);
    return dem_lines_measure(&run->lines, &run->p.columns, NULL, &run->volumes, error);
}

static dem_status polish(dem_pack_stages *run, dem_lines *lines, size_t tangent_count, dem_error *error)
{
    dem_polish_options options = {.iterations = run->p.effort.polish_steps, .tolerance = run->p.effort.polish_tolerance,
                                  .tangent_count = tangent_count};
    if (run->state.count >= many_balls && run->p.options->moments != DEM_MOMENTS_FREE)
        options.tolerance *= lines == &run->rough ? rough_tolerance : last_tolerance;
    for (size_t k = 0; k < tangent_count; k++)
        options.tangent[k] = run->rows.rows[k];
    return dem_pack_polish(&run->p, lines, &run->state, options, &run->volumes, error);
}

// removes balls without exposed surface; where there are none, `rows` are those of the first `kept` moments
static dem_status drop_hidden(dem_pack_stages *run, size_t kept, size_t *dropped, dem_error *error)
{
    dem_pack_state *state = &run->state;
    size_t before = state->count;
    bool *gone = dem_alloc_zero(before, sizeof *gone);
    if (!gone)
        return dem_fail_memory(error);
    dem_status status = dem_moment_rows_set(&run->p, state, kept, &run->rows, error);
    for (size_t i = 0; i < before && status == DEM_OK; i++) {
        double r = state->balls[i].radius;
        gone[i] = run->rows.rows[0][i][3] <= least_exposed * 4 * DEM_PI * r * r;
    }
    if (status == DEM_OK)
        dem_pack_state_remove(state, gone);
    *dropped = before - state->count;
    free(gone);
    return status;
}

dem_status dem_pack_fit(dem_pack_stages *run, dem_error *error)
{
    enum { RESPENDINGS = 2 };
    dem_packing *p = &run->p;
    // where the moments are kept, descent goes on along them
    dem_lines *lines = p->options->moments == DEM_MOMENTS_FREE ? &run->lines : &run->rough;
    p->charge.linear = true;
    dem_pack_stage(p, fitted);
    DEM_TRY(dem_pack_relax(p, &run->state, settle_linear, error));
    DEM_TRY(dem_pack_join(p, &run->state, error));
    DEM_TRY(polish(run, lines, 0, error));
    for (int k = 0; k < RESPENDINGS; k++) {
        size_t dropped, wanted = run->state.count;
        DEM_TRY(drop_hidden(run, 1, &dropped, error));
        if (!dropped)
            break;
        DEM_TRY(dem_pack_resize(run, wanted, error));
        DEM_TRY(polish(run, lines, 0, error));
    }
    if (lines != &run->lines)
        DEM_TRY(dem_pack_measure(run, error));
    dem_laps_end(&p->laps, "fit");
    return DEM_OK;
}

static void take_balls(const dem_pack_state *from, dem_pack_state *to)
{
    to->count = from->count;
    memcpy(to->balls, from->balls, from->count * sizeof *to->balls);
    memcpy(to->clearances, from->clearances, from->count * sizeof *to->clearances);
}

// projects on the first `kept` moments and descends along them, or more, in turn
static dem_status project(dem_pack_stages *run, size_t kept, size_t tangent, bool *met, dem_error *error)
{
    dem_packing *p = &run->p;
    for (int k = 0; k < PROJECTIONS; k++) {
        DEM_TRY(dem_pack_project(p, &run->state, kept, &run->rows, &run->spare_rows, met, error));
        if (!*met || k + 1 == PROJECTIONS)
            break;
        bool rough = k == 0 && run->state.count >= many_balls;
        DEM_TRY(polish(run, rough ? &run->rough : &run->lines, tangent, error));
    }
    return dem_pack_measure(run, error);
}

// Meets all moments; or volume and centre, from as near as the others could be met; or volume and centre alone. What
// costs too much is taken back.
static dem_status meet_moments(dem_pack_stages *run, dem_error *error)
{
    static const struct {
        size_t kept, tangent;
        bool nearest;      // go on from where the last attempt ended
        dem_moments_kept met;
    } ways[] = {{10, 10, false, DEM_MOMENTS_EXACT}, {4, 10, true, DEM_MOMENTS_VOLUME}, {4, 4, false, DEM_MOMENTS_VOLUME}};
    dem_pack_state *free_state = &run->p.moved;
    dem_line_volumes free_volumes = run->volumes;
    take_balls(&run->state, free_state);
    for (size_t k = run->p.options->moments == DEM_MOMENTS_EXACT ? 0 : 2; k < sizeof ways / sizeof *ways; k++) {
        bool met;
        if (!ways[k].nearest)
            take_balls(free_state, &run->state);
        DEM_TRY(project(run, ways[k].kept, ways[k].tangent, &met, error));
        if (met && run->volumes.gap <= free_volumes.gap * (1 + dearest_share) + dearest_part) {
            run->met = ways[k].met;
            return DEM_OK;
        }
    }
    take_balls(free_state, &run->state);
    run->volumes = free_volumes;
    return DEM_OK;
}

dem_status dem_pack_keep_moments(dem_pack_stages *run, dem_error *error)
{
    dem_pack_stage(&run->p, kept_moments);
    if (run->p.options->moments != DEM_MOMENTS_FREE)
        DEM_TRY(meet_moments(run, error));
    dem_laps_end(&run->p.laps, "moments");
    return DEM_OK;
}

static size_t moments_of(dem_moments_kept kept)
{
    return kept == DEM_MOMENTS_EXACT ? DEM_MOMENT_COUNT : kept == DEM_MOMENTS_VOLUME ? 4 : 0;
}

// of a clump that keeps none the volume is looked at
static size_t moments_told(dem_moments_kept kept)
{
    return kept == DEM_MOMENTS_FREE ? 1 : moments_of(kept);
}

// keeping the moments may have pulled pieces apart: closes and projects in turn; one piece has the last word
static dem_status rejoin(dem_pack_stages *run, dem_error *error)
{
    size_t kept = moments_of(run->met);
    for (int k = 0; k < REJOINS; k++) {
        bool met;
        if (!dem_pack_close(&run->p, &run->state, kept ? 0 : 0.5) || !kept)
            return DEM_OK;
        DEM_TRY(dem_pack_project(&run->p, &run->state, kept, &run->rows, &run->spare_rows, &met, error));
    }
    dem_pack_close(&run->p, &run->state, 1);
    return DEM_OK;
}

dem_status dem_pack_settle(dem_pack_stages *run, dem_error *error)
{
    size_t dropped;
    dem_pack_stage(&run->p, 1);
    DEM_TRY(rejoin(run, error));
    DEM_TRY(drop_hidden(run, moments_told(run->met), &dropped, error));
    DEM_TRY(dem_pack_go_on(&run->p, error));
    DEM_TRY(dem_pack_measure(run, error));
    DEM_TRY(dem_pack_go_on(&run->p, error));
    bool told = dropped == 0;
    for (;; run->met--, told = false) {
        if (!told)
            DEM_TRY(dem_moment_rows_set(&run->p, &run->state, moments_told(run->met), &run->rows, error));
        if (run->met == DEM_MOMENTS_FREE || run->rows.residual <= exact_residual)
            return DEM_OK;
    }
}
