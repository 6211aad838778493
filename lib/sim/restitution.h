/// The damping ratio that gives a coefficient of restitution (PHYSICS 1.2 and 1.3).
///
/// One contact of mass m: linear, F = k d + 2 zeta sqrt(k m) d', or Hertz, F = k d^1.5 + sqrt(5) zeta sqrt(k m) d^0.25
/// d'; the substitution d^1.25 makes one of the other, so both have the same maps (Antypov & Elliott 2011).
#ifndef DEM_SIM_RESTITUTION_H
#define DEM_SIM_RESTITUTION_H

/// The damping ratio [-] for a restitution 0..1 where the dashpot may pull at the end of the contact: 0 to 1.
double dem_damping_ratio(double restitution);

/// The same where the force is cut at 0: above 1 for restitutions below exp(-2). INFINITY for 0, which no dashpot
/// that cannot pull gives. Relative error below 1e-13.
double dem_damping_ratio_cut(double restitution);

/// The restitution [-] that a damping ratio >= 0 gives where the dashpot may pull.
double dem_restitution(double damping_ratio);

/// The same where the force is cut at 0.
double dem_restitution_cut(double damping_ratio);

#endif
