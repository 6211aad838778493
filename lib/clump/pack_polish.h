/// Descent of the true symmetric difference: limited-memory BFGS on line integrals.
#ifndef DEM_CLUMP_PACK_POLISH_H
#define DEM_CLUMP_PACK_POLISH_H

#include "clump/pack_lines.h"
#include "clump/packing.h"

typedef struct dem_polish_options {
    int iterations;
    double tolerance;   ///< stop when five steps gain less than this part of the difference
    /// Rows of 4 per ball that steps must leave alone, to first order; `tangent_count` of them.
    double (*tangent[10])[4];
    size_t tangent_count;
} dem_polish_options;

/// Moves the balls of `state`, keeps their number; f and owner are stale afterwards. `volumes` (may be NULL): at the end.
dem_status dem_pack_polish(dem_packing *p, dem_lines *lines, dem_pack_state *state, dem_polish_options options,
                           dem_line_volumes *volumes, dem_error *error);

#endif
