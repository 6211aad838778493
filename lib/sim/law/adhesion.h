/// What pulls two surfaces together: a constant force (Derjaguin, Muller & Toporov 1975), or one in proportion to the
/// area of the overlap (the "simplified JKR" of the field's codes). Both act while the surfaces overlap; friction feels
/// the repulsive part of the normal force only.
#ifndef DEM_SIM_LAW_ADHESION_H
#define DEM_SIM_LAW_ADHESION_H

#include "math/vec.h"
#include "sim/law/normal.h"

/// The lens that two balls share: its area A / pi, and its volume [m^2, m^3]. dV / d(overlap) = A.
typedef struct lens {
    wide area, volume;
} lens;

DEM_INLINE lens lens_of_balls(wide a, wide b, wide distance, wide overlap)
{
    wide sum = a + b, apart = a - b, apart2 = apart * apart, d2 = distance * distance;
    wide area = overlap * (sum + distance) * (d2 - apart2) / (wide_all(4) * d2);
    wide height = wide_fma(distance, distance + sum + sum, wide_all(-3) * apart2);
    return (lens){area, wide_all(DEM_PI / 12) * overlap * overlap * height / distance};
}

/// The cap that a plane cuts off a ball.
DEM_INLINE lens lens_at_wall(wide radius, wide overlap)
{
    return (lens){overlap * (radius + radius - overlap),
                  wide_all(DEM_PI / 3) * overlap * overlap * (wide_all(3) * radius - overlap)};
}

typedef struct adhesion_law {
    wide force;   ///< pull [N]
    wide energy;  ///< of the pull: negative [J]
} adhesion_law;

DEM_INLINE adhesion_law adhesion(const dem_features f, const wide *law, lens shared, wide reduced, wide overlap)
{
    adhesion_law pull = {wide_all(0), wide_all(0)};
    if (f.sjkr) {
        pull.force = wide_all(DEM_PI) * law[LAW_ENERGY_DENSITY] * shared.area;
        pull.energy = wide_all(0) - law[LAW_ENERGY_DENSITY] * shared.volume;
    }
    if (f.dmt) {
        wide constant = law[LAW_ADHESION] * reduced;
        pull.force = pull.force + constant;
        pull.energy = wide_fnma(constant, overlap, pull.energy);
    }
    return pull;
}

#endif
