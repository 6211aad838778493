/// Fewer triangles for pictures.
#ifndef DEM_MESH_DECIMATE_H
#define DEM_MESH_DECIMATE_H

#include "dem/mesh.h"

/// A surface of about `triangles` triangles, with the volume and the centre of the mesh: by edge collapse, thinned
/// before on a grid where the mesh is huge. A mesh that is coarse enough is copied.
dem_status dem_mesh_decimate(const dem_mesh *mesh, size_t triangles, dem_mesh *out, dem_error *error);

#endif
