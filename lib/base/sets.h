/// Disjoint sets of numbers 0..n-1 (Tarjan 1975). parent[i] == i where i stands for its set; the smallest does.
#ifndef DEM_BASE_SETS_H
#define DEM_BASE_SETS_H

#include <stddef.h>
#include <stdint.h>

static inline void sets_init(uint32_t *parent, size_t count)
{
    for (size_t i = 0; i < count; i++)
        parent[i] = (uint32_t)i;
}
static inline uint32_t sets_root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}
static inline void sets_join(uint32_t *parent, uint32_t a, uint32_t b)
{
    a = sets_root(parent, a);
    b = sets_root(parent, b);
    parent[a > b ? a : b] = a < b ? a : b;
}

#endif
