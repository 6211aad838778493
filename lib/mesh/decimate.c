// Decimation: edge collapse by meshoptimizer, about 1 us per triangle. Huge meshes are first thinned by merging the
// vertices of each cell of a grid into their mean (Rossignac & Borrel 1993).
#include "mesh/decimate.h"

#include <stdlib.h>
#include <string.h>

#include <meshoptimizer.h>

#include "base/memory.h"
#include "mesh/mass.h"
#include "mesh/weld.h"

enum { THIN_ABOVE = 50000, THIN_FACTOR = 12, CELLS = 1 << 20 };
static const float ANY_ERROR = 1e9f;
static const double MOST_GROWTH = 0.1;

typedef struct cell_map {
    uint64_t *keys;    // 0: free
    uint32_t *numbers;
    size_t mask, count;
} cell_map;

static uint32_t cell_number(cell_map *map, uint64_t key)
{
    size_t at = (size_t)((key * 0x9e3779b97f4a7c15u) >> 20) & map->mask;
    while (map->keys[at] && map->keys[at] != key)
        at = (at + 1) & map->mask;
    if (!map->keys[at]) {
        map->keys[at] = key;
        map->numbers[at] = (uint32_t)map->count++;
    }
    return map->numbers[at];
}

// edge of the grid's cells: a surface of area A leaves about 2 A / h^2 triangles
static double cell_size(const dem_mesh *mesh, size_t triangles)
{
    double area = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles + 3 * i;
        dem_vec3 a = mesh->vertices[t[0]];
        area += v3_norm(v3_cross(v3_sub(mesh->vertices[t[1]], a), v3_sub(mesh->vertices[t[2]], a))) / 2;
    }
    return fmax(sqrt(2 * area / (double)triangles), box_diagonal(dem_mesh_box(mesh)) / (CELLS - 2));
}

static void merge_cells(dem_mesh *mesh, cell_map *map, uint32_t *number, dem_vec3 *sums, double *weights, double size)
{
    dem_vec3 low = dem_mesh_box(mesh).low;
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        uint32_t v = mesh->triangles[i];
        if (number[v] == UINT32_MAX) {
            dem_vec3 p = v3_scale(v3_sub(mesh->vertices[v], low), 1 / size);
            uint64_t key = 1 + (uint64_t)p.x + ((uint64_t)p.y << 21) + ((uint64_t)p.z << 42);
            uint32_t cell = number[v] = cell_number(map, key);
            sums[cell] = v3_add(sums[cell], mesh->vertices[v]);
            weights[cell]++;
        }
        mesh->triangles[i] = number[v];
    }
    for (size_t i = 0; i < map->count; i++)
        mesh->vertices[i] = v3_scale(sums[i], 1 / weights[i]);
    mesh->vertex_count = map->count;
    dem_mesh_drop_collapsed(mesh);
}

// in place, to about `triangles`
static dem_status thin(dem_mesh *mesh, size_t triangles, dem_error *error)
{
    cell_map map = {.mask = 1023};
    while (map.mask < 2 * mesh->vertex_count)
        map.mask = 2 * map.mask + 1;
    map.keys = dem_alloc_zero(map.mask + 1, sizeof *map.keys);
    map.numbers = dem_alloc(map.mask + 1, sizeof *map.numbers);
    uint32_t *number = dem_alloc(mesh->vertex_count, sizeof *number);
    dem_vec3 *sums = dem_alloc_zero(mesh->vertex_count, sizeof *sums);
    double *weights = dem_alloc_zero(mesh->vertex_count, sizeof *weights);
    int *layers = dem_alloc(mesh->triangle_count, sizeof *layers);
    bool fine = map.keys && map.numbers && number && sums && weights && layers;
    if (fine) {
        memset(number, 0xff, mesh->vertex_count * sizeof *number);
        merge_cells(mesh, &map, number, sums, weights, cell_size(mesh, triangles));
        fine = dem_mesh_merge_layers(mesh, layers);  // folds that came to lie on each other
    }
    free(map.keys);
    free(map.numbers);
    free(number);
    free(sums);
    free(weights);
    free(layers);
    return fine ? DEM_OK : dem_fail_memory(error);
}

static void move(dem_mesh *mesh, dem_vec3 shift, double factor)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->vertices[i] = v3_scale(v3_add(mesh->vertices[i], shift), factor);
}

// in place, to `triangles` or as near as its holes allow
static dem_status collapse(dem_mesh *mesh, size_t triangles, dem_error *error)
{
    float *vertices = dem_alloc(3 * mesh->vertex_count, sizeof *vertices);
    uint32_t *few = dem_alloc(3 * mesh->triangle_count, sizeof *few);
    if (!vertices || !few) {
        free(vertices);
        free(few);
        return dem_fail_memory(error);
    }
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            vertices[3 * i + (size_t)k] = (float)v3_get(mesh->vertices[i], k);
    size_t corners = meshopt_simplify(few, mesh->triangles, 3 * mesh->triangle_count, vertices, mesh->vertex_count,
                                      3 * sizeof *vertices, 3 * triangles, ANY_ERROR, 0, NULL);
    free(vertices);
    free(mesh->triangles);
    mesh->triangles = few;
    mesh->triangle_count = corners / 3;
    size_t unused;
    return dem_mesh_compact(mesh, &unused, error);
}

// corners of the surface stay where they are, so a round one has lost a little
static void give_volume(dem_mesh *mesh, const dem_solid *want)
{
    dem_solid now = dem_mesh_solid(mesh);
    double factor = cbrt(want->volume / now.volume);
    if (!(fabs(factor - 1) < MOST_GROWTH))
        return;  // it encloses nothing
    move(mesh, v3_scale(now.centre, -1), factor);
    move(mesh, want->centre, 1);
}

dem_status dem_mesh_decimate(const dem_mesh *mesh, size_t triangles, dem_mesh *out, dem_error *error)
{
    *out = (dem_mesh){0};
    dem_mesh work;
    DEM_TRY(dem_mesh_copy(mesh, &work, error));
    if (mesh->triangle_count <= triangles) {
        *out = work;
        return DEM_OK;
    }
    // about its middle and of size 1, so that every grain is collapsed in the same way
    dem_box box = dem_mesh_box(&work);
    dem_vec3 middle = v3_along(box.low, 0.5, v3_sub(box.high, box.low));
    double size = box_diagonal(box);
    move(&work, v3_scale(middle, -1), 1 / size);
    dem_solid solid = dem_mesh_solid(&work);
    dem_status status = DEM_OK;
    if (work.triangle_count > THIN_ABOVE + THIN_FACTOR * triangles)
        status = thin(&work, THIN_FACTOR * triangles, error);
    if (status == DEM_OK)
        status = collapse(&work, triangles, error);
    if (status != DEM_OK) {
        dem_mesh_free(&work);
        return status;
    }
    give_volume(&work, &solid);
    move(&work, v3_scale(middle, 1 / size), size);
    *out = work;
    return DEM_OK;
}
