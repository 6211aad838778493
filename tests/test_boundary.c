#include "check.h"

#include "base/random.h"
#include "geom/boundary.h"

enum { BALLS = 40, CLOUD = 30000 };

static dem_vec3 random_direction(dem_random *r)
{
    double x = random_normal(r), y = random_normal(r), z = random_normal(r);
    return v3_unit(v3(x, y, z));
}

static void make_balls(dem_ball *balls, uint64_t seed)
{
    dem_random r = random_stream(seed, 0);
    for (size_t i = 0; i < BALLS; i++) {
        double depth = cbrt(random_uniform(&r));
        balls[i].centre = v3_scale(random_direction(&r), depth);
        balls[i].radius = 0.15 + 0.3 * random_uniform(&r);
    }
}

// the boundary as points: those of each sphere that no other ball holds
static size_t make_cloud(const dem_ball *balls, dem_vec3 *cloud)
{
    dem_random r = random_stream(99, 0);
    size_t count = 0;
    while (count < CLOUD) {
        size_t i = random_below(&r, BALLS);
        bool covered = random_uniform(&r) * 0.2025 > balls[i].radius * balls[i].radius;  // even by area
        dem_vec3 p = v3_along(balls[i].centre, balls[i].radius, random_direction(&r));
        for (size_t j = 0; j < BALLS && !covered; j++)
            covered = j != i && v3_distance(p, balls[j].centre) < balls[j].radius;
        if (!covered)
            cloud[count++] = p;
    }
    return count;
}

static void the_closest_point_is_on_the_boundary_and_none_is_closer(void **state)
{
    (void)state;
    dem_ball balls[BALLS];
    static dem_vec3 cloud[CLOUD];
    make_balls(balls, 1);
    size_t count = make_cloud(balls, cloud), creases = 0, inside_points = 0;
    dem_boundary b;
    dem_error error;
    check_ok(dem_boundary_build(&b, balls, BALLS, &error), error);
    dem_random r = random_stream(2, 0);
    for (int i = 0; i < 1500; i++) {
        dem_vec3 p = v3_scale(random_direction(&r), 1.6 * cbrt(random_uniform(&r)));
        dem_boundary_hit hit = dem_boundary_closest(&b, p, -1, INFINITY);
        check_near(v3_distance(p, hit.point), hit.distance, 1e-12);
        int on = 0;
        bool inside = false;
        dem_vec3 normal = {0};
        for (size_t j = 0; j < BALLS; j++) {
            double level = v3_distance(hit.point, balls[j].centre) - balls[j].radius;
            check(level > -1e-11);
            if (level < 1e-11) {
                on++;
                normal = v3_add(normal, v3_unit(v3_sub(hit.point, balls[j].centre)));
            }
            inside = inside || v3_distance(p, balls[j].centre) < balls[j].radius;
        }
        check(on >= 1);
        check(inside || on == 1);  // from outside a crease is a valley, never closest
        creases += on > 1;
        inside_points += inside;
        if (on <= 2)
            check_vec(hit.normal, v3_unit(normal), 1e-9);
        double nearest = INFINITY;
        for (size_t k = 0; k < count; k++)
            nearest = fmin(nearest, v3_distance(p, cloud[k]));
        check(nearest > hit.distance - 1e-12);
        check(nearest < hit.distance + 0.08);  // 30000 points over an area of about 20
    }
    check(creases > 50);
    check(inside_points > 300);
    dem_boundary_release(&b);
}

static void a_search_that_has_enough_stops_within_it(void **state)
{
    (void)state;
    dem_ball balls[BALLS];
    make_balls(balls, 3);
    dem_boundary b;
    dem_error error;
    check_ok(dem_boundary_build(&b, balls, BALLS, &error), error);
    dem_random r = random_stream(4, 0);
    for (int i = 0; i < 3000; i++) {
        dem_vec3 p = v3_scale(random_direction(&r), 1.2 * random_uniform(&r));
        double exact = dem_boundary_closest(&b, p, -1, INFINITY).distance;
        double got = dem_boundary_closest(&b, p, 0.1, INFINITY).distance;
        check(got >= exact);
        check(got <= fmax(exact, 0.1));
        // what is known of it, or thought to be, changes nothing
        check(dem_boundary_closest(&b, p, -1, 1.5 * exact + 1e-9).distance == exact);
        check(dem_boundary_closest(&b, p, -1, 0.5 * exact).distance == exact);
    }
    dem_boundary_release(&b);
}

static void samples_stand_for_the_whole_boundary(void **state)
{
    (void)state;
    for (uint64_t seed = 5; seed < 9; seed++) {
        dem_ball balls[BALLS];
        make_balls(balls, seed);
        dem_boundary b;
        dem_boundary_point *points;
        size_t count;
        dem_error error;
        check_ok(dem_boundary_build(&b, balls, BALLS, &error), error);
        check_ok(dem_boundary_sample(&b, 20000, &points, &count, &error), error);
        double area = 0, volume = 0;
        dem_vec3 flux = {0};
        for (size_t i = 0; i < count; i++) {
            dem_boundary_point p = points[i];
            dem_ball ball = balls[p.ball];
            check_vec(p.point, v3_along(ball.centre, ball.radius, p.normal), 1e-12);
            for (size_t j = 0; j < BALLS; j++)
                check(v3_distance(p.point, balls[j].centre) > balls[j].radius - 1e-11);
            area += p.area;
            volume += p.area * v3_dot(p.point, p.normal) / 3;
            flux = v3_along(flux, p.area, p.normal);
        }
        check(count < 2 * 20000);
        check_close(area, b.whole.area, 1e-3);  // slivers without a point
        check_close(volume, b.whole.moments.volume, 2e-3);
        check_vec(flux, v3(0, 0, 0), 5e-3 * area);
        free(points);
        dem_boundary_release(&b);
    }
}

static void covered_directions_lie_in_other_balls(void **state)
{
    (void)state;
    dem_ball balls[BALLS];
    make_balls(balls, 10);
    dem_boundary b;
    dem_error error;
    check_ok(dem_boundary_build(&b, balls, BALLS, &error), error);
    dem_random r = random_stream(11, 0);
    size_t marginal = 0;
    for (int k = 0; k < 20000; k++) {
        uint32_t i = (uint32_t)random_below(&r, BALLS);
        dem_vec3 n = random_direction(&r), p = v3_along(balls[i].centre, balls[i].radius, n);
        bool covered = false;
        for (size_t j = 0; j < BALLS; j++)
            covered = covered || (j != i && v3_distance(p, balls[j].centre) < balls[j].radius);
        if (b.whole.patches[i].area == 0) {
            check(covered);
            continue;
        }
        check(dem_boundary_covered(&b, i, n, 0) == covered);
        check(covered || v3_dot(n, v3_unit(b.whole.patches[i].first)) >= b.cones[i]);
        if (dem_boundary_covered(&b, i, n, 0.1)) {
            dem_vec3 m = v3_unit(v3_along(n, 0.09, random_direction(&r)));
            check(dem_boundary_covered(&b, i, m, 0));
            marginal++;
        }
    }
    check(marginal > 1000);
    dem_boundary_release(&b);
}

static void a_single_ball_and_a_shell_around_a_void_have_boundaries(void **state)
{
    (void)state;
    dem_ball one = {{1, 0, 0}, 2};
    dem_boundary b;
    dem_error error;
    check_ok(dem_boundary_build(&b, &one, 1, &error), error);
    check_near(dem_boundary_closest(&b, v3(1, 0.5, 0), -1, INFINITY).distance, 1.5, 1e-15);
    check_near(dem_boundary_closest(&b, v3(1, 0, 5), -1, INFINITY).distance, 3, 1e-15);
    check_near(dem_boundary_closest(&b, v3(1, 0, 0), -1, INFINITY).distance, 2, 1e-15);
    dem_boundary_release(&b);
    // balls on a sphere leave a void in the middle that has a boundary of its own
    dem_ball shell[400];
    for (int i = 0; i < 400; i++) {
        double z = 1 - (2 * i + 1) / 400.0, s = sqrt(1 - z * z), t = 2.399963229728653 * i;
        shell[i] = (dem_ball){{s * cos(t), s * sin(t), z}, 0.2};
    }
    check_ok(dem_boundary_build(&b, shell, 400, &error), error);
    dem_boundary_hit hit = dem_boundary_closest(&b, v3(0, 0, 0), -1, INFINITY);
    check_near(hit.distance, 0.8, 1e-12);
    check(v3_dot(hit.normal, hit.point) < 0);
    dem_boundary_release(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_closest_point_is_on_the_boundary_and_none_is_closer),
        cmocka_unit_test(a_search_that_has_enough_stops_within_it),
        cmocka_unit_test(samples_stand_for_the_whole_boundary),
        cmocka_unit_test(covered_directions_lie_in_other_balls),
        cmocka_unit_test(a_single_ball_and_a_shell_around_a_void_have_boundaries),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
