/// Closed forms of one elastic impact, for the choice of the time step and for tests (PHYSICS 1.2, 1.3).
///
/// `mass` is the effective mass of the contact [kg], `speed` that of approach [m/s].
#ifndef DEM_SIM_IMPACT_H
#define DEM_SIM_IMPACT_H

/// k of the Hertz law F = k overlap^1.5, 4/3 E* sqrt(R*) [N/m^1.5], from E* [Pa] and R* [m].
double dem_hertz_stiffness(double modulus, double radius);
/// Largest overlap [m].
double dem_hertz_overlap(double mass, double stiffness, double speed);
/// Duration of the contact [s].
double dem_hertz_duration(double mass, double stiffness, double speed);
/// Largest force [N].
double dem_hertz_force(double mass, double stiffness, double speed);

/// The same for the linear law F = k overlap, k in [N/m]; the duration is the same at every speed.
double dem_linear_overlap(double mass, double stiffness, double speed);
double dem_linear_duration(double mass, double stiffness);
double dem_linear_force(double mass, double stiffness, double speed);

#endif
