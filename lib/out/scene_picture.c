#include "out/scene_picture.h"

#include <stdlib.h>

#include "base/file.h"
#include "base/memory.h"
#include "math/quat.h"
#include "out/wall_mesh.h"

static const double FIELD_DEG = 24, MARGIN = 0.03;
static const double LEVEL = 0.999;       // cosine of the tilt up to which a floor is the ground
static const float GLASS_CLEAR = 0.86f;  // light that passes straight through a wall
static const dem_colour GLASS = {0.62f, 0.72f, 0.80f};

enum { MOST_PIXELS = 20000 };  // of a side

// what the renderer draws: a shape and a body for every wall behind those of the bodies
typedef struct model {
    const dem_picture_options *options;
    const dem_body_view *view;
    dem_vec3 up;
    dem_clump_def *clumps;
    double *radii, *diameters;  // of the shapes: of a ball about the centre of mass; of equal volume [m]
    dem_mesh *walls;
    dem_render_shape *shapes;
    dem_render_body *bodies;
    size_t shape_count;
} model;

dem_picture_options dem_picture_defaults(void)
{
    return (dem_picture_options){
        .width = 1200,
        .height = 1600,
        .low = NAN,
        .high = NAN,
        .up = {0, 0, 1},
        .azimuth_deg = -60,
        .elevation_deg = 18,
        .domain = {.low = {-INFINITY, -INFINITY, -INFINITY}, .high = {INFINITY, INFINITY, INFINITY}}};
}

// ---- shapes

static void measure_shape(model *m, size_t i)
{
    const dem_clump_def *c = &m->clumps[i];
    for (size_t k = 0; k < c->ball_count; k++)
        m->radii[i] = fmax(m->radii[i], v3_norm(c->balls[k].centre) + c->balls[k].radius);
    m->diameters[i] = cbrt(6 * c->volume / DEM_PI);
    if (c->surface.triangle_count && !m->options->spheres)
        m->shapes[i].mesh = &c->surface;
    else
        m->shapes[i] = (dem_render_shape){.balls = c->balls, .ball_count = c->ball_count};
}

static dem_status make_room(model *m, const dem_clump *const *shapes, size_t shape_count, dem_error *error)
{
    size_t walls = m->options->wall_count;
    m->shape_count = shape_count;
    m->clumps = dem_alloc(shape_count, sizeof *m->clumps);
    m->radii = dem_alloc_zero(shape_count, sizeof *m->radii);
    m->diameters = dem_alloc_zero(shape_count, sizeof *m->diameters);
    m->walls = dem_alloc_zero(walls, sizeof *m->walls);
    m->shapes = dem_alloc_zero(shape_count + walls, sizeof *m->shapes);
    m->bodies = dem_alloc_zero(m->view->count + walls, sizeof *m->bodies);
    if (!m->clumps || !m->radii || !m->diameters || !m->walls || !m->shapes || !m->bodies)
        return dem_fail_memory(error);
    for (size_t i = 0; i < shape_count; i++) {
        m->clumps[i] = dem_clump_view(shapes[i]);
        measure_shape(m, i);
    }
    return DEM_OK;
}

static void release(model *m)
{
    for (size_t i = 0; m->walls && i < m->options->wall_count; i++)
        dem_mesh_free(&m->walls[i]);
    free(m->clumps);
    free(m->radii);
    free(m->diameters);
    free(m->walls);
    free(m->shapes);
    free(m->bodies);
}

// ---- bodies

static double value_of(const model *m, size_t i)
{
    const dem_body_view *b = m->view;
    switch (m->options->colour) {
    case DEM_PICTURE_SIZE:
        return b->scale[i] * m->diameters[b->shape[i]];
    case DEM_PICTURE_SPEED:
        return v3_norm(b->velocity[i]);
    case DEM_PICTURE_SPIN:
        return v3_norm(b->spin[i]);
    case DEM_PICTURE_COORDINATION:
        return b->coordination[i];
    case DEM_PICTURE_HEIGHT:
        return v3_dot(b->position[i], m->up);
    default:
        return NAN;
    }
}

static dem_colour colour_of(const model *m, size_t i, double low, double high)
{
    if (m->options->colour == DEM_PICTURE_NUMBER)
        return dem_colour_of_number(i);
    if (m->options->colour == DEM_PICTURE_SHAPE)  // the golden section takes hues that lie apart
        return dem_colour_lch(0.72, 0.085, 0.14 + 0.618033988749895 * m->view->shape[i]);
    double value = value_of(m, i);
    return dem_colour_ramp(high > low ? (value - low) / (high - low) : value - low);
}

static void place_bodies(model *m)
{
    const dem_body_view *b = m->view;
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < b->count; i++) {
        low = fmin(low, value_of(m, i));
        high = fmax(high, value_of(m, i));
    }
    low = isnan(m->options->low) ? low : m->options->low;
    high = isnan(m->options->high) ? high : m->options->high;
    for (size_t i = 0; i < b->count; i++)
        m->bodies[i] = (dem_render_body){.shape = b->shape[i],
                                         .position = b->position[i],
                                         .orientation = b->orientation[i],
                                         .scale = b->scale[i],
                                         .colour = colour_of(m, i, low, high)};
}

static dem_box bodies_box(const model *m)
{
    dem_box box = box_empty();
    for (size_t i = 0; i < m->view->count; i++) {
        double r = m->radii[m->view->shape[i]] * m->view->scale[i];
        box = box_with(box, v3_sub(m->view->position[i], v3(r, r, r)));
        box = box_with(box, v3_add(m->view->position[i], v3(r, r, r)));
    }
    return box;
}

// ---- walls

// a level floor; its height
static bool is_ground(const model *m, size_t wall, double *height)
{
    const dem_wall_def *def = &m->options->walls[wall];
    const dem_wall_view *pose = m->options->poses ? &m->options->poses[wall] : NULL;
    dem_vec3 n = pose ? quat_rotate(pose->orientation, def->normal) : def->normal;
    dem_vec3 point = pose ? v3_add(pose->position, quat_rotate(pose->orientation, def->point)) : def->point;
    *height = v3_dot(point, m->up);
    return def->kind == DEM_WALL_PLANE && v3_dot(n, m->up) > LEVEL;
}

// those that are the ground come last, so that they can be counted for the camera and then left out
static dem_status place_walls(model *m, size_t *glass, double *ground, dem_error *error)
{
    const dem_picture_options *o = m->options;
    dem_box box = dem_walls_box(&o->domain, bodies_box(m), o->walls, o->poses, o->wall_count);
    size_t floors = 0;
    *glass = 0;
    *ground = INFINITY;
    for (size_t i = 0; i < o->wall_count; i++) {
        DEM_TRY(dem_wall_mesh(&o->walls[i], o->poses ? &o->poses[i] : NULL, box, &m->walls[i], error));
        double height;
        bool floor = is_ground(m, i, &height);
        *ground = floor ? fmin(*ground, height) : *ground;
        size_t place = floor ? o->wall_count - ++floors : (*glass)++;
        m->shapes[m->shape_count + place].mesh = &m->walls[i];
        m->bodies[m->view->count + place] = (dem_render_body){.shape = (uint32_t)(m->shape_count + place),
                                                              .orientation = {1, 0, 0, 0},
                                                              .scale = 1,
                                                              .colour = GLASS,
                                                              .clear = GLASS_CLEAR};
    }
    return DEM_OK;
}

// ---- the picture

static dem_camera choose_camera(const model *m)
{
    double azimuth = m->options->azimuth_deg * DEM_PI / 180, elevation = m->options->elevation_deg * DEM_PI / 180;
    dem_vec3 right = v3_normal_to(m->up), ahead = v3_cross(m->up, right);
    dem_vec3 level = v3_along(v3_scale(right, cos(azimuth)), sin(azimuth), ahead);
    dem_vec3 eye = v3_along(v3_scale(level, cos(elevation)), sin(elevation), m->up);
    return (dem_camera){.forward = v3_scale(eye, -1), .up = m->up, .field_deg = FIELD_DEG, .margin = MARGIN};
}

static dem_status check_options(const dem_picture_options *o, dem_error *error)
{
    if (o->width < 1 || o->height < 1 || o->width > MOST_PIXELS || o->height > MOST_PIXELS)
        return dem_fail(error, DEM_USAGE, "a picture of %d x %d pixels; take 1 to %d each", o->width, o->height,
                        MOST_PIXELS);
    if (!(fabs(o->elevation_deg) < 90) || !isfinite(o->azimuth_deg))
        return dem_fail(error, DEM_USAGE, "the elevation must lie between -90 and 90 degrees; take 18");
    return DEM_OK;
}

dem_status dem_scene_picture_render(const dem_ctx *ctx, const dem_body_view *bodies, const dem_clump *const *shapes,
                                    size_t shape_count, const dem_picture_options *options, dem_image *image,
                                    dem_view *view, dem_error *error)
{
    model m = {.options = options, .view = bodies, .up = v3_unit(options->up)};
    size_t glass = 0;
    double ground = INFINITY;
    *image = (dem_image){0};
    DEM_TRY(check_options(options, error));
    dem_status status = make_room(&m, shapes, shape_count, error);
    if (status == DEM_OK) {
        place_bodies(&m);
        status = place_walls(&m, &glass, &ground, error);
    }
    if (status == DEM_OK) {
        size_t all = bodies->count + options->wall_count;
        dem_render_scene scene = {m.shapes, shape_count + options->wall_count, m.bodies, all};
        dem_camera camera = choose_camera(&m);
        dem_view fit = dem_view_fit(&scene, &camera, options->width, options->height);
        scene.body_count = bodies->count + glass;
        fit.ground = isfinite(ground) ? ground : fit.ground;
        if (view)
            *view = fit;
        status = dem_render(ctx, &scene, &fit, image, error);
    }
    release(&m);
    return status;
}

dem_status dem_picture_bodies(const dem_ctx *ctx, const dem_body_view *bodies, const dem_clump *const *shapes,
                              size_t shape_count, const dem_picture_options *options, const char *path,
                              dem_error *error)
{
    dem_image image;
    dem_buffer png = {0};
    DEM_TRY(dem_scene_picture_render(ctx, bodies, shapes, shape_count, options, &image, NULL, error));
    dem_status status = dem_png_encode(&image, &png, error);
    dem_image_free(&image);
    if (status == DEM_OK)
        return dem_file_write_buffer(path, &png, error);
    dem_buffer_release(&png);
    return status;
}
