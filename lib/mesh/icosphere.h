/// Regular triangulations: triangles divided evenly, and the geodesic sphere made of them.
#ifndef DEM_MESH_ICOSPHERE_H
#define DEM_MESH_ICOSPHERE_H

#include "base/status.h"
#include "dem/mesh.h"

/// Divides every triangle of a closed mesh into frequency^2 in its own plane; neighbours share the points on
/// their common edge. `divided` is freed with dem_mesh_free.
dem_status dem_mesh_divide(const dem_mesh *mesh, size_t frequency, dem_mesh *divided, dem_error *error);

/// Unit sphere about the origin: an icosahedron with 20 frequency^2 triangles, its vertices pushed out to the
/// sphere. An even frequency has vertices on the six half axes.
dem_status dem_icosphere(size_t frequency, dem_mesh *sphere, dem_error *error);

/// The even frequency whose sphere has the number of triangles nearest to the asked one.
size_t dem_icosphere_frequency(size_t triangles);

#endif
