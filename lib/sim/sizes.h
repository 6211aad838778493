/// Size laws: equivalent diameters drawn by number, whatever the law counts.
///
/// Every law becomes a curve of segments with a share of the number of bodies each. In a segment the density of the
/// number (or, for a law by mass, of the mass) over the diameter is uniform: a grading curve is followed by straight
/// lines between its points, the uniform law is exact, the normal laws are within 1e-6 of their distribution (1e-4
/// where the limits leave but a tail).
#ifndef DEM_SIM_SIZES_H
#define DEM_SIM_SIZES_H

#include "base/status.h"
#include "dem/scene.h"

typedef struct dem_sizes {
    struct dem_size_segment *segments;
    size_t count;
    bool by_mass;  ///< density of mass inside of the segments
} dem_sizes;

/// `as_is` is the shape's own equivalent diameter, for DEM_SIZE_AS_IS [m]. A law by mass needs sizes above 0: a normal
/// one that reaches 0 is refused without `smallest`; by number it is then cut at 1/1000 of its mean.
dem_status dem_sizes_create(const dem_size_def *def, double as_is, dem_sizes *sizes, dem_error *error);
void dem_sizes_release(dem_sizes *sizes);

/// The diameter below which the share `u`, 0..1, of the bodies lies [m]; with u uniform it is a draw.
double dem_sizes_draw(const dem_sizes *sizes, double u);

#endif
