/// A scene run from start to end with all its files: frames, series, checkpoints, final state, report.
#ifndef DEM_OUT_RUN_H
#define DEM_OUT_RUN_H

#include "dem/scene.h"
#include "dem/world.h"

typedef struct dem_run_options {
    const char *resume;  ///< checkpoint to go on from; NULL: from the start
    double until;        ///< end instead of the scene's [s]; NAN: the scene's
    uint64_t steps;      ///< end after so many steps, counted from the scene's start; 0: by time
    uint64_t warmup;     ///< steps before those, not timed
    dem_scene *spent;    ///< the scene, where bodies that files hold may be forgotten; NULL: it stays whole
} dem_run_options;

/// What a run came to. Texts are owned; see dem_run_release.
typedef struct dem_run_result {
    dem_figures figures;
    double step;           ///< the last time step [s]
    double critical_step;  ///< see dem_world_critical_step [s]
    double loop_seconds;   ///< of the timed steps
    double setup_seconds;
    uint64_t timed_steps;
    uint64_t warmup;
    double bytes_per_body;
    int threads;
    dem_pass_time *passes;  ///< seconds of the timed steps; then of output in between, and of ending
    size_t pass_count;
    dem_inlet_view *inlets;  ///< with the names of the scene
    size_t inlet_count;
    char *checkpoint;  ///< the last one written; NULL: none
    char *stopped;     ///< why the run ended before its end; NULL: it did not
} dem_run_result;

/// Runs the scene into its output directory. Errors: DEM_FAILED for an unstable run, DEM_INTERRUPTED with a checkpoint
/// written; both leave a result. DEM_BAD_INPUT, DEM_CANNOT_WRITE, DEM_USAGE (no end).
dem_status dem_run(const dem_ctx *ctx, const dem_scene *scene, const dem_run_options *options, dem_run_result *result,
                   dem_error *error);
void dem_run_release(dem_run_result *result);

#endif
