/// What the form of grains does to what they do together: measured tests of several variants of a grain, each with
/// several seeds, as the cells of a study.
#ifndef DEM_STUDY_SHAPE_STUDY_H
#define DEM_STUDY_SHAPE_STUDY_H

#include "study/cells.h"
#include "study/lab.h"
#include "study/statistics.h"

typedef struct dem_variant {
    char name[64];
    double x;                ///< where it stands on the axis: number of spheres, aspect ratio, ...
    const dem_clump *clump;  ///< NULL: a sphere
} dem_variant;

enum { DEM_STUDY_TESTS = 8 };

typedef struct dem_shape_study {
    const dem_variant *variants;  ///< the last one is what the others are compared with
    size_t variant_count;
    const dem_lab_test *tests[DEM_STUDY_TESTS];
    double values[DEM_STUDY_TESTS][DEM_LAB_PARAMS];
    size_t test_count;
    dem_multiple multiple;
    size_t seeds;  ///< the first `seed`, the others behind it
    uint64_t seed;
    const char *directory;  ///< where results are kept; NULL: they are not
    size_t only;            ///< one cell; DEM_ALL_CELLS
} dem_shape_study;

/// Every variant and test with the first seed, then with the second.
typedef struct dem_shape_cell {
    size_t variant, test;
    uint64_t seed;
} dem_shape_cell;
size_t dem_shape_cells(const dem_shape_study *study);
dem_shape_cell dem_shape_cell_at(const dem_shape_study *study, size_t cell);

/// `results` [dem_shape_cells], to be released; see dem_cells_run.
dem_status dem_shape_run(const dem_ctx *ctx, const dem_shape_study *study, dem_cell_result *results, dem_error *error);

/// Of a figure over the seeds. `name`: a figure of the test, or "seconds".
dem_mean dem_shape_mean(const dem_shape_study *study, const dem_cell_result *results, size_t variant, size_t test,
                        const char *name);

/// The first variant from which on the figure cannot be told from that of the last one: the difference of each is at
/// most what the errors of both make, and the means differ by less than that. variant_count: not known, for
/// want of seeds or because the errors are so large that they agree with anything.
size_t dem_shape_enough(const dem_shape_study *study, const dem_cell_result *results, size_t test, const char *name);

#endif
