/// Removing the balls that matter least.
#ifndef DEM_CLUMP_PACK_PRUNE_H
#define DEM_CLUMP_PACK_PRUNE_H

#include "clump/packing.h"

/// Removes `count` of the cheapest balls, no two of them neighbours if that can be; costs are multiplied by
/// 1 +- jitter / 2 at random.
dem_status dem_pack_prune(dem_packing *p, dem_pack_state *state, size_t count, double jitter, dem_error *error);
/// Removes a small share at a time and relaxes, until `count` are left.
dem_status dem_pack_prune_to(dem_packing *p, dem_pack_state *state, size_t count, dem_error *error);

#endif
