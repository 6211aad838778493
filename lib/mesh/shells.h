/// Closed surfaces of a mesh and how they lie in each other.
#ifndef DEM_MESH_SHELLS_H
#define DEM_MESH_SHELLS_H

#include "math/vec.h"
#include "mesh/surface.h"

typedef struct dem_shell {
    size_t triangles;
    double volume, area;   ///< signed volume [m^3], area [m^2]
    dem_box box;
    uint32_t largest;      ///< its largest triangle
    bool entangled;        ///< crosses another shell: it is in none
    size_t hosts_begin, hosts_end;  ///< range of dem_shells.hosts
} dem_shell;

typedef struct dem_shells {
    uint32_t *of;      ///< [triangle_count] shell of each triangle
    dem_shell *list;   ///< [count]
    size_t count;
    uint32_t *hosts;   ///< shells that a shell lies in, shell by shell
    bool nested;       ///< the hosts are known
} dem_shells;

/// Patches that bound something only together are one shell. The surface is closed and oriented.
dem_status dem_shells_find(dem_shells *shells, const dem_surface *surface, dem_error *error);

/// Fills the hosts, once. Shells marked `entangled` lie in none.
dem_status dem_shells_nest(dem_shells *shells, const dem_mesh *mesh, dem_error *error);
void dem_shells_release(dem_shells *shells);

/// The outermost (or innermost) host of a shell; itself where it has none.
uint32_t dem_shell_outermost(const dem_shells *shells, uint32_t shell);
uint32_t dem_shell_innermost(const dem_shells *shells, uint32_t shell);

#endif
