#include "dem/clump.h"

dem_pack_options dem_pack_defaults(void)
{
    return (dem_pack_options){.method = "optimal",
                              .spheres = 50,
                              .max_spheres = 2000,
                              .effort = DEM_EFFORT_DEFAULT,
                              .moments = DEM_MOMENTS_EXACT,
                              .seed = 1};
}
