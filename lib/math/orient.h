/// Exact signs of orientation determinants (Shewchuk 1997): right for every input short of over- or underflow.
#ifndef DEM_MATH_ORIENT_H
#define DEM_MATH_ORIENT_H

#include "math/vec.h"

/// +1 where d lies below the plane of a, b, c, seen counter-clockwise from above; 0: in the plane.
int dem_orient3(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 d);

/// Sign of the area of (a, b, c) seen along a coordinate axis; the two other axes in cyclic order.
int dem_orient2(dem_vec3 a, dem_vec3 b, dem_vec3 c, int axis);

#endif
