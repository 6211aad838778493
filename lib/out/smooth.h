/// Normals for shading.
#ifndef DEM_OUT_SMOOTH_H
#define DEM_OUT_SMOOTH_H

#include "dem/mesh.h"

/// Unit normals of the corners of triangles, [9 * triangle_count], to be freed: of all triangles about the vertex
/// that meet this one at less than a crease's angle, weighted by their angles. So scans look smooth and a cube
/// keeps its edges. NULL: out of memory.
float *dem_mesh_corner_normals(const dem_mesh *mesh);

#endif
