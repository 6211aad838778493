#include <string.h>

#include "clump/pack_kernels.h"

static const dem_pack_kernels *const sets[] = {
#ifdef DEM_X86
    &dem_pack_kernels_v4,
    &dem_pack_kernels_v3,
#endif
    &dem_pack_kernels_plain,
};

const dem_pack_kernels *const *dem_pack_kernels_all(size_t *count)
{
    *count = sizeof sets / sizeof *sets;
    return sets;
}

const dem_pack_kernels *dem_pack_kernels_choose(const char *name)
{
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++)
        if ((!name || strcmp(sets[i]->name, name) == 0) && sets[i]->usable())
            return sets[i];
    return NULL;
}
