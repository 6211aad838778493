/// The search for near pairs of bodies: cell grids over bounding balls, one for each factor of two in size.
#ifndef DEM_SIM_BROAD_H
#define DEM_SIM_BROAD_H

#include "sim/state.h"

/// Work space of the search. Needs the world's bodies.
dem_status dem_search_create(dem_world *world, dem_error *error);
void dem_search_destroy(dem_search *search);

/// Finds anew all pairs whose bounding balls are nearer than the skin and keeps what is known of old ones. New pairs
/// have no contacts yet and ask to be refreshed. Bodies are put back into a periodic domain first.
dem_status dem_broad_search(dem_world *world, dem_error *error);

/// Whether the pairs of the last search will do for longer, as bodies have moved less than their paths say, or all
/// together. Sets anew how far they may go.
bool dem_broad_extend(dem_world *world);

/// The skin that suits the world's bodies while they are slow [m].
double dem_broad_skin(const dem_world *world);

/// Row of the image (x, y, z), each within DEM_IMAGES_ASIDE.
static inline uint32_t image_row(int x, int y, int z)
{
    return (uint32_t)(((x + DEM_IMAGES_ASIDE) * DEM_IMAGES_ROW + y + DEM_IMAGES_ASIDE) * DEM_IMAGES_ROW + z +
                      DEM_IMAGES_ASIDE);
}
static inline void image_of(uint32_t row, int image[3])
{
    image[2] = (int)(row % DEM_IMAGES_ROW) - DEM_IMAGES_ASIDE;
    image[1] = (int)(row / DEM_IMAGES_ROW % DEM_IMAGES_ROW) - DEM_IMAGES_ASIDE;
    image[0] = (int)(row / (DEM_IMAGES_ROW * DEM_IMAGES_ROW)) - DEM_IMAGES_ASIDE;
}

/// Makes dem_world.shifts for a periodic domain. Errors: a side too short for the bodies.
dem_status dem_broad_images(dem_world *world, dem_error *error);

#endif
