/// Balls to start from: those that touch the surface from inside at two places or more.
#ifndef DEM_CLUMP_PACK_CANDIDATES_H
#define DEM_CLUMP_PACK_CANDIDATES_H

#include "base/crew.h"
#include "clump/pack_kernels.h"

typedef struct dem_candidates {
    dem_ball *balls;
    size_t count;
    uint32_t *at_block;     ///< [surface_blocks + 1] candidates of a block: those whose first touching point is nearest to it
} dem_candidates;

/// Largest ball that touches the surface at p, unit outward normal n, from inside and contains no part of it deeper
/// than 2 / 1000 of its radius.
double dem_medial_radius(const dem_tree *tree, dem_vec3 p, dem_vec3 n);

dem_status dem_candidates_build(const dem_pack_grain *grain, const dem_samples *samples,
                                const dem_pack_kernels *kernels, size_t count, int threads,
                                dem_candidates *candidates, dem_error *error);
void dem_candidates_release(dem_candidates *candidates);

/// Chooses up to `most` balls, candidates made larger by one of `inflations`, each time the one that shrinks the
/// symmetric difference on the lattice most, until none does.
dem_status dem_candidates_greedy(const dem_candidates *candidates, dem_lattice *lattice,
                                 const dem_pack_kernels *kernels, const double *inflations, size_t inflation_count,
                                 size_t most, dem_crew *crew, dem_ball *chosen, size_t *chosen_count,
                                 dem_error *error);

#endif
