/// The bonds that have broken, as a table (bonds.csv): when, where, how, and at what stress.
#ifndef DEM_OUT_BREAKAGES_H
#define DEM_OUT_BREAKAGES_H

#include "base/file_queue.h"
#include "dem/scene.h"
#include "dem/world.h"

/// Writes the whole table anew, in the order of time, by the queue (NULL: at once). `defs`: the scene's bonds. Errors:
/// DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_breakages_write(dem_file_queue *queue, const char *directory, const dem_bond_def *defs,
                               const dem_bond_view *bonds, size_t count, dem_error *error);

#endif
