/// What the parts of scene_write.c share.
#ifndef DEM_SIM_SCENE_WRITER_H
#define DEM_SIM_SCENE_WRITER_H

#include "sim/scene.h"

static inline void put_vec(dem_json_writer *w, const char *key, dem_vec3 v)
{
    dem_json_put_numbers(w, key, (double[]){v.x, v.y, v.z}, 3);
}

// an object with each member on a line of its own
static inline void open_map(dem_json_writer *w, const char *key)
{
    dem_json_open_object(w, key);
    w->line_depth = w->depth;
}

static inline const char *text_of(const char *text)
{
    return text ? text : "";
}

static inline const char *material_of(const dem_scene *scene, uint32_t material)
{
    return material < scene->material_count ? text_of(scene->materials[material].name) : "";
}

/// "walls". Error: DEM_USAGE where a mesh or table is in no file.
dem_status dem_scene_put_walls(dem_json_writer *w, const dem_scene *scene, dem_error *error);

#endif
