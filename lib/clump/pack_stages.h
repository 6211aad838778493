/// The stages of a packing with a given number of balls, in the order they run.
#ifndef DEM_CLUMP_PACK_STAGES_H
#define DEM_CLUMP_PACK_STAGES_H

#include "clump/pack_lines.h"
#include "clump/pack_moments.h"
#include "clump/packing.h"

typedef struct dem_pack_stages {
    dem_packing p;
    dem_pack_state state;
    dem_lines lines;
    dem_lines rough;            ///< fewer of them, for what is looked at again with all; none where nothing is
    dem_line_volumes volumes;   ///< of the state, as the lines see them
    dem_moment_rows rows, spare_rows;
    dem_moments_kept met;
} dem_pack_stages;

/// For options->spheres balls; the grain is borrowed.
dem_status dem_pack_stages_open(const dem_ctx *ctx, const dem_pack_grain *grain, const dem_pack_options *options,
                                const dem_pack_kernels *kernels, dem_pack_stages *run, dem_error *error);
void dem_pack_stages_close(dem_pack_stages *run);

/// Greedy choice, pruning, breathing: where the balls are, to the accuracy of the surface samples.
dem_status dem_pack_place(dem_pack_stages *run, dem_error *error);
/// Descent on the true symmetric difference; balls without exposed surface are spent again.
dem_status dem_pack_fit(dem_pack_stages *run, dem_error *error);
/// Moves on to the moments that options->moments asks for, as far as they can be had at a fair price.
dem_status dem_pack_keep_moments(dem_pack_stages *run, dem_error *error);
/// One piece, no hidden balls; sets `volumes`, `met` and `rows` to what came of it.
dem_status dem_pack_settle(dem_pack_stages *run, dem_error *error);

/// Sets `volumes`.
dem_status dem_pack_measure(dem_pack_stages *run, dem_error *error);
/// Changes the number of balls by inserting or pruning, and relaxes.
dem_status dem_pack_resize(dem_pack_stages *run, size_t count, dem_error *error);

#endif
