#include "geom/tree.h"

#include <stdlib.h>

enum { LEAF_TRIANGLES = 4 };

dem_vec3 dem_triangle_closest(dem_vec3 p, dem_vec3 a, dem_vec3 b, dem_vec3 c)
{
    dem_vec3 ab = v3_sub(b, a), ac = v3_sub(c, a), ap = v3_sub(p, a);
    double d1 = v3_dot(ab, ap), d2 = v3_dot(ac, ap);
    if (d1 <= 0 && d2 <= 0)
        return a;
    dem_vec3 bp = v3_sub(p, b);
    double d3 = v3_dot(ab, bp), d4 = v3_dot(ac, bp);
    if (d3 >= 0 && d4 <= d3)
        return b;
    double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3)
        return v3_along(a, d1 / (d1 - d3), ab);
    dem_vec3 cp = v3_sub(p, c);
    double d5 = v3_dot(ab, cp), d6 = v3_dot(ac, cp);
    if (d6 >= 0 && d5 <= d6)
        return c;
    double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6)
        return v3_along(a, d2 / (d2 - d6), ac);
    double va = d3 * d6 - d5 * d4, e = d4 - d3, f = d5 - d6;
    if (va <= 0 && e >= 0 && f >= 0 && e + f > 0)
        return v3_along(b, e / (e + f), v3_sub(c, b));
    double sum = va + vb + vc;
    if (!(sum != 0))
        return a;
    return v3_along(v3_along(a, vb / sum, ab), vc / sum, ac);
}

static dem_vec3 corner(const dem_tree *tree, uint32_t triangle, int k)
{
    return tree->vertices[tree->triangles[3 * (size_t)triangle + (size_t)k]];
}

static dem_box triangle_box(const void *items, uint32_t triangle)
{
    dem_box box = box_empty();
    for (int k = 0; k < 3; k++)
        box = box_with(box, corner(items, triangle, k));
    return box;
}

dem_status dem_tree_build(dem_tree *tree, const dem_vec3 *vertices, const uint32_t *triangles, size_t count,
                          dem_error *error)
{
    *tree = (dem_tree){.vertices = vertices, .triangles = triangles, .count = count};
    if (count == 0)
        return dem_fail(error, DEM_BAD_INPUT, "no triangles; give a mesh with faces");
    if (count >= UINT32_MAX / 2)
        return dem_fail(error, DEM_BAD_INPUT, "%zu triangles; give fewer than 2^31", count);
    dem_box_tree boxes;
    if (!dem_box_tree_build(&boxes, tree, count, LEAF_TRIANGLES, triangle_box))
        return dem_fail_memory(error);
    tree->nodes = boxes.nodes;
    tree->node_count = boxes.node_count;
    tree->order = boxes.order;
    return DEM_OK;
}

void dem_tree_release(dem_tree *tree)
{
    free(tree->nodes);
    free(tree->order);
    *tree = (dem_tree){0};
}

typedef struct nearest {
    double distance2;
    dem_vec3 point;
    uint32_t triangle;
    bool found;
} nearest;

// looks for a point nearer than given, and stops at one not farther than `enough2`
static void search_nearest(const dem_tree *tree, dem_vec3 p, double enough2, nearest *best)
{
    dem_box_visit stack[DEM_BOX_TREE_STACK];
    int top = 0;
    stack[top++] = (dem_box_visit){box_distance2(&tree->nodes[0].box, p), 0};
    while (top && best->distance2 > enough2) {
        dem_box_visit visit = stack[--top];
        if (visit.distance2 >= best->distance2)
            continue;
        const dem_tree_node *node = &tree->nodes[visit.node];
        if (node->right) {
            top += box_visit_both(tree->nodes, visit.node, p, best->distance2, stack + top);
            continue;
        }
        for (uint32_t i = node->begin; i < node->end; i++) {
            uint32_t t = tree->order[i];
            dem_vec3 q = dem_triangle_closest(p, corner(tree, t, 0), corner(tree, t, 1), corner(tree, t, 2));
            double d = v3_norm2(v3_sub(q, p));
            if (d < best->distance2)
                *best = (nearest){d, q, t, true};
        }
    }
}

double dem_tree_closest(const dem_tree *tree, dem_vec3 p, double limit, dem_vec3 *point, uint32_t *triangle)
{
    nearest best = {.distance2 = limit * limit};
    search_nearest(tree, p, -1, &best);
    if (best.found && point)
        *point = best.point;
    if (best.found && triangle)
        *triangle = best.triangle;
    return best.found ? sqrt(best.distance2) : INFINITY;
}

bool dem_tree_within(const dem_tree *tree, dem_vec3 p, double distance)
{
    nearest best = {.distance2 = nextafter(distance * distance, INFINITY)};
    search_nearest(tree, p, distance * distance, &best);
    return best.found;
}

// does the ray p + t d, t >= 0, meet the box? `inverse` is 1/d by component (infinities allowed)
static bool ray_meets_box(const dem_box *box, dem_vec3 p, dem_vec3 inverse)
{
    double near = 0, far = INFINITY;
    for (int k = 0; k < 3; k++) {
        double a = (v3_get(box->low, k) - v3_get(p, k)) * v3_get(inverse, k);
        double b = (v3_get(box->high, k) - v3_get(p, k)) * v3_get(inverse, k);
        double first = a < b ? a : b, last = a < b ? b : a;
        near = first > near ? first : near;
        far = last < far ? last : far;
    }
    return near <= far * (1 + 1e-12);
}

static void pass_triangle(const dem_tree *tree, uint32_t triangle, dem_vec3 p, dem_vec3 d, dem_tree_visit visit,
                          void *user)
{
    dem_vec3 a = corner(tree, triangle, 0);
    dem_vec3 e1 = v3_sub(corner(tree, triangle, 1), a), e2 = v3_sub(corner(tree, triangle, 2), a);
    dem_vec3 pv = v3_cross(d, e2), tv = v3_sub(p, a), qv = v3_cross(tv, e1);
    double det = v3_dot(e1, pv);
    if (det == 0)
        return;
    double u = v3_dot(tv, pv) / det, v = v3_dot(d, qv) / det, t = v3_dot(e2, qv) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && t > 0)
        visit(user, triangle, det > 0 ? -1 : 1, t);
}

void dem_tree_ray(const dem_tree *tree, dem_vec3 p, dem_vec3 d, dem_tree_visit visit, void *user)
{
    dem_vec3 inverse = v3(1 / d.x, 1 / d.y, 1 / d.z);
    uint32_t stack[DEM_BOX_TREE_STACK];
    int top = 0;
    stack[top++] = 0;
    while (top) {
        uint32_t at = stack[--top];
        const dem_box_node *node = &tree->nodes[at];
        if (!ray_meets_box(&node->box, p, inverse))
            continue;
        if (node->right) {
            stack[top++] = at + 1;
            stack[top++] = node->right;
            continue;
        }
        for (uint32_t i = node->begin; i < node->end; i++)
            pass_triangle(tree, tree->order[i], p, d, visit, user);
    }
}

static void add_crossing(void *user, uint32_t triangle, int leaving, double t)
{
    (void)triangle, (void)t;
    *(int *)user += leaving;
}

int dem_tree_winding(const dem_tree *tree, dem_vec3 p, dem_vec3 d)
{
    int winding = 0;
    dem_tree_ray(tree, p, d, add_crossing, &winding);
    return winding;
}

bool dem_tree_inside(const dem_tree *tree, dem_vec3 p)
{
    static const dem_vec3 directions[3] = {
        {0.57731, 0.33913, 0.74311}, {-0.41273, 0.82131, 0.29317}, {0.27191, -0.61133, -0.74197}};
    int votes = 0;
    for (int i = 0; i < 3; i++)
        votes += dem_tree_winding(tree, p, directions[i]) != 0;
    return votes >= 2;
}
