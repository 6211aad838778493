// Welding by hashing. Files of loose triangles have six vertices for each one that remains, so memory counts:
// vertices move down in place, and the table holds 4 bytes per slot and grows with the vertices that remain.
#include "mesh/weld.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "mesh/mass.h"

static const uint32_t FREE = UINT32_MAX;

typedef struct vertex_table {
    uint32_t *slots;
    size_t mask;
} vertex_table;

static bool table_init(vertex_table *table, size_t slots)
{
    table->mask = slots - 1;
    table->slots = dem_alloc(slots, sizeof *table->slots);
    if (table->slots)
        memset(table->slots, 0xff, slots * sizeof *table->slots);
    return table->slots != NULL;
}

static uint64_t bits_of(double x)
{
    uint64_t bits;
    x += 0.0;  // -0 to 0
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static uint64_t position_hash(dem_vec3 p)
{
    return random_mix(bits_of(p.x) ^ random_mix(bits_of(p.y) ^ random_mix(bits_of(p.z) + 0x9e3779b97f4a7c15u)));
}

static bool same_position(dem_vec3 a, dem_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static bool table_double(vertex_table *table, const dem_vec3 *vertices, size_t count)
{
    vertex_table larger;
    if (!table_init(&larger, 2 * (table->mask + 1)))
        return false;
    for (size_t i = 0; i < count; i++) {
        size_t at = position_hash(vertices[i]) & larger.mask;
        while (larger.slots[at] != FREE)
            at = (at + 1) & larger.mask;
        larger.slots[at] = (uint32_t)i;
    }
    free(table->slots);
    *table = larger;
    return true;
}

static void shrink(dem_mesh *mesh)
{
    void *vertices = realloc(mesh->vertices, (mesh->vertex_count + 1) * sizeof *mesh->vertices);
    if (vertices)
        mesh->vertices = vertices;
    void *triangles = realloc(mesh->triangles, (3 * mesh->triangle_count + 1) * sizeof *mesh->triangles);
    if (triangles)
        mesh->triangles = triangles;
}

static void renumber(dem_mesh *mesh, const uint32_t *number)
{
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
        mesh->triangles[i] = number[mesh->triangles[i]];
}

// number[v]: FREE where unused, else anything; becomes the new number of each vertex. Moves vertices down
static bool merge_equal(dem_mesh *mesh, uint32_t *number, size_t *unused)
{
    vertex_table table;
    if (!table_init(&table, 1 << 12))
        return false;
    size_t kept = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        if (number[i] == FREE) {
            ++*unused;
            continue;
        }
        dem_vec3 p = mesh->vertices[i];
        size_t at = position_hash(p) & table.mask;
        while (table.slots[at] != FREE && !same_position(mesh->vertices[table.slots[at]], p))
            at = (at + 1) & table.mask;
        if (table.slots[at] == FREE) {
            table.slots[at] = (uint32_t)kept;
            mesh->vertices[kept++] = p;
            number[i] = (uint32_t)kept - 1;
            if (2 * kept > table.mask && !table_double(&table, mesh->vertices, kept)) {
                free(table.slots);
                return false;
            }
        } else {
            number[i] = table.slots[at];
        }
    }
    mesh->vertex_count = kept;
    free(table.slots);
    return true;
}

// FREE for the vertices no triangle uses, 0 for the others
static uint32_t *mark_used(const dem_mesh *mesh)
{
    uint32_t *number = dem_alloc(mesh->vertex_count, sizeof *number);
    if (!number)
        return NULL;
    memset(number, 0xff, mesh->vertex_count * sizeof *number);
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
        number[mesh->triangles[i]] = 0;
    return number;
}

dem_status dem_mesh_weld_equal(dem_mesh *mesh, size_t *unused, dem_error *error)
{
    *unused = 0;
    uint32_t *number = mark_used(mesh);
    if (!number || !merge_equal(mesh, number, unused)) {
        // a half-done merge has moved vertices: nothing is left to use
        free(number);
        dem_mesh_free(mesh);
        return dem_fail_memory(error);
    }
    renumber(mesh, number);
    free(number);
    shrink(mesh);
    return DEM_OK;
}

dem_status dem_mesh_compact(dem_mesh *mesh, size_t *unused, dem_error *error)
{
    *unused = 0;
    uint32_t *number = mark_used(mesh);
    if (!number)
        return dem_fail_memory(error);
    size_t kept = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        if (number[i] != FREE) {
            mesh->vertices[kept] = mesh->vertices[i];
            number[i] = (uint32_t)kept++;
        }
    *unused = mesh->vertex_count - kept;
    mesh->vertex_count = kept;
    renumber(mesh, number);
    free(number);
    shrink(mesh);
    return DEM_OK;
}

// a marked vertex in a cell of the grid; cells are as wide as the tolerance, so neighbours suffice
typedef struct cell_entry {
    uint64_t cell;
    uint32_t vertex;
} cell_entry;

static uint64_t cell_of(int64_t x, int64_t y, int64_t z)
{
    return random_mix((uint64_t)x ^ random_mix((uint64_t)y ^ random_mix((uint64_t)z)));
}

static int by_cell(const void *pa, const void *pb)
{
    const cell_entry *a = pa, *b = pb;
    if (a->cell != b->cell)
        return a->cell < b->cell ? -1 : 1;
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

static size_t first_in_cell(const cell_entry *entries, size_t count, uint64_t cell)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (entries[middle].cell < cell)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// the lowest numbered marked vertex in reach of v that stands for itself
static uint32_t near_vertex(const dem_mesh *mesh, const cell_entry *entries, size_t count, const uint32_t *number,
                            uint32_t v, dem_vec3 low, double tolerance)
{
    dem_vec3 p = mesh->vertices[v], s = v3_scale(v3_sub(p, low), 1 / tolerance);
    uint32_t best = v;
    for (int k = 0; k < 27; k++) {
        uint64_t cell = cell_of((int64_t)s.x + k % 3 - 1, (int64_t)s.y + k / 3 % 3 - 1, (int64_t)s.z + k / 9 - 1);
        for (size_t i = first_in_cell(entries, count, cell); i < count && entries[i].cell == cell; i++) {
            uint32_t w = entries[i].vertex;
            if (w >= best)
                break;
            if (number[w] == w && v3_distance(mesh->vertices[w], p) <= tolerance)
                best = w;
        }
    }
    return best;
}

dem_status dem_mesh_weld_near(dem_mesh *mesh, const unsigned char *marked, double tolerance, size_t *merged,
                              dem_error *error)
{
    *merged = 0;
    dem_status status = DEM_OK;
    size_t count = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        count += marked[i] != 0;
    cell_entry *entries = dem_alloc(count, sizeof *entries);
    uint32_t *number = dem_alloc(mesh->vertex_count, sizeof *number);
    if (!entries || !number) {
        status = dem_fail_memory(error);
        goto done;
    }
    dem_vec3 low = dem_mesh_box(mesh).low;
    count = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        number[i] = (uint32_t)i;
        dem_vec3 s = v3_scale(v3_sub(mesh->vertices[i], low), 1 / tolerance);
        if (marked[i])
            entries[count++] = (cell_entry){cell_of((int64_t)s.x, (int64_t)s.y, (int64_t)s.z), (uint32_t)i};
    }
    qsort(entries, count, sizeof *entries, by_cell);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        if (marked[i]) {
            number[i] = near_vertex(mesh, entries, count, number, (uint32_t)i, low, tolerance);
            *merged += number[i] != i;
        }
    renumber(mesh, number);
    if (*merged) {
        size_t unused;
        status = dem_mesh_compact(mesh, &unused, error);
    }
done:
    free(entries);
    free(number);
    return status;
}

void dem_mesh_drop(dem_mesh *mesh, const unsigned char *drop)
{
    size_t kept = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        if (!drop[i])
            memmove(mesh->triangles + 3 * kept++, mesh->triangles + 3 * i, 3 * sizeof *mesh->triangles);
    mesh->triangle_count = kept;
}

size_t dem_mesh_drop_collapsed(dem_mesh *mesh)
{
    size_t kept = 0, count = mesh->triangle_count;
    for (size_t i = 0; i < count; i++) {
        uint32_t *t = mesh->triangles + 3 * i;
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            memmove(mesh->triangles + 3 * kept++, t, 3 * sizeof *t);
    }
    mesh->triangle_count = kept;
    return count - kept;
}

typedef struct triangle_key {
    uint32_t corner[3];  // ascending
    uint32_t triangle;
    bool odd;            // an odd number of exchanges sorts the corners
} triangle_key;

static triangle_key key_of(const dem_mesh *mesh, uint32_t triangle)
{
    const uint32_t *v = mesh->triangles + 3 * (size_t)triangle;
    triangle_key key = {{v[0], v[1], v[2]}, triangle, false};
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < 2; k++)
            if (key.corner[k] > key.corner[k + 1]) {
                uint32_t swap = key.corner[k];
                key.corner[k] = key.corner[k + 1];
                key.corner[k + 1] = swap;
                key.odd = !key.odd;
            }
    return key;
}

static int by_corners(const void *pa, const void *pb)
{
    const triangle_key *a = pa, *b = pb;
    for (int k = 0; k < 3; k++)
        if (a->corner[k] != b->corner[k])
            return a->corner[k] < b->corner[k] ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

bool dem_mesh_merge_layers(dem_mesh *mesh, int *layers)
{
    size_t count = mesh->triangle_count;
    triangle_key *keys = dem_alloc(count, sizeof *keys);
    unsigned char *drop = dem_alloc_zero(count, 1);
    if (!keys || !drop) {
        free(keys);
        free(drop);
        return false;
    }
    for (uint32_t t = 0; t < count; t++)
        keys[t] = key_of(mesh, t);
    qsort(keys, count, sizeof *keys, by_corners);
    for (size_t i = 0, n; i < count; i += n) {
        int net = 0;
        for (n = 0; i + n < count && memcmp(keys[i].corner, keys[i + n].corner, sizeof keys[i].corner) == 0; n++) {
            net += keys[i + n].odd == keys[i].odd ? 1 : -1;
            drop[keys[i + n].triangle] = n > 0;
        }
        uint32_t *v = mesh->triangles + 3 * (size_t)keys[i].triangle, corner = v[0];
        drop[keys[i].triangle] = net == 0;
        layers[keys[i].triangle] = abs(net);
        if (net < 0) {
            v[0] = v[1];
            v[1] = corner;
        }
    }
    size_t kept = 0;
    for (size_t t = 0; t < count; t++)
        if (!drop[t])
            layers[kept++] = layers[t];
    dem_mesh_drop(mesh, drop);
    free(keys);
    free(drop);
    return true;
}
