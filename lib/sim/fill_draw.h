/// The bodies of a fill before they have a place.
#ifndef DEM_SIM_FILL_DRAW_H
#define DEM_SIM_FILL_DRAW_H

#include "sim/fill.h"

typedef struct dem_fill_draw {
    uint32_t shape;
    double scale;  ///< [-]
} dem_fill_draw;

/// As many as the count, or as come nearest to the void ratio. The caller frees *draws. Errors: DEM_USAGE.
dem_status dem_fill_draws(const dem_fill_def *fill, const dem_fill_shape *shapes, size_t shape_count,
                          dem_fill_draw **draws, size_t *count, dem_error *error);

/// Volume of a grain of that scale over that of its shape [-].
static inline double fill_bulk(const dem_fill_shape *shape, double scale)
{
    return shape->flat ? scale * scale : scale * scale * scale;
}

/// Volume of the box of a fill [m^3].
double dem_fill_box_volume(const dem_fill_def *fill);

#endif
