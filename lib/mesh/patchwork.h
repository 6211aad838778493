/// Surfaces sewn together from patches: vertices and triangles one by one, convex polygons filled evenly.
#ifndef DEM_MESH_PATCHWORK_H
#define DEM_MESH_PATCHWORK_H

#include "base/status.h"
#include "math/vec.h"
#include "dem/mesh.h"

/// A mesh being made; zero-initialise. After a failed call `failed` is set, and the rest does nothing.
typedef struct dem_patchwork {
    dem_mesh mesh;
    size_t vertex_room, index_room;
    bool failed;
} dem_patchwork;

uint32_t dem_patchwork_vertex(dem_patchwork *work, dem_vec3 at);
void dem_patchwork_triangle(dem_patchwork *work, uint32_t a, uint32_t b, uint32_t c);
/// Hands the mesh over, or frees it and says that there was no memory.
dem_status dem_patchwork_finish(dem_patchwork *work, dem_mesh *mesh, dem_error *error);

/// A convex polygon to fill, counter-clockwise. On a sphere its corners are unit normals, and each point of it is
/// pushed out to the sphere about `centre`.
typedef struct dem_polygon_patch {
    const dem_vec3 *corners;  ///< [sides]
    size_t sides;
    const uint32_t
        *rim;  ///< vertices that are there already, side by side; the last one of a side is the first of the next
    const size_t *begins;  ///< [sides + 1] where each side begins in `rim`, whose length is the last one
    double edge;           ///< length of the triangles' sides, in the unit of the corners
    double radius;         ///< of the sphere [m]; 0: flat
    dem_vec3 centre;       ///< of the sphere [m]
} dem_polygon_patch;

/// Rings around its middle, each side of a ring divided by its own length.
void dem_patchwork_fill(dem_patchwork *work, const dem_polygon_patch *patch);

#endif
