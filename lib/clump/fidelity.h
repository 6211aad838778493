/// The measures of a clump's error one by one; dem_fidelity_measure takes them in turn.
#ifndef DEM_CLUMP_FIDELITY_H
#define DEM_CLUMP_FIDELITY_H

#include "dem/clump.h"
#include "geom/lines.h"

/// IoU gap by exact lengths along three bundles of parallel lines. `lines` hit the mesh in each bundle; 0: as many as
/// bring the standard error below half a percent of the gap. `error_estimate` (relative to the gap) may be NULL.
dem_status dem_fidelity_gap(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count, size_t lines,
                            double *gap, double *error_estimate, dem_error *error);

/// Mesh and balls in a frame of the grain's own, and what is known of them.
typedef struct dem_fidelity_work {
    dem_solid solid;              ///< of the mesh as given
    double size;                  ///< d_eq as given [m]
    dem_vec3 *vertices;
    dem_ball *balls;
    dem_line_bodies bodies;
    size_t samples;
    double difference;            ///< volume where mesh and union differ [d_eq^3]
    double union_volume;          ///< [d_eq^3]
    dem_fidelity *fidelity;       ///< NULL: nothing has begun
} dem_fidelity_work;

/// Distances with masses, and the gap; neither needs the other.
enum { DEM_FIDELITY_SURFACES, DEM_FIDELITY_GAP, DEM_FIDELITY_PARTS };

/// The mesh and `fidelity` are borrowed, the balls are not. To be ended in any case, after which the figures stand.
dem_status dem_fidelity_begin(const dem_mesh *mesh, const dem_ball *balls, size_t count, size_t samples,
                              dem_fidelity *fidelity, dem_fidelity_work *work, dem_error *error);
dem_status dem_fidelity_part(dem_fidelity_work *work, int part, int threads, dem_error *error);
void dem_fidelity_end(dem_fidelity_work *work);

#endif
