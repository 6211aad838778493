#include "sim/mesh_spots.h"

#include <string.h>

static const dem_mesh_spots *const sets[] = {
#ifdef DEM_X86
    &dem_mesh_spots_v4,
    &dem_mesh_spots_v3,
#endif
    &dem_mesh_spots_plain,
};

const dem_mesh_spots *dem_mesh_spots_choose(const char *name)
{
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++)
        if ((!name || strcmp(sets[i]->name, name) == 0) && sets[i]->usable())
            return sets[i];
    return NULL;
}
