/// Bodies whose motion is given in whole or in part: fixed, at a given velocity or spin, or locked along axes of space.
///
/// To all others a body whose velocity is given is one without end of mass, so its inverse mass is as good as 0 (not 0,
/// so that a contact of two of them has numbers), and it has no weight; the same for the spin and the moments.
#ifndef DEM_SIM_HOLD_H
#define DEM_SIM_HOLD_H

#include "math/quat.h"
#include "dem/scene.h"

enum {
    DEM_LOCK_ALL = DEM_LOCK_X | DEM_LOCK_Y | DEM_LOCK_Z,
    DEM_LOCK_TURNS = DEM_LOCK_RX | DEM_LOCK_RY | DEM_LOCK_RZ,
    DEM_LOCK_PLANE = DEM_LOCK_Z | DEM_LOCK_RX | DEM_LOCK_RY,  ///< what leaves a body two dimensions
};

/// Times the inverse mass of a body without end of mass.
static const double DEM_AS_GOOD_AS_NONE = 1e-15;

static inline bool hold_moves(uint32_t hold)
{
    return (hold & DEM_HOLD_VELOCITY) || (hold & DEM_LOCK_ALL) == DEM_LOCK_ALL;
}
static inline bool hold_turns(uint32_t hold)
{
    return (hold & DEM_HOLD_SPIN) || (hold & DEM_LOCK_TURNS) == DEM_LOCK_TURNS;
}
/// Whether contacts can do nothing to the body, so that two such need no contact.
static inline bool hold_whole(uint32_t hold)
{
    return hold_moves(hold) && hold_turns(hold);
}

/// The vector without the components whose bits, from the lowest, are set.
static inline dem_vec3 without_locked(dem_vec3 v, uint32_t bits)
{
    return v3(bits & 1 ? 0 : v.x, bits & 2 ? 0 : v.y, bits & 4 ? 0 : v.z);
}
static inline dem_vec3 unlocked_velocity(dem_vec3 v, uint32_t hold)
{
    return without_locked(v, hold);
}
static inline dem_vec3 unlocked_spin(dem_vec3 spin, uint32_t hold)
{
    return without_locked(spin, hold / DEM_LOCK_RX);
}

/// The spin of a body that can turn about some axes of space only. What holds it acts about the others, so the angular
/// momentum about the free ones is that of its contacts: I_ff w_f = L_f.
static inline dem_vec3 locked_spin(dem_quat q, const double inverse[3], dem_vec3 momentum, uint32_t hold)
{
    dem_vec3 column[3], l = unlocked_spin(momentum, hold);
    if (inverse[0] == inverse[1] && inverse[1] == inverse[2])
        return v3_scale(l, inverse[0]);
    for (int k = 0; k < 3; k++) {
        dem_vec3 axis = v3(k == 0, k == 1, k == 2), own = quat_unrotate(q, axis);
        bool locked = hold & (uint32_t)(DEM_LOCK_RX << k);
        own = v3(own.x / inverse[0], own.y / inverse[1], own.z / inverse[2]);
        column[k] = locked ? axis : unlocked_spin(quat_rotate(q, own), hold);
    }
    double all = v3_dot(column[0], v3_cross(column[1], column[2]));
    return v3(v3_dot(l, v3_cross(column[1], column[2])) / all, v3_dot(column[0], v3_cross(l, column[2])) / all,
              v3_dot(column[0], v3_cross(column[1], l)) / all);
}

#endif
