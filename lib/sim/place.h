/// The bodies of a scene as they start: those that are listed, then those that fills place.
#ifndef DEM_SIM_PLACE_H
#define DEM_SIM_PLACE_H

#include "sim/fill.h"
#include "sim/state.h"

/// All bodies of the scene, to be freed. Needs the world's templates and walls. Errors: DEM_BAD_INPUT for a body that
/// cannot be, or where a fill has no room.
dem_status dem_place_bodies(const dem_world *world, const dem_scene *scene, dem_body_def **bodies, size_t *count,
                            dem_error *error);

/// The world's shapes as fills and inlets take them, and its walls as they stand.
typedef struct dem_placing {
    const dem_world *w;
    dem_fill_shape *shapes;
    dem_ball *balls;
    bool smooth;   ///< smooth walls are asked, too, but generator spheres
    bool failed;   ///< out of memory, at the end of any call
    dem_ray_list near;
} dem_placing;
/// `placing` is zero. False: no memory; release it all the same.
bool dem_placing_create(const dem_world *world, dem_placing *placing);
void dem_placing_release(dem_placing *placing);
/// See dem_fill_obstacles.
double dem_placing_clearance(void *placing, dem_vec3 centre, double radius, double most);

/// A shape that is a plain sphere, as a clump.
dem_status dem_sphere_clump(const dem_scene *scene, size_t shape, dem_clump **clump, dem_error *error);

#endif
