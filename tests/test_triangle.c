#include "check.h"

#include "base/random.h"
#include "geom/tree.h"
#include "geom/triangle.h"
#include "math/quat.h"

static dem_vec3 random_point(dem_random *r)
{
    double x = random_uniform(r), y = random_uniform(r), z = random_uniform(r);
    return v3(x - 0.5, y - 0.5, z - 0.5);
}

static dem_quat random_turn(dem_random *r)
{
    double w = random_normal(r), x = random_normal(r), y = random_normal(r), z = random_normal(r);
    return quat_unit((dem_quat){w, x, y, z});
}

static void each_part_of_a_triangle_is_closest_where_it_should_be(void **state)
{
    (void)state;
    static const struct {
        dem_vec3 p, closest;
        dem_triangle_part part;
    } cases[] = {
        {{1, 1, 2}, {1, 1, 0}, DEM_ON_FACE},        {{1, 1, -2}, {1, 1, 0}, DEM_ON_FACE},
        {{1, 1, 0}, {1, 1, 0}, DEM_ON_FACE},        {{2, -1, 1}, {2, 0, 0}, DEM_ON_EDGE_AB},
        {{4, 4, 1}, {2, 2, 0}, DEM_ON_EDGE_BC},     {{-1, 3, 1}, {0, 3, 0}, DEM_ON_EDGE_CA},
        {{-1, -1, 1}, {0, 0, 0}, DEM_ON_VERTEX_A},  {{6, -1, 1}, {4, 0, 0}, DEM_ON_VERTEX_B},
        {{-1, 6, 1}, {0, 4, 0}, DEM_ON_VERTEX_C},   {{2, 0, 3}, {2, 0, 0}, DEM_ON_EDGE_AB},
        {{4, 0, 3}, {4, 0, 0}, DEM_ON_VERTEX_B},    {{0, 0, 0}, {0, 0, 0}, DEM_ON_VERTEX_A},
        {{0, 4.5, -1}, {0, 4, 0}, DEM_ON_VERTEX_C},
    };
    dem_triangle t;
    check(triangle_prepare(v3(0, 0, 0), v3(4, 0, 0), v3(0, 4, 0), &t));
    check(t.normal.x == 0 && t.normal.y == 0 && t.normal.z == 1);
    check_near(t.length, sqrt(32), 1e-15);
    check(triangle_prepare(v3(4, 0, 0), v3(0, 4, 0), v3(0, 0, 0), &t) && t.length == sqrt(32) && t.normal.z == 1);
    check(triangle_prepare(v3(0, 4, 0), v3(0, 0, 0), v3(4, 0, 0), &t) && t.length == sqrt(32) && t.normal.z == 1);
    check(triangle_prepare(v3(0, 0, 0), v3(4, 0, 0), v3(0, 4, 0), &t));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_closest s = triangle_closest(&t, cases[i].p);
        check_vec(v3_add(cases[i].p, s.offset), cases[i].closest, 0);
        assert_int_equal(s.part, cases[i].part);
        check_near(s.distance2, v3_norm2(v3_sub(cases[i].p, cases[i].closest)), 1e-14);
    }
}

// where the distances to corner, edge and face are the same number
static void beside_a_corner_the_closest_point_is_still_told_apart(void **state)
{
    (void)state;
    dem_triangle t;
    check(triangle_prepare(v3(0, 0, 0), v3(4, 0, 0), v3(0, 4, 0), &t));
    for (double aside = 1e-3; aside > 1e-14; aside *= 0.1) {
        dem_closest edge = triangle_closest(&t, v3(aside, -0.1 * aside, 1));
        check(edge.part == DEM_ON_EDGE_AB);
        check_vec(edge.offset, v3(0, 0.1 * aside, -1), 1e-15);
        check_near(edge.aside2, 0.01 * aside * aside, 1e-6 * aside * aside);
        dem_closest corner = triangle_closest(&t, v3(-aside, -0.1 * aside, 1));
        check(corner.part == DEM_ON_VERTEX_A);
        check_vec(corner.offset, v3(aside, 0.1 * aside, -1), 0);
        dem_closest face = triangle_closest(&t, v3(aside, 0.1 * aside, 1));
        check(face.part == DEM_ON_FACE && face.aside2 == 0);
        check_vec(face.offset, v3(0, 0, -1), 0);
    }
}

// dem_triangle_closest is another algorithm; it loses digits with the square of length / width
static void both_closest_points_of_a_wide_triangle_agree(void **state)
{
    (void)state;
    dem_random r = random_stream(11, 0);
    int parts[7] = {0}, wide = 0;
    while (wide < 20000) {
        dem_vec3 a = random_point(&r), b = random_point(&r), c = random_point(&r), p = v3_scale(random_point(&r), 2);
        dem_triangle t;
        if (!triangle_prepare(a, b, c, &t) || v3_norm(v3_cross(v3_sub(b, a), v3_sub(c, a))) < 0.1 * t.length * t.length)
            continue;
        wide++;
        dem_closest s = triangle_closest(&t, p);
        check_vec(v3_add(p, s.offset), dem_triangle_closest(p, a, b, c), 2e-13);
        check_near(sqrt(s.distance2), v3_distance(p, dem_triangle_closest(p, a, b, c)), 2e-15);
        parts[s.part]++;
    }
    for (int k = 0; k < 7; k++)
        check(parts[k] > 500);
}

// The foot of p lies inside, at height h: the distance is h whatever the width. Turning the triangle moves its corners
// by 1e-16 and so the distance by about that.
static void the_distance_to_a_sliver_keeps_its_digits(void **state)
{
    (void)state;
    dem_random r = random_stream(12, 0);
    for (double width = 1; width > 4e-12; width *= 0.1)
        for (int i = 0; i < 2000; i++) {
            // third corners above the end, the middle, and beyond the end of the long edge
            const double across[3] = {1, random_uniform(&r), 1.5};
            dem_vec3 corners[3] = {v3(0, 0, 0), v3(1, 0, 0), v3(across[i % 3], width, 0)};
            double u = 0.1 + 0.3 * random_uniform(&r), v = 0.1 + 0.5 * random_uniform(&r), h = random_uniform(&r) - 0.5;
            dem_vec3 p = v3_add(v3_along(v3_scale(corners[1], u), v, corners[2]), v3(0, 0, h));
            dem_quat turn = random_turn(&r);
            dem_triangle t;
            for (int k = 0; k < 3; k++)
                corners[k] = quat_rotate(turn, corners[k]);
            check(triangle_prepare(corners[i % 2], corners[1 - i % 2], corners[2], &t));
            dem_closest s = triangle_closest(&t, quat_rotate(turn, p));
            check_near(sqrt(s.distance2), fabs(h), 2e-15);
            check_near(sqrt(s.distance2), v3_norm(s.offset), 1e-16);
        }
}

static void a_normal_is_square_to_its_edges(void **state)
{
    (void)state;
    dem_random r = random_stream(13, 0);
    for (double width = 1; width > 1e-11; width *= 0.1)
        for (int i = 0; i < 500; i++) {
            dem_vec3 a = random_point(&r), b = random_point(&r), d = random_point(&r);
            dem_vec3 c = v3_along(v3_along(a, random_uniform(&r), v3_sub(b, a)), width, d);
            dem_triangle t;
            if (!triangle_prepare(a, b, c, &t))
                continue;
            check_near(v3_norm(t.normal), 1, 1e-15);
            check_near(v3_dot(t.normal, v3_sub(b, a)), 0, 1e-15);
            check_near(v3_dot(t.normal, v3_sub(c, a)), 0, 1e-15);
        }
}

static void triangles_without_area_are_degenerate(void **state)
{
    (void)state;
    dem_triangle t;
    const dem_vec3 a = {1, 2, 3}, b = {2, 2, 3};
    check(!triangle_prepare(a, a, a, &t) && !triangle_prepare(a, a, b, &t) && !triangle_prepare(a, b, a, &t));
    check(!triangle_prepare(a, b, v3(1.5, 2, 3), &t));
    check(!triangle_prepare(v3(0, 0, 0), v3(1, 0, 0), v3(0.3, 1.9e-12, 0), &t));
    check(triangle_prepare(v3(0, 0, 0), v3(1, 0, 0), v3(0.3, 2.1e-12, 0), &t));
    // the size does not matter
    check(triangle_prepare(v3(0, 0, 0), v3(1e-60, 0, 0), v3(0, 1e-60, 0), &t));
    check(triangle_prepare(v3(0, 0, 0), v3(1e60, 0, 0), v3(0, 1e60, 0), &t));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_part_of_a_triangle_is_closest_where_it_should_be),
        cmocka_unit_test(beside_a_corner_the_closest_point_is_still_told_apart),
        cmocka_unit_test(both_closest_points_of_a_wide_triangle_agree),
        cmocka_unit_test(the_distance_to_a_sliver_keeps_its_digits),
        cmocka_unit_test(a_normal_is_square_to_its_edges),
        cmocka_unit_test(triangles_without_area_are_degenerate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
