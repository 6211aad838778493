/// Cutting the polygons of a mesh file into triangles.
#ifndef DEM_MESH_POLYGON_H
#define DEM_MESH_POLYGON_H

#include "math/vec.h"

/// Concave polygons above this are refused: ear clipping takes time with the square of the corners (here 20 ms).
enum { DEM_POLYGON_MOST_CORNERS = 4096 };

/// Work space kept from polygon to polygon; zero-initialise.
typedef struct dem_polygon_work {
    struct dem_polygon_corner *corners;
    size_t corner_capacity;
    uint32_t *blockers;
    size_t blocker_capacity;
} dem_polygon_work;

/// Cuts a polygon of `count` >= 3 corners (indices of `vertices`) into count - 2 triangles with its own sense of
/// rotation: a fan where that is correct, else ear clipping in the plane of its Newell normal. Corners on a
/// straight side are kept without making triangles of no area, as long as the polygon does not meet itself.
/// `triangles` has room for 3 (count - 2) indices. DEM_NO_MEMORY, or DEM_BAD_INPUT for too many corners.
dem_status dem_polygon_split(dem_polygon_work *work, const dem_vec3 *vertices, const uint32_t *corners, size_t count,
                             uint32_t *triangles);
void dem_polygon_work_release(dem_polygon_work *work);

#endif
