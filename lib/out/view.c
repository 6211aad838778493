#include <stdlib.h>

#include "base/memory.h"
#include "math/quat.h"
#include "out/render.h"

enum { MANY_PARTS = 20000000 };

static dem_vec3 placed(const dem_render_body *body, dem_vec3 point)
{
    return v3_along(body->position, body->scale, quat_rotate(body->orientation, point));
}

typedef void visitor(void *user, dem_vec3 centre, double radius);

static size_t parts(const dem_render_shape *shape)
{
    return shape->mesh ? 3 * shape->mesh->triangle_count : shape->ball_count;
}

// a part of a shape as a ball: a corner of a triangle, or a ball
static dem_ball part(const dem_render_shape *shape, size_t k)
{
    return shape->mesh ? (dem_ball){shape->mesh->vertices[shape->mesh->triangles[k]], 0} : shape->balls[k];
}

static dem_ball bounding_ball(const dem_render_shape *shape)
{
    dem_box box = box_empty();
    for (size_t k = 0; k < parts(shape); k++)
        box = box_with(box, part(shape, k).centre);
    dem_ball ball = {v3_scale(v3_add(box.low, box.high), 0.5), 0};
    for (size_t k = 0; k < parts(shape); k++) {
        dem_ball b = part(shape, k);
        ball.radius = fmax(ball.radius, v3_distance(b.centre, ball.centre) + b.radius);
    }
    return ball;
}

// calls `visit` with balls that hold the scene between them: its parts or, where they are too many, whole bodies
static void visit_all(const dem_render_scene *scene, const dem_ball *bounds, visitor *visit, void *user)
{
    for (size_t i = 0; i < scene->body_count; i++) {
        const dem_render_body *body = &scene->bodies[i];
        const dem_render_shape *shape = &scene->shapes[body->shape];
        size_t count = parts(shape);
        for (size_t k = 0; k < (bounds && count ? 1 : count); k++) {
            dem_ball b = bounds ? bounds[body->shape] : part(shape, k);
            visit(user, placed(body, b.centre), b.radius * body->scale);
        }
    }
}

// of all shapes, where the scene has too many parts to visit each (or there is no memory: NULL)
static dem_ball *bound_shapes(const dem_render_scene *scene)
{
    size_t all = 0;
    for (size_t i = 0; i < scene->body_count; i++)
        all += parts(&scene->shapes[scene->bodies[i].shape]);
    dem_ball *bounds = all > MANY_PARTS ? dem_alloc(scene->shape_count, sizeof *bounds) : NULL;
    for (size_t i = 0; bounds && i < scene->shape_count; i++)
        bounds[i] = bounding_ball(&scene->shapes[i]);
    return bounds;
}

// extents along the axes of the view
typedef struct extent {
    dem_vec3 axes[4];  // right, up, forward, normal of the ground
    double low[4], high[4];
} extent;

static void widen(void *user, dem_vec3 centre, double radius)
{
    extent *e = user;
    for (int k = 0; k < 4; k++) {
        double at = v3_dot(centre, e->axes[k]);
        e->low[k] = fmin(e->low[k], at - radius);
        e->high[k] = fmax(e->high[k], at + radius);
    }
}

// the least distance of the eye for which everything is on the inner side of each side of the picture: a plane through
// the eye, whose slope from the line of sight is that of half the picture
typedef struct pyramid {
    const dem_view *view;
    double slope[2];    // to the right, up
    double need[2][2];  // at the positive and the negative side
} pyramid;

static void step_back(void *user, dem_vec3 centre, double radius)
{
    pyramid *p = user;
    dem_vec3 d = v3_sub(centre, p->view->centre);
    double depth = v3_dot(d, p->view->forward), at[2] = {v3_dot(d, p->view->right), v3_dot(d, p->view->up)};
    for (int k = 0; k < 2; k++) {
        double t = p->slope[k], far = radius * sqrt(1 + t * t) / t - depth;
        p->need[k][0] = fmax(p->need[k][0], at[k] / t + far);
        p->need[k][1] = fmax(p->need[k][1], -at[k] / t + far);
    }
}

// moves the eye back until all is in the picture, and sideways until the free room is the same on either side
static void place_eye(dem_view *view, const dem_render_scene *scene, const dem_ball *bounds, double angle,
                      double margins)
{
    double smaller = view->width < view->height ? view->width : view->height, sides[2] = {view->width, view->height};
    pyramid p = {.view = view, .need = {{-INFINITY, -INFINITY}, {-INFINITY, -INFINITY}}};
    for (int k = 0; k < 2; k++)
        p.slope[k] = tan(angle) * fmax(sides[k] - margins, 1) / smaller;
    visit_all(scene, bounds, step_back, &p);
    double distance = 0, shift[2] = {0};
    for (int k = 0; k < 2 && isfinite(p.need[k][0]); k++) {
        distance = fmax(distance, (p.need[k][0] + p.need[k][1]) / 2);
        shift[k] = (p.need[k][0] - p.need[k][1]) / 2 * p.slope[k];
    }
    view->distance = distance > 1e-6 * view->radius ? distance : view->radius / sin(angle);
    view->centre = v3_along(v3_along(view->centre, shift[0], view->right), shift[1], view->up);
    view->radius += hypot(shift[0], shift[1]);
    view->pixel = 2 * tan(angle) * view->distance / smaller;
}

dem_view dem_view_fit(const dem_render_scene *scene, const dem_camera *camera, int width, int height)
{
    dem_view view = {
        .forward = v3_unit(camera->forward), .ground_up = v3_unit(camera->up), .width = width, .height = height};
    view.right = v3_unit(v3_cross(view.forward, view.ground_up));
    view.up = v3_cross(view.right, view.forward);
    extent e = {.axes = {view.right, view.up, view.forward, view.ground_up}};
    for (int k = 0; k < 4; k++)
        e.low[k] = INFINITY, e.high[k] = -INFINITY;
    dem_ball *bounds = bound_shapes(scene);
    visit_all(scene, bounds, widen, &e);
    if (!(e.high[0] >= e.low[0]))
        for (int k = 0; k < 4; k++)
            e.low[k] = -1, e.high[k] = 1;  // nothing there: a picture of nothing
    double half[3];
    for (int k = 0; k < 3; k++) {
        view.centre = v3_along(view.centre, (e.low[k] + e.high[k]) / 2, e.axes[k]);
        half[k] = (e.high[k] - e.low[k]) / 2;
    }
    view.ground = e.low[3];
    view.radius = sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    if (!(view.radius > 0))
        view.radius = 1;
    double smaller = width < height ? width : height, margins = 2 * camera->margin * smaller;
    view.pixel = fmax(2 * half[0] / fmax(width - margins, 1), 2 * half[1] / fmax(height - margins, 1));
    if (camera->field_deg > 0)
        place_eye(&view, scene, bounds, camera->field_deg * DEM_PI / 360, margins);
    else if (!(view.pixel > 0))
        view.pixel = 2 * view.radius / smaller;
    free(bounds);
    return view;
}

void dem_view_project(const dem_view *view, dem_vec3 point, double *x, double *y)
{
    dem_vec3 d = v3_sub(point, view->centre);
    double closer = view->distance > 0 ? view->distance / (view->distance + v3_dot(d, view->forward)) : 1;
    *x = view->width / 2.0 + closer * v3_dot(d, view->right) / view->pixel;
    *y = view->height / 2.0 - closer * v3_dot(d, view->up) / view->pixel;
}
