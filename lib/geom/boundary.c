#include "geom/boundary.h"

#include <stdlib.h>

enum { LEAF_CREASES = 4, MIN_PATCH_POINTS = 4, MAX_PATCH_TRIALS = 1024 };

static dem_vec3 crease_point(const dem_crease *c, double x, double y)
{
    return v3_along(c->centre, c->radius, v3_along(v3_scale(c->a, x), y, c->b));
}

static dem_crease crease_make(const dem_ball *balls, const dem_arc *arc)
{
    dem_ball ball = balls[arc->i];
    double middle = (arc->begin + arc->end) / 2, half = (arc->end - arc->begin) / 2;
    dem_crease c = {.centre = v3_along(ball.centre, ball.radius * arc->h, arc->u),
                    .a = arc->a,
                    .b = arc->b,
                    .u = arc->u,
                    .radius = ball.radius * arc->s,
                    .middle_x = cos(middle),
                    .middle_y = sin(middle),
                    .open = half < DEM_PI ? cos(half) : -2,
                    .i = arc->i,
                    .j = arc->j};
    c.begin = crease_point(&c, cos(arc->begin), sin(arc->begin));
    c.middle = crease_point(&c, c.middle_x, c.middle_y);
    c.end = crease_point(&c, cos(arc->end), sin(arc->end));
    return c;
}

// is the unit direction (x, y) on the arc?
static bool crease_holds(const dem_crease *c, double x, double y)
{
    return x * c->middle_x + y * c->middle_y >= c->open;
}

// the point of the whole crease farthest along d, and with it the box of the arc
static dem_vec3 crease_farthest(const dem_crease *c, dem_vec3 d)
{
    double x = v3_dot(d, c->a), y = v3_dot(d, c->b), length = hypot(x, y);
    if (length > 0 && crease_holds(c, x / length, y / length))
        return crease_point(c, x / length, y / length);
    return v3_dot(v3_sub(c->begin, c->end), d) > 0 ? c->begin : c->end;
}

static dem_box crease_box(const void *items, uint32_t item)
{
    const dem_crease *c = &((const dem_crease *)items)[item];
    dem_box box = box_empty();
    for (int k = 0; k < 6; k++) {
        dem_vec3 d = {0};
        v3_set(&d, k / 2, k % 2 ? 1 : -1);
        box = box_with(box, crease_farthest(c, d));
    }
    return box;
}

// cos of the opening of a cone about each patch's mean direction that holds the patch
static void patch_cones(dem_boundary *b)
{
    double *cone = b->cones;
    for (size_t i = 0; i < b->count; i++)
        cone[i] = 1;
    for (size_t k = 0; k < b->whole.arc_count; k++) {
        const dem_crease *c = &b->creases[k];
        uint32_t sides[2] = {c->i, c->j};
        for (int e = 0; e < 2; e++) {
            dem_ball ball = b->balls[sides[e]];
            dem_vec3 m = v3_unit(b->whole.patches[sides[e]].first), p = crease_farthest(c, v3_scale(m, -1));
            double cosine = v3_dot(v3_sub(p, ball.centre), m) / ball.radius;
            cone[sides[e]] = fmin(cone[sides[e]], cosine - 1e-9);
        }
    }
    // no arc enters the rest of the sphere: it is all patch or all covered
    for (size_t i = 0; i < b->count; i++)
        if (cone[i] >= 1 || b->whole.patches[i].area > 2 * DEM_PI * (1 + cone[i]) - 1e-9)
            cone[i] = -1;
}

dem_status dem_boundary_build(dem_boundary *b, const dem_ball *balls, size_t count, dem_error *error)
{
    *b = (dem_boundary){.balls = balls, .count = count};
    DEM_TRY(dem_ball_union_compute(balls, count, true, 1, &b->whole, error));
    dem_status status = dem_ball_tree_build(&b->tree, balls, count, error);
    size_t arcs = b->whole.arc_count;
    b->cones = dem_alloc(count, sizeof *b->cones);
    b->creases = dem_alloc(arcs, sizeof *b->creases);
    if (status == DEM_OK && (!b->cones || !b->creases))
        status = dem_fail_memory(error);
    for (size_t k = 0; status == DEM_OK && k < arcs; k++)
        b->creases[k] = crease_make(balls, &b->whole.arcs[k]);
    if (status == DEM_OK && arcs && !dem_box_tree_build(&b->crease_tree, b->creases, arcs, LEAF_CREASES, crease_box))
        status = dem_fail_memory(error);
    if (status == DEM_OK)
        patch_cones(b);
    else
        dem_boundary_release(b);
    return status;
}

void dem_boundary_release(dem_boundary *b)
{
    dem_ball_union_release(&b->whole);
    dem_ball_tree_release(&b->tree);
    dem_box_tree_release(&b->crease_tree);
    free(b->creases);
    free(b->cones);
}

bool dem_boundary_covered(const dem_boundary *b, uint32_t i, dem_vec3 n, double margin)
{
    for (size_t k = b->whole.cap_start[i]; k < b->whole.cap_start[i + 1]; k++)
        if (v3_dot(n, b->whole.caps[k].u) - margin > b->whole.caps[k].h)
            return true;
    return false;
}

// nearest patch seen from inside: the closest point of a patch's inside lies on the ray from the centre through p
static void patch_closest(const dem_boundary *b, dem_vec3 p, double enough, dem_boundary_hit *hit)
{
    uint32_t stack[DEM_BOX_TREE_STACK];
    int top = 0;
    stack[top++] = 0;
    while (top && hit->distance > enough) {
        uint32_t at = stack[--top];
        const dem_box_node *node = &b->tree.boxes.nodes[at];
        if (box_distance2(&node->box, p) > hit->distance * hit->distance)
            continue;
        if (node->right) {
            stack[top++] = node->right;
            stack[top++] = at + 1;
            continue;
        }
        for (uint32_t k = node->begin; k < node->end; k++) {
            uint32_t i = b->tree.boxes.order[k];
            dem_vec3 d = v3_sub(p, b->balls[i].centre);
            double away = v3_norm(d), distance = fabs(away - b->balls[i].radius);
            if (distance >= hit->distance || b->whole.patches[i].area == 0)
                continue;
            dem_vec3 n = away > 0 ? v3_scale(d, 1 / away) : v3_unit(b->whole.patches[i].first);
            if (!dem_boundary_covered(b, i, n, 0))
                *hit = (dem_boundary_hit){distance, v3_along(b->balls[i].centre, b->balls[i].radius, n), n};
        }
    }
}

// squared distance to the arc, or to its whole circle where that is not below `limit2`
static double crease_distance2(const dem_crease *c, dem_vec3 p, double limit2, dem_vec3 *point)
{
    dem_vec3 d = v3_sub(p, c->centre);
    double x = v3_dot(d, c->a), y = v3_dot(d, c->b), z = v3_dot(d, c->u), across = sqrt(x * x + y * y);
    double circle2 = (across - c->radius) * (across - c->radius) + z * z;
    if (circle2 >= limit2)
        return circle2;
    if (across > 0 && crease_holds(c, x / across, y / across)) {
        *point = crease_point(c, x / across, y / across);
        return circle2;
    }
    double begin2 = v3_norm2(v3_sub(p, c->begin)), end2 = v3_norm2(v3_sub(p, c->end));
    *point = begin2 < end2 ? c->begin : c->end;
    return fmin(begin2, end2);
}

static void crease_closest(const dem_boundary *b, dem_vec3 p, double enough, dem_boundary_hit *hit)
{
    const dem_box_node *nodes = b->crease_tree.nodes;
    dem_box_visit stack[DEM_BOX_TREE_STACK];
    int top = 0;
    if (b->crease_tree.count)
        stack[top++] = (dem_box_visit){box_distance2(&nodes[0].box, p), 0};
    while (top && hit->distance > enough) {
        dem_box_visit visit = stack[--top];
        const dem_box_node *node = &nodes[visit.node];
        if (visit.distance2 >= hit->distance * hit->distance)
            continue;
        if (node->right) {
            top += box_visit_both(nodes, visit.node, p, hit->distance * hit->distance, stack + top);
            continue;
        }
        for (uint32_t k = node->begin; k < node->end; k++) {
            const dem_crease *c = &b->creases[b->crease_tree.order[k]];
            dem_vec3 q;
            double limit2 = hit->distance * hit->distance, distance2 = crease_distance2(c, p, limit2, &q);
            if (distance2 >= limit2)
                continue;
            dem_vec3 one = v3_unit(v3_sub(q, b->balls[c->i].centre)), other = v3_unit(v3_sub(q, b->balls[c->j].centre));
            *hit = (dem_boundary_hit){sqrt(distance2), q, v3_unit(v3_add(one, other))};
        }
    }
}

dem_boundary_hit dem_boundary_closest(const dem_boundary *b, dem_vec3 p, double enough, double limit)
{
    uint32_t nearest = UINT32_MAX;
    dem_boundary_hit hit = {.distance = dem_ball_tree_level(&b->tree, p, limit, 0, &nearest)};
    bool found = nearest != UINT32_MAX;
    if (found && hit.distance >= 0) {
        hit.normal = v3_unit(v3_sub(p, b->balls[nearest].centre));
        hit.point = v3_along(b->balls[nearest].centre, b->balls[nearest].radius, hit.normal);
    } else if (found) {
        hit.distance = limit;
        crease_closest(b, p, enough, &hit);
        patch_closest(b, p, enough, &hit);
        found = hit.distance < limit;
    }
    return found || limit == INFINITY ? hit : dem_boundary_closest(b, p, enough, INFINITY);
}

typedef struct point_list {
    dem_boundary_point *points;
    size_t count, room;
} point_list;

static bool point_add(point_list *list, dem_boundary_point point)
{
    if (!dem_grow(&list->points, &list->room, list->count, sizeof *list->points))
        return false;
    list->points[list->count++] = point;
    return true;
}

// a spiral of evenly spread directions over the cone; those that are not covered share the patch's area
static bool patch_sample(const dem_boundary *b, uint32_t i, double density, point_list *list)
{
    dem_ball ball = b->balls[i];
    const dem_patch *patch = &b->whole.patches[i];
    double area = patch->area * ball.radius * ball.radius, cone = b->cones[i];
    double part = 2 * DEM_PI * (1 - cone) / patch->area;
    double trials = fmax(density * area * part, fmin(MIN_PATCH_POINTS * part, MAX_PATCH_TRIALS));
    size_t wanted = (size_t)trials + 1, first = list->count;
    dem_vec3 m = v3_unit(patch->first), a = v3_normal_to(m), c = v3_cross(m, a);
    for (size_t k = 0; k < wanted; k++) {
        double z = 1 - (1 - cone) * ((double)k + 0.5) / (double)wanted, s = sqrt(fmax(0, 1 - z * z));
        double t = 2.39996322972865332 * (double)k;
        dem_vec3 n = v3_along(v3_scale(m, z), s, v3_along(v3_scale(a, cos(t)), sin(t), c));
        if (dem_boundary_covered(b, i, n, 0))
            continue;
        if (!point_add(list, (dem_boundary_point){v3_along(ball.centre, ball.radius, n), n, 1, i}))
            return false;
    }
    for (size_t k = first; k < list->count; k++)
        list->points[k].area = area / (double)(list->count - first);
    return true;
}

dem_status dem_boundary_sample(const dem_boundary *b, size_t count, dem_boundary_point **points, size_t *point_count,
                               dem_error *error)
{
    point_list list = {0};
    double density = (double)count / b->whole.area;
    bool done = true;
    for (uint32_t i = 0; done && i < b->count; i++)
        done = b->whole.patches[i].area == 0 || patch_sample(b, i, density, &list);
    for (size_t k = 0; done && k < b->whole.arc_count; k++) {
        const dem_crease *c = &b->creases[k];
        dem_vec3 p[3] = {c->begin, c->middle, c->end};
        for (int e = 0; done && e < 3; e++)
            done = point_add(&list, (dem_boundary_point){p[e], v3_unit(v3_sub(p[e], b->balls[c->i].centre)), 0, c->i});
    }
    if (!done) {
        free(list.points);
        return dem_fail_memory(error);
    }
    *points = list.points;
    *point_count = list.count;
    return DEM_OK;
}
