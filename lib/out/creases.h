/// Edges of a mesh that are worth a line.
#ifndef DEM_OUT_CREASES_H
#define DEM_OUT_CREASES_H

#include "dem/mesh.h"

/// For every triangle a bit 1 << k where the edge opposite of its corner k is at the border or a crease. Corners at the
/// same place count as one, as in files that are not welded. [triangle_count], to be freed; NULL: out of memory.
unsigned char *dem_mesh_creases(const dem_mesh *mesh);

#endif
