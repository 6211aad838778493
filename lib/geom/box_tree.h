/// A tree of bounding boxes over anything that has one; the trees of triangles, balls and arcs stand on it.
#ifndef DEM_GEOM_BOX_TREE_H
#define DEM_GEOM_BOX_TREE_H

#include "base/memory.h"
#include "math/vec.h"

typedef struct dem_box_node {
    dem_box box;
    uint32_t begin, end;  ///< range of `order`; the left child follows its parent, the right one is `right`
    uint32_t right;       ///< 0: leaf
} dem_box_node;

typedef struct dem_box_tree {
    dem_box_node *nodes;
    size_t node_count, count;
    uint32_t *order;  ///< item indices, leaf by leaf
} dem_box_tree;

/// No path from the root is longer: a stack for one descent.
enum { DEM_BOX_TREE_STACK = 96 };

typedef dem_box (*dem_box_of)(const void *items, uint32_t item);

/// Splits at the median of the box centres down to at most `leaf` (at least 2) items. `count` 1 to 2^31 - 1.
/// False: no memory.
bool dem_box_tree_build(dem_box_tree *tree, const void *items, size_t count, uint32_t leaf, dem_box_of box_of);
void dem_box_tree_release(dem_box_tree *tree);

static inline double box_distance2(const dem_box *box, dem_vec3 p)
{
    double x = fmax(0, fmax(box->low.x - p.x, p.x - box->high.x));
    double y = fmax(0, fmax(box->low.y - p.y, p.y - box->high.y));
    double z = fmax(0, fmax(box->low.z - p.z, p.z - box->high.z));
    return x * x + y * y + z * z;
}

#endif
