#include "math/quat.h"
#include "out/render.h"

static dem_vec3 placed(const dem_render_body *body, dem_vec3 point)
{
    return v3_along(body->position, body->scale, quat_rotate(body->orientation, point));
}

// calls `visit` with balls that hold the scene between them: corners of triangles and the balls themselves
static void visit_all(const dem_render_scene *scene, void (*visit)(void *user, dem_vec3 centre, double radius),
                      void *user)
{
    for (size_t i = 0; i < scene->body_count; i++) {
        const dem_render_body *body = &scene->bodies[i];
        const dem_render_shape *shape = &scene->shapes[body->shape];
        for (size_t k = 0; shape->mesh && k < 3 * shape->mesh->triangle_count; k++)
            visit(user, placed(body, shape->mesh->vertices[shape->mesh->triangles[k]]), 0);
        for (size_t k = 0; !shape->mesh && k < shape->ball_count; k++)
            visit(user, placed(body, shape->balls[k].centre), shape->balls[k].radius * body->scale);
    }
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

dem_view dem_view_fit(const dem_render_scene *scene, const dem_camera *camera, int width, int height)
{
    dem_view view = {
        .forward = v3_unit(camera->forward), .ground_up = v3_unit(camera->up), .width = width, .height = height};
    view.right = v3_unit(v3_cross(view.forward, view.ground_up));
    view.up = v3_cross(view.right, view.forward);
    extent e = {.axes = {view.right, view.up, view.forward, view.ground_up}};
    for (int k = 0; k < 4; k++)
        e.low[k] = INFINITY, e.high[k] = -INFINITY;
    visit_all(scene, widen, &e);
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
    double smaller = width < height ? width : height, free = 2 * camera->margin * smaller;
    view.pixel = fmax(2 * half[0] / fmax(width - free, 1), 2 * half[1] / fmax(height - free, 1));
    if (camera->field_deg > 0) {
        // the ball that holds everything touches the cone of view
        double angle = camera->field_deg * DEM_PI / 360;
        view.distance = view.radius / sin(angle) * (1 + camera->margin);
        view.pixel = 2 * tan(angle) * view.distance / smaller;
    } else if (!(view.pixel > 0))
        view.pixel = 2 * view.radius / smaller;
    return view;
}

void dem_view_project(const dem_view *view, dem_vec3 point, double *x, double *y)
{
    dem_vec3 d = v3_sub(point, view->centre);
    double closer = view->distance > 0 ? view->distance / (view->distance + v3_dot(d, view->forward)) : 1;
    *x = view->width / 2.0 + closer * v3_dot(d, view->right) / view->pixel;
    *y = view->height / 2.0 - closer * v3_dot(d, view->up) / view->pixel;
}
