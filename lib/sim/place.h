/// The bodies of a scene as they start: those that are listed, then those that fills place.
#ifndef DEM_SIM_PLACE_H
#define DEM_SIM_PLACE_H

#include "sim/state.h"

/// All bodies of the scene, to be freed. Needs the world's templates and walls. Errors: DEM_BAD_INPUT for a body that
/// cannot be, or where a fill has no room.
dem_status dem_place_bodies(const dem_world *world, const dem_scene *scene, dem_body_def **bodies, size_t *count,
                            dem_error *error);

/// A shape that is a plain sphere, as a clump.
dem_status dem_sphere_clump(const dem_scene *scene, size_t shape, dem_clump **clump, dem_error *error);

#endif
