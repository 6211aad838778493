/// Quantities with units: "2 mm", "2.65 g/cm3", "70GPa", or a bare number in SI.
#ifndef DEM_BASE_UNITS_H
#define DEM_BASE_UNITS_H

#include "base/status.h"

typedef enum dem_dimension { DEM_DIMENSION_LENGTH, DEM_DIMENSION_DENSITY } dem_dimension;

/// Reads a number with an optional unit of `dimension` into SI. The error names the units that can be used.
dem_status dem_quantity(const char *text, dem_dimension dimension, double *value, dem_error *error);

/// The SI value of a unit's name ("mm" -> 1e-3).
dem_status dem_unit(const char *name, dem_dimension dimension, double *value, dem_error *error);

/// A length in the unit that reads best: factor to multiply metres with, and its name.
const char *dem_length_unit(double length, double *factor);

#endif
