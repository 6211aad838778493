/// The slope of a heap's surface, out of where its grains lie.
#ifndef DEM_STUDY_SLOPE_H
#define DEM_STUDY_SLOPE_H

#include <stddef.h>

#include "base/status.h"

/// The surface is that of the topmost grain in each cell of a grid over x and y.
typedef struct dem_slope_def {
    double from, to;   ///< in x, where the line is fitted [m]
    double low, high;  ///< in y [m]
    double cell;       ///< about, of the grid [m]
} dem_slope_def;

typedef struct dem_slope {
    double angle;   ///< downwards along x, of the line by least squares through the cells [rad]
    double error;   ///< its standard error, as if cells were independent [rad]
    double height;  ///< of the line at x = 0 [m]
    size_t cells;   ///< with a grain in them
} dem_slope;

/// Angle NAN: fewer than three cells that have grains.
dem_status dem_slope_fit(const dem_slope_def *def, const dem_vec3 *tops, size_t count, dem_slope *slope,
                         dem_error *error);

/// The slope of a heap that leans on a wall at x = 0 and ends at x = `length`, out of all of its grains: the straight
/// surface under which their mass, and its moments along x and z above the floor, are those of an even filling. Far
/// less noisy than the surface itself where the heap is a few grains long [rad]. NAN: no grains.
double dem_slope_of_heap(const dem_vec3 *places, const double *masses, size_t count, double length);

#endif
