/// The rows and columns of a world's bodies.
#ifndef DEM_SIM_BODIES_H
#define DEM_SIM_BODIES_H

#include "sim/state.h"

/// Makes the columns a world needs, of `rows` rows, and puts the bodies into the first of them, along a space-filling
/// curve. Needs templates.
dem_status dem_bodies_create(dem_world *world, const dem_body_def *defs, size_t count, size_t rows, dem_error *error);
/// More rows, free ones; the dummies move behind them, and slots of momenta are gone. False: no memory, all as it was.
bool dem_bodies_grow(dem_world *world, size_t rows);

/// Puts a body into a row, with the momenta of its velocities; lists know nothing of it yet.
void dem_body_put(dem_world *world, size_t row, const dem_body_def *def);
/// Makes a row one without a body.
void dem_body_clear(dem_world *world, size_t row);
void dem_bodies_release(dem_bodies *bodies);

/// Room for `slots` rows of momentum behind those of the bodies, zeroed where new.
bool dem_bodies_reserve_slots(dem_bodies *bodies, size_t slots);

/// Puts bodies that have crossed a periodic side back into the domain; `moved` [3 a body] receives how many sides each
/// has been moved back by.
void dem_bodies_wrap(dem_world *world, int32_t *moved);

/// The angular velocity of a body in space for its angular momentum and orientation [rad/s].
dem_vec3 dem_body_spin(const dem_bodies *bodies, size_t row, dem_vec3 momentum);

/// Of rotation [J].
double dem_body_turning_energy(const dem_bodies *bodies, size_t row, dem_vec3 spin);

/// Memory of the columns by body [B].
double dem_bodies_bytes(const dem_world *world);

#endif
