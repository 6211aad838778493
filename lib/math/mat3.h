/// Symmetric 3x3 tensors and their principal frame; moments of solids.
#ifndef DEM_MATH_MAT3_H
#define DEM_MATH_MAT3_H

#include "math/vec.h"

static inline dem_sym3 sym3_add(dem_sym3 a, dem_sym3 b)
{
    return (dem_sym3){a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
static inline dem_sym3 sym3_scale(dem_sym3 a, double s)
{
    return (dem_sym3){a.xx * s, a.yy * s, a.zz * s, a.xy * s, a.xz * s, a.yz * s};
}
/// u u^T
static inline dem_sym3 sym3_outer(dem_vec3 u)
{
    return (dem_sym3){u.x * u.x, u.y * u.y, u.z * u.z, u.x * u.y, u.x * u.z, u.y * u.z};
}
/// (p q^T + q p^T) / 2
static inline dem_sym3 sym3_pair(dem_vec3 p, dem_vec3 q)
{
    return (dem_sym3){p.x * q.x, p.y * q.y, p.z * q.z, (p.x * q.y + p.y * q.x) / 2, (p.x * q.z + p.z * q.x) / 2,
                      (p.y * q.z + p.z * q.y) / 2};
}
static inline dem_vec3 sym3_apply(dem_sym3 a, dem_vec3 v)
{
    return v3(a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
              a.xz * v.x + a.yz * v.y + a.zz * v.z);
}

/// Eigenvalues ascending, unit eigenvectors right-handed (cyclic Jacobi).
void dem_sym3_eigen(dem_sym3 a, double values[3], dem_vec3 vectors[3]);

/// Mass properties from moments taken about `origin`; `area` is passed through.
dem_solid dem_solid_from_moments(dem_moments moments, dem_vec3 origin, double area);

#endif
