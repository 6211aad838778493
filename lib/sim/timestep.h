/// The time step.
///
/// Stability: with M the masses, K the stiffness and C the dashpots of all contacts, central differences with dashpots
/// on velocities half a step old are stable while h^2 K + 2 h C < 4 M. (One contact: h < 2 (sqrt(1 + z^2) - z) / w.)
/// Since 1/2 k (u_p - u_q)^2 <= k (u_p^2 + u_q^2), it suffices that this holds for each body's own 6 x 6 problem with
/// contacts with other bodies counted twice: with the largest eigenvalues of M^-1 K and M^-1 C of each, a bound and not
/// an estimate. (Normal dashpots are corrected for the old velocity, law/normal.h, and so take less than C.)
///
/// Damping of the whole motion counts, too: local damping of alpha makes forces against the motion larger, K and C by
/// 1 + alpha, and global damping of the rate c adds c M to C. (The drag of a fluid is implicit and takes nothing.)
///
/// Accuracy: an automatic step also takes the shortest contact in a number of steps (`contact_steps`).
///
/// An automatic step is watched in every step: the contact loop sums for each body what its touching contacts take at
/// most, its *strain*, sum of (h^2 k + 2 h c) / m_least. Only where that exceeds what the body was allowed, its own
/// problem is solved, and the step lowered where that is due. From time to time all bodies are asked whether it may be
/// raised.
#ifndef DEM_SIM_TIMESTEP_H
#define DEM_SIM_TIMESTEP_H

#include "sim/state.h"

typedef struct dem_step_bound {
    double eigenvalue;  ///< of M^-1 K, of the body that sets the bound [1/s^2]
    double damping;     ///< of M^-1 C, of the same body [1/s]
    double step;        ///< the limit [s]; INFINITY without contacts
    size_t row;         ///< that body
} dem_step_bound;

/// The bound for the contacts that touch, or for all that are listed and may do so before the lists change.
dem_status dem_step_stable(dem_world *world, bool listed, dem_step_bound *bound, dem_error *error);

/// The step that takes the shortest contact in `contact_steps`, before stability is asked [s]; INFINITY: no law.
double dem_step_accurate(const dem_world *world);

/// The same, or without any law one that the scene can live with [s].
double dem_step_guess(const dem_world *world);

/// A speed that impacts may have: twice the present one, or of a fall by some sizes [m/s].
double dem_step_impact_speed(const dem_world *world);

/// Sets the first step, now that contacts are listed.
dem_status dem_step_choose(dem_world *world, dem_error *error);

/// Takes up the strained bodies of the last step; looks at an automatic step again from time to time.
dem_status dem_step_review(dem_world *world, dem_error *error);

/// Largest eigenvalue of a symmetric matrix (cyclic Jacobi); destroys it.
double dem_largest_eigenvalue6(double a[6][6]);

/// At least the largest absolute eigenvalue of a symmetric matrix, and at most 1.26 times as much: the root of the
/// eighth moment, in a hundredth of the time.
double dem_eigenvalue_bound6(const double a[6][6]);

/// Lowers an automatic step to what a body that has come asks for.
void dem_step_admit(dem_world *world, size_t row);

#endif
