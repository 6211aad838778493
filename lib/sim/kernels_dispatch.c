#include "sim/kernels.h"

#include <string.h>

#include "base/level.h"

static const dem_kernels *const sets[] = DEM_LEVELS_OF(dem_kernels);

const dem_kernels *dem_kernels_choose(const char *name)
{
    int level = dem_level_find(name);
    return level < 0 ? NULL : sets[level];
}

const dem_contact_instance *dem_kernels_instance(const dem_contact_instance *instances, dem_features features)
{
    const dem_contact_instance *i = instances;
    while (!i->any && memcmp(&i->features, &features, sizeof features) != 0)
        i++;
    return i;
}
