/// Bounding box and mass properties of triangle meshes.
#ifndef DEM_MESH_MASS_H
#define DEM_MESH_MASS_H

#include "dem/mesh.h"
#include "math/vec.h"

/// Box of the vertices that triangles use; empty (infinite, inverted) without triangles.
dem_box dem_mesh_box(const dem_mesh *mesh);

#endif
