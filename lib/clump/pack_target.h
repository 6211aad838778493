/// The fewest spheres for a gap asked for.
#ifndef DEM_CLUMP_PACK_TARGET_H
#define DEM_CLUMP_PACK_TARGET_H

#include "clump/pack_grain.h"

/// One packing of options->spheres, whatever options->gap says.
typedef dem_status dem_pack_count_run(const dem_ctx *ctx, const dem_pack_grain *grain, const dem_pack_options *options,
                                      dem_pack *pack, dem_error *error);

/// Searches the number of spheres, at most options->max_spheres, whose gap as dem_fidelity_measure sees it is at most
/// options->gap. Not reached: the best found, pack->reached false, and a warning.
dem_status dem_pack_target(const dem_ctx *ctx, const dem_pack_grain *grain, const dem_pack_options *options,
                           dem_pack_count_run *run, dem_pack *pack, dem_error *error);

#endif
