/// The drag of a fluid that flows evenly: on each body as on the sphere of its volume (Schiller & Naumann 1933), and
/// its buoyancy where that is asked for. The fluid itself is not changed, and spins are not slowed.
///
/// With s the speed against the fluid and Re = rho s d / mu, the drag is 3 pi mu d s (1 + 0.15 Re^0.687), and at least
/// 0.44 pi/8 rho d^2 s^2, which takes over at Re = 990. It is taken at the end of the kick, so that no step is too long
/// for it: of a grain that follows the fluid within a small part of a step nothing is left but that.
#ifndef DEM_SIM_FLUID_H
#define DEM_SIM_FLUID_H

#include "sim/state.h"

/// Drag on a sphere of diameter d that moves at a speed through the fluid [N].
double dem_fluid_drag(const dem_drag_def *drag, double diameter, double speed);

/// The impulse of the drag in a kick that would take the body to the velocity `ahead` [N s].
dem_vec3 dem_fluid_impulse(const dem_world *world, size_t row, dem_vec3 ahead, double kick);

/// Adds it to the momenta of bodies that the contacts have kicked already.
void dem_fluid_push(dem_world *world, size_t begin, size_t end, double kick);
/// Puts the work of it to the ledger, behind the motion.
void dem_fluid_tally(dem_world *world, size_t begin, size_t end);

#endif
