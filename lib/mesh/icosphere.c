#include "mesh/icosphere.h"

#include <stdlib.h>

#include "base/memory.h"
#include "math/vec.h"

typedef struct edge {
    uint32_t low, high;
} edge;

static int compare_edges(const void *a, const void *b)
{
    const edge *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    return (p->high > q->high) - (p->high < q->high);
}

// the edges of the mesh, each once, sorted; returns their number
static size_t list_edges(const dem_mesh *mesh, edge *edges)
{
    size_t count = 0, kept = 0;
    for (size_t t = 0; t < mesh->triangle_count; t++)
        for (size_t k = 0; k < 3; k++) {
            uint32_t a = mesh->triangles[3 * t + k], b = mesh->triangles[3 * t + (k + 1) % 3];
            edges[count++] = a < b ? (edge){a, b} : (edge){b, a};
        }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || compare_edges(&edges[i], &edges[i - 1]) != 0)
            edges[kept++] = edges[i];
    return kept;
}

// the points of a divided mesh: first the old vertices, then those on edges, then those inside triangles
typedef struct division {
    const dem_mesh *mesh;
    edge *edges;
    size_t edge_count, frequency;
} division;

// the step-th point from vertex a towards vertex b
static uint32_t point_on_edge(const division *d, uint32_t a, uint32_t b, size_t step)
{
    edge key = a < b ? (edge){a, b} : (edge){b, a};
    const edge *found = bsearch(&key, d->edges, d->edge_count, sizeof key, compare_edges);
    size_t along = a < b ? step : d->frequency - step;
    return (uint32_t)(d->mesh->vertex_count + (size_t)(found - d->edges) * (d->frequency - 1) + along - 1);
}

// the point i steps from corner 0 towards 1 and j steps towards 2
static uint32_t point_in_triangle(const division *d, size_t triangle, size_t i, size_t j)
{
    const uint32_t *v = &d->mesh->triangles[3 * triangle];
    size_t f = d->frequency;
    if (i + j == 0 || i == f || j == f)
        return v[i == f ? 1 : j == f ? 2 : 0];
    if (j == 0)
        return point_on_edge(d, v[0], v[1], i);
    if (i == 0)
        return point_on_edge(d, v[0], v[2], j);
    if (i + j == f)
        return point_on_edge(d, v[1], v[2], j);
    // rows j = 1, 2, ... hold f - 2, f - 3, ... points
    size_t inside = (j - 1) * (f - 2) - (j - 1) * (j - 2) / 2 + (i - 1);
    size_t first = d->mesh->vertex_count + d->edge_count * (f - 1);
    return (uint32_t)(first + triangle * ((f - 1) * (f - 2) / 2) + inside);
}

static void place_points(const division *d, dem_vec3 *points)
{
    const dem_vec3 *v = d->mesh->vertices;
    size_t f = d->frequency;
    for (size_t i = 0; i < d->mesh->vertex_count; i++)
        points[i] = v[i];
    for (size_t e = 0; e < d->edge_count; e++)
        for (size_t k = 1; k < f; k++) {
            double s = (double)k / (double)f;
            dem_vec3 low = v3_scale(v[d->edges[e].low], 1 - s);
            points[d->mesh->vertex_count + e * (f - 1) + k - 1] = v3_along(low, s, v[d->edges[e].high]);
        }
    for (size_t t = 0; t < d->mesh->triangle_count; t++) {
        const uint32_t *corner = &d->mesh->triangles[3 * t];
        for (size_t j = 1; j + 1 < f; j++)
            for (size_t i = 1; i + j < f; i++) {
                double s = (double)i / (double)f, r = (double)j / (double)f;
                dem_vec3 p = v3_along(v3_scale(v[corner[0]], 1 - s - r), s, v[corner[1]]);
                points[point_in_triangle(d, t, i, j)] = v3_along(p, r, v[corner[2]]);
            }
    }
}

static void put_triangle(uint32_t **at, uint32_t a, uint32_t b, uint32_t c)
{
    (*at)[0] = a;
    (*at)[1] = b;
    (*at)[2] = c;
    *at += 3;
}

static void place_triangles(const division *d, uint32_t *at)
{
    size_t f = d->frequency;
    for (size_t t = 0; t < d->mesh->triangle_count; t++)
        for (size_t j = 0; j < f; j++)
            for (size_t i = 0; i + j < f; i++) {
                uint32_t right = point_in_triangle(d, t, i + 1, j), up = point_in_triangle(d, t, i, j + 1);
                put_triangle(&at, point_in_triangle(d, t, i, j), right, up);
                if (i + j + 1 < f)
                    put_triangle(&at, right, point_in_triangle(d, t, i + 1, j + 1), up);
            }
}

dem_status dem_mesh_divide(const dem_mesh *mesh, size_t frequency, dem_mesh *divided, dem_error *error)
{
    DEM_ASSERT(frequency > 0);
    *divided = (dem_mesh){0};
    edge *edges = dem_alloc(3 * mesh->triangle_count, sizeof *edges);
    if (!edges)
        return dem_fail_memory(error);
    division d = {mesh, edges, list_edges(mesh, edges), frequency};
    divided->vertex_count = mesh->vertex_count + d.edge_count * (frequency - 1);
    if (frequency > 2)
        divided->vertex_count += mesh->triangle_count * ((frequency - 1) * (frequency - 2) / 2);
    divided->triangle_count = mesh->triangle_count * frequency * frequency;
    DEM_ASSERT(divided->vertex_count < UINT32_MAX);
    divided->vertices = dem_alloc(divided->vertex_count, sizeof *divided->vertices);
    divided->triangles = dem_alloc(3 * divided->triangle_count, sizeof *divided->triangles);
    dem_status status = DEM_OK;
    if (divided->vertices && divided->triangles) {
        place_points(&d, divided->vertices);
        place_triangles(&d, divided->triangles);
    } else {
        dem_mesh_free(divided);
        status = dem_fail_memory(error);
    }
    free(edges);
    return status;
}

dem_status dem_icosphere(size_t frequency, dem_mesh *sphere, dem_error *error)
{
    const double g = 1.6180339887498949;  // golden ratio; the corners of three golden rectangles
    dem_vec3 corners[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                            {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    uint32_t faces[60] = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                          4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                          6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    dem_mesh icosahedron = {.vertices = corners, .triangles = faces, .vertex_count = 12, .triangle_count = 20};
    DEM_TRY(dem_mesh_divide(&icosahedron, frequency, sphere, error));
    for (size_t i = 0; i < sphere->vertex_count; i++)
        sphere->vertices[i] = v3_unit(sphere->vertices[i]);
    return DEM_OK;
}

size_t dem_icosphere_frequency(size_t triangles)
{
    size_t half = (size_t)(sqrt((double)triangles / 80) + 0.5);
    return half > 1 ? 2 * half : 2;
}
