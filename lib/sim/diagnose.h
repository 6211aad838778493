/// Warnings about a run, each once, with the cause that was measured (PHYSICS 4).
#ifndef DEM_SIM_DIAGNOSE_H
#define DEM_SIM_DIAGNOSE_H

#include "sim/state.h"

/// Judges the figures of the last dem_world_measure; tells the log what is new.
dem_status dem_world_diagnose(dem_world *world, dem_error *error);

#endif
