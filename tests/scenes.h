/// Scenes for tests, as texts in which ' stands for ".
#ifndef DEM_TESTS_SCENES_H
#define DEM_TESTS_SCENES_H

#include "check.h"

#include <unistd.h>

#include "base/file.h"
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

/// A folder with the files of SCENE_SAMPLE, for the group of tests that makes and removes it.
static inline char *scene_folder(void)
{
    static char folder[] = "/tmp/dem-scene-XXXXXX";
    return folder;
}

static inline const char *in_scene_folder(const char *name)
{
    static char path[300];
    snprintf(path, sizeof path, "%s/%s", scene_folder(), name);
    return path;
}

static inline void put_scene_file(const char *name, const char *text)
{
    dem_error error;
    char *json = quoted(text);
    check_ok(dem_file_write(in_scene_folder(name), json, strlen(json), &error), error);
    free(json);
}

static inline int make_scene_folder(void **state)
{
    (void)state;
    if (!mkdtemp(scene_folder()))
        return -1;
    put_scene_file("grain.json", "{'schema': 'dem-clump/1', 'density': 2500, 'mass': 5, 'inertia': [1, 1, 1.5],\n"
                                 "'spheres': [[0, 0, 0, 1]]}");
    put_scene_file("wall.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    put_scene_file("bodies.csv", "shape,x,y,z,vx,vy,vz,scale\ngrain,1,2,3,4,5,6,0.5\ngrain,-1,0,1e-3,0,0,0,1\n");
    return 0;
}

static inline int remove_scene_folder(void **state)
{
    (void)state;
    char command[300];
    snprintf(command, sizeof command, "rm -rf '%s'", scene_folder());
    return system(command);
}

/// The sample of the design, without what is not built; it stands in scene_folder().
#define SCENE_SAMPLE                                                                                                   \
    "{ 'schema': 'dem-scene/1', 'title': 'sand column', 'gravity': [0, 0, -9.81],\n"                                   \
    "  'time':   { 'end': 0.5, 'step': 'auto', 'safety': 0.8 },             // or 'step': 1e-5\n"                      \
    "  'domain': { 'min': [0,0,0], 'max': [0.1,0.1,0.3], 'periodic': [false,false,false], 'leaving': 'error' },\n"     \
    "  'materials': { 'quartz': { 'density': 2650, 'young': '70 GPa', 'poisson': 0.17 } },\n"                          \
    "  'contacts': [ { 'between': ['quartz','quartz'], 'effective_mass': 'local',      // or 'body'\n"                 \
    "      'normal':   { 'law': 'linear', 'stiffness': 1e4, 'restitution': 0.5, 'restitution_mode': 'cut_corrected' "  \
    "},\n"                                                                                                             \
    "      'friction': { 'law': 'linear', 'stiffness_ratio': 0.2857, 'coefficient': 0.5 }, } ],\n"                     \
    "  'shapes': { 'grain': { 'clump': 'grain.json', 'material': 'quartz' } },\n"                                      \
    "  'bodies': [ { 'file': 'bodies.csv' },      /* w in space frame */\n"                                            \
    "              { 'fill': { 'mix': [ { 'shape': 'grain', 'share': 1.0, 'size': { 'law': 'lognormal', 'median': "    \
    "'1 mm', 'sigma': 0.2 } } ],\n"                                                                                    \
    "                          'box': [[0,0,0.1],[0.1,0.1,0.3]], 'count': 2000, 'seed': 1 } } ],\n"                    \
    "  'walls': { 'floor':  { 'plane': { 'point': [0,0,0], 'normal': [0,0,1] }, 'material': 'quartz' },\n"             \
    "             'hopper': { 'mesh': 'wall.obj', 'unit': 'cm', 'material': 'quartz', 'motion': { 'rotate': { "        \
    "'axis': "                                                                                                         \
    "[0,1,0], 'through': [0,0,0], 'rate': '10 rpm' } } } },\n"                                                         \
    "  'inlets': {}, 'bonds': {}, 'damping': { 'local': 0.0 }, 'integrator': { 'translation': 'central', 'rotation': " \
    "'lsym' },\n"                                                                                                      \
    "  'contacts_between_clumps': 'sum',          // sum | mean | merge\n"                                             \
    "  'output': { 'directory': 'out', 'frames': '5 ms', 'series': '1 ms', 'checkpoint': '60 s wall' } }\n"

#endif
