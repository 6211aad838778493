/// The IoU gap alone, for who needs it often.
#ifndef DEM_CLUMP_FIDELITY_H
#define DEM_CLUMP_FIDELITY_H

#include "dem/clump.h"

/// IoU gap by exact lengths along three bundles of parallel lines. `lines` hit the mesh in each bundle; 0: as many as
/// bring the standard error below half a percent of the gap. `error_estimate` (relative to the gap) may be NULL.
dem_status dem_fidelity_gap(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count, size_t lines,
                            double *gap, double *error_estimate, dem_error *error);

#endif
