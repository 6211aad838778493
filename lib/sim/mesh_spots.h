/// Closest points of many pairs of a ball and a triangle in one loop without branches, compiled once per instruction
/// set (kernels.cmake); all give the bits of triangle_closest.
#ifndef DEM_SIM_MESH_SPOTS_H
#define DEM_SIM_MESH_SPOTS_H

#include "geom/triangle.h"

typedef struct dem_mesh_spots {
    /// spots[k] is the closest point of triangles[ids[k]] to centres[k].
    void (*run)(const dem_triangle *triangles, const uint32_t *ids, const dem_vec3 *centres, size_t count,
                dem_closest *restrict spots);
} dem_mesh_spots;

/// The best set this machine can run, or the named one (NULL: none such, or not usable here).
const dem_mesh_spots *dem_mesh_spots_choose(const char *name);

extern const dem_mesh_spots dem_mesh_spots_plain, dem_mesh_spots_v3, dem_mesh_spots_v4;

#endif
