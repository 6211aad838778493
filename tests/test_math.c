#include "check.h"

#include "math/mat3.h"
#include "math/quat.h"
#include "math/sum.h"

static void eigenvectors_of_a_rotated_tensor_are_its_axes(void **state)
{
    (void)state;
    dem_quat q = quat_unit((dem_quat){0.9, -0.3, 0.2, 0.5});
    double want[3] = {1, 2.5, 7};
    dem_sym3 m = {0};
    dem_vec3 basis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; i++)
        m = sym3_add(m, sym3_scale(sym3_outer(quat_rotate(q, basis[i])), want[i]));
    double values[3];
    dem_vec3 axes[3];
    dem_sym3_eigen(m, values, axes);
    for (int i = 0; i < 3; i++) {
        check_near(values[i], want[i], 1e-14 * 10);  // a few roundings of the largest value
        check_near(fabs(v3_dot(axes[i], quat_rotate(q, basis[i]))), 1, 1e-14);
    }
    check_near(v3_dot(v3_cross(axes[0], axes[1]), axes[2]), 1, 1e-14);
}

static void a_quaternion_from_axes_maps_the_basis_to_them(void **state)
{
    (void)state;
    dem_quat cases[] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {0.1, -0.7, 0.3, 0.2}, {0.5, 0.5, 0.5, 0.5}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_quat q = quat_unit(cases[i]);
        dem_vec3 a = quat_rotate(q, v3(1, 0, 0)), b = quat_rotate(q, v3(0, 1, 0)), c = quat_rotate(q, v3(0, 0, 1));
        dem_quat got = dem_quat_from_axes(a, b, c);
        check_vec(quat_rotate(got, v3(1, 2, 3)), quat_rotate(q, v3(1, 2, 3)), 1e-14);
        check(got.w >= 0);
    }
}

static void compensated_sums_keep_what_plain_sums_lose(void **state)
{
    (void)state;
    dem_sum s = {0};
    sum_add(&s, 1);
    for (int i = 0; i < 1000; i++)
        sum_add(&s, 1e-17);
    sum_add(&s, -1);
    check_close(sum_value(s), 1e-14, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eigenvectors_of_a_rotated_tensor_are_its_axes),
        cmocka_unit_test(a_quaternion_from_axes_maps_the_basis_to_them),
        cmocka_unit_test(compensated_sums_keep_what_plain_sums_lose),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
