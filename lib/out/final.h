/// The last state of a run as a table that a scene can start from: DIR/final.csv.
#ifndef DEM_OUT_FINAL_H
#define DEM_OUT_FINAL_H

#include "base/status.h"
#include "dem/scene.h"
#include "dem/world.h"

/// Columns shape,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz and, where any differs from 1, scale; SI units, 17 digits, so that
/// the state is read back without loss. Names of shapes that a comma could be mistaken in stand in quotes. Whole or not
/// at all. Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_final_write(const dem_ctx *ctx, const char *directory, const dem_shape_def *shapes, size_t shape_count,
                           const dem_body_view *bodies, dem_error *error);

#endif
