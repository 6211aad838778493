/// Which triangles share which edges. A half edge 3 t + k is the side of triangle t from its corner k to the next.
#ifndef DEM_MESH_EDGES_H
#define DEM_MESH_EDGES_H

#include "base/status.h"
#include "dem/mesh.h"

#define DEM_EDGE_BORDER UINT32_MAX        ///< one triangle only
#define DEM_EDGE_MANY (UINT32_MAX - 1)    ///< three or more triangles

typedef struct dem_edges {
    uint32_t *twin;       ///< [3 triangle_count] the other half edge of the edge, or one of the two above
    size_t border;        ///< edges of one triangle
    size_t many;          ///< edges of three and more
    uint32_t *fan;        ///< half edges of the edges of three and more, edge by edge
    size_t *fan_start;    ///< [many + 1] where each begins in `fan`
    size_t duplicates;    ///< triangles marked in `duplicate`
    unsigned char *duplicate;  ///< [triangle_count] same corners as one before, in any order; NULL: none
} dem_edges;

/// Needs welded triangles without repeated corners. Zero-initialise before the first use; a second build
/// releases the first.
dem_status dem_edges_build(dem_edges *edges, const dem_mesh *mesh, dem_error *error);
void dem_edges_release(dem_edges *edges);

static inline uint32_t half_start(const dem_mesh *mesh, uint32_t half)
{
    return mesh->triangles[half];
}
static inline uint32_t half_next(uint32_t half)
{
    return half % 3 == 2 ? half - 2 : half + 1;
}
static inline uint32_t half_before(uint32_t half)
{
    return half % 3 == 0 ? half + 2 : half - 1;
}
static inline uint32_t half_end(const dem_mesh *mesh, uint32_t half)
{
    return mesh->triangles[half_next(half)];
}
/// The corner across the edge.
static inline uint32_t half_apex(const dem_mesh *mesh, uint32_t half)
{
    return mesh->triangles[half_before(half)];
}

#endif
