#include "shapes.h"

#include "base/random.h"
#include "clump/fidelity.h"
#include "geom/tree.h"
#include "geom/union.h"

enum { MAX_BALLS = 120, CREASE_POINTS = 200000, RAYS = 30000, POINTS = 15000, CLIMBERS = 60 };

static dem_vec3 random_direction(dem_random *r)
{
    double x = random_normal(r), y = random_normal(r), z = random_normal(r);
    return v3_unit(v3(x, y, z));
}

static dem_fidelity measure(const dem_mesh *mesh, const dem_ball *balls, size_t count, int threads)
{
    dem_fidelity f;
    dem_error error;
    dem_ctx ctx = {.threads = threads};
    check_ok(dem_fidelity_measure(&ctx, mesh, balls, count, 0, &f, &error), error);
    return f;
}

// --- the twin: everything by all pairs, random points and hill climbing

typedef struct twin {
    const dem_mesh *mesh;
    const dem_ball *balls;
    size_t count;
    dem_tree tree;
    dem_vec3 *creases;
    size_t crease_count;
    dem_random random;
} twin;

static double level(const twin *w, dem_vec3 p, size_t except, size_t *ball)
{
    double best = INFINITY;
    for (size_t i = 0; i < w->count; i++) {
        double l = v3_distance(p, w->balls[i].centre) - w->balls[i].radius;
        if (i != except && l < best) {
            best = l;
            if (ball)
                *ball = i;
        }
    }
    return best;
}

// points of all circles in which two spheres meet that no third ball holds
static void collect_creases(twin *w)
{
    for (size_t i = 0; i < w->count; i++)
        for (size_t j = i + 1; j < w->count; j++) {
            dem_ball a = w->balls[i], b = w->balls[j];
            dem_vec3 d = v3_sub(b.centre, a.centre);
            double dist = v3_norm(d), h = (a.radius * a.radius + dist * dist - b.radius * b.radius) / (2 * dist);
            if (!(fabs(h) < a.radius))
                continue;
            dem_vec3 u = v3_unit(d), e = v3_normal_to(u), f = v3_cross(u, e);
            double s = sqrt(a.radius * a.radius - h * h);
            for (int k = 0; k < 400; k++) {
                double t = 2 * DEM_PI / 400 * k;
                dem_vec3 n = v3_along(v3_scale(e, cos(t)), sin(t), f), p = v3_along(v3_along(a.centre, h, u), s, n);
                if (level(w, p, SIZE_MAX, NULL) > -1e-9 && w->crease_count < CREASE_POINTS)
                    w->creases[w->crease_count++] = p;
            }
        }
}

static double to_boundary(const twin *w, dem_vec3 p, dem_vec3 *normal)
{
    size_t ball = 0;
    double best = level(w, p, SIZE_MAX, &ball);
    *normal = v3_unit(v3_sub(p, w->balls[ball].centre));
    if (best >= 0)
        return best;
    best = INFINITY;
    for (size_t i = 0; i < w->count; i++) {
        dem_vec3 n = v3_unit(v3_sub(p, w->balls[i].centre));
        double d = fabs(v3_distance(p, w->balls[i].centre) - w->balls[i].radius);
        if (d < best && level(w, v3_along(w->balls[i].centre, w->balls[i].radius, n), i, NULL) >= 0) {
            best = d;
            *normal = n;
        }
    }
    for (size_t k = 0; k < w->crease_count; k++) {
        double d = v3_distance(p, w->creases[k]);
        if (d < best) {
            best = d;
            *normal = v3_unit(v3_sub(w->creases[k], p));
        }
    }
    return best;
}

// positive outside
static double to_mesh(const twin *w, dem_vec3 p)
{
    double best = INFINITY;
    for (size_t t = 0; t < w->mesh->triangle_count; t++) {
        const uint32_t *q = w->mesh->triangles + 3 * t;
        const dem_vec3 *v = w->mesh->vertices;
        best = fmin(best, v3_norm2(v3_sub(p, dem_triangle_closest(p, v[q[0]], v[q[1]], v[q[2]]))));
    }
    return dem_tree_inside(&w->tree, p) ? -sqrt(best) : sqrt(best);
}

static int by_from(const void *left, const void *right)
{
    const double *a = left, *b = right;
    return a[0] < b[0] ? -1 : a[0] > b[0];
}

// int r^2 dr over what lies in the mesh or the balls but not in both, along the ray from the origin to beyond `surface`
static double ray_difference(const twin *w, dem_vec3 n, double surface)
{
    double span[MAX_BALLS][2], cubes = 0, reach = 0;
    size_t count = 0;
    for (size_t i = 0; i < w->count; i++) {
        double along = v3_dot(n, w->balls[i].centre), r = w->balls[i].radius;
        double root = r * r - v3_norm2(v3_along(w->balls[i].centre, -along, n));
        if (root > 0 && along + sqrt(root) > 0) {
            span[count][0] = fmax(0, along - sqrt(root));
            span[count++][1] = along + sqrt(root);
        }
    }
    qsort(span, count, sizeof *span, by_from);
    for (size_t k = 0; k <= count; k++) {
        // a hole before the span, up to the surface; then what of the span lies beyond it
        double from = k < count ? span[k][0] : INFINITY, to = k < count ? span[k][1] : 0;
        double hole = fmin(from, surface), bulge = fmax(fmax(from, reach), surface);
        cubes += hole > reach ? pow(hole, 3) - pow(reach, 3) : 0;
        cubes += to > bulge ? pow(to, 3) - pow(bulge, 3) : 0;
        reach = fmax(reach, to);
    }
    return cubes / 3;
}

// for meshes that each ray from the origin meets once
static double twin_gap(const twin *w, double mesh_volume)
{
    double difference = 0;
    dem_union u;
    dem_error error;
    for (int k = 0; k < RAYS; k++) {
        double z = 1 - (2 * k + 1.0) / RAYS, s = sqrt(1 - z * z), t = 2.399963229728653 * k, surface = 0;
        dem_vec3 n = v3(s * cos(t), s * sin(t), z);
        for (size_t m = 0; m < w->mesh->triangle_count; m++) {
            const uint32_t *q = w->mesh->triangles + 3 * m;
            dem_vec3 a = w->mesh->vertices[q[0]], b = w->mesh->vertices[q[1]], c = w->mesh->vertices[q[2]];
            double ab = v3_dot(n, v3_cross(a, b)), bc = v3_dot(n, v3_cross(b, c)), ca = v3_dot(n, v3_cross(c, a));
            if (ab >= 0 && bc >= 0 && ca >= 0)
                surface = v3_dot(a, v3_cross(b, c)) / (ab + bc + ca);
        }
        difference += ray_difference(w, n, surface) * 4 * DEM_PI / RAYS;
    }
    check_ok(dem_balls_union(w->balls, w->count, &u, &error), error);
    return difference / ((mesh_volume + u.solid.volume + difference) / 2);
}

typedef struct figures {
    double mesh_mean, union_mean, mesh_max, union_max, protrusion, normal_deg;
} figures;

static dem_vec3 on_triangle(const twin *w, size_t t, double u, double v)
{
    const uint32_t *q = w->mesh->triangles + 3 * t;
    dem_vec3 a = w->mesh->vertices[q[0]], b = w->mesh->vertices[q[1]], c = w->mesh->vertices[q[2]];
    return v3_along(v3_along(a, u, v3_sub(b, a)), v, v3_sub(c, a));
}

static double triangle_area(const twin *w, size_t t, dem_vec3 *normal)
{
    dem_vec3 a = on_triangle(w, t, 0, 0),
             n = v3_cross(v3_sub(on_triangle(w, t, 1, 0), a), v3_sub(on_triangle(w, t, 0, 1), a));
    *normal = v3_unit(n);
    return v3_norm(n) / 2;
}

static void twin_mesh_side(twin *w, figures *f)
{
    double area = 0, total = 0, sum = 0, angle = 0;
    dem_vec3 n, m;
    for (size_t t = 0; t < w->mesh->triangle_count; t++)
        total += triangle_area(w, t, &n);
    size_t points = 0;
    for (size_t t = 0; t < w->mesh->triangle_count; t++) {
        area += triangle_area(w, t, &n);
        double best = 0, bu = 0, bv = 0;
        for (; (double)points < area / total * POINTS; points++) {
            double u = random_uniform(&w->random), v = random_uniform(&w->random);
            if (u + v > 1)
                u = 1 - u, v = 1 - v;
            double d = to_boundary(w, on_triangle(w, t, u, v), &m);
            sum += d;
            angle += acos(fmax(-1, fmin(1, v3_dot(n, m))));
            if (d > best)
                best = d, bu = u, bv = v;
        }
        for (int c = 0; c < 3; c++)
            f->mesh_max = fmax(f->mesh_max, to_boundary(w, on_triangle(w, t, c == 1, c == 2), &m));
        // climb where there is hope
        double step = 0.3;
        for (int k = 0; k < 300 && best > 0.7 * f->mesh_max; k++, step *= 0.98) {
            double u = bu + step * random_normal(&w->random), v = bv + step * random_normal(&w->random);
            if (u < 0 || v < 0 || u + v > 1)
                continue;
            double d = to_boundary(w, on_triangle(w, t, u, v), &m);
            if (d > best)
                best = d, bu = u, bv = v;
        }
        f->mesh_max = fmax(f->mesh_max, best);
    }
    f->mesh_mean = sum / (double)points;
    f->normal_deg = angle / (double)points * 180 / DEM_PI;
}

static void climb(twin *w, size_t ball, dem_vec3 n, double sign, double *best)
{
    double step = 0.1, here = -INFINITY;
    for (int k = 0; k < 250; k++, step *= 0.97) {
        dem_vec3 m = v3_unit(v3_along(n, step, random_direction(&w->random)));
        dem_vec3 p = v3_along(w->balls[ball].centre, w->balls[ball].radius, m);
        if (level(w, p, ball, NULL) < 0)
            continue;
        double d = sign * to_mesh(w, p);
        if (d > here)
            here = d, n = m;
    }
    *best = fmax(*best, here);
}

static void twin_union_side(twin *w, figures *f)
{
    static size_t ball[POINTS];
    static dem_vec3 direction[POINTS];
    static double value[POINTS];
    double sum = 0, largest = 0;
    for (size_t i = 0; i < w->count; i++)
        largest = fmax(largest, w->balls[i].radius);
    for (size_t k = 0; k < POINTS;) {
        size_t i = random_below(&w->random, w->count);
        double part = w->balls[i].radius / largest;
        dem_vec3 n = random_direction(&w->random), p = v3_along(w->balls[i].centre, w->balls[i].radius, n);
        if (random_uniform(&w->random) > part * part || level(w, p, i, NULL) < 0)
            continue;
        ball[k] = i;
        direction[k] = n;
        value[k] = to_mesh(w, p);
        sum += fabs(value[k++]) / POINTS;
    }
    f->union_mean = sum;
    double inside = 0;
    for (int side = -1; side <= 1; side += 2) {
        double best = 0;
        for (int c = 0; c < CLIMBERS; c++) {
            size_t top = 0;
            for (size_t k = 1; k < POINTS; k++)
                if (side * value[k] > side * value[top])
                    top = k;
            best = fmax(best, side * value[top]);
            if (side * value[top] > 0)
                climb(w, ball[top], direction[top], side, &best);
            value[top] = 0;
        }
        *(side > 0 ? &f->protrusion : &inside) = best;
    }
    f->union_max = fmax(f->protrusion, inside);
}

static void check_against_twin(const dem_mesh *mesh, const dem_ball *balls, size_t count)
{
    dem_error error;
    dem_fidelity got = measure(mesh, balls, count, 1);
    twin w = {.mesh = mesh, .balls = balls, .count = count, .random = random_stream(41, count)};
    w.creases = malloc(CREASE_POINTS * sizeof *w.creases);
    check_ok(dem_tree_build(&w.tree, mesh->vertices, mesh->triangles, mesh->triangle_count, &error), error);
    collect_creases(&w);
    dem_solid solid = dem_mesh_solid(mesh);
    double size = cbrt(6 / DEM_PI * solid.volume);
    figures f = {0};
    twin_mesh_side(&w, &f);
    twin_union_side(&w, &f);
    check_close(got.iou_gap, twin_gap(&w, solid.volume), 0.02);
    check_close(got.distance_mean, (f.mesh_mean + f.union_mean) / 2 / size, 0.02);
    check_close(got.distance_max, fmax(f.mesh_max, f.union_max) / size, 0.02);
    check_near(got.protrusion, f.protrusion / size, 0.02 * f.protrusion / size + 1e-6);
    check_close(got.normal_deviation_deg, f.normal_deg, 0.02);
    free(w.creases);
    dem_tree_release(&w.tree);
}

// balls inside the mesh, a little too large
static size_t inscribed_balls(const dem_mesh *mesh, dem_ball *balls, size_t count, double factor)
{
    dem_tree tree;
    dem_error error;
    check_ok(dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, &error), error);
    dem_random r = random_stream(42, 0);
    dem_box box = tree.nodes[0].box;
    for (size_t i = 0; i < count;) {
        double x = random_uniform(&r), y = random_uniform(&r), z = random_uniform(&r);
        dem_vec3 d = v3_sub(box.high, box.low), p = v3_add(box.low, v3(x * d.x, y * d.y, z * d.z));
        double distance = dem_tree_closest(&tree, p, INFINITY, NULL, NULL);
        if (dem_tree_inside(&tree, p) && distance > 0.05)
            balls[i++] = (dem_ball){p, distance * factor};
    }
    dem_tree_release(&tree);
    return count;
}

static void a_bad_clump_is_measured_as_by_brute_force(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(7);
    dem_ball one = {{0.1, 0.05, 0}, 0.7},
             three[3] = {{{0.6, 0, 0}, 0.5}, {{-0.3, 0.2, 0}, 0.45}, {{-0.4, -0.3, 0.1}, 0.4}};
    check_against_twin(&mesh, &one, 1);
    check_against_twin(&mesh, three, 3);
    dem_mesh_free(&mesh);
    mesh = shape_box(1, 0.8, 0.5);
    shape_move(&mesh, (dem_quat){1, 0, 0, 0}, v3(-0.5, -0.4, -0.25));
    dem_ball balls[MAX_BALLS];
    check_against_twin(&mesh, balls, inscribed_balls(&mesh, balls, 25, 1.1));
    dem_mesh_free(&mesh);
}

static void a_fair_clump_is_measured_as_by_brute_force(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(7);
    dem_ball balls[MAX_BALLS];
    check_against_twin(&mesh, balls, inscribed_balls(&mesh, balls, MAX_BALLS, 1.03));
    dem_mesh_free(&mesh);
}

static void a_packed_clump_is_measured_as_by_brute_force(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(8);
    dem_pack_options options = dem_pack_defaults();
    options.spheres = 60;
    options.effort = DEM_EFFORT_FAST;
    dem_pack pack;
    dem_error error;
    check_ok(dem_clump_pack(NULL, &mesh, &options, &pack, &error), error);
    check_against_twin(&mesh, pack.balls, pack.count);
    dem_pack_free(&pack);
    dem_mesh_free(&mesh);
}

static void a_concentric_ball_is_off_by_its_excess(void **state)
{
    (void)state;
    dem_mesh mesh = shape_sphere(60);  // its facets lie up to 3e-4 below the sphere
    for (double excess = -0.2; excess < 0.3; excess += 0.1) {
        dem_ball ball = {{0, 0, 0}, 1 + excess};
        dem_fidelity f = measure(&mesh, &ball, 1, 1);
        double volume = pow(1 + excess, 3), d = fabs(excess) / 2;
        if (d < 1e-9)
            continue;
        check_near(f.volume_error, volume - 1, 2e-3);
        check_near(f.iou_gap, 1 - fmin(volume, 1 / volume), 1e-3);
        check_near(f.distance_mean, d, 4e-4);
        check_near(f.distance_max, d, 4e-4);
        check_near(f.protrusion, excess > 0 ? d : 0, 4e-4);
        check_near(f.inertia_error, fabs(pow(1 + excess, 5) - 1), 8e-3);
        check_near(f.centre_offset, 0, 1e-12);
        check(f.normal_deviation_deg < 1.5);  // facets are tilted by half their width
        check(f.pieces == 1);
        check_near(f.overlap_ratio, 1, 1e-12);
    }
    dem_mesh_free(&mesh);
}

static void masses_are_compared_exactly(void **state)
{
    (void)state;
    dem_mesh mesh = shape_box(3, 2, 1);
    dem_ball balls[3] = {{{1, 1, 0.5}, 0.5}, {{1.5, 1, 0.5}, 0.5}, {{2.6, 1, 0.5}, 0.3}};
    dem_fidelity f = measure(&mesh, balls, 3, 1);
    dem_union u;
    dem_error error;
    check_ok(dem_balls_union(balls, 3, &u, &error), error);
    check_close(f.volume_error, u.solid.volume / 6 - 1, 1e-12);
    check_close(f.centre_offset, v3_distance(u.solid.centre, v3(1.5, 1, 0.5)) / cbrt(36 / DEM_PI), 1e-12);
    double box[3] = {6 * (4 + 1) / 12.0, 6 * (9 + 1) / 12.0, 6 * (9 + 4) / 12.0}, worst = 0;
    for (int k = 0; k < 3; k++)
        worst = fmax(worst, fabs(u.solid.principal[k] / box[k] - 1));
    check_close(f.inertia_error, worst, 1e-12);
    check_close(f.overlap_ratio, 4 * DEM_PI / 3 * 0.277 / u.solid.volume, 1e-12);
    check(f.pieces == 2);
    dem_mesh_free(&mesh);
}

static void a_small_gap_is_measured_directly(void **state)
{
    (void)state;
    // a ball a hair larger than the sphere: the difference is a shell of half a permille
    dem_mesh mesh = shape_sphere(100);
    double facets = dem_mesh_solid(&mesh).volume / (4 * DEM_PI / 3);
    dem_ball ball = {{0, 0, 0}, 1};
    double gap, estimate;
    dem_error error;
    check_ok(dem_fidelity_gap(NULL, &mesh, &ball, 1, 0, &gap, &estimate, &error), error);
    check_close(gap, 1 - facets, 0.01);
    check(gap < 5e-4);
    check(estimate < 0.01);
    dem_mesh_free(&mesh);
}

static void size_place_and_turn_do_not_matter(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(7);
    dem_ball balls[MAX_BALLS], moved[MAX_BALLS];
    size_t count = inscribed_balls(&mesh, balls, 40, 1.05);
    dem_fidelity want = measure(&mesh, balls, count, 1);
    dem_quat turn = quat_unit((dem_quat){0.3, -0.7, 0.2, 0.5});
    for (double scale = 1e-9; scale < 2e9; scale *= 1e9) {
        dem_mesh other;
        dem_error error;
        dem_vec3 shift = v3(3 * scale, -7 * scale, scale);
        check_ok(dem_mesh_copy(&mesh, &other, &error), error);
        dem_mesh_scale(&other, scale);
        shape_move(&other, turn, shift);
        for (size_t i = 0; i < count; i++) {
            dem_vec3 c = quat_rotate(turn, v3_scale(balls[i].centre, scale));
            moved[i] = (dem_ball){v3_add(c, shift), balls[i].radius * scale};
        }
        dem_fidelity got = measure(&other, moved, count, 1);
        check_close(got.volume_error, want.volume_error, 1e-9);
        check_close(got.inertia_error, want.inertia_error, 1e-9);
        check_close(got.iou_gap, want.iou_gap, 0.01);
        check_close(got.distance_mean, want.distance_mean, 0.01);
        check_close(got.distance_max, want.distance_max, 0.01);
        check_close(got.protrusion, want.protrusion, 0.01);
        check_close(got.normal_deviation_deg, want.normal_deviation_deg, 0.01);
        dem_mesh_free(&other);
    }
    dem_mesh_free(&mesh);
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(10);
    dem_ball balls[MAX_BALLS];
    size_t count = inscribed_balls(&mesh, balls, 60, 1.05);
    dem_fidelity one = measure(&mesh, balls, count, 1);
    for (int threads = 2; threads <= 8; threads *= 2) {
        dem_fidelity many = measure(&mesh, balls, count, threads);
        check(memcmp(&one, &many, sizeof one) == 0);
    }
    dem_mesh_free(&mesh);
}

static void what_cannot_be_measured_is_refused(void **state)
{
    (void)state;
    dem_mesh mesh = shape_box(1, 1, 1);
    dem_ball ball = {{0, 0, 0}, 1};
    dem_fidelity f;
    dem_error error;
    check(dem_fidelity_measure(NULL, &mesh, &ball, 0, 0, &f, &error) == DEM_USAGE);
    ball.radius = -1;
    check(dem_fidelity_measure(NULL, &mesh, &ball, 1, 0, &f, &error) == DEM_USAGE);
    ball.radius = 1;
    shape_flip(&mesh, 0, 12);
    check(dem_fidelity_measure(NULL, &mesh, &ball, 1, 0, &f, &error) == DEM_BAD_INPUT);
    mesh.triangle_count = 0;
    check(dem_fidelity_measure(NULL, &mesh, &ball, 1, 0, &f, &error) == DEM_USAGE);
    dem_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bad_clump_is_measured_as_by_brute_force),
        cmocka_unit_test(a_fair_clump_is_measured_as_by_brute_force),
        cmocka_unit_test(a_packed_clump_is_measured_as_by_brute_force),
        cmocka_unit_test(a_concentric_ball_is_off_by_its_excess),
        cmocka_unit_test(masses_are_compared_exactly),
        cmocka_unit_test(a_small_gap_is_measured_directly),
        cmocka_unit_test(size_place_and_turn_do_not_matter),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(what_cannot_be_measured_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
