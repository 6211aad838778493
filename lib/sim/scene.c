#define _GNU_SOURCE
#include "sim/scene.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "math/vec.h"
#include "sim/scene_reader.h"

static const double SAFETY = 0.8, SAFETY_HERTZ = 0.5;  // a Hertz contact stiffens between two looks at it

// ---- defaults

dem_scene dem_scene_defaults(void)
{
    return (dem_scene){
        .title = "",
        .dimension = 3,
        .time = {.end = NAN, .safety = NAN, .contact_steps = 10},
        .domain = {.low = {-INFINITY, -INFINITY, -INFINITY}, .high = {INFINITY, INFINITY, INFINITY}},
        .output = {.directory = "out", .energy = true},
    };
}

dem_pair_law dem_pair_law_defaults(void)
{
    return (dem_pair_law){
        .stiffness = NAN,
        .restitution = 1,
        .tangential_stiffness = NAN,
        .stiffness_ratio = 2.0 / 7,
        .tangential_rate = NAN,
        .rescale = true,
        .rolling_stiffness = NAN,
        .static_coefficient = NAN,
        .friction_decay = 500,
        .rolling_damping = 0.3,
    };
}

dem_bond_def dem_bond_defaults(void)
{
    return (dem_bond_def){
        .name = "",
        .radius_multiplier = 1,
        .young = NAN,
        .shear_ratio = 0.4,
        .tensile_strength = INFINITY,
        .shear_strength = INFINITY,
        .moment_contribution = 1,
    };
}

// ---- what follows from a scene

double dem_shape_diameter(const dem_shape_def *shape)
{
    if (shape->sphere_radius > 0 || !shape->clump)
        return 2 * shape->sphere_radius;
    return cbrt(6 / DEM_PI * dem_clump_view(shape->clump).volume);
}

bool dem_scene_can_meet(const dem_scene *scene, uint32_t a, uint32_t b)
{
    bool body_a = false, body_b = false, wall_a = false, wall_b = false;
    for (size_t i = 0; i < scene->shape_count; i++) {
        body_a |= scene->shapes[i].material == a;
        body_b |= scene->shapes[i].material == b;
    }
    for (size_t i = 0; i < scene->wall_count; i++) {
        wall_a |= scene->walls[i].material == a;
        wall_b |= scene->walls[i].material == b;
    }
    return (body_a && (body_b || wall_b)) || (body_b && wall_a);
}

double dem_scene_safety(const dem_scene *scene)
{
    if (!isnan(scene->time.safety))
        return scene->time.safety;
    for (size_t i = 0; i < scene->law_count; i++) {
        const dem_pair_law *law = &scene->laws[i];
        if (law->normal != DEM_NORMAL_LINEAR && dem_scene_can_meet(scene, law->materials[0], law->materials[1]))
            return SAFETY_HERTZ;
    }
    return SAFETY;
}

// ---- reading

static dem_status read_root(dem_scene_reader *r, const char *const *overrides)
{
    DEM_TRY(dem_json_parse_lenient(r->text, r->size, r->name, &r->owner->root, r->error));
    dem_scene_value root = {.json = r->owner->root};
    if (!dem_json_is_object(root.json))
        return dem_scene_refuse(r, &root, "one starts with { \"schema\": \"dem-scene/1\", ...", "is not a scene file");
    DEM_TRY(dem_scene_override_all(r, overrides));
    DEM_TRY(dem_fields_read(r, &root, &dem_scene_fields, r->scene, NULL));
    return dem_scene_finish(r, &root);
}

dem_status dem_scene_read_text(const dem_ctx *ctx, const char *text, size_t size, const char *name, const char *folder,
                               const char *const *overrides, dem_scene *scene, dem_error *error)
{
    *scene = dem_scene_defaults();
    scene->owner = calloc(1, sizeof *scene->owner);
    if (!scene->owner)
        return dem_fail_memory(error);
    dem_error unused;
    dem_scene_reader r = {.ctx = ctx,
                          .name = name,
                          .folder = folder,
                          .text = text,
                          .size = size,
                          .scene = scene,
                          .owner = scene->owner,
                          .error = error ? error : &unused};
    dem_status status = read_root(&r, overrides);
    if (status != DEM_OK)
        dem_scene_release(scene);
    return status;
}

// the folder of a file, absolute; free it
static char *folder_of(const char *path)
{
    const char *name = dem_file_name(path);
    char *folder = name == path ? strdup(".") : strndup(path, (size_t)(name - path));
    char *absolute = folder ? realpath(folder, NULL) : NULL;
    free(folder);
    return absolute;
}

dem_status dem_scene_read(const dem_ctx *ctx, const char *path, const char *const *overrides, dem_scene *scene,
                          dem_error *error)
{
    *scene = dem_scene_defaults();
    dem_buffer text;
    DEM_TRY(dem_file_read(path, &text, error));
    bool input = strcmp(path, "-") == 0;
    char *folder = folder_of(input ? "./" : path);
    dem_status status = DEM_OK;
    if (folder)
        status = dem_scene_read_text(ctx, text.data, text.size, input ? "standard input" : path, folder, overrides,
                                     scene, error);
    else
        status = dem_fail_at(error, DEM_BAD_INPUT, path, 0, "its folder cannot be found; give the whole path");
    free(folder);
    dem_buffer_release(&text);
    return status;
}

void dem_scene_release(dem_scene *scene)
{
    struct dem_scene_owner *o = scene->owner;
    if (o) {
        for (size_t i = 0; i < o->clump_count; i++)
            dem_clump_destroy(o->clumps[i]);
        for (size_t i = 0; i < o->wall_count; i++)
            dem_mesh_free(&o->walls[i].mesh);
        free(o->clumps);
        free(o->bodies);
        free(o->fills);
        free(o->entries);
        free(o->walls);
        free(o->wall_sources);
        dem_json_release(o->root);
        dem_arena_release(&o->arena);
        free(o);
    }
    *scene = dem_scene_defaults();
}
