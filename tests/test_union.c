#include "check.h"

#include "base/random.h"
#include "geom/ball_tree.h"
#include "geom/union.h"
#include "math/mat3.h"
#include "sections.h"

static dem_vec3 random_direction(dem_random *r)
{
    double x = random_normal(r), y = random_normal(r), z = random_normal(r);
    return v3_unit(v3(x, y, z));
}

// balls like those of a clump: centres in a unit ball, the larger the nearer to its centre
static void clump_like(dem_random *r, dem_ball *balls, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        double depth = cbrt(random_uniform(r));
        balls[i].centre = v3_scale(random_direction(r), depth);
        balls[i].radius = (1.1 - depth) * (0.5 + random_uniform(r)) + 0.6 / cbrt((double)count);
    }
}

static dem_ball_union compute(const dem_ball *balls, size_t count)
{
    dem_ball_union u;
    dem_error error;
    check_ok(dem_ball_union_compute(balls, count, true, 1, &u, &error), error);
    check(u.consistent);
    return u;
}

static void check_moments(dem_moments a, dem_moments b, double tolerance)
{
    check_near(a.volume, b.volume, tolerance);
    check_vec(a.first, b.first, tolerance);
    check_vec(v3(a.second.xx, a.second.yy, a.second.zz), v3(b.second.xx, b.second.yy, b.second.zz), tolerance);
    check_vec(v3(a.second.xy, a.second.xz, a.second.yz), v3(b.second.xy, b.second.xz, b.second.yz), tolerance);
}

// a ball cut by a plane at z = z0 .. z1 of its frame: int (1, z, z^2, x^2) dV
static void ball_slice(double r, double z0, double z1, double out[4])
{
    double p[6];
    for (int k = 1; k < 6; k++)
        p[k] = (pow(z1, k) - pow(z0, k)) / k;
    out[0] = DEM_PI * (r * r * p[1] - p[3]);
    out[1] = DEM_PI * (r * r * p[2] - p[4]);
    out[2] = DEM_PI * (r * r * p[3] - p[5]);
    out[3] = DEM_PI / 4 * (r * r * r * r * p[1] - 2 * r * r * p[3] + p[5]);
}

static void one_ball_is_a_ball(void **state)
{
    (void)state;
    dem_ball ball = {{1, -2, 3}, 0.7};
    dem_ball_union u = compute(&ball, 1);
    double v = 4 * DEM_PI / 3 * 0.343;
    check_close(u.moments.volume, v, 1e-15);
    check_close(u.area, 4 * DEM_PI * 0.49, 1e-15);
    check_vec(u.moments.first, v3(v, -2 * v, 3 * v), 1e-14);
    check_close(u.moments.second.yy, v * (4 + 0.49 / 5), 1e-15);
    check_close(u.moments.second.xz, v * 3, 1e-15);
    check(u.redundant == 0 && u.arc_count == 0);
    dem_ball_union_release(&u);
}

static void two_overlapping_balls_lose_their_lens(void **state)
{
    (void)state;
    dem_random r = random_stream(1, 0);
    for (int i = 0; i < 400; i++) {
        // radii and distance over all overlapping cases, the plane of the circle at z = z0 from the first centre
        double r1 = 0.2 + random_uniform(&r), r2 = 0.2 + random_uniform(&r);
        double d = fabs(r1 - r2) + (r1 + r2 - fabs(r1 - r2)) * random_uniform(&r);
        double z0 = (r1 * r1 + d * d - r2 * r2) / (2 * d), a[4], b[4];
        ball_slice(r1, -r1, z0, a);
        ball_slice(r2, z0 - d, r2, b);
        dem_vec3 axis = random_direction(&r);
        dem_ball balls[2] = {{{0, 0, 0}, r1}, {v3_scale(axis, d), r2}};
        dem_ball_union u = compute(balls, 2);
        double along = a[2] + b[2] + 2 * d * b[1] + d * d * b[0], across = a[3] + b[3];
        dem_moments want = {.volume = a[0] + b[0], .first = v3_scale(axis, a[1] + b[1] + d * b[0])};
        want.second =
            sym3_add(sym3_scale(sym3_outer(axis), along - across), (dem_sym3){across, across, across, 0, 0, 0});
        check_moments(u.moments, want, 1e-12);
        check_close(u.area, 2 * DEM_PI * (r1 * (r1 + z0) + r2 * (r2 + d - z0)), 1e-12);
        check(u.arc_count == 1);
        check_near(u.arcs[0].end - u.arcs[0].begin, 2 * DEM_PI, 0);
        dem_ball_union_release(&u);
    }
}

static void two_unit_balls_have_the_published_mass_properties(void **state)
{
    (void)state;
    // distance, volume, moment of inertia along and across the axis (nine digits)
    static const double want[4][4] = {{0.5, 5.72686161, 2.42880291, 3.13187744},
                                      {1, 7.06858347, 3.00414797, 5.21308031},
                                      {1.5, 8.01760625, 3.29724057, 8.03263926},
                                      {2, 8.37758041, 3.35103216, 11.7286126}};
    for (int i = 0; i < 4; i++) {
        dem_ball balls[2] = {{{0, 0, 0}, 1}, {{0, want[i][0], 0}, 1}};
        dem_union result;
        dem_error error;
        check_ok(dem_balls_union(balls, 2, &result, &error), error);
        check_close(result.solid.volume, want[i][1], 1e-9);
        check_close(result.solid.principal[0], want[i][2], 2e-9);
        check_close(result.solid.principal[1], want[i][3], 5e-9);
        check_near(result.solid.centre.y, want[i][0] / 2, 1e-15);
        check(result.pieces == (i < 3 ? 1 : 2));
    }
    dem_ball balls[2] = {{{0, 0, 0}, 1}, {{1, 0, 0}, 1}};
    dem_ball_union u = compute(balls, 2);
    check_close(u.moments.volume, 9 * DEM_PI / 4, 1e-15);
    dem_ball_union_release(&u);
}

static void five_hundred_balls_have_the_volume_of_their_sections(void **state)
{
    (void)state;
    dem_random r = random_stream(2, 0);
    static dem_ball balls[500];
    clump_like(&r, balls, 500);
    dem_ball_union u = compute(balls, 500);
    double want[3];
    sections_moments(balls, 500, want);
    check_close(u.moments.volume, want[0], 1e-9);
    check_near(u.moments.first.z, want[1], 1e-9);
    check_close(u.moments.second.zz, want[2], 1e-9);
    dem_ball_union_release(&u);
}

static void random_balls_have_the_moments_of_their_sections(void **state)
{
    (void)state;
    dem_random r = random_stream(3, 0);
    for (int trial = 0; trial < 60; trial++) {
        dem_ball balls[24];
        size_t count = 2 + random_below(&r, 23);
        for (size_t i = 0; i < count; i++) {
            balls[i].centre = v3_scale(random_direction(&r), random_uniform(&r));
            balls[i].radius = trial % 3 == 0 ? exp(-3 * random_uniform(&r)) : 0.3 + 0.3 * random_uniform(&r);
        }
        dem_ball_union u = compute(balls, count);
        for (int axis = 0; axis < 3; axis++) {
            double want[3];
            sections_moments(balls, count, want);
            check_close(u.moments.volume, want[0], 1e-9);
            check_near(v3_get(u.moments.first, (axis + 2) % 3), want[1], 1e-9);
            double second[3] = {u.moments.second.xx, u.moments.second.yy, u.moments.second.zz};
            check_near(second[(axis + 2) % 3], want[2], 1e-9);
            for (size_t i = 0; i < count; i++)
                balls[i].centre = v3(balls[i].centre.y, balls[i].centre.z, balls[i].centre.x);
        }
        dem_ball_union_release(&u);
    }
}

static void the_patches_are_the_derivatives_of_the_moments(void **state)
{
    (void)state;
    dem_random r = random_stream(4, 0);
    enum { COUNT = 12 };
    dem_ball balls[COUNT];
    clump_like(&r, balls, COUNT);
    dem_ball_union u = compute(balls, COUNT);
    const double step = 1e-5;
    for (size_t i = 0; i < COUNT; i++) {
        const dem_patch *p = &u.patches[i];
        dem_vec3 c = balls[i].centre;
        double ri = balls[i].radius, r2 = ri * ri;
        for (int k = 0; k < 4; k++) {
            dem_moments m[2];
            for (int side = 0; side < 2; side++) {
                dem_ball moved[COUNT];
                memcpy(moved, balls, sizeof moved);
                double delta = side ? step : -step;
                if (k < 3)
                    v3_set(&moved[i].centre, k, v3_get(c, k) + delta);
                else
                    moved[i].radius += delta;
                dem_ball_union v = compute(moved, COUNT);
                m[side] = v.moments;
                dem_ball_union_release(&v);
            }
            // int (1, x, x x) (n_k or 1) dn with x = c + r n: the patch integrals of one order more
            double n1 = k < 3 ? v3_get(p->first, k) : p->area;
            dem_vec3 nn = p->first;
            dem_sym3 nnn = p->second;
            const double *t = p->third;
            if (k == 0)
                nn = v3(p->second.xx, p->second.xy, p->second.xz), nnn = (dem_sym3){t[0], t[3], t[5], t[1], t[2], t[4]};
            else if (k == 1)
                nn = v3(p->second.xy, p->second.yy, p->second.yz), nnn = (dem_sym3){t[1], t[6], t[8], t[3], t[4], t[7]};
            else if (k == 2)
                nn = v3(p->second.xz, p->second.yz, p->second.zz), nnn = (dem_sym3){t[2], t[7], t[9], t[4], t[5], t[8]};
            dem_moments want = {.volume = r2 * n1, .first = v3_scale(v3_along(v3_scale(c, n1), ri, nn), r2)};
            dem_sym3 cross = {2 * c.x * nn.x,          2 * c.y * nn.y,          2 * c.z * nn.z,
                              c.x * nn.y + c.y * nn.x, c.x * nn.z + c.z * nn.x, c.y * nn.z + c.z * nn.y};
            want.second = sym3_add(sym3_add(sym3_scale(sym3_outer(c), n1), sym3_scale(cross, ri)), sym3_scale(nnn, r2));
            want.second = sym3_scale(want.second, r2);
            double s = 0.5 / step;
            dem_moments got = {(m[1].volume - m[0].volume) * s, v3_scale(v3_sub(m[1].first, m[0].first), s),
                               sym3_scale(sym3_add(m[1].second, sym3_scale(m[0].second, -1)), s)};
            check_moments(got, want, 2e-8);  // third derivatives times step^2, and rounding 1e-15 / step
        }
    }
    dem_ball_union_release(&u);
}

// every coincidence at once is judged by a twin whose balls are shaken a little
static void check_against_shaken(const dem_ball *balls, size_t count)
{
    static dem_ball shaken[MAX_BALLS];
    dem_random r = random_stream(5, count);
    dem_ball_union u = compute(balls, count);
    for (size_t i = 0; i < count; i++) {
        shaken[i].centre = v3_along(balls[i].centre, 1e-8, random_direction(&r));
        shaken[i].radius = balls[i].radius * (1 + 1e-8 * random_uniform(&r));
    }
    dem_ball_union v = compute(shaken, count);
    double size = u.moments.volume + u.area + fabs(u.moments.second.xx + u.moments.second.yy + u.moments.second.zz);
    check_moments(u.moments, v.moments, 3e-8 * size);
    check_close(u.area, v.area, 1e-7);
    dem_ball_union_release(&u);
    dem_ball_union_release(&v);
}

static void lattices_full_of_coincidences_are_no_trouble(void **state)
{
    (void)state;
    dem_ball balls[MAX_BALLS];
    // radius over spacing: touching, circles through common points, sphere through the next centre, cube corners, ...
    static const double radius[] = {0.5, 0.7, 0.70710678118654752, 0.86602540378443865, 1, 1.118033988749895, 1.5, 2};
    for (size_t k = 0; k < sizeof radius / sizeof *radius; k++)
        for (int side = 2; side <= 6; side += 2) {
            size_t n = 0;
            for (int x = 0; x < side; x++)
                for (int y = 0; y < side; y++)
                    for (int z = 0; z < side; z++)
                        balls[n++] = (dem_ball){{x, y, z}, radius[k]};
            check_against_shaken(balls, n);
        }
    // cubes of spacing 1 whose spheres meet in each cell's middle fill the lattice: no holes inside
    size_t n = 0;
    for (int i = 0; i < 27; i++)
        balls[n++] = (dem_ball){{i % 3, i / 3 % 3, i / 9}, 0.86602540378443865};
    dem_ball_union u = compute(balls, n);
    check(u.redundant == 1);
    check(u.patches[13].area == 0);
    dem_ball_union_release(&u);
    // a dense layer of a hexagonal lattice, all circles upright
    n = 0;
    for (int x = 0; x < 8; x++)
        for (int y = 0; y < 8; y++)
            balls[n++] = (dem_ball){{x + 0.5 * (y & 1), y * sqrt(0.75), 0}, 1};
    check_against_shaken(balls, n);
}

static void spheres_through_common_points_and_circles_are_no_trouble(void **state)
{
    (void)state;
    dem_random r = random_stream(6, 0);
    for (int trial = 0; trial < 300; trial++) {
        dem_ball balls[12];
        size_t n = 3 + random_below(&r, 10);
        dem_vec3 axis = random_direction(&r), p = random_direction(&r);
        for (size_t i = 0; i < n; i++) {
            double t = 2 * random_uniform(&r) - 1;
            if (trial % 3 == 0) {  // all through the point p
                balls[i].centre = random_direction(&r);
                balls[i].radius = v3_distance(balls[i].centre, p);
            } else if (trial % 3 == 1) {  // all through one circle about the axis
                balls[i].centre = v3_scale(axis, t);
                balls[i].radius = sqrt(t * t + 0.49);
            } else {  // in a row, each touching the inside of the same ball or its neighbours
                balls[i].centre = v3_scale(axis, t);
                balls[i].radius = i == 0 ? 1 - fabs(t) : (i & 1) ? 1 - fabs(t) : 0.3;
            }
        }
        check_against_shaken(balls, n);
    }
}

static void a_pencil_through_one_circle_is_the_union_of_its_outermost_balls(void **state)
{
    (void)state;
    dem_ball balls[9];
    for (int i = 0; i < 9; i++) {
        double t = (i * 4 % 9 - 4) * 0.25;
        balls[i] = (dem_ball){{0.6 * t, 0, 0.8 * t}, sqrt(t * t + 1)};
    }
    dem_ball_union u = compute(balls, 9);
    double r = sqrt(2), slice[4];
    ball_slice(r, -1, r, slice);  // centres at -1 and 1, the circle in the middle
    check_close(u.moments.volume, 2 * slice[0], 1e-13);
    check(u.redundant == 7);
    dem_ball_union_release(&u);
}

static void swallowed_and_repeated_balls_change_nothing(void **state)
{
    (void)state;
    dem_random r = random_stream(7, 0);
    dem_ball balls[60];
    clump_like(&r, balls, 20);
    dem_ball_union before = compute(balls, 20);
    for (int i = 0; i < 20; i++) {
        balls[20 + i] = balls[i];
        double s = random_uniform(&r);
        // inside its host, every other one touching it from inside
        dem_vec3 d = v3_scale(random_direction(&r), balls[i].radius * (1 - s));
        balls[40 + i] = (dem_ball){v3_add(balls[i].centre, d), balls[i].radius * s * (i & 1 ? 0.9 : 1 - 1e-14)};
    }
    balls[59].centre = balls[19].centre;  // concentric
    dem_ball_union after = compute(balls, 60);
    check_moments(after.moments, before.moments, 1e-12);
    check(after.redundant >= before.redundant + 30);
    for (int i = 0; i < 20; i++)
        check_near(after.patches[i].area, before.patches[i].area, 1e-12);
    dem_ball_union_release(&before);
    dem_ball_union_release(&after);
}

static void touching_balls_do_not_overlap(void **state)
{
    (void)state;
    dem_ball balls[3] = {{{0, 0, 0}, 1}, {{3, 0, 0}, 2}, {{3, 4, 0}, 2}};
    dem_ball_union u = compute(balls, 3);
    check_close(u.moments.volume, 4 * DEM_PI / 3 * 17, 1e-14);
    check(dem_ball_pieces(balls, 3, 0, NULL) == 3);
    dem_ball_union_release(&u);
}

static void nearly_equal_balls_keep_every_digit(void **state)
{
    (void)state;
    // two unit balls a tiny distance d apart: volume 4/3 pi + pi d to first order
    for (double d = 1e-3; d > 1e-16; d /= 7) {
        dem_ball balls[2] = {{{0, 0, 0}, 1}, {{0, 0, d}, 1}};
        dem_ball_union u = compute(balls, 2);
        check_near(u.moments.volume, 4 * DEM_PI / 3 + DEM_PI * d - DEM_PI * d * d * d / 12, 1e-14);
        dem_ball_union_release(&u);
    }
    // and a handful of them among others
    dem_random r = random_stream(8, 0);
    for (double d = 1e-5; d > 1e-17; d /= 10) {
        dem_ball balls[30];
        clump_like(&r, balls, 10);
        for (int i = 10; i < 30; i++) {
            balls[i].centre = v3_along(balls[i % 10].centre, d, random_direction(&r));
            balls[i].radius = balls[i % 10].radius * (1 + d * random_uniform(&r));
        }
        dem_ball_union few = compute(balls, 10), many = compute(balls, 30);
        check_moments(few.moments, many.moments, 60 * d + 1e-12);
        dem_ball_union_release(&few);
        dem_ball_union_release(&many);
    }
}

static void size_and_place_do_not_matter(void **state)
{
    (void)state;
    dem_random r = random_stream(9, 0);
    dem_ball balls[40], other[40];
    clump_like(&r, balls, 40);
    dem_union a, b;
    dem_error error;
    check_ok(dem_balls_union(balls, 40, &a, &error), error);
    for (double scale = 1e-9; scale < 2e9; scale *= 1e9) {
        for (int i = 0; i < 40; i++)
            other[i] = (dem_ball){v3_scale(balls[i].centre, scale), balls[i].radius * scale};
        check_ok(dem_balls_union(other, 40, &b, &error), error);
        check_close(b.solid.volume, a.solid.volume * pow(scale, 3), 1e-13);
        for (int k = 0; k < 3; k++)
            check_close(b.solid.principal[k], a.solid.principal[k] * pow(scale, 5), 1e-12);
    }
    dem_vec3 far = {1e6, -2e6, 3e6};
    for (int i = 0; i < 40; i++)
        other[i] = (dem_ball){v3_add(balls[i].centre, far), balls[i].radius};
    check_ok(dem_balls_union(other, 40, &b, &error), error);
    check_close(b.solid.volume, a.solid.volume, 1e-8);  // the coordinates themselves are rounded to 2e-10
    check_vec(v3_sub(b.solid.centre, far), a.solid.centre, 1e-8);
    for (int k = 0; k < 3; k++)
        check_close(b.solid.principal[k], a.solid.principal[k], 1e-8);
    check(a.pieces == b.pieces && a.redundant == b.redundant);
}

static void creases_lie_on_two_balls_and_inside_no_other(void **state)
{
    (void)state;
    dem_random r = random_stream(10, 0);
    dem_ball balls[60];
    clump_like(&r, balls, 60);
    dem_ball_union u = compute(balls, 60);
    check(u.arc_count > 60);
    for (size_t k = 0; k < u.arc_count; k++) {
        dem_arc a = u.arcs[k];
        check(a.i < a.j);
        check(a.end > a.begin);
        for (int step = 0; step <= 8; step++) {
            double t = a.begin + (a.end - a.begin) * step / 8;
            dem_vec3 n = v3_along(v3_scale(a.u, a.h), a.s, v3_along(v3_scale(a.a, cos(t)), sin(t), a.b));
            dem_vec3 p = v3_along(balls[a.i].centre, balls[a.i].radius, n);
            check_near(v3_distance(p, balls[a.j].centre), balls[a.j].radius, 1e-14);
            for (size_t l = 0; l < 60; l++)
                check(v3_distance(p, balls[l].centre) > balls[l].radius - 1e-12);
        }
    }
    dem_ball_union_release(&u);
}

static void pieces_are_counted_with_a_margin(void **state)
{
    (void)state;
    dem_ball balls[6] = {{{5, 0, 0}, 1},   {{0, 0, 0}, 1}, {{1.9, 0, 0}, 1},
                         {{3.7, 0, 0}, 1}, {{0, 9, 0}, 1}, {{0, 9, 0}, 0.1}};
    uint32_t piece[6];
    check(dem_ball_pieces(balls, 6, 0, piece) == 2);
    check(piece[0] == 0 && piece[1] == 0 && piece[2] == 0 && piece[3] == 0 && piece[4] == 4 && piece[5] == 4);
    check(dem_ball_pieces(balls, 6, 0.15, piece) == 3);
    check(piece[0] == 0 && piece[1] == 1 && piece[2] == 0 && piece[3] == 0);
    check(dem_ball_pieces(balls, 6, 0.3, NULL) == 4);
    check(dem_ball_pieces(balls, 0, 0, NULL) == 0);
}

static void a_hundred_thousand_balls_are_done_in_time(void **state)
{
    (void)state;
    enum { SIDE = 46 };
    size_t count = (size_t)SIDE * SIDE * SIDE;
    dem_ball *balls = malloc(count * sizeof *balls);
    dem_random r = random_stream(11, 0);
    for (size_t i = 0; i < count; i++) {
        double x = (double)(i % SIDE), y = (double)(i / SIDE % SIDE), z = (double)(i / SIDE / SIDE);
        balls[i] = (dem_ball){v3_along(v3(x, y, z), 0.3, random_direction(&r)), 0.4 + 0.3 * random_uniform(&r)};
    }
    dem_ball_union u = compute(balls, count);
    check(u.moments.volume > 0.5 * (double)count);
    check(u.moments.volume < (double)count);
    dem_ball_union_release(&u);
    free(balls);
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    dem_ball balls[COUNT];
    dem_random r = random_stream(17, 0);
    clump_like(&r, balls, COUNT);
    dem_ball_union alone = compute(balls, COUNT);
    for (int threads = 1; threads <= 8; threads *= 2) {
        dem_ball_union u;
        dem_error error;
        check_ok(dem_ball_union_compute(balls, COUNT, false, threads, &u, &error), error);
        check(memcmp(u.patches, alone.patches, COUNT * sizeof *u.patches) == 0);
        check(memcmp(&u.moments, &alone.moments, sizeof u.moments) == 0);
        check(u.area == alone.area && u.redundant == alone.redundant && u.consistent);
        dem_ball_union_release(&u);
    }
    dem_ball_union_release(&alone);
}

static void balls_that_are_none_are_refused(void **state)
{
    (void)state;
    dem_union u;
    dem_error error;
    dem_ball balls[2] = {{{0, 0, 0}, 1}, {{0, 0, 0}, 0}};
    check(dem_balls_union(balls, 2, &u, &error) == DEM_USAGE);
    balls[1] = (dem_ball){{0, NAN, 0}, 1};
    check(dem_balls_union(balls, 2, &u, &error) == DEM_USAGE);
    check(dem_balls_union(balls, 0, &u, &error) == DEM_USAGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_ball_is_a_ball),
        cmocka_unit_test(two_overlapping_balls_lose_their_lens),
        cmocka_unit_test(two_unit_balls_have_the_published_mass_properties),
        cmocka_unit_test(five_hundred_balls_have_the_volume_of_their_sections),
        cmocka_unit_test(random_balls_have_the_moments_of_their_sections),
        cmocka_unit_test(the_patches_are_the_derivatives_of_the_moments),
        cmocka_unit_test(lattices_full_of_coincidences_are_no_trouble),
        cmocka_unit_test(spheres_through_common_points_and_circles_are_no_trouble),
        cmocka_unit_test(a_pencil_through_one_circle_is_the_union_of_its_outermost_balls),
        cmocka_unit_test(swallowed_and_repeated_balls_change_nothing),
        cmocka_unit_test(touching_balls_do_not_overlap),
        cmocka_unit_test(nearly_equal_balls_keep_every_digit),
        cmocka_unit_test(size_and_place_do_not_matter),
        cmocka_unit_test(creases_lie_on_two_balls_and_inside_no_other),
        cmocka_unit_test(pieces_are_counted_with_a_margin),
        cmocka_unit_test(a_hundred_thousand_balls_are_done_in_time),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(balls_that_are_none_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
