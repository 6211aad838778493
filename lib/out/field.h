/// Numbers of bodies by name, for colours and conditions.
///
/// size, speed, spin, coordination, height, mass and the coordinates x, y, z are always known; with a frame also every
/// array of it: "velocity:z" or "orientation:0" is a component, the name alone of several components their length.
#ifndef DEM_OUT_FIELD_H
#define DEM_OUT_FIELD_H

#include "base/units.h"
#include "dem/picture.h"
#include "out/vtp.h"

/// Where they come from. Borrowed.
typedef struct dem_field_source {
    const dem_body_view *bodies;  ///< columns that are not known are NULL
    const double *diameters;      ///< of the shapes: of the spheres of equal volume [m]
    dem_vec3 up;                  ///< unit
    const dem_vtp *frame;         ///< NULL: none
} dem_field_source;

typedef struct dem_field {
    char title[96];
    const char *unit;  ///< SI; "" for a pure number
    bool whole;        ///< its values are whole numbers
    double *values;    ///< of the bodies; free it
} dem_field;

/// Errors: DEM_USAGE for a name that is not known, DEM_BAD_INPUT for a column that is not there, DEM_NO_MEMORY.
dem_status dem_field_make(const char *name, const dem_field_source *source, dem_field *field, dem_error *error);

/// The name of what a colour shows; NULL where that is no number.
const char *dem_field_of_colour(dem_picture_colour colour);

/// Smallest and largest of the values that are finite and not hidden (NULL: none is); low > high: there are none.
void dem_field_range(const double *values, const unsigned char *hidden, size_t count, double *low, double *high);

/// What a unit measures, to read quantities in it.
dem_dimension dem_field_dimension(const char *unit);

#endif
