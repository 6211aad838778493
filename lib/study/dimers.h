/// The random packing of dimers without friction against their aspect ratio, as cells of a study: 0.64 for spheres,
/// about 0.70 near 1.4, falling beyond.
#ifndef DEM_STUDY_DIMERS_H
#define DEM_STUDY_DIMERS_H

#include "study/cells.h"
#include "study/jam.h"

typedef struct dem_dimers {
    const double *aspects;
    size_t count;
    size_t seeds;
    dem_jam_def jam;        ///< without clump; its seed is the first
    const char *directory;  ///< where results are kept; NULL: they are not
    size_t only;            ///< one cell; DEM_ALL_CELLS
} dem_dimers;

/// Every aspect ratio with the first seed, then with the second. `results` [count * seeds], with numbers
/// solid_fraction, contacts, loose, seconds. Errors: see dem_cells_run; DEM_USAGE for an aspect ratio outside 1..2.
dem_status dem_dimers_run(const dem_ctx *ctx, const dem_dimers *dimers, dem_cell_result *results, dem_error *error);

/// What others found: for plots and verdicts.
typedef struct dem_dimers_known {
    double aspect, solid_fraction;
} dem_dimers_known;
extern const dem_dimers_known dem_dimers_sphere, dem_dimers_peak;
/// Within which the figures are to agree.
extern const double dem_dimers_tolerance;

#endif
