/// Balls near mesh walls: their candidate triangles between refreshes, and the contacts they make in each step.
///
/// The mesh knows geometry (mesh_wall.h); here a ball's contacts of one step are matched with those of the last, so
/// that a spring goes on where the ball rolls from one triangle to the next.
#ifndef DEM_SIM_MESH_TOUCH_H
#define DEM_SIM_MESH_TOUCH_H

#include "base/memory.h"
#include "dem/world.h"
#include "sim/kernels.h"
#include "sim/mesh_wall.h"

/// The overlap of places without a contact [m]. Surfaces that hold on to each other have less of a gap.
#define DEM_MESH_NO_OVERLAP (-1.0)

/// One ball near one mesh wall.
typedef struct dem_mesh_touch {
    uint32_t a, sphere, wall;   ///< rows
    uint32_t slot, slot_count;  ///< its places in the segment's list of mesh contacts
    uint32_t first, count;      ///< its candidates in `triangles`
    uint32_t last_count;        ///< contacts of the last step, in `last` from `slot`
} dem_mesh_touch;

/// What of it need not be asked again until its body and the walls have gone some way. It is no part of the state: with
/// and without it the same contacts are found.
typedef struct dem_mesh_near {
    double until;    ///< it holds while the path of the body plus that of walls is up to this; -1: nothing is known [m]
    uint32_t count;  ///< of the candidates, those that the ball may touch, in `close`; of a smooth wall 0 or 1
    uint32_t shown;  ///< so many of its slots may hold a contact in the columns, the others say that none is there
} dem_mesh_near;

/// Those of a segment, in the order of its list.
typedef struct dem_mesh_touches {
    dem_mesh_touch *items;
    dem_mesh_near *near;  ///< [count]
    size_t count, capacity, near_capacity;
    uint32_t *triangles;
    uint32_t *close;  ///< [triangle_count]
    size_t triangle_count, triangle_capacity, close_capacity;
    dem_mesh_contact *last;  ///< [slots], in the frame of the wall
    size_t last_capacity;
} dem_mesh_touches;

void dem_mesh_touches_release(dem_mesh_touches *touches);

/// Makes room for what is known of the touches, which is nothing. False: no memory.
bool dem_mesh_touches_forget(dem_mesh_touches *touches);

/// Appends the balls of a body that are nearer to a mesh wall than the margin. `slack` receives how far the body may go
/// before it is looked at again [m]. False: no memory.
bool dem_mesh_touch_search(dem_world *world, size_t row, uint32_t wall, double margin, dem_mesh_touches *touches,
                           double *slack);

/// Appends a touch of another list with its triangles and last contacts, at another slot. False: no memory.
bool dem_mesh_touch_copy(const dem_mesh_touches *from, const dem_mesh_touch *touch, uint32_t slot,
                         dem_mesh_touches *to);

/// Gives the touches from `from` on the last contacts that the same balls had in the old list. False: no memory.
bool dem_mesh_touch_remember(const dem_mesh_touches *old, dem_mesh_touches *touches, size_t from);

/// The contacts of the balls of the segments [begin, end) as they stand now: geometry columns and springs. Doing it
/// again where nothing has moved changes nothing.
void dem_mesh_touch_measure(dem_world *world, size_t begin, size_t end);

/// Whether none of the 8 contacts from `begin` on is one, so that nothing would come of them.
static inline bool dem_mesh_block_idle(const dem_contact_columns *c, size_t begin)
{
    int some = 0;
    for (size_t i = begin; i < begin + DEM_BLOCK_LANES; i++)
        some |= c->geometry[3][i] != DEM_MESH_NO_OVERLAP;
    return !some;
}

/// The same of all, with the wear that comes of it. Error: DEM_NO_MEMORY.
dem_status dem_mesh_touch_measure_all(dem_world *world, dem_error *error);

#endif
