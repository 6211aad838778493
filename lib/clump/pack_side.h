/// Clumps on one side of the surface: inscribed (nothing protrudes) or outer (nothing is uncovered).
#ifndef DEM_CLUMP_PACK_SIDE_H
#define DEM_CLUMP_PACK_SIDE_H

#include "clump/pack_stages.h"

/// Before balls are placed: makes samples on the forbidden side dear.
void dem_pack_side_begin(dem_packing *p);

/// Brings placed balls to the side asked for, as close to the surface as their number allows. What holds at the end
/// holds for the mesh as given: no point of an inscribed ball outside it, no point of it outside an outer clump.
dem_status dem_pack_side_keep(dem_pack_stages *run, dem_error *error);

#endif
