// Clumps, meshes and the VTP files of both, one at a time.
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "math/vec.h"
#include "out/legend.h"
#include "out/grid.h"
#include "view.h"

static dem_status open_clump(const view_arguments *a, const char *path, bool alone, view_grain *g, dem_error *error)
{
    DEM_TRY(dem_clump_read(path, &g->clump, error));
    g->def = dem_clump_view(g->clump);
    g->in_metres = true;
    bool kept = g->def.surface.triangle_count > 0;
    if (a->surface && !kept)
        return dem_fail_at(error, DEM_BAD_INPUT, path, 0, "keeps no surface; leave out --surface");
    if (kept && (a->surface || (alone && !a->spheres)))
        g->picture.mesh = &g->def.surface;
    if (!a->surface || a->spheres) {
        g->picture.balls = g->def.balls;
        g->picture.count = g->def.ball_count;
    }
    return DEM_OK;
}

static dem_status take_balls(const dem_vtp *v, const dem_vtp_array *radii, view_grain *g, dem_error *error)
{
    g->balls = dem_alloc(v->point_count, sizeof *g->balls);
    if (!g->balls)
        return dem_fail_memory(error);
    for (size_t i = 0; i < v->point_count; i++)
        g->balls[i] = (dem_ball){v->points[i], dem_vtp_value(radii, i, 0)};
    g->picture.balls = g->balls;
    g->picture.count = v->point_count;
    return DEM_OK;
}

static bool is_good(const view_grain *g)
{
    bool good = true;
    for (size_t i = 0; i < g->picture.count; i++)
        good &= isfinite(v3_norm2(g->picture.balls[i].centre)) && g->picture.balls[i].radius > 0 &&
                isfinite(g->picture.balls[i].radius);
    for (size_t i = 0; i < g->mesh.vertex_count; i++)
        good &= isfinite(v3_norm2(g->mesh.vertices[i]));
    return good;
}

// spheres with their radii, or triangles
static dem_status open_vtp(const char *path, view_grain *g, dem_error *error)
{
    dem_vtp_file file;
    DEM_TRY(dem_vtp_read(path, &file, error));
    const dem_vtp *v = &file.vtp;
    const dem_vtp_array *radii = dem_vtp_find(v, "radius");
    dem_status status = DEM_OK;
    g->in_metres = true;
    if (v->triangle_count) {
        const dem_mesh mesh = {.vertices = (dem_vec3 *)(uintptr_t)v->points,
                               .triangles = (uint32_t *)(uintptr_t)v->triangles,
                               .vertex_count = v->point_count,
                               .triangle_count = v->triangle_count};
        status = dem_mesh_copy(&mesh, &g->mesh, error);
        g->picture.mesh = &g->mesh;
    } else if (radii && radii->width == 1 && v->point_count) {
        status = take_balls(v, radii, g, error);
    } else {
        status = dem_fail_at(error, DEM_BAD_INPUT, path, 0, "holds neither triangles nor spheres; name another file");
    }
    if (status == DEM_OK && !is_good(g))
        status = dem_fail_at(error, DEM_BAD_INPUT, path, 0,
                             "has points or radii that are no numbers, or radii that are not above 0; write it again");
    dem_vtp_file_release(&file);
    return status;
}

static dem_status open_mesh(const dem_ctx *ctx, const view_choices *c, const char *path, view_grain *g,
                            dem_error *error)
{
    DEM_TRY(dem_mesh_read(ctx, path, &g->mesh, error));
    g->in_metres = !isnan(c->unit);
    if (g->in_metres)
        dem_mesh_scale(&g->mesh, c->unit);
    g->picture.mesh = &g->mesh;
    return DEM_OK;
}

// as the arguments tell it; what they leave open is as for runs
static dem_camera given_camera(const view_choices *c)
{
    const view_arguments *a = c->arguments;
    const dem_picture_options o = dem_picture_defaults();
    return dem_camera_around(c->up, isnan(a->azimuth) ? o.azimuth_deg : a->azimuth,
                             isnan(a->elevation) ? o.elevation_deg : a->elevation, 0, 0);
}

dem_status view_grain_open(const dem_ctx *ctx, const view_choices *c, const char *path, bool alone, view_grain *g,
                           dem_error *error)
{
    const view_arguments *a = c->arguments;
    *g = (view_grain){.camera = given_camera(c)};
    if (dem_file_has_suffix(path, "json"))
        DEM_TRY(open_clump(a, path, alone, g, error));
    else if (dem_file_has_suffix(path, "vtp"))
        DEM_TRY(open_vtp(path, g, error));
    else
        DEM_TRY(open_mesh(ctx, c, path, g, error));
    g->picture.zoom = a->zoom;
    g->picture.field_deg = a->perspective ? 24 : 0;
    g->picture.samples = (int)a->samples;
    g->picture.background = &c->light;
    g->picture.camera = c->camera_given ? &g->camera : NULL;
    g->picture.look_at = isnan(c->look_at.x) ? NULL : &c->look_at;
    return DEM_OK;
}

// room for the scale bar
static int foot_of(const view_choices *c, const view_grain *g, int width, int height, double *size)
{
    const view_arguments *a = c->arguments;
    *size = a->label_size > 0 ? a->label_size : dem_label_size(width, height);
    return a->no_labels || !g->in_metres ? 0 : (int)fmin(dem_foot_height(*size), height / 4.0);
}

dem_status view_grain_pixel(const view_choices *c, const view_grain *g, int width, int height, double *pixel,
                            dem_error *error)
{
    dem_view view;
    double size;
    int foot = foot_of(c, g, width, height, &size);
    DEM_TRY(dem_grain_view(&g->picture, width, height - foot, &view, error));
    *pixel = view.pixel * c->arguments->zoom;
    return DEM_OK;
}

dem_status view_grain_draw(const dem_ctx *ctx, const view_choices *c, const view_grain *g, int width, int height,
                           dem_image *image, dem_error *error)
{
    dem_view view;
    double size;
    int foot = foot_of(c, g, width, height, &size);
    const uint8_t *b = c->background;
    DEM_TRY(dem_grain_render(ctx, &g->picture, width, height - foot, image, &view, error));
    if (foot == 0)
        return DEM_OK;
    dem_image part = *image;
    dem_status status = dem_image_create(width, height, image, error);
    if (status == DEM_OK) {
        dem_image_fill(image, (dem_rgb){b[0], b[1], b[2]});
        dem_image_paste(image, &part, 0, 0);
        status = dem_scale_bar_draw(image, dem_label_margin(size), height - dem_label_margin(size), 0.25 * width,
                                    view.pixel, "m", size, dem_ink_on(b), error);
    }
    dem_image_free(&part);
    return status;
}

void view_grain_release(view_grain *g)
{
    dem_clump_destroy(g->clump);
    dem_mesh_free(&g->mesh);
    free(g->balls);
}
