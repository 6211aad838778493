/// The smallest box around a mesh.
#ifndef DEM_MESH_MIN_BOX_H
#define DEM_MESH_MIN_BOX_H

#include "dem/mesh.h"

/// Edges of the bounding box of least volume, in any orientation, descending [m], and their unit directions
/// (right-handed; may be NULL). The same for any number of threads, with and without CGAL.
dem_status dem_mesh_min_box(const dem_mesh *mesh, int threads, double edges[3], dem_vec3 axes[3], dem_error *error);

#endif
