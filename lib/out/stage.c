#include "out/stage.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "math/quat.h"
#include "out/creases.h"
#include "out/smooth.h"

enum {
    GROUND_FEW_SKY = 24,         // rays to the sky from a point of the ground; if one is stopped,
    GROUND_SKY = 96,             // so many
    GROUND_FEW_SUN = 16,         // to the sun; if some are stopped and some are not,
    GROUND_SUN = 48,             // so many
    SMOOTH_TRIANGLES = 1 << 20,  // more than pixels: nobody sees their facets
    LAYERS = 12,                 // of clear bodies that are looked through
};
static const uint32_t UNUSED = UINT32_MAX;

_Static_assert(GROUND_SKY <= STAGE_SUBSETS * STAGE_SKY_RAYS && GROUND_SUN <= STAGE_SUBSETS * STAGE_SUN_RAYS,
               "the ground takes its rays from the set of the bodies");

static const double SUN = 0.75, SKY = 0.50;  // light of the sun straight on, and of the whole sky
static const double SUN_SIZE = 0.22;         // radius of the sun's disk at unit distance
static const double SHADOW = 0.62;           // how dark the ground may become
static const double GROUND_REACH = 0.4;      // how far bodies darken the ground
static const double FADE = 0.14;             // edge of the picture without shadows, over its smaller side
static const double BEHIND = 0.12;           // brightness of what hides the sky, over that of the sky
static const double FRONT = 0.22;            // light held back by what is seen from its outside, over that from inside
static const double LINE = 0.9;              // half the breadth of a crease [pixels]
static const double LINE_HELD = 0.75;        // light that a crease holds back
static const double LINE_SHADE = 0.25;       // brightness of a crease, over that of its body
static const double MOST_PATH = 4;           // through a clear body, over its thickness
static const double NEAR = 2e-4;             // rays start so far off the surface, not to meet it

// ---- setting up

void dem_even_point(size_t index, double *u, double *v)
{
    double whole;
    *u = modf(0.5 + 0.7548776662466927 * (double)(index + 1), &whole);
    *v = modf(0.5 + 0.5698402909980532 * (double)(index + 1), &whole);
}

// even points of the unit disk
static dem_vec3 disk_point(size_t index)
{
    double u, v;
    dem_even_point(index, &u, &v);
    return v3(sqrt(u) * cos(2 * DEM_PI * v), sqrt(u) * sin(2 * DEM_PI * v), 0);
}

static void deal_lights(stage_lights *lights)
{
    for (size_t i = 0; i < STAGE_SUBSETS * STAGE_SKY_RAYS; i++) {
        dem_vec3 d = disk_point(i);  // lifted onto the half sphere, it is cosine-weighted (Malley)
        lights->sky[i] = v3(d.x, d.y, sqrt(fmax(0, 1 - v3_norm2(d))));
    }
    for (size_t i = 0; i < STAGE_SUBSETS * STAGE_SUN_RAYS; i++)
        lights->sun[i] = disk_point(i);
}

static void choose_frame(const dem_render_shape *shape, stage_shape *frame)
{
    dem_box box = box_empty();
    for (size_t i = 0; shape->mesh && i < 3 * shape->mesh->triangle_count; i++)
        box = box_with(box, shape->mesh->vertices[shape->mesh->triangles[i]]);
    for (size_t i = 0; !shape->mesh && i < shape->ball_count; i++) {
        double r = shape->balls[i].radius;
        box = box_with(box, v3_sub(shape->balls[i].centre, v3(r, r, r)));
        box = box_with(box, v3_add(shape->balls[i].centre, v3(r, r, r)));
    }
    frame->size = box_diagonal(box) / 2;
    frame->origin = v3_scale(v3_add(box.low, box.high), 0.5);
    if (!(frame->size > 0 && isfinite(frame->size)))  // nothing, or a point
        *frame = (stage_shape){.size = 1};
}

static dem_status add_mesh(dem_ray_scene *rays, const dem_mesh *mesh, const stage_shape *frame, dem_error *error)
{
    return dem_ray_add_mesh(rays, mesh->vertices, mesh->vertex_count, mesh->triangles, mesh->triangle_count,
                            frame->origin, 1 / frame->size, error);
}

static dem_status add_solid(dem_stage *s, size_t i, uint32_t *count, dem_error *error)
{
    const dem_render_shape *shape = &s->scene->shapes[i];
    stage_shape *frame = &s->shapes[i];
    frame->solid = (*count)++;
    if (!shape->mesh)
        return dem_ray_add_balls(s->rays, shape->balls, shape->ball_count, frame->origin, 1 / frame->size, error);
    if (shape->mesh->triangle_count <= SMOOTH_TRIANGLES && !(frame->normals = dem_mesh_corner_normals(shape->mesh)))
        return dem_fail_memory(error);
    return add_mesh(s->rays, shape->mesh, frame, error);
}

static dem_status add_clear(dem_stage *s, size_t i, uint32_t *count, dem_error *error)
{
    stage_shape *frame = &s->shapes[i];
    if (!s->panes)
        DEM_TRY(dem_ray_create(&s->panes, error));
    frame->clear = (*count)++;
    frame->creases = dem_mesh_creases(s->scene->shapes[i].mesh);
    return frame->creases ? add_mesh(s->panes, s->scene->shapes[i].mesh, frame, error) : dem_fail_memory(error);
}

// a shape is added to the rays that its bodies are of
static dem_status add_shapes(dem_stage *s, dem_error *error)
{
    const dem_render_scene *scene = s->scene;
    uint32_t solids = 0, clears = 0;
    for (size_t i = 0; i < scene->shape_count; i++) {
        choose_frame(&scene->shapes[i], &s->shapes[i]);
        s->shapes[i].solid = s->shapes[i].clear = UNUSED;
    }
    for (size_t i = 0; i < scene->body_count; i++) {
        size_t shape = scene->bodies[i].shape;
        bool clear = scene->bodies[i].clear > 0;
        if (clear && s->shapes[shape].clear == UNUSED)
            DEM_TRY(add_clear(s, shape, &clears, error));
        if (!clear && s->shapes[shape].solid == UNUSED)
            DEM_TRY(add_solid(s, shape, &solids, error));
    }
    return DEM_OK;
}

static dem_vec3 to_stage(const dem_stage *s, const dem_render_body *body, dem_vec3 x)
{
    dem_vec3 base = v3_sub(body->position, s->view->centre);
    return v3_scale(v3_along(base, body->scale, quat_rotate(body->orientation, x)), 1 / s->view->radius);
}

static dem_ray_pose pose_of(const dem_stage *s, const dem_render_body *body)
{
    const stage_shape *frame = &s->shapes[body->shape];
    dem_ray_pose pose;
    dem_vec3 at = to_stage(s, body, frame->origin);
    for (int k = 0; k < 3; k++) {
        dem_vec3 axis = quat_rotate(body->orientation, v3(k == 0, k == 1, k == 2));
        axis = v3_scale(axis, body->scale * frame->size / s->view->radius);
        for (int c = 0; c < 3; c++)
            pose.axes[k][c] = (float)v3_get(axis, c);
        pose.position[k] = (float)v3_get(at, k);
    }
    return pose;
}

static dem_status add_bodies(dem_stage *s, dem_error *error)
{
    size_t count = s->scene->body_count;
    uint32_t solids = 0, clears = 0;
    s->solid = dem_alloc(count, sizeof *s->solid);
    s->clear = dem_alloc(s->panes ? count : 0, sizeof *s->clear);
    if (!s->solid || !s->clear)
        return dem_fail_memory(error);
    for (size_t i = 0; i < count; i++) {
        const dem_render_body *body = &s->scene->bodies[i];
        const stage_shape *frame = &s->shapes[body->shape];
        dem_ray_pose pose = pose_of(s, body);
        if (body->clear > 0) {
            s->clear[clears++] = (uint32_t)i;
            DEM_TRY(dem_ray_add_instance(s->panes, frame->clear, &pose, error));
        } else {
            s->solid[solids++] = (uint32_t)i;
            DEM_TRY(dem_ray_add_instance(s->rays, frame->solid, &pose, error));
        }
    }
    return s->panes ? dem_ray_commit(s->panes, error) : DEM_OK;
}

// the sun stands to the upper left, a little before the scene
static void set_lights(dem_stage *s)
{
    const dem_view *v = s->view;
    deal_lights(&s->lights);
    s->up = v->ground_up;
    dem_vec3 ahead = v3_unit(v3_along(v->forward, -v3_dot(v->forward, s->up), s->up));
    s->sun = v3_unit(v3_along(v3_along(v3_scale(v->right, -0.5), -0.25, ahead), 1.0, s->up));
    s->sun_u = v3_normal_to(s->sun);
    s->sun_v = v3_cross(s->sun, s->sun_u);
    s->ground = (v->ground - v3_dot(v->centre, s->up)) / v->radius;
}

// ---- what a ray meets

static dem_ray make_ray(dem_vec3 from, dem_vec3 to, double near)
{
    return (dem_ray){
        {(float)from.x, (float)from.y, (float)from.z}, (float)near, {(float)to.x, (float)to.y, (float)to.z}, INFINITY};
}

static void describe_triangle(const dem_stage *s, const dem_render_body *body, const dem_ray_hit *hit, dem_spot *p)
{
    const dem_mesh *mesh = s->scene->shapes[body->shape].mesh;
    const uint32_t *t = &mesh->triangles[3 * (size_t)hit->primitive];
    dem_vec3 a = mesh->vertices[t[0]];
    dem_vec3 n = v3_cross(v3_sub(mesh->vertices[t[1]], a), v3_sub(mesh->vertices[t[2]], a));
    p->face = quat_rotate(body->orientation, v3_unit(n));
    p->normal = p->face;
    const float *c = s->shapes[body->shape].normals;
    if (c) {
        c += 9 * (size_t)hit->primitive;
        double w[3] = {1 - (double)hit->u - (double)hit->v, hit->u, hit->v};
        n = v3(0, 0, 0);
        for (int k = 0; k < 3; k++)
            n = v3_along(n, w[k], v3(c[3 * k], c[3 * k + 1], c[3 * k + 2]));
        p->normal = quat_rotate(body->orientation, v3_unit(n));
    }
}

static void describe_hit(const dem_stage *s, dem_vec3 from, dem_vec3 along, const dem_ray_hit *hit, dem_spot *p)
{
    p->body = s->solid[hit->instance];
    const dem_render_body *body = &s->scene->bodies[p->body];
    const dem_render_shape *shape = &s->scene->shapes[body->shape];
    p->primitive = hit->primitive;
    p->at = v3_along(from, hit->distance, along);
    if (shape->mesh)
        describe_triangle(s, body, hit, p);
    else
        p->normal = p->face = v3_unit(v3_sub(p->at, to_stage(s, body, shape->balls[hit->primitive].centre)));
    // both sides of an open mesh can be seen
    if (v3_dot(p->face, along) > 0) {
        p->face = v3_scale(p->face, -1);
        p->normal = v3_scale(p->normal, -1);
    }
}

static void view_ray(const dem_stage *s, double x, double y, dem_vec3 *from, dem_vec3 *along)
{
    const dem_view *v = s->view;
    double unit = v->pixel / v->radius, right = (x - v->width / 2.0) * unit, up = (v->height / 2.0 - y) * unit;
    dem_vec3 across = v3_along(v3_scale(v->right, right), up, v->up);
    if (v->distance > 0) {
        *from = v3_scale(v->forward, -v->distance / v->radius);
        *along = v3_unit(v3_sub(across, *from));
    } else {
        *from = v3_along(across, -2, v->forward);
        *along = v->forward;
    }
}

// the point of the ground behind a point of the picture, if there is one
static bool ground_at(const dem_stage *s, dem_vec3 from, dem_vec3 along, dem_spot *p)
{
    double fall = v3_dot(along, s->up), height = v3_dot(from, s->up) - s->ground;
    if (!(fall < 0 && height > 0))
        return false;
    *p = (dem_spot){.body = STAGE_GROUND, .at = v3_along(from, -height / fall, along), .normal = s->up, .face = s->up};
    return true;
}

bool dem_stage_look(const dem_stage *s, double x, double y, dem_spot *p)
{
    dem_vec3 from, along;
    dem_ray_hit hit;
    view_ray(s, x, y, &from, &along);
    dem_ray ray = make_ray(from, along, 0);
    if (!dem_ray_closest(s->rays, &ray, &hit))
        return ground_at(s, from, along, p);
    describe_hit(s, from, along, &hit, p);
    return true;
}

// ---- what is clear

// whether a crease of the triangle passes within a line's breadth of a point of the picture [pixels]; `near`: within
// two
static bool on_crease(const dem_stage *s, const dem_render_body *body, uint32_t triangle, double x, double y,
                      bool *near)
{
    const dem_render_shape *shape = &s->scene->shapes[body->shape];
    unsigned creases = s->shapes[body->shape].creases[triangle];
    bool on = false;
    for (size_t k = 0; k < 3 && creases >> k; k++) {
        double ends[2][2];
        if (!(creases >> k & 1))
            continue;
        for (size_t e = 0; e < 2; e++) {
            dem_vec3 corner = shape->mesh->vertices[shape->mesh->triangles[3 * (size_t)triangle + (k + 1 + e) % 3]];
            dem_vec3 at = v3_along(body->position, body->scale, quat_rotate(body->orientation, corner));
            dem_view_project(s->view, at, &ends[e][0], &ends[e][1]);
        }
        double u = ends[1][0] - ends[0][0], v = ends[1][1] - ends[0][1], length = hypot(u, v);
        double off = length > 0 ? fabs(u * (y - ends[0][1]) - v * (x - ends[0][0])) / length : INFINITY;
        on |= off < LINE;
        *near |= off < LINE + 1.5;
    }
    return on;
}

// light through a body at an angle passes more of it; the near side of a box is held back, so that it shows what is in
// it
static void add_pane(const dem_stage *s, const dem_ray_hit *hit, dem_vec3 along, double x, double y, dem_veil *veil)
{
    const dem_render_body *body = &s->scene->bodies[s->clear[hit->instance]];
    const dem_mesh *mesh = s->scene->shapes[body->shape].mesh;
    const uint32_t *t = &mesh->triangles[3 * (size_t)hit->primitive];
    dem_vec3 a = mesh->vertices[t[0]];
    dem_vec3 n = v3_cross(v3_sub(mesh->vertices[t[1]], a), v3_sub(mesh->vertices[t[2]], a));
    double slope = v3_dot(quat_rotate(body->orientation, v3_unit(n)), along), held, shade = 1;
    bool near = false;
    if (on_crease(s, body, hit->primitive, x, y, &near)) {
        held = LINE_HELD;
        shade = LINE_SHADE;
    } else {
        held = 1 - pow((double)body->clear, fmin(1 / fabs(slope), MOST_PATH));
        held *= slope > 0 ? FRONT : 1;
    }
    float add = veil->through * (float)held;
    veil->light.r += add * (float)shade * body->colour.r;
    veil->light.g += add * (float)shade * body->colour.g;
    veil->light.b += add * (float)shade * body->colour.b;
    veil->through -= add;
    veil->key = veil->key * 31 + 2 * s->clear[hit->instance] + 1 + near;
}

dem_veil dem_stage_veil(const dem_stage *s, double x, double y, const dem_spot *spot)
{
    dem_veil veil = {.through = 1};
    dem_vec3 from, along;
    dem_ray_hit hit;
    if (!s->panes)
        return veil;
    view_ray(s, x, y, &from, &along);
    dem_ray ray = make_ray(from, along, 0);
    if (spot)
        ray.far = (float)(v3_dot(v3_sub(spot->at, from), along) * (1 - NEAR));
    for (int layer = 0; layer < LAYERS && dem_ray_closest(s->panes, &ray, &hit); layer++) {
        add_pane(s, &hit, along, x, y, &veil);
        ray.near = hit.distance + (float)NEAR;
    }
    return veil;
}

// ---- light

// a few of the light rays, turned about their axis
typedef struct hand {
    size_t first, count;
    double c, s;
} hand;

static bool blocked(const dem_stage *s, const dem_spot *p, dem_vec3 along, double reach)
{
    dem_ray ray = make_ray(v3_along(p->at, NEAR, p->face), along, NEAR);
    ray.far = (float)reach;
    return dem_ray_occluded(s->rays, &ray);
}

// mean brightness of the sky about a spot; `behind`: of what hides it; `open`: were nothing in the way
static double sky_at(const dem_stage *s, const dem_spot *p, hand h, double reach, double behind, double *open)
{
    dem_vec3 u = v3_normal_to(p->normal), v = v3_cross(p->normal, u);
    double sum = 0, all = 0;
    for (size_t i = h.first; i < h.first + h.count; i++) {
        dem_vec3 d = s->lights.sky[i];
        dem_vec3 across = v3_along(v3_scale(u, h.c * d.x - h.s * d.y), h.s * d.x + h.c * d.y, v);
        dem_vec3 along = v3_along(across, d.z, p->normal);
        double up = v3_dot(along, s->up), bright = up > 0 ? 0.85 + 0.3 * up : 0.75;  // the white ground shines too
        all += bright;
        sum += blocked(s, p, along, reach) ? behind * bright : bright;
    }
    *open = all / (double)h.count;
    return sum / (double)h.count;
}

static double sun_at(const dem_stage *s, const dem_spot *p, hand h, double *open)
{
    double sum = 0, all = 0;
    for (size_t i = h.first; i < h.first + h.count; i++) {
        dem_vec3 d = s->lights.sun[i];
        double a = SUN_SIZE * (h.c * d.x - h.s * d.y), b = SUN_SIZE * (h.s * d.x + h.c * d.y);
        dem_vec3 along = v3_unit(v3_along(v3_along(s->sun, a, s->sun_u), b, s->sun_v));
        double slope = v3_dot(along, p->normal);
        if (slope <= 0)
            continue;
        all += slope;
        if (!blocked(s, p, along, INFINITY))
            sum += slope;
    }
    *open = all / (double)h.count;
    return sum / (double)h.count;
}

dem_colour dem_stage_light(const dem_stage *s, const dem_spot *p, size_t subset)
{
    double open;
    double sky = SKY * sky_at(s, p, (hand){subset * STAGE_SKY_RAYS, STAGE_SKY_RAYS, 1, 0}, INFINITY, BEHIND, &open);
    double sun = SUN * sun_at(s, p, (hand){subset * STAGE_SUN_RAYS, STAGE_SUN_RAYS, 1, 0}, &open);
    // a warm sun in a cool sky
    return (dem_colour){(float)(1.03 * sun + 0.98 * sky), (float)(sun + sky), (float)(0.94 * sun + 1.05 * sky)};
}

// shadows fade towards the edges of the picture, so that it melts into a white page
static double fade(const dem_view *v, int x, int y)
{
    int edge_x = x < v->width - x ? x : v->width - x, edge_y = y < v->height - y ? y : v->height - y;
    int smaller = v->width < v->height ? v->width : v->height;
    double t = (edge_x < edge_y ? edge_x : edge_y) / (FADE * smaller);
    return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
}

float dem_stage_ground(const dem_stage *s, int x, int y)
{
    dem_vec3 from, along;
    dem_spot p;
    double shadow = SHADOW * fade(s->view, x, y);
    view_ray(s, x, y, &from, &along);
    if (!(shadow > 0) || !ground_at(s, from, along, &p))
        return 1;
    dem_random r = random_stream((uint64_t)y, (uint64_t)x);
    double turn = 2 * DEM_PI * random_uniform(&r), c = cos(turn), w = sin(turn), open_sky, open_sun;
    double sky = sky_at(s, &p, (hand){0, GROUND_FEW_SKY, c, w}, GROUND_REACH, 0, &open_sky);
    if (sky < open_sky)
        sky = sky_at(s, &p, (hand){0, GROUND_SKY, c, w}, GROUND_REACH, 0, &open_sky);
    double sun = sun_at(s, &p, (hand){0, GROUND_FEW_SUN, c, w}, &open_sun);
    if (sun > 0 && sun < open_sun)
        sun = sun_at(s, &p, (hand){0, GROUND_SUN, c, w}, &open_sun);
    double part = (SKY * sky + SUN * sun) / (SKY * open_sky + SUN * open_sun);
    return (float)(1 - shadow * (1 - part));
}

// ---- beginning and end

dem_status dem_stage_init(dem_stage *s, const dem_render_scene *scene, const dem_view *view, dem_error *error)
{
    *s = (dem_stage){.scene = scene, .view = view};
    set_lights(s);
    dem_status status = dem_ray_create(&s->rays, error);
    if (status == DEM_OK) {
        s->shapes = dem_alloc_zero(scene->shape_count, sizeof *s->shapes);
        status = s->shapes ? add_shapes(s, error) : dem_fail_memory(error);
    }
    if (status == DEM_OK)
        status = add_bodies(s, error);
    if (status == DEM_OK)
        status = dem_ray_commit(s->rays, error);
    if (status != DEM_OK)
        dem_stage_release(s);
    return status;
}

void dem_stage_release(dem_stage *s)
{
    for (size_t i = 0; s->shapes && i < s->scene->shape_count; i++) {
        free(s->shapes[i].normals);
        free(s->shapes[i].creases);
    }
    free(s->shapes);
    free(s->solid);
    free(s->clear);
    dem_ray_destroy(s->rays);
    dem_ray_destroy(s->panes);
    *s = (dem_stage){0};
}
