/// A bounding-box tree over balls: neighbours of a ball, balls along a line or near a point.
#ifndef DEM_GEOM_BALL_TREE_H
#define DEM_GEOM_BALL_TREE_H

#include "geom/box_tree.h"

/// Borrowed balls must outlive the tree.
typedef struct dem_ball_tree {
    const dem_ball *balls;
    dem_box_tree boxes;  ///< of whole balls
} dem_ball_tree;

dem_status dem_ball_tree_build(dem_ball_tree *tree, const dem_ball *balls, size_t count, dem_error *error);
void dem_ball_tree_release(dem_ball_tree *tree);

/// Writes to `found` (room for `count`) the balls whose gap to the ball (centre, radius) is below `gap`
/// (negative: they overlap by more than -gap), in the order of the tree, which is the same for the same balls.
size_t dem_ball_tree_near(const dem_ball_tree *tree, dem_ball ball, double gap, uint32_t *found);

/// The smallest |p - c| - r of all balls, or `limit` where none is below it: outside the union the distance to it,
/// inside it negative. A value below `enough` ends the search. `nearest` (may be NULL) is set where one is below
/// `limit`.
double dem_ball_tree_level(const dem_ball_tree *tree, dem_vec3 p, double limit, double enough, uint32_t *nearest);

#endif
