// Favier et al. (1999): spheres with their centres on an axis of the particle, each as large as it can be inside, so
// that it is tangent to the surface. The paper leaves open where on the axis they stand. Here they are those of the
// largest union that so many spheres can have: the volume of a row of balls is that of the balls less what neighbours
// share, so the best row ends in each place with the best shorter row before it (dynamic programming).
#include <stdlib.h>

#include "clump/pack_classic.h"
#include "math/mat3.h"
#include "math/quat.h"

enum { AXIS };
enum { PLACES = 800 };

static const double least_gain = 1e-5;  // of the grain's volume, for one more ball to be worth its place

static const dem_parameter parameters[] = {
    [AXIS] = {"axis", NAN, 1, 3, "count", "principal axis: 1 that of least inertia, along a long grain, to 3"},
};

static double cap_volume(double radius, double height)
{
    return DEM_PI * height * height * (radius - height / 3);
}

static double ball_volume(double radius)
{
    return 4 * DEM_PI / 3 * radius * radius * radius;
}

// what two balls share
static double lens_volume(dem_ball a, dem_ball b)
{
    double d = v3_distance(a.centre, b.centre), small = fmin(a.radius, b.radius);
    if (d >= a.radius + b.radius)
        return 0;
    if (d <= fabs(a.radius - b.radius))
        return ball_volume(small);
    double to_plane = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);  // from a's centre
    return cap_volume(a.radius, a.radius - to_plane) + cap_volume(b.radius, b.radius - (d - to_plane));
}

// balls on the line, from one end to the other
static size_t balls_on(const dem_classic *c, dem_vec3 axis, dem_ball *balls)
{
    double low = INFINITY, high = -INFINITY;
    const dem_mesh *shell = &c->grain->shell;
    for (size_t i = 0; i < 3 * shell->triangle_count; i++) {
        double x = v3_dot(shell->vertices[shell->triangles[i]], axis);
        low = fmin(low, x);
        high = fmax(high, x);
    }
#pragma omp parallel for num_threads(c->threads) schedule(dynamic, 16)
    for (int i = 0; i < PLACES; i++) {
        dem_vec3 p = v3_scale(axis, low + (i + 0.5) / PLACES * (high - low));
        balls[i] = (dem_ball){p, dem_classic_depth(c, p)};
    }
    size_t kept = 0;
    for (int i = 0; i < PLACES; i++)
        if (balls[i].radius > 0)
            balls[kept++] = balls[i];
    return kept;
}

typedef struct table {
    const dem_ball *balls;
    size_t count, rows;
    double *shared;  // [count][count] of two balls
    double *volume;  // [2][count] of the best row that ends here, with so many balls and with one fewer
    uint16_t *from;  // [rows][count] the ball before
} table;

// rows of one ball more; the best volume
static double lengthen(table *t, size_t row, size_t *end)
{
    double *now = t->volume + (row & 1) * t->count, *before = t->volume + (~row & 1) * t->count, most = 0;
    for (size_t j = 0; j < t->count; j++) {
        double own = ball_volume(t->balls[j].radius), best = 0;
        size_t from = j;
        for (size_t i = 0; row > 0 && i < j; i++) {
            double gained = before[i] - t->shared[j * t->count + i];
            if (gained > best) {
                best = gained;
                from = i;
            }
        }
        now[j] = own + best;
        t->from[row * t->count + j] = (uint16_t)from;
        if (now[j] > most) {
            most = now[j];
            *end = j;
        }
    }
    return most;
}

static size_t best_row(table *t, double grain_volume, dem_ball *chosen)
{
    double most = 0;
    size_t end = 0, rows = 0;
    for (size_t row = 0; row < t->rows; row++) {
        size_t at = 0;
        double volume = lengthen(t, row, &at);
        if (volume < most + least_gain * grain_volume)
            break;
        most = volume;
        end = at;
        rows = row + 1;
    }
    size_t count = 0;
    for (size_t row = rows; row-- > 0; end = t->from[row * t->count + end]) {
        chosen[count++] = t->balls[end];
        if (row > 0 && t->from[row * t->count + end] == end)
            break;
    }
    return count;
}

static int larger_first(const void *pa, const void *pb)
{
    double a = ((const dem_ball *)pa)->radius, b = ((const dem_ball *)pb)->radius;
    return (a < b) - (a > b);
}

static dem_status place_on(dem_classic *c, int axis, dem_vec3 direction, double *least, dem_error *error)
{
    dem_ball balls[PLACES], chosen[PLACES];
    table t = {.balls = balls, .count = balls_on(c, direction, balls)};
    t.rows = c->options->spheres < t.count ? c->options->spheres : t.count;
    t.shared = dem_alloc(t.count * t.count, sizeof *t.shared);
    t.volume = dem_alloc(2 * t.count, sizeof *t.volume);
    t.from = dem_alloc(t.rows * t.count, sizeof *t.from);
    dem_status status = DEM_OK;
    if (t.shared && t.volume && t.from) {
        for (size_t j = 0; j < t.count; j++)
            for (size_t i = 0; i < j; i++)
                t.shared[j * t.count + i] = lens_volume(balls[i], balls[j]);
        size_t count = best_row(&t, c->grain->moments.volume, chosen);
        qsort(chosen, count, sizeof *chosen, larger_first);
        bool kept;
        status = dem_classic_offer(c, chosen, count, least, &kept, error);
        if (kept)
            c->value[AXIS] = axis + 1;
    } else {
        status = dem_fail_memory(error);
    }
    free(t.shared);
    free(t.volume);
    free(t.from);
    return status;
}

static dem_status place(dem_classic *c, dem_error *error)
{
    dem_solid solid = dem_solid_from_moments(c->grain->moments, v3(0, 0, 0), 0);
    double given = c->value[AXIS], least = INFINITY;
    for (int k = 0; k < 3; k++) {
        if (!isnan(given) && k + 1 != (int)given)
            continue;
        dem_vec3 axis = quat_rotate(solid.axes, v3(k == 0, k == 1, k == 2));
        DEM_TRY(place_on(c, k, axis, &least, error));
        DEM_TRY(dem_classic_go_on(c, (k + 1) / 3.0, error));
    }
    if (c->count == 0)
        return dem_fail(error, DEM_FAILED,
                        "%s of the grain runs through its inside, so the method favier has no place for spheres; take "
                        "another method",
                        isnan(given) ? "no principal axis" : "not this principal axis");
    return DEM_OK;
}

const dem_packer dem_packer_favier = {
    .name = "favier",
    .paper =
        "Favier, Abbaspour-Fard, Kremmer & Raji 1999, Eng. Computations 16, 467-480, doi:10.1108/02644409910271894",
    .about = "Inscribed spheres centred on one principal axis, placed for the largest union; for bodies of revolution. "
             "The axis not given is that of least gap.",
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .order = "largest first",
    .run = dem_classic_run,
    .place = place,
};
