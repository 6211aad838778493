/// Walls: where they stand and how they move.
#ifndef DEM_SIM_WALLS_H
#define DEM_SIM_WALLS_H

#include "dem/scene.h"
#include "math/quat.h"
#include "sim/kernels.h"
#include "sim/surface.h"
#include "sim/wall_motion.h"

enum { DEM_WALL_ROW = 16 };

typedef struct dem_wall {
    char *name;
    dem_wall_form form;
    uint32_t material;
    dem_vec3 point, normal;  ///< at time 0; see dem_wall_def
    double radius;           ///< of a cylinder, negative where the bodies are outside [m]
    dem_mesh_wall *mesh;     ///< in the frame of time 0; NULL: none
    dem_surface surface;     ///< of the form MESH without a mesh, in that frame
    dem_wall_motion motion;
    dem_servo_def servo;
    dem_wear_def wear;
    double *worn;  ///< [worn_count] by triangle as given, or of the whole [m^3] (wear)
    size_t worn_count;
    bool generator;        ///< it is a generator sphere, which is in no inlet's way
    double travel, speed;  ///< of a servo, along its direction, now [m], [m/s]
    bool moves;            ///< its surface has a velocity
    bool sweeps;           ///< ... and its shape does not stay in place
    dem_vec3 position;     ///< now: where the frame of time 0 has moved to [m]
    dem_quat orientation;
} dem_wall;

/// `rows`, 16 a wall: normal or axis, offset (n . point) or radius (negative: bodies outside), point, -; velocity of
/// the surface point that passes the origin of space, angular velocity, - -. Behind the last wall stand a plane and a
/// cylinder far from everything, for idle contacts.
typedef struct dem_walls {
    dem_wall *items;
    size_t count;
    double *rows;
    bool move, sweep, servo, wear, rub;  ///< some do, some are; rub: wear by Archard
    uint32_t slots;  ///< a ball at a mesh, or another wall of that form, has places for a multiple of so many contacts
} dem_walls;

/// Errors: DEM_BAD_INPUT, DEM_UNAVAILABLE for a mesh without Embree.
dem_status dem_walls_create(const dem_ctx *ctx, const dem_scene *scene, dem_walls *walls, dem_error *error);
void dem_walls_release(dem_walls *walls);

/// Puts the walls where they are at time t.
void dem_walls_place(dem_walls *walls, double t);

/// Bound of the speed of the sweeping walls' surfaces within `radius` of `centre` [m/s], without what servos add.
double dem_walls_speed(const dem_walls *walls, dem_vec3 centre, double radius);

/// Where the point is now that the wall turns about at time 0, to which moments refer [m].
static inline dem_vec3 wall_reference(const dem_wall *wall)
{
    return v3_add(wall->position, quat_rotate(wall->orientation, wall->motion.through));
}

/// A point of space in the wall's frame of time 0, and back.
static inline dem_vec3 wall_from_space(const dem_wall *wall, dem_vec3 x)
{
    return wall->sweeps ? quat_unrotate(wall->orientation, v3_sub(x, wall->position)) : x;
}
static inline dem_vec3 wall_to_space(const dem_wall *wall, dem_vec3 x)
{
    return wall->sweeps ? v3_add(quat_rotate(wall->orientation, x), wall->position) : x;
}
static inline dem_vec3 wall_turn(const dem_wall *wall, dem_vec3 v)
{
    return wall->sweeps ? quat_rotate(wall->orientation, v) : v;
}

/// Distance of a point from the surface of a plane or cylinder, positive on the side of the bodies [m].
double dem_wall_distance(const dem_walls *walls, size_t wall, dem_vec3 x);

#endif
