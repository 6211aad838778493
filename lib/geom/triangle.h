/// Closest points of triangles, with the part of the triangle that they lie on.
///
/// The closest point of a triangle is the foot of the perpendicular on its plane where that falls inside, else the
/// point of its three edges that is nearest to the foot (the distances from p itself are equal for points that are
/// 1e-8 of them apart). Regions told apart by products of four lengths (Ericson 2005, 5.1.5, as dem_triangle_closest
/// does) drown in rounding for slivers: above one of width 1e-6 of its length the distance was wrong by 5e-4 of the
/// length, at 1e-7 by a tenth. Here the worst that rounding does is to take an edge for the face beside it or the
/// reverse, where both are equally near. Once a triangle is prepared there are no divisions.
#ifndef DEM_GEOM_TRIANGLE_H
#define DEM_GEOM_TRIANGLE_H

#include "math/vec.h"

/// What the closest point lies on.
typedef enum dem_triangle_part {
    DEM_ON_FACE,
    DEM_ON_EDGE_AB,
    DEM_ON_EDGE_BC,
    DEM_ON_EDGE_CA,
    DEM_ON_VERTEX_A,
    DEM_ON_VERTEX_B,
    DEM_ON_VERTEX_C,
} dem_triangle_part;

/// A triangle made ready: two cache lines.
typedef struct dem_triangle {
    dem_vec3 a, b, c;   ///< [m]
    dem_vec3 normal;    ///< unit, along (b - a) x (c - a)
    double inverse[3];  ///< 1 / squared lengths of ab, bc, ca [1/m^2]
    double length;      ///< of the longest edge [m]
} dem_triangle;

/// The closest point of a triangle as seen from a point p.
typedef struct dem_closest {
    dem_vec3 offset;   ///< from p to it [m]
    double distance2;  ///< of p, squared [m^2]
    double aside2;     ///< squared distance of the foot of p on the plane; 0 on the face [m^2]
    int64_t part;      ///< a dem_triangle_part, as wide as the numbers beside it
} dem_closest;

/// Triangles of less area / (longest edge)^2 are degenerate: rounding alone would turn their normals.
#define DEM_TRIANGLE_NARROWEST 1e-12

/// False: degenerate.
static inline bool triangle_prepare(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_triangle *t)
{
    dem_vec3 ab = v3_sub(b, a), bc = v3_sub(c, b), ca = v3_sub(a, c);
    double lengths2[3] = {v3_norm2(ab), v3_norm2(bc), v3_norm2(ca)};
    int longest = lengths2[1] > lengths2[0];
    longest = lengths2[2] > lengths2[longest] ? 2 : longest;
    // the cross product of the two shorter edges loses least; a sliver's would still lean along its length
    dem_vec3 along = longest == 0 ? ab : longest == 1 ? bc : ca;
    dem_vec3 n = longest == 0 ? v3_cross(bc, ca) : longest == 1 ? v3_cross(ca, ab) : v3_cross(ab, bc);
    n = v3_along(n, -v3_dot(n, along) / lengths2[longest], along);
    double twice = v3_norm(n);
    *t = (dem_triangle){a, b, c, v3(n.x / twice, n.y / twice, n.z / twice), {0}, sqrt(lengths2[longest])};
    for (int k = 0; k < 3; k++)
        t->inverse[k] = 1 / lengths2[k];
    return twice > 0 && twice >= 2 * DEM_TRIANGLE_NARROWEST * lengths2[longest];
}

// left to itself the compiler calls these, and then no loop around them becomes vector code
#define TRIANGLE_INLINE static inline __attribute__((always_inline))

// A point of the edge from a to b, all seen from p: the closest to p and so to its foot. At its ends it is exactly the
// corner, so that all triangles around a corner find the same.
TRIANGLE_INLINE dem_closest triangle_edge_spot_(dem_vec3 a, dem_vec3 b, dem_vec3 ab, double inverse, dem_vec3 foot,
                                                int edge)
{
    double t = -v3_dot(a, ab) * inverse;
    bool at_a = t <= 0, at_b = t >= 1;
    dem_closest s;
    s.offset.x = at_a ? a.x : at_b ? b.x : a.x + t * ab.x;
    s.offset.y = at_a ? a.y : at_b ? b.y : a.y + t * ab.y;
    s.offset.z = at_a ? a.z : at_b ? b.z : a.z + t * ab.z;
    s.distance2 = 0;
    s.aside2 = v3_norm2(v3_sub(s.offset, foot));
    s.part = at_a ? DEM_ON_VERTEX_A + edge : at_b ? DEM_ON_VERTEX_A + (edge + 1) % 3 : DEM_ON_EDGE_AB + edge;
    return s;
}

TRIANGLE_INLINE dem_closest triangle_either_(bool second, dem_closest a, dem_closest b)
{
    dem_closest s;
    s.offset.x = second ? b.offset.x : a.offset.x;
    s.offset.y = second ? b.offset.y : a.offset.y;
    s.offset.z = second ? b.offset.z : a.offset.z;
    s.distance2 = 0;
    s.aside2 = second ? b.aside2 : a.aside2;
    s.part = second ? b.part : a.part;
    return s;
}

// in lanes all is computed and then chosen from; alone only what is needed
TRIANGLE_INLINE dem_closest triangle_spot_(const dem_triangle *t, dem_vec3 p, bool lanes)
{
    dem_vec3 ab = v3_sub(t->b, t->a), bc = v3_sub(t->c, t->b), ca = v3_sub(t->a, t->c);
    dem_vec3 a = v3_sub(t->a, p), b = v3_sub(t->b, p), c = v3_sub(t->c, p);
    dem_vec3 foot = v3_scale(t->normal, v3_dot(t->normal, a));
    // beyond which edges the foot lies: only those can have the closest point
    bool beyond_ab = !(v3_dot(t->normal, v3_cross(a, ab)) > 0);
    bool beyond_bc = !(v3_dot(t->normal, v3_cross(b, bc)) > 0);
    bool beyond_ca = !(v3_dot(t->normal, v3_cross(c, ca)) > 0);
    bool inside = !beyond_ab & !beyond_bc & !beyond_ca;
    dem_closest best = {.offset = foot, .aside2 = INFINITY, .part = DEM_ON_FACE}, next;
    if (lanes || beyond_ab) {
        next = triangle_edge_spot_(a, b, ab, t->inverse[0], foot, 0);
        best = triangle_either_(beyond_ab, best, next);
    }
    if (lanes || beyond_bc) {
        next = triangle_edge_spot_(b, c, bc, t->inverse[1], foot, 1);
        best = triangle_either_(beyond_bc & (next.aside2 < best.aside2), best, next);
    }
    if (lanes || beyond_ca) {
        next = triangle_edge_spot_(c, a, ca, t->inverse[2], foot, 2);
        best = triangle_either_(beyond_ca & (next.aside2 < best.aside2), best, next);
    }
    best.aside2 = inside ? 0 : best.aside2;
    best.distance2 = v3_norm2(best.offset);
    return best;
}

static inline dem_closest triangle_closest(const dem_triangle *t, dem_vec3 p)
{
    return triangle_spot_(t, p, false);
}

/// Is the plane beyond the radius, and so the triangle? With room to spare: where rounding has turned the normal of a
/// sliver, it is about its length, and then the plane is off by no more than the sliver is wide.
static inline bool triangle_is_beyond(const dem_triangle *t, dem_vec3 p, double radius)
{
    double height = v3_dot(t->normal, v3_sub(t->a, p));
    return height * height > 1.01 * (radius * radius);
}

/// The same bits without branches, for loops that are to become vector code.
TRIANGLE_INLINE dem_closest triangle_closest_lane(const dem_triangle *t, dem_vec3 p)
{
    return triangle_spot_(t, p, true);
}

#endif
