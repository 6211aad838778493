// A triangle meets a line where the line's foot lies inside its projection. The three edge functions are always
// evaluated from the lower to the higher vertex index, a zero counting as positive, so the triangles on both sides of
// an edge see the same sign and a line never leaks through a closed mesh.
#include "geom/lines.h"

#include <stdlib.h>

#define GOLDEN 0.61803398874989485
// a lattice has at most so many rows or columns; the spacing is enlarged where it must be
enum { MAX_ROWS = 1 << 14, NONE = -1, COVERS = 32 };

// an event on the lines of one row; lists by column
typedef struct crossing {
    double at;
    int32_t next;
    int winding;  // +1: enters the mesh
} crossing;

typedef struct chord {
    double from, to;
    int32_t next;
} chord;

// what the plane of a row cuts out of a ball
typedef struct disc {
    double x, z, wide2, wide;
} disc;

// work space of one thread
typedef struct row_work {
    disc *discs;              // [balls]
    crossing *crossings;
    size_t crossing_count, crossing_room;
    chord *chords;
    size_t chord_count, chord_room;
    int32_t *first_crossing;  // [columns]
    chord *cover;             // [columns] a chord grown by every later one that met it; the others are listed
    crossing *sorted;
    size_t sorted_room;
    chord *merged;
    size_t merged_room;
} row_work;

// the bodies in the frame of the bundle and their rows
typedef struct lattice {
    const dem_line_bodies *bodies;
    dem_vec3 *vertices;
    dem_ball *balls;
    double spacing, x, y;  // column 0 of an unshifted row, row 0
    int64_t rows, columns;
    size_t *start;      // [rows + 1] ranges of `members`
    uint32_t *members;  // triangles, row by row
} lattice;

static double row_y(const lattice *l, int64_t j)
{
    return l->y + l->spacing * (double)j;
}

static double row_x(const lattice *l, int64_t j)
{
    double f = GOLDEN * (double)j;
    return l->x + l->spacing * (f - floor(f));
}

// first and last index of origin + k spacing in [low, high], within 0..count-1
static void index_range(double low, double high, double origin, double spacing, int64_t count, int64_t *first,
                        int64_t *last)
{
    double a = ceil((low - origin) / spacing), b = floor((high - origin) / spacing);
    *first = a > 0 ? (int64_t)fmin(a, (double)count) : 0;
    *last = b < (double)count - 1 ? (int64_t)fmax(b, -1) : count - 1;
}

static void triangle_rows(const lattice *l, size_t triangle, int64_t *first, int64_t *last)
{
    const uint32_t *t = l->bodies->triangles + 3 * triangle;
    double a = l->vertices[t[0]].y, b = l->vertices[t[1]].y, c = l->vertices[t[2]].y;
    index_range(fmin(a, fmin(b, c)), fmax(a, fmax(b, c)), l->y, l->spacing, l->rows, first, last);
}

static dem_vec3 in_frame(const dem_line_bundle *bundle, dem_vec3 p)
{
    return v3(v3_dot(p, bundle->axis[0]), v3_dot(p, bundle->axis[1]), v3_dot(p, bundle->axis[2]));
}

static void lattice_release(lattice *l)
{
    free(l->vertices);
    free(l->balls);
    free(l->start);
    free(l->members);
}

static int larger_ball_first(const void *left, const void *right)
{
    double a = ((const dem_ball *)left)->radius, b = ((const dem_ball *)right)->radius;
    return a > b ? -1 : a < b;
}

// projects everything, lays the lattice over it and lists the triangles of each row
static bool lattice_make(lattice *l, const dem_line_bodies *bodies, const dem_line_bundle *bundle)
{
    *l = (lattice){.bodies = bodies};
    l->vertices = dem_alloc(bodies->vertex_count, sizeof *l->vertices);
    l->balls = dem_alloc(bodies->ball_count, sizeof *l->balls);
    if (!l->vertices || !l->balls)
        return false;
    dem_box box = box_empty();
    for (size_t i = 0; i < bodies->vertex_count; i++)
        box = box_with(box, l->vertices[i] = in_frame(bundle, bodies->vertices[i]));
    for (size_t i = 0; i < bodies->ball_count; i++) {
        double r = bodies->balls[i].radius;
        l->balls[i] = (dem_ball){in_frame(bundle, bodies->balls[i].centre), r};
        box = box_with(box_with(box, v3_sub(l->balls[i].centre, v3(r, r, r))), v3_add(l->balls[i].centre, v3(r, r, r)));
    }
    qsort(l->balls, bodies->ball_count, sizeof *l->balls, larger_ball_first);
    double wide = box.high.x - box.low.x, high = box.high.y - box.low.y;
    l->spacing = fmax(bundle->spacing, fmax(wide, high) / (MAX_ROWS - 4));
    l->x = box.low.x - 0.38196601125 * l->spacing;
    l->y = box.low.y - 0.27639320225 * l->spacing;
    l->columns = (int64_t)(wide / l->spacing) + 2;
    l->rows = (int64_t)(high / l->spacing) + 2;
    l->start = dem_alloc_zero((size_t)l->rows + 2, sizeof *l->start);
    if (!l->start)
        return false;
    int64_t first, last;
    for (size_t t = 0; t < bodies->triangle_count; t++) {
        triangle_rows(l, t, &first, &last);
        for (int64_t j = first; j <= last; j++)
            l->start[j + 2]++;
    }
    for (int64_t j = 2; j < l->rows + 2; j++)
        l->start[j] += l->start[j - 1];
    l->members = dem_alloc(l->start[l->rows + 1], sizeof *l->members);
    if (!l->members)
        return false;
    for (size_t t = 0; t < bodies->triangle_count; t++) {
        triangle_rows(l, t, &first, &last);
        for (int64_t j = first; j <= last; j++)
            l->members[l->start[j + 1]++] = (uint32_t)t;
    }
    return true;
}

// twice the signed area of (p, q, foot), from the lower vertex index
static double edge_function(const lattice *l, uint32_t p, uint32_t q, double x, double y)
{
    dem_vec3 a = l->vertices[p < q ? p : q], b = l->vertices[p < q ? q : p];
    double e = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    return p < q ? e : -e;
}

static bool triangle_cross(const lattice *l, size_t triangle, int64_t j, row_work *w)
{
    const uint32_t *t = l->bodies->triangles + 3 * triangle;
    dem_vec3 a = l->vertices[t[0]], b = l->vertices[t[1]], c = l->vertices[t[2]];
    double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y), y = row_y(l, j), x0 = row_x(l, j);
    int64_t first, last;
    if (area == 0)
        return true;
    index_range(fmin(a.x, fmin(b.x, c.x)), fmax(a.x, fmax(b.x, c.x)), x0, l->spacing, l->columns, &first, &last);
    for (int64_t i = first; i <= last; i++) {
        double x = x0 + l->spacing * (double)i, e[3];
        bool inside = true;
        for (int k = 0; k < 3 && inside; k++) {
            uint32_t p = t[(k + 1) % 3], q = t[(k + 2) % 3];
            e[k] = edge_function(l, p, q, x, y);
            inside = (e[k] == 0 ? p < q : e[k] > 0) == (area > 0);
        }
        double sum = inside ? e[0] + e[1] + e[2] : 0;
        if (sum == 0)
            continue;
        if (!dem_grow(&w->crossings, &w->crossing_room, w->crossing_count, sizeof *w->crossings))
            return false;
        double at = (e[0] * a.z + e[1] * b.z + e[2] * c.z) / sum;
        w->crossings[w->crossing_count] = (crossing){at, w->first_crossing[i], area > 0 ? -1 : 1};
        w->first_crossing[i] = (int32_t)w->crossing_count++;
    }
    return true;
}

// A disc adds nothing where a larger one contains it, by more than rounding. It is looked for among the first ones,
// which are those of the largest balls.
static bool is_contained(const disc *discs, size_t count, const disc *d)
{
    for (size_t k = 0; k < count && k < COVERS; k++) {
        double more = discs[k].wide * (1 - 1e-9) - d->wide, dx = discs[k].x - d->x, dz = discs[k].z - d->z;
        if (more > 0 && dx * dx + dz * dz < more * more)
            return true;
    }
    return false;
}

// the discs in which the plane of a row cuts the balls, without those hidden in others
static size_t cut_balls(const lattice *l, int64_t j, disc *discs)
{
    size_t count = 0;
    for (size_t k = 0; k < l->bodies->ball_count; k++) {
        const dem_ball *ball = &l->balls[k];
        double dy = row_y(l, j) - ball->centre.y, wide2 = ball->radius * ball->radius - dy * dy;
        if (!(wide2 > 0))
            continue;
        disc d = {ball->centre.x, ball->centre.z, wide2, sqrt(wide2)};
        if (!is_contained(discs, count, &d))
            discs[count++] = d;
    }
    return count;
}

static bool disc_cross(const lattice *l, const disc *d, int64_t j, row_work *w)
{
    double x0 = row_x(l, j);
    int64_t first, last;
    index_range(d->x - d->wide, d->x + d->wide, x0, l->spacing, l->columns, &first, &last);
    for (int64_t i = first; i <= last; i++) {
        double dx = x0 + l->spacing * (double)i - d->x, half2 = d->wide2 - dx * dx;
        if (!(half2 > 0))
            continue;
        double half = sqrt(half2), from = d->z - half, to = d->z + half;
        chord *cover = &w->cover[i];
        if (cover->from > cover->to || (from <= cover->to && to >= cover->from)) {
            cover->from = fmin(cover->from, from);
            cover->to = fmax(cover->to, to);
            continue;
        }
        if (!dem_grow(&w->chords, &w->chord_room, w->chord_count, sizeof *w->chords))
            return false;
        w->chords[w->chord_count] = (chord){from, to, cover->next};
        cover->next = (int32_t)w->chord_count++;
    }
    return true;
}

static int chord_order(const void *left, const void *right)
{
    const chord *a = left, *b = right;
    return a->from < b->from ? -1 : a->from > b->from;
}

static int crossing_order(const void *left, const void *right)
{
    const crossing *a = left, *b = right;
    return a->at < b->at ? -1 : a->at > b->at;
}

// the chords of a column, sorted and united
static bool column_balls(row_work *w, int64_t column, size_t *count)
{
    const chord *next = &w->cover[column];
    size_t n = 0, out = 0;
    while (next && next->from <= next->to) {
        if (!dem_grow(&w->merged, &w->merged_room, n, sizeof *w->merged))
            return false;
        w->merged[n++] = *next;
        next = next->next == NONE ? NULL : &w->chords[next->next];
    }
    if (n > 1)
        qsort(w->merged, n, sizeof *w->merged, chord_order);
    for (size_t i = 0; i < n; i++) {
        if (out > 0 && w->merged[i].from <= w->merged[out - 1].to)
            w->merged[out - 1].to = fmax(w->merged[out - 1].to, w->merged[i].to);
        else
            w->merged[out++] = w->merged[i];
    }
    *count = out;
    return true;
}

// the crossings of a column in order; *closed: the winding number comes back to zero
static bool column_mesh(row_work *w, int64_t column, size_t *count, bool *closed)
{
    size_t n = 0;
    int winding = 0;
    for (int32_t k = w->first_crossing[column]; k != NONE; k = w->crossings[k].next) {
        if (!dem_grow(&w->sorted, &w->sorted_room, n, sizeof *w->sorted))
            return false;
        winding += w->crossings[k].winding;
        w->sorted[n++] = w->crossings[k];
    }
    if (n > 1)
        qsort(w->sorted, n, sizeof *w->sorted, crossing_order);
    *count = n;
    *closed = winding == 0;
    return true;
}

static void column_lengths(const row_work *w, size_t crossings, size_t chords, dem_bundle_volumes *v)
{
    for (size_t k = 0; k < chords; k++)
        v->balls += w->merged[k].to - w->merged[k].from;
    int winding = 0;
    size_t at = 0;
    for (size_t k = 0; k + 1 < crossings; k++) {
        winding += w->sorted[k].winding;
        if (winding == 0)
            continue;
        double from = w->sorted[k].at, to = w->sorted[k + 1].at;
        v->mesh += to - from;
        while (at < chords && w->merged[at].to <= from)
            at++;
        for (size_t c = at; c < chords && w->merged[c].from < to; c++)
            v->both += fmin(to, w->merged[c].to) - fmax(from, w->merged[c].from);
    }
}

// all lines of one row
static bool row_measure(const lattice *l, int64_t j, row_work *w, dem_bundle_volumes groups[DEM_LINE_GROUPS])
{
    w->crossing_count = w->chord_count = 0;
    for (int64_t i = 0; i < l->columns; i++) {
        w->first_crossing[i] = NONE;
        w->cover[i] = (chord){INFINITY, -INFINITY, NONE};
    }
    for (size_t k = l->start[j]; k < l->start[j + 1]; k++)
        if (!triangle_cross(l, l->members[k], j, w))
            return false;
    size_t discs = cut_balls(l, j, w->discs);
    for (size_t k = 0; k < discs; k++)
        if (!disc_cross(l, &w->discs[k], j, w))
            return false;
    for (int64_t i = 0; i < l->columns; i++) {
        dem_bundle_volumes *v = &groups[(i + 3 * j) % DEM_LINE_GROUPS];
        size_t crossings, chords;
        bool closed;
        if (w->first_crossing[i] == NONE && w->cover[i].from > w->cover[i].to)
            continue;
        if (!column_balls(w, i, &chords) || !column_mesh(w, i, &crossings, &closed))
            return false;
        v->lines++;
        if (closed)
            column_lengths(w, crossings, chords, v);
        else
            v->broken++;
    }
    return true;
}

static void row_work_release(row_work *w)
{
    free(w->discs);
    free(w->crossings);
    free(w->chords);
    free(w->first_crossing);
    free(w->cover);
    free(w->sorted);
    free(w->merged);
}

static bool rows_measure(const lattice *l, int threads, dem_bundle_volumes (*rows)[DEM_LINE_GROUPS])
{
    bool failed = false;
#pragma omp parallel num_threads(threads)
    {
        row_work w = {0};
        w.first_crossing = dem_alloc((size_t)l->columns, sizeof *w.first_crossing);
        w.cover = dem_alloc((size_t)l->columns, sizeof *w.cover);
        w.discs = dem_alloc(l->bodies->ball_count, sizeof *w.discs);
        bool ready = w.first_crossing && w.cover && w.discs;
#pragma omp for schedule(dynamic, 4) reduction(|| : failed)
        for (int64_t j = 0; j < l->rows; j++)
            failed = failed || !ready || !row_measure(l, j, &w, rows[j]);
        row_work_release(&w);
    }
    return !failed;
}

dem_status dem_line_bundle_measure(const dem_line_bodies *bodies, const dem_line_bundle *bundle, int threads,
                                   dem_bundle_volumes groups[DEM_LINE_GROUPS], dem_error *error)
{
    lattice l;
    dem_bundle_volumes(*rows)[DEM_LINE_GROUPS] = NULL;
    bool done = lattice_make(&l, bodies, bundle);
    if (done) {
        rows = dem_alloc_zero((size_t)l.rows, sizeof *rows);
        done = rows && rows_measure(&l, threads, rows);
    }
    double cell = l.spacing * l.spacing * DEM_LINE_GROUPS;
    for (int g = 0; g < DEM_LINE_GROUPS; g++) {
        groups[g] = (dem_bundle_volumes){0};
        for (int64_t j = 0; done && j < l.rows; j++) {
            groups[g].mesh += rows[j][g].mesh * cell;
            groups[g].balls += rows[j][g].balls * cell;
            groups[g].both += rows[j][g].both * cell;
            groups[g].lines += rows[j][g].lines;
            groups[g].broken += rows[j][g].broken;
        }
    }
    free(rows);
    lattice_release(&l);
    return done ? DEM_OK : dem_fail_memory(error);
}
