/// Breathing: insert a few balls where the error is worst, relax, remove as many, relax; keep it if it is better.
#ifndef DEM_CLUMP_PACK_BREATHE_H
#define DEM_CLUMP_PACK_BREATHE_H

#include "clump/packing.h"

/// Adds up to `count` balls at places drawn by error, each the best of a few candidates; fewer where nothing helps.
/// The state must be assigned, and stays so.
void dem_pack_insert(dem_packing *p, dem_pack_state *state, size_t count);
/// One breath. `state` must be assigned, and is at the end.
dem_status dem_pack_breathe(dem_packing *p, dem_pack_state *state, dem_error *error);

#endif
