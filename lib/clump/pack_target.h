/// The fewest spheres for a gap and for other targets, with any packer.
#ifndef DEM_CLUMP_PACK_TARGET_H
#define DEM_CLUMP_PACK_TARGET_H

#include "clump/pack.h"

/// Searches the number of spheres, at most options->max_spheres, with which the packing has the gap and keeps the
/// targets that are asked for, as dem_fidelity_measure sees it. Not reached: the best found, pack->reached false, and
/// a warning. Stopped: the best so far, pack->interrupted true; DEM_INTERRUPTED where there is none yet.
dem_status dem_pack_target(const dem_ctx *ctx, const dem_mesh *mesh, const dem_packer *packer,
                           const dem_pack_options *options, dem_pack *pack, dem_error *error);

#endif
