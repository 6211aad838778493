// The surface around a polyhedron: its faces moved out, a strip of a cylinder over each edge, a patch of the sphere at
// each corner. The three share their outlines, so the mesh is closed by construction.
#include <stdlib.h>

#include "base/memory.h"
#include "mesh/flips.h"
#include "mesh/patchwork.h"
#include "mesh/polyhedron.h"

enum { ATTEMPTS = 4, MAX_STEPS = 1 << 20 };

static const double COARSE_TURN = 0.4;  // [rad] most that a step over an edge turns; more looks like an edge

typedef struct wrapping {
    const dem_polyhedron *p;
    dem_polyhedron_sides sides;
    double radius, edge;
    size_t *steps;    // [loop_count] along a side
    size_t *across;   // [loop_count] over it; 0: sharp
    uint32_t *rows;   // [loop_count] where the vertices of a side begin in `row`
    uint32_t *row;    // those along each side, steps + 1 of them
    uint32_t *strip;  // [loop_count] first vertex of the inside of a strip, of the first of the two sides
    size_t row_count;
    dem_patchwork work;
} wrapping;

static dem_vec3 corner_at(const wrapping *w, uint32_t side)
{
    return w->p->corners[w->p->loops[side]];
}

static dem_vec3 end_of(const wrapping *w, uint32_t side)
{
    return corner_at(w, polyhedron_next(w->p, &w->sides, side));
}

static dem_vec3 normal_of(const wrapping *w, uint32_t side)
{
    return w->p->faces[w->sides.face[side]].plane.normal;
}

static size_t whole_steps(double length, double edge)
{
    double steps = floor(length / edge + 0.5);
    return steps < 1 ? 1 : steps > MAX_STEPS ? MAX_STEPS : (size_t)steps;
}

static void count_steps(wrapping *w)
{
    size_t used = 0;
    for (uint32_t i = 0; i < w->p->loop_count; i++) {
        double turn = polyhedron_turn(w->p, &w->sides, i);
        w->steps[i] = whole_steps(v3_distance(corner_at(w, i), end_of(w, i)), w->edge);
        size_t least = (size_t)ceil(turn / COARSE_TURN), wanted = whole_steps(turn * w->radius, w->edge);
        w->across[i] = w->radius > 0 ? (wanted > least ? wanted : least ? least : 1) : 0;
        w->rows[i] = (uint32_t)used;
        used += w->steps[i] + 1;
    }
    w->row_count = used;
}

// the vertex at a corner of a face; where nothing is rounded, all faces around the corner have the same
static void put_corners(wrapping *w, uint32_t *shared)
{
    for (uint32_t i = 0; i < w->p->loop_count; i++) {
        uint32_t *at = &shared[w->p->loops[i]];
        if (w->radius > 0 || *at == UINT32_MAX)
            *at = dem_patchwork_vertex(&w->work, v3_along(corner_at(w, i), w->radius, normal_of(w, i)));
        w->row[w->rows[i]] = *at;
    }
    for (uint32_t i = 0; i < w->p->loop_count; i++)
        w->row[w->rows[i] + w->steps[i]] = w->row[w->rows[polyhedron_next(w->p, &w->sides, i)]];
}

static void put_rows(wrapping *w)
{
    for (uint32_t i = 0; i < w->p->loop_count; i++) {
        uint32_t twin = w->sides.twin[i];
        for (size_t k = 1; k < w->steps[i]; k++) {
            double s = (double)k / (double)w->steps[i];
            dem_vec3 at = v3_along(v3_scale(corner_at(w, i), 1 - s), s, end_of(w, i));
            w->row[w->rows[i] + k] = w->radius == 0 && twin < i
                                         ? w->row[w->rows[twin] + w->steps[i] - k]
                                         : dem_patchwork_vertex(&w->work, v3_along(at, w->radius, normal_of(w, i)));
        }
    }
}

// between unit vectors, at even angles
static dem_vec3 between(dem_vec3 a, dem_vec3 b, double s, double angle)
{
    if (angle < 1e-9)
        return v3_unit(v3_along(a, s, v3_sub(b, a)));
    return v3_unit(v3_along(v3_scale(a, sin((1 - s) * angle)), sin(s * angle), b));
}

// the vertex `step` along a side and `over` over it, counted from the side's own face
static uint32_t strip_vertex(const wrapping *w, uint32_t side, size_t step, size_t over)
{
    uint32_t twin = w->sides.twin[side];
    if (over == 0)
        return w->row[w->rows[side] + step];
    if (over == w->across[side])
        return w->row[w->rows[twin] + w->steps[side] - step];
    if (twin < side)
        return strip_vertex(w, twin, w->steps[side] - step, w->across[side] - over);
    return w->strip[side] + (uint32_t)(step * (w->across[side] - 1) + over - 1);
}

static void put_strip(wrapping *w, uint32_t side)
{
    size_t along = w->steps[side], across = w->across[side];
    dem_vec3 a = normal_of(w, side), b = normal_of(w, w->sides.twin[side]);
    double turn = polyhedron_turn(w->p, &w->sides, side);
    w->strip[side] = (uint32_t)w->work.mesh.vertex_count;
    for (size_t k = 0; k <= along; k++)
        for (size_t j = 1; j < across; j++) {
            double s = (double)k / (double)along;
            dem_vec3 at = v3_along(v3_scale(corner_at(w, side), 1 - s), s, end_of(w, side));
            dem_patchwork_vertex(&w->work, v3_along(at, w->radius, between(a, b, (double)j / (double)across, turn)));
        }
    for (size_t k = 0; k < along; k++)
        for (size_t j = 0; j < across; j++) {
            uint32_t q[4] = {strip_vertex(w, side, k, j), strip_vertex(w, side, k, j + 1),
                             strip_vertex(w, side, k + 1, j + 1), strip_vertex(w, side, k + 1, j)};
            dem_patchwork_triangle(&w->work, q[0], q[1], q[2]);
            dem_patchwork_triangle(&w->work, q[0], q[2], q[3]);
        }
}

// room for the outline of one patch
typedef struct outline {
    dem_vec3 *corners;
    uint32_t *rim;
    size_t *begins, sides, length;
} outline;

static void fill(wrapping *w, const outline *o, double edge, double radius, dem_vec3 centre)
{
    o->begins[o->sides] = o->length;
    dem_polygon_patch patch = {o->corners, o->sides, o->rim, o->begins, edge, radius, centre};
    dem_patchwork_fill(&w->work, &patch);
}

static void fill_face(wrapping *w, const dem_polyhedron_face *face, outline *o)
{
    o->sides = o->length = 0;
    for (uint32_t i = (uint32_t)face->begin; i < face->end; i++) {
        o->corners[o->sides] = v3_along(corner_at(w, i), w->radius, face->plane.normal);
        o->begins[o->sides++] = o->length;
        for (size_t k = 0; k < w->steps[i]; k++)
            o->rim[o->length++] = w->row[w->rows[i] + k];
    }
    fill(w, o, w->edge, 0, v3(0, 0, 0));
}

// the patch of the sphere at the corner where `first` begins
static void fill_corner(wrapping *w, uint32_t first, outline *o)
{
    uint32_t side = first;
    o->sides = o->length = 0;
    do {
        // from this face over the side that ends here to the next one
        uint32_t ends = polyhedron_before(w->p, &w->sides, side);
        o->corners[o->sides] = normal_of(w, side);
        o->begins[o->sides++] = o->length;
        for (size_t k = 0; k < w->across[ends]; k++)
            o->rim[o->length++] = strip_vertex(w, ends, w->steps[ends], k);
        side = w->sides.twin[ends];
    } while (side != first && o->sides < w->p->face_count);
    fill(w, o, fmin(w->edge / w->radius, COARSE_TURN), w->radius, corner_at(w, first));
}

static void put_surface(wrapping *w, outline *o, uint32_t *shared)
{
    put_corners(w, shared);
    put_rows(w);
    for (uint32_t i = 0; i < w->p->loop_count && w->radius > 0; i++)
        if (w->sides.twin[i] > i)
            put_strip(w, i);
    for (size_t f = 0; f < w->p->face_count && !w->work.failed; f++)
        fill_face(w, &w->p->faces[f], o);
    for (size_t v = 0; v < w->p->corner_count; v++)
        shared[v] = UINT32_MAX;
    for (uint32_t i = 0; i < w->p->loop_count && w->radius > 0 && !w->work.failed; i++)
        if (shared[w->p->loops[i]] == UINT32_MAX) {
            shared[w->p->loops[i]] = i;
            fill_corner(w, i, o);
        }
}

static dem_status wrap(wrapping *w, dem_mesh *mesh, dem_error *error)
{
    count_steps(w);
    size_t across = 0;
    for (size_t i = 0; i < w->p->loop_count; i++)
        across += w->across[i];
    dem_arena arena = {0};
    size_t sides = w->p->loop_count, rim = w->row_count + across;
    w->row = dem_arena_take(&arena, w->row_count, sizeof *w->row);
    uint32_t *shared = dem_arena_take(&arena, w->p->corner_count, sizeof *shared);
    outline o = {.corners = dem_arena_take(&arena, sides, sizeof *o.corners),
                 .rim = dem_arena_take(&arena, rim, sizeof *o.rim),
                 .begins = dem_arena_take(&arena, sides + 1, sizeof *o.begins)};
    w->work.failed = arena.failed;
    if (!arena.failed) {
        for (size_t v = 0; v < w->p->corner_count; v++)
            shared[v] = UINT32_MAX;
        put_surface(w, &o, shared);
    }
    dem_arena_release(&arena);
    return dem_patchwork_finish(&w->work, mesh, error);
}

// patches over long narrow corners have needles that lean; the origin need not lie inside
static dem_status flip_from_inside(dem_mesh *mesh, dem_vec3 inside, dem_error *error)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->vertices[i] = v3_sub(mesh->vertices[i], inside);
    dem_status status = dem_mesh_flip_to_convex(mesh, error);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->vertices[i] = v3_add(mesh->vertices[i], inside);
    return status;
}

dem_status dem_polyhedron_mesh(const dem_polyhedron *p, double radius, size_t triangles, dem_mesh *mesh,
                               dem_error *error)
{
    *mesh = (dem_mesh){0};
    dem_polyhedron_measures m;
    DEM_TRY(dem_polyhedron_measure(p, &m, error));
    wrapping w = {.p = p, .radius = radius};
    DEM_TRY(dem_polyhedron_sides_find(p, &w.sides, error));
    dem_arena arena = {0};
    w.steps = dem_arena_take(&arena, p->loop_count, sizeof *w.steps);
    w.across = dem_arena_take(&arena, p->loop_count, sizeof *w.across);
    w.rows = dem_arena_take(&arena, p->loop_count, sizeof *w.rows);
    w.strip = dem_arena_take(&arena, p->loop_count, sizeof *w.strip);
    dem_status status = arena.failed ? dem_fail_memory(error) : DEM_OK;
    // even triangles first; then once or twice again, for rows are whole
    double area = m.area + 2 * m.curvature * radius + 4 * DEM_PI * radius * radius;
    w.edge = sqrt(area / (double)triangles * 2.309401076758503);
    for (int attempt = 0; attempt < ATTEMPTS && status == DEM_OK; attempt++) {
        dem_mesh_free(mesh);
        status = wrap(&w, mesh, error);
        double too_many = (double)mesh->triangle_count / (double)triangles;
        if (fabs(too_many - 1) < 0.1)
            break;
        w.edge *= fmin(sqrt(too_many), 2);
    }
    dem_arena_release(&arena);
    dem_polyhedron_sides_release(&w.sides);
    if (status == DEM_OK && radius > 0)
        status = flip_from_inside(mesh, m.centre, error);
    return status;
}
