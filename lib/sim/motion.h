/// The motion of bodies by other schemes than the default: the loop of the kernels, body by body, compiled once, so
/// that all instruction sets have its bits. Only called where a scene asks for it.
#ifndef DEM_SIM_MOTION_H
#define DEM_SIM_MOTION_H

#include "sim/state.h"

void dem_motion_any(const dem_rows *rows, dem_motion_job *job);

/// The time that forces, and that moments, act in the next step [s].
double dem_motion_kick(const dem_world *world);
double dem_motion_turn_kick(const dem_world *world);

/// The velocity of a body's centre, and its spin in space, at the time of its position, under the force and the moment
/// there [m/s], [rad/s].
dem_vec3 dem_motion_velocity(const dem_world *world, size_t row, dem_vec3 force);
dem_vec3 dem_motion_spin(const dem_world *world, size_t row, dem_vec3 moment);

#endif
