// Edge collapse by quadrics (Garland & Heckbert 1997), cheapest edge first. The vertex that an edge becomes is the best
// one of those that keep the volume (Lindstrom & Turk 1998): in the plane g.v = k, with g and g.p summed over the
// triangles around the edge. About 1 us per triangle.
#include "mesh/collapse.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/mat3.h"
#include "mesh/weld.h"

#define NONE UINT32_MAX

static const double pull = 1e-4;       // towards the middle of the edge, against the planes: where they leave it free
static const double shortness = 1e-6;  // what length costs, against distance: of equals the shortest edge goes first
static const double least_turn = 0.2;  // cosine between a triangle's normals before and after
static const double farthest = 2;      // of the new vertex from the middle, in lengths of the edge

// sum over planes of area times squared distance: v.a v - 2 b.v + c
typedef struct quadric {
    dem_sym3 a;
    dem_vec3 b;
    double c;
} quadric;

typedef struct offer {
    double cost;
    uint32_t from, to, version;  // the sum of the ends' versions when it was made: it is void at another one
} offer;

typedef struct collapse {
    dem_mesh *mesh;
    uint32_t *first;        // [vertices] corner of a triangle there; the others follow by `next`
    uint32_t *next;         // [corners]
    unsigned char *gone;    // [triangles]
    quadric *quadrics;      // [vertices]
    uint32_t *version;      // [vertices]
    uint32_t *mark, stamp;  // [vertices]
    offer *heap;
    size_t count, room;
} collapse;

static dem_vec3 corner(const collapse *w, uint32_t c)
{
    return w->mesh->vertices[w->mesh->triangles[c]];
}

// twice the area
static dem_vec3 normal(const collapse *w, uint32_t triangle)
{
    dem_vec3 p = corner(w, 3 * triangle);
    return v3_cross(v3_sub(corner(w, 3 * triangle + 1), p), v3_sub(corner(w, 3 * triangle + 2), p));
}

static bool has(const collapse *w, uint32_t triangle, uint32_t vertex)
{
    const uint32_t *t = w->mesh->triangles + 3 * (size_t)triangle;
    return t[0] == vertex || t[1] == vertex || t[2] == vertex;
}

static quadric quadric_add(quadric p, quadric q)
{
    return (quadric){sym3_add(p.a, q.a), v3_add(p.b, q.b), p.c + q.c};
}

static double quadric_at(const quadric *q, dem_vec3 v)
{
    return v3_dot(v, sym3_apply(q->a, v)) - 2 * v3_dot(q->b, v) + q->c;
}

static void add_planes(collapse *w)
{
    for (uint32_t t = 0; t < w->mesh->triangle_count; t++) {
        dem_vec3 n = normal(w, t);
        double area = v3_norm(n) / 2;
        if (!(area > 0))
            continue;
        n = v3_unit(n);
        double d = v3_dot(n, corner(w, 3 * t));
        quadric q = {sym3_scale(sym3_outer(n), area), v3_scale(n, area * d), area * d * d};
        for (uint32_t c = 3 * t; c < 3 * t + 3; c++)
            w->quadrics[w->mesh->triangles[c]] = quadric_add(w->quadrics[w->mesh->triangles[c]], q);
    }
}

// by the adjugate; a is positive definite
static dem_vec3 solve(dem_sym3 a, dem_vec3 b)
{
    double xx = a.yy * a.zz - a.yz * a.yz, xy = a.xz * a.yz - a.xy * a.zz, xz = a.xy * a.yz - a.xz * a.yy;
    double yy = a.xx * a.zz - a.xz * a.xz, yz = a.xy * a.xz - a.xx * a.yz, zz = a.xx * a.yy - a.xy * a.xy;
    double determinant = a.xx * xx + a.xy * xy + a.xz * xz;
    return v3_scale(v3(xx * b.x + xy * b.y + xz * b.z, xy * b.x + yy * b.y + yz * b.z, xz * b.x + yz * b.y + zz * b.z),
                    1 / determinant);
}

// where the edge goes and what that costs; false: nowhere
static bool place(const collapse *w, uint32_t from, uint32_t to, dem_vec3 *at, double *cost)
{
    dem_vec3 p = w->mesh->vertices[from], q = w->mesh->vertices[to], middle = v3_scale(v3_add(p, q), 0.5), g = {0};
    double k = 0, length = v3_distance(p, q);
    for (int end = 0; end < 2; end++)
        for (uint32_t c = w->first[end ? to : from]; c != NONE; c = w->next[c]) {
            if (end && has(w, c / 3, from))
                continue;
            dem_vec3 n = normal(w, c / 3);
            g = v3_add(g, n);
            k += v3_dot(n, corner(w, c));
        }
    quadric sum = quadric_add(w->quadrics[from], w->quadrics[to]);
    double area = sum.a.xx + sum.a.yy + sum.a.zz, held = pull * area;
    dem_sym3 a = sym3_add(sum.a, (dem_sym3){held, held, held, 0, 0, 0});
    dem_vec3 best = solve(a, v3_along(sum.b, held, middle)), across = solve(a, g);
    *at = v3_along(best, (k - v3_dot(g, best)) / v3_dot(g, across), across);
    *cost = fmax(0, quadric_at(&sum, *at)) + area * length * length * shortness;
    return v3_distance(*at, middle) <= farthest * length;
}

static bool comes_before(const offer *a, const offer *b)
{
    if (a->cost != b->cost)
        return a->cost < b->cost;
    return a->from != b->from ? a->from < b->from : a->to < b->to;
}

static bool heap_add(collapse *w, uint32_t from, uint32_t to)
{
    dem_vec3 at;
    offer o = {0, from < to ? from : to, from < to ? to : from, w->version[from] + w->version[to]};
    if (!place(w, o.from, o.to, &at, &o.cost))
        return true;
    if (!dem_grow(&w->heap, &w->room, w->count, sizeof *w->heap))
        return false;
    size_t k = w->count++;
    for (; k > 0 && comes_before(&o, &w->heap[(k - 1) / 2]); k = (k - 1) / 2)
        w->heap[k] = w->heap[(k - 1) / 2];
    w->heap[k] = o;
    return true;
}

static offer heap_take(collapse *w)
{
    offer best = w->heap[0], last = w->heap[--w->count];
    size_t k = 0;
    for (size_t child = 1; child < w->count; child = 2 * k + 1) {
        child += child + 1 < w->count && comes_before(&w->heap[child + 1], &w->heap[child]);
        if (!comes_before(&w->heap[child], &last))
            break;
        w->heap[k] = w->heap[child];
        k = child;
    }
    if (w->count)
        w->heap[k] = last;
    return best;
}

// the ends of an edge of two triangles share two neighbours and no more, or the collapse would pinch the surface
static bool is_link(collapse *w, uint32_t from, uint32_t to)
{
    int triangles = 0, common = 0;
    w->stamp += 2;
    for (uint32_t c = w->first[from]; c != NONE; c = w->next[c]) {
        triangles += has(w, c / 3, to);
        for (uint32_t k = 0; k < 3; k++)
            w->mark[w->mesh->triangles[c / 3 * 3 + k]] = w->stamp;
    }
    w->mark[from] = w->mark[to] = 0;
    for (uint32_t c = w->first[to]; c != NONE; c = w->next[c])
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t *mark = &w->mark[w->mesh->triangles[c / 3 * 3 + k]];
            common += *mark == w->stamp;
            *mark = *mark == w->stamp ? w->stamp + 1 : *mark;  // counted
        }
    return triangles == 2 && common == 2;
}

// would a triangle of `vertex`, other than those of the edge, turn over?
static bool folds(const collapse *w, uint32_t vertex, uint32_t other, dem_vec3 at)
{
    for (uint32_t c = w->first[vertex]; c != NONE; c = w->next[c]) {
        if (has(w, c / 3, other))
            continue;
        uint32_t ahead = c % 3 == 2 ? c - 2 : c + 1, behind = c % 3 == 0 ? c + 2 : c - 1;
        dem_vec3 p = corner(w, ahead), q = corner(w, behind), before = normal(w, c / 3);
        dem_vec3 after = v3_cross(v3_sub(p, at), v3_sub(q, at));
        if (v3_dot(before, after) <= least_turn * v3_norm(before) * v3_norm(after))
            return true;
    }
    return false;
}

// takes corners of triangles that are gone out of a vertex's list
static void purge(collapse *w, uint32_t vertex)
{
    uint32_t *link = &w->first[vertex];
    while (*link != NONE) {
        if (w->gone[*link / 3])
            *link = w->next[*link];
        else
            link = &w->next[*link];
    }
}

static void merge(collapse *w, uint32_t from, uint32_t to, dem_vec3 at)
{
    uint32_t sides[2] = {from, from}, side_count = 0, *link = &w->first[from];
    for (uint32_t c = w->first[to]; c != NONE; c = w->next[c]) {
        uint32_t *t = w->mesh->triangles + c / 3 * 3;
        w->gone[c / 3] = has(w, c / 3, from);
        for (int k = 0; k < 3 && w->gone[c / 3] && side_count < 2; k++)
            if (t[k] != from && t[k] != to) {
                sides[side_count++] = t[k];
                break;
            }
        w->mesh->triangles[c] = from;
    }
    while (*link != NONE)
        link = &w->next[*link];
    *link = w->first[to];
    w->first[to] = NONE;
    purge(w, from);
    purge(w, sides[0]);
    purge(w, sides[1]);
    w->mesh->vertices[from] = at;
    w->quadrics[from] = quadric_add(w->quadrics[from], w->quadrics[to]);
    w->version[from]++;
    w->version[to]++;
}

// the edges of one vertex, each once
static bool offer_edges(collapse *w, uint32_t vertex)
{
    w->stamp += 2;
    w->mark[vertex] = w->stamp;
    for (uint32_t c = w->first[vertex]; c != NONE; c = w->next[c])
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t other = w->mesh->triangles[c / 3 * 3 + k];
            if (w->mark[other] == w->stamp)
                continue;
            w->mark[other] = w->stamp;
            if (!heap_add(w, vertex, other))
                return false;
        }
    return true;
}

static bool collapse_to(collapse *w, size_t triangles)
{
    dem_mesh *mesh = w->mesh;
    size_t left = mesh->triangle_count;
    for (uint32_t c = 0; c < 3 * mesh->triangle_count; c++) {
        uint32_t from = mesh->triangles[c], to = mesh->triangles[c % 3 == 2 ? c - 2 : c + 1];
        if (from < to && !heap_add(w, from, to))
            return false;
    }
    while (left > triangles && w->count) {
        offer o = heap_take(w);
        dem_vec3 at;
        double cost;
        // its neighbours may have moved since
        if (o.version != w->version[o.from] + w->version[o.to] || !place(w, o.from, o.to, &at, &cost) ||
            !is_link(w, o.from, o.to) || folds(w, o.from, o.to, at) || folds(w, o.to, o.from, at))
            continue;
        merge(w, o.from, o.to, at);
        left -= 2;
        if (!offer_edges(w, o.from))
            return false;
    }
    return true;
}

static dem_status take_work_space(collapse *w, dem_arena *arena, dem_error *error)
{
    size_t vertices = w->mesh->vertex_count, triangles = w->mesh->triangle_count;
    w->first = dem_arena_take(arena, vertices, sizeof *w->first);
    w->next = dem_arena_take(arena, triangles, 3 * sizeof *w->next);
    w->gone = dem_arena_take(arena, triangles, sizeof *w->gone);
    w->quadrics = dem_arena_take(arena, vertices, sizeof *w->quadrics);
    w->version = dem_arena_take(arena, vertices, sizeof *w->version);
    w->mark = dem_arena_take(arena, vertices, sizeof *w->mark);
    if (arena->failed)
        return dem_fail_memory(error);
    memset(w->gone, 0, triangles * sizeof *w->gone);
    memset(w->first, 0xff, vertices * sizeof *w->first);
    memset(w->quadrics, 0, vertices * sizeof *w->quadrics);
    memset(w->version, 0, vertices * sizeof *w->version);
    memset(w->mark, 0, vertices * sizeof *w->mark);
    for (uint32_t c = 0; c < 3 * triangles; c++) {
        w->next[c] = w->first[w->mesh->triangles[c]];
        w->first[w->mesh->triangles[c]] = c;
    }
    return DEM_OK;
}

dem_status dem_mesh_collapse(dem_mesh *mesh, size_t triangles, dem_error *error)
{
    collapse w = {.mesh = mesh};
    dem_arena arena = {0};
    dem_status status = take_work_space(&w, &arena, error);
    if (status == DEM_OK) {
        add_planes(&w);
        if (!collapse_to(&w, triangles))
            status = dem_fail_memory(error);
    }
    if (status == DEM_OK) {
        size_t unused;
        dem_mesh_drop(mesh, w.gone);
        status = dem_mesh_compact(mesh, &unused, error);
    }
    dem_arena_release(&arena);
    free(w.heap);
    return status;
}
