/// Flipping the edges of a mesh whose vertices lie on a convex surface.
#ifndef DEM_MESH_FLIPS_H
#define DEM_MESH_FLIPS_H

#include "base/status.h"
#include "dem/mesh.h"

/// Turns every edge that runs along the bottom of a crease, until the surface is convex: of all meshes with these
/// vertices the one with the largest volume, without needles that lean. The mesh is closed, outward, and star-shaped
/// about the origin. Flat parts stay as they are.
dem_status dem_mesh_flip_to_convex(dem_mesh *mesh, dem_error *error);

#endif
