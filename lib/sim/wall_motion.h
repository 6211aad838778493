/// Where walls are and how fast they move, as a function of time: velocity, spin, oscillations and a table.
///
/// A wall turns about one axis through one point, which goes along with what shifts the wall.
#ifndef DEM_SIM_WALL_MOTION_H
#define DEM_SIM_WALL_MOTION_H

#include "dem/scene.h"
#include "math/quat.h"

typedef struct dem_wall_motion {
    dem_vec3 velocity, through, spin, axis;  ///< axis: of spin where there is any
    double start, stop;                      ///< stop: INFINITY: never
    const dem_oscillation *oscillations;
    size_t oscillation_count;
    dem_wall_table table;
    double speed_most, rate_most;  ///< bounds of what it ever does [m/s], [rad/s]
    double range;                  ///< of the shifts that come and go [m]
    bool steady;                   ///< velocity and spin, all the time
    bool turns, shifts;            ///< ever
    dem_vec3 shift_only;           ///< unit; the direction of all shifts where they have one, else 0
} dem_wall_motion;

/// What a wall's definition says, with its arrays borrowed.
dem_wall_motion dem_wall_motion_of(const dem_wall_def *wall);

/// Copies of the arrays, so that the definition may go. False: no memory; released either way.
bool dem_wall_motion_own(dem_wall_motion *motion);
void dem_wall_motion_release(dem_wall_motion *motion);

/// Whether it ever moves.
static inline bool dem_wall_motion_any(const dem_wall_motion *m)
{
    return m->shifts || m->turns;
}

typedef struct dem_wall_moment {
    dem_vec3 shift, velocity;  ///< of what goes through `through` at time 0 [m], [m/s]
    double angle;              ///< about the axis [rad]
    dem_vec3 spin;             ///< [rad/s]
} dem_wall_moment;

dem_wall_moment dem_wall_motion_at(const dem_wall_motion *motion, double time);

/// Where the frame of time 0 has moved to: x -> position + orientation x. `more` is a shift that comes on top.
dem_vec3 dem_wall_pose(const dem_wall_motion *motion, const dem_wall_moment *now, dem_vec3 more, dem_quat *orientation);

/// Whether a wall of the definition ever moves, by itself or as a servo.
bool dem_wall_def_moves(const dem_wall_def *wall);

#endif
