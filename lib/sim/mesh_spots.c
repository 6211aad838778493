// Compiled once as it is (plain) and once per instruction set with DEM_KERNELS set to v3 or v4.
#include "sim/mesh_spots.h"

#ifndef DEM_KERNELS
#define DEM_KERNELS plain
#endif
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define TEXT_(a) #a
#define TEXT(a) TEXT_(a)

static bool usable(void)
{
#if defined(__AVX512F__) && defined(__AVX512BW__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#elif defined(__AVX2__)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
#else
    return true;
#endif
}

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

const dem_mesh_spots JOIN(dem_mesh_spots_, DEM_KERNELS) = {.name = TEXT(DEM_KERNELS), .usable = usable, .run = run};
