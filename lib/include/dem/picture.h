/// Pictures of meshes and clumps, rendered with Embree on the processor: no display, no GPU.
#ifndef DEM_PICTURE_H
#define DEM_PICTURE_H

#include "dem/base.h"
#include "dem/clump.h"
#include "dem/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/// The mesh and its clump side by side (PNG), same view and scale, soft shading, white ground.
/// `path` "-" is standard output. Errors: DEM_UNAVAILABLE without Embree, DEM_CANNOT_WRITE.
DEM_API dem_status dem_picture_clump(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls,
                                     size_t count, const char *path, dem_error *error);

#ifdef __cplusplus
}
#endif
#endif
