/// What we take from CGAL, behind a plain C interface: nothing is thrown across it. Built without CGAL each
/// call returns DEM_UNAVAILABLE, unless its comment says otherwise. Outputs are new meshes, empty on failure.
#ifndef DEM_MESH_CGAL_H
#define DEM_MESH_CGAL_H

#include "dem/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Convex hull of the vertices that triangles use. DEM_BAD_INPUT where they lie in one plane.
dem_status dem_mesh_hull(const dem_mesh *mesh, dem_mesh *hull, dem_error *error);

/// Cuts the triangles of each pair along what they share, exactly, so that the triangles of `out` meet only in
/// whole edges and corners; only then are new vertices rounded. Each piece keeps its triangle's orientation, so a
/// closed surface stays closed. Pairs as of dem_mesh_crossings, all of them.
dem_status dem_mesh_refine(const dem_mesh *mesh, const uint32_t (*pairs)[2], size_t pair_count, dem_mesh *out,
                           dem_error *error);

/// Closed surface around whatever triangles there are (Portaneri et al. 2022): a ball of radius `alpha` rolls over
/// the surface `offset` outside them, and fills what it cannot enter.
dem_status dem_mesh_alpha_wrap(const dem_mesh *mesh, double alpha, double offset, dem_mesh *out, dem_error *error);

#ifdef __cplusplus
}
#endif
#endif
