/// Clumps for other programs: a registry of formats.
///
/// A format is one file export_<name>.c with one const record, and one line in export.c. The name of a file means the
/// format whose suffix or name it ends in: grain.mol and grain.lammps, grain.yade.py and grain.yade. Suffixes that
/// several programs use for everything (.txt, .py, .csv) are told apart by a word before them.
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
    const char *file;       ///< what is written, for texts that say how to use it; dem_export sets it
} dem_export_options;

/// Appends one file. Errors: DEM_NO_MEMORY, DEM_UNAVAILABLE, DEM_INTERRUPTED.
typedef dem_status dem_export_write(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                                    dem_error *error);

/// One file of a format that is a folder.
typedef struct dem_export_part {
    const char *path;  ///< in the folder
    dem_export_write *write;
} dem_export_part;

typedef struct dem_exporter {
    const char *name;
    const char *suffix;  ///< of file names that mean this format
    const char *about;
    bool needs_mesh;  ///< looks better with `mesh` given
    bool for_engine;  ///< the input of another simulation program
    dem_export_write *write;       ///< NULL: a folder of `parts`
    const dem_export_part *parts;  ///< path NULL behind the last
} dem_exporter;

/// All formats, NULL behind the last.
const dem_exporter *const *dem_exporters(void);
/// By name, or by how the name of a file ends; NULL: there is none.
const dem_exporter *dem_exporter_find(const char *name);
const dem_exporter *dem_exporter_of_file(const char *path);
/// How much of `path` stands before what tells this format, or else before the last '.' of its name.
size_t dem_exporter_stem(const dem_exporter *exporter, const char *path);

/// Writes the file whole or not at all; "-" is standard output (not for folders, whose files are written one by one).
/// Also DEM_CANNOT_WRITE and, for a folder to standard output, DEM_USAGE.
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
