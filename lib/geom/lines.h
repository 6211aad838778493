/// Volumes of a closed mesh, of a union of balls and of what they share, by exact lengths along parallel lines.
#ifndef DEM_GEOM_LINES_H
#define DEM_GEOM_LINES_H

#include "base/memory.h"
#include "math/vec.h"

/// What to compare. A point is inside the mesh where its winding number is not zero.
typedef struct dem_line_bodies {
    const dem_vec3 *vertices;
    const uint32_t *triangles;
    size_t vertex_count, triangle_count;
    const dem_ball *balls;
    size_t ball_count;
} dem_line_bodies;

/// Lines along axis[2] through a lattice of rows in the plane of axis[0] and axis[1]; the axes are orthonormal.
/// The rows are shifted against each other by the golden ratio, so that no direction in the plane is special.
typedef struct dem_line_bundle {
    dem_vec3 axis[3];
    double spacing;  ///< [m]
} dem_line_bundle;

/// Volumes: lengths times the lattice cell [m^3].
typedef struct dem_bundle_volumes {
    double mesh, balls, both;
    size_t lines;   ///< that met anything
    size_t broken;  ///< left out because the mesh is open there
} dem_bundle_volumes;

/// Interleaved parts of a bundle; their scatter tells the error of the whole.
enum { DEM_LINE_GROUPS = 8 };

/// `groups[k]` estimates the whole volumes from every eighth line. The same bits for any number of threads.
dem_status dem_line_bundle_measure(const dem_line_bodies *bodies, const dem_line_bundle *bundle, int threads,
                                   dem_bundle_volumes groups[DEM_LINE_GROUPS], dem_error *error);

#endif
