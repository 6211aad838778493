/// The time step.
///
/// Stability: with M the masses and K the stiffness of all contacts, central differences are stable below 2 / sqrt(L),
/// L the largest eigenvalue of M^-1 K. Since 1/2 k (u_p - u_q)^2 <= k (u_p^2 + u_q^2), L is at most the largest
/// eigenvalue of the bodies' own 6 x 6 problems, contacts with other bodies counted twice: a bound, not an estimate.
/// Dashpots act on velocities half a step old: the limit falls by sqrt(1 + z^2) - z, z = 1/2 sqrt(L) max(c / k); by
/// less where c is corrected for that (see law/normal.h), so this is a bound too.
///
/// Accuracy: an automatic step also takes the shortest contact in a number of steps (`contact_steps`).
#ifndef DEM_SIM_TIMESTEP_H
#define DEM_SIM_TIMESTEP_H

#include "sim/state.h"

typedef struct dem_step_bound {
    double eigenvalue; ///< L [1/s^2]
    double damping;    ///< z [-]
    double step;       ///< the limit with both [s]; INFINITY without contacts
    size_t row;        ///< the body that sets it
} dem_step_bound;

/// The bound for the contacts that touch, or for all that are listed and may do so before the lists change.
dem_status dem_step_stable(dem_world *world, bool listed, dem_step_bound *bound, dem_error *error);

/// The step that takes the shortest contact in `contact_steps`, before stability is asked [s]; INFINITY: no law.
double dem_step_accurate(const dem_world *world);

/// The same, or without any law one that the scene can live with [s].
double dem_step_guess(const dem_world *world);

/// Sets the first step, now that contacts are listed.
dem_status dem_step_choose(dem_world *world, dem_error *error);

/// Looks at an automatic step again from time to time.
dem_status dem_step_review(dem_world *world, dem_error *error);

/// Largest eigenvalue of a symmetric matrix (cyclic Jacobi); destroys it.
double dem_largest_eigenvalue6(double a[6][6]);

#endif
