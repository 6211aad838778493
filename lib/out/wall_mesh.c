#include "out/wall_mesh.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/quat.h"
#include "sim/surface.h"
#include "sim/wall_motion.h"

enum {
    CORNERS = 10,   // of a square cut by six planes
    SEGMENTS = 64,  // of a cylinder
};

static const double MARGIN = 0.05;     // about what is in the box, over its diagonal
static const double TOLERANCE = 1e-9;  // a plane on the side of the box is in it, over its diagonal

bool dem_wall_moves(const dem_wall_def *wall)
{
    return dem_wall_def_moves(wall);
}

static dem_vec3 placed(const dem_wall_view *pose, dem_vec3 x)
{
    return pose ? v3_add(pose->position, quat_rotate(pose->orientation, x)) : x;
}

static dem_vec3 turned(const dem_wall_view *pose, dem_vec3 v)
{
    return pose ? quat_rotate(pose->orientation, v) : v;
}

// ---- where they are cut

// a circle about an axis
static dem_box with_circle(dem_box box, dem_vec3 centre, dem_vec3 axis, double radius)
{
    for (int k = 0; k < 3; k++) {
        double a = v3_get(axis, k), reach = radius * sqrt(fmax(0, 1 - a * a));
        v3_set(&box.low, k, fmin(v3_get(box.low, k), v3_get(centre, k) - reach));
        v3_set(&box.high, k, fmax(v3_get(box.high, k), v3_get(centre, k) + reach));
    }
    return box;
}

static dem_box with_surface(dem_box box, const dem_surface *s, const dem_wall_view *pose)
{
    dem_vec3 point = placed(pose, s->point), axis = turned(pose, s->axis);
    if (s->kind == DEM_SURFACE_SPHERE) {
        dem_vec3 reach = v3(s->begin, s->begin, s->begin);
        return box_with(box_with(box, v3_sub(point, reach)), v3_add(point, reach));
    }
    if (s->kind == DEM_SURFACE_RECTANGLE) {
        dem_vec3 u = v3_scale(turned(pose, s->along), s->half[0]);
        dem_vec3 v = v3_scale(v3_cross(axis, turned(pose, s->along)), s->half[1]);
        for (int k = 0; k < 4; k++)
            box = box_with(box, v3_along(v3_along(point, k & 1 ? 1 : -1, u), k & 2 ? 1 : -1, v));
        return box;
    }
    box = with_circle(box, point, axis, s->begin);
    return s->endless ? box : with_circle(box, v3_along(point, s->run[1], axis), axis, s->begin + s->run[0]);
}

static dem_box with_wall(dem_box box, const dem_wall_def *wall, const dem_wall_view *pose)
{
    if (wall->kind == DEM_WALL_MESH) {
        for (size_t i = 0; i < wall->mesh.vertex_count; i++)
            box = box_with(box, placed(pose, wall->mesh.vertices[i]));
        return box;
    }
    dem_vec3 point = placed(pose, wall->point);
    box = box_with(box, point);
    dem_surface surface = dem_surface_of(wall);
    if (surface.kind != DEM_SURFACE_NONE)
        return with_surface(box, &surface, pose);
    if (wall->kind == DEM_WALL_CYLINDER) {
        dem_vec3 a = turned(pose, wall->normal);
        dem_vec3 reach = v3_scale(
            v3(sqrt(fmax(0, 1 - a.x * a.x)), sqrt(fmax(0, 1 - a.y * a.y)), sqrt(fmax(0, 1 - a.z * a.z))), wall->radius);
        box = box_with(box_with(box, v3_sub(point, reach)), v3_add(point, reach));
    }
    return box;
}

// bodies are on one side of a plane; where it stands across an axis, nothing beyond it needs to be shown
static dem_box cut_by_plane(dem_box box, dem_vec3 point, dem_vec3 normal)
{
    for (int k = 0; k < 3; k++) {
        double n = v3_get(normal, k), at = v3_get(point, k), low = v3_get(box.low, k), high = v3_get(box.high, k);
        if (n > 1 - TOLERANCE && at < high)
            v3_set(&box.low, k, fmax(low, at));
        if (n < TOLERANCE - 1 && at > low)
            v3_set(&box.high, k, fmin(high, at));
    }
    return box;
}

dem_box dem_walls_box(const dem_domain_def *domain, dem_box bodies, const dem_wall_def *walls,
                      const dem_wall_view *poses, size_t count)
{
    dem_box box = bodies;
    for (size_t i = 0; i < count; i++)
        box = with_wall(box, &walls[i], poses ? &poses[i] : NULL);
    if (!(box.low.x <= box.high.x))
        box = (dem_box){v3(0, 0, 0), v3(0, 0, 0)};
    double margin = MARGIN * box_diagonal(box);
    margin = margin > 0 ? margin : 1;  // nothing but a point: any size will do
    for (int k = 0; k < 3; k++) {
        double low = v3_get(domain->low, k), high = v3_get(domain->high, k);
        v3_set(&box.low, k, isfinite(low) ? low : v3_get(box.low, k) - margin);
        v3_set(&box.high, k, isfinite(high) ? high : v3_get(box.high, k) + margin);
    }
    for (size_t i = 0; i < count; i++) {
        const dem_wall_view *pose = poses ? &poses[i] : NULL;
        if (walls[i].kind == DEM_WALL_PLANE)
            box = cut_by_plane(box, placed(pose, walls[i].point), v3_unit(turned(pose, walls[i].normal)));
    }
    return box;
}

// ---- their triangles

static dem_status make_room(dem_mesh *mesh, size_t vertices, size_t triangles, dem_error *error)
{
    *mesh = (dem_mesh){.vertices = dem_alloc(vertices, sizeof *mesh->vertices),
                       .triangles = dem_alloc(3 * triangles, sizeof *mesh->triangles)};
    if (mesh->vertices && mesh->triangles)
        return DEM_OK;
    dem_mesh_free(mesh);
    return dem_fail_memory(error);
}

static void put_triangle(dem_mesh *mesh, size_t a, size_t b, size_t c)
{
    uint32_t *t = &mesh->triangles[3 * mesh->triangle_count++];
    t[0] = (uint32_t)a, t[1] = (uint32_t)b, t[2] = (uint32_t)c;
}

// keeps what has side * x[axis] <= limit of a convex polygon; returns the corners left
static size_t cut(dem_vec3 *polygon, size_t corners, int axis, double side, double limit)
{
    dem_vec3 rest[CORNERS];
    size_t left = 0;
    for (size_t i = 0; i < corners; i++) {
        dem_vec3 a = polygon[i], b = polygon[(i + 1) % corners];
        double over_a = side * v3_get(a, axis) - limit, over_b = side * v3_get(b, axis) - limit;
        if (over_a <= 0)
            rest[left++] = a;
        if ((over_a <= 0) != (over_b <= 0))
            rest[left++] = v3_along(a, over_a / (over_a - over_b), v3_sub(b, a));
    }
    memcpy(polygon, rest, left * sizeof *rest);
    return left;
}

static dem_status plane_mesh(dem_vec3 point, dem_vec3 normal, dem_box box, dem_mesh *mesh, dem_error *error)
{
    DEM_TRY(make_room(mesh, CORNERS, CORNERS, error));
    double size = box_diagonal(box), spare = TOLERANCE * size;
    dem_vec3 middle = v3_scale(v3_add(box.low, box.high), 0.5);
    middle = v3_along(middle, v3_dot(v3_sub(point, middle), normal), normal);
    dem_vec3 u = v3_scale(v3_normal_to(normal), size), v = v3_cross(normal, u), *corners = mesh->vertices;
    for (int k = 0; k < 4; k++)
        corners[k] = v3_along(v3_along(middle, k == 0 || k == 3 ? -1 : 1, u), k < 2 ? -1 : 1, v);
    size_t count = 4;
    for (int axis = 0; axis < 3; axis++) {
        count = cut(corners, count, axis, 1, v3_get(box.high, axis) + spare);
        count = cut(corners, count, axis, -1, spare - v3_get(box.low, axis));
    }
    mesh->vertex_count = count > 2 ? count : 0;
    for (size_t k = 2; k < count; k++)
        put_triangle(mesh, 0, k - 1, k);
    return DEM_OK;
}

static dem_status rectangle_mesh(const dem_surface *s, dem_mesh *mesh, dem_error *error)
{
    DEM_TRY(make_room(mesh, 4, 2, error));
    dem_vec3 u = v3_scale(s->along, s->half[0]), v = v3_scale(v3_cross(s->axis, s->along), s->half[1]);
    for (int k = 0; k < 4; k++)
        mesh->vertices[mesh->vertex_count++] =
            v3_along(v3_along(s->point, k == 0 || k == 3 ? -1 : 1, u), k < 2 ? -1 : 1, v);
    put_triangle(mesh, 0, 1, 2);
    put_triangle(mesh, 0, 2, 3);
    return DEM_OK;
}

// between two circles, facing away from the axis, or along it where they are flat
static dem_status ring_mesh(const dem_surface *s, const double radii[2], const double heights[2], dem_mesh *mesh,
                            dem_error *error)
{
    DEM_TRY(make_room(mesh, 2 * SEGMENTS, 2 * SEGMENTS, error));
    dem_vec3 u = v3_normal_to(s->axis), v = v3_cross(s->axis, u);
    for (int i = 0; i < SEGMENTS; i++) {
        double angle = 2 * DEM_PI * i / SEGMENTS;
        dem_vec3 out = v3_along(v3_scale(u, cos(angle)), sin(angle), v);
        for (int end = 0; end < 2; end++)
            mesh->vertices[mesh->vertex_count++] =
                v3_along(v3_along(s->point, heights[end], s->axis), radii[end], out);
    }
    for (size_t i = 0; i < SEGMENTS; i++) {
        size_t low = 2 * i, next = 2 * ((i + 1) % SEGMENTS), turn = s->side > 0;
        if (radii[1] > 0)
            put_triangle(mesh, low, turn ? low + 1 : next + 1, turn ? next + 1 : low + 1);
        if (radii[0] > 0)
            put_triangle(mesh, low, turn ? next + 1 : next, turn ? next : next + 1);
    }
    return DEM_OK;
}

// as far along an axis as the box goes
static double end_of_box(const dem_surface *s, dem_box box)
{
    double end = 0;
    for (int k = 0; k < 8; k++)
        end = fmax(end, v3_dot(v3_sub(v3(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
                                         k & 4 ? box.high.z : box.low.z),
                                      s->point),
                               s->axis));
    return end;
}

// by meridians; the circles at the poles are points
static dem_status ball_mesh(const dem_surface *s, dem_mesh *mesh, dem_error *error)
{
    enum { CIRCLES = SEGMENTS / 2 };
    DEM_TRY(make_room(mesh, SEGMENTS * (CIRCLES + 1), 2 * SEGMENTS * CIRCLES, error));
    for (int j = 0; j <= CIRCLES; j++)
        for (int i = 0; i < SEGMENTS; i++) {
            double tilt = DEM_PI * j / CIRCLES, angle = 2 * DEM_PI * i / SEGMENTS, r = s->begin * sin(tilt);
            dem_vec3 out = v3(r * cos(angle), r * sin(angle), s->begin * cos(tilt));
            mesh->vertices[mesh->vertex_count++] = v3_add(s->point, out);
        }
    for (size_t j = 0; j < CIRCLES; j++)
        for (size_t i = 0; i < SEGMENTS; i++) {
            size_t a = j * SEGMENTS + i, b = j * SEGMENTS + (i + 1) % SEGMENTS, turn = s->side > 0;
            if (j > 0)
                put_triangle(mesh, a, turn ? b : b + SEGMENTS, turn ? b + SEGMENTS : b);
            if (j + 1 < CIRCLES)
                put_triangle(mesh, a, turn ? b + SEGMENTS : a + SEGMENTS, turn ? a + SEGMENTS : b + SEGMENTS);
        }
    return DEM_OK;
}

static dem_status surface_mesh(const dem_surface *at_start, const dem_wall_view *pose, dem_box box, dem_mesh *mesh,
                               dem_error *error)
{
    dem_surface s = *at_start;
    s.point = placed(pose, s.point);
    s.axis = turned(pose, s.axis);
    s.along = turned(pose, s.along);
    if (s.kind == DEM_SURFACE_SPHERE)
        return ball_mesh(&s, mesh, error);
    if (s.kind == DEM_SURFACE_RECTANGLE)
        return rectangle_mesh(&s, mesh, error);
    double length = s.endless ? end_of_box(&s, box) : s.run[1], reach = s.endless ? length / s.run[1] : 1;
    return ring_mesh(&s, (double[]){s.begin, s.begin + reach * s.run[0]}, (double[]){0, length}, mesh, error);
}

static dem_status cylinder_mesh(const dem_wall_def *wall, dem_vec3 point, dem_vec3 axis, dem_box box, dem_mesh *mesh,
                                dem_error *error)
{
    DEM_TRY(make_room(mesh, 2 * SEGMENTS, 2 * SEGMENTS, error));
    double ends[2] = {INFINITY, -INFINITY};
    for (int k = 0; k < 8; k++) {
        dem_vec3 corner =
            v3(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y, k & 4 ? box.high.z : box.low.z);
        double along = v3_dot(v3_sub(corner, point), axis);
        ends[0] = fmin(ends[0], along);
        ends[1] = fmax(ends[1], along);
    }
    dem_vec3 u = v3_normal_to(axis), v = v3_cross(axis, u);
    for (int i = 0; i < SEGMENTS; i++) {
        double angle = 2 * DEM_PI * i / SEGMENTS, x = wall->radius * cos(angle), y = wall->radius * sin(angle);
        dem_vec3 rim = v3_along(v3_along(point, x, u), y, v);
        for (int end = 0; end < 2; end++)
            mesh->vertices[mesh->vertex_count++] = v3_along(rim, ends[end], axis);
    }
    for (size_t i = 0; i < SEGMENTS; i++) {
        size_t low = 2 * i, next = 2 * ((i + 1) % SEGMENTS), turn = wall->outside ? 1 : 0;
        put_triangle(mesh, low, turn ? next : next + 1, turn ? next + 1 : next);
        put_triangle(mesh, low, turn ? next + 1 : low + 1, turn ? low + 1 : next + 1);
    }
    return DEM_OK;
}

dem_status dem_wall_mesh(const dem_wall_def *wall, const dem_wall_view *pose, dem_box box, dem_mesh *mesh,
                         dem_error *error)
{
    if (wall->kind == DEM_WALL_MESH) {
        DEM_TRY(dem_mesh_copy(&wall->mesh, mesh, error));
        for (size_t i = 0; i < mesh->vertex_count; i++)
            mesh->vertices[i] = placed(pose, mesh->vertices[i]);
        return DEM_OK;
    }
    dem_surface surface = dem_surface_of(wall);
    if (surface.kind != DEM_SURFACE_NONE)
        return surface_mesh(&surface, pose, box, mesh, error);
    dem_vec3 point = placed(pose, wall->point), normal = v3_unit(turned(pose, wall->normal));
    if (wall->kind == DEM_WALL_PLANE)
        return plane_mesh(point, normal, box, mesh, error);
    return cylinder_mesh(wall, point, normal, box, mesh, error);
}

// ---- what is worn off

static double area_of(const dem_mesh *mesh, size_t triangle)
{
    const uint32_t *t = &mesh->triangles[3 * triangle];
    const dem_vec3 *v = mesh->vertices;
    return v3_norm(v3_cross(v3_sub(v[t[1]], v[t[0]]), v3_sub(v[t[2]], v[t[0]]))) / 2;
}

void dem_wall_worn(const dem_mesh *mesh, const dem_wall_view *view, double *volume, double *depth)
{
    double whole = 0;
    for (size_t t = 0; view && view->wear && t < mesh->triangle_count; t++)
        whole += area_of(mesh, t);
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        double area = area_of(mesh, t), worn = 0;
        if (whole > 0)
            worn = view->wear_count == mesh->triangle_count ? view->wear[t] : view->worn * area / whole;
        if (volume)
            volume[t] = worn;
        if (depth)
            depth[t] = area > 0 ? worn / area : 0;
    }
}
