/// Clumps in the formats of other programs.
#ifndef DEM_EXPORT_H
#define DEM_EXPORT_H

#include "dem/base.h"
#include "dem/clump.h"

#ifdef __cplusplus
extern "C" {
#endif

/// The names of the formats by number; NULL behind the last.
DEM_API const char *dem_export_format(size_t index);

/// Writes a clump as a file of another program. `format` NULL: as the name of the file tells. `mesh` (may be NULL) is
/// the one it was made from, for pictures. Formats that are only spheres can be `in_mesh_frame`, in metres. "-" is
/// standard output. Errors: DEM_USAGE for a format there is not, DEM_UNAVAILABLE, DEM_CANNOT_WRITE.
DEM_API dem_status dem_clump_export(const dem_ctx *ctx, const dem_clump *clump, const dem_mesh *mesh,
                                    const char *format, bool in_mesh_frame, const char *path, dem_error *error);

#ifdef __cplusplus
}
#endif
#endif
