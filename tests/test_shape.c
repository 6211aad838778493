#include "shapes.h"

#include "base/random.h"

static dem_shape measure_with(const dem_mesh *mesh, int threads)
{
    dem_shape shape;
    dem_error error;
    dem_ctx ctx = {.threads = threads};
    check_ok(dem_shape_measure(&ctx, mesh, &shape, &error), error);
    return shape;
}

static dem_shape measure(dem_mesh mesh)
{
    dem_shape shape = measure_with(&mesh, 1);
    dem_mesh_free(&mesh);
    return shape;
}

// Minkowski sum of a cube of half edge 1 - r and a ball of radius r: each octant of the sphere moves to its corner
static dem_mesh rounded_cube(double r, int n)
{
    dem_mesh mesh = shape_sphere(n);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        dem_vec3 u = mesh.vertices[i], corner = {0};
        for (int k = 0; k < 3; k++) {
            double x = v3_get(u, k);
            v3_set(&corner, k, fabs(x) < 1e-9 ? 0 : copysign(1 - r, x));
        }
        mesh.vertices[i] = v3_along(corner, r, u);
    }
    return mesh;
}

// an octahedron with its faces cut into n^2 triangles each
static dem_mesh shape_octahedron(int n)
{
    dem_mesh mesh = shape_sphere(n);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        dem_vec3 u = mesh.vertices[i];
        mesh.vertices[i] = v3_scale(u, 1 / (fabs(u.x) + fabs(u.y) + fabs(u.z)));
    }
    return mesh;
}

static void a_sphere_is_round_and_has_no_form(void **state)
{
    (void)state;
    for (int n = 8; n <= 24; n *= 3) {
        dem_shape s = measure(shape_sphere(n));
        double facets = 2.5 / (n * n);  // what the facets cut off
        check_close(s.equivalent_diameter, 2, facets);
        check_close(s.longest, 2, facets);
        check_close(s.shortest, 2, facets + 0.01);  // the box may find a flat place
        check_near(s.elongation, 1, 0.01);
        check_near(s.flatness, 1, 0.01);
        check_near(s.sphericity, 1, facets);
        check_near(s.roundness, 1, 0.002);
        check_near(s.angularity, 0, 0.02);
    }
}

static void a_cube_is_angular_and_not_round(void **state)
{
    (void)state;
    dem_shape s = measure(shape_box(1, 1, 1));
    check_close(s.equivalent_diameter, cbrt(6 / DEM_PI), 1e-14);
    check_close(s.longest, 1, 1e-12);
    check_close(s.sphericity, cbrt(DEM_PI / 6), 1e-14);
    check(s.roundness < 0.05);
    check_near(s.angularity, 1, 0.02);
    check(measure(shape_tetrahedron(v3(0, 0, 0), v3(1, 1, 0), v3(0, 1, 1), v3(1, 0, 1))).angularity > 1.2);
    check(measure(shape_sphere(1)).angularity < 0.9);  // an octahedron
}

static void a_rounded_cube_has_the_roundness_of_its_edges(void **state)
{
    (void)state;
    double last_roundness = 0, last_angularity = 2;
    for (double r = 0.1; r < 1; r += 0.2) {
        dem_shape coarse = measure(rounded_cube(r, 8)), fine = measure(rounded_cube(r, 20));
        check_near(fine.roundness, r, 0.04);
        check_near(coarse.roundness, fine.roundness, 0.03);
        check_near(coarse.angularity, fine.angularity, 0.03);
        check(fine.roundness > last_roundness + 0.05);
        check(fine.angularity < last_angularity);
        last_roundness = fine.roundness;
        last_angularity = fine.angularity;
    }
}

static void boxes_and_ellipsoids_have_their_axes(void **state)
{
    (void)state;
    dem_shape s = measure(shape_box(0.5, 3, 1.5));
    check_close(s.longest, 3, 1e-12);
    check_close(s.intermediate, 1.5, 1e-12);
    check_close(s.shortest, 0.5, 1e-12);
    check_close(s.elongation, 0.5, 1e-12);
    check_close(s.flatness, 1.0 / 3, 1e-12);
    dem_mesh mesh = shape_sphere(24);
    shape_scale(&mesh, 3, 1.5, 1);
    shape_move(&mesh, quat_unit((dem_quat){1, -2, 3, 0.5}), v3(7, 8, 9));
    s = measure(mesh);
    check_close(s.longest, 6, 0.01);
    check_close(s.elongation, 0.5, 0.01);
    check_close(s.flatness, 2.0 / 3, 0.01);
    check(s.roundness > 0.6 && s.roundness < 0.95);  // its tips are sharper than its girth
    check(s.angularity > 0 && s.angularity < 0.2);
}

static void size_and_place_do_not_matter(void **state)
{
    (void)state;
    dem_shape want = measure(shape_grain(10));
    for (double scale = 1e-9; scale < 2e9; scale *= 1e9) {
        dem_mesh mesh = shape_grain(10);
        dem_mesh_scale(&mesh, scale);
        dem_shape here = measure_with(&mesh, 1);
        check_close(here.equivalent_diameter, want.equivalent_diameter * scale, 1e-12);
        check_close(here.intermediate, want.intermediate * scale, 1e-6);
        check_close(here.roundness, want.roundness, 1e-6);
        check_close(here.angularity, want.angularity, 1e-6);
        // turned, the cells that collect turning lie elsewhere
        shape_move(&mesh, quat_unit((dem_quat){0.3, -0.7, 0.2, 0.5}), v3(5 * scale, -9 * scale, scale));
        dem_shape turned = measure(mesh);
        check_close(turned.longest, want.longest * scale, 1e-6);
        check_close(turned.sphericity, want.sphericity, 1e-9);
        check_near(turned.roundness, want.roundness, 0.03);
        check_near(turned.angularity, want.angularity, 0.01);
    }
}

static void triangles_do_not_matter(void **state)
{
    (void)state;
    dem_shape coarse = measure(shape_grain(10)), fine = measure(shape_grain(30));
    check_near(coarse.roundness, fine.roundness, 0.02);
    check_near(coarse.angularity, fine.angularity, 0.01);
    check_near(coarse.sphericity, fine.sphericity, 0.003);
    dem_shape many = measure(shape_octahedron(16)), few = measure(shape_sphere(1));
    check_near(many.roundness, few.roundness, 0.01);
    check_near(many.angularity, few.angularity, 0.02);
}

static void a_little_noise_is_no_corner(void **state)
{
    (void)state;
    dem_mesh mesh = shape_sphere(30);
    dem_random r = random_stream(51, 0);
    for (size_t i = 0; i < mesh.vertex_count; i++)
        mesh.vertices[i] = v3_scale(mesh.vertices[i], 1 + 0.002 * random_normal(&r));  // .1 % of the diameter
    dem_shape s = measure(mesh);
    check(s.roundness > 0.98);
    check(s.angularity < 0.03);
}

static void convexity_is_the_part_of_the_hull_or_unknown(void **state)
{
    (void)state;
    // two boxes, one on the other: an L with 3 of the 4 quarters, whose hull lacks half a quarter
    static const dem_vec3 corners[12] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0},
                                         {0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}, {1, 2, 1}, {0, 2, 1}};
    uint32_t faces[60] = {0, 3, 1, 1, 3, 2, 0, 5, 3, 3, 5, 4, 6, 7, 9, 7, 8, 9, 6, 9, 11, 9, 10, 11};
    for (uint32_t k = 0; k < 6; k++) {
        uint32_t a = k, b = (k + 1) % 6, side[6] = {a, b, b + 6, a, b + 6, a + 6};
        memcpy(faces + 24 + 6 * k, side, sizeof side);
    }
    dem_shape s = measure(shape_copy(corners, 12, faces, 20));
    check_close(s.equivalent_diameter, cbrt(18 / DEM_PI), 1e-12);
#if DEM_CGAL
    check_close(s.convexity, 3 / 3.5, 1e-6);
    check_near(measure(shape_box(1, 2, 3)).convexity, 1, 1e-6);
    check_near(measure(shape_octahedron(12)).convexity, 1, 1e-6);
#else
    check(isnan(s.convexity));
#endif
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(6);
    dem_shape one = measure_with(&mesh, 1);
    for (int threads = 2; threads <= 8; threads *= 2) {
        dem_shape many = measure_with(&mesh, threads);
        check(one.roundness == many.roundness && one.angularity == many.angularity && one.longest == many.longest);
    }
    dem_mesh_free(&mesh);
}

static void needles_plates_and_nothing_are_handled(void **state)
{
    (void)state;
    dem_shape needle = measure(shape_box(100, 1, 1)), plate = measure(shape_box(100, 100, 1));
    check_close(needle.elongation, 0.01, 1e-9);
    check_close(plate.flatness, 0.01, 1e-9);
    check(needle.roundness >= 0 && needle.roundness <= 1 && isfinite(needle.angularity));
    check(plate.roundness >= 0 && plate.roundness <= 1 && isfinite(plate.angularity));
    dem_mesh inside_out = shape_box(1, 1, 1);
    shape_flip(&inside_out, 0, 12);
    dem_shape shape;
    dem_error error;
    check(dem_shape_measure(NULL, &inside_out, &shape, &error) == DEM_BAD_INPUT);
    dem_mesh_free(&inside_out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sphere_is_round_and_has_no_form),
        cmocka_unit_test(a_cube_is_angular_and_not_round),
        cmocka_unit_test(a_rounded_cube_has_the_roundness_of_its_edges),
        cmocka_unit_test(boxes_and_ellipsoids_have_their_axes),
        cmocka_unit_test(size_and_place_do_not_matter),
        cmocka_unit_test(triangles_do_not_matter),
        cmocka_unit_test(a_little_noise_is_no_corner),
        cmocka_unit_test(convexity_is_the_part_of_the_hull_or_unknown),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(needles_plates_and_nothing_are_handled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
