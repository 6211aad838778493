#include "out/results.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json.h"
#include "base/memory.h"
#include "base/status.h"
#include "sim/bodies_csv.h"
#include "sim/place.h"
#include "sim/scene.h"

static char *path_in(const char *directory, const char *name)
{
    dem_buffer path = {0};
    dem_buffer_print(&path, "%s/%s", directory, name);
    return path.data;
}

// the scene of run.json; its bodies are those of final.csv
static dem_status read_scene(const dem_ctx *ctx, const char *path, dem_results *r, dem_error *error)
{
    dem_buffer text;
    dem_json *root;
    DEM_TRY(dem_file_read(path, &text, error));
    dem_status status = dem_json_parse(text.data, text.size, path, &root, error);
    dem_buffer_release(&text);
    DEM_TRY(status);
    char *scene = dem_json_text(dem_json_member(root, "scene"));
    if (!dem_json_number(dem_json_member(root, "time"), &r->time))
        r->time = NAN;
    dem_json_release(root);
    if (!scene)
        return dem_fail_at(error, DEM_BAD_INPUT, path, 0, "holds no scene; name the output directory of dem-run");
    status = dem_scene_read_text(ctx, scene, strlen(scene), path, "/", (const char *[]){"bodies=[]", NULL}, &r->scene,
                                 error);
    free(scene);
    return status;
}

static dem_status make_clumps(dem_results *r, dem_error *error)
{
    r->clumps = dem_alloc_zero(r->scene.shape_count, sizeof *r->clumps);
    if (!r->clumps)
        return dem_fail_memory(error);
    for (size_t i = 0; i < r->scene.shape_count; i++) {
        const dem_clump *clump = r->scene.shapes[i].clump;
        if (!clump) {
            DEM_TRY(dem_sphere_clump(&r->scene, i, &r->clumps[i], error));
            continue;
        }
        r->clumps[i] = malloc(dem_clump_bytes(clump));
        if (!r->clumps[i])
            return dem_fail_memory(error);
        memcpy(r->clumps[i], clump, dem_clump_bytes(clump));
    }
    return DEM_OK;
}

typedef struct columns {
    uint32_t *shape;
    double *scale, *mass;
    dem_vec3 *position, *velocity, *spin;
    dem_quat *orientation;
} columns;

static dem_status fill_view(dem_results *r, const dem_body_def *defs, size_t n, dem_error *error)
{
    columns c = {dem_alloc(n, sizeof *c.shape),      dem_alloc(n, sizeof *c.scale),    dem_alloc(n, sizeof *c.mass),
                 dem_alloc(n, sizeof *c.position),   dem_alloc(n, sizeof *c.velocity), dem_alloc(n, sizeof *c.spin),
                 dem_alloc(n, sizeof *c.orientation)};
    r->bodies = (dem_body_view){.count = n,
                                .shape = c.shape,
                                .scale = c.scale,
                                .mass = c.mass,
                                .position = c.position,
                                .velocity = c.velocity,
                                .spin = c.spin,
                                .orientation = c.orientation};
    if (!c.shape || !c.scale || !c.mass || !c.position || !c.velocity || !c.spin || !c.orientation)
        return dem_fail_memory(error);
    for (size_t i = 0; i < n; i++) {
        const dem_body_def *d = &defs[i];
        c.shape[i] = d->shape;
        c.scale[i] = d->scale;
        c.mass[i] = dem_clump_view(r->clumps[d->shape]).mass * d->scale * d->scale * d->scale;
        c.position[i] = d->position;
        c.velocity[i] = d->velocity;
        c.spin[i] = d->spin;
        c.orientation[i] = d->orientation;
    }
    return DEM_OK;
}

static dem_status read_bodies(const char *path, dem_results *r, dem_error *error)
{
    dem_buffer text;
    dem_body_def *defs = NULL;
    size_t count = 0, capacity = 0;
    DEM_TRY(dem_file_read(path, &text, error));
    dem_status status = dem_bodies_csv_parse(text.data, text.size, path, r->scene.shapes, r->scene.shape_count, &defs,
                                             &count, &capacity, error);
    if (status == DEM_OK)
        status = fill_view(r, defs, count, error);
    dem_buffer_release(&text);
    free(defs);
    return status;
}

dem_status dem_results_read(const dem_ctx *ctx, const char *directory, dem_results *r, dem_error *error)
{
    *r = (dem_results){0};
    char *run = path_in(directory, "run.json"), *final = path_in(directory, "final.csv");
    dem_status status = run && final ? read_scene(ctx, run, r, error) : dem_fail_memory(error);
    if (status == DEM_OK)
        status = make_clumps(r, error);
    if (status == DEM_OK)
        status = read_bodies(final, r, error);
    free(run);
    free(final);
    return status;
}

void dem_results_release(dem_results *r)
{
    for (size_t i = 0; r->clumps && i < r->scene.shape_count; i++)
        dem_clump_destroy(r->clumps[i]);
    free(r->clumps);
    dem_scene_release(&r->scene);
    const void *all[] = {r->bodies.shape,    r->bodies.scale, r->bodies.mass,       r->bodies.position,
                         r->bodies.velocity, r->bodies.spin,  r->bodies.orientation};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free((void *)all[i]);
}
