/// The boundary of a union of balls, ready for questions: how far, which normal, points spread over it.
#ifndef DEM_GEOM_BOUNDARY_H
#define DEM_GEOM_BOUNDARY_H

#include "geom/ball_tree.h"
#include "geom/union.h"

/// An arc of a crease without angles: centre + x a + y b with (x, y) on a circle; it holds the directions whose cosine
/// with (middle_x, middle_y) is at least `open`.
typedef struct dem_crease {
    dem_vec3 centre, a, b, u;
    double radius, middle_x, middle_y, open;
    dem_vec3 begin, middle, end;
    uint32_t i, j;
} dem_crease;

/// Borrowed balls must outlive it.
typedef struct dem_boundary {
    const dem_ball *balls;
    size_t count;
    dem_ball_union whole;  ///< with arcs and caps
    dem_ball_tree tree;
    dem_crease *creases;       ///< [whole.arc_count]
    dem_box_tree crease_tree;  ///< empty without creases
    double *cones;             ///< [count] cosine of a cone about patches[i].first that holds the patch; -1: the sphere
} dem_boundary;

dem_status dem_boundary_build(dem_boundary *boundary, const dem_ball *balls, size_t count, dem_error *error);
void dem_boundary_release(dem_boundary *boundary);

typedef struct dem_boundary_hit {
    double distance;
    dem_vec3 point, normal;  ///< outward; on a crease the mean of both sides
} dem_boundary_hit;

/// The boundary point closest to p. Exact, among patches, creases and their ends, unless one within `enough` was met
/// on the way, which ends the search. One nearer than `limit` is looked for first (INFINITY: nothing is known).
dem_boundary_hit dem_boundary_closest(const dem_boundary *boundary, dem_vec3 p, double enough, double limit);

/// True where the direction n of ball i's unit sphere is covered by another ball, and with it all directions whose
/// unit vectors lie within `margin` of n. Only for balls with a patch.
bool dem_boundary_covered(const dem_boundary *boundary, uint32_t i, dem_vec3 n, double margin);

/// A point of the boundary that stands for a part of its area (0: a point of a crease).
typedef struct dem_boundary_point {
    dem_vec3 point, normal;
    double area;
    uint32_t ball;
} dem_boundary_point;

/// About `count` points spread evenly over the patches, and each crease's ends and middle; malloc'd.
dem_status dem_boundary_sample(const dem_boundary *boundary, size_t count, dem_boundary_point **points,
                               size_t *point_count, dem_error *error);

#endif
