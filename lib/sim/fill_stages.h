/// The stages of a fill, each for what the one before could not place.
#ifndef DEM_SIM_FILL_STAGES_H
#define DEM_SIM_FILL_STAGES_H

#include "base/random.h"
#include "math/quat.h"
#include "sim/fill_draw.h"
#include "sim/fill_room.h"

/// A fill under way. Bodies are counted in the order of placing, the largest bounding sphere first.
typedef struct dem_filling {
    const dem_ctx *ctx;
    const dem_fill_def *fill;
    const dem_fill_draw *draws;
    const uint32_t *order;  ///< draw of each body
    uint32_t *held;         ///< index in the room of each body that is placed
    size_t count, placed;   ///< bodies to place; the first `placed` are in the room
    size_t done;            ///< bodies that need no more work
    dem_room *room;
    dem_room_trial trial;
    uint64_t turns;  ///< trials, for the progress
} dem_filling;

/// What a stage came to. A failure leaves bodies in the room.
typedef enum dem_filled { DEM_FILLED, DEM_FILL_FULL, DEM_FILL_STOPPED, DEM_FILL_NO_MEMORY } dem_filled;

dem_filled dem_fill_random(dem_filling *f);
dem_filled dem_fill_voids(dem_filling *f);
/// Moves bodies of the fill. f->done of them are in full size at the end, no longer the first ones; `volume` is theirs
/// [m^3].
dem_filled dem_fill_grow(dem_filling *f, double *volume);
/// Needs an empty room.
dem_filled dem_fill_lattice(dem_filling *f);

/// Volume of the grain that a body is [m^3].
double dem_fill_volume(const dem_filling *f, size_t body);
/// Makes the trial one of the body.
void dem_fill_take(dem_filling *f, size_t body);
/// Whether the trial, turned already and inside of the box, finds room there; tries a few more orientations.
bool dem_fill_try(dem_filling *f, dem_random *r, dem_vec3 position, dem_room_sight *sight);
/// Puts the trial into the room as body f->placed, which is counted. False: out of memory.
bool dem_fill_put(dem_filling *f, dem_vec3 position);
/// Counts a trial; true: the caller wants to stop.
bool dem_fill_stop(dem_filling *f);

/// Uniform over all orientations: a normalised vector of four normal numbers.
static inline dem_quat fill_orientation(dem_random *r)
{
    double w = random_normal(r), x = random_normal(r), y = random_normal(r), z = random_normal(r);
    return w == 0 && x == 0 && y == 0 && z == 0 ? (dem_quat){1, 0, 0, 0} : quat_unit((dem_quat){w, x, y, z});
}
static inline dem_vec3 fill_point(dem_random *r, dem_vec3 low, dem_vec3 high)
{
    double u = random_uniform(r), v = random_uniform(r), w = random_uniform(r);
    return v3(low.x + u * (high.x - low.x), low.y + v * (high.y - low.y), low.z + w * (high.z - low.z));
}

#endif
