#include "out/picture.h"

#include <stdlib.h>

#include "base/file.h"
#include "base/memory.h"
#include "geom/union.h"
#include "math/mat3.h"

enum { WIDTH = 2000, HEIGHT = 1000, HUES = 6, SWEEPS = 4 };

static const double TURN = 28 * DEM_PI / 180;  // of the long axis out of the picture's plane
static const double MARGIN = 0.09;

static const dem_colour STONE = {0.46f, 0.41f, 0.35f};

// second moments of a surface about its centre
static dem_sym3 surface_spread(const dem_mesh *mesh)
{
    dem_sym3 sum = {0};
    dem_vec3 first = {0}, origin = mesh->vertices[mesh->triangles[0]];
    double area = 0;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        dem_vec3 corner[3];
        for (int k = 0; k < 3; k++)
            corner[k] = v3_sub(mesh->vertices[mesh->triangles[3 * t + (size_t)k]], origin);
        double a = v3_norm(v3_cross(v3_sub(corner[1], corner[0]), v3_sub(corner[2], corner[0]))) / 2;
        dem_vec3 middle = v3_scale(v3_add(v3_add(corner[0], corner[1]), corner[2]), 1.0 / 3);
        area += a;
        first = v3_along(first, a, middle);
        // int x x^T dA = A / 12 (9 m m^T + sum of c c^T)
        sum = sym3_add(sum, sym3_scale(sym3_outer(middle), a * 9 / 12));
        for (int k = 0; k < 3; k++)
            sum = sym3_add(sum, sym3_scale(sym3_outer(corner[k]), a / 12));
    }
    return area > 0 ? sym3_add(sum, sym3_scale(sym3_outer(first), -1 / area)) : sum;
}

static dem_sym3 balls_spread(const dem_ball *balls, size_t count)
{
    dem_sym3 sum = {0};
    dem_vec3 first = {0};
    double volume = 0;
    for (size_t i = 0; i < count; i++) {
        double r = balls[i].radius, v = r * r * r, own = v * r * r / 5;
        dem_vec3 c = v3_sub(balls[i].centre, balls[0].centre);
        volume += v;
        first = v3_along(first, v, c);
        sum = sym3_add(sum, sym3_scale(sym3_outer(c), v));
        sum = sym3_add(sum, (dem_sym3){own, own, own, 0, 0, 0});
    }
    return sym3_add(sum, sym3_scale(sym3_outer(first), -1 / volume));
}

// the grain lies flat, its long axis turned a little out of the picture, seen from above
static dem_camera choose_camera(dem_sym3 spread)
{
    double sizes[3];
    dem_vec3 axes[3];  // shortest first
    dem_sym3_eigen(spread, sizes, axes);
    // the flatter it is, the more from above
    double thickness = sizes[0] > 0 ? sqrt(sizes[0] / sizes[1]) : 0;
    double elevation = (62 - 26 * thickness) * DEM_PI / 180;
    dem_vec3 up = axes[0], toward = v3_add(v3_scale(axes[1], cos(TURN)), v3_scale(axes[2], sin(TURN)));
    dem_vec3 eye = v3_add(v3_scale(toward, cos(elevation)), v3_scale(up, sin(elevation)));
    return (dem_camera){.forward = v3_scale(eye, -1), .up = up, .margin = MARGIN};
}

// every ball takes, some times over, the hue it has the shortest seams with, on the surface (arcs are listed ball by
// ball)
static void choose_hues(int *hues, size_t count, const dem_ball *balls, const dem_ball_union *seams)
{
    size_t end = 0;
    for (size_t turn = 0; turn < SWEEPS * count; turn++) {
        size_t i = turn % count;
        size_t begin = i ? end : 0;  // the arcs of this ball
        for (end = begin; end < seams->arc_count && seams->arcs[end].i == i; end++)
            ;
        double met[HUES] = {0};
        for (size_t k = begin; k < end; k++) {
            const dem_arc *arc = &seams->arcs[k];
            if (hues[arc->j] >= 0)
                met[hues[arc->j]] += balls[i].radius * arc->s * (arc->end - arc->begin);
        }
        int best = hues[i] >= 0 ? hues[i] : (int)(i % HUES);
        for (int h = 0; h < HUES; h++)
            if (met[h] < met[best])
                best = h;
        hues[i] = best;
    }
}

static dem_status colour_balls(const dem_ball *balls, size_t count, dem_colour *colours, dem_error *error)
{
    // clay, sand, sage, sea, sky, heather
    static const double turns[HUES] = {0.09, 0.20, 0.37, 0.52, 0.68, 0.90};
    dem_ball_union seams;
    DEM_TRY(dem_ball_union_compute(balls, count, true, 1, &seams, error));
    int *hues = dem_alloc(count, sizeof *hues);
    if (hues) {
        for (size_t i = 0; i < count; i++)
            hues[i] = -1;
        choose_hues(hues, count, balls, &seams);
        for (size_t i = 0; i < count; i++)
            colours[i] = dem_colour_lch(0.74, 0.07, turns[hues[i]]);
    }
    free(hues);
    dem_ball_union_release(&seams);
    return hues ? DEM_OK : dem_fail_memory(error);
}

static bool has_mesh(const dem_grain_picture *g)
{
    return g->mesh && g->mesh->triangle_count > 0;
}

// a mesh, balls or both in one place
typedef struct model {
    dem_render_shape shapes[2];
    dem_render_body bodies[2];
    dem_render_scene scene;
} model;

static void fill_model(const dem_grain_picture *g, const dem_colour *colours, model *m)
{
    size_t n = 0;
    if (g->count) {
        m->shapes[n] = (dem_render_shape){.balls = g->balls, .ball_count = g->count, .part_colours = colours};
        m->bodies[n++] = (dem_render_body){.shape = 0, .orientation = {1, 0, 0, 0}, .scale = 1};
    }
    if (has_mesh(g)) {
        m->shapes[n] = (dem_render_shape){.mesh = g->mesh};
        m->bodies[n] =
            (dem_render_body){.shape = (uint32_t)n, .orientation = {1, 0, 0, 0}, .scale = 1, .colour = STONE};
        n++;
    }
    m->scene = (dem_render_scene){m->shapes, n, m->bodies, n, g->background, g->samples};
}

static dem_view view_of(const dem_grain_picture *g, const model *m, int width, int height)
{
    dem_camera camera = g->camera
                            ? *g->camera
                            : choose_camera(has_mesh(g) ? surface_spread(g->mesh) : balls_spread(g->balls, g->count));
    camera.margin = MARGIN;
    camera.field_deg = g->field_deg;
    dem_view view = dem_view_fit(&m->scene, &camera, m->scene.body_count == 2 ? width / 2 : width, height);
    if (g->look_at) {
        view.radius += v3_distance(view.centre, *g->look_at);
        view.centre = *g->look_at;
    }
    view.pixel = fmax(view.pixel, g->pixel);
    view.pixel /= g->zoom > 0 ? g->zoom : 1;
    return view;
}

static dem_status check_grain(const dem_grain_picture *g, dem_error *error)
{
    return g->count || has_mesh(g) ? DEM_OK : dem_fail(error, DEM_USAGE, "there are no spheres to draw");
}

dem_status dem_grain_view(const dem_grain_picture *g, int width, int height, dem_view *view, dem_error *error)
{
    model m;
    DEM_TRY(check_grain(g, error));
    fill_model(g, NULL, &m);
    *view = view_of(g, &m, width, height);
    return DEM_OK;
}

dem_status dem_grain_render(const dem_ctx *ctx, const dem_grain_picture *g, int width, int height, dem_image *image,
                            dem_view *left, dem_error *error)
{
    model m;
    *image = (dem_image){0};
    DEM_TRY(check_grain(g, error));
    dem_colour *colours = dem_alloc(g->count, sizeof *colours);
    if (!colours)
        return dem_fail_memory(error);
    fill_model(g, colours, &m);
    // half of the picture holds both in one place; then they move apart by its breadth
    dem_view view = view_of(g, &m, width, height);
    if (left)
        *left = view;
    if (m.scene.body_count == 2) {
        double half = view.width * view.pixel / 2;
        m.bodies[0].position = v3_scale(view.right, half);
        m.bodies[1].position = v3_scale(view.right, -half);
        view.width = width;
        view.radius += half;
    }
    dem_status status = g->count ? colour_balls(g->balls, g->count, colours, error) : DEM_OK;
    if (status == DEM_OK)
        status = dem_render(ctx, &m.scene, &view, image, error);
    free(colours);
    return status;
}

dem_status dem_picture_render(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count, int width,
                              int height, dem_image *image, dem_view *left, dem_error *error)
{
    const dem_grain_picture grain = {.mesh = mesh, .balls = balls, .count = count};
    *image = (dem_image){0};
    if (count == 0)
        return dem_fail(error, DEM_USAGE, "there are no spheres to draw");
    return dem_grain_render(ctx, &grain, width, height, image, left, error);
}

dem_status dem_picture_render_part(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count,
                                   dem_picture_part part, int width, int height, dem_image *image, dem_error *error)
{
    const dem_grain_picture grain = {.mesh = mesh, .balls = balls, .count = count};
    model m;
    *image = (dem_image){0};
    if (count == 0)
        return dem_fail(error, DEM_USAGE, "there are no spheres to draw");
    dem_colour *colours = dem_alloc(count, sizeof *colours);
    if (!colours)
        return dem_fail_memory(error);
    fill_model(&grain, colours, &m);
    dem_view view = view_of(&grain, &m, m.scene.body_count == 2 ? 2 * width : width, height);
    view.width = width;
    m.scene.bodies = &m.bodies[part == DEM_PICTURE_GRAIN ? m.scene.body_count - 1 : 0];
    m.scene.body_count = 1;
    dem_status status = colour_balls(balls, count, colours, error);
    if (status == DEM_OK)
        status = dem_render(ctx, &m.scene, &view, image, error);
    free(colours);
    return status;
}

dem_status dem_picture_draw(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count,
                            dem_buffer *out, dem_error *error)
{
    dem_image image;
    DEM_TRY(dem_picture_render(ctx, mesh, balls, count, WIDTH, HEIGHT, &image, NULL, error));
    dem_status status = dem_png_encode(&image, out, error);
    dem_image_free(&image);
    return status;
}

dem_status dem_picture_clump(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count,
                             const char *path, dem_error *error)
{
    dem_buffer png = {0};
    dem_status status = dem_picture_draw(ctx, mesh, balls, count, &png, error);
    if (status == DEM_OK)
        return dem_file_write_buffer(path, &png, error);
    dem_buffer_release(&png);
    return status;
}
