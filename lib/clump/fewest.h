/// The fewest spheres for which a bound holds, of an error that falls with the number of spheres, more or less.
#ifndef DEM_CLUMP_FEWEST_H
#define DEM_CLUMP_FEWEST_H

#include "base/status.h"

/// No search tries more numbers than this.
enum { DEM_FEWEST_TRIES = 24 };

/// What was asked for, what came of it, and how it stands to the bound.
typedef struct dem_fewest_try {
    size_t asked, got;  ///< spheres; some methods cannot make the number asked for
    double worst;       ///< error / bound; at most 1: it holds. INFINITY: there is no clump of so many
} dem_fewest_try;

/// Fills `got` and `worst` for try->asked. Any status but DEM_OK ends the search.
typedef dem_status dem_fewest_measure(void *user, dem_fewest_try *attempt, dem_error *error);

/// Is `a` rather to be taken than `b`: it holds with fewer spheres, or, where neither holds, comes nearer?
bool dem_fewest_better(dem_fewest_try a, dem_fewest_try b);

/// Tries numbers from 1 to `most`, first `first`, each at most once, and sets `best`. Where the search was stopped,
/// `best` is the best so far, with `asked` 0 if there is none.
dem_status dem_fewest_search(size_t first, size_t most, dem_fewest_measure *measure, void *user, dem_fewest_try *best,
                             dem_error *error);

#endif
