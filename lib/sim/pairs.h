/// The list of near pairs of bodies: what one search found takes the place of what the last one did.
#ifndef DEM_SIM_PAIRS_H
#define DEM_SIM_PAIRS_H

#include "sim/state.h"

/// Bodies a <= b, and the image of b that is near.
typedef struct dem_near {
    uint32_t a, b, image;
} dem_near;

/// Makes the pairs of `near`, which it may sort, the world's, and keeps what is known of those that were there before.
/// by_a: they are in the order of a. moved: sides by which bodies were put back into a periodic domain, three a body.
dem_status dem_pairs_replace(dem_world *world, dem_near *near, size_t count, bool by_a, const int32_t *moved,
                             dem_error *error);

void dem_pairs_release(dem_pairs *pairs);

#endif
