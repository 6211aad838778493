/// A mesh with its neighbourhoods: edges, and patches of triangles joined over edges that two of them share.
#ifndef DEM_MESH_SURFACE_H
#define DEM_MESH_SURFACE_H

#include "mesh/edges.h"

typedef struct dem_patch {
    size_t triangles;
    double area;           ///< [m^2]
    size_t border, many;   ///< half edges with no neighbour, and at edges of three and more triangles
} dem_patch;

/// `mesh` is borrowed. Whoever drops or adds triangles builds the surface again.
typedef struct dem_surface {
    dem_mesh *mesh;
    dem_edges edges;
    uint32_t *patch;     ///< [triangle_count]
    dem_patch *patches;  ///< [patch_count]
    size_t patch_count;
    double area;         ///< of all [m^2]
} dem_surface;

/// Zero-initialise before the first use; building again releases what was there.
dem_status dem_surface_build(dem_surface *surface, dem_mesh *mesh, dem_error *error);
void dem_surface_release(dem_surface *surface);

/// Flips triangles until neighbours within each patch agree, the fewer ones of a patch. `flipped`
/// [triangle_count] is toggled where it did; `conflicts` counts the edges where they cannot agree (one-sided).
dem_status dem_surface_orient(dem_surface *surface, unsigned char *flipped, size_t *conflicts, dem_error *error);

/// Flips the triangles marked in `flip` and keeps the edges valid.
void dem_surface_flip(dem_surface *surface, const unsigned char *flip);

/// Edges whose triangles do not run as often one way as the other, borders left out: 0 where every edge of the
/// surface bounds a solid.
size_t dem_surface_unbalanced(const dem_surface *surface);

double dem_triangle_area(const dem_mesh *mesh, size_t triangle);

#endif
