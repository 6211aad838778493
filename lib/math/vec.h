/// Vectors: plain values, everything inline.
#ifndef DEM_MATH_VEC_H
#define DEM_MATH_VEC_H

#include <math.h>

#include "dem/base.h"

#define DEM_PI 3.14159265358979323846

static inline dem_vec3 v3(double x, double y, double z)
{
    return (dem_vec3){x, y, z};
}
static inline dem_vec3 v3_add(dem_vec3 a, dem_vec3 b)
{
    return v3(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline dem_vec3 v3_sub(dem_vec3 a, dem_vec3 b)
{
    return v3(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline dem_vec3 v3_scale(dem_vec3 a, double s)
{
    return v3(a.x * s, a.y * s, a.z * s);
}
/// a + s b
static inline dem_vec3 v3_along(dem_vec3 a, double s, dem_vec3 b)
{
    return v3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
static inline double v3_dot(dem_vec3 a, dem_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline dem_vec3 v3_cross(dem_vec3 a, dem_vec3 b)
{
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double v3_norm2(dem_vec3 a)
{
    return v3_dot(a, a);
}
static inline double v3_norm(dem_vec3 a)
{
    return sqrt(v3_norm2(a));
}
static inline double v3_distance(dem_vec3 a, dem_vec3 b)
{
    return v3_norm(v3_sub(a, b));
}
/// Unit vector along a; z for a zero vector.
static inline dem_vec3 v3_unit(dem_vec3 a)
{
    double n = v3_norm(a);
    return n > 0 ? v3_scale(a, 1 / n) : v3(0, 0, 1);
}
/// The smaller and the larger of two numbers, a where b is none (fmin and fmax would be library calls).
static inline double smaller(double a, double b)
{
    return b < a ? b : a;
}
static inline double larger(double a, double b)
{
    return b > a ? b : a;
}
/// Smaller and larger components.
static inline dem_vec3 v3_min(dem_vec3 a, dem_vec3 b)
{
    return v3(smaller(a.x, b.x), smaller(a.y, b.y), smaller(a.z, b.z));
}
static inline dem_vec3 v3_max(dem_vec3 a, dem_vec3 b)
{
    return v3(larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z));
}
/// Component 0, 1 or 2.
static inline double v3_get(dem_vec3 a, int axis)
{
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}
static inline void v3_set(dem_vec3 *a, int axis, double value)
{
    *(axis == 0 ? &a->x : axis == 1 ? &a->y : &a->z) = value;
}
/// A unit vector normal to the unit vector n.
static inline dem_vec3 v3_normal_to(dem_vec3 n)
{
    dem_vec3 a = fabs(n.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0);
    return v3_unit(v3_along(a, -v3_dot(a, n), n));
}

typedef struct dem_box {
    dem_vec3 low, high;
} dem_box;

static inline dem_box box_empty(void)
{
    return (dem_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}
static inline dem_box box_with(dem_box box, dem_vec3 point)
{
    return (dem_box){v3_min(box.low, point), v3_max(box.high, point)};
}
static inline double box_diagonal(dem_box box)
{
    return v3_distance(box.low, box.high);
}

#endif
