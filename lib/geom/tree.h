/// A bounding-box tree over triangles, in double: closest point, distance, inside or outside, rays.
#ifndef DEM_GEOM_TREE_H
#define DEM_GEOM_TREE_H

#include "geom/box_tree.h"

/// Closest point of triangle (a, b, c) to p (Ericson 2005, 5.1.5); works for degenerate triangles.
dem_vec3 dem_triangle_closest(dem_vec3 p, dem_vec3 a, dem_vec3 b, dem_vec3 c);

typedef dem_box_node dem_tree_node;

/// Borrowed vertices and triangles must outlive the tree.
typedef struct dem_tree {
    const dem_vec3 *vertices;
    const uint32_t *triangles;
    size_t count;
    dem_tree_node *nodes;
    size_t node_count;
    uint32_t *order;  ///< triangle ids, leaf by leaf
} dem_tree;

dem_status dem_tree_build(dem_tree *tree, const dem_vec3 *vertices, const uint32_t *triangles, size_t count,
                          dem_error *error);
void dem_tree_release(dem_tree *tree);

/// Closest surface point to p nearer than `limit` (INFINITY: any). Returns the distance, INFINITY where none;
/// `point` and `triangle` may be NULL.
double dem_tree_closest(const dem_tree *tree, dem_vec3 p, double limit, dem_vec3 *point, uint32_t *triangle);

/// Called for a triangle that a ray passes at p + t d; `leaving` is +1 where it comes out of the front, else -1.
typedef void (*dem_tree_visit)(void *user, uint32_t triangle, int leaving, double t);

/// All triangles the ray p + t d, t > 0, passes, in no particular order.
void dem_tree_ray(const dem_tree *tree, dem_vec3 p, dem_vec3 d, dem_tree_visit visit, void *user);

/// True where some surface point is not farther from p than `distance`; cheaper than finding the closest.
bool dem_tree_within(const dem_tree *tree, dem_vec3 p, double distance);

/// Winding number of a closed surface about p, seen along the direction d: signed crossings of the ray.
int dem_tree_winding(const dem_tree *tree, dem_vec3 p, dem_vec3 d);

/// True where p lies inside a closed surface, whatever its orientation: a vote of three generic directions.
bool dem_tree_inside(const dem_tree *tree, dem_vec3 p);

#endif
