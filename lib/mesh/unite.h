/// One outline for surfaces that cross themselves or each other.
#ifndef DEM_MESH_UNITE_H
#define DEM_MESH_UNITE_H

#include "mesh/crossings.h"

/// Replaces a closed, oriented surface by the boundary of everything it winds around, whatever the number of
/// turns (winding number not 0). `changed` is false, and the mesh as it was, where it only touches itself.
/// DEM_UNAVAILABLE without CGAL; DEM_FAILED where the outline does not come out closed.
dem_status dem_mesh_unite(dem_mesh *mesh, const dem_crossings *crossings, bool *changed, dem_error *error);

#endif
