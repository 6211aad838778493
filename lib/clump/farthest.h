/// The point of one surface that lies farthest from another, found from samples of it.
#ifndef DEM_CLUMP_FARTHEST_H
#define DEM_CLUMP_FARTHEST_H

#include "geom/boundary.h"
#include "geom/spread.h"

/// Distance of p to the mesh, positive outside, and its closest point. `limit` says where to begin to look.
double dem_mesh_level(const dem_tree *mesh, dem_vec3 p, double limit, dem_vec3 *closest);

/// Raises *largest to the largest distance of a mesh point to the boundary. The samples come from dem_tree_spread, each
/// for `area`, with their distances to the boundary. False: no memory.
bool dem_farthest_of_mesh(const dem_tree *mesh, const dem_boundary *boundary, int threads,
                          const dem_surface_point *samples, const double *distances, size_t count, double area,
                          double *largest);

/// A sample of the boundary: its distance to the mesh (positive outside) and the closest point of the mesh.
typedef struct dem_boundary_sample_hit {
    double level;
    dem_vec3 closest;
} dem_boundary_sample_hit;

/// The same for boundary points, outside the mesh (`sign` 1) or inside (-1); one hit for each point.
bool dem_farthest_of_boundary(const dem_tree *mesh, const dem_boundary *boundary, int threads,
                              const dem_boundary_point *points, const dem_boundary_sample_hit *hits, size_t count,
                              int sign, double *largest);

#endif
