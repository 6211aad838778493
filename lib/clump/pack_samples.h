/// Sample points on the grain's surface and in its interior, in blocks of 32 neighbours for the vector kernels.
#ifndef DEM_CLUMP_PACK_SAMPLES_H
#define DEM_CLUMP_PACK_SAMPLES_H

#include "clump/pack_lattice.h"

enum { DEM_BLOCK = 32 };

typedef struct dem_sample_block {
    float x[DEM_BLOCK], y[DEM_BLOCK], z[DEM_BLOCK];
    float weight[DEM_BLOCK];  ///< area or volume a sample stands for
} dem_sample_block;

/// Bounding ball of a block.
typedef struct dem_block_bound {
    float x, y, z, radius;
} dem_block_bound;

typedef struct dem_samples {
    dem_sample_block *blocks;
    dem_block_bound *bounds;
    size_t surface_blocks;  ///< these come first
    size_t block_count;
} dem_samples;

/// Numbers are rounded down to full blocks.
dem_status dem_samples_build(const dem_pack_grain *grain, const dem_lattice *lattice, size_t surface, size_t interior,
                             dem_samples *samples, dem_error *error);
void dem_samples_release(dem_samples *samples);

/// Equal shares of a surface, one point each, in the order of the triangles: `visit` gets point, unit normal and
/// number. `corners` fetches a triangle.
typedef void dem_corners_of(const void *surface, size_t triangle, dem_vec3 corners[3]);
typedef void dem_visit_point(void *user, size_t number, dem_vec3 point, dem_vec3 normal);
void dem_surface_spread(dem_corners_of *corners_of, const void *surface, size_t triangle_count, double area,
                        size_t point_count, dem_visit_point *visit, void *user);

#endif
