// Compiled once as it is (plain) and once per instruction set with DEM_KERNELS set to v3 or v4.
#include "sim/mesh_spots.h"

#include "base/level.h"

static void run(const dem_triangle *triangles, const uint32_t *ids, const dem_vec3 *centres, size_t count,
                dem_closest *restrict spots)
{
#ifdef __AVX2__
#pragma omp simd
    for (size_t k = 0; k < count; k++)
        spots[k] = triangle_closest_lane(&triangles[ids[k]], centres[k]);
#else
    // two lanes gain less than skipping what is not needed
    for (size_t k = 0; k < count; k++)
        spots[k] = triangle_closest(&triangles[ids[k]], centres[k]);
#endif
}

const dem_mesh_spots DEM_LEVEL_OF(dem_mesh_spots) = {.run = run};
