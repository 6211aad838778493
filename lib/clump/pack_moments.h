/// Exact moments: moving the balls so that their union has the volume, centre and inertia of the grain.
#ifndef DEM_CLUMP_PACK_MOMENTS_H
#define DEM_CLUMP_PACK_MOMENTS_H

#include "clump/packing.h"

enum { DEM_MOMENT_COUNT = 10 };  ///< volume, 3 first moments, 6 second moments

/// What is lacking of each moment, and its gradient.
typedef struct dem_moment_rows {
    size_t kept;                          ///< 10, or 4 for volume and centre
    double lack[DEM_MOMENT_COUNT];
    double scale[DEM_MOMENT_COUNT];       ///< volume, volume times radius of gyration, and times its square
    double (*rows[DEM_MOMENT_COUNT])[4];  ///< [capacity] of each moment to (x, y, z, r) of each ball
    double residual;                      ///< largest lack / scale
    double merit;                         ///< sum of the squares of lack / scale
} dem_moment_rows;

dem_status dem_moment_rows_init(dem_packing *p, dem_moment_rows *rows, dem_error *error);
/// Lack and gradients of the first `kept` moments.
dem_status dem_moment_rows_set(dem_packing *p, const dem_pack_state *state, size_t kept, dem_moment_rows *rows,
                               dem_error *error);
/// Newton steps of least cost (pack_metric.h) until the moments are met. Where they cannot be (no union of balls has
/// the moments of an ellipsoid, which has the least second moments of all bodies of its volume) the balls end as near
/// as it came. `rows` are those of the balls where they end, if the moments are met; `spare` is work space.
dem_status dem_pack_project(dem_packing *p, dem_pack_state *state, size_t kept, dem_moment_rows *rows,
                            dem_moment_rows *spare, bool *met, dem_error *error);

#endif
