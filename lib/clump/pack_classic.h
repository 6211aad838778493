/// What the classic packing methods share: the grain, distances in it, a measure of fit, the choice among tangent
/// spheres, and all that has nothing to do with the method itself (sides, counts, what is told).
#ifndef DEM_CLUMP_PACK_CLASSIC_H
#define DEM_CLUMP_PACK_CLASSIC_H

#include "clump/pack.h"
#include "clump/pack_kernels.h"

/// One run of one method. Lengths in units of d_eq, in the frame of pack_grain.h.
struct dem_classic {
    const dem_ctx *ctx;
    const dem_packer *packer;
    const dem_pack_options *options;  ///< at most options->spheres
    const dem_pack_grain *grain;
    const dem_pack_kernels *kernels;
    int threads;
    dem_lattice lattice;            ///< to measure the fit on
    double value[DEM_PACK_VALUES];  ///< the parameters; NAN: the method finds one and leaves it here
    dem_ball *balls;                ///< what was chosen, in the order of the choice
    size_t count;
};

/// The `run` of every classic: calls the record's `place` between what all have in common.
dem_status dem_classic_run(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *options, dem_pack *pack,
                           dem_error *error);

/// Tells the progress; DEM_INTERRUPTED where the caller wants to stop.
dem_status dem_classic_go_on(const dem_classic *c, double fraction, dem_error *error);

/// Distance of p to the surface, negative outside.
double dem_classic_depth(const dem_classic *c, dem_vec3 p);

/// IoU gap as the lattice sees it.
double dem_classic_gap(dem_classic *c, const dem_ball *balls, size_t count);

/// The balls become the result if their gap is below *least, which then is lowered to it; `kept` (may be NULL) tells.
dem_status dem_classic_offer(dem_classic *c, const dem_ball *balls, size_t count, double *least, bool *kept,
                             dem_error *error);

/// A point of the surface and the largest ball inside that touches the surface there.
typedef struct dem_tangent {
    dem_vec3 point;
    dem_ball ball;
} dem_tangent;

/// Tangent balls of about `count` points spread evenly over the surface, in the order of the surface; malloc'd.
dem_status dem_classic_tangents(const dem_classic *c, size_t count, dem_tangent **tangents, size_t *tangent_count,
                                dem_error *error);

/// A choice that two parameters steer: one of the sizes, for which a few values are tried, and one of the spacing, on
/// which the count depends steadily. Each is taken as given, or found.
typedef struct dem_thinning {
    /// Chooses balls and stops behind `most` of them; returns their number.
    size_t (*choose)(const void *user, double size, double spacing, size_t most, dem_ball *balls);
    const void *user;
    size_t size_parameter, spacing_parameter;  ///< places in c->value
    const double *sizes;                       ///< to try
    size_t size_count;
    double fewest, most;  ///< spacings of the fewest and of the most balls
    size_t limit;         ///< no choice has more balls
} dem_thinning;

/// The choice of least gap among those of at most options->spheres balls; all parameters given: what they come to.
dem_status dem_classic_thin(dem_classic *c, const dem_thinning *thinning, dem_error *error);

#endif
