/// Memory: checked array allocation, growable arrays, and an arena for work space.
#ifndef DEM_BASE_MEMORY_H
#define DEM_BASE_MEMORY_H

#include "base/status.h"

/// malloc of count * size bytes without overflow; NULL when it cannot be had. count 0 gives a valid pointer.
void *dem_alloc(size_t count, size_t size);
/// The same, zeroed.
void *dem_alloc_zero(size_t count, size_t size);

/// Makes room for one more item in a growable array. `*array` holds *capacity items of `size` bytes;
/// grows by half. False: out of memory, the array is untouched.
bool dem_grow(void *array, size_t *capacity, size_t count, size_t size);

/// Work space released as a whole. Zero-initialise, take from it, release at the end. Blocks are 64-byte
/// aligned. After a failed take `failed` is set, so that one check after several takes is enough.
typedef struct dem_arena {
    struct dem_arena_chunk *chunks;
    bool failed;
} dem_arena;

void *dem_arena_take(dem_arena *arena, size_t count, size_t size);
void dem_arena_release(dem_arena *arena);

#endif
