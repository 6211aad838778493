#include "clump/corners.h"

#include <stdlib.h>

#include "geom/spread.h"
#include "mesh/edges.h"

enum {
    CLOUD = 16384,
    LANES = 16,
    SPREAD_POINTS = 5000,
    BALL_POINTS = 1000,
    MOST_EDGES = 500000,
    LEAF_POINTS = 8,
    CHUNK = 32,
    CLIMBS = 60
};
// lengths in d_eq
#define CELL 0.05           // turning is collected in cells so wide, where the noise of a rough surface cancels
#define SMOOTH 0.004        // balls may come so deep through the surface, and touch it from so far
#define LARGEST 0.6f        // radius to begin with
#define POLISH 0.03         // normals are smoothed so far around a point before they are compared
#define WINDOW 0.1          // and compared so far
#define FACING -0.5         // where their cosine is below this they belong to the other side of a thin grain [-]
#define TURNING_KEPT 0.995  // the least of the turning is left out [-]
#define SPREAD_SPHERE (WINDOW * WINDOW)  // of the normals of a sphere: a cap of chord WINDOW, R = 1/2
#define SPREAD_CUBE 0.0780               // of a cube

// the surface as evenly spread points, about .015 apart: far finer than SMOOTH for any ball
typedef struct cloud {
    dem_surface_point *points;
    size_t count;
    dem_box_tree tree;
    float *x, *y, *z;  // [blocks * LANES] neighbours side by side, padded with the last point
    float *coarse_x, *coarse_y, *coarse_z;  // [blocks] one of each block
    float *bounds;     // [blocks] radius of a block around that one
    size_t blocks;
} cloud;

// turning of the surface, int H dA, on a piece of an edge or summed over a cell; convex is positive
typedef struct turn {
    uint64_t cell;
    double turning;
    dem_vec3 point, normal;
    double radius;  // of the largest ball that touches there
} turn;

typedef struct turn_list {
    turn *turns;
    size_t count, room;
} turn_list;

static uint64_t cell_of(dem_vec3 p)
{
    uint64_t key = 0;
    for (int k = 0; k < 3; k++)
        key = key << 21 | ((uint64_t)(int64_t)(floor(v3_get(p, k) / CELL) + (1 << 20)) & ((1 << 21) - 1));
    return key;
}

static dem_vec3 face_normal(const dem_mesh *mesh, uint32_t triangle)
{
    const uint32_t *t = mesh->triangles + 3 * (size_t)triangle;
    dem_vec3 a = mesh->vertices[t[0]];
    return v3_unit(v3_cross(v3_sub(mesh->vertices[t[1]], a), v3_sub(mesh->vertices[t[2]], a)));
}

// An edge of length l between faces turned by the angle b against each other carries int H dA = l b / 2 (normal cycle,
// Cohen-Steiner & Morvan 2003). Long edges are cut.
static bool edge_turns(const dem_mesh *mesh, uint32_t half, uint32_t twin, turn_list *list)
{
    dem_vec3 a = mesh->vertices[half_start(mesh, half)], b = mesh->vertices[half_end(mesh, half)], d = v3_sub(b, a);
    dem_vec3 n = face_normal(mesh, half / 3), m = face_normal(mesh, twin / 3);
    double length = v3_norm(d);
    double angle = length > 0 ? atan2(v3_dot(v3_cross(n, m), d) / length, v3_dot(n, m)) : 0;
    size_t parts = (size_t)(length / CELL) + 1;
    for (size_t k = 0; k < parts && fabs(angle) > 1e-9; k++) {
        if (!dem_grow(&list->turns, &list->room, list->count, sizeof *list->turns))
            return false;
        dem_vec3 p = v3_along(a, ((double)k + 0.5) / (double)parts, d);
        list->turns[list->count++] =
            (turn){cell_of(p), length / (double)parts * angle / 2, p, v3_unit(v3_add(n, m)), 0};
    }
    return true;
}

static int by_cell(const void *left, const void *right)
{
    const turn *a = left, *b = right;
    if (a->cell != b->cell)
        return a->cell < b->cell ? -1 : 1;
    return fabs(a->turning) > fabs(b->turning) ? -1 : fabs(a->turning) < fabs(b->turning);
}

static int most_first(const void *left, const void *right)
{
    const turn *a = left, *b = right;
    if (a->turning != b->turning)
        return a->turning > b->turning ? -1 : 1;
    return a->cell < b->cell ? -1 : a->cell > b->cell;
}

// the convex cells, those that turn most first; each stands where its sharpest edge does
static dem_status turns_collect(const dem_mesh *mesh, turn_list *list, dem_error *error)
{
    dem_edges edges = {0};
    DEM_TRY(dem_edges_build(&edges, mesh, error));
    bool done = true;
    size_t halves = 3 * mesh->triangle_count, step = 3 * (halves / (6 * (size_t)MOST_EDGES)) + 1;
    for (size_t h = 0; h < halves && done; h += step) {
        uint32_t half = (uint32_t)h, twin = edges.twin[h];
        if (twin < halves && (half < twin || step > 1))
            done = edge_turns(mesh, half, twin, list);
    }
    dem_edges_release(&edges);
    if (!done)
        return dem_fail_memory(error);
    size_t cells = 0, kept = 0;
    double total = 0, sum = 0;
    if (list->count)
        qsort(list->turns, list->count, sizeof *list->turns, by_cell);
    for (size_t i = 0; i < list->count; i++) {
        if (cells && list->turns[cells - 1].cell == list->turns[i].cell)
            list->turns[cells - 1].turning += list->turns[i].turning;
        else
            list->turns[cells++] = list->turns[i];
    }
    if (cells)
        qsort(list->turns, cells, sizeof *list->turns, most_first);
    for (size_t i = 0; i < cells; i++)
        total += fmax(0, list->turns[i].turning);
    while (kept < cells && sum < TURNING_KEPT * total)
        sum += list->turns[kept++].turning;
    list->count = kept;
    return DEM_OK;
}

static int larger_first(const void *left, const void *right)
{
    const dem_ball *a = left, *b = right;
    if (a->radius != b->radius)
        return a->radius > b->radius ? -1 : 1;
    return a->centre.x < b->centre.x ? -1 : a->centre.x > b->centre.x;
}

// The least of `least` and of the radii of the balls that touch p from inside (normal n) and come SMOOTH deep to a
// point q: with e = p - q that is r = (e.e - SMOOTH^2) / (2 (n.e - SMOOTH)) for every q with n.e > SMOOTH.
static float least_radius(dem_vec3 p, dem_vec3 n, const float *x, const float *y, const float *z, size_t count,
                          float least)
{
    const float px = (float)p.x, py = (float)p.y, pz = (float)p.z;
    const float nx = (float)n.x, ny = (float)n.y, nz = (float)n.z, deep = (float)SMOOTH;
    float lane[LANES];
    for (int k = 0; k < LANES; k++)
        lane[k] = least;
    for (size_t i = 0; i < count; i += LANES)
        for (int k = 0; k < LANES; k++) {
            float ex = px - x[i + (size_t)k], ey = py - y[i + (size_t)k], ez = pz - z[i + (size_t)k];
            float low = ex * nx + ey * ny + ez * nz - deep, r = (ex * ex + ey * ey + ez * ez - deep * deep) / (2 * low);
            lane[k] = low > 0 && r < lane[k] ? r : lane[k];
        }
    for (int k = 0; k < LANES; k++)
        least = lane[k] < least ? lane[k] : least;
    return least;
}

// Largest ball that touches p from inside and holds no point of the cloud deeper than SMOOTH. One point of each block
// tells nearly how large it is, and few blocks reach into that.
static dem_ball touching_ball(const cloud *c, dem_vec3 p, dem_vec3 n)
{
    float r = least_radius(p, n, c->coarse_x, c->coarse_y, c->coarse_z, c->blocks, LARGEST);
    for (size_t b = 0; b < c->blocks && r > 0; b++) {
        float x = (float)(p.x - (double)r * n.x) - c->coarse_x[b], y = (float)(p.y - (double)r * n.y) - c->coarse_y[b];
        float z = (float)(p.z - (double)r * n.z) - c->coarse_z[b], reach = r + c->bounds[b];
        if (x * x + y * y + z * z < reach * reach)
            r = least_radius(p, n, c->x + b * LANES, c->y + b * LANES, c->z + b * LANES, LANES, r);
    }
    r = r > 0 ? r : 0;
    return (dem_ball){v3_along(p, -r, n), r};
}

// the point of the cloud nearest to p
static dem_vec3 nearest(const cloud *c, dem_vec3 p)
{
    size_t at = 0;
    double best = INFINITY;
    for (size_t i = 0; i < c->count; i++) {
        double d = v3_norm2(v3_sub(c->points[i].point, p));
        if (d < best) {
            best = d;
            at = i;
        }
    }
    return c->points[at].point;
}

// radius of the largest ball inside: from a good one away from the nearest wall, by ever smaller steps, none through it
static double inscribed_radius(const cloud *c, dem_vec3 centre)
{
    double best = 0, step = INFINITY;
    for (int k = 0; k < CLIMBS; k++, step *= 0.88) {
        dem_vec3 away = v3_sub(centre, nearest(c, centre));
        double room = v3_norm(away);
        best = fmax(best, room);
        step = fmin(step, 0.2 * best);
        centre = v3_along(centre, fmin(step, 0.9 * room), v3_unit(away));
    }
    return best;
}

static bool touches(dem_ball ball, dem_vec3 p)
{
    double reach = ball.radius + SMOOTH;
    return v3_norm2(v3_sub(p, ball.centre)) <= reach * reach;
}

// mean over the turning of the radius of the largest ball that touches there, `most` at most
static double mean_radius(const turn_list *list, double most, const dem_ball *balls, size_t count, int threads)
{
    double sum = 0, total = 0;
#pragma omp parallel for num_threads(threads) schedule(dynamic, CHUNK)
    for (size_t i = 0; i < list->count; i++) {
        turn *t = &list->turns[i];
        size_t k = 0;
        while (k < count && !touches(balls[k], t->point))
            k++;
        t->radius = k < count ? fmin(balls[k].radius, most) : 0;
    }
    for (size_t i = 0; i < list->count; i++) {
        sum += list->turns[i].turning * list->turns[i].radius;
        total += list->turns[i].turning;
    }
    return total > 0 ? sum / total : most;
}

static dem_status roundness_measure(const dem_mesh *mesh, const cloud *c, int threads, double *roundness,
                                    dem_error *error)
{
    turn_list list = {0};
    dem_status status = turns_collect(mesh, &list, error);
    size_t count = list.count + BALL_POINTS;
    dem_ball *balls = dem_alloc(count, sizeof *balls);
    if (status == DEM_OK && !balls)
        status = dem_fail_memory(error);
    if (status == DEM_OK) {
#pragma omp parallel for num_threads(threads) schedule(dynamic, CHUNK)
        for (size_t i = 0; i < count; i++) {
            const dem_surface_point *p = &c->points[i < list.count ? 0 : (i - list.count) * c->count / BALL_POINTS];
            balls[i] = i < list.count ? touching_ball(c, list.turns[i].point, list.turns[i].normal)
                                      : touching_ball(c, p->point, p->normal);
        }
        qsort(balls, count, sizeof *balls, larger_first);
        double largest = inscribed_radius(c, balls[0].centre);
        *roundness = mean_radius(&list, largest, balls, count, threads) / largest;
    }
    free(balls);
    free(list.turns);
    return status;
}

static dem_box point_box(const void *items, uint32_t item)
{
    dem_vec3 p = ((const dem_surface_point *)items)[item].point;
    return (dem_box){p, p};
}

// sum and number of the normals of points within `reach` of p that look the same way as n
static dem_vec3 normals_around(const dem_box_tree *tree, const dem_surface_point *points, dem_vec3 p, dem_vec3 n,
                               double reach, size_t *count)
{
    dem_vec3 sum = {0};
    uint32_t stack[DEM_BOX_TREE_STACK];
    int top = 0;
    *count = 0;
    stack[top++] = 0;
    while (top) {
        uint32_t me = stack[--top];
        const dem_box_node *node = &tree->nodes[me];
        if (box_distance2(&node->box, p) > reach * reach)
            continue;
        if (node->right) {
            stack[top++] = node->right;
            stack[top++] = me + 1;
            continue;
        }
        for (uint32_t k = node->begin; k < node->end; k++) {
            const dem_surface_point *q = &points[tree->order[k]];
            if (v3_norm2(v3_sub(q->point, p)) <= reach * reach && v3_dot(q->normal, n) > FACING) {
                sum = v3_add(sum, q->normal);
                ++*count;
            }
        }
    }
    return sum;
}

// mean over the surface of the spread of the smoothed normals
static dem_status spread_measure(const dem_tree *tree, const cloud *c, int threads, double *mean, dem_error *error)
{
    size_t count = SPREAD_POINTS, around;
    dem_box_tree few = {0};
    dem_surface_point *points = dem_alloc(SPREAD_POINTS, sizeof *points);
    double *spread = dem_alloc(SPREAD_POINTS, sizeof *spread);
    dem_status status = points && spread ? DEM_OK : dem_fail_memory(error);
    if (status == DEM_OK) {
        dem_tree_spread(tree, points, &count);
#pragma omp parallel for num_threads(threads) schedule(dynamic, CHUNK) private(around)
        for (size_t i = 0; i < count; i++)
            points[i].normal =
                v3_unit(normals_around(&c->tree, c->points, points[i].point, points[i].normal, POLISH, &around));
        if (!dem_box_tree_build(&few, points, count, LEAF_POINTS, point_box))
            status = dem_fail_memory(error);
    }
    if (status == DEM_OK) {
#pragma omp parallel for num_threads(threads) schedule(dynamic, CHUNK) private(around)
        for (size_t i = 0; i < count; i++) {
            dem_vec3 sum = normals_around(&few, points, points[i].point, points[i].normal, WINDOW, &around);
            spread[i] = 1 - v3_norm(sum) / (double)around;
        }
        *mean = 0;
        for (size_t i = 0; i < count; i++)
            *mean += spread[i] / (double)count;
    }
    dem_box_tree_release(&few);
    free(points);
    free(spread);
    return status;
}

static void cloud_release(cloud *c)
{
    free(c->points);
    free(c->x);
    dem_box_tree_release(&c->tree);
}

// the columns of points and blocks, from the points in the order of the tree
static void set_columns(cloud *c)
{
    c->y = c->x + CLOUD;
    c->z = c->y + CLOUD;
    c->coarse_x = c->z + CLOUD;
    c->coarse_y = c->coarse_x + c->blocks;
    c->coarse_z = c->coarse_y + c->blocks;
    c->bounds = c->coarse_z + c->blocks;
    for (size_t i = 0; i < CLOUD; i++) {
        dem_vec3 p = c->points[c->tree.order[i < c->count ? i : c->count - 1]].point;
        c->x[i] = (float)p.x;
        c->y[i] = (float)p.y;
        c->z[i] = (float)p.z;
    }
    for (size_t b = 0; b < c->blocks; b++) {
        size_t middle = b * LANES + LANES / 2;
        double widest = 0;
        c->coarse_x[b] = c->x[middle];
        c->coarse_y[b] = c->y[middle];
        c->coarse_z[b] = c->z[middle];
        for (size_t i = b * LANES; i < (b + 1) * LANES; i++)
            widest = fmax(widest, v3_norm(v3((double)(c->x[i] - c->x[middle]), (double)(c->y[i] - c->y[middle]),
                                             (double)(c->z[i] - c->z[middle]))));
        c->bounds[b] = (float)widest;
    }
}

static dem_status cloud_make(cloud *c, const dem_tree *tree, dem_error *error)
{
    *c = (cloud){.points = dem_alloc(CLOUD, sizeof *c->points), .count = CLOUD, .blocks = CLOUD / LANES};
    c->x = dem_alloc(3 * CLOUD + 4 * c->blocks, sizeof *c->x);
    if (c->points && c->x)
        dem_tree_spread(tree, c->points, &c->count);
    if (!c->points || !c->x || !dem_box_tree_build(&c->tree, c->points, c->count, LEAF_POINTS, point_box)) {
        cloud_release(c);
        return dem_fail_memory(error);
    }
    set_columns(c);
    return DEM_OK;
}

dem_status dem_corners_measure(const dem_mesh *mesh, const dem_tree *tree, int threads, double *roundness,
                               double *angularity, dem_error *error)
{
    cloud c;
    double spread = 0;
    DEM_TRY(cloud_make(&c, tree, error));
    dem_status status = spread_measure(tree, &c, threads, &spread, error);
    *angularity = (spread - SPREAD_SPHERE) / (SPREAD_CUBE - SPREAD_SPHERE);
    if (status == DEM_OK)
        status = roundness_measure(mesh, &c, threads, roundness, error);
    cloud_release(&c);
    return status;
}
