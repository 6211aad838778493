/// Unit quaternions, scalar first; they map body vectors to space.
#ifndef DEM_MATH_QUAT_H
#define DEM_MATH_QUAT_H

#include "math/vec.h"

static inline dem_vec3 quat_rotate(dem_quat q, dem_vec3 v)
{
    dem_vec3 u = v3(q.x, q.y, q.z);
    dem_vec3 t = v3_scale(v3_cross(u, v), 2);
    return v3_add(v3_along(v, q.w, t), v3_cross(u, t));
}
static inline dem_quat quat_conjugate(dem_quat q)
{
    return (dem_quat){q.w, -q.x, -q.y, -q.z};
}
/// Space vector to body.
static inline dem_vec3 quat_unrotate(dem_quat q, dem_vec3 v)
{
    return quat_rotate(quat_conjugate(q), v);
}
static inline dem_quat quat_multiply(dem_quat a, dem_quat b)
{
    return (dem_quat){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
static inline dem_quat quat_unit(dem_quat q)
{
    double s = 1 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return (dem_quat){q.w * s, q.x * s, q.y * s, q.z * s};
}

/// The rotation whose columns (images of the axes) are the right-handed orthonormal a, b, c; w >= 0.
dem_quat dem_quat_from_axes(dem_vec3 a, dem_vec3 b, dem_vec3 c);

#endif
