/// Clumps for other programs: a registry of formats.
///
/// A format is one file export_<name>.c with one const record, and one line in export.c.
#ifndef DEM_OUT_EXPORT_H
#define DEM_OUT_EXPORT_H

#include "base/text.h"
#include "dem/clump.h"
#include "math/quat.h"

typedef enum dem_frame {
    DEM_FRAME_PRINCIPAL,  ///< the clump's own, in metres
    DEM_FRAME_MESH,       ///< that of the mesh it was made from, in metres
} dem_frame;

/// Zero-initialised: principal frame, no mesh, all cores.
typedef struct dem_export_options {
    dem_frame frame;        ///< for the formats that have only spheres: xyzr, stl, vtp
    const dem_mesh *mesh;   ///< in its own frame [m]; NULL: the surface kept in the clump serves instead
    int threads;
} dem_export_options;

typedef struct dem_exporter {
    const char *name;
    const char *suffix;  ///< of file names that mean this format
    const char *about;
    bool needs_mesh;  ///< looks better with `mesh` given
    /// Appends the file. Errors: DEM_NO_MEMORY, DEM_UNAVAILABLE, DEM_INTERRUPTED.
    dem_status (*write)(const dem_clump *clump, const dem_export_options *options, dem_buffer *out, dem_error *error);
} dem_exporter;

/// All formats, NULL behind the last.
const dem_exporter *const *dem_exporters(void);
/// By name, or by the suffix of a file; NULL: there is none.
const dem_exporter *dem_exporter_find(const char *name);
const dem_exporter *dem_exporter_of_file(const char *path);

/// Writes the file whole or not at all; "-" is standard output. Also DEM_CANNOT_WRITE.
dem_status dem_export(const dem_exporter *exporter, const dem_clump *clump, const dem_export_options *options,
                      const char *path, dem_error *error);

/// A clump's ball in the asked frame [m].
static inline dem_ball export_ball(const dem_export_options *options, const dem_clump_def *clump, dem_ball ball)
{
    if (options->frame == DEM_FRAME_MESH)
        ball.centre = v3_add(clump->position, quat_rotate(clump->orientation, ball.centre));
    return ball;
}

/// All balls in the asked frame [m], to be freed; NULL: out of memory.
dem_ball *dem_export_balls(const dem_export_options *options, const dem_clump_def *clump);

#endif
