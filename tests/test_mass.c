#include "shapes.h"

#include "math/mat3.h"
#include "mesh/mass.h"

static void a_box_has_its_textbook_mass_properties(void **state)
{
    (void)state;
    dem_mesh box = shape_box(3, 2, 1);
    dem_solid s = dem_mesh_solid(&box);
    check_close(s.volume, 6.0, 1e-15);
    check_close(s.area, 22.0, 1e-15);
    check_vec(s.centre, v3(1.5, 1, 0.5), 1e-15);
    // V (b^2 + c^2) / 12
    check_close(s.principal[0], 2.5, 1e-14);
    check_close(s.principal[1], 5.0, 1e-14);
    check_close(s.principal[2], 6.5, 1e-14);
    check_near(s.inertia.xy, 0, 1e-14);
    check_vec(quat_rotate(s.axes, v3(1, 0, 0)), v3(1, 0, 0), 1e-14);
    dem_mesh_free(&box);
}

static void the_moments_of_a_corner_tetrahedron_are_its_simplex_integrals(void **state)
{
    (void)state;
    dem_mesh t = shape_tetrahedron(v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0), v3(0, 0, 1));
    dem_moments m = dem_mesh_moments(&t, v3(0, 0, 0));
    // int x^a y^b z^c = a! b! c! / (a + b + c + 3)!
    check_close(m.volume, 1.0 / 6, 1e-15);
    check_vec(m.first, v3(1.0 / 24, 1.0 / 24, 1.0 / 24), 1e-17);
    check_close(m.second.xx, 2.0 / 120, 1e-14);
    check_close(m.second.zz, 2.0 / 120, 1e-14);
    check_close(m.second.xy, 1.0 / 120, 1e-14);
    check_close(m.second.yz, 1.0 / 120, 1e-14);
    // the same about another origin: x - o
    dem_moments n = dem_mesh_moments(&t, v3(1, 2, -3));
    check_vec(n.first, v3(1.0 / 24 - 1.0 / 6, 1.0 / 24 - 2.0 / 6, 1.0 / 24 + 3.0 / 6), 1e-15);
    check_close(n.second.xy, 1.0 / 120 - 2.0 / 24 - 1.0 / 24 + 2.0 / 6, 1e-14);
    dem_mesh_free(&t);
}

static void a_fine_ellipsoid_approaches_the_analytic_one_with_the_square_of_the_edge(void **state)
{
    (void)state;
    double a = 1.5, b = 1, c = 0.7, volume = 4 * DEM_PI / 3 * a * b * c, last = 0;
    for (int n = 20; n <= 80; n *= 2) {
        dem_mesh mesh = shape_sphere(n);
        shape_scale(&mesh, a, b, c);
        dem_solid s = dem_mesh_solid(&mesh);
        double error = 1 - s.volume / volume;
        check(error > 0 && error < 2.0 / (n * n));
        if (last > 0)
            check_close(last / error, 4.0, 0.02);
        last = error;
        check_close(s.principal[0], s.volume * (b * b + c * c) / 5, 3 * error);
        check_close(s.principal[2], s.volume * (a * a + b * b) / 5, 3 * error);
        dem_mesh_free(&mesh);
    }
}

// the union of two unit balls whose centres are 1 apart, as a surface of revolution
static void two_fused_balls_have_the_reference_moments(void **state)
{
    (void)state;
    dem_mesh mesh = shape_sphere(160);
    // x -> the half angle seen from the nearer centre: each half sphere is stretched over its 240 degree cap
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        dem_vec3 u = mesh.vertices[i];
        double angle = acos(fmin(1, fabs(u.x))) * 4 / 3, rho = sqrt(u.y * u.y + u.z * u.z), x = 0.5 + cos(angle);
        double scale = rho > 0 ? sin(angle) / rho : 0;
        mesh.vertices[i] = v3(copysign(x, u.x), u.y * scale, u.z * scale);
    }
    dem_solid s = dem_mesh_solid(&mesh);
    check_close(s.volume, 7.06858347, 2e-4);  // the facets cut off about (edge / radius)^2 / 8
    check_close(s.principal[0], 3.00414797, 4e-4);
    check_close(s.principal[1], 5.21308031, 4e-4);
    check_close(s.principal[2], 5.21308031, 4e-4);
    dem_mesh_free(&mesh);
}

static void check_same_shape(const dem_solid *got, const dem_solid *want, double scale, double tolerance)
{
    check_close(got->volume, want->volume * pow(scale, 3), tolerance);
    check_close(got->area, want->area * pow(scale, 2), tolerance);
    for (int k = 0; k < 3; k++)
        check_close(got->principal[k], want->principal[k] * pow(scale, 5), tolerance);
}

static void rotation_and_translation_leave_the_principal_moments(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8), moved = shape_grain(8);
    dem_quat q = quat_unit((dem_quat){0.3, -0.5, 0.7, 0.2});
    dem_vec3 shift = v3(4, -7, 2);
    shape_move(&moved, q, shift);
    dem_solid a = dem_mesh_solid(&grain), b = dem_mesh_solid(&moved);
    check_same_shape(&b, &a, 1, 1e-13);
    check_vec(b.centre, v3_add(quat_rotate(q, a.centre), shift), 1e-13);
    dem_mesh_free(&grain);
    dem_mesh_free(&moved);
}

static void the_principal_frame_is_right_handed_and_diagonalises(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    shape_move(&grain, quat_unit((dem_quat){0.1, 0.5, -0.7, 0.9}), v3(0, 0, 0));
    dem_solid s = dem_mesh_solid(&grain);
    check(0 < s.principal[0] && s.principal[0] < s.principal[1] && s.principal[1] < s.principal[2]);
    dem_vec3 axes[3];
    for (int k = 0; k < 3; k++) {
        axes[k] = quat_rotate(s.axes, v3(k == 0, k == 1, k == 2));
        check_vec(sym3_apply(s.inertia, axes[k]), v3_scale(axes[k], s.principal[k]), 1e-14);
    }
    check_near(v3_dot(v3_cross(axes[0], axes[1]), axes[2]), 1, 1e-14);
    dem_mesh_free(&grain);
}

static void a_million_grain_lengths_from_zero_the_inertia_still_has_six_digits(void **state)
{
    (void)state;
    dem_mesh near = shape_grain(9), far = shape_grain(9);
    dem_vec3 shift = v3(1e6, -1e6, 1e6);
    shape_move(&far, (dem_quat){1, 0, 0, 0}, shift);
    dem_solid a = dem_mesh_solid(&near), b = dem_mesh_solid(&far);
    // the coordinates themselves are rounded to 1e-10
    check_same_shape(&b, &a, 1, 1e-9);
    check_vec(v3_sub(b.centre, shift), a.centre, 1e-9);
    dem_mesh_free(&near);
    dem_mesh_free(&far);
}

static void the_scale_of_the_grain_does_not_matter(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    dem_solid want = dem_mesh_solid(&grain);
    for (int k = -1; k <= 1; k += 2) {
        double scale = pow(10, 9 * k);
        dem_mesh scaled = shape_grain(6);
        shape_scale(&scaled, scale, scale, scale);
        dem_solid got = dem_mesh_solid(&scaled);
        check_same_shape(&got, &want, scale, 1e-13);
        dem_mesh_free(&scaled);
    }
    dem_mesh_free(&grain);
}

static void a_far_vertex_that_no_triangle_uses_changes_nothing(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    dem_solid want = dem_mesh_solid(&grain);
    grain.vertices = realloc(grain.vertices, (grain.vertex_count + 1) * sizeof *grain.vertices);
    grain.vertices[grain.vertex_count++] = v3(1e30, -1e30, 1e30);
    dem_solid got = dem_mesh_solid(&grain);
    check(memcmp(&got, &want, sizeof got) == 0);
    dem_mesh_free(&grain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_has_its_textbook_mass_properties),
        cmocka_unit_test(the_moments_of_a_corner_tetrahedron_are_its_simplex_integrals),
        cmocka_unit_test(a_fine_ellipsoid_approaches_the_analytic_one_with_the_square_of_the_edge),
        cmocka_unit_test(two_fused_balls_have_the_reference_moments),
        cmocka_unit_test(rotation_and_translation_leave_the_principal_moments),
        cmocka_unit_test(the_principal_frame_is_right_handed_and_diagonalises),
        cmocka_unit_test(a_million_grain_lengths_from_zero_the_inertia_still_has_six_digits),
        cmocka_unit_test(the_scale_of_the_grain_does_not_matter),
        cmocka_unit_test(a_far_vertex_that_no_triangle_uses_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
