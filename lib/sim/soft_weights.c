// Weights with which the soft maximum of a clump's spheres follows its surface: probes that touch it (planes from all
// sides, small and large balls at points of the surface) shall see sum w_i exp((h_i - h_max) / tau) = 1, where h_i is
// how deep sphere i would be. Non-negative least squares by multiplicative steps (Lee & Seung 2001). Planes alone would
// leave no weight to spheres in hollows, which balls reach.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/vec.h"
#include "sim/soft.h"

enum { DIRECTIONS = 600, STEPS = 60 };
enum { ON_BALL = 100, ON_BALL_MOST = 1600, ENOUGH = 10 };  // points tried on each sphere, until enough are exposed

static const double LEAST_WEIGHT = 0.02;
static const double PROBES[2] = {0.05, 0.25};  // radii of the probing balls [equivalent diameters]
static const double SEEN = 8;                  // how far below the deepest a sphere counts [tau]
static const double SAME = 1e-9;               // difference of spheres that are one [equivalent diameters]

// the spheres that differ, and the probes as rows of what they see
typedef struct fitting {
    dem_ball *balls;
    size_t count;
    double tau;
    double *value, *depth;
    uint32_t *sphere;
    size_t filled, value_capacity, sphere_capacity;
    size_t *row;  // first value of each probe
    size_t rows, row_capacity;
    bool failed;
} fitting;

// the k-th of n directions spread evenly over a sphere
static dem_vec3 spread_direction(size_t k, size_t n)
{
    double z = 1 - (2 * (double)k + 1) / (double)n, s = sqrt(1 - z * z), angle = 2.39996322972865332 * (double)k;
    return v3(s * cos(angle), s * sin(angle), z);
}

// keeps a probe by the depths of all spheres
static void add_probe(fitting *f)
{
    double most = -INFINITY;
    for (size_t i = 0; i < f->count; i++)
        most = larger(most, f->depth[i]);
    if (!dem_grow(&f->row, &f->row_capacity, f->rows + 1, sizeof *f->row)) {
        f->failed = true;
        return;
    }
    f->row[f->rows++] = f->filled;
    for (size_t i = 0; i < f->count && !f->failed; i++) {
        double u = (f->depth[i] - most) / f->tau;
        if (u < -SEEN)
            continue;
        f->failed = !dem_grow(&f->value, &f->value_capacity, f->filled, sizeof *f->value) ||
                    !dem_grow(&f->sphere, &f->sphere_capacity, f->filled, sizeof *f->sphere);
        if (f->failed)
            return;
        f->value[f->filled] = exp(u);
        f->sphere[f->filled++] = (uint32_t)i;
    }
    f->row[f->rows] = f->filled;
}

static void probe_plane(fitting *f, dem_vec3 n)
{
    for (size_t i = 0; i < f->count; i++)
        f->depth[i] = v3_dot(f->balls[i].centre, n) + f->balls[i].radius;
    add_probe(f);
}

static void probe_ball(fitting *f, dem_vec3 centre, double radius)
{
    for (size_t i = 0; i < f->count; i++)
        f->depth[i] = f->balls[i].radius + radius - v3_distance(f->balls[i].centre, centre);
    add_probe(f);
}

// `last`: who covered the point before, which will often cover this one, too
static bool covered(const fitting *f, size_t own, dem_vec3 point, size_t *last)
{
    const dem_ball *b = f->balls;
    if (*last != own && v3_distance(b[*last].centre, point) < b[*last].radius)
        return true;
    for (size_t i = 0; i < f->count; i++)
        if (i != own && v3_distance(b[i].centre, point) < b[i].radius) {
            *last = i;
            return true;
        }
    return false;
}

// the exposed ones of n points of a sphere; with a probe where that is asked for
static size_t exposed(fitting *f, size_t own, size_t n, double size, bool probe)
{
    size_t count = 0, last = own;
    for (size_t k = 0; k < n && !f->failed; k++) {
        dem_ball b = f->balls[own];
        dem_vec3 out = spread_direction(k, n), point = v3_along(b.centre, b.radius, out);
        if (covered(f, own, point, &last))
            continue;
        count++;
        for (int p = 0; probe && p < 2 && !f->failed; p++)
            probe_ball(f, v3_along(point, PROBES[p] * size, out), PROBES[p] * size);
    }
    return count;
}

static void probe_surface(fitting *f, double size)
{
    for (size_t i = 0; i < f->count; i++) {
        size_t n = ON_BALL;
        while (n < ON_BALL_MOST && exposed(f, i, n, size, false) < ENOUGH)
            n *= 4;
        exposed(f, i, n, size, true);
    }
}

// w <- w (K^T 1) / (K^T K w)
static void solve(const fitting *f, double *weight, double *wanted, double *got)
{
    memset(wanted, 0, f->count * sizeof *wanted);
    for (size_t k = 0; k < f->filled; k++)
        wanted[f->sphere[k]] += f->value[k];
    for (size_t i = 0; i < f->count; i++)
        weight[i] = 1;
    for (int step = 0; step < STEPS; step++) {
        memset(got, 0, f->count * sizeof *got);
        for (size_t r = 0; r < f->rows; r++) {
            double seen = 0;
            for (size_t k = f->row[r]; k < f->row[r + 1]; k++)
                seen += weight[f->sphere[k]] * f->value[k];
            for (size_t k = f->row[r]; k < f->row[r + 1]; k++)
                got[f->sphere[k]] += seen * f->value[k];
        }
        for (size_t i = 0; i < f->count; i++)
            weight[i] = got[i] > 0 ? fmin(weight[i] * (wanted[i] / got[i]), 1) : LEAST_WEIGHT;
    }
}

// gathers the spheres that differ; `group`: which of them each sphere is
static void gather(const double (*spheres)[4], size_t count, double same, fitting *f, uint32_t *group)
{
    for (size_t i = 0; i < count; i++) {
        dem_ball b = {v3(spheres[i][0], spheres[i][1], spheres[i][2]), spheres[i][3]};
        size_t k = 0;
        while (k < f->count &&
               !(fabs(f->balls[k].radius - b.radius) <= same && v3_distance(f->balls[k].centre, b.centre) <= same))
            k++;
        if (k == f->count)
            f->balls[f->count++] = b;
        group[i] = (uint32_t)k;
    }
}

bool dem_soft_weigh(const double (*spheres)[4], size_t count, double tau, double size, double *weights)
{
    fitting f = {.tau = tau, .balls = dem_alloc(count, sizeof *f.balls), .depth = dem_alloc(count, sizeof *f.depth)};
    uint32_t *group = dem_alloc(2 * count, sizeof *group), *times = group ? group + count : NULL;
    double *work = dem_alloc_zero(3 * count, sizeof *work);
    f.failed = !f.balls || !f.depth || !group || !work;
    if (!f.failed) {
        gather(spheres, count, SAME * size, &f, group);
        for (size_t k = 0; k < DIRECTIONS && !f.failed; k++)
            probe_plane(&f, spread_direction(k, DIRECTIONS));
        probe_surface(&f, size);
    }
    if (!f.failed) {
        solve(&f, work, work + count, work + 2 * count);
        memset(times, 0, count * sizeof *times);
        for (size_t i = 0; i < count; i++)
            times[group[i]]++;
        for (size_t i = 0; i < count; i++)
            weights[i] = fmax(work[group[i]], LEAST_WEIGHT) / times[group[i]];
    }
    bool good = !f.failed;
    void *all[] = {f.balls, f.depth, f.value, f.sphere, f.row, group, work};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    return good;
}
