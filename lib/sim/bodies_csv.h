/// Bodies from a CSV file: one line each, columns by the names in the first line.
#ifndef DEM_SIM_BODIES_CSV_H
#define DEM_SIM_BODIES_CSV_H

#include "dem/scene.h"

/// Appends bodies to a growable array. Needed columns: shape (a name, which may stand in quotes), x, y, z; further
/// qw, qx, qy, qz (made a unit quaternion), vx, vy, vz, wx, wy, wz and scale; id, mass and coordination are passed
/// over. SI units, independent of the locale; blank lines and lines that begin with '#' are passed over.
/// Errors: DEM_BAD_INPUT with `name`, line and column; DEM_NO_MEMORY.
dem_status dem_bodies_csv_parse(const char *text, size_t size, const char *name, const dem_shape_def *shapes,
                                size_t shape_count, dem_body_def **bodies, size_t *count, size_t *capacity,
                                dem_error *error);

/// A unit quaternion, of the same bits if it is one; false where there is no direction in it.
bool dem_quat_normalise(dem_quat *q);

#endif
