/// Triangles that bound nothing.
#ifndef DEM_MESH_PRUNE_H
#define DEM_MESH_PRUNE_H

#include "mesh/surface.h"

/// Marks in `drop` [triangle_count] fins (open patches that hang on edges of three and more triangles) and
/// strays (small open patches beside the surface). Returns how many triangles.
size_t dem_surface_mark_fins(const dem_surface *surface, unsigned char *drop);

/// Marks inner walls: patches between edges of three and more triangles that nobody sees from outside.
dem_status dem_surface_mark_walls(const dem_surface *surface, unsigned char *drop, size_t *count, dem_error *error);

#endif
