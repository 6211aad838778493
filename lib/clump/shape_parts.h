/// The measures of a shape one by one, for who has several hands: dem_shape_measure takes them in turn.
#ifndef DEM_CLUMP_SHAPE_PARTS_H
#define DEM_CLUMP_SHAPE_PARTS_H

#include "dem/clump.h"

/// A shape under way: the mesh with all lengths in d_eq and the centre of mass at 0.
typedef struct dem_shape_work {
    dem_mesh unit;
    double size;           ///< d_eq [m]
    dem_error hull_error;  ///< why there is no hull
    dem_status hull;
    dem_shape *shape;
} dem_shape_work;

/// Corners, box and hull; none of them needs another one.
enum { DEM_SHAPE_CORNERS, DEM_SHAPE_BOX, DEM_SHAPE_HULL, DEM_SHAPE_PARTS };

/// The mesh and `shape` are borrowed. To be ended in any case.
dem_status dem_shape_begin(const dem_mesh *mesh, dem_shape *shape, dem_shape_work *work, dem_error *error);
dem_status dem_shape_part(dem_shape_work *work, int part, int threads, dem_error *error);
/// Logs what could not be measured.
void dem_shape_end(const dem_ctx *ctx, dem_shape_work *work);

#endif
