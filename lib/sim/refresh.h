/// Near pairs, looked at again when their bodies have moved: which of their spheres may touch soon.
///
/// Every sphere pair nearer than a margin is listed. While the two bodies have not used up the slack with the paths of
/// their fastest surface points, no other pair can touch, so a step tests no candidates.
#ifndef DEM_SIM_REFRESH_H
#define DEM_SIM_REFRESH_H

#include "sim/state.h"

/// Looks at the pairs of the asked bodies whose share of the slack is used up. Sets the limits of all asked bodies;
/// marks the segments dirty whose lists change and leaves the new candidates in dem_world.fresh.
dem_status dem_refresh(dem_world *world, dem_error *error);

/// Lets go of the memory of a refresh. The first lists are of all pairs; later ones are of a few, and there are more who
/// need the memory.
void dem_refresh_forget(dem_world *world);

/// The margin of two bodies that move so far in a step [m].
double dem_refresh_margin(const dem_world *world, size_t a, size_t b, double strides);

#endif
