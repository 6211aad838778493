/// Closing the holes of a surface.
#ifndef DEM_MESH_HOLES_H
#define DEM_MESH_HOLES_H

#include "math/vec.h"
#include "mesh/surface.h"

typedef struct dem_holes {
    size_t holes, edges;  ///< closed, and their border edges
    double volume;        ///< of the cones from `centre` to the new triangles, with their signs [m^3]
    double share;         ///< the same, hole by hole without sign [m^3]
    double area;          ///< of the new triangles [m^2]
} dem_holes;

/// Appends to the surface's mesh the triangles of least area that close each hole (Barequet & Sharir 1995), or
/// a fan for holes of hundreds of edges. The surface must be oriented, and is to be built again afterwards.
dem_status dem_surface_fill(const dem_surface *surface, dem_vec3 centre, dem_holes *holes, dem_error *error);

#endif
