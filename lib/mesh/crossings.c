// Pairs of triangles that intersect: candidates by the box tree, one leaf against the tree at a time, then exact
// predicates on edges against triangles, so that contacts at a point, along a line or in a plane are all found.
#include "mesh/crossings.h"

#include <stdlib.h>
#include <string.h>

#include "math/orient.h"

enum { WORK_PER_TRIANGLE = 1000, WORK_BASE = 1000000, WORK_BETWEEN_REPORTS = 10000000 };
enum { SHARES = 16, SHARE_NODES = 16 };  // of the tree, looked at together: few, so that it can stop soon

typedef struct corners {
    dem_vec3 p[3];
    uint32_t v[3];
} corners;

static corners corners_of(const dem_mesh *mesh, uint32_t triangle)
{
    corners c;
    for (int k = 0; k < 3; k++) {
        c.v[k] = mesh->triangles[3 * (size_t)triangle + (size_t)k];
        c.p[k] = mesh->vertices[c.v[k]];
    }
    return c;
}

static bool boxes_meet(const dem_box *a, const dem_box *b)
{
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y &&
           a->low.z <= b->high.z && b->low.z <= a->high.z;
}

static dem_box box_of(const corners *c)
{
    return box_with(box_with(box_with(box_empty(), c->p[0]), c->p[1]), c->p[2]);
}

// the axis along which a triangle looks largest; -1 without area
static int widest_axis(const corners *c)
{
    dem_vec3 n = v3_cross(v3_sub(c->p[1], c->p[0]), v3_sub(c->p[2], c->p[0]));
    n = v3(fabs(n.x), fabs(n.y), fabs(n.z));
    int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
    // the sign is exact: a needle of rounding size still has a plane
    for (int k = 0; k < 3; k++) {
        if (dem_orient2(c->p[0], c->p[1], c->p[2], axis) != 0)
            return axis;
        axis = (axis + 1) % 3;
    }
    return -1;
}

static bool inside_flat(const corners *t, dem_vec3 p, int axis)
{
    int a = dem_orient2(t->p[0], t->p[1], p, axis), b = dem_orient2(t->p[1], t->p[2], p, axis);
    int c = dem_orient2(t->p[2], t->p[0], p, axis);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

// two segments in one line along `axis`: do they overlap?
static bool overlap_in_line(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 d, int axis)
{
    for (int k = 1; k <= 2; k++) {
        int i = (axis + k) % 3;
        if (fmax(v3_get(a, i), v3_get(b, i)) < fmin(v3_get(c, i), v3_get(d, i)) ||
            fmax(v3_get(c, i), v3_get(d, i)) < fmin(v3_get(a, i), v3_get(b, i)))
            return false;
    }
    return true;
}

static bool segments_meet_flat(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 d, int axis)
{
    int s = dem_orient2(a, b, c, axis), t = dem_orient2(a, b, d, axis);
    int u = dem_orient2(c, d, a, axis), v = dem_orient2(c, d, b, axis);
    if (s == 0 && t == 0 && u == 0 && v == 0)
        return overlap_in_line(a, b, c, d, axis);
    return s * t <= 0 && u * v <= 0;
}

// closed segment against closed triangle
static bool segment_meets(dem_vec3 p, dem_vec3 q, const corners *t)
{
    int below = dem_orient3(t->p[0], t->p[1], t->p[2], p), above = dem_orient3(t->p[0], t->p[1], t->p[2], q);
    if (below * above > 0)
        return false;
    if (below == 0 && above == 0) {
        int axis = widest_axis(t);
        if (axis < 0)
            return false;
        for (int k = 0; k < 3; k++)
            if (segments_meet_flat(p, q, t->p[k], t->p[(k + 1) % 3], axis))
                return true;
        return inside_flat(t, p, axis);
    }
    int a = dem_orient3(p, q, t->p[0], t->p[1]), b = dem_orient3(p, q, t->p[1], t->p[2]);
    int c = dem_orient3(p, q, t->p[2], t->p[0]);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

// all corners of `a` strictly on one side of the plane of `b`?
static bool apart(const corners *a, const corners *b)
{
    int s = dem_orient3(b->p[0], b->p[1], b->p[2], a->p[0]);
    return s != 0 && s == dem_orient3(b->p[0], b->p[1], b->p[2], a->p[1]) &&
           s == dem_orient3(b->p[0], b->p[1], b->p[2], a->p[2]);
}

static bool separate_cross(const corners *a, const corners *b)
{
    if (apart(a, b) || apart(b, a))
        return false;
    for (int k = 0; k < 3; k++)
        if (segment_meets(a->p[k], a->p[(k + 1) % 3], b) || segment_meets(b->p[k], b->p[(k + 1) % 3], a))
            return true;
    return false;
}

// turned so that corner 0 is the k-th
static corners turned(const corners *c, int k)
{
    corners t;
    for (int i = 0; i < 3; i++) {
        t.p[i] = c->p[(i + k) % 3];
        t.v[i] = c->v[(i + k) % 3];
    }
    return t;
}

static bool corners_cross(const corners *a, const corners *b)
{
    int shared = 0, in_a[3] = {0}, in_b[3] = {0};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (a->v[i] == b->v[k]) {
                in_a[shared] = i;
                in_b[shared++] = k;
                break;
            }
    if (shared == 0)
        return separate_cross(a, b);
    if (shared == 1) {
        // whatever they share besides the corner ends on the side across from it
        corners s = turned(a, in_a[0]), t = turned(b, in_b[0]);
        return segment_meets(s.p[1], s.p[2], b) || segment_meets(t.p[1], t.p[2], a);
    }
    if (shared == 2) {
        // folded flat onto each other
        dem_vec3 p = a->p[in_a[0]], q = a->p[in_a[1]], r = a->p[3 - in_a[0] - in_a[1]], s = b->p[3 - in_b[0] - in_b[1]];
        int axis = widest_axis(a);
        return axis >= 0 && dem_orient3(p, q, r, s) == 0 && dem_orient2(p, q, r, axis) == dem_orient2(p, q, s, axis);
    }
    return true;
}

bool dem_triangles_cross(const dem_mesh *mesh, uint32_t a, uint32_t b)
{
    corners p = corners_of(mesh, a), q = corners_of(mesh, b);
    return corners_cross(&p, &q);
}

// a share of the leaves, and what was found of it
typedef struct search {
    const dem_mesh *mesh;
    const dem_tree *tree;
    dem_crossings found;
    size_t room, work;
    bool failed;     // out of memory
} search;

// triangles of two leaves, or within one; false: out of memory
static bool test_leaves(search *s, const dem_box_node *one, const dem_box_node *other)
{
    for (uint32_t i = one->begin; i < one->end; i++) {
        corners a = corners_of(s->mesh, s->tree->order[i]);
        dem_box box = box_of(&a);
        if (!boxes_meet(&box, &other->box))
            continue;
        for (uint32_t k = one == other ? i + 1 : other->begin; k < other->end; k++) {
            corners b = corners_of(s->mesh, s->tree->order[k]);
            dem_box facing = box_of(&b);
            s->work++;
            if (!boxes_meet(&box, &facing) || widest_axis(&a) < 0 || widest_axis(&b) < 0 || !corners_cross(&a, &b))
                continue;
            if (!dem_grow(&s->found.pairs, &s->room, s->found.count, sizeof *s->found.pairs))
                return false;
            s->found.pairs[s->found.count][0] = s->tree->order[i];
            s->found.pairs[s->found.count++][1] = s->tree->order[k];
        }
    }
    return true;
}

// `leaf` against the leaves from itself on
static bool test_leaf(search *s, const dem_box_node *leaf)
{
    uint32_t stack[DEM_BOX_TREE_STACK];
    int top = 0;
    stack[top++] = 0;
    while (top) {
        uint32_t at = stack[--top];
        const dem_box_node *node = &s->tree->nodes[at];
        s->work++;
        if (node->end <= leaf->begin || !boxes_meet(&node->box, &leaf->box))
            continue;
        if (node->right) {
            stack[top++] = node->right;
            stack[top++] = at + 1;
        } else if (!test_leaves(s, leaf, node)) {
            return false;
        }
    }
    return true;
}

// the leaves among some nodes, until there is too much of them
static void search_share(search *s, size_t begin, size_t end, size_t max_pairs, size_t max_work)
{
    s->found.count = s->work = 0;
    for (size_t i = begin; i < end && !s->failed && s->found.count <= max_pairs && s->work <= max_work; i++)
        if (!s->tree->nodes[i].right)
            s->failed = !test_leaf(s, &s->tree->nodes[i]);
}

// adds what a share has found; false: out of memory
static bool take_in(const search *s, dem_crossings *all, size_t *room)
{
    for (size_t k = 0; k < s->found.count; k++) {
        if (!dem_grow(&all->pairs, room, all->count, sizeof *all->pairs))
            return false;
        memcpy(all->pairs[all->count++], s->found.pairs[k], sizeof *all->pairs);
    }
    return !s->failed;
}

dem_status dem_mesh_crossings(const dem_ctx *ctx, const dem_mesh *mesh, const dem_tree *tree, size_t max_pairs,
                              dem_crossings *crossings, dem_error *error)
{
    search shares[SHARES];
    size_t max_work = WORK_BASE + WORK_PER_TRIANGLE * mesh->triangle_count, told = 0, work = 0, room = 0;
    int threads = dem_threads(ctx);
    dem_status status = DEM_OK;
    *crossings = (dem_crossings){.complete = true};
    for (int k = 0; k < SHARES; k++)
        shares[k] = (search){.mesh = mesh, .tree = tree};
    // SHARES shares at a time, whatever the number of threads
    for (size_t at = 0; at < tree->node_count && status == DEM_OK && crossings->complete; at += SHARES * SHARE_NODES) {
#pragma omp parallel for num_threads(threads) schedule(dynamic) if (threads > 1)
        for (int k = 0; k < SHARES; k++) {
            size_t begin = at + (size_t)k * SHARE_NODES, end = begin + SHARE_NODES;
            end = end < tree->node_count ? end : tree->node_count;
            search_share(&shares[k], begin, end, max_pairs, max_work - work);
        }
        for (int k = 0; k < SHARES && status == DEM_OK; k++) {
            work += shares[k].work;
            if (!take_in(&shares[k], crossings, &room))
                status = dem_fail_memory(error);
        }
        crossings->complete = crossings->count <= max_pairs && work <= max_work;
        if (status == DEM_OK && work - told > WORK_BETWEEN_REPORTS) {
            told = work;
            if (dem_progress(ctx, "checking", (double)at / (double)tree->node_count))
                status = dem_fail(error, DEM_INTERRUPTED, "interrupted while checking the mesh");
        }
    }
    for (int k = 0; k < SHARES; k++)
        free(shares[k].found.pairs);
    if (status != DEM_OK) {
        free(crossings->pairs);
        *crossings = (dem_crossings){0};
    }
    return status;
}
