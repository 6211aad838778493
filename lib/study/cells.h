/// The cells of a study: runs that do not depend on each other. Several at once on one machine, or one by one as jobs
/// of a cluster; what a cell has found is kept in a file of its own, so that an interrupted study goes on where it
/// stopped.
#ifndef DEM_STUDY_CELLS_H
#define DEM_STUDY_CELLS_H

#include "base/json.h"
#include "dem/base.h"

#define DEM_ALL_CELLS SIZE_MAX

typedef struct dem_cells_def {
    const char *directory;  ///< results are kept in `cells/NNNN.json` of it; NULL: they are not
    size_t count;
    size_t only;  ///< the one cell to run; DEM_ALL_CELLS
    void *user;
    /// Appends everything that a cell's result depends on, as text. A result with another text is not taken from its
    /// file. Cells that differ have different texts.
    void (*describe)(void *user, size_t cell, dem_buffer *inputs);
    /// Runs a cell with ctx->threads threads (1 where several cells run at once) and writes what it finds as members
    /// of an object. Called from several threads.
    dem_status (*run)(void *user, size_t cell, const dem_ctx *ctx, dem_json_writer *found, dem_error *error);
} dem_cells_def;

/// What is known of a cell.
typedef struct dem_cell_result {
    dem_status status;  ///< DEM_INTERRUPTED: not run
    dem_error error;
    dem_json *found;  ///< NULL where it failed or was not run
    bool kept;        ///< taken from its file
    double seconds;   ///< it took when it was run
} dem_cell_result;

/// Runs the cells that have no result yet, by ctx->threads at once; `results` [count]. That some have failed is told by
/// the results alone and tried again the next time. Errors: DEM_INTERRUPTED, DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_cells_run(const dem_ctx *ctx, const dem_cells_def *def, dem_cell_result *results, dem_error *error);
void dem_cells_release(dem_cell_result *results, size_t count);

/// A number that was found, NAN where it is not there or was not finite.
double dem_cell_number(const dem_cell_result *result, const char *name);
/// Several of them, at most `most`; returns how many.
size_t dem_cell_numbers(const dem_cell_result *result, const char *name, double *values, size_t most);

#endif
