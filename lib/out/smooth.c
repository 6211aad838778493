#include "out/smooth.h"

#include <stdlib.h>

#include "base/memory.h"
#include "math/vec.h"

// normals farther apart than this belong to different faces of a solid
#define CREASE_COSINE 0.88  // 28 degrees

enum { MANY = 100 };  // triangles about one vertex: a fan, whose normals are not worth their square

typedef struct corners {
    const dem_mesh *mesh;
    dem_vec3 *normals;  // of triangles; zero where there is no area
    size_t *begins;     // of each vertex in `lists`, and one more
    uint32_t *lists;    // corners about a vertex
} corners;

static dem_vec3 vertex(const dem_mesh *mesh, size_t corner)
{
    return mesh->vertices[mesh->triangles[corner]];
}

static dem_vec3 triangle_normal(const dem_mesh *mesh, size_t t)
{
    dem_vec3 a = vertex(mesh, 3 * t);
    dem_vec3 n = v3_cross(v3_sub(vertex(mesh, 3 * t + 1), a), v3_sub(vertex(mesh, 3 * t + 2), a));
    double size = v3_norm(n);
    return size > 0 ? v3_scale(n, 1 / size) : v3(0, 0, 0);
}

static double corner_angle(const dem_mesh *mesh, size_t corner)
{
    size_t t = corner / 3 * 3;
    dem_vec3 at = vertex(mesh, corner);
    dem_vec3 u = v3_sub(vertex(mesh, t + (corner + 1 - t) % 3), at),
             v = v3_sub(vertex(mesh, t + (corner + 2 - t) % 3), at);
    return atan2(v3_norm(v3_cross(u, v)), v3_dot(u, v));
}

static void list_corners(corners *c)
{
    const dem_mesh *mesh = c->mesh;
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
        c->begins[mesh->triangles[i] + 1]++;
    for (size_t v = 0; v < mesh->vertex_count; v++)
        c->begins[v + 1] += c->begins[v];
    // fills each list from its end; afterwards begins[v] is where it should be
    for (size_t i = 3 * mesh->triangle_count; i-- > 0;)
        c->lists[--c->begins[mesh->triangles[i] + 1]] = (uint32_t)i;
    for (size_t v = 0; v < mesh->vertex_count; v++)
        c->begins[v] = c->begins[v + 1];
    c->begins[mesh->vertex_count] = 3 * mesh->triangle_count;
}

static dem_vec3 smooth_normal(const corners *c, size_t corner)
{
    dem_vec3 own = c->normals[corner / 3], sum = {0};
    uint32_t v = c->mesh->triangles[corner];
    if (c->begins[v + 1] - c->begins[v] > MANY)
        return own;
    for (size_t i = c->begins[v]; i < c->begins[v + 1]; i++) {
        dem_vec3 other = c->normals[c->lists[i] / 3];
        if (v3_dot(own, other) > CREASE_COSINE)
            sum = v3_along(sum, corner_angle(c->mesh, c->lists[i]), other);
    }
    return v3_norm2(sum) > 0 ? v3_unit(sum) : own;
}

float *dem_mesh_corner_normals(const dem_mesh *mesh)
{
    size_t count = mesh->triangle_count;
    corners c = {.mesh = mesh,
                 .normals = dem_alloc(count, sizeof *c.normals),
                 .begins = dem_alloc_zero(mesh->vertex_count + 2, sizeof *c.begins),
                 .lists = dem_alloc(3 * count, sizeof *c.lists)};
    float *result = dem_alloc(9 * count, sizeof *result);
    if (c.normals && c.begins && c.lists && result) {
        for (size_t t = 0; t < count; t++)
            c.normals[t] = triangle_normal(mesh, t);
        list_corners(&c);
        for (size_t i = 0; i < 3 * count; i++) {
            dem_vec3 n = smooth_normal(&c, i);
            result[3 * i] = (float)n.x;
            result[3 * i + 1] = (float)n.y;
            result[3 * i + 2] = (float)n.z;
        }
    } else {
        free(result);
        result = NULL;
    }
    free(c.normals);
    free(c.begins);
    free(c.lists);
    return result;
}
