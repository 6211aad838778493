/// How rounded and how angular a closed mesh is; the definitions stand in clump/shape.c.
#ifndef DEM_CLUMP_CORNERS_H
#define DEM_CLUMP_CORNERS_H

#include "dem/mesh.h"
#include "geom/tree.h"

/// The mesh has the equivalent diameter 1 and lies about the origin; `tree` is over it.
dem_status dem_corners_measure(const dem_mesh *mesh, const dem_tree *tree, int threads, double *roundness,
                               double *angularity, dem_error *error);

#endif
