#include "check.h"

#include "base/random.h"
#include "math/orient.h"

typedef __int128 wide;

// whole numbers below 2^30: the determinant fits into 128 bits
static dem_vec3 lattice_point(dem_random *r, long size)
{
    long x = (long)random_below(r, (uint64_t)size), y = (long)random_below(r, (uint64_t)size);
    return v3((double)x, (double)y, (double)random_below(r, (uint64_t)size));
}

static wide exact_determinant(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 d)
{
    wide m[3][3];
    dem_vec3 rows[3] = {v3_sub(a, d), v3_sub(b, d), v3_sub(c, d)};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            m[i][k] = (wide)v3_get(rows[i], k);
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) + m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static int sign_of(wide x)
{
    return (x > 0) - (x < 0);
}

static void signs_in_space_agree_with_whole_numbers(void **state)
{
    (void)state;
    dem_random r = random_stream(11, 0);
    int zeros = 0;
    for (int i = 0; i < 20000; i++) {
        // large numbers in a thin slab about a slanted plane, small ones for true zeros
        long size = i % 2 ? 1 << 30 : 4;
        dem_vec3 p[4];
        for (int k = 0; k < 4; k++) {
            p[k] = lattice_point(&r, size);
            if (i % 2)
                p[k].z = floor(0.3 * p[k].x + 0.7 * p[k].y) + (double)random_below(&r, 2);
        }
        int want = sign_of(exact_determinant(p[0], p[1], p[2], p[3]));
        zeros += want == 0;
        check(dem_orient3(p[0], p[1], p[2], p[3]) == want);
        check(dem_orient3(p[1], p[0], p[2], p[3]) == -want);
    }
    check(zeros > 1000);
}

static void points_a_last_digit_off_the_plane_are_told_apart(void **state)
{
    (void)state;
    for (int k = -30; k <= 30; k += 10) {
        double s = ldexp(1, k);
        dem_vec3 a = v3(12 * s, 12 * s, 0.1 * s), b = v3(24 * s, 24 * s, 0.1 * s), c = v3(0.5 * s, 0.5 * s, 7 * s);
        dem_vec3 on = v3(3 * s, 3 * s, 5 * s), above = v3(3 * s, nextafter(3 * s, INFINITY), 5 * s);
        dem_vec3 below = v3(3 * s, nextafter(3 * s, 0), 5 * s);
        check(dem_orient3(a, b, c, on) == 0);
        check(dem_orient3(a, b, c, above) != 0);
        check(dem_orient3(a, b, c, above) == -dem_orient3(a, b, c, below));
    }
}

static void the_signs_are_those_of_the_headers_words(void **state)
{
    (void)state;
    dem_vec3 a = v3(0, 0, 0), b = v3(1, 0, 0), c = v3(0, 1, 0);
    check(dem_orient3(a, b, c, v3(0, 0, -1)) == 1);
    check(dem_orient2(a, b, c, 2) == 1);
    check(dem_orient2(a, c, v3(0, 0, 1), 0) == 1);
    check(dem_orient2(a, v3(0, 0, 1), b, 1) == 1);
    check(dem_orient2(a, v3(0.1, 0.1, 5), v3(0.3, 0.3, 7), 2) == dem_orient2(a, v3(0.1, 0.1, 0), v3(0.3, 0.3, 0), 2));
    check(dem_orient2(v3(0, 0, 0), v3(1e-3, 1e-3, 0), v3(1e3, nextafter(1e3, INFINITY), 0), 2) == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(signs_in_space_agree_with_whole_numbers),
        cmocka_unit_test(points_a_last_digit_off_the_plane_are_told_apart),
        cmocka_unit_test(the_signs_are_those_of_the_headers_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
