#include "mesh/holes.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { LARGEST_EXACT = 500 };                   // edges of a hole that is triangulated with least area
static const double MOST_WORK = 4e8;            // of all such holes: sum of the cubes of their edges

typedef struct filler {
    const dem_surface *surface;
    dem_mesh *mesh;
    dem_vec3 centre;
    dem_holes *holes;
    uint32_t *border;       // border half edges by their first vertex
    size_t border_count;
    unsigned char *used;    // [3 triangle_count at the start]
    uint32_t *loop;         // vertices, in the order of the surface's border
    size_t loop_count;
    double work;
} filler;

typedef struct border_key {
    uint32_t vertex, half;
} border_key;

static int by_vertex(const void *pa, const void *pb)
{
    const border_key *a = pa, *b = pb;
    if (a->vertex != b->vertex)
        return a->vertex < b->vertex ? -1 : 1;
    return (a->half > b->half) - (a->half < b->half);
}

static bool list_borders(filler *f)
{
    const dem_surface *s = f->surface;
    border_key *keys = dem_alloc(s->edges.border, sizeof *keys);
    f->border = dem_alloc(s->edges.border, sizeof *f->border);
    if (!keys || !f->border) {
        free(keys);
        return false;
    }
    for (uint32_t h = 0; h < 3 * s->mesh->triangle_count; h++)
        if (s->edges.twin[h] == DEM_EDGE_BORDER)
            keys[f->border_count++] = (border_key){half_start(s->mesh, h), h};
    qsort(keys, f->border_count, sizeof *keys, by_vertex);
    for (size_t i = 0; i < f->border_count; i++)
        f->border[i] = keys[i].half;
    free(keys);
    return true;
}

// a border half edge that starts at `vertex` and is not yet used; UINT32_MAX: none
static uint32_t border_from(const filler *f, uint32_t vertex)
{
    size_t low = 0, high = f->border_count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (half_start(f->surface->mesh, f->border[middle]) < vertex)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < f->border_count && half_start(f->surface->mesh, f->border[low]) == vertex; low++)
        if (!f->used[f->border[low]])
            return f->border[low];
    return UINT32_MAX;
}

// the border half edge behind `half`, around the fan of triangles at its end
static uint32_t next_border(const filler *f, uint32_t half)
{
    const uint32_t *twin = f->surface->edges.twin;
    uint32_t h = half_next(half);
    for (size_t i = 0; i < f->surface->mesh->triangle_count && twin[h] < DEM_EDGE_MANY; i++)
        h = half_next(twin[h]);
    if (twin[h] == DEM_EDGE_BORDER && !f->used[h])
        return h;
    return border_from(f, half_end(f->surface->mesh, half));
}

// room for all that can come: a triangle per border edge and a vertex per hole
static bool reserve(dem_mesh *mesh, size_t border)
{
    void *triangles = realloc(mesh->triangles, 3 * (mesh->triangle_count + border) * sizeof *mesh->triangles);
    if (triangles)
        mesh->triangles = triangles;
    void *vertices = realloc(mesh->vertices, (mesh->vertex_count + border / 3) * sizeof *mesh->vertices);
    if (vertices)
        mesh->vertices = vertices;
    return triangles && vertices;
}

static void append(filler *f, uint32_t a, uint32_t b, uint32_t c)
{
    size_t count = f->mesh->triangle_count++;
    memcpy(f->mesh->triangles + 3 * count, (uint32_t[]){a, b, c}, 3 * sizeof a);
    const dem_vec3 *p = f->mesh->vertices;
    dem_vec3 u = v3_sub(p[a], f->centre), v = v3_sub(p[b], f->centre), w = v3_sub(p[c], f->centre);
    f->holes->volume += v3_dot(u, v3_cross(v, w)) / 6;
    f->holes->area += dem_triangle_area(f->mesh, count);
}

// triangles between the vertices i and j of the loop; the pieces on the stack get smaller
static bool append_pieces(filler *f, const uint32_t *loop, size_t n, const uint16_t *best)
{
    uint16_t *stack = dem_alloc(2 * n, sizeof *stack);
    if (!stack)
        return false;
    size_t top = 0;
    stack[top++] = 0;
    stack[top++] = (uint16_t)(n - 1);
    while (top) {
        size_t j = stack[--top], i = stack[--top], k = best[i * n + j];
        append(f, loop[j], loop[k], loop[i]);
        if (k > i + 1) {
            stack[top++] = (uint16_t)i;
            stack[top++] = (uint16_t)k;
        }
        if (j > k + 1) {
            stack[top++] = (uint16_t)k;
            stack[top++] = (uint16_t)j;
        }
    }
    free(stack);
    return true;
}

static bool fill_least_area(filler *f, const uint32_t *loop, size_t n)
{
    double *area = dem_alloc_zero(n * n, sizeof *area);
    uint16_t *best = dem_alloc_zero(n * n, sizeof *best);
    bool fine = area && best;
    const dem_vec3 *p = f->mesh->vertices;
    for (size_t span = 2; fine && span < n; span++)
        for (size_t i = 0; i + span < n; i++) {
            size_t j = i + span;
            dem_vec3 a = p[loop[i]], side = v3_sub(p[loop[j]], a);
            double least = INFINITY;
            for (size_t k = i + 1; k < j; k++) {
                double sum = area[i * n + k] + area[k * n + j] + v3_norm(v3_cross(side, v3_sub(p[loop[k]], a))) / 2;
                if (sum < least) {
                    least = sum;
                    best[i * n + j] = (uint16_t)k;
                }
            }
            area[i * n + j] = least;
        }
    fine = fine && append_pieces(f, loop, n, best);
    free(area);
    free(best);
    return fine;
}

static void fill_fan(filler *f, const uint32_t *loop, size_t n)
{
    dem_vec3 *p = f->mesh->vertices, middle = {0};
    for (size_t i = 0; i < n; i++)
        middle = v3_along(middle, 1 / (double)n, p[loop[i]]);
    uint32_t tip = (uint32_t)f->mesh->vertex_count++;
    p[tip] = middle;
    for (size_t i = 0; i < n; i++)
        append(f, loop[(i + 1) % n], loop[i], tip);
}

static bool fill_loop(filler *f, const uint32_t *loop, size_t n)
{
    if (n < 3)
        return true;  // two borders of one edge: nothing between them
    f->holes->holes++;
    f->holes->edges += n;
    double work = (double)n * (double)n * (double)n, before = f->holes->volume;
    if (n > LARGEST_EXACT || f->work + work > MOST_WORK) {
        fill_fan(f, loop, n);
    } else {
        f->work += work;
        if (!fill_least_area(f, loop, n))
            return false;
    }
    f->holes->share += fabs(f->holes->volume - before);
    return true;
}

// walks one border; where it comes back to a vertex, the part between is a hole of its own
static bool fill_from(filler *f, uint32_t first, uint32_t *place)
{
    f->loop_count = 0;
    uint32_t half = first;
    do {
        f->used[half] = 1;
        uint32_t v = half_start(f->surface->mesh, half);
        if (place[v] != UINT32_MAX) {
            size_t from = place[v];
            if (!fill_loop(f, f->loop + from, f->loop_count - from))
                return false;
            while (f->loop_count > from)
                place[f->loop[--f->loop_count]] = UINT32_MAX;
        }
        place[v] = (uint32_t)f->loop_count;
        f->loop[f->loop_count++] = v;
        half = half_end(f->surface->mesh, half) == half_start(f->surface->mesh, first) ? first : next_border(f, half);
    } while (half != first && half != UINT32_MAX);
    bool closed = half == first;
    for (size_t i = 0; i < f->loop_count; i++)
        place[f->loop[i]] = UINT32_MAX;
    return !closed || fill_loop(f, f->loop, f->loop_count);
}

dem_status dem_surface_fill(const dem_surface *surface, dem_vec3 centre, dem_holes *holes, dem_error *error)
{
    *holes = (dem_holes){0};
    filler f = {.surface = surface, .mesh = surface->mesh, .centre = centre, .holes = holes};
    size_t count = surface->mesh->triangle_count;
    f.used = dem_alloc_zero(3 * count, 1);
    f.loop = dem_alloc(surface->edges.border, sizeof *f.loop);
    uint32_t *place = dem_alloc(surface->mesh->vertex_count, sizeof *place);
    bool fine = f.used && f.loop && place && list_borders(&f) && reserve(f.mesh, f.border_count);
    if (fine)
        memset(place, 0xff, surface->mesh->vertex_count * sizeof *place);
    for (uint32_t h = 0; fine && h < 3 * count; h++)
        if (surface->edges.twin[h] == DEM_EDGE_BORDER && !f.used[h])
            fine = fill_from(&f, h, place);
    free(f.used);
    free(f.loop);
    free(f.border);
    free(place);
    return fine ? DEM_OK : dem_fail_memory(error);
}
