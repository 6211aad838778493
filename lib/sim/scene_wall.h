/// What the readers of one wall share.
#ifndef DEM_SIM_SCENE_WALL_H
#define DEM_SIM_SCENE_WALL_H

#include "math/vec.h"
#include "sim/scene_reader.h"

typedef struct wall_text {
    dem_wall_def wall;
    dem_wall_source source;
    dem_vec3 low, high;  ///< of a box
    double radii[2];     ///< of a cone with ends
    bool turns;          ///< some part of the motion has set axis and point
    double stress[3];    ///< of a box: along x, y, z; NAN: no servo there
    bool three_stresses;
    uint64_t servo_given;
} wall_text;

extern const dem_fields dem_wall_motion_fields, dem_wall_servo_fields, dem_wall_wear_fields;
dem_field_reader dem_wall_read_motion, dem_wall_read_servo, dem_wall_read_wear;  ///< into a wall_text

/// Whether the servo suits the form of the wall. `v`: the servo.
dem_status dem_wall_check_servo(dem_scene_reader *r, const dem_scene_value *v, wall_text *text, bool box, bool plane);

/// The servo of side 0 to 5 of a box whose first side is wall `first`.
void dem_wall_servo_of_side(dem_wall_def *side, const wall_text *text, int index, uint32_t first);

/// A wall for the solid generator sphere of an inlet; its name may be that of another wall.
dem_status dem_wall_add_generator(dem_scene_reader *r, const dem_inlet_def *inlet);

/// Puts numbers for the names of walls that servos refer to. `v`: all walls.
dem_status dem_wall_find_names(dem_scene_reader *r, const dem_scene_value *v);

/// Rows of time, x, y, z, angle from a CSV file (SI units), kept with the scene.
dem_status dem_wall_read_table(dem_scene_reader *r, const dem_scene_value *v, dem_wall_table *table);

#endif
