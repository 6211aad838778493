/// The name that was probably meant by one that is not known.
#ifndef DEM_BASE_NEAREST_H
#define DEM_BASE_NEAREST_H

#include <stddef.h>

/// The name nearest to what was typed, or NULL if none is near; `next` yields names until NULL.
const char *dem_nearest(const char *typed, const char *(*next)(const void *user, size_t index), const void *user);

#endif
