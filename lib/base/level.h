/// Levels of the instruction set that hot loops are compiled for (kernels.cmake): plain, and v3 and v4 of x86-64. A
/// family of loops is a struct of functions, `family_plain` and so on, and is chosen once at start.
#ifndef DEM_BASE_LEVEL_H
#define DEM_BASE_LEVEL_H

#ifndef DEM_KERNELS
#define DEM_KERNELS plain
#endif
#define DEM_LEVEL_JOIN_(family, level) family##_##level
#define DEM_LEVEL_JOIN(family, level) DEM_LEVEL_JOIN_(family, level)
#define DEM_LEVEL_TEXT_(level) #level
#define DEM_LEVEL_TEXT(level) DEM_LEVEL_TEXT_(level)

/// What this file is compiled for, and the name of its member of a family.
#define DEM_LEVEL_NAME DEM_LEVEL_TEXT(DEM_KERNELS)
#define DEM_LEVEL_OF(family) DEM_LEVEL_JOIN(family, DEM_KERNELS)

/// The members of a family that are built in, by level.
#ifdef DEM_X86
#define DEM_LEVELS_OF(family)                                                                                          \
    {                                                                                                                  \
        &family##_plain, &family##_v3, &family##_v4                                                                    \
    }
#else
#define DEM_LEVELS_OF(family)                                                                                          \
    {                                                                                                                  \
        &family##_plain                                                                                                \
    }
#endif
enum { DEM_LEVELS = 3 };

/// "plain", "v3", "v4"
const char *dem_level_name(int level);

/// The named level, or the highest (NULL), of those that are built in and that this machine runs; -1: not one of them.
int dem_level_find(const char *name);

#endif
