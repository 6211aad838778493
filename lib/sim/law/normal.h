/// Normal forces: linear spring (Cundall & Strack 1979) and Hertz (1882), with a dashpot.
#ifndef DEM_SIM_LAW_NORMAL_H
#define DEM_SIM_LAW_NORMAL_H

#include "base/simd.h"
#include "sim/features.h"

typedef struct normal_law {
    wide elastic;   ///< force of the spring [N]
    wide force;     ///< with the dashpot [N]
    wide stiffness; ///< tangent of the spring [N/m]
    wide radius;    ///< sqrt(R* overlap), of the contact [m] (Hertz only)
} normal_law;

/// R* = R_i R_j / (R_i + R_j)
DEM_INLINE wide reduced_radius(wide a, wide b)
{
    return a * b / (a + b);
}

/// Elastic part. `reduced` R* [m] (Hertz), `area_length` A / (pi L) = R_min^2 / (R_i + R_j) [m] (young).
DEM_INLINE normal_law normal_elastic(const dem_features f, const wide *law, wide overlap, wide reduced,
                                     wide area_length)
{
    wide zero = wide_all(0);
    normal_law n = {zero, zero, zero, zero};
    if (f.linear) {
        n.stiffness = law[LAW_STIFFNESS];
        if (f.young)
            n.stiffness = n.stiffness + law[LAW_YOUNG] * area_length;
        n.elastic = n.stiffness * overlap;
    }
    if (f.hertz) {
        n.radius = wide_sqrt(reduced * wide_max(overlap, zero));
        wide tangent = law[LAW_HERTZ] * n.radius;
        n.elastic = n.elastic + wide_all(2.0 / 3) * (tangent * overlap);
        n.stiffness = n.stiffness + tangent;
    }
    n.force = n.elastic;
    return n;
}

/// Dashpot on the velocity `vn` of separation [m/s] with the effective mass [kg].
DEM_INLINE void normal_damp(const dem_features f, const wide *law, normal_law *n, wide mass, wide vn)
{
    if (f.rate)
        n->force = n->force - law[LAW_RATE] * mass * vn;
    if (f.restitution)
        n->force = n->force - law[LAW_ZETA] * wide_sqrt(n->stiffness * mass) * vn;
    if (f.cut)
        n->force = wide_max(n->force, law[LAW_FLOOR]);
}

#endif
