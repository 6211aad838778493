/// The results of a run, read back from its directory: its scene from run.json, its last state from final.csv.
#ifndef DEM_OUT_RESULTS_H
#define DEM_OUT_RESULTS_H

#include "dem/scene.h"
#include "dem/world.h"

typedef struct dem_results {
    dem_scene scene;       ///< without its bodies
    dem_body_view bodies;  ///< positions, orientations, sizes and velocities; no forces, no coordination
    dem_clump **clumps;    ///< of the shapes
    double time;           ///< of the last state [s]
} dem_results;

/// Errors: DEM_BAD_INPUT where a file is missing or is none of ours, DEM_NO_MEMORY. To be released either way.
dem_status dem_results_read(const dem_ctx *ctx, const char *directory, dem_results *results, dem_error *error);
void dem_results_release(dem_results *results);

#endif
