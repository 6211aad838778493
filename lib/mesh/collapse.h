/// Edge collapse.
#ifndef DEM_MESH_COLLAPSE_H
#define DEM_MESH_COLLAPSE_H

#include "base/status.h"
#include "dem/mesh.h"

/// In place, down to `triangles` or as near as it comes without folds and without a change of the volume or of the
/// topology. The coordinates should be about 1 in size and centred; see dem_mesh_decimate.
dem_status dem_mesh_collapse(dem_mesh *mesh, size_t triangles, dem_error *error);

#endif
