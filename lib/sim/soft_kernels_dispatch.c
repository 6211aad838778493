#include "base/level.h"
#include "sim/soft.h"

static const dem_soft_kernels *const sets[] = DEM_LEVELS_OF(dem_soft_kernels);

const dem_soft_kernels *dem_soft_kernels_choose(const char *name)
{
    int level = dem_level_find(name);
    return level < 0 ? NULL : sets[level];
}
