/// Clumps where they lie in the image they were cut out of: a scene of dem-run, and the file of its bodies.
#ifndef DEM_TOOLS_CLUMP_SCENE_H
#define DEM_TOOLS_CLUMP_SCENE_H

#include "base/text.h"
#include "clump_job.h"

typedef struct clump_scene {
    dem_buffer bodies;  ///< rows of the CSV
    char **shapes;      ///< names of the clumps
    size_t count, capacity;
    double density;  ///< [kg/m^3]
} clump_scene;

/// Adds a clump that has been made.
void clump_scene_add(clump_scene *scene, const job_result *result);
/// Writes NAME_bodies.csv and NAME_scene.json into the folder of the clumps, if there are any, and releases the scene.
dem_status clump_scene_finish(clump_scene *scene, const char *folder, const char *name, dem_error *error);

#endif
