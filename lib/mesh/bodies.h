/// Which shells of a clean mesh make which body.
#ifndef DEM_MESH_BODIES_H
#define DEM_MESH_BODIES_H

#include "mesh/shells.h"

typedef struct dem_mesh_bodies {
    uint32_t *of;       ///< [shells] body of each shell
    double *volume;     ///< [count] descending [m^3]
    size_t count;
} dem_mesh_bodies;

/// Shells that share a vertex are one body; a cavity belongs to the shell around it. Nested shells expected.
dem_status dem_mesh_bodies_find(dem_mesh_bodies *bodies, const dem_shells *shells, const dem_mesh *mesh,
                                dem_error *error);
void dem_mesh_bodies_release(dem_mesh_bodies *bodies);

#endif
