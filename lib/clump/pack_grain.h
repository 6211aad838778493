/// The grain in the packer's frame: d_eq = 1, centroid at 0, turned by a fixed generic rotation, so that no tolerance
/// carries a unit and no flat face is parallel to an axis (lines along the axes then integrate without bias).
#ifndef DEM_CLUMP_PACK_GRAIN_H
#define DEM_CLUMP_PACK_GRAIN_H

#include "dem/clump.h"
#include "geom/tree.h"

typedef struct dem_pack_grain {
    const dem_mesh *mesh;    ///< as given, borrowed; large ones are streamed, never copied
    dem_vec3 centre;         ///< of the mesh [m]
    double size;             ///< d_eq of the mesh [m]
    dem_moments moments;     ///< exact, about 0, in the packer's frame
    double area;
    dem_box box;
    dem_mesh shell;          ///< what the tree is built on: the mesh turned, or a coarser stand-in for a large one
    dem_tree tree;
} dem_pack_grain;

dem_status dem_pack_grain_open(const dem_mesh *mesh, dem_pack_grain *grain, dem_error *error);
void dem_pack_grain_close(dem_pack_grain *grain);

/// How the stand-in of a large mesh differs from it; nothing for a mesh that stands for itself.
typedef struct dem_pack_stand_in {
    size_t triangles;      ///< 0: there is none
    double volume_change;  ///< relative to the mesh [-]
    double distance;       ///< farthest of some 50,000 vertices of the mesh from it, over d_eq [-]
} dem_pack_stand_in;
dem_pack_stand_in dem_pack_grain_stand_in(const dem_pack_grain *grain);

/// Mesh frame to the packer's frame and back.
dem_vec3 dem_pack_grain_enter(const dem_pack_grain *grain, dem_vec3 point);
dem_ball dem_pack_grain_leave(const dem_pack_grain *grain, dem_ball ball);
/// The corners of a triangle of `mesh`, in the packer's frame.
void dem_pack_grain_corners(const dem_pack_grain *grain, size_t triangle, dem_vec3 corners[3]);

#endif
