/// What happens when bodies have moved as far as their lists allow.
#ifndef DEM_SIM_LISTS_H
#define DEM_SIM_LISTS_H

#include "sim/state.h"

/// Takes up the asked bodies: checks that they are sound, searches for pairs when some have used up the skin, refreshes
/// walls and pairs, rebuilds lists. Errors: DEM_FAILED for a body that is not finite, runs away or leaves the domain.
dem_status dem_lists_update(dem_world *world, dem_error *error);

/// A search for pairs, and all lists anew.
dem_status dem_lists_renew(dem_world *world, dem_error *error);

/// Whether the centre of the body is beyond a side of the domain that is not periodic.
bool dem_lists_outside(const dem_world *world, size_t row);

#endif
