/// The room that a fill works in: what is placed, a cell grid per size class to find it, and exact tests of overlap.
///
/// Sizes are sorted into classes by factors of two, each with a grid of its own whose cells hold the largest body of
/// the class. Cells of a periodic axis are counted on beyond the ends, so that every image of a body is a body.
#ifndef DEM_SIM_FILL_ROOM_H
#define DEM_SIM_FILL_ROOM_H

#include "math/vec.h"
#include "sim/fill.h"

enum { DEM_ROOM_CLASSES = 32 };

/// What a search reads of a body.
typedef struct dem_room_body {
    dem_vec3 position;    ///< inside of a periodic domain [m]
    double radius, core;  ///< of the sphere around the body; of one about the centre that is inside of it, 0: none [m]
    uint32_t next;        ///< in the same cell
    uint32_t shape;
} dem_room_body;

typedef struct dem_room_pose {
    dem_quat orientation;
    double scale;
    uint32_t grid;  ///< size class whose grid holds it
} dem_room_pose;

typedef struct dem_room_grid {
    uint32_t *cells;  ///< first body of each
    int32_t count[3];
    double size[3];   ///< of a cell [m]
    double largest;   ///< radius of a body of the class [m]
    size_t expected;  ///< bodies it was made for
    size_t held;      ///< bodies in it
} dem_room_grid;

/// A body that is being tried, turned and scaled.
typedef struct dem_room_trial {
    uint32_t shape, grid;
    double scale, radius, core;
    dem_quat orientation;
    dem_ball *balls;  ///< about its centre, axes of space; room for the largest shape [m]
    size_t count;
    dem_vec3 low, high;  ///< box around the balls [m]
} dem_room_trial;

/// A body near the trial; `offset` from its centre to the trial's [m].
typedef struct dem_room_near {
    dem_vec3 offset;
    uint32_t body;
} dem_room_near;

typedef struct dem_room {
    const dem_fill_shape *shapes;
    double *cores;       ///< of the shapes at scale 1 [m]
    dem_vec3 low, high;  ///< the box [m]
    bool spans[3];       ///< the box goes around a periodic domain
    bool periodic[3];
    dem_vec3 origin, period;  ///< of the grids; period 0: not periodic [m]
    bool flat;                ///< centres are put in the middle plane along z
    double gap;               ///< with what rounding may take [m]
    double rounding;          ///< [m]
    const dem_fill_obstacles *there;
    double largest;  ///< radius of the largest body [m]
    dem_room_grid grids[DEM_ROOM_CLASSES];
    dem_room_body *bodies;
    dem_room_pose *poses;
    size_t count, capacity;
    size_t obstacles;     ///< the first ones were there already
    dem_room_near *near;  ///< of the last look
    size_t near_count, near_capacity;
    bool near_wall, near_self;
    uint32_t *picked;  ///< work space of a pair
    bool failed;       ///< out of memory, at the end of any call
} dem_room;

/// `radii` of the bodies to come [m]. Errors: DEM_USAGE, DEM_NO_MEMORY.
dem_status dem_room_create(dem_room *room, const dem_fill_def *fill, const dem_fill_shape *shapes, size_t shape_count,
                           const dem_fill_obstacles *there, const double *radii, size_t count, dem_error *error);
void dem_room_release(dem_room *room);

/// A trial of a body; needs dem_room_turn before it can be tested.
void dem_room_take(const dem_room *room, dem_room_trial *trial, uint32_t shape, double scale);
void dem_room_turn(const dem_room *room, dem_room_trial *trial, dem_quat orientation);

typedef enum dem_room_sight {
    DEM_ROOM_BLOCKED,  ///< overlaps in every orientation
    DEM_ROOM_NEAR,     ///< dem_room_fits tells
    DEM_ROOM_FREE,     ///< no body or wall is near, in any orientation
} dem_room_sight;

enum { DEM_ROOM_NONE = UINT32_MAX };
/// Collects what is near the trial's centre at `position`, but for the body `without` (DEM_ROOM_NONE: all).
dem_room_sight dem_room_look(dem_room *room, const dem_room_trial *trial, dem_vec3 position, uint32_t without);
/// Whether the trial, as it is turned, fits where the last look (NEAR or FREE) was. The box is not asked.
bool dem_room_fits(dem_room *room, const dem_room_trial *trial, dem_vec3 position);
/// Whether it is inside of the box.
bool dem_room_inside(const dem_room *room, const dem_room_trial *trial, dem_vec3 position);
/// Where its centre can be, as it is turned, to be inside; false: nowhere.
bool dem_room_range(const dem_room *room, const dem_room_trial *trial, dem_vec3 *low, dem_vec3 *high);

/// Adds the trial there; the index of the new body or DEM_ROOM_NONE: out of memory.
uint32_t dem_room_add(dem_room *room, const dem_room_trial *trial, dem_vec3 position);
/// The body becomes the trial, which is of the same shape, at another place.
void dem_room_move(dem_room *room, uint32_t body, const dem_room_trial *trial, dem_vec3 position);

/// Whether no point within `half` of `centre` can hold the centre of a body with that core: it would overlap a ball or
/// cross a wall.
bool dem_room_covered(dem_room *room, dem_vec3 centre, double half, double core);

/// The point, in the plane of a flat room.
static inline dem_vec3 room_point(const dem_room *room, dem_vec3 position)
{
    return v3(position.x, position.y, room->flat ? (room->low.z + room->high.z) / 2 : position.z);
}

/// The point in the periodic domain.
dem_vec3 dem_room_wrapped(const dem_room *room, dem_vec3 position);

#endif
