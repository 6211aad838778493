/// The results of a run, read back from its directory: its scene from run.json, its last state from final.csv, its
/// frames from run.pvd and the files named there.
#ifndef DEM_OUT_RESULTS_H
#define DEM_OUT_RESULTS_H

#include "dem/scene.h"
#include "dem/world.h"
#include "out/pvd.h"
#include "out/vtp_read.h"

typedef struct dem_results {
    char *directory;
    dem_scene scene;       ///< without its bodies
    dem_clump **clumps;    ///< of the shapes
    double *diameters;     ///< of the shapes: of the spheres of equal volume [m]
    double end;            ///< time of the last state [s]; NAN: not known
    dem_pvd index;         ///< frames and their times, ascending
    dem_body_view bodies;  ///< of what was read last; a column that is not known is NULL
    dem_wall_view *walls;  ///< poses of the scene's walls at that time
    double **worn;         ///< arrays of their wear
    double time;           ///< of the bodies [s]; NAN: not known
    dem_vtp_file frame;    ///< what was read, where that is a frame
} dem_results;

/// Everything but bodies. Errors: DEM_BAD_INPUT where a file is missing or is none of ours, DEM_NO_MEMORY. To be
/// released either way.
dem_status dem_results_open(const dem_ctx *ctx, const char *directory, dem_results *results, dem_error *error);

/// The bodies of a frame of the index. Also DEM_BAD_INPUT where they do not fit the scene.
dem_status dem_results_frame(dem_results *results, size_t index, dem_error *error);

/// Those of any file written as a frame of this run.
dem_status dem_results_frame_file(dem_results *results, const char *path, dem_error *error);

/// Those of the last state: the last frame where it is of that time, else final.csv.
dem_status dem_results_last(dem_results *results, dem_error *error);

/// What was worn off the walls by then, into their views: from the file of walls whose time is nearest. A run without
/// frames has none.
dem_status dem_results_wear(dem_results *results, dem_error *error);

/// dem_results_open and dem_results_last.
dem_status dem_results_read(const dem_ctx *ctx, const char *directory, dem_results *results, dem_error *error);

/// The frame nearest to a time; DEM_USAGE where there is none within half the interval to its neighbour.
dem_status dem_results_at(const dem_results *results, double time, size_t *index, dem_error *error);

void dem_results_release(dem_results *results);

#endif
