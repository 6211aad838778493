/// Wear of walls: what bodies take off them, by triangle of a mesh or of a whole smooth surface.
///
/// Finnie (1960), by event: when a body begins to touch a wall, it takes Q off at its deepest contact, by the speed V and
/// the angle a from the surface of the two surfaces there (PHYSICS 1.10):
///   Q = r m V^2 / (p psi K) (sin 2a - 6/K sin^2 a)  for tan a <= K/6, else  r m V^2 / (6 p psi) cos^2 a.
/// The mass is the body's, and an episode counts once, however many of its spheres touch in it.
/// Archard (1953), in each step: Q = k F_n |v_t| h / H for each contact.
///
/// Events are gathered by segment and added in their order, so that any number of threads gives the same bits.
#ifndef DEM_SIM_WEAR_H
#define DEM_SIM_WEAR_H

#include "sim/state.h"

/// Volume by Finnie [m^3]; `angle` from the surface [rad].
double dem_wear_finnie(const dem_wear_def *law, double mass, double speed, double angle);

/// Notes what body `row` does that has begun to touch: `contact` in the wall's frame.
void dem_wear_strike(dem_world *world, size_t segment, uint32_t row, uint32_t wall, const dem_mesh_contact *contact);

/// Notes the wear by Archard of the segments' contacts as the contact pass has left them, over the time `kick`.
void dem_wear_rub(dem_world *world, size_t begin, size_t end, double kick);

/// Adds what was noted to the walls. Error: DEM_NO_MEMORY, where some could not be.
dem_status dem_wear_settle(dem_world *world, dem_error *error);

#endif
