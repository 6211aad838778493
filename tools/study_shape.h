/// `dem-study shape`: what the form of grains does to what they do together.
#ifndef DEM_TOOLS_STUDY_SHAPE_H
#define DEM_TOOLS_STUDY_SHAPE_H

#include "cli.h"
#include "study/shape_study.h"

/// The subcommand, argv[0] its name; returns the exit status.
int study_shape(int argc, char **argv);

enum { SHAPE_MOST = 32 };

typedef enum shape_series { SHAPE_GRAIN, SHAPE_ASPECT, SHAPE_ROUNDNESS, SHAPE_ANGULARITY, SHAPE_CLUSTERS } shape_series;

/// The grains of a study.
typedef struct shape_grains {
    dem_variant variants[SHAPE_MOST];
    dem_clump *clumps[SHAPE_MOST];  ///< owned
    size_t count;
    const char *axis;  ///< title of what they differ by
    bool log;
    bool spheres;  ///< the same grain of more and more spheres
} shape_grains;

/// What is asked for.
typedef struct shape_request {
    shape_series series;
    const char *mesh;           ///< of SHAPE_GRAIN
    double counts[SHAPE_MOST];  ///< of spheres, ascending; of families the last one counts
    size_t count_count;
    int effort, repair;
    uint64_t seed;
    const char *folder;  ///< clumps are kept in `clumps` of it, and taken from there
} shape_request;

// study_shape_grains.c
dem_status shape_grains_make(const dem_ctx *ctx, const shape_request *request, shape_grains *grains, dem_error *error);
void shape_grains_release(shape_grains *grains);

/// Everything that is told.
typedef struct shape_told {
    const dem_shape_study *study;
    const dem_cell_result *results;
    const shape_grains *grains;
    const char *title;
    shape_series series;
    size_t missing, failed;
} shape_told;

// study_shape_page.c
dem_status shape_page(const dem_ctx *ctx, dem_buffer *out, const shape_told *told, dem_error *error);
void shape_csv(dem_buffer *out, const shape_told *told);
void shape_text(dem_buffer *out, const shape_told *told);
void shape_json(dem_buffer *out, cli_session *session, const shape_told *told);

#endif
