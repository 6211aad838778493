/// Growing balls until they cover a whole grain.
#ifndef DEM_CLUMP_PACK_COVER_H
#define DEM_CLUMP_PACK_COVER_H

#include "clump/packing.h"

/// Raises radii, each time the one that needs it least, until every triangle of the mesh, to its last point, and every
/// inside point of the lattice lie in the union.
dem_status dem_pack_cover(dem_packing *p, dem_pack_state *state, dem_error *error);

#endif
