// Half edges are sorted into buckets by their lower vertex and, within the few of a bucket, by the upper one:
// linear in time, 8 bytes of work space per half edge.
#include "mesh/edges.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { SMALL_BUCKET = 48 };

typedef struct side {
    uint32_t upper, half;
} side;

typedef struct buckets {
    size_t *start;  // [vertex_count + 1]
    side *sides;    // [3 triangle_count]
} buckets;

void dem_edges_release(dem_edges *edges)
{
    free(edges->twin);
    free(edges->fan);
    free(edges->fan_start);
    free(edges->duplicate);
    *edges = (dem_edges){0};
}

static int by_upper(const void *pa, const void *pb)
{
    const side *a = pa, *b = pb;
    if (a->upper != b->upper)
        return a->upper < b->upper ? -1 : 1;
    return (a->half > b->half) - (a->half < b->half);
}

static void sort_bucket(side *sides, size_t count)
{
    if (count > SMALL_BUCKET) {
        qsort(sides, count, sizeof *sides, by_upper);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        side s = sides[i];
        size_t k = i;
        for (; k > 0 && by_upper(&sides[k - 1], &s) > 0; k--)
            sides[k] = sides[k - 1];
        sides[k] = s;
    }
}

static bool fill_buckets(buckets *b, const dem_mesh *mesh)
{
    size_t sides = 3 * mesh->triangle_count;
    b->start = dem_alloc_zero(mesh->vertex_count + 2, sizeof *b->start);
    b->sides = dem_alloc(sides, sizeof *b->sides);
    if (!b->start || !b->sides)
        return false;
    // counted two places up, so that filling moves each start to where it belongs
    for (uint32_t h = 0; h < sides; h++) {
        uint32_t p = half_start(mesh, h), q = half_end(mesh, h);
        b->start[(p < q ? p : q) + 2]++;
    }
    for (size_t v = 2; v < mesh->vertex_count + 2; v++)
        b->start[v] += b->start[v - 1];
    for (uint32_t h = 0; h < sides; h++) {
        uint32_t p = half_start(mesh, h), q = half_end(mesh, h);
        b->sides[b->start[(p < q ? p : q) + 1]++] = (side){p < q ? q : p, h};
    }
    return true;
}

// among the triangles at one edge, marks those whose third corner was seen before; reorders `sides`
static dem_status mark_duplicates(dem_edges *edges, const dem_mesh *mesh, side *sides, size_t count, dem_error *error)
{
    uint32_t upper = sides[0].upper;
    for (size_t i = 0; i < count; i++)
        sides[i].upper = half_apex(mesh, sides[i].half);
    sort_bucket(sides, count);
    for (size_t i = 1; i < count; i++) {
        // each triangle is looked at from one edge only: the one across from its highest corner
        if (sides[i].upper != sides[i - 1].upper || sides[i].upper < upper)
            continue;
        if (!edges->duplicate)
            edges->duplicate = dem_alloc_zero(mesh->triangle_count, 1);
        if (!edges->duplicate)
            return dem_fail_memory(error);
        edges->duplicate[sides[i].half / 3] = 1;
        edges->duplicates++;
    }
    return DEM_OK;
}

static bool add_fan(dem_edges *edges, const side *sides, size_t count, size_t *fan_room, size_t *start_room)
{
    size_t at = edges->many ? edges->fan_start[edges->many] : 0;
    for (size_t i = 0; i < count; i++) {
        if (!dem_grow(&edges->fan, fan_room, at + i, sizeof *edges->fan))
            return false;
        edges->fan[at + i] = sides[i].half;
        edges->twin[sides[i].half] = DEM_EDGE_MANY;
    }
    if (!dem_grow(&edges->fan_start, start_room, edges->many + 1, sizeof *edges->fan_start))
        return false;
    edges->fan_start[edges->many++] = at;
    edges->fan_start[edges->many] = at + count;
    return true;
}

static dem_status match(dem_edges *edges, const dem_mesh *mesh, const buckets *b, dem_error *error)
{
    size_t fan_room = 0, start_room = 0;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        side *sides = b->sides + b->start[v];
        size_t count = b->start[v + 1] - b->start[v];
        sort_bucket(sides, count);
        for (size_t i = 0, n; i < count; i += n) {
            for (n = 1; i + n < count && sides[i + n].upper == sides[i].upper; n++)
                ;
            if (n == 1) {
                edges->twin[sides[i].half] = DEM_EDGE_BORDER;
                edges->border++;
            } else if (n == 2) {
                edges->twin[sides[i].half] = sides[i + 1].half;
                edges->twin[sides[i + 1].half] = sides[i].half;
            } else if (!add_fan(edges, sides + i, n, &fan_room, &start_room)) {
                return dem_fail_memory(error);
            }
            if (n > 1)
                DEM_TRY(mark_duplicates(edges, mesh, sides + i, n, error));
        }
    }
    return DEM_OK;
}

dem_status dem_edges_build(dem_edges *edges, const dem_mesh *mesh, dem_error *error)
{
    dem_edges_release(edges);
    buckets b = {0};
    edges->twin = dem_alloc(mesh->triangle_count, 3 * sizeof *edges->twin);
    dem_status status = DEM_OK;
    if (!edges->twin || !fill_buckets(&b, mesh))
        status = dem_fail_memory(error);
    else
        status = match(edges, mesh, &b, error);
    free(b.start);
    free(b.sides);
    return status;
}
