/// Points of a cubic lattice in and around the grain, as bits: which lie inside, which a set of balls covers.
#ifndef DEM_CLUMP_PACK_LATTICE_H
#define DEM_CLUMP_PACK_LATTICE_H

#include "clump/pack_columns.h"

/// Row l is line l of `rows`; its bits stand for the points x = origin + (64 first[l] + bit) step.
typedef struct dem_lattice {
    dem_columns rows;        ///< along x
    double origin;           ///< of x
    int32_t *first;          ///< [rows] first word, counted from `origin`
    uint32_t *word;          ///< [rows + 1] index of a row's first word
    uint64_t *inside, *covered;
    size_t inside_count;     ///< points inside
} dem_lattice;

/// About `points` of them inside.
dem_status dem_lattice_build(const dem_pack_grain *grain, size_t points, dem_lattice *lattice, dem_error *error);
void dem_lattice_release(dem_lattice *lattice);

void dem_lattice_clear(dem_lattice *lattice);
/// Every k-th inside point, such that there are about `count`; returns how many were written.
size_t dem_lattice_sample(const dem_lattice *lattice, size_t count, dem_vec3 *points);

/// The bits of word w that stand for points i0..i1 of its row.
static inline uint64_t lattice_mask(int32_t w, int32_t i0, int32_t i1)
{
    uint64_t mask = ~(uint64_t)0;
    if (w == i0 >> 6)
        mask &= ~(uint64_t)0 << (i0 & 63);
    if (w == i1 >> 6)
        mask &= ~(uint64_t)0 >> (63 - (i1 & 63));
    return mask;
}

#endif
