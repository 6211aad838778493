#include <string.h>

#include "sim/kernels.h"

static const dem_kernels *const sets[] = {
#ifdef DEM_X86
    &dem_kernels_v4,
    &dem_kernels_v3,
#endif
    &dem_kernels_plain,
};

const dem_kernels *const *dem_kernels_all(size_t *count)
{
    *count = sizeof sets / sizeof *sets;
    return sets;
}

const dem_kernels *dem_kernels_choose(const char *name)
{
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++)
        if ((!name || strcmp(sets[i]->name, name) == 0) && sets[i]->usable())
            return sets[i];
    return NULL;
}

const dem_contact_instance *dem_kernels_instance(const dem_kernels *kernels, dem_features features)
{
    const dem_contact_instance *i = kernels->instances;
    while (!i->any && memcmp(&i->features, &features, sizeof features) != 0)
        i++;
    return i;
}
