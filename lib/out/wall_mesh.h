/// Walls as triangles, for results and pictures.
#ifndef DEM_OUT_WALL_MESH_H
#define DEM_OUT_WALL_MESH_H

#include "base/status.h"
#include "dem/scene.h"
#include "dem/world.h"
#include "math/vec.h"

/// True where the wall does not stay where it is at time 0.
bool dem_wall_moves(const dem_wall_def *wall);

/// Where walls without an end are cut: at the domain, and where that is infinite at a margin about the bodies and what
/// is known of the walls' places, or at a plane across that axis, which bounds the bodies. `poses` may be NULL: as at
/// time 0.
dem_box dem_walls_box(const dem_domain_def *domain, dem_box bodies, const dem_wall_def *walls,
                      const dem_wall_view *poses, size_t count);

/// The part of a wall in the box, facing the bodies: a plane is cut at it, a cylinder as long as it, a mesh whole. No
/// triangles where the box misses a plane. `pose` may be NULL. Released by dem_mesh_free. Error: DEM_NO_MEMORY.
dem_status dem_wall_mesh(const dem_wall_def *wall, const dem_wall_view *pose, dem_box box, dem_mesh *mesh,
                         dem_error *error);

/// What was worn off each triangle of such a mesh: volume [m^3] and depth [m]; of a smooth wall evenly over all of it.
/// `view` (may be NULL: nothing) is of the wall. Either array may be NULL.
void dem_wall_worn(const dem_mesh *mesh, const dem_wall_view *view, double *volume, double *depth);

#endif
