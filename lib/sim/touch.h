/// One listed contact in plain doubles, for what is asked rarely: weights of shared forces, the time step.
#ifndef DEM_SIM_TOUCH_H
#define DEM_SIM_TOUCH_H

#include "sim/contacts.h"

typedef struct dem_touch {
    size_t place;        ///< in the columns
    dem_vec3 point;      ///< of contact [m]
    dem_vec3 normal;     ///< unit, out of the first body
    double overlap;      ///< negative: a gap [m]
    double reduced;      ///< R* [m]
    double radius[2];    ///< of the spheres [m]; of walls the first
    double area_length;  ///< R_min^2 / (R_i + R_j), or R [m]
    dem_vec3 shift;      ///< of the second body's image [m]
} dem_touch;

dem_touch dem_touch_of_pair(const dem_world *world, size_t place);

/// Of a wall's list; contacts of meshes as they were last measured.
dem_touch dem_touch_of_wall(const dem_world *world, dem_wall_form form, size_t place);

#endif
