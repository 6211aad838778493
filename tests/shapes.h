/// Closed meshes for tests, made in code: known by construction, welded, outward-oriented.
#ifndef DEM_TESTS_SHAPES_H
#define DEM_TESTS_SHAPES_H

#include "check.h"

#include "math/quat.h"

static inline dem_mesh shape_copy(const dem_vec3 *vertices, size_t vertex_count, const uint32_t *triangles,
                                  size_t triangle_count)
{
    dem_mesh mesh = {.vertex_count = vertex_count, .triangle_count = triangle_count};
    mesh.vertices = malloc((vertex_count + 1) * sizeof *mesh.vertices);
    mesh.triangles = malloc((3 * triangle_count + 1) * sizeof *mesh.triangles);
    check(mesh.vertices && mesh.triangles);
    memcpy(mesh.vertices, vertices, vertex_count * sizeof *vertices);
    memcpy(mesh.triangles, triangles, 3 * triangle_count * sizeof *triangles);
    return mesh;
}

/// Box from 0 to (x, y, z), 12 triangles.
static inline dem_mesh shape_box(double x, double y, double z)
{
    static const uint32_t faces[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                       2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    dem_vec3 corners[8];
    for (int i = 0; i < 8; i++)
        corners[i] = v3(i & 1 ? x : 0, i & 2 ? y : 0, i & 4 ? z : 0);
    return shape_copy(corners, 8, faces, 12);
}

static inline dem_mesh shape_tetrahedron(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 d)
{
    static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    return shape_copy((dem_vec3[]){a, b, c, d}, 4, faces, 4);
}

// index of the lattice point (i, j, k), |i| + |j| + |k| = n, given once
static inline uint32_t shape_lattice_(dem_mesh *mesh, uint32_t *table, int n, int i, int j, int k)
{
    size_t at = ((size_t)(i + n) * (size_t)(2 * n + 1) + (size_t)(j + n)) * 2 + (k < 0);
    if (table[at] == 0) {
        mesh->vertices[mesh->vertex_count] = v3_unit(v3(i, j, k));
        table[at] = (uint32_t)++mesh->vertex_count;
    }
    return table[at] - 1;
}

/// Unit sphere: an octahedron whose edges are divided in n, 8 n^2 triangles, 4 n^2 + 2 vertices.
static inline dem_mesh shape_sphere(int n)
{
    size_t count = (size_t)n * (size_t)n;
    dem_mesh mesh = {.vertices = malloc((4 * count + 2) * sizeof *mesh.vertices),
                     .triangles = malloc(24 * count * sizeof *mesh.triangles)};
    uint32_t *table = calloc((size_t)(2 * n + 1) * (size_t)(2 * n + 1) * 2, sizeof *table);
    check(mesh.vertices && mesh.triangles && table);
    for (int octant = 0; octant < 8; octant++) {
        int sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n - i; j++)
                for (int up = 0; up < (i + j + 1 < n ? 2 : 1); up++) {
                    int at[3][2] = {{i + 1, j}, {i, j + 1}, {i, j}};
                    if (up)
                        at[2][0] = i + 1, at[2][1] = j + 1;
                    uint32_t *t = mesh.triangles + 3 * mesh.triangle_count++;
                    bool flip = (sx * sy * sz < 0) != (up == 1);
                    for (int c = 0; c < 3; c++) {
                        int a = at[c][0], b = at[c][1];
                        t[flip ? 2 - c : c] = shape_lattice_(&mesh, table, n, sx * a, sy * b, sz * (n - a - b));
                    }
                }
    }
    free(table);
    return mesh;
}

/// A triaxial grain with no symmetry, about 2 x 1.6 x 1.2.
static inline dem_mesh shape_grain(int n)
{
    dem_mesh mesh = shape_sphere(n);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        dem_vec3 u = mesh.vertices[i];
        double r = 1 + 0.2 * u.x - 0.12 * u.y * u.z + 0.08 * u.x * u.y * u.y;
        mesh.vertices[i] = v3(r * u.x, 0.8 * r * u.y, 0.6 * r * u.z);
    }
    return mesh;
}

/// x -> R x + shift
static inline void shape_move(dem_mesh *mesh, dem_quat rotation, dem_vec3 shift)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->vertices[i] = v3_add(quat_rotate(rotation, mesh->vertices[i]), shift);
}

static inline void shape_scale(dem_mesh *mesh, double x, double y, double z)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->vertices[i] = v3(mesh->vertices[i].x * x, mesh->vertices[i].y * y, mesh->vertices[i].z * z);
}

static inline void shape_flip(dem_mesh *mesh, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i++) {
        uint32_t swap = mesh->triangles[3 * i];
        mesh->triangles[3 * i] = mesh->triangles[3 * i + 1];
        mesh->triangles[3 * i + 1] = swap;
    }
}

/// Adds the triangles [begin, end) of `other` with vertices of their own; `other` stays as it is.
static inline void shape_append(dem_mesh *mesh, const dem_mesh *other, size_t begin, size_t end)
{
    size_t vertices = mesh->vertex_count + other->vertex_count, triangles = mesh->triangle_count + end - begin;
    mesh->vertices = realloc(mesh->vertices, vertices * sizeof *mesh->vertices);
    mesh->triangles = realloc(mesh->triangles, 3 * triangles * sizeof *mesh->triangles);
    check(mesh->vertices && mesh->triangles);
    memcpy(mesh->vertices + mesh->vertex_count, other->vertices, other->vertex_count * sizeof *other->vertices);
    for (size_t i = 3 * begin; i < 3 * end; i++)
        mesh->triangles[3 * mesh->triangle_count + i - 3 * begin] = other->triangles[i] + (uint32_t)mesh->vertex_count;
    mesh->vertex_count = vertices;
    mesh->triangle_count = triangles;
}

#endif
