/// Points spread evenly over the surface of a triangle tree.
#ifndef DEM_GEOM_SPREAD_H
#define DEM_GEOM_SPREAD_H

#include "geom/tree.h"

typedef struct dem_surface_point {
    dem_vec3 point, normal;  ///< unit normal
    uint32_t place;          ///< of its triangle in tree->order
} dem_surface_point;

/// Up to `count` points, each for the same area, which is returned. They stand in the order of the tree, so neighbours
/// in the list are near each other. `count` receives how many there are.
double dem_tree_spread(const dem_tree *tree, dem_surface_point *points, size_t *count);

#endif
