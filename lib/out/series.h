/// The history of a run as a table: DIR/series.csv, a row per time, units in the names of the columns, every number
/// as short as is read back without loss.
#ifndef DEM_OUT_SERIES_H
#define DEM_OUT_SERIES_H

#include "base/status.h"
#include "dem/scene.h"
#include "dem/world.h"

typedef struct dem_series dem_series;

/// What the columns behind those of the whole stand for; borrowed while it is opened.
typedef struct dem_series_def {
    const char *directory;      ///< NULL: the table is kept in memory, see dem_series_text
    bool flow;                  ///< bodies come and go: columns of how many and how much
    const dem_wall_def *walls;  ///< six columns each: what the bodies do to it
    size_t wall_count;
    const dem_measure_def *measures;  ///< see dem_measure_view
    size_t measure_count;
    bool bonds;  ///< three columns: bonds that live, and those that broke
    bool lost;   ///< a fourth one: those that went with a body
} dem_series_def;

/// All that a scene has; `flow` is for the caller to tell.
dem_series_def dem_series_def_of(const dem_scene *scene, const char *directory, bool flow);

/// Begins the table; with a time in `resume` [s] (NAN: a new run) it goes on with the one that is there, from which the
/// rows behind that time are cut. A row that is due at the time of a checkpoint must be written before it. Makes the
/// folder. Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY; DEM_BAD_INPUT for a table to go on with that has other columns.
dem_status dem_series_open(const dem_series_def *def, double resume, dem_series **series, dem_error *error);

/// Appends a row, which is in the file when this returns; a row that cannot be written leaves no part of itself.
/// `walls` [wall_count], `measures` [measure_count]. Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_series_write(dem_series *series, const dem_figures *figures, const dem_wall_view *walls,
                            const dem_measure_view *measures, dem_error *error);

/// What is in the table by now, where it is kept in memory; NULL: it is not, or there is no memory.
const char *dem_series_text(const dem_series *series);

/// How many there are, with those that stayed.
size_t dem_series_rows(const dem_series *series);

void dem_series_close(dem_series *series);

#endif
