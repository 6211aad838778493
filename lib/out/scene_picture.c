#include "out/scene_picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/quat.h"
#include "out/field.h"
#include "out/legend.h"
#include "out/palette.h"
#include "out/grid.h"
#include "out/wall_mesh.h"

static const double FIELD_DEG = 24, MARGIN = 0.03;
static const double LEVEL = 0.999;       // cosine of the tilt up to which a floor is the ground
static const float GLASS_CLEAR = 0.86f;  // light that passes straight through a wall
static const dem_colour GLASS = {0.62f, 0.72f, 0.80f};

static const double SMALL = 0.016;         // height of a capital letter, over the size of the picture
static const double NEARLY = 0.06;         // over the range
static const double LEGEND_HEIGHT = 0.62;  // over that of the picture

enum { MOST_PIXELS = 20000 };  // of a side

// what the renderer draws: a shape and a body for every wall behind those of the bodies
typedef struct model {
    const dem_picture_options *options;
    const dem_body_view *view;
    dem_vec3 up;
    dem_clump_def *clumps;
    double *radii, *diameters;  // of the shapes: of a ball about the centre of mass; of equal volume [m]
    dem_mesh *walls;
    double **depths;            // worn off their triangles [m]; NULL: nothing is worn, or it is not shown
    dem_colour **wall_colours;  // of their triangles
    dem_render_shape *shapes;
    dem_render_body *bodies;
    size_t shape_count, body_count, glass;  // of the clumps; those that are shown; walls that are not the ground
    double ground;                          // height of the ground, INFINITY: there is no floor [m]
    dem_field field;                        // values: NULL: the colours show no numbers
    dem_palette palette;
    double low, high;
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
        .zoom = 1,
        .look_at = {NAN, NAN, NAN},
        .samples = 16,
        .background = {255, 255, 255},
        .time = NAN,
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
    m->depths = dem_alloc_zero(walls, sizeof *m->depths);
    m->wall_colours = dem_alloc_zero(walls, sizeof *m->wall_colours);
    m->shapes = dem_alloc_zero(shape_count + walls, sizeof *m->shapes);
    m->bodies = dem_alloc_zero(m->view->count + walls, sizeof *m->bodies);
    if (!m->clumps || !m->radii || !m->diameters || !m->walls || !m->depths || !m->wall_colours ||
        !m->shapes || !m->bodies)
        return dem_fail_memory(error);
    for (size_t i = 0; i < shape_count; i++) {
        m->clumps[i] = dem_clump_view(shapes[i]);
        measure_shape(m, i);
    }
    return DEM_OK;
}

static void clear_walls(model *m)
{
    for (size_t i = 0; m->walls && m->depths && m->wall_colours && i < m->options->wall_count; i++) {
        dem_mesh_free(&m->walls[i]);
        free(m->depths[i]);
        free(m->wall_colours[i]);
        m->depths[i] = NULL;
        m->wall_colours[i] = NULL;
    }
}

static void release(model *m)
{
    clear_walls(m);
    free(m->field.values);
    free(m->clumps);
    free(m->radii);
    free(m->diameters);
    free(m->walls);
    free(m->depths);
    free(m->wall_colours);
    free(m->shapes);
    free(m->bodies);
}

// ---- bodies

// what is shown is not of bodies
static dem_status no_values(model *m, dem_error *error)
{
    m->field = (dem_field){.unit = "m", .title = "wear depth"};
    m->field.values = dem_alloc(m->view->count, sizeof *m->field.values);
    if (!m->field.values)
        return dem_fail_memory(error);
    for (size_t i = 0; i < m->view->count; i++)
        m->field.values[i] = NAN;
    return DEM_OK;
}

static dem_status find_values(model *m, dem_error *error)
{
    const dem_picture_options *o = m->options;
    const char *name = dem_field_of_colour(o->colour);
    const dem_field_source source = {.bodies = m->view, .diameters = m->diameters, .up = m->up};
    m->field = (dem_field){.unit = ""};
    if (name)
        return dem_field_make(name, &source, &m->field, error);
    if (o->colour == DEM_PICTURE_WEAR)
        return no_values(m, error);
    if (o->colour != DEM_PICTURE_VALUES)
        return DEM_OK;
    if (!o->values)
        return dem_fail(error, DEM_USAGE, "there are no values to show in colours; give `values`");
    m->field.unit = o->unit ? o->unit : "";
    m->field.whole = o->whole;
    snprintf(m->field.title, sizeof m->field.title, "%s", o->title ? o->title : "");
    m->field.values = dem_alloc(m->view->count, sizeof *m->field.values);
    if (!m->field.values)
        return dem_fail_memory(error);
    if (m->view->count)
        memcpy(m->field.values, o->values, m->view->count * sizeof *m->field.values);
    return DEM_OK;
}

static dem_colour colour_of_shape(size_t shape)  // the golden section takes hues that lie apart
{
    return dem_colour_lch(0.72, 0.085, 0.14 + 0.618033988749895 * (double)shape);
}

static dem_colour colour_of_value(const model *m, double value)
{
    value -= m->low;
    return dem_palette_at(&m->palette, m->high > m->low ? value / (m->high - m->low) : value);
}

static dem_colour colour_of(const model *m, size_t i)
{
    if (!m->field.values)
        return m->options->colour == DEM_PICTURE_SHAPE ? colour_of_shape(m->view->shape[i]) : dem_colour_of_number(i);
    return colour_of_value(m, m->field.values[i]);
}

static bool is_hidden(const model *m, size_t i)
{
    return m->options->hidden && m->options->hidden[i];
}

static void place_bodies(model *m)
{
    const dem_body_view *b = m->view;
    m->body_count = 0;
    for (size_t i = 0; i < b->count; i++)
        if (!is_hidden(m, i))
            m->bodies[m->body_count++] = (dem_render_body){.shape = b->shape[i],
                                                           .position = b->position[i],
                                                           .orientation = b->orientation[i],
                                                           .scale = b->scale[i],
                                                           .colour = colour_of(m, i)};
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

// of a wall that wears, where that is shown
static dem_status find_depths(model *m, size_t wall, dem_error *error)
{
    const dem_picture_options *o = m->options;
    size_t count = m->walls[wall].triangle_count;
    if (o->colour != DEM_PICTURE_WEAR || !o->poses || !o->poses[wall].wear || !count)
        return DEM_OK;
    m->depths[wall] = dem_alloc(count, sizeof *m->depths[wall]);
    m->wall_colours[wall] = dem_alloc(count, sizeof *m->wall_colours[wall]);
    if (!m->depths[wall] || !m->wall_colours[wall])
        return dem_fail_memory(error);
    dem_wall_worn(&m->walls[wall], &o->poses[wall], NULL, m->depths[wall]);
    return DEM_OK;
}

static void include_depths(const model *m, double *low, double *high)
{
    for (size_t i = 0; i < m->options->wall_count; i++)
        for (size_t t = 0; m->depths[i] && t < m->walls[i].triangle_count; t++) {
            *low = 0;
            *high = fmax(*high, m->depths[i][t]);
        }
}

// once the range is known
static void colour_walls(model *m)
{
    for (size_t i = 0; i < m->options->wall_count; i++)
        for (size_t t = 0; m->depths[i] && t < m->walls[i].triangle_count; t++)
            m->wall_colours[i][t] = colour_of_value(m, m->depths[i][t]);
}

// those that are the ground come last, so that they can be counted for the camera and then left out
static dem_status place_walls(model *m, dem_box bodies, dem_error *error)
{
    const dem_picture_options *o = m->options;
    dem_box box = dem_walls_box(&o->domain, bodies, o->walls, o->poses, o->wall_count);
    size_t floors = 0;
    m->glass = 0;
    m->ground = INFINITY;
    for (size_t i = 0; i < o->wall_count; i++) {
        DEM_TRY(dem_wall_mesh(&o->walls[i], o->poses ? &o->poses[i] : NULL, box, &m->walls[i], error));
        DEM_TRY(find_depths(m, i, error));
        double height;
        bool floor = is_ground(m, i, &height) && !m->depths[i];
        m->ground = floor ? fmin(m->ground, height) : m->ground;
        size_t place = floor ? o->wall_count - ++floors : m->glass++;
        m->shapes[m->shape_count + place] =
            (dem_render_shape){.mesh = &m->walls[i], .part_colours = m->wall_colours[i]};
        m->bodies[m->body_count + place] = (dem_render_body){.shape = (uint32_t)(m->shape_count + place),
                                                             .orientation = {1, 0, 0, 0},
                                                             .scale = 1,
                                                             .colour = GLASS,
                                                             .clear = m->depths[i] ? 0 : GLASS_CLEAR};
    }
    return DEM_OK;
}

// ---- the camera

static dem_view choose_view(const model *m, const dem_picture_span *span)
{
    const dem_picture_options *o = m->options;
    dem_view view = dem_fit_end(&span->fit);
    view.ground = isfinite(m->ground) ? m->ground : view.ground;
    if (isfinite(v3_norm2(o->look_at))) {
        view.radius += v3_distance(view.centre, o->look_at);
        view.centre = o->look_at;
    }
    view.pixel /= o->zoom;
    return view;
}

// ---- what is written beside the bodies

typedef struct layout {
    double size;        // of capital letters [pixels]
    int width, height;  // of what is left for the bodies
    dem_legend legend;  // without a range
    bool has_legend;
    const char **names;  // of the shapes
    dem_colour *colours;
} layout;

double dem_label_size(int width, int height)
{
    return fmin(fmax(round(SMALL * sqrt((double)width * height)), 8), 200);
}

dem_rgb dem_ink_on(const uint8_t background[3])
{
    bool light = 299 * background[0] + 587 * background[1] + 114 * background[2] > 128000;
    return light ? (dem_rgb){24, 24, 24} : (dem_rgb){235, 235, 235};
}

static dem_status name_shapes(const model *m, layout *l, dem_error *error)
{
    enum { NAME_BYTES = 24 };
    l->names = dem_alloc(m->shape_count, sizeof *l->names + NAME_BYTES);
    l->colours = dem_alloc(m->shape_count, sizeof *l->colours);
    if (!l->names || !l->colours)
        return dem_fail_memory(error);
    char *room = (char *)(l->names + m->shape_count);
    for (size_t i = 0; i < m->shape_count; i++, room += NAME_BYTES) {
        snprintf(room, NAME_BYTES, "%zu", i);
        const char *const *given = m->options->shape_names;
        l->names[i] = given && given[i] ? given[i] : room;
        l->colours[i] = colour_of_shape(i);
    }
    l->legend = (dem_legend){.names = l->names, .colours = l->colours, .count = m->shape_count};
    return DEM_OK;
}

static dem_status lay_out(const model *m, layout *l, dem_error *error)
{
    const dem_picture_options *o = m->options;
    *l = (layout){.width = o->width, .height = o->height};
    if (!o->labels)
        return DEM_OK;
    l->size = o->label_size > 0 ? o->label_size : dem_label_size(o->width, o->height);
    if (o->colour == DEM_PICTURE_SHAPE)
        DEM_TRY(name_shapes(m, l, error));
    else
        l->legend = (dem_legend){.title = m->field.title[0] ? m->field.title : NULL,
                                 .unit = m->field.unit,
                                 .whole = m->field.whole,
                                 .palette = &m->palette};
    l->has_legend = m->field.values || l->names;
    // a legend may take a third of the picture, the line at its foot a quarter
    double strip = l->has_legend ? dem_legend_width(&l->legend, l->size) + 2 * dem_label_margin(l->size) : 0;
    double foot = dem_foot_height(l->size);
    l->width -= (int)fmin(strip, o->width / 3.0);
    l->height -= (int)fmin(foot, o->height / 4.0);
    return DEM_OK;
}

static void release_layout(layout *l)
{
    free(l->names);
    free(l->colours);
}

static dem_status write_legend(const model *m, const layout *l, dem_image *image, dem_rgb ink, dem_error *error)
{
    dem_legend legend = l->legend;
    legend.low = m->low;
    legend.high = m->high;
    for (size_t i = 0; m->field.values && i < m->view->count; i++) {
        legend.below |= !is_hidden(m, i) && m->field.values[i] < m->low;
        legend.above |= !is_hidden(m, i) && m->field.values[i] > m->high;
    }
    double height = fmin(LEGEND_HEIGHT * l->height, 40 * l->size);
    return dem_legend_draw(image, &legend, l->width + dem_label_margin(l->size), (l->height - height) / 2, height,
                           l->size, ink, error);
}

static dem_status write_labels(const model *m, const layout *l, const dem_view *view, const dem_picture_span *span,
                               dem_image *image, dem_error *error)
{
    const dem_picture_options *o = m->options;
    dem_rgb ink = dem_ink_on(o->background);
    double side = dem_label_margin(l->size), base = image->height - side;
    DEM_TRY(dem_scale_bar_draw(image, side, base, 0.25 * l->width, view->pixel, "m", l->size, ink, error));
    if (isfinite(o->time)) {
        char time[DEM_LABEL_TEXT], text[DEM_LABEL_TEXT + 8];
        const dem_text_style style = {.size = l->size, .ink = ink, .align = DEM_ALIGN_RIGHT};
        snprintf(text, sizeof text, "t = %s", dem_quantity_text(o->time, "s", fmax(span->end, o->time), time));
        DEM_TRY(dem_text_draw(image, l->width - side, base, &style, text, error));
    }
    return l->has_legend ? write_legend(m, l, image, ink, error) : DEM_OK;
}

// ---- the picture

static dem_status check_options(const dem_picture_options *o, dem_error *error)
{
    if (o->width < 1 || o->height < 1 || o->width > MOST_PIXELS || o->height > MOST_PIXELS)
        return dem_fail(error, DEM_USAGE, "a picture of %d x %d pixels; take 1 to %d each", o->width, o->height,
                        MOST_PIXELS);
    if (!(fabs(o->elevation_deg) < 90) || !isfinite(o->azimuth_deg))
        return dem_fail(error, DEM_USAGE, "the elevation must lie between -90 and 90 degrees; take 18");
    if (!(o->zoom > 0 && isfinite(o->zoom)))
        return dem_fail(error, DEM_USAGE, "the zoom must be above 0; take 1");
    if (!(v3_norm2(o->up) > 0))
        return dem_fail(error, DEM_USAGE, "nothing tells which way is up; take z");
    return DEM_OK;
}

// an end that nearly is a round number becomes one
static void round_ends(double *low, double *high)
{
    double ticks[DEM_TICKS], step, span = *high - *low;
    if (!(span > 0) || dem_ticks(*low, *high, 8, false, ticks, &step) < 2)
        return;
    double below = floor(*low / step) * step, above = ceil(*high / step) * step;
    *low = *low - below < NEARLY * span ? below : *low;
    *high = above - *high < NEARLY * span ? above : *high;
}

dem_picture_map dem_picture_range(const dem_picture_options *o, const dem_picture_span *span, double *low, double *high)
{
    bool none = !(span->low <= span->high), chosen = isnan(o->low) && isnan(o->high);
    double near_low = none ? 0 : span->low, near_high = none ? 0 : span->high;
    if (!none)
        round_ends(&near_low, &near_high);
    *low = isnan(o->low) ? near_low : o->low;
    *high = isnan(o->high) ? near_high : o->high;
    bool split = *low < 0 && *high > 0;
    bool may_diverge = o->map == DEM_PICTURE_MAP_AUTO || o->map == DEM_PICTURE_MAP_DIVERGING;
    if (chosen && split && may_diverge && fmin(-*low, *high) > NEARLY * (*high - *low)) {  // white is zero
        *high = fmax(-*low, *high);
        *low = -*high;
    }
    if (o->map != DEM_PICTURE_MAP_AUTO)
        return o->map;
    return split && fabs(*low + *high) < 1e-9 * *high ? DEM_PICTURE_MAP_DIVERGING : DEM_PICTURE_MAP_RAMP;
}

static dem_status begin(model *m, const dem_clump *const *shapes, size_t shape_count, dem_error *error)
{
    DEM_TRY(check_options(m->options, error));
    m->up = v3_unit(m->options->up);
    DEM_TRY(make_room(m, shapes, shape_count, error));
    return find_values(m, error);
}

static dem_status measure(model *m, const layout *l, dem_picture_span *span, dem_error *error)
{
    const dem_picture_options *o = m->options;
    double low, high;
    if (!span->begun) {
        dem_camera camera =
            dem_camera_around(m->up, o->azimuth_deg, o->elevation_deg, o->parallel ? 0 : FIELD_DEG, MARGIN);
        *span =
            (dem_picture_span){.begun = true, .bodies = box_empty(), .low = INFINITY, .high = -INFINITY, .end = NAN};
        dem_fit_begin(&span->fit, &camera, l->width, l->height);
    }
    dem_box box = bodies_box(m);
    span->bodies = (dem_box){v3_min(span->bodies.low, box.low), v3_max(span->bodies.high, box.high)};
    if (m->field.values) {
        dem_field_range(m->field.values, o->hidden, m->view->count, &low, &high);
        span->low = fmin(span->low, low);
        span->high = fmax(span->high, high);
    }
    span->end = fmax(span->end, o->time);
    place_bodies(m);
    DEM_TRY(place_walls(m, span->bodies, error));
    include_depths(m, &span->low, &span->high);
    const dem_render_scene all = {
        m->shapes, m->shape_count + o->wall_count, m->bodies, m->body_count + o->wall_count, NULL, 0};
    dem_fit_add(&span->fit, &all);
    return DEM_OK;
}

dem_status dem_scene_picture_measure(const dem_body_view *bodies, const dem_clump *const *shapes, size_t shape_count,
                                     const dem_picture_options *options, dem_picture_span *span, dem_error *error)
{
    model m = {.options = options, .view = bodies};
    layout l = {0};
    dem_status status = begin(&m, shapes, shape_count, error);
    if (status == DEM_OK)
        status = lay_out(&m, &l, error);
    if (status == DEM_OK)
        status = measure(&m, &l, span, error);
    release_layout(&l);
    release(&m);
    return status;
}

// the bodies in the upper left part of the image, the rest in the colour of the background
static dem_status draw(const dem_ctx *ctx, model *m, const layout *l, const dem_picture_span *span, dem_image *image,
                       dem_view *view, dem_error *error)
{
    const dem_picture_options *o = m->options;
    const uint8_t *b = o->background;
    const dem_colour background = dem_colour_of_srgb(b[0], b[1], b[2]);
    dem_palette_make(dem_picture_range(o, span, &m->low, &m->high), &m->palette);
    clear_walls(m);
    place_bodies(m);
    DEM_TRY(place_walls(m, span->bodies, error));
    colour_walls(m);
    const dem_render_scene seen = {
        m->shapes, m->shape_count + o->wall_count, m->bodies, m->body_count + m->glass, &background, o->samples};
    *view = choose_view(m, span);
    DEM_TRY(dem_render(ctx, &seen, view, image, error));
    if (l->width == o->width && l->height == o->height)
        return DEM_OK;
    dem_image part = *image;
    dem_status status = dem_image_create(o->width, o->height, image, error);
    if (status == DEM_OK) {
        dem_image_fill(image, (dem_rgb){b[0], b[1], b[2]});
        dem_image_paste(image, &part, 0, 0);
    }
    dem_image_free(&part);
    return status == DEM_OK ? write_labels(m, l, view, span, image, error) : status;
}

dem_status dem_scene_picture_render(const dem_ctx *ctx, const dem_body_view *bodies, const dem_clump *const *shapes,
                                    size_t shape_count, const dem_picture_options *options,
                                    const dem_picture_span *span, dem_image *image, dem_view *view, dem_error *error)
{
    model m = {.options = options, .view = bodies};
    layout l = {0};
    dem_picture_span own = {0};
    dem_view how = {0};
    *image = (dem_image){0};
    dem_status status = begin(&m, shapes, shape_count, error);
    if (status == DEM_OK)
        status = lay_out(&m, &l, error);
    if (status == DEM_OK && !span)
        status = measure(&m, &l, &own, error);
    if (status == DEM_OK)
        status = draw(ctx, &m, &l, span ? span : &own, image, view ? view : &how, error);
    if (status != DEM_OK)
        dem_image_free(image);
    release_layout(&l);
    release(&m);
    return status;
}

dem_status dem_picture_bodies(const dem_ctx *ctx, const dem_body_view *bodies, const dem_clump *const *shapes,
                              size_t shape_count, const dem_picture_options *options, const char *path,
                              dem_error *error)
{
    dem_image image;
    DEM_TRY(dem_scene_picture_render(ctx, bodies, shapes, shape_count, options, NULL, &image, NULL, error));
    return dem_png_write(&image, path, error);
}
