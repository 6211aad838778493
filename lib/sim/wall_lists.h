/// The listed contacts of bodies with walls: refreshed like pairs, by body.
#ifndef DEM_SIM_WALL_LISTS_H
#define DEM_SIM_WALL_LISTS_H

#include "sim/contacts.h"

/// Looks at the walls near those asked bodies whose wall limit is used up, and rebuilds the lists that change.
dem_status dem_wall_refresh(dem_world *world, dem_error *error);

#endif
