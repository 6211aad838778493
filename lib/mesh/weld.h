/// Welding: from loose triangles to a mesh whose neighbours share their vertices.
#ifndef DEM_MESH_WELD_H
#define DEM_MESH_WELD_H

#include "base/status.h"
#include "dem/mesh.h"

/// Merges vertices with the same coordinates and drops those no triangle uses. In place; the rest keep their
/// order. `unused` counts the unreferenced ones.
dem_status dem_mesh_weld_equal(dem_mesh *mesh, size_t *unused, dem_error *error);

/// Merges those marked vertices that lie within `tolerance` of each other into the first of each cluster, and
/// drops them. `merged` counts the vertices that went.
dem_status dem_mesh_weld_near(dem_mesh *mesh, const unsigned char *marked, double tolerance, size_t *merged,
                              dem_error *error);

/// Drops vertices no triangle uses. Returns how many.
dem_status dem_mesh_compact(dem_mesh *mesh, size_t *unused, dem_error *error);

/// Removes triangles marked in `drop` [triangle_count]; the others keep their order.
void dem_mesh_drop(dem_mesh *mesh, const unsigned char *drop);

/// Removes triangles that name a vertex twice. Returns how many.
size_t dem_mesh_drop_collapsed(dem_mesh *mesh);

/// Triangles in the same place become one, turned the way most of them lie and counted in `layers`
/// [triangle_count] by how many more that are; none where they cancel. False: no memory.
bool dem_mesh_merge_layers(dem_mesh *mesh, int *layers);

#endif
