#include "base/level.h"

#include <stdbool.h>
#include <string.h>

static const char *const names[DEM_LEVELS] = {"plain", "v3", "v4"};

const char *dem_level_name(int level)
{
    return names[level];
}

static bool runs(int level)
{
#ifdef DEM_X86
    bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
              __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
    bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
              __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
              __builtin_cpu_supports("avx512vl");
    return level == 0 || (level == 1 ? v3 : v4);
#else
    return level == 0;
#endif
}

int dem_level_find(const char *name)
{
    for (int level = DEM_LEVELS - 1; level >= 0; level--)
        if ((!name || strcmp(names[level], name) == 0) && runs(level))
            return level;
    return -1;
}
