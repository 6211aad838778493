/// Shapes as files that ParaView uses as glyphs.
#ifndef DEM_OUT_GLYPH_H
#define DEM_OUT_GLYPH_H

#include "base/status.h"
#include "dem/clump.h"

/// The surface of a clump in its principal frame [m]: that of the grain where it is kept in the clump, else of the
/// union of the spheres with their normals. Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_glyph_write(const char *path, const dem_clump *clump, dem_error *error);

#endif
