/// What making a clump from a mesh and from a file of another program share.
#ifndef DEM_CLUMP_MAKE_H
#define DEM_CLUMP_MAKE_H

#include "dem/clump.h"

/// A surface of about `triangles` triangles in the frame of the clump that `def` places; empty for 0, and where the
/// mesh cannot be reduced.
dem_status dem_make_surface(const dem_mesh *mesh, size_t triangles, const dem_clump_def *def, dem_mesh *surface,
                            dem_error *error);

#endif
