/// A block broken into the Voronoi cells of random points.
#ifndef DEM_MESH_FRACTURE_H
#define DEM_MESH_FRACTURE_H

#include "mesh/polyhedron.h"

enum { DEM_FRACTURE_MAX_CELLS = 20000 };

/// Cell i is what lies nearer to point i than to all others; together the cells fill the block.
typedef struct dem_fracture {
    dem_vec3 *points;       ///< [count]
    dem_polyhedron *cells;  ///< [count] tag >= 0: the neighbour beyond a face; below: a side of the block
    size_t count;
} dem_fracture;

/// Points spread at random by the seed, then moved `evenings` times to the middles of their cells (Lloyd 1982), which
/// makes the cells alike. The same for any number of threads.
dem_status dem_fracture_block(const dem_ctx *ctx, dem_box block, size_t count, size_t evenings, uint64_t seed,
                              dem_fracture *fracture, dem_error *error);
void dem_fracture_release(dem_fracture *fracture);

#endif
