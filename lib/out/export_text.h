/// What the text formats share: numbers in a row, comments, and the head that says what a file holds.
#ifndef DEM_OUT_EXPORT_TEXT_H
#define DEM_OUT_EXPORT_TEXT_H

#include "out/export.h"
#include "out/names.h"

/// Numbers with 17 digits, `between` them, a newline behind the last.
void dem_export_put_row(dem_buffer *out, const double *values, size_t count, const char *between);

/// x, y, z and radius of a sphere likewise.
void dem_export_put_ball(dem_buffer *out, dem_ball ball, const char *between);

/// A comment line; `mark` is what starts one in this format, with a blank: "# ".
void dem_export_put_comment(dem_buffer *out, const char *mark, const char *format, ...) DEM_PRINTF(3, 4);

/// A comment line "what: values".
void dem_export_put_figures(dem_buffer *out, const char *mark, const char *what, const double *values, size_t count);

/// Density, mass, centre, moments, and the way back to the mesh, as comments.
void dem_export_put_mass(dem_buffer *out, const char *mark, const dem_clump_def *clump, dem_vec3 centre);

/// How a file for another program begins.
typedef struct dem_export_head {
    const char *mark;        ///< what starts a comment
    const char *what;        ///< program and format
    const char *const *use;  ///< lines, NULL behind the last; FILE and NAME stand for those of the clump
    const char *suffix;
} dem_export_head;

/// The head: what the file is, how it is used, the frame, the clump's mass and what its spheres alone would have.
void dem_export_put_head(dem_buffer *out, const dem_export_head *head, const dem_clump_def *clump,
                         const dem_export_options *options);

/// The clump's name as it can stand in commands and source: letters, digits and '_', a letter first.
dem_plain_name dem_export_identifier(const dem_clump_def *clump);

/// Name of the file for texts that tell how to use it.
dem_plain_name dem_export_file_name(const dem_clump_def *clump, const dem_export_options *options, const char *suffix);

/// Radius of the smallest sphere about the centre of mass that holds all spheres [m].
double dem_export_reach(const dem_clump_def *clump);

#endif
