#include <stdlib.h>

#include "base/memory.h"
#include "math/quat.h"
#include "out/render.h"

enum { MANY_PARTS = 20000000 };

dem_camera dem_camera_around(dem_vec3 up, double azimuth_deg, double elevation_deg, double field_deg, double margin)
{
    double azimuth = azimuth_deg * DEM_PI / 180, elevation = elevation_deg * DEM_PI / 180;
    dem_vec3 right = v3_normal_to(up), ahead = v3_cross(up, right);
    dem_vec3 level = v3_along(v3_scale(right, cos(azimuth)), sin(azimuth), ahead);
    dem_vec3 eye = v3_along(v3_scale(level, cos(elevation)), sin(elevation), up);
    return (dem_camera){.forward = v3_scale(eye, -1), .up = up, .field_deg = field_deg, .margin = margin};
}

static dem_vec3 placed(const dem_render_body *body, dem_vec3 point)
{
    return v3_along(body->position, body->scale, quat_rotate(body->orientation, point));
}

typedef void visitor(void *user, dem_vec3 centre, double radius);

static size_t parts(const dem_render_shape *shape)
{
    return shape->mesh ? shape->mesh->vertex_count : shape->ball_count;
}

// a part of a shape as a ball: a vertex, or a ball
static dem_ball part(const dem_render_shape *shape, size_t k)
{
    return shape->mesh ? (dem_ball){shape->mesh->vertices[k], 0} : shape->balls[k];
}

// what holds a shape; NULL: there was no memory, and all its parts do
typedef struct hold {
    dem_ball *balls;
    size_t count;
} hold;

// all parts but the vertices that no triangle uses
static hold hold_shape(const dem_render_shape *shape)
{
    size_t count = parts(shape);
    hold h = {.balls = dem_alloc(count, sizeof *h.balls)};
    unsigned char *used = dem_alloc_zero(count, 1);
    for (size_t t = 0; used && shape->mesh && t < 3 * shape->mesh->triangle_count; t++)
        used[shape->mesh->triangles[t]] = 1;
    for (size_t k = 0; h.balls && k < count; k++)
        if (!shape->mesh || !used || used[k])
            h.balls[h.count++] = part(shape, k);
    free(used);
    return h;
}

// one ball instead of many
static void bound(hold *h)
{
    dem_box box = box_empty();
    for (size_t k = 0; k < h->count; k++)
        box = box_with(box, h->balls[k].centre);
    dem_ball ball = {v3_scale(v3_add(box.low, box.high), 0.5), 0};
    for (size_t k = 0; k < h->count; k++)
        ball.radius = fmax(ball.radius, v3_distance(h->balls[k].centre, ball.centre) + h->balls[k].radius);
    h->count = h->count > 0;
    if (h->count)
        h->balls[0] = ball;
}

// calls `visit` with balls that hold the scene between them: its parts or, where they are too many, whole bodies
static void visit_all(const dem_render_scene *scene, visitor *visit, void *user)
{
    size_t all = 0;
    hold *holds = dem_alloc_zero(scene->shape_count, sizeof *holds);
    for (size_t i = 0; i < scene->body_count; i++)
        all += parts(&scene->shapes[scene->bodies[i].shape]);
    for (size_t i = 0; holds && i < scene->shape_count; i++) {
        holds[i] = hold_shape(&scene->shapes[i]);
        if (all > MANY_PARTS && holds[i].balls)
            bound(&holds[i]);
    }
    for (size_t i = 0; i < scene->body_count; i++) {
        const dem_render_body *body = &scene->bodies[i];
        const dem_render_shape *shape = &scene->shapes[body->shape];
        const hold *h = holds && holds[body->shape].balls ? &holds[body->shape] : NULL;
        for (size_t k = 0; k < (h ? h->count : parts(shape)); k++) {
            dem_ball b = h ? h->balls[k] : part(shape, k);
            visit(user, placed(body, b.centre), b.radius * body->scale);
        }
    }
    for (size_t i = 0; holds && i < scene->shape_count; i++)
        free(holds[i].balls);
    free(holds);
}

// The extents along the axes of the view, and how far the eye must step back so that everything is on the inner side of
// each side of the picture: a plane through the eye, whose slope from the line of sight is that of half the picture.
// All are the largest of linear functions of the places, so each point is looked at once.
static void widen(void *user, dem_vec3 centre, double radius)
{
    dem_fit *f = user;
    if (!f->begun) {
        f->origin = centre;
        f->begun = true;
    }
    dem_vec3 d = v3_sub(centre, f->origin);
    double at[4] = {v3_dot(d, f->view.right), v3_dot(d, f->view.up), v3_dot(d, f->view.forward),
                    v3_dot(d, f->view.ground_up)};
    for (int k = 0; k < 4; k++) {
        f->low[k] = fmin(f->low[k], at[k] - radius);
        f->high[k] = fmax(f->high[k], at[k] + radius);
    }
    for (int k = 0; k < 2 && f->camera.field_deg > 0; k++) {
        double t = f->slope[k], far = radius * sqrt(1 + t * t) / t - at[2];
        f->need[k][0] = fmax(f->need[k][0], at[k] / t + far);
        f->need[k][1] = fmax(f->need[k][1], -at[k] / t + far);
    }
}

static double smaller_side(const dem_view *view)
{
    return view->width < view->height ? view->width : view->height;
}

static double margins(const dem_fit *f)
{
    return 2 * f->camera.margin * smaller_side(&f->view);
}

void dem_fit_begin(dem_fit *f, const dem_camera *camera, int width, int height)
{
    *f = (dem_fit){.camera = *camera, .need = {{-INFINITY, -INFINITY}, {-INFINITY, -INFINITY}}};
    dem_view *v = &f->view;
    *v = (dem_view){
        .forward = v3_unit(camera->forward), .ground_up = v3_unit(camera->up), .width = width, .height = height};
    v->right = v3_unit(v3_cross(v->forward, v->ground_up));
    v->up = v3_cross(v->right, v->forward);
    double sides[2] = {width, height}, angle = camera->field_deg * DEM_PI / 360;
    for (int k = 0; k < 4; k++)
        f->low[k] = INFINITY, f->high[k] = -INFINITY;
    for (int k = 0; k < 2; k++)
        f->slope[k] = tan(angle) * fmax(sides[k] - margins(f), 1) / smaller_side(v);
}

void dem_fit_add(dem_fit *f, const dem_render_scene *scene)
{
    visit_all(scene, widen, f);
}

// moves the eye back until all is in the picture, and sideways until the free room is the same on either side
static void place_eye(const dem_fit *f, const double middle[3], dem_view *view)
{
    double distance = 0, shift[2] = {0}, angle = f->camera.field_deg * DEM_PI / 360;
    for (int k = 0; k < 2 && isfinite(f->need[k][0]); k++) {
        // as seen from the middle
        double one = f->need[k][0] - middle[k] / f->slope[k] + middle[2];
        double other = f->need[k][1] + middle[k] / f->slope[k] + middle[2];
        distance = fmax(distance, (one + other) / 2);
        shift[k] = (one - other) / 2 * f->slope[k];
    }
    view->distance = distance > 1e-6 * view->radius ? distance : view->radius / sin(angle);
    view->centre = v3_along(v3_along(view->centre, shift[0], view->right), shift[1], view->up);
    view->radius += hypot(shift[0], shift[1]);
    view->pixel = 2 * tan(angle) * view->distance / smaller_side(view);
}

dem_view dem_fit_end(const dem_fit *f)
{
    dem_view view = f->view;
    const dem_vec3 axes[3] = {view.right, view.up, view.forward};
    double half[3], middle[3], ground = f->low[3];
    view.centre = f->origin;
    for (int k = 0; k < 3; k++) {
        bool any = f->high[k] >= f->low[k];  // nothing there: a picture of nothing
        middle[k] = any ? (f->low[k] + f->high[k]) / 2 : 0;
        half[k] = any ? (f->high[k] - f->low[k]) / 2 : 1;
        view.centre = v3_along(view.centre, middle[k], axes[k]);
    }
    view.ground = isfinite(ground) ? ground + v3_dot(f->origin, view.ground_up) : -1;
    view.radius = sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    if (!(view.radius > 0))
        view.radius = 1;
    view.pixel = fmax(2 * half[0] / fmax(view.width - margins(f), 1), 2 * half[1] / fmax(view.height - margins(f), 1));
    if (f->camera.field_deg > 0)
        place_eye(f, middle, &view);
    else if (!(view.pixel > 0))
        view.pixel = 2 * view.radius / smaller_side(&view);
    return view;
}

dem_view dem_view_fit(const dem_render_scene *scene, const dem_camera *camera, int width, int height)
{
    dem_fit fit;
    dem_fit_begin(&fit, camera, width, height);
    dem_fit_add(&fit, scene);
    return dem_fit_end(&fit);
}

void dem_view_project(const dem_view *view, dem_vec3 point, double *x, double *y)
{
    dem_vec3 d = v3_sub(point, view->centre);
    double closer = view->distance > 0 ? view->distance / (view->distance + v3_dot(d, view->forward)) : 1;
    *x = view->width / 2.0 + closer * v3_dot(d, view->right) / view->pixel;
    *y = view->height / 2.0 - closer * v3_dot(d, view->up) / view->pixel;
}
