/// Servo walls: they move along a direction until the bodies push back with a given force (PHYSICS 5).
///
/// The force is that of the contact pass, summed by segment and then in their order, so that any number of threads
/// gives the same bits. A velocity is held for one step: v = gain (F - F now) / (h sum(k + c / h)), which takes `gain`
/// of what is missing off in that step where the bodies stay. The dashpots c are in it, or a stiff contact with a
/// strong one would overshoot. With a mass m, v += h (F - F now) / m, where m is at least h^2 sum(k + c / h), so that
/// no step is too long for it.
#ifndef DEM_SIM_SERVO_H
#define DEM_SIM_SERVO_H

#include "sim/state.h"

/// What is asked of the servos: targets, gains, and areas that can be found. Sets the areas of walls that have their
/// own. Errors: DEM_BAD_INPUT.
dem_status dem_servo_prepare(dem_walls *walls, dem_error *error);

/// The fastest that any servo may go [m/s].
double dem_servo_most(const dem_walls *walls);

/// Sums the forces of the wall contacts of the segments [begin, end) as the contact pass has left them.
void dem_servo_gather(dem_world *world, size_t begin, size_t end);

/// Sets the velocities for the step to come and moves on by it.
void dem_servo_move(dem_world *world);

/// The area over which a servo's stress is meant, as the walls stand [m^2]; 0: it has none.
double dem_servo_area(const dem_walls *walls, size_t wall);

#endif
