/// Scenes for tests, as texts in which ' stands for ".
#ifndef DEM_TESTS_SCENES_H
#define DEM_TESTS_SCENES_H

#include "check.h"

#include "math/vec.h"
#include "sim/scene.h"

/// Members of the outermost object: two materials, their law, a sphere, a clump of two balls.
#define SCENE_HEAD                                                                                                     \
    "'schema': 'dem-scene/1',\n"                                                                                       \
    "'materials': {'rock': {'density': 2500, 'young': '1 GPa', 'poisson': 0.2}, 'steel': {'young': 2e11}},\n"          \
    "'contacts': [{'between': ['rock', 'rock'], 'normal': {'stiffness': 1e4}},\n"                                      \
    " {'between': ['steel', 'rock'], 'normal': {'stiffness': 2e4}}],\n"                                                \
    "'shapes': {'ball': {'sphere': {'radius': 0.5}, 'material': 'rock'},\n"                                            \
    " 'pair': {'spheres': [[0, 0, 0, 1], [1, 0, 0, 1]], 'material': 'rock'}}"

/// The text with quotes; free it.
static inline char *quoted(const char *text)
{
    char *copy = strdup(text);
    for (char *p = copy; *p; p++)
        if (*p == '\'')
            *p = '"';
    return copy;
}

static inline dem_status scene_read(const char *text, const char *folder, const char *const *overrides,
                                    dem_scene *scene, dem_error *error)
{
    char *json = quoted(text);
    memset(error, 0, sizeof *error);
    dem_status status = dem_scene_read_text(NULL, json, strlen(json), "scene.json", folder, overrides, scene, error);
    free(json);
    return status;
}

/// A scene that can be read.
static inline dem_scene scene_of(const char *text)
{
    dem_scene scene;
    dem_error error;
    check_ok(scene_read(text, NULL, NULL, &scene, &error), error);
    return scene;
}

#endif
