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

/// The same one by one and without end: of the fill only mix, shares and seed count, and nothing of it is needed
/// afterwards. On an error, too, *drawer is to be destroyed. Errors: DEM_USAGE, DEM_NO_MEMORY.
typedef struct dem_fill_drawer dem_fill_drawer;
dem_status dem_fill_drawer_create(const dem_fill_def *fill, const dem_fill_shape *shapes, size_t shape_count,
                                  dem_fill_drawer **drawer, dem_error *error);
void dem_fill_drawer_destroy(dem_fill_drawer *drawer);
dem_fill_draw dem_fill_drawer_next(dem_fill_drawer *drawer);
/// The body of an entry of the mix below whose size the share `u` of them lies; false: there is no such entry.
bool dem_fill_drawer_quantile(const dem_fill_drawer *drawer, size_t entry, double u, dem_fill_draw *out);

/// Volume of the box of a fill [m^3].
double dem_fill_box_volume(const dem_fill_def *fill);

#endif
