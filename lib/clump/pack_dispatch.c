#include "clump/pack_kernels.h"

#include "base/level.h"

static const dem_pack_kernels *const sets[] = DEM_LEVELS_OF(dem_pack_kernels);

const dem_pack_kernels *dem_pack_kernels_choose(const char *name)
{
    int level = dem_level_find(name);
    return level < 0 ? NULL : sets[level];
}
