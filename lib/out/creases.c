#include "out/creases.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/vec.h"

#define CREASE_COSINE 0.88  // 28 degrees

// an edge as its ends, the smaller one first, and a triangle it belongs to
typedef struct edge {
    dem_vec3 ends[2];
    uint32_t triangle;
    unsigned char corner;  // opposite
} edge;

static int compare_points(const dem_vec3 *a, const dem_vec3 *b)
{
    for (int k = 0; k < 3; k++) {
        double x = v3_get(*a, k), y = v3_get(*b, k);
        if (x != y)
            return x < y ? -1 : 1;
    }
    return 0;
}

static int compare_places(const edge *a, const edge *b)
{
    int first = compare_points(&a->ends[0], &b->ends[0]);
    return first ? first : compare_points(&a->ends[1], &b->ends[1]);
}

static int compare_edges(const void *a, const void *b)
{
    const edge *p = a, *q = b;
    int places = compare_places(p, q);
    return places ? places : (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

static dem_vec3 corner(const dem_mesh *mesh, size_t t, int k)
{
    return mesh->vertices[mesh->triangles[3 * t + (size_t)k]];
}

static dem_vec3 normal(const dem_mesh *mesh, size_t t)
{
    dem_vec3 a = corner(mesh, t, 0);
    return v3_unit(v3_cross(v3_sub(corner(mesh, t, 1), a), v3_sub(corner(mesh, t, 2), a)));
}

static void list_edges(const dem_mesh *mesh, edge *edges)
{
    for (size_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            dem_vec3 a = corner(mesh, t, (k + 1) % 3), b = corner(mesh, t, (k + 2) % 3);
            bool swap = compare_points(&a, &b) > 0;
            edges[3 * t + (size_t)k] = (edge){{swap ? b : a, swap ? a : b}, (uint32_t)t, (unsigned char)k};
        }
}

unsigned char *dem_mesh_creases(const dem_mesh *mesh)
{
    size_t count = 3 * mesh->triangle_count;
    unsigned char *creases = dem_alloc_zero(mesh->triangle_count, 1);
    edge *edges = dem_alloc(count, sizeof *edges);
    if (!creases || !edges) {
        free(creases);
        free(edges);
        return NULL;
    }
    list_edges(mesh, edges);
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && compare_places(&edges[begin], &edges[end]) == 0; end++)
            ;
        bool smooth = end - begin == 2 && v3_dot(normal(mesh, edges[begin].triangle),
                                                 normal(mesh, edges[begin + 1].triangle)) > CREASE_COSINE;
        for (size_t i = begin; i < end && !smooth; i++)
            creases[edges[i].triangle] |= (unsigned char)(1 << edges[i].corner);
    }
    free(edges);
    return creases;
}
