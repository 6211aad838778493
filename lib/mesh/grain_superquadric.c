/// Superquadrics, ((x/a)^n2 + (y/b)^n2)^(n1/n2) + (z/c)^n1 = 1, with the blockiness n1 of sections along z and n2 of
/// the one across: 2 and 2 make an ellipsoid, large n1 a cylinder, both large a brick (Barr 1981; Podlozhnyuk, Pirker &
/// Kloss 2017). With e = 2/n the volume is 2 a b c e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2) (Jaklic, Leonardis & Solina
/// 2000).
///
/// The mesh is that of a brick with its grid, of which each line follows a section; the brick's edges lie on those of
/// the grain, where the section has x = y or the like. Along a section the points keep even distances in a mean of arc
/// length and turning, so that flat sides are divided evenly and edges are still round.
#include <stdlib.h>

#include "base/memory.h"
#include "mesh/grain.h"
#include "mesh/flips.h"
#include "mesh/patchwork.h"

enum { A, B, C, N1, N2 };
enum { TABLE = 4096, MOST_STEPS = 8192 };

static const double TURNING = 0.3;  // its part in the distances
static const double LONGEST = 100;  // most that half axes may differ by

static const dem_grain_param params[] = {
    [A] = {"a", 1e-3, 1e-9, 1e9, "m", "half axis along x"},
    [B] = {"b", 0.8e-3, 1e-9, 1e9, "m", "half axis along y"},
    [C] = {"c", 0.6e-3, 1e-9, 1e9, "m", "half axis along z"},
    [N1] = {"n1", 6, 2, 50, "-", "blockiness of the sections along z: 2 round, 50 with sharp edges"},
    [N2] = {"n2", 6, 2, 50, "-", "blockiness of the section across z"},
};

typedef struct point {
    double small, large;
} point;

// an eighth of the curve small^n + large^n = 1, from the middle of a side (0) to the corner (1)
typedef struct section {
    double n;
    double passed[TABLE + 1];  // distance from the middle, to small/large = i / TABLE, over the whole
} section;

static point on_curve(double n, double ratio)
{
    double large = pow(1 + pow(ratio, n), -1 / n);
    return (point){ratio * large, large};
}

static void measure_section(section *s, double n)
{
    s->n = n;
    s->passed[0] = 0;
    point before = {0, 1};
    for (int i = 1; i <= TABLE; i++) {
        point p = on_curve(n, (double)i / TABLE);
        s->passed[i] = s->passed[i - 1] + hypot(p.small - before.small, p.large - before.large);
        before = p;
    }
    double length = s->passed[TABLE];
    for (int i = 1; i <= TABLE; i++) {
        double turn = atan(pow((double)i / TABLE, n - 1)) / (DEM_PI / 4);
        s->passed[i] = (1 - TURNING) * s->passed[i] / length + TURNING * turn;
    }
}

static point along_section(const section *s, double part)
{
    int low = 0, high = TABLE;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        *(s->passed[middle] <= part ? &low : &high) = middle;
    }
    double rest = (part - s->passed[low]) / (s->passed[high] - s->passed[low]);
    return on_curve(s->n, (low + fmin(fmax(rest, 0), 1)) / TABLE);
}

// the grid over the brick, `count` cells along each axis, and the points of the sections at its lines
typedef struct grid {
    long count[3];
    section rising, across;
    const double *values;
} grid;

// lattice coordinate k of 0..count as a number in -1..1
static double spread(long k, long count)
{
    return 2 * (double)k / (double)count - 1;
}

static dem_vec3 place(const grid *g, long i, long j, long k)
{
    double u = spread(i, g->count[0]), v = spread(j, g->count[1]), w = spread(k, g->count[2]);
    double wide = fmax(fabs(u), fabs(v));
    bool cap = k == 0 || k == g->count[2];
    point rise = along_section(&g->rising, cap ? wide : fabs(w));
    double out = cap ? rise.small : rise.large, up = cap ? rise.large : rise.small;
    if (wide == 0)
        return v3(0, 0, copysign(g->values[C], w));
    bool x_leads = fabs(u) >= fabs(v);
    point turn = along_section(&g->across, fmin(fabs(u), fabs(v)) / wide);
    return v3(copysign(g->values[A] * out * (x_leads ? turn.large : turn.small), u),
              copysign(g->values[B] * out * (x_leads ? turn.small : turn.large), v), copysign(g->values[C] * up, w));
}

// vertices stand layer by layer: two full ones, rims between them
static uint32_t vertex_at(const grid *g, long i, long j, long k)
{
    long nx = g->count[0], ny = g->count[1], layer = (nx + 1) * (ny + 1), rim = 2 * (nx + ny);
    if (k == 0)
        return (uint32_t)(i + j * (nx + 1));
    long begin = layer + (k - 1) * rim;
    if (k == g->count[2])
        return (uint32_t)(begin + i + j * (nx + 1));
    long at = j == 0 ? i : i == nx ? nx + j : j == ny ? nx + ny + (nx - i) : 2 * nx + ny + (ny - j);
    return (uint32_t)(begin + at);
}

static void put_vertices(const grid *g, dem_patchwork *w)
{
    long nx = g->count[0], ny = g->count[1], nz = g->count[2];
    for (long k = 0; k <= nz; k += k == 0 ? nz : nz + 1) {
        if (k == nz)
            for (long m = 1; m < nz; m++)
                for (long at = 0; at < 2 * (nx + ny); at++) {
                    long i = at < nx ? at : at < nx + ny ? nx : at < 2 * nx + ny ? 2 * nx + ny - at : 0;
                    long j = at < nx ? 0 : at < nx + ny ? at - nx : at < 2 * nx + ny ? ny : 2 * (nx + ny) - at;
                    dem_patchwork_vertex(w, place(g, i, j, m));
                }
        for (long j = 0; j <= ny; j++)
            for (long i = 0; i <= nx; i++)
                dem_patchwork_vertex(w, place(g, i, j, k));
    }
}

// one side of the brick: `axis` and whether it is the far one. Cells are cut towards the nearest corner of the side
static void put_side(const grid *g, int axis, bool far, dem_patchwork *w)
{
    int one = (axis + 1) % 3, two = (axis + 2) % 3;
    for (long q = 0; q < g->count[two]; q++)
        for (long p = 0; p < g->count[one]; p++) {
            uint32_t v[4];
            for (int c = 0; c < 4; c++) {
                long at[3];
                at[axis] = far ? g->count[axis] : 0;
                at[one] = p + (c == 1 || c == 2);
                at[two] = q + (c >= 2);
                v[far ? c : 3 - c] = vertex_at(g, at[0], at[1], at[2]);
            }
            bool rising = (2 * p < g->count[one]) == (2 * q < g->count[two]);
            int k = rising == far ? 0 : 1;
            dem_patchwork_triangle(w, v[k], v[k + 1], v[(k + 2) % 4]);
            dem_patchwork_triangle(w, v[k], v[(k + 2) % 4], v[(k + 3) % 4]);
        }
}

// even numbers of cells in the proportion of the half axes, with about so many triangles
static void choose_counts(grid *g, size_t triangles)
{
    // thin sides get a few more the finer the rest is
    double low = 0, high = 1e12, least = triangles < 200 ? 2 : fmax(4, 2 * floor(pow((double)triangles, 0.25) / 2));
    double longest = fmax(g->values[A], fmax(g->values[B], g->values[C]));
    for (int k = 0; k < 100; k++) {
        double middle = (low + high) / 2, n[3];
        for (int axis = 0; axis < 3; axis++) {
            n[axis] = fmin(fmax(middle * g->values[axis] / longest, least), MOST_STEPS);
            g->count[axis] = 2 * (long)(n[axis] / 2 + 0.5);
        }
        double made = 4 * (n[0] * n[1] + n[1] * n[2] + n[0] * n[2]);
        *(made < (double)triangles ? &low : &high) = middle;
    }
}

static dem_status make(const dem_ctx *ctx, const dem_grain_request *request, dem_mesh *mesh, dem_error *error)
{
    const double *v = request->values;
    double longest = fmax(v[A], fmax(v[B], v[C])), shortest = fmin(v[A], fmin(v[B], v[C]));
    if (longest > LONGEST * shortest)
        return dem_fail(error, DEM_USAGE, "the half axes differ by a factor of %.3g; at most %.0f is allowed",
                        longest / shortest, LONGEST);
    grid *g = dem_alloc(1, sizeof *g);
    if (!g)
        return dem_fail_memory(error);
    g->values = v;
    choose_counts(g, request->triangles);
    measure_section(&g->rising, v[N1]);
    measure_section(&g->across, v[N2]);
    dem_patchwork work = {0};
    put_vertices(g, &work);
    for (int axis = 0; axis < 3; axis++)
        for (int far = 0; far < 2; far++)
            put_side(g, axis, far, &work);
    free(g);
    if (dem_progress(ctx, "making", 1)) {
        dem_mesh_free(&work.mesh);
        return dem_fail(error, DEM_INTERRUPTED, "interrupted; nothing was written");
    }
    DEM_TRY(dem_patchwork_finish(&work, mesh, error));
    dem_status status = dem_mesh_flip_to_convex(mesh, error);
    if (status != DEM_OK)
        dem_mesh_free(mesh);
    return status;
}

const dem_grain_kind dem_grain_superquadric = {
    .name = "superquadric",
    .paper = "Barr 1981, doi:10.1109/MCG.1981.1673799; Podlozhnyuk, Pirker & Kloss 2017, doi:10.1007/s40571-016-0131-6",
    .about = "Superquadric ((x/a)^n2 + (y/b)^n2)^(n1/n2) + (z/c)^n1 = 1: ellipsoid, cylinder, brick and between.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .make = make,
};
