// The default packer. Greedy choice of medial balls, pruned and relaxed on surface samples, gives the places; descent
// on the true symmetric difference gives the fit; moving on the constraint surface gives the moments.
#include <stdlib.h>

#include "base/status.h"
#include "clump/pack.h"
#include "clump/pack_side.h"

static const double poor_gap = 0.4;    // a fit not worth the name

// one ball: the sphere of equal volume about the centroid
static void place_one(dem_pack_stages *run)
{
    dem_pack_state_add(&run->state, (dem_ball){v3(0, 0, 0), 0.5});
    run->p.charge.linear = true;
    run->met = DEM_MOMENTS_VOLUME;
}

static dem_status run_stages(dem_pack_stages *run, dem_error *error)
{
    if (run->p.options->side != DEM_SIDE_BOTH) {
        dem_pack_side_begin(&run->p);
        DEM_TRY(dem_pack_place(run, error));
        DEM_TRY(dem_pack_side_keep(run, error));
    } else if (run->p.options->spheres == 1 && run->p.options->moments != DEM_MOMENTS_FREE) {
        place_one(run);
    } else {
        DEM_TRY(dem_pack_place(run, error));
        DEM_TRY(dem_pack_fit(run, error));
        DEM_TRY(dem_pack_keep_moments(run, error));
    }
    return dem_pack_settle(run, error);
}

static void warn(const dem_pack_stages *run)
{
    const dem_ctx *ctx = run->p.ctx;
    size_t count = run->state.count;
    if (run->met < run->p.options->moments)
        dem_log(ctx, DEM_LOG_WARNING, "%zu spheres cannot have the grain's %s exactly%s; use more spheres", count,
                run->met == DEM_MOMENTS_VOLUME ? "inertia" : "volume and centre",
                run->met == DEM_MOMENTS_VOLUME ? ", but have its volume and centre" : "");
    if (run->volumes.gap > poor_gap)
        dem_log(ctx, DEM_LOG_WARNING, "%zu spheres leave an IoU gap of %.0f %%: the grain is too thin or too long for so few; "
                "use more spheres", count, 100 * run->volumes.gap);
}

static dem_status hand_over(const dem_pack_stages *run, dem_pack *pack, dem_error *error)
{
    const dem_pack_state *state = &run->state;
    pack->balls = dem_alloc(state->count, sizeof *pack->balls);
    if (!pack->balls)
        return dem_fail_memory(error);
    pack->count = state->count;
    for (size_t i = 0; i < state->count; i++)
        pack->balls[i] = dem_pack_grain_leave(run->p.grain, state->balls[i]);
    pack->gap_estimate = run->volumes.gap;
    pack->moments = run->met;
    pack->moment_residual = run->rows.residual;
    pack->reached = true;
    warn(run);
    return DEM_OK;
}

static dem_status pack_count(const dem_ctx *ctx, const dem_pack_grain *grain, const dem_pack_options *options,
                             dem_pack *pack, dem_error *error)
{
    dem_pack_stages run;
    DEM_TRY(dem_pack_stages_open(ctx, grain, options, NULL, &run, error));
    dem_status status = run_stages(&run, error);
    if (status == DEM_OK)
        status = hand_over(&run, pack, error);
    dem_laps_end(&run.p.laps, "settling");
    if (status == DEM_OK)
        dem_laps_log(&run.p.laps, ctx, "packing");
    dem_pack_stages_close(&run);
    return status;
}

static dem_status run_optimal(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *options,
                              dem_pack *pack, dem_error *error)
{
    dem_pack_grain grain;
    dem_pack_options settled = *options;
    if (options->side != DEM_SIDE_BOTH)
        settled.moments = DEM_MOMENTS_FREE;
    DEM_TRY(dem_pack_grain_open(mesh, &grain, error));
    dem_status status = pack_count(ctx, &grain, &settled, pack, error);
    if (status == DEM_OK) {
        dem_pack_stand_in in = dem_pack_grain_stand_in(&grain);
        pack->stand_in_triangles = in.triangles;
        pack->stand_in_volume = in.volume_change;
        pack->stand_in_distance = in.distance;
    }
    dem_pack_grain_close(&grain);
    return status;
}

const dem_packer dem_packer_optimal = {
    .name = "optimal",
    .about = "Least symmetric difference between grain and union: greedy medial balls, pruned and relaxed, then polished "
             "on line integrals with the union's moments equal to the grain's.",
    .keeps_moments = true,
    .run = run_optimal,
};
