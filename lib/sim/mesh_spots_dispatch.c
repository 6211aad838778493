#include "sim/mesh_spots.h"

#include "base/level.h"

static const dem_mesh_spots *const sets[] = DEM_LEVELS_OF(dem_mesh_spots);

const dem_mesh_spots *dem_mesh_spots_choose(const char *name)
{
    int level = dem_level_find(name);
    return level < 0 ? NULL : sets[level];
}
