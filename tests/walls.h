/// Meshes for tests of walls: sheets, grooves, drums, and what a ball feels there.
#ifndef DEM_TESTS_WALLS_H
#define DEM_TESTS_WALLS_H

#include "shapes.h"

#include "base/random.h"
#include "sim/mesh_wall.h"

/// The rectangle that the coordinates span in z = 0, facing +z, two triangles to a cell. `pattern` tells the diagonals:
/// 0 rising, 1 falling, 2 in turns.
static inline dem_mesh wall_sheet(const double *xs, uint32_t nx, const double *ys, uint32_t ny, int pattern)
{
    size_t cells = (size_t)(nx - 1) * (ny - 1);
    dem_mesh mesh = {.vertices = malloc((size_t)nx * ny * sizeof *mesh.vertices),
                     .triangles = malloc(6 * cells * sizeof *mesh.triangles)};
    check(mesh.vertices && mesh.triangles);
    for (uint32_t i = 0; i < nx; i++)
        for (uint32_t j = 0; j < ny; j++)
            mesh.vertices[mesh.vertex_count++] = v3(xs[i], ys[j], 0);
    for (uint32_t i = 0; i + 1 < nx; i++)
        for (uint32_t j = 0; j + 1 < ny; j++) {
            uint32_t a = i * ny + j, b = a + ny, c = b + 1, d = a + 1;
            bool falling = pattern == 1 || (pattern == 2 && (i + j) % 2);
            const uint32_t rising_cell[6] = {a, b, c, a, c, d}, falling_cell[6] = {a, b, d, b, c, d};
            memcpy(&mesh.triangles[3 * mesh.triangle_count], falling ? falling_cell : rising_cell, sizeof rising_cell);
            mesh.triangle_count += 2;
        }
    return mesh;
}

/// Corners a, b, c, d of a rectangle, facing (b - a) x (d - a).
static inline dem_mesh wall_quad(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 d)
{
    return shape_copy((dem_vec3[]){a, b, c, d}, 4, (const uint32_t[]){0, 1, 2, 0, 2, 3}, 2);
}

/// Appends the second mesh and frees it.
static inline dem_mesh wall_join(dem_mesh mesh, dem_mesh other)
{
    shape_append(&mesh, &other, 0, other.triangle_count);
    dem_mesh_free(&other);
    return mesh;
}

/// A 90 degree groove along y: the planes z = 0 and x = 0 from 0 to 4.
static inline dem_mesh wall_groove(void)
{
    return wall_join(wall_quad(v3(0, -4, 0), v3(4, -4, 0), v3(4, 4, 0), v3(0, 4, 0)),
                     wall_quad(v3(0, -4, 0), v3(0, 4, 0), v3(0, 4, 4), v3(0, -4, 4)));
}

/// The inside of a drum of radius 1 along y with `facets` flat facets.
static inline dem_mesh wall_drum(int facets)
{
    dem_mesh mesh = {0};
    for (int i = 0; i < facets; i++) {
        double t = 2 * DEM_PI * i / facets, u = 2 * DEM_PI * ((i + 1) % facets) / facets;
        mesh = wall_join(mesh, wall_quad(v3(cos(t), -1, sin(t)), v3(cos(t), 1, sin(t)), v3(cos(u), 1, sin(u)),
                                         v3(cos(u), -1, sin(u))));
    }
    return mesh;
}

/// Every triangle divided into four; frees the mesh.
static inline dem_mesh wall_refined(dem_mesh mesh)
{
    dem_mesh fine = {.vertices = malloc(6 * mesh.triangle_count * sizeof *fine.vertices),
                     .triangles = malloc(12 * mesh.triangle_count * sizeof *fine.triangles)};
    static const uint32_t parts[12] = {0, 3, 5, 3, 1, 4, 5, 4, 2, 3, 4, 5};
    check(fine.vertices && fine.triangles);
    for (size_t i = 0; i < mesh.triangle_count; i++) {
        uint32_t base = (uint32_t)fine.vertex_count;
        dem_vec3 *v = &fine.vertices[base];
        for (int k = 0; k < 3; k++)
            v[k] = mesh.vertices[mesh.triangles[3 * i + (size_t)k]];
        for (int k = 0; k < 3; k++)
            v[3 + k] = v3_scale(v3_add(v[k], v[(k + 1) % 3]), 0.5);
        for (int k = 0; k < 12; k++)
            fine.triangles[3 * fine.triangle_count + (size_t)k] = base + parts[k];
        fine.vertex_count += 6;
        fine.triangle_count += 4;
    }
    dem_mesh_free(&mesh);
    return fine;
}

/// The wall of a mesh, which is freed. Skips the test without Embree.
static inline dem_mesh_wall *wall_of(dem_mesh mesh)
{
    dem_mesh_wall *wall = NULL;
    dem_error error;
    if (DEM_EMBREE)
        check_ok(dem_mesh_wall_create(NULL, &mesh, "test", &wall, &error), error);
    dem_mesh_free(&mesh);
    if (!DEM_EMBREE)
        skip();
    return wall;
}

static inline void wall_check_contacts_(const dem_mesh_contact *contacts, int count, dem_vec3 centre, double radius)
{
    for (int i = 0; i < count; i++) {
        const dem_mesh_contact *c = &contacts[i];
        check(c->distance >= 0 && c->distance <= radius);
        check(i == 0 || c->distance >= contacts[i - 1].distance);
        check_near(v3_norm(c->normal), 1, 1e-15);
        check_near(v3_norm(c->offset), c->distance, 1e-15 * radius);
        check_vec(c->point, v3_add(centre, c->offset), 0);
        if (c->distance > 1e-9 * radius)
            check_vec(v3_scale(c->normal, -c->distance), c->offset, 1e-15 * radius);
    }
}

/// The contacts of a ball. More candidates, in reverse, and each twice change no bit.
static inline int wall_touch(const dem_mesh_wall *wall, dem_vec3 centre, double radius, dem_mesh_contact *contacts)
{
    dem_ray_list list = {0};
    dem_mesh_contact again[DEM_MESH_CONTACTS];
    check(dem_mesh_wall_near(wall, centre, radius, &list));
    int count = dem_mesh_wall_contacts(wall, list.items, list.count, centre, radius, contacts, DEM_MESH_CONTACTS);
    wall_check_contacts_(contacts, count, centre, radius);
    check(dem_mesh_wall_near(wall, centre, 1.3 * radius, &list));
    size_t n = list.count;
    uint32_t *ids = malloc((2 * n + 1) * sizeof *ids);
    check(ids != NULL);
    for (size_t i = 0; i < n; i++)
        ids[i] = ids[n + i] = list.items[n - 1 - i];
    int count_again = dem_mesh_wall_contacts(wall, ids, 2 * n, centre, radius, again, DEM_MESH_CONTACTS);
    check(count_again == count && memcmp(again, contacts, (size_t)count * sizeof *contacts) == 0);
    free(ids);
    free(list.items);
    return count;
}

/// The force of springs of stiffness 1 at the contacts [m].
static inline dem_vec3 wall_push(const dem_mesh_contact *contacts, int count, double radius)
{
    dem_vec3 sum = {0, 0, 0};
    for (int i = 0; i < count; i++)
        sum = v3_along(sum, radius - contacts[i].distance, contacts[i].normal);
    return sum;
}

static inline dem_vec3 wall_push_at(const dem_mesh_wall *wall, dem_vec3 centre, double radius)
{
    dem_mesh_contact contacts[DEM_MESH_CONTACTS];
    return wall_push(contacts, wall_touch(wall, centre, radius, contacts), radius);
}

static inline dem_quat random_turn(dem_random *r)
{
    double w = random_normal(r), x = random_normal(r), y = random_normal(r), z = random_normal(r);
    return quat_unit((dem_quat){w, x, y, z});
}

/// In the cube from -1 to 1.
static inline dem_vec3 random_point(dem_random *r)
{
    double x = random_uniform(r), y = random_uniform(r), z = random_uniform(r);
    return v3(2 * x - 1, 2 * y - 1, 2 * z - 1);
}

#endif
