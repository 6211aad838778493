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

// fmax would be a library call here
static inline double box_beyond(double low, double high, double x)
{
    double below = low - x, above = x - high, beyond = below > above ? below : above;
    return beyond > 0 ? beyond : 0;
}

/// Squared distance of p to the box, 0 inside.
static inline double box_distance2(const dem_box *box, dem_vec3 p)
{
    double x = box_beyond(box->low.x, box->high.x, p.x), y = box_beyond(box->low.y, box->high.y, p.y);
    double z = box_beyond(box->low.z, box->high.z, p.z);
    return x * x + y * y + z * z;
}

/// A node that is still to be looked at, and its squared distance.
typedef struct dem_box_visit {
    double distance2;
    uint32_t node;
} dem_box_visit;

/// Puts those of a node's two parts on the stack that are nearer than asked for, the nearer one on top. Returns their
/// number.
static inline int box_visit_both(const dem_box_node *nodes, uint32_t node, dem_vec3 p, double limit2,
                                 dem_box_visit *stack)
{
    dem_box_visit left = {box_distance2(&nodes[node + 1].box, p), node + 1};
    dem_box_visit right = {box_distance2(&nodes[nodes[node].right].box, p), nodes[node].right};
    bool left_first = left.distance2 < right.distance2;
    dem_box_visit near = left_first ? left : right, far = left_first ? right : left;
    int count = 0;
    if (far.distance2 < limit2)
        stack[count++] = far;
    if (near.distance2 < limit2)
        stack[count++] = near;
    return count;
}

#endif
