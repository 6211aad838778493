#include "mesh/patchwork.h"

#include <stdlib.h>

#include "base/memory.h"

uint32_t dem_patchwork_vertex(dem_patchwork *w, dem_vec3 at)
{
    if (w->failed || w->mesh.vertex_count >= UINT32_MAX - 1 ||
        !dem_grow(&w->mesh.vertices, &w->vertex_room, w->mesh.vertex_count, sizeof *w->mesh.vertices)) {
        w->failed = true;
        return 0;
    }
    w->mesh.vertices[w->mesh.vertex_count] = at;
    return (uint32_t)w->mesh.vertex_count++;
}

void dem_patchwork_triangle(dem_patchwork *w, uint32_t a, uint32_t b, uint32_t c)
{
    if (w->failed ||
        !dem_grow(&w->mesh.triangles, &w->index_room, w->mesh.triangle_count, 3 * sizeof *w->mesh.triangles)) {
        w->failed = true;
        return;
    }
    uint32_t *t = &w->mesh.triangles[3 * w->mesh.triangle_count++];
    t[0] = a;
    t[1] = b;
    t[2] = c;
}

dem_status dem_patchwork_finish(dem_patchwork *w, dem_mesh *mesh, dem_error *error)
{
    bool failed = w->failed;
    if (failed)
        dem_mesh_free(&w->mesh);
    *mesh = w->mesh;
    *w = (dem_patchwork){0};
    return failed ? dem_fail_memory(error) : DEM_OK;
}

// one ring of a patch: its vertices side by side
typedef struct ring {
    uint32_t *vertices;
    size_t *begins;  // [sides + 1]
} ring;

// between two rows of vertices that run the same way, the second to the left of the first
static void sew(dem_patchwork *w, const uint32_t *outer, size_t m, const uint32_t *inner, size_t n)
{
    for (size_t i = 0, j = 0; i < m || j < n;) {
        if (j == n || (i < m && (i + 1) * n <= (j + 1) * m)) {
            dem_patchwork_triangle(w, outer[i], outer[i + 1], inner[j]);
            i++;
        } else {
            dem_patchwork_triangle(w, outer[i], inner[j + 1], inner[j]);
            j++;
        }
    }
}

static dem_vec3 on_patch(const dem_polygon_patch *p, dem_vec3 flat)
{
    return p->radius > 0 ? v3_along(p->centre, p->radius, v3_unit(flat)) : flat;
}

// the length of a polygon's sides, its middle (that of its outline), and how far that is from the sides
static double outline(const dem_polygon_patch *p, dem_vec3 *middle)
{
    double length = 0, twice_area = 0;
    *middle = v3(0, 0, 0);
    for (size_t i = 0; i < p->sides; i++) {
        dem_vec3 a = p->corners[i], b = p->corners[(i + 1) % p->sides];
        double side = v3_distance(a, b);
        *middle = v3_along(*middle, side / 2, v3_add(a, b));
        length += side;
    }
    *middle = v3_scale(*middle, 1 / length);
    for (size_t i = 0; i < p->sides; i++) {
        dem_vec3 a = p->corners[i], b = p->corners[(i + 1) % p->sides];
        twice_area += v3_norm(v3_cross(v3_sub(a, *middle), v3_sub(b, *middle)));
    }
    return twice_area / length;
}

// the ring at `part` of the way to the middle
static void put_ring(dem_patchwork *w, const dem_polygon_patch *p, dem_vec3 middle, double part, ring *to)
{
    size_t used = 0;
    for (size_t i = 0; i < p->sides; i++) {
        dem_vec3 a = v3_along(v3_scale(p->corners[i], 1 - part), part, middle);
        dem_vec3 b = v3_along(v3_scale(p->corners[(i + 1) % p->sides], 1 - part), part, middle);
        size_t most = p->begins[i + 1] - p->begins[i], steps = (size_t)(v3_distance(a, b) / p->edge + 0.5);
        steps = steps < 1 ? 1 : steps > most ? most : steps;
        to->begins[i] = used;
        for (size_t k = 0; k < steps; k++) {
            double s = (double)k / (double)steps;
            to->vertices[used++] = dem_patchwork_vertex(w, on_patch(p, v3_along(v3_scale(a, 1 - s), s, b)));
        }
    }
    to->vertices[used] = to->vertices[0];
    to->begins[p->sides] = used;
}

void dem_patchwork_fill(dem_patchwork *w, const dem_polygon_patch *p)
{
    size_t length = p->begins[p->sides] + 1;
    uint32_t *room = dem_alloc(2 * length, sizeof *room);
    size_t *begins = dem_alloc(2 * (p->sides + 1), sizeof *begins);
    if (!room || !begins)
        w->failed = true;
    dem_vec3 middle;
    size_t rings = (size_t)(outline(p, &middle) / (0.8660254037844386 * p->edge) + 0.5);
    rings = rings < 1 ? 1 : rings;
    ring outer = {room, begins}, inner = {room + length, begins + p->sides + 1};
    for (size_t i = 0; i < length && !w->failed; i++)
        outer.vertices[i] = p->rim[i % (length - 1)];
    for (size_t i = 0; i <= p->sides && !w->failed; i++)
        outer.begins[i] = p->begins[i];
    for (size_t j = 1; j < rings && !w->failed; j++) {
        put_ring(w, p, middle, (double)j / (double)rings, &inner);
        for (size_t i = 0; i < p->sides; i++)
            sew(w, outer.vertices + outer.begins[i], outer.begins[i + 1] - outer.begins[i],
                inner.vertices + inner.begins[i], inner.begins[i + 1] - inner.begins[i]);
        ring swap = outer;
        outer = inner;
        inner = swap;
    }
    if (!w->failed) {
        uint32_t tip = dem_patchwork_vertex(w, on_patch(p, middle));
        sew(w, outer.vertices, outer.begins[p->sides], &tip, 0);
    }
    free(room);
    free(begins);
}
