/// Where a surface meets itself other than along its edges.
#ifndef DEM_MESH_CROSSINGS_H
#define DEM_MESH_CROSSINGS_H

#include "dem/mesh.h"
#include "geom/tree.h"

typedef struct dem_crossings {
    uint32_t (*pairs)[2];  ///< triangles that share more points than their common corners and edge
    size_t count;
    bool complete;         ///< false: stopped at the bound of pairs or work
} dem_crossings;

/// Exact in its predicates: touching counts, nearly touching does not. Triangles without area are passed over.
/// Stops at `max_pairs`, or when the boxes of the triangles overlap hopelessly.
dem_status dem_mesh_crossings(const dem_ctx *ctx, const dem_mesh *mesh, const dem_tree *tree, size_t max_pairs,
                              dem_crossings *crossings, dem_error *error);

/// Do two triangles of a mesh share more than corners and edge?
bool dem_triangles_cross(const dem_mesh *mesh, uint32_t a, uint32_t b);

#endif
