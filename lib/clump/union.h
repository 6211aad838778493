/// Clumps that are nothing but their balls: no mesh behind them.
#ifndef DEM_CLUMP_UNION_H
#define DEM_CLUMP_UNION_H

#include "dem/clump.h"

/// The definition of such a clump but for what the caller knows: no figure of a mesh is known. `whole` is the union of
/// its balls as they are given.
dem_clump_def dem_clump_def_of_balls(const char *name, const dem_ball *balls, size_t count, const dem_union *whole,
                                     double density);

/// With mass, centre and moments of the union, in its principal frame.
dem_status dem_clump_of_union(const char *name, const dem_ball *balls, size_t count, double density, dem_clump **clump,
                              dem_error *error);

#endif
