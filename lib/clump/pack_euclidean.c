// Spheres by the Euclidean distance transform, as Angelidakis et al. (2021) describe it: of all voxels of the grain the
// one farthest from everything that bounds it is the centre of the next sphere and that distance its radius. What
// bounds it is the surface and the spheres before, each made smaller by the overlap allowed: with 0 the spheres touch,
// with 1 only the centre of one must not lie in another's.
//
// Distances are those to the triangles and the centre is moved off its voxel to where the distance is largest, so that
// voxels only decide which places are looked at. The transform of an image instead counts to the next voxel outside,
// and its spheres stick out by up to a voxel, which fits better than inscribed ones: `margin` does the same.
#include <stdlib.h>
#include <string.h>

#include "clump/farthest.h"
#include "clump/pack_classic.h"

enum { OVERLAP, MARGIN, VOXELS, RMIN };
enum { CHUNK = 128, FEWEST_VOXELS = 60000, VOXELS_PER_SPHERE = 500, MOST_VOXELS = 300000 };
enum { MOST_MOVES = 30, MOST_STEPS = 8 };  // of half a voxel and less, off a voxel

static const double smallest_radius = 1e-4;  // [d_eq]

static const dem_parameter parameters[] = {
    [OVERLAP] = {"overlap", NAN, 0, 1, "-", "part of a sphere that others may reach into; 0: they touch"},
    [MARGIN] = {"margin", NAN, 0, 1, "-", "how far spheres may stick out of the grain, in voxels"},
    [VOXELS] = {"voxels", NAN, 8, 128, "-", "voxels across the equivalent diameter"},
    [RMIN] = {"rmin", 0, 0, 0.5, "d_eq", "smallest radius"},
};

// neighbouring voxels, with a ball around them
typedef struct chunk {
    dem_vec3 middle;
    double reach;
    float farthest;  // largest distance of its voxels
} chunk;

typedef struct field {
    dem_classic *c;
    dem_vec3 *points;         // [count] voxels inside
    float *depth, *distance;  // [count] to the surface; to that and the spheres there are
    chunk *chunks;
    size_t count, chunk_count;
    double step;    // of the voxels
    double core;    // 1 - overlap
    double margin;  // [d_eq]
    dem_ball *balls, *near;
    size_t ball_count;
} field;

static size_t chunk_end(const field *f, size_t k)
{
    return (k + 1) * CHUNK < f->count ? (k + 1) * CHUNK : f->count;
}

static void set_chunk(field *f, size_t k)
{
    chunk *at = &f->chunks[k];
    size_t begin = k * CHUNK, end = chunk_end(f, k);
    dem_box box = box_empty();
    for (size_t i = begin; i < end; i++)
        box = box_with(box, f->points[i]);
    at->middle = v3_scale(v3_add(box.low, box.high), 0.5);
    at->reach = box_diagonal(box) / 2;
    double limit = INFINITY;
    for (size_t i = begin; i < end; i++) {
        double d = dem_tree_closest(&f->c->grain->tree, f->points[i], limit, NULL, NULL);
        f->depth[i] = (float)(isfinite(d) ? d : 0);
        limit = i + 1 < end ? 1.000001 * (d + v3_distance(f->points[i], f->points[i + 1])) : INFINITY;
    }
}

static dem_status set_depths(field *f, dem_error *error)
{
    enum { AT_ONCE = 512 };
    for (size_t first = 0; first < f->chunk_count; first += AT_ONCE) {
        size_t last = first + AT_ONCE < f->chunk_count ? first + AT_ONCE : f->chunk_count;
#pragma omp parallel for num_threads(f->c->threads) schedule(dynamic, 8)
        for (size_t k = first; k < last; k++)
            set_chunk(f, k);
        DEM_TRY(dem_classic_go_on(f->c, 0.3 * (double)last / (double)f->chunk_count, error));
    }
    return DEM_OK;
}

static dem_status open_field(dem_classic *c, field *f, dem_error *error)
{
    double wanted = fmin(fmax(FEWEST_VOXELS, (double)VOXELS_PER_SPHERE * (double)c->options->spheres), MOST_VOXELS);
    if (isnan(c->value[VOXELS]))
        c->value[VOXELS] = round(cbrt(6 * wanted / DEM_PI));
    dem_lattice lattice;
    DEM_TRY(dem_lattice_build(c->grain, (size_t)(DEM_PI / 6 * pow(c->value[VOXELS], 3)), &lattice, error));
    *f = (field){.c = c, .count = lattice.inside_count, .step = lattice.rows.step};
    f->chunk_count = (f->count + CHUNK - 1) / CHUNK;
    f->points = dem_alloc(f->count, sizeof *f->points);
    f->depth = dem_alloc(f->count, sizeof *f->depth);
    f->distance = dem_alloc(f->count, sizeof *f->distance);
    f->chunks = dem_alloc(f->chunk_count, sizeof *f->chunks);
    f->balls = dem_alloc(c->options->spheres, sizeof *f->balls);
    f->near = dem_alloc(c->options->spheres, sizeof *f->near);
    bool room = f->near && f->points && f->depth && f->distance && f->chunks && f->balls;
    if (room)
        f->count = dem_lattice_sample(&lattice, f->count, f->points);
    f->chunk_count = (f->count + CHUNK - 1) / CHUNK;
    dem_lattice_release(&lattice);
    return room ? set_depths(f, error) : dem_fail_memory(error);
}

static void close_field(field *f)
{
    free(f->points);
    free(f->depth);
    free(f->distance);
    free(f->chunks);
    free(f->balls);
    free(f->near);
}

static void lower_chunk(field *f, size_t k, const dem_ball *ball)
{
    float farthest = 0;
    for (size_t i = k * CHUNK; i < chunk_end(f, k); i++) {
        if (ball)
            f->distance[i] =
                (float)smaller(f->distance[i], v3_distance(f->points[i], ball->centre) - f->core * ball->radius);
        farthest = f->distance[i] > farthest ? f->distance[i] : farthest;
    }
    f->chunks[k].farthest = farthest;
}

static void lower_field(field *f, dem_ball ball)
{
    for (size_t k = 0; k < f->chunk_count; k++) {
        const chunk *at = &f->chunks[k];
        if (v3_distance(at->middle, ball.centre) - at->reach - f->core * ball.radius < at->farthest)
            lower_chunk(f, k, &ball);
    }
}

static size_t farthest_voxel(const field *f)
{
    size_t best = 0, k = 0;
    for (size_t i = 1; i < f->chunk_count; i++)
        if (f->chunks[i].farthest > f->chunks[k].farthest)
            k = i;
    best = k * CHUNK;
    for (size_t i = best; i < chunk_end(f, k); i++)
        if (f->distance[i] > f->distance[best])
            best = i;
    return best;
}

// the balls that may matter within `reach` of a place
static size_t find_near(const field *f, dem_vec3 p, double reach, dem_ball *near)
{
    double room = INFINITY;
    size_t count = 0;
    for (size_t i = 0; i < f->ball_count; i++)
        room = smaller(room, v3_distance(p, f->balls[i].centre) - f->core * f->balls[i].radius);
    for (size_t i = 0; i < f->ball_count; i++)
        if (v3_distance(p, f->balls[i].centre) - f->core * f->balls[i].radius <= room + 2 * reach)
            near[count++] = f->balls[i];
    return count;
}

// distance to all that bounds the next ball where that is more than `enough`; the surface is `limit` away or nearer
static double room_at(const field *f, size_t near_count, dem_vec3 p, double enough, double limit)
{
    double room = INFINITY;
    for (size_t i = 0; i < near_count; i++)
        room = smaller(room, v3_distance(p, f->near[i].centre) - f->core * f->near[i].radius);
    if (room <= enough)
        return room;
    dem_vec3 closest;
    return smaller(room, f->margin - dem_mesh_level(&f->c->grain->tree, p, limit, &closest));
}

// steps along axes and diagonals uphill from a voxel, halved where none leads up
static dem_ball climb(field *f, size_t voxel)
{
    dem_vec3 from = f->points[voxel];
    enum { DIRECTIONS = 14 };
    static const dem_vec3 directions[DIRECTIONS] = {
        {1, 0, 0},     {-1, 0, 0},    {0, 1, 0},     {0, -1, 0},      {0, 0, 1},      {0, 0, -1},     {.6, .6, .6},
        {.6, .6, -.6}, {.6, -.6, .6}, {-.6, .6, .6}, {-.6, -.6, -.6}, {-.6, -.6, .6}, {-.6, .6, -.6}, {.6, -.6, -.6}};
    double step = f->step / 2, reach = MOST_STEPS * step, depth = f->depth[voxel];
    size_t near = find_near(f, from, reach, f->near);
    dem_ball best = {from, room_at(f, near, from, -INFINITY, INFINITY)};
    for (int move = 0; move < MOST_MOVES && step > f->step / 64; move++) {
        dem_ball next = best;
        for (int k = 0; k < DIRECTIONS; k++) {
            dem_vec3 p = v3_along(best.centre, step, directions[k]);
            double moved = v3_distance(p, from);
            if (moved > reach)
                continue;
            double room = room_at(f, near, p, next.radius, 1.001 * (depth + moved));
            if (room > next.radius)
                next = (dem_ball){p, room};
        }
        if (!(next.radius > best.radius))
            step /= 2;
        best = next;
    }
    return best;
}

// one packing; it is taken if it is better than those before
static dem_status fill(field *f, double overlap, double margin, double *least, dem_error *error)
{
    dem_classic *c = f->c;
    double smallest = fmax(c->value[RMIN], smallest_radius);
    bool kept = false;
    f->core = 1 - overlap;
    f->margin = margin * f->step;
    f->ball_count = 0;
    for (size_t i = 0; i < f->count; i++)
        f->distance[i] = f->depth[i] + (float)f->margin;
    for (size_t k = 0; k < f->chunk_count; k++)
        lower_chunk(f, k, NULL);
    while (f->count && f->ball_count < c->options->spheres) {
        dem_ball ball = climb(f, farthest_voxel(f));
        if (!(ball.radius >= smallest))
            break;
        f->balls[f->ball_count++] = ball;
        lower_field(f, ball);
    }
    DEM_TRY(dem_classic_offer(c, f->balls, f->ball_count, least, &kept, error));
    if (kept) {
        c->value[OVERLAP] = overlap;
        c->value[MARGIN] = margin;
    }
    return DEM_OK;
}

// what is not given is found: the overlap with half the margin, then the margin with that overlap
static dem_status search(field *f, dem_error *error)
{
    static const double overlaps[] = {0, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 1}, margins[] = {0, 0.25, 0.75, 1};
    enum { OVERLAPS = sizeof overlaps / sizeof *overlaps, MARGINS = sizeof margins / sizeof *margins };
    dem_classic *c = f->c;
    double overlap = c->value[OVERLAP], margin = c->value[MARGIN], least = INFINITY;
    if (c->options->side == DEM_SIDE_INSCRIBED)
        margin = 0;
    int first = isnan(overlap) ? OVERLAPS : 1, second = isnan(margin) ? MARGINS : 0;
    for (int k = 0; k < first; k++) {
        DEM_TRY(fill(f, isnan(overlap) ? overlaps[k] : overlap, isnan(margin) ? 0.5 : margin, &least, error));
        DEM_TRY(dem_classic_go_on(c, 0.3 + 0.7 * (k + 1) / (first + second), error));
    }
    for (int k = 0; k < second; k++) {
        DEM_TRY(fill(f, c->value[OVERLAP], margins[k], &least, error));
        DEM_TRY(dem_classic_go_on(c, 0.3 + 0.7 * (first + k + 1) / (first + second), error));
    }
    return DEM_OK;
}

static dem_status place(dem_classic *c, dem_error *error)
{
    field f;
    dem_status status = open_field(c, &f, error);
    if (status == DEM_OK)
        status = search(&f, error);
    close_field(&f);
    return status;
}

const dem_packer dem_packer_euclidean = {
    .name = "euclidean",
    .paper = "Angelidakis, Nadimi, Otsubo & Utili 2021, SoftwareX 15, 100735, doi:10.1016/j.softx.2021.100735",
    .about = "The largest inscribed sphere, then again and again the largest that fits beside those before with some "
             "overlap, by the distance transform of voxels. Overlap and margin not given are those of least gap.",
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .order = "largest first",
    .run = dem_classic_run,
    .place = place,
};
