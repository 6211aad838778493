#include "check.h"

#include <float.h>

#include "base/random.h"
#include "base/simd.h"

// roots of one number, whatever the width this file is compiled for
static double root_of(double a, double *inverse)
{
    double in[DEM_WIDTH], root[DEM_WIDTH], one_over[DEM_WIDTH];
    for (int i = 0; i < DEM_WIDTH; i++)
        in[i] = a;
    wide r, y = wide_roots(wide_load(in), &r);
    wide_store(root, r);
    wide_store(one_over, y);
    for (int i = 1; i < DEM_WIDTH; i++)
        assert_true(root[i] == root[0] && one_over[i] == one_over[0]);
    wide_store(in, wide_rsqrt(wide_load(in)));
    assert_true(in[0] == one_over[0]);
    *inverse = one_over[0];
    return root[0];
}

// the error in units of the last place of the true value
static double units_off(double got, long double want)
{
    double near = (double)want, unit = nextafter(near, INFINITY) - near;
    return (double)(fabsl((long double)got - want) / (long double)unit);
}

static double worst;

static void check_roots(double a)
{
    double inverse, root = root_of(a, &inverse);
    long double want = sqrtl((long double)a);
    worst = fmax(worst, fmax(units_off(root, want), units_off(inverse, 1 / want)));
    if (worst > 2)
        fail_msg("of %.17g: root %.17g, inverse %.17g", a, root, inverse);
}

// The step of third order leaves 1e-18 of its guess, so that only roundings are left: those of the guess times the
// number, of the last products and of the sum. 1.53 units at most have been seen.
static void roots_are_right_to_two_units_of_the_last_place(void **state)
{
    (void)state;
    // 1e-300 is the least that callers have
    const double edges[] = {1e-300, 1.0000000000000002e-300, DBL_MAX, DBL_MAX / 2, 1, 2, 3, 4, 0.25, 0.5, 0.75};
    for (size_t i = 0; i < sizeof edges / sizeof *edges; i++)
        check_roots(edges[i]);
    // beside each power of 2, where the digits of the guess have their kinks
    for (int e = -996; e <= 1023; e++) {
        double p = ldexp(1, e);
        check_roots(p);
        check_roots(nextafter(p, 0));
        check_roots(nextafter(p, INFINITY));
    }
    dem_random r = random_stream(7, 1);
    for (int i = 0; i < 400000; i++)
        check_roots(ldexp(1 + random_uniform(&r), (int)(2000 * random_uniform(&r)) - 995));
    // every part of the two octaves that the guess is made for
    for (int i = 0; i < 400000; i++)
        check_roots(1 + 3 * (i + random_uniform(&r)) / 400000);
}

static void squares_have_whole_roots(void **state)
{
    (void)state;
    for (int i = 1; i < 100000; i++) {
        double inverse, root = root_of((double)i * i, &inverse);
        check_near(root / i, 1, DBL_EPSILON);
        check_near(inverse * i, 1, 2 * DBL_EPSILON);
    }
}

// what stands for nothing: callers add 1e-300 to a square, and what they multiply by the root is 0 or not taken
static void nothing_has_a_finite_root(void **state)
{
    (void)state;
    double inverse, root = root_of(0 + 1e-300, &inverse);
    assert_true(isfinite(inverse) && root > 0 && root < 1.1e-150);
    // below, down to zero and the least numbers of all, there is no root to rely on, but none is negative or NaN
    const double less[] = {0, DBL_TRUE_MIN, DBL_MIN / 3, DBL_MIN, 1e-305};
    for (size_t i = 0; i < sizeof less / sizeof *less; i++) {
        root = root_of(less[i], &inverse);
        assert_true(root >= 0 && inverse > 0 && isfinite(root));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_are_right_to_two_units_of_the_last_place),
        cmocka_unit_test(squares_have_whole_roots),
        cmocka_unit_test(nothing_has_a_finite_root),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
