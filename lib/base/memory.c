#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

struct dem_arena_chunk {
    struct dem_arena_chunk *next;
    size_t used, size;
};

enum { ALIGNMENT = 64, CHUNK_BYTES = 1 << 18 };

void *dem_alloc(size_t count, size_t size)
{
    if (size && count > (SIZE_MAX / 2) / size)
        return NULL;
    size_t bytes = count * size;
    return malloc(bytes ? bytes : 1);
}

void *dem_alloc_zero(size_t count, size_t size)
{
    if (size && count > (SIZE_MAX / 2) / size)
        return NULL;
    return calloc(count ? count : 1, size ? size : 1);
}

bool dem_grow(void *array, size_t *capacity, size_t count, size_t size)
{
    if (count < *capacity)
        return true;
    size_t wanted = *capacity + *capacity / 2 + 16;
    if (wanted > (SIZE_MAX / 2) / size)
        return false;
    void *old;
    memcpy(&old, array, sizeof old);
    void *grown = realloc(old, wanted * size);
    if (!grown)
        return false;
    memcpy(array, &grown, sizeof grown);
    *capacity = wanted;
    return true;
}

void *dem_arena_take(dem_arena *arena, size_t count, size_t size)
{
    if (size && count > (SIZE_MAX / 4) / size) {
        arena->failed = true;
        return NULL;
    }
    size_t bytes = (count * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    struct dem_arena_chunk *chunk = arena->chunks;
    if (!chunk || chunk->size - chunk->used < bytes) {
        size_t room = bytes + ALIGNMENT > CHUNK_BYTES ? bytes + ALIGNMENT : CHUNK_BYTES;
        chunk = aligned_alloc(ALIGNMENT, room);
        if (!chunk) {
            arena->failed = true;
            return NULL;
        }
        *chunk = (struct dem_arena_chunk){.next = arena->chunks, .used = ALIGNMENT, .size = room};
        arena->chunks = chunk;
    }
    void *block = (char *)chunk + chunk->used;
    chunk->used += bytes;
    return block;
}

void dem_arena_release(dem_arena *arena)
{
    while (arena->chunks) {
        struct dem_arena_chunk *next = arena->chunks->next;
        free(arena->chunks);
        arena->chunks = next;
    }
    arena->failed = false;
}
