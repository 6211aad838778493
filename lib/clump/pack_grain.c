#include "clump/pack_grain.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/mat3.h"
#include "math/quat.h"

// A tree takes about 100 bytes per triangle. It only serves medial balls and clearances, for which surface detail
// below a hundredth of d_eq is noise, so a larger mesh is replaced by its vertices clustered on a grid.
enum { MOST_TREE_TRIANGLES = 100000, MOST_CELLS = 100000, CELL_SLOTS = 1 << 18, DISTANCE_SAMPLES = 50000 };

// no axis is within 20 degrees of a coordinate plane's normal, nor of the diagonals
static const dem_quat turn = {0.8342, 0.3137, -0.3714, 0.2621};

static dem_quat unit_turn(void)
{
    return quat_unit(turn);
}

dem_vec3 dem_pack_grain_enter(const dem_pack_grain *grain, dem_vec3 point)
{
    return quat_rotate(unit_turn(), v3_scale(v3_sub(point, grain->centre), 1 / grain->size));
}

dem_ball dem_pack_grain_leave(const dem_pack_grain *grain, dem_ball ball)
{
    dem_vec3 centre = v3_along(grain->centre, grain->size, quat_unrotate(unit_turn(), ball.centre));
    return (dem_ball){centre, ball.radius * grain->size};
}

void dem_pack_grain_corners(const dem_pack_grain *grain, size_t triangle, dem_vec3 corners[3])
{
    for (int k = 0; k < 3; k++)
        corners[k] = dem_pack_grain_enter(grain, grain->mesh->vertices[grain->mesh->triangles[3 * triangle + (size_t)k]]);
}

// exact moments in the packer's frame: those about the mesh's centroid, scaled and turned
static void set_moments(dem_pack_grain *grain)
{
    dem_moments m = dem_mesh_moments(grain->mesh, grain->centre);
    double s = 1 / grain->size, volume = s * s * s;
    dem_sym3 a = sym3_scale(m.second, volume * s * s);
    dem_quat q = unit_turn();
    dem_vec3 x = quat_unrotate(q, v3(1, 0, 0)), y = quat_unrotate(q, v3(0, 1, 0)), z = quat_unrotate(q, v3(0, 0, 1));
    grain->moments.volume = m.volume * volume;
    grain->moments.first = quat_rotate(q, v3_scale(m.first, volume * s));
    dem_vec3 ax = sym3_apply(a, x), ay = sym3_apply(a, y), az = sym3_apply(a, z);
    grain->moments.second = (dem_sym3){v3_dot(x, ax), v3_dot(y, ay), v3_dot(z, az),
                                       v3_dot(x, ay), v3_dot(x, az), v3_dot(y, az)};
}

static dem_status copy_turned(dem_pack_grain *grain, dem_error *error)
{
    const dem_mesh *mesh = grain->mesh;
    dem_mesh *shell = &grain->shell;
    shell->vertices = dem_alloc(mesh->vertex_count, sizeof *shell->vertices);
    shell->triangles = dem_alloc(mesh->triangle_count, 3 * sizeof *shell->triangles);
    if (!shell->vertices || !shell->triangles)
        return dem_fail_memory(error);
    shell->vertex_count = mesh->vertex_count;
    shell->triangle_count = mesh->triangle_count;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        shell->vertices[i] = dem_pack_grain_enter(grain, mesh->vertices[i]);
    memcpy(shell->triangles, mesh->triangles, 3 * mesh->triangle_count * sizeof *shell->triangles);
    return DEM_OK;
}

// occupied cells of a grid, by open addressing
typedef struct cell_map {
    uint64_t *keys;      // 0: free
    uint32_t *ids;
    dem_vec3 *sums;      // of the points in a cell
    uint32_t *counts;
    uint32_t cell_count;
    double cell;
    dem_vec3 low;
} cell_map;

static uint64_t cell_key(const cell_map *map, dem_vec3 p)
{
    uint64_t i = (uint64_t)((p.x - map->low.x) / map->cell), j = (uint64_t)((p.y - map->low.y) / map->cell),
             k = (uint64_t)((p.z - map->low.z) / map->cell);
    return 1 + (i | j << 20 | k << 40);
}

// the cell's number; false: the map is full
static bool cell_find(cell_map *map, dem_vec3 p, uint32_t *id)
{
    uint64_t key = cell_key(map, p);
    uint64_t slot = (key * 0x9e3779b97f4a7c15u) >> 46;
    for (; map->keys[slot] != key; slot = (slot + 1) % CELL_SLOTS)
        if (!map->keys[slot]) {
            if (map->cell_count == MOST_CELLS)
                return false;
            map->keys[slot] = key;
            map->ids[slot] = map->cell_count;
            map->sums[map->cell_count] = v3(0, 0, 0);
            map->counts[map->cell_count++] = 0;
            break;
        }
    *id = map->ids[slot];
    return true;
}

// all vertices of the mesh into cells; false: more cells than the map can take
static bool fill_cells(const dem_pack_grain *grain, cell_map *map)
{
    map->cell_count = 0;
    for (size_t i = 0; i < CELL_SLOTS; i++)
        map->keys[i] = 0;
    for (size_t i = 0; i < 3 * grain->mesh->triangle_count; i++) {
        dem_vec3 p = dem_pack_grain_enter(grain, grain->mesh->vertices[grain->mesh->triangles[i]]);
        uint32_t id;
        if (!cell_find(map, p, &id))
            return false;
        map->sums[id] = v3_add(map->sums[id], p);
        map->counts[id]++;
    }
    return true;
}

static dem_status take_triangles(dem_pack_grain *grain, cell_map *map, dem_error *error)
{
    dem_mesh *shell = &grain->shell;
    size_t capacity = 0;
    shell->vertices = dem_alloc(map->cell_count, sizeof *shell->vertices);
    if (!shell->vertices)
        return dem_fail_memory(error);
    shell->vertex_count = map->cell_count;
    for (uint32_t i = 0; i < map->cell_count; i++)
        shell->vertices[i] = v3_scale(map->sums[i], 1.0 / map->counts[i]);
    for (size_t t = 0; t < grain->mesh->triangle_count; t++) {
        dem_vec3 corners[3];
        uint32_t id[3] = {0, 0, 0};
        dem_pack_grain_corners(grain, t, corners);
        for (int k = 0; k < 3; k++)
            cell_find(map, corners[k], &id[k]);
        if (id[0] == id[1] || id[1] == id[2] || id[2] == id[0])
            continue;
        if (!dem_grow(&shell->triangles, &capacity, shell->triangle_count, 3 * sizeof *shell->triangles))
            return dem_fail_memory(error);
        for (size_t k = 0; k < 3; k++)
            shell->triangles[3 * shell->triangle_count + k] = id[k];
        shell->triangle_count++;
    }
    return DEM_OK;
}

// vertex clustering (Rossignac & Borrel 1993), streaming: one mean point per occupied cell, the triangles that
// still have three corners
static dem_status cluster(dem_pack_grain *grain, dem_error *error)
{
    cell_map map = {.low = grain->box.low};
    dem_status status = DEM_OK;
    map.keys = dem_alloc(CELL_SLOTS, sizeof *map.keys);
    map.ids = dem_alloc(CELL_SLOTS, sizeof *map.ids);
    map.sums = dem_alloc(MOST_CELLS, sizeof *map.sums);
    map.counts = dem_alloc(MOST_CELLS, sizeof *map.counts);
    if (!map.keys || !map.ids || !map.sums || !map.counts) {
        status = dem_fail_memory(error);
        goto done;
    }
    // a surface of area A meets about 2 A / h^2 cells of edge h; 20 bits per axis bound the key
    map.cell = fmax(sqrt(4 * grain->area / MOST_CELLS), box_diagonal(grain->box) / (1 << 19));
    while (!fill_cells(grain, &map))
        map.cell *= 1.3;
    status = take_triangles(grain, &map, error);
done:
    free(map.keys);
    free(map.ids);
    free(map.sums);
    free(map.counts);
    return status;
}

dem_status dem_pack_grain_open(const dem_mesh *mesh, dem_pack_grain *grain, dem_error *error)
{
    *grain = (dem_pack_grain){.mesh = mesh};
    dem_solid solid = dem_mesh_solid(mesh);
    if (!(solid.volume > 0) || !isfinite(solid.volume))
        return dem_fail(error, DEM_BAD_INPUT, "the mesh encloses no volume; repair it first");
    grain->size = cbrt(6 * solid.volume / DEM_PI);
    grain->centre = solid.centre;
    grain->area = solid.area / (grain->size * grain->size);
    set_moments(grain);
    grain->box = box_empty();
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
        grain->box = box_with(grain->box, dem_pack_grain_enter(grain, mesh->vertices[mesh->triangles[i]]));
    dem_status status = mesh->triangle_count > MOST_TREE_TRIANGLES ? cluster(grain, error) : copy_turned(grain, error);
    if (status == DEM_OK)
        status = dem_tree_build(&grain->tree, grain->shell.vertices, grain->shell.triangles,
                                grain->shell.triangle_count, error);
    if (status != DEM_OK)
        dem_pack_grain_close(grain);
    return status;
}

dem_pack_stand_in dem_pack_grain_stand_in(const dem_pack_grain *grain)
{
    const dem_mesh *mesh = grain->mesh;
    if (grain->shell.triangle_count == mesh->triangle_count)
        return (dem_pack_stand_in){0};
    dem_pack_stand_in in = {.triangles = grain->shell.triangle_count};
    in.volume_change = dem_mesh_moments(&grain->shell, v3(0, 0, 0)).volume / grain->moments.volume - 1;
    size_t step = 1 + mesh->vertex_count / DISTANCE_SAMPLES;
    for (size_t i = 0; i < mesh->vertex_count; i += step) {
        dem_vec3 p = dem_pack_grain_enter(grain, mesh->vertices[i]);
        if (!dem_tree_within(&grain->tree, p, in.distance))
            in.distance = dem_tree_closest(&grain->tree, p, INFINITY, NULL, NULL);
    }
    return in;
}

void dem_pack_grain_close(dem_pack_grain *grain)
{
    dem_tree_release(&grain->tree);
    dem_mesh_free(&grain->shell);
    *grain = (dem_pack_grain){0};
}
