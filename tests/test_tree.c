#include "check.h"

#include "base/random.h"
#include "geom/tree.h"

enum { TRIANGLES = 400 };

static dem_vec3 random_point(dem_random *r)
{
    double x = random_uniform(r), y = random_uniform(r), z = random_uniform(r);
    return v3(x, y, z);
}

static void the_tree_finds_the_closest_point_that_brute_force_finds(void **state)
{
    (void)state;
    dem_random r = random_stream(7, 0);
    dem_vec3 vertices[3 * TRIANGLES];
    uint32_t triangles[3 * TRIANGLES];
    for (uint32_t i = 0; i < 3 * TRIANGLES; i++) {
        dem_vec3 offset = v3_scale(random_point(&r), 0.1);
        vertices[i] = i % 3 == 0 ? random_point(&r) : v3_add(vertices[i - 1], offset);
        triangles[i] = i;
    }
    vertices[1] = vertices[2] = vertices[0];  // a triangle that is a point
    dem_tree tree;
    dem_error error;
    check_ok(dem_tree_build(&tree, vertices, triangles, TRIANGLES, &error), error);
    for (int i = 0; i < 500; i++) {
        dem_vec3 p = v3_scale(random_point(&r), 1.4), point;
        uint32_t triangle;
        double want = INFINITY;
        for (int t = 0; t < TRIANGLES; t++)
            want = fmin(want, v3_distance(p, dem_triangle_closest(p, vertices[3 * t], vertices[3 * t + 1], vertices[3 * t + 2])));
        double got = dem_tree_closest(&tree, p, INFINITY, &point, &triangle);
        check_near(got, want, 1e-15);
        check_near(v3_distance(p, point), want, 1e-15);
        check(dem_tree_closest(&tree, p, want * (1 - 1e-9), NULL, NULL) == INFINITY);
    }
    dem_tree_release(&tree);
}

static void the_closest_point_of_a_triangle_is_no_farther_than_any_of_its_points(void **state)
{
    (void)state;
    dem_random r = random_stream(8, 0);
    for (int i = 0; i < 200; i++) {
        dem_vec3 a = random_point(&r), b = random_point(&r), c = random_point(&r), p = v3_scale(random_point(&r), 2);
        double d = v3_distance(p, dem_triangle_closest(p, a, b, c)), best = INFINITY;
        for (int j = 0; j <= 60; j++)
            for (int k = 0; k <= 60 - j; k++) {
                dem_vec3 q = v3_along(v3_along(a, j / 60.0, v3_sub(b, a)), k / 60.0, v3_sub(c, a));
                best = fmin(best, v3_distance(p, q));
            }
        check(d <= best + 1e-15);
        check(best <= d + 0.04);  // the grid is 1/60 of edges of at most sqrt 3
    }
}

static void points_are_inside_a_cube_of_either_orientation(void **state)
{
    (void)state;
    dem_vec3 vertices[8];
    for (int i = 0; i < 8; i++)
        vertices[i] = v3(i & 1, i >> 1 & 1, i >> 2 & 1);
    uint32_t cube[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    for (int flip = 0; flip < 2; flip++) {
        dem_tree tree;
        dem_error error;
        check_ok(dem_tree_build(&tree, vertices, cube, 12, &error), error);
        check(dem_tree_inside(&tree, v3(0.5, 0.5, 0.5)));
        check(dem_tree_inside(&tree, v3(0.01, 0.99, 0.4)));
        check(!dem_tree_inside(&tree, v3(1.01, 0.5, 0.5)));
        check(!dem_tree_inside(&tree, v3(-3, 0.5, 0.5)));
        check(dem_tree_winding(&tree, v3(0.5, 0.5, 0.5), v3(0.3, 0.2, 0.9)) == (flip ? -1 : 1));
        dem_tree_release(&tree);
        for (int t = 0; t < 12; t++) {
            uint32_t swap = cube[3 * t];
            cube[3 * t] = cube[3 * t + 1];
            cube[3 * t + 1] = swap;
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_tree_finds_the_closest_point_that_brute_force_finds),
        cmocka_unit_test(the_closest_point_of_a_triangle_is_no_farther_than_any_of_its_points),
        cmocka_unit_test(points_are_inside_a_cube_of_either_orientation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
