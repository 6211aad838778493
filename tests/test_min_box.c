#include "shapes.h"

#include "base/random.h"
#include "mesh/min_box.h"

static dem_quat random_turn(dem_random *r)
{
    double w = random_normal(r), x = random_normal(r), y = random_normal(r), z = random_normal(r);
    return quat_unit((dem_quat){w, x, y, z});
}

static void check_edges(dem_mesh *mesh, double a, double b, double c, double tolerance)
{
    double edges[3];
    dem_error error;
    dem_vec3 axes[3];
    check_ok(dem_mesh_min_box(mesh, 1, edges, axes, &error), error);
    // along its axes the mesh is as long as the edges say
    check_vec(v3_cross(axes[0], axes[1]), axes[2], 1e-12);
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < mesh->vertex_count; i++) {
            low = fmin(low, v3_dot(axes[k], mesh->vertices[i]));
            high = fmax(high, v3_dot(axes[k], mesh->vertices[i]));
        }
        check_near(high - low, edges[k], 1e-9 * edges[0]);
    }
    check_close(edges[0], a, tolerance);
    check_close(edges[1], b, tolerance);
    check_close(edges[2], c, tolerance);
}

static void a_turned_box_gets_its_own_edges_back(void **state)
{
    (void)state;
    const double sizes[][3] = {{3, 2, 1}, {1, 1, 1}, {100, 1, 1}, {100, 100, 1}, {100, 10, 1}};
    dem_random r = random_stream(3, 0);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (int k = 0; k < 2; k++) {
            dem_mesh box = shape_box(sizes[i][2], sizes[i][0], sizes[i][1]);
            shape_move(&box, random_turn(&r), v3(-5, 3, 8));
            check_edges(&box, sizes[i][0], sizes[i][1], sizes[i][2], 1e-12);
            dem_mesh_free(&box);
        }
}

// no face of the box touches a face of the tetrahedron: each holds one edge as its diagonal
static void a_regular_tetrahedron_fits_into_a_cube(void **state)
{
    (void)state;
    dem_random r = random_stream(4, 0);
    for (int k = 0; k < 4; k++) {
        dem_mesh t = shape_tetrahedron(v3(0, 0, 0), v3(1, 1, 0), v3(1, 0, 1), v3(0, 1, 1));
        shape_move(&t, random_turn(&r), v3(0, 0, 0));
        check_edges(&t, 1.0, 1.0, 1.0, 1e-8);  // the volume, which is searched, is flat to second order
        dem_mesh_free(&t);
    }
}

static void an_ellipsoid_has_its_three_axes(void **state)
{
    (void)state;
    dem_random r = random_stream(5, 0);
    for (int k = 0; k < 3; k++) {
        dem_mesh mesh = shape_sphere(30);
        shape_scale(&mesh, 3, 2, 1.2);
        shape_move(&mesh, random_turn(&r), v3(0, 0, 0));
        // the poles are vertices, but a box may tilt within the facets
        check_edges(&mesh, 6.0, 4.0, 2.4, 2e-3);
        dem_mesh_free(&mesh);
    }
}

static void scale_and_place_do_not_matter(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(10);
    double want[3];
    dem_error error;
    check_ok(dem_mesh_min_box(&grain, 1, want, NULL, &error), error);
    dem_mesh_free(&grain);
    for (int k = -9; k <= 9; k += 9) {
        double scale = pow(10, k);
        dem_mesh mesh = shape_grain(10);
        shape_move(&mesh, (dem_quat){1, 0, 0, 0}, v3(1e6, 1e6, -1e6));
        shape_scale(&mesh, scale, scale, scale);
        // the shifted coordinates are rounded to 1e-10
        check_edges(&mesh, want[0] * scale, want[1] * scale, want[2] * scale, 1e-8);
        dem_mesh_free(&mesh);
    }
}

static void the_box_is_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(12);
    double first[3];
    dem_vec3 first_axes[3];
    dem_error error;
    check_ok(dem_mesh_min_box(&grain, 1, first, first_axes, &error), error);
    for (int threads = 2; threads <= 4; threads++) {
        double edges[3];
        dem_vec3 axes[3];
        check_ok(dem_mesh_min_box(&grain, threads, edges, axes, &error), error);
        check(memcmp(edges, first, sizeof edges) == 0 && memcmp(axes, first_axes, sizeof axes) == 0);
    }
    dem_mesh_free(&grain);
}

static void a_line_has_no_box(void **state)
{
    (void)state;
    dem_mesh mesh = shape_copy((dem_vec3[]){{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, 3, (uint32_t[]){0, 1, 2}, 1);
    double edges[3];
    dem_error error;
    check(dem_mesh_min_box(&mesh, 1, edges, NULL, &error) == DEM_BAD_INPUT);
    dem_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_turned_box_gets_its_own_edges_back),
        cmocka_unit_test(a_regular_tetrahedron_fits_into_a_cube),
        cmocka_unit_test(an_ellipsoid_has_its_three_axes),
        cmocka_unit_test(scale_and_place_do_not_matter),
        cmocka_unit_test(the_box_is_the_same_for_any_number_of_threads),
        cmocka_unit_test(a_line_has_no_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
