#include "geom/tree.h"

#include <stdlib.h>
#include <string.h>

enum { LEAF_TRIANGLES = 4, STACK = 96 };

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

typedef struct tree_builder {
    dem_tree *tree;
    dem_vec3 *centres;
} tree_builder;

static dem_box range_box(const dem_tree *tree, uint32_t begin, uint32_t end)
{
    dem_box box = box_empty();
    for (uint32_t i = begin; i < end; i++)
        for (int k = 0; k < 3; k++)
            box = box_with(box, corner(tree, tree->order[i], k));
    return box;
}

// quickselect of order[begin, end) about position `middle` by centre coordinate
static void split_at(tree_builder *b, uint32_t begin, uint32_t end, uint32_t middle, int axis)
{
    uint32_t *order = b->tree->order;
    int64_t low = begin, high = (int64_t)end - 1;
    while (low < high) {
        double pivot = v3_get(b->centres[order[low + (high - low) / 2]], axis);
        int64_t i = low, j = high;
        while (i <= j) {
            while (v3_get(b->centres[order[i]], axis) < pivot)
                i++;
            while (v3_get(b->centres[order[j]], axis) > pivot)
                j--;
            if (i <= j) {
                uint32_t swap = order[i];
                order[i++] = order[j];
                order[j--] = swap;
            }
        }
        if (middle <= j)
            high = j;
        else if (middle >= i)
            low = i;
        else
            return;
    }
}

static uint32_t build_range(tree_builder *b, uint32_t begin, uint32_t end)
{
    uint32_t me = (uint32_t)b->tree->node_count++;
    b->tree->nodes[me] = (dem_tree_node){.box = range_box(b->tree, begin, end), .begin = begin, .end = end};
    if (end - begin > LEAF_TRIANGLES) {
        dem_vec3 size = v3_sub(b->tree->nodes[me].box.high, b->tree->nodes[me].box.low);
        int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        uint32_t middle = begin + (end - begin) / 2;
        split_at(b, begin, end, middle, axis);
        build_range(b, begin, middle);
        b->tree->nodes[me].right = build_range(b, middle, end);
    }
    return me;
}

dem_status dem_tree_build(dem_tree *tree, const dem_vec3 *vertices, const uint32_t *triangles, size_t count,
                          dem_error *error)
{
    *tree = (dem_tree){.vertices = vertices, .triangles = triangles, .count = count};
    if (count == 0)
        return dem_fail(error, DEM_BAD_INPUT, "no triangles; give a mesh with faces");
    tree->nodes = dem_alloc(2 * count, sizeof *tree->nodes);
    tree->order = dem_alloc(count, sizeof *tree->order);
    dem_vec3 *centres = dem_alloc(count, sizeof *centres);
    if (!tree->nodes || !tree->order || !centres) {
        free(centres);
        dem_tree_release(tree);
        return dem_fail_memory(error);
    }
    for (size_t i = 0; i < count; i++) {
        tree->order[i] = (uint32_t)i;
        dem_vec3 sum = v3_add(v3_add(corner(tree, (uint32_t)i, 0), corner(tree, (uint32_t)i, 1)), corner(tree, (uint32_t)i, 2));
        centres[i] = v3_scale(sum, 1.0 / 3);
    }
    tree_builder builder = {tree, centres};
    build_range(&builder, 0, (uint32_t)count);
    free(centres);
    return DEM_OK;
}

void dem_tree_release(dem_tree *tree)
{
    free(tree->nodes);
    free(tree->order);
    *tree = (dem_tree){0};
}

double dem_tree_closest(const dem_tree *tree, dem_vec3 p, double limit, dem_vec3 *point, uint32_t *triangle)
{
    double best = limit * limit;
    bool found = false;
    uint32_t stack[STACK];
    int top = 0;
    stack[top++] = 0;
    while (top) {
        uint32_t at = stack[--top];
        const dem_tree_node *node = &tree->nodes[at];
        if (box_distance2(&node->box, p) >= best)
            continue;
        if (node->right) {
            uint32_t left = at + 1, right = node->right;
            bool left_first = box_distance2(&tree->nodes[left].box, p) < box_distance2(&tree->nodes[right].box, p);
            stack[top++] = left_first ? right : left;
            stack[top++] = left_first ? left : right;
            continue;
        }
        for (uint32_t i = node->begin; i < node->end; i++) {
            uint32_t t = tree->order[i];
            dem_vec3 q = dem_triangle_closest(p, corner(tree, t, 0), corner(tree, t, 1), corner(tree, t, 2));
            double d = v3_norm2(v3_sub(q, p));
            if (d < best) {
                best = d;
                found = true;
                if (point)
                    *point = q;
                if (triangle)
                    *triangle = t;
            }
        }
    }
    return found ? sqrt(best) : INFINITY;
}

// does the ray p + t d, t >= 0, meet the box? `inverse` is 1/d by component (infinities allowed)
static bool ray_meets_box(const dem_box *box, dem_vec3 p, dem_vec3 inverse)
{
    double near = 0, far = INFINITY;
    for (int k = 0; k < 3; k++) {
        double a = (v3_get(box->low, k) - v3_get(p, k)) * v3_get(inverse, k);
        double b = (v3_get(box->high, k) - v3_get(p, k)) * v3_get(inverse, k);
        near = fmax(near, fmin(a, b));
        far = fmin(far, fmax(a, b));
    }
    return near <= far * (1 + 1e-12);
}

int dem_tree_winding(const dem_tree *tree, dem_vec3 p, dem_vec3 d)
{
    dem_vec3 inverse = v3(1 / d.x, 1 / d.y, 1 / d.z);
    int winding = 0, top = 0;
    uint32_t stack[STACK];
    stack[top++] = 0;
    while (top) {
        uint32_t at = stack[--top];
        const dem_tree_node *node = &tree->nodes[at];
        if (!ray_meets_box(&node->box, p, inverse))
            continue;
        if (node->right) {
            stack[top++] = at + 1;
            stack[top++] = node->right;
            continue;
        }
        for (uint32_t i = node->begin; i < node->end; i++) {
            dem_vec3 a = corner(tree, tree->order[i], 0);
            dem_vec3 e1 = v3_sub(corner(tree, tree->order[i], 1), a), e2 = v3_sub(corner(tree, tree->order[i], 2), a);
            dem_vec3 pv = v3_cross(d, e2), tv = v3_sub(p, a), qv = v3_cross(tv, e1);
            double det = v3_dot(e1, pv);
            if (det == 0)
                continue;
            double u = v3_dot(tv, pv) / det, v = v3_dot(d, qv) / det;
            if (u >= 0 && v >= 0 && u + v <= 1 && v3_dot(e2, qv) / det > 0)
                winding += det > 0 ? -1 : 1;
        }
    }
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
