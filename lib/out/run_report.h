/// What came of a run, from plain values: for people, for programs, and as DIR/run.json.
#ifndef DEM_OUT_RUN_REPORT_H
#define DEM_OUT_RUN_REPORT_H

#include "base/text.h"
#include "dem/world.h"

/// Everything is borrowed.
typedef struct dem_run_report {
    const char *title;     ///< of the scene; NULL: none
    const char *scene;     ///< resolved, as JSON; NULL: left out of run.json
    const char *ended;     ///< "done", "interrupted" or why it failed
    dem_figures figures;   ///< at the end
    uint64_t steps;        ///< taken in `loop_seconds`
    uint64_t warmup;       ///< steps at the scene's start that do not count
    double step;           ///< their size at the end [s]
    double critical_step;  ///< INFINITY: no contact [s]
    double loop_seconds, setup_seconds;
    double bytes_per_clump;
    int threads;
    const dem_pass_time *passes;
    size_t pass_count;
    const dem_inlet_view *inlets;
    size_t inlet_count;
    const char *const *warnings;
    size_t warning_count;
} dem_run_report;

/// Appends one JSON object with a newline. Kinetic energy is that of translation and rotation.
void dem_run_report_json(dem_buffer *out, const dem_run_report *report);

/// Appends a screenful of text.
void dem_run_report_text(dem_buffer *out, const dem_run_report *report);

/// Writes DIR/run.json whole or not at all: the object of dem_run_report_json, and the scene.
/// Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_run_report_write(const char *directory, const dem_run_report *report, dem_error *error);

#endif
