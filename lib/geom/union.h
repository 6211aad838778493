/// The exact geometry of a union of balls: moments, exposed surface, and their derivatives.
#ifndef DEM_GEOM_UNION_H
#define DEM_GEOM_UNION_H

#include "base/memory.h"
#include "math/mat3.h"

/// Exposed patch of one ball: integrals over the directions n of its unit sphere that no other ball covers.
/// The derivative of any volume integral int f dV with respect to this ball is r^2 int f(c + r n) (n, 1) dn.
typedef struct dem_patch {
    double area;       ///< int dn [sr]; 0: the ball adds nothing
    dem_vec3 first;    ///< int n dn
    dem_sym3 second;   ///< int n n^T dn
    double third[10];  ///< int n_a n_b n_c dn: xxx xxy xxz xyy xyz xzz yyy yyz yzz zzz
} dem_patch;

/// An exposed arc of the circle in which ball `j` cuts ball `i`: points c_i + r_i (h u + s (a cos t + b sin t)),
/// t from `begin` to `end`.
typedef struct dem_arc {
    uint32_t i, j;
    dem_vec3 u, a, b;
    double h, s, begin, end;
} dem_arc;

/// What ball `j` covers of the unit sphere of its neighbour: n.u > h.
typedef struct dem_cap {
    dem_vec3 u;
    double h;
    uint32_t j;
} dem_cap;

typedef struct dem_ball_union {
    dem_moments moments;  ///< about the origin the balls are given in
    double area;          ///< exposed
    size_t redundant;     ///< balls without exposed surface
    dem_patch *patches;   ///< [count]
    dem_arc *arcs;        ///< [arc_count], only if asked for; each crease once, i < j
    size_t arc_count;
    dem_cap *caps;      ///< with the arcs: those of ball i that no other one contains stand from cap_start[i]
    size_t *cap_start;  ///< [count + 1]; equal ends and no area: swallowed
    bool consistent;    ///< false: a patch area was in doubt (sampled and integrated areas disagree)
} dem_ball_union;

/// Finite centres and positive finite radii, or DEM_USAGE.
dem_status dem_balls_check(const dem_ball *balls, size_t count, dem_error *error);

/// Exact to rounding, coincidences included; work and memory grow with the overlapping pairs. Far from the origin the
/// moments about it lose what their size loses, patches and area do not. `want_arcs` also lists the crease
/// arcs and the caps, which one thread does whatever `threads` says. The same bits for any number of them.
dem_status dem_ball_union_compute(const dem_ball *balls, size_t count, bool want_arcs, int threads,
                                  dem_ball_union *result, dem_error *error);
void dem_ball_union_release(dem_ball_union *result);

/// Connected pieces of balls whose overlap (r_i + r_j - distance) exceeds `margin`; `piece` (may be NULL) receives
/// the smallest index of each ball's piece. 0: no balls or no memory.
size_t dem_ball_pieces(const dem_ball *balls, size_t count, double margin, uint32_t *piece);

#endif
