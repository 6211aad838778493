/// Quantities with units: "2 mm", "2.65 g/cm3", "70GPa", or a bare number in SI.
#ifndef DEM_BASE_UNITS_H
#define DEM_BASE_UNITS_H

#include "base/status.h"

typedef enum dem_dimension {
    DEM_DIMENSION_LENGTH,           ///< [m]
    DEM_DIMENSION_DENSITY,          ///< [kg/m^3]
    DEM_DIMENSION_TIME,             ///< [s]
    DEM_DIMENSION_VELOCITY,         ///< [m/s]
    DEM_DIMENSION_ACCELERATION,     ///< [m/s^2]
    DEM_DIMENSION_PRESSURE,         ///< [Pa]
    DEM_DIMENSION_STIFFNESS,        ///< [N/m]
    DEM_DIMENSION_ANGLE,            ///< [rad]
    DEM_DIMENSION_ANGULAR_VELOCITY, ///< [rad/s]
    DEM_DIMENSION_MASS,             ///< [kg]
    DEM_DIMENSION_AREA,             ///< [m^2]
    DEM_DIMENSION_INERTIA,          ///< [kg m^2]
    DEM_DIMENSION_RATE,             ///< [1/s]
    DEM_DIMENSION_VISCOSITY,        ///< [Pa s]
    DEM_DIMENSION_FORCE,            ///< [N]
    DEM_DIMENSION_SLOWNESS,         ///< [s/m]
    DEM_DIMENSION_MASS_RATE,        ///< [kg/s]
    DEM_DIMENSION_NONE,             ///< a pure number [-]
} dem_dimension;

/// Reads a number with an optional unit of `dimension` into SI. The error names the units that can be used.
dem_status dem_quantity(const char *text, dem_dimension dimension, double *value, dem_error *error);

/// "a length", and how one is written: "2 mm".
const char *dem_dimension_name(dem_dimension dimension);
const char *dem_dimension_example(dem_dimension dimension);

/// The SI value of a unit's name ("mm" -> 1e-3).
dem_status dem_unit(const char *name, dem_dimension dimension, double *value, dem_error *error);

/// The dimension of an SI unit's name ("N/m"); a pure number for NULL and what is not known.
dem_dimension dem_dimension_of(const char *name);

/// A length in the unit that reads best: factor to multiply metres with, and its name.
const char *dem_length_unit(double length, double *factor);

#endif
