// Search by subdivision around the samples: no point of a piece of surface is farther from the other surface than from
// the point of it that is closest to the middle of the piece, nor farther than the middle is plus the reach of the
// piece. A piece is dropped once that is no gain over what is known; where this bound is too weak (the surfaces nearly
// coincide) only the most promising pieces go on.
#include "clump/farthest.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_CELLS = 3000, MANY_CELLS = 200000, MAX_LEVELS = 48, MAX_VERTICES = 60000, CHUNK = 32 };
#define GAIN 0.003  // smallest relative gain worth another subdivision [-]
#define SPREAD 1.3  // a sample stands for the surface so far around it, in square roots of its area [-]

typedef enum cell_kind { TRIANGLE, PIECE, PATCH } cell_kind;

// A piece of surface: a triangle, a piece of its plane, or a spherical triangle of a ball (with unit directions).
// Pieces and spherical triangles may stick out of the surface.
typedef struct cell {
    dem_vec3 corner[3];
    dem_vec3 middle;
    dem_vec3 other;  // closest point of the other surface; at first of the piece it was cut out of
    bool bounded;    // `other` is set
    double reach;    // no point of the piece is farther from the middle
    double bound;    // of the distance in the piece
    double found;    // distance of the middle; -INFINITY: not on the surface, or not worth finding
    uint32_t index;  // of the triangle or ball
    cell_kind kind;
} cell;

typedef struct cell_list {
    cell *cells;
    size_t count, room;
} cell_list;

typedef struct search {
    const dem_tree *mesh;
    const dem_boundary *boundary;
    double sign, best;
    int threads;
    cell_list now, next;
    bool failed;
} search;

static void cell_add(search *s, cell c)
{
    cell_list *list = &s->next;
    if (s->failed || !dem_grow(&list->cells, &list->room, list->count, sizeof *list->cells)) {
        s->failed = true;
        return;
    }
    list->cells[list->count++] = c;
}

// below this nothing is gained
static double threshold(const search *s)
{
    return s->best * (1 + GAIN);
}

// distance of q to the farthest corner
static double corner_farthest(const dem_vec3 corner[3], dem_vec3 q)
{
    return sqrt(
        fmax(v3_norm2(v3_sub(corner[0], q)), fmax(v3_norm2(v3_sub(corner[1], q)), v3_norm2(v3_sub(corner[2], q)))));
}

// the other surface is not farther than this from p
static double known_limit(const cell *c, dem_vec3 p)
{
    return c->bounded ? 1.000001 * v3_distance(p, c->other) : INFINITY;
}

// --- from the mesh to the boundary

// how far p is from the triangle
static double off_triangle(const search *s, uint32_t triangle, dem_vec3 p)
{
    const uint32_t *t = s->mesh->triangles + 3 * (size_t)triangle;
    const dem_vec3 *v = s->mesh->vertices;
    return v3_distance(p, dem_triangle_closest(p, v[t[0]], v[t[1]], v[t[2]]));
}

static void mesh_evaluate(const search *s, cell *c)
{
    double enough = threshold(s) - c->reach;
    dem_boundary_hit hit = dem_boundary_closest(s->boundary, c->middle, enough, known_limit(c, c->middle));
    c->found = c->bound = -INFINITY;
    if (hit.distance <= enough)
        return;
    c->other = hit.point;
    c->bound = fmin(hit.distance + c->reach, corner_farthest(c->corner, hit.point));
    if (c->kind == TRIANGLE || off_triangle(s, c->index, c->middle) < 1e-9)
        c->found = hit.distance;
}

static cell triangle_cell(cell_kind kind, uint32_t index, dem_vec3 a, dem_vec3 b, dem_vec3 c)
{
    cell out = {
        .corner = {a, b, c}, .middle = v3_scale(v3_add(v3_add(a, b), c), 1.0 / 3), .index = index, .kind = kind};
    out.reach = corner_farthest(out.corner, out.middle);
    return out;
}

static void piece_add(search *s, const cell *parent, dem_vec3 a, dem_vec3 b, dem_vec3 c)
{
    cell piece = triangle_cell(PIECE, parent->index, a, b, c);
    piece.other = parent->other;
    piece.bounded = true;
    piece.bound = corner_farthest(piece.corner, parent->other);
    if (piece.bound > threshold(s) && off_triangle(s, piece.index, piece.middle) <= piece.reach + 1e-9)
        cell_add(s, piece);
}

static void mesh_split(search *s, const cell *c)
{
    const dem_vec3 *p = c->corner;
    dem_vec3 m[3];
    for (int k = 0; k < 3; k++)
        m[k] = v3_scale(v3_add(p[k], p[(k + 1) % 3]), 0.5);
    piece_add(s, c, m[0], m[1], m[2]);
    for (int k = 0; k < 3; k++)
        piece_add(s, c, p[k], m[k], m[(k + 2) % 3]);
}

// --- from the boundary to the mesh

// the sign is that of the closest triangle's side where p stands right above it, else by rays
double dem_mesh_level(const dem_tree *mesh, dem_vec3 p, double limit, dem_vec3 *closest)
{
    uint32_t triangle;
    double distance = dem_tree_closest(mesh, p, limit, closest, &triangle);
    if (!isfinite(distance))
        distance = dem_tree_closest(mesh, p, INFINITY, closest, &triangle);
    const uint32_t *t = mesh->triangles + 3 * (size_t)triangle;
    dem_vec3 a = mesh->vertices[t[0]];
    dem_vec3 n = v3_cross(v3_sub(mesh->vertices[t[1]], a), v3_sub(mesh->vertices[t[2]], a));
    double above = v3_dot(v3_sub(p, *closest), n), straight = (1 - 1e-6) * distance * v3_norm(n);
    if (above > straight || above < -straight)
        return above > 0 ? distance : -distance;
    return dem_tree_inside(mesh, p) ? -distance : distance;
}

// distance of q to the farthest point of the piece, which bulges out of the triangle of its corners
static double patch_farthest(const search *s, const cell *c, dem_vec3 q)
{
    dem_ball ball = s->boundary->balls[c->index];
    dem_vec3 corner[3];
    for (int k = 0; k < 3; k++)
        corner[k] = v3_along(ball.centre, ball.radius, c->corner[k]);
    return corner_farthest(corner, q) + c->reach * c->reach / ball.radius;
}

static void patch_evaluate(const search *s, cell *c)
{
    dem_ball ball = s->boundary->balls[c->index];
    dem_vec3 p = v3_along(ball.centre, ball.radius, c->middle);
    double enough = threshold(s) - c->reach;
    c->found = c->bound = -INFINITY;
    if (enough > 0 && dem_tree_within(s->mesh, p, enough))
        return;
    double level = s->sign * dem_mesh_level(s->mesh, p, known_limit(c, p), &c->other);
    c->bound = level + c->reach;
    if (level >= 0)
        c->bound = fmin(c->bound, patch_farthest(s, c, c->other));
    if (!dem_boundary_covered(s->boundary, c->index, c->middle, 0))
        c->found = level;
}

static void patch_add(search *s, const cell *parent, dem_vec3 a, dem_vec3 b, dem_vec3 c)
{
    cell out = {.corner = {a, b, c}, .middle = v3_unit(v3_add(v3_add(a, b), c)), .other = parent->other,
                .bounded = true, .index = parent->index, .kind = PATCH};
    double reach = corner_farthest(out.corner, out.middle);
    out.reach = reach * s->boundary->balls[out.index].radius;
    out.bound = patch_farthest(s, &out, parent->other);
    if (out.bound > threshold(s) && !dem_boundary_covered(s->boundary, out.index, out.middle, reach))
        cell_add(s, out);
}

static void patch_split(search *s, const cell *c)
{
    const dem_vec3 *p = c->corner;
    dem_vec3 m[3];
    for (int k = 0; k < 3; k++)
        m[k] = v3_unit(v3_add(p[k], p[(k + 1) % 3]));
    patch_add(s, c, m[0], m[1], m[2]);
    for (int k = 0; k < 3; k++)
        patch_add(s, c, p[k], m[k], m[(k + 2) % 3]);
}

// --- the search

static int most_promising_first(const void *left, const void *right)
{
    const cell *a = left, *b = right;
    if (a->bound != b->bound)
        return a->bound > b->bound ? -1 : 1;
    return memcmp(&a->middle, &b->middle, sizeof a->middle);
}

// forgets the cells that hold nothing more than is known, and the least promising of too many
static void cells_thin(const search *s, cell_list *list, size_t most)
{
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++)
        if (list->cells[i].bound > threshold(s))
            list->cells[kept++] = list->cells[i];
    if (kept > most) {
        qsort(list->cells, kept, sizeof *list->cells, most_promising_first);
        kept = most;
    }
    list->count = kept;
}

static void cells_evaluate(search *s)
{
#pragma omp parallel for num_threads(s->threads) schedule(dynamic, CHUNK)
    for (size_t i = 0; i < s->now.count; i++) {
        if (s->now.cells[i].kind == PATCH)
            patch_evaluate(s, &s->now.cells[i]);
        else
            mesh_evaluate(s, &s->now.cells[i]);
    }
    for (size_t i = 0; i < s->now.count; i++)
        s->best = fmax(s->best, s->now.cells[i].found);
    cells_thin(s, &s->now, MAX_CELLS);
}

// splits the evaluated cells in `now` and evaluates the parts, which become `now`
static void search_level(search *s)
{
    s->next.count = 0;
    for (size_t i = 0; i < s->now.count; i++) {
        if (s->now.cells[i].kind == PATCH)
            patch_split(s, &s->now.cells[i]);
        else
            mesh_split(s, &s->now.cells[i]);
    }
    cell_list swap = s->now;
    s->now = s->next;
    s->next = swap;
    cells_evaluate(s);
}

static bool search_run(search *s, double *largest)
{
    for (int level = 0; level < MAX_LEVELS && s->now.count && !s->failed; level++)
        search_level(s);
    free(s->now.cells);
    free(s->next.cells);
    *largest = s->best;
    return !s->failed;
}

bool dem_farthest_of_boundary(const dem_tree *mesh, const dem_boundary *boundary, int threads,
                              const dem_boundary_point *points, const dem_boundary_sample_hit *hits, size_t count,
                              int sign, double *largest)
{
    search s = {.mesh = mesh, .boundary = boundary, .sign = sign, .best = *largest, .threads = threads};
    for (size_t i = 0; i < count; i++)
        s.best = fmax(s.best, sign * hits[i].level);
    for (size_t i = 0; i < count; i++) {
        dem_ball ball = boundary->balls[points[i].ball];
        double wide = SPREAD * sqrt(points[i].area), level = sign * hits[i].level;
        cell c = {.middle = points[i].normal, .other = hits[i].closest, .bounded = true, .index = points[i].ball,
                  .kind = PATCH};
        if (level + wide <= threshold(&s))
            continue;
        dem_vec3 a = v3_normal_to(c.middle), b = v3_cross(c.middle, a);
        for (int k = 0; k < 3; k++) {
            double t = 2 * DEM_PI / 3 * k, far = 2 * wide / ball.radius;
            c.corner[k] = v3_unit(v3_along(c.middle, far, v3_along(v3_scale(a, cos(t)), sin(t), b)));
        }
        c.reach = ball.radius * corner_farthest(c.corner, c.middle);
        c.bound = level + wide;
        cell_add(&s, c);
    }
    cells_thin(&s, &s.next, MAX_CELLS);
    s.now = s.next;
    s.next = (cell_list){0};
    return search_run(&s, largest);
}

// Distances of the mesh's vertices (of some, evenly chosen, where there are many), -1 where not known; those below
// `low` only roughly. Ridges and tips are where the largest distances are, and samples miss them.
static bool vertex_distances(const search *s, double low, double *distance, size_t vertex_count)
{
    const dem_tree *mesh = s->mesh;
    uint32_t *used = dem_alloc(vertex_count, sizeof *used);
    if (!used)
        return false;
    for (size_t v = 0; v < vertex_count; v++)
        distance[v] = -2;
    for (size_t k = 0; k < 3 * mesh->count; k++)
        distance[mesh->triangles[k]] = -1;
    size_t count = 0, step = vertex_count / MAX_VERTICES + 1;
    for (size_t v = 0; v < vertex_count; v += step)
        if (distance[v] == -1)
            used[count++] = (uint32_t)v;
#pragma omp parallel for num_threads(s->threads) schedule(dynamic, CHUNK)
    for (size_t k = 0; k < count; k++)
        distance[used[k]] = dem_boundary_closest(s->boundary, mesh->vertices[used[k]], low, INFINITY).distance;
    free(used);
    return true;
}

typedef struct mesh_samples {
    const dem_surface_point *points;
    const double *distances;
    size_t count;
    double wide;     // each stands for the surface so far around it
    double *vertex;  // distances of the vertices
} mesh_samples;

// the first sample of a leaf or behind it, from *at on, and the largest distance of those in the leaf, of the last
// before and of the first behind it
static double leaf_distance(const mesh_samples *m, const dem_tree_node *leaf, size_t *at)
{
    while (*at < m->count && m->points[*at].place < leaf->begin)
        ++*at;
    double largest = *at > 0 ? m->distances[*at - 1] : 0;
    for (size_t k = *at; k < m->count; k++) {
        largest = fmax(largest, m->distances[k]);
        if (m->points[k].place >= leaf->end)
            break;
    }
    return largest;
}

// a triangle around the sample in the plane of its large triangle
static void local_cell_add(search *s, uint32_t triangle, dem_vec3 sample, double distance, double wide)
{
    const uint32_t *t = s->mesh->triangles + 3 * (size_t)triangle;
    const dem_vec3 *v = s->mesh->vertices;
    dem_vec3 a = v3_unit(v3_sub(v[t[1]], v[t[0]])), n = v3_unit(v3_cross(a, v3_sub(v[t[2]], v[t[0]]))), p[3];
    dem_vec3 b = v3_cross(n, a);
    for (int k = 0; k < 3; k++) {
        double turn = 2 * DEM_PI / 3 * k;
        p[k] = v3_along(sample, 2 * wide, v3_along(v3_scale(a, cos(turn)), sin(turn), b));
    }
    cell c = triangle_cell(PIECE, triangle, p[0], p[1], p[2]);
    c.bound = distance + wide;
    cell_add(s, c);
}

// the triangles of one leaf, or the surroundings of its samples where they are large, that leave hope for more
static void leaf_collect(search *s, const mesh_samples *m, const dem_tree_node *leaf, size_t *at)
{
    double near = leaf_distance(m, leaf, at);
    for (uint32_t k = leaf->begin; k < leaf->end; k++) {
        uint32_t triangle = s->mesh->order[k];
        const uint32_t *t = s->mesh->triangles + 3 * (size_t)triangle;
        const dem_vec3 *v = s->mesh->vertices;
        cell c = triangle_cell(TRIANGLE, triangle, v[t[0]], v[t[1]], v[t[2]]);
        c.bound = fmax(near, fmax(m->vertex[t[0]], fmax(m->vertex[t[1]], m->vertex[t[2]]))) + m->wide;
        if (c.reach < 3 * m->wide) {
            if (c.bound > threshold(s))
                cell_add(s, c);
            continue;
        }
        for (size_t i = *at; i < m->count && m->points[i].place <= k; i++)
            if (m->points[i].place == k && m->distances[i] + m->wide > threshold(s))
                local_cell_add(s, triangle, m->points[i].point, m->distances[i], m->wide);
    }
}

static bool mesh_collect(search *s, mesh_samples *m)
{
    const dem_tree *mesh = s->mesh;
    size_t at = 0, vertex_count = 0;
    for (size_t k = 0; k < 3 * mesh->count; k++)
        vertex_count = mesh->triangles[k] >= vertex_count ? mesh->triangles[k] + (size_t)1 : vertex_count;
    m->vertex = dem_alloc(vertex_count, sizeof *m->vertex);
    if (!m->vertex || !vertex_distances(s, 0.5 * s->best, m->vertex, vertex_count))
        return false;
    for (size_t v = 0; v < vertex_count; v++)
        s->best = fmax(s->best, m->vertex[v]);
    for (size_t n = 0; n < mesh->node_count; n++) {
        if (!mesh->nodes[n].right)
            leaf_collect(s, m, &mesh->nodes[n], &at);
        if (s->next.count > MANY_CELLS)  // memory stays bounded for millions of triangles
            cells_thin(s, &s->next, 2 * MAX_CELLS);
    }
    return true;
}

bool dem_farthest_of_mesh(const dem_tree *mesh, const dem_boundary *boundary, int threads,
                          const dem_surface_point *samples, const double *distances, size_t count, double area,
                          double *largest)
{
    search s = {.mesh = mesh, .boundary = boundary, .best = *largest, .threads = threads};
    mesh_samples m = {samples, distances, count, SPREAD * sqrt(area), NULL};
    for (size_t i = 0; i < count; i++)
        s.best = fmax(s.best, distances[i]);
    bool done = mesh_collect(&s, &m);
    free(m.vertex);
    cells_thin(&s, &s.next, 2 * MAX_CELLS);
    s.now = s.next;
    s.next = (cell_list){0};
    cells_evaluate(&s);
    return search_run(&s, largest) && done;
}
