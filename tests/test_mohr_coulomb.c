#include "check.h"

#include "base/random.h"
#include "math/vec.h"
#include "study/mohr_coulomb.h"

// tests of a material at the confinements given, their strengths off by `noise`
static size_t made(double angle_deg, double cohesion, const double *sigma3, size_t count, double noise,
                   dem_failure *tests)
{
    double s = sin(angle_deg * DEM_PI / 180), c = cos(angle_deg * DEM_PI / 180);
    dem_random r = random_stream(3, 1);
    for (size_t i = 0; i < count; i++)
        tests[i] = (dem_failure){sigma3[i] * (1 + s) / (1 - s) + 2 * cohesion * c / (1 - s) + noise * random_normal(&r),
                                 sigma3[i]};
    return count;
}

static const double CONFINED[] = {0, 1e4, 3e4, 1e5, 2e5};

static void a_line_gives_back_what_it_was_made_of(void **state)
{
    (void)state;
    const double angles[] = {0, 5, 30, 44, 60}, cohesions[] = {0, 5e3, 1e6};
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 3; k++) {
            dem_failure tests[5];
            dem_mohr_coulomb fit;
            dem_error error;
            check_ok(dem_mohr_coulomb_fit(tests, made(angles[i], cohesions[k], CONFINED, 5, 0, tests), &fit, &error),
                     error);
            check_near(fit.friction_angle * 180 / DEM_PI, angles[i], 1e-9);
            check_near(fit.cohesion, cohesions[k], 1e-8 * (1e5 + cohesions[k]));
            check_near(fit.residual, 0, 1e-9 * (1e6 + cohesions[k]));
        }
}

// PHYSICS 1.11 and its second erratum: 3.464102 c is the axial stress, 1.732051 c the shear stress
static void the_uniaxial_strength_has_two_forms(void **state)
{
    (void)state;
    dem_failure tests[3];
    dem_mohr_coulomb fit;
    dem_error error;
    check_ok(dem_mohr_coulomb_fit(tests, made(30, 5000, CONFINED, 3, 0, tests), &fit, &error), error);
    check_close(fit.axial_strength, 17320.508, 1e-8);
    check_close(fit.axial_strength, 3.464102 * 5000, 1e-6);
    check_close(fit.shear_strength, 1.732051 * 5000, 1e-6);
    check_close(fit.axial_strength, tests[0].sigma1, 1e-9);  // the test without confinement
    // with sigma1 = 0 sigma3 is the cutoff
    double s = sin(fit.friction_angle), c = cos(fit.friction_angle), sigma3 = -fit.tensile_cutoff;
    check_close(-sigma3 / 2, sigma3 / 2 * s + fit.cohesion * c, 1e-9);
}

// with noise the truth is within a few standard errors, and these are as large as what many fits scatter by
static void errors_tell_how_far_it_may_be_off(void **state)
{
    (void)state;
    enum { MANY = 200 };
    double sigma3[MANY];
    dem_failure tests[MANY];
    for (int i = 0; i < MANY; i++)
        sigma3[i] = 1e3 * i;
    dem_mohr_coulomb fit;
    dem_error error;
    check_ok(dem_mohr_coulomb_fit(tests, made(30, 5000, sigma3, MANY, 2e3, tests), &fit, &error), error);
    check(fit.angle_error > 0 && fabs(fit.friction_angle - DEM_PI / 6) < 3 * fit.angle_error);
    check(fit.cohesion_error > 0 && fabs(fit.cohesion - 5000) < 3 * fit.cohesion_error);
    // noise n of sigma1 is n/2 in t and n/2 in s: t is off the line by n (1 - sin) / 2
    check_close(fit.residual, 2e3 * 0.25, 0.15);
    check_ok(dem_mohr_coulomb_fit(tests, 2, &fit, &error), error);
    check(isnan(fit.angle_error) && isnan(fit.cohesion_error));
}

static void what_tells_no_line_is_refused(void **state)
{
    (void)state;
    dem_mohr_coulomb fit;
    dem_error error;
    const dem_failure same[] = {{3, 1}, {3, 1}, {2, 2}}, wrong[] = {{3, 1}, {1, 3}, {5, -3}},
                      steep[] = {{1, 0}, {10, 0.0}, {30, -3}};
    check(dem_mohr_coulomb_fit(same, 0, &fit, &error) == DEM_BAD_INPUT);
    check(dem_mohr_coulomb_fit(same, 1, &fit, &error) == DEM_BAD_INPUT);
    check(dem_mohr_coulomb_fit(same, 3, &fit, &error) == DEM_BAD_INPUT && strstr(error.text, "same mean stress"));
    check(dem_mohr_coulomb_fit(wrong, 3, &fit, &error) == DEM_BAD_INPUT);
    check(dem_mohr_coulomb_fit(steep, 3, &fit, &error) == DEM_BAD_INPUT &&
          strstr(error.text, "more than any friction"));
}

static dem_status parsed(const char *text, dem_failure **tests, size_t *count, dem_error *error)
{
    memset(error, 0, sizeof *error);
    return dem_failures_parse(text, strlen(text), "t.csv", 1e3, tests, count, error);
}

static void tables_are_read_with_their_units(void **state)
{
    (void)state;
    dem_failure *tests;
    size_t count;
    dem_error error;
    check_ok(
        parsed("# made by hand\n\n\"sigma3\",extra, sigma1_MPa\r\n 1,x,2\r\n#\n-0.5,y,1e-1", &tests, &count, &error),
        error);
    check(count == 2 && tests[0].sigma1 == 2e6 && tests[0].sigma3 == 1e3 && tests[1].sigma3 == -500);
    check_close(tests[1].sigma1, 1e5, 1e-15);
    free(tests);
    check_ok(parsed("sigma1,sigma3\n", &tests, &count, &error), error);
    check(count == 0);
    free(tests);
    static const struct {
        const char *text, *said;
        long line;
    } bad[] = {{"", "holds no table", 0},
               {"# only\n", "holds no table", 0},
               {"1,2\n", "no column sigma1", 1},
               {"sigma1,sigma1\n", "two columns sigma1", 1},
               {"sigma1_mm,sigma3\n", "column sigma1_mm", 1},
               {"sigma1,sigma3\n1\n", "sigma3 is no number", 2},
               {"sigma1,sigma3\n1,\n", "sigma3 is no number", 2},
               {"sigma1,sigma3\n1,inf\n", "sigma3 is no number", 2},
               {"sigma1,sigma3\n2,1\n\n1,2\n", "sigma1 is below sigma3", 4}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        check(parsed(bad[i].text, &tests, &count, &error) == DEM_BAD_INPUT && !tests && count == 0);
        if (!strstr(error.text, bad[i].said) || error.line != bad[i].line)
            fail_msg("%ld: %s", error.line, error.text);
    }
}

static void the_picture_has_a_circle_for_each_test(void **state)
{
    (void)state;
    dem_failure tests[5];
    dem_mohr_coulomb fit;
    dem_error error;
    const double tension[] = {-2e3, 0, 1e4};
    const struct {
        double angle, cohesion;
    } materials[] = {{30, 5000}, {0, 5000}, {40, 0}};
    for (int i = 0; i < 3; i++) {
        dem_buffer svg = {0};
        size_t count = made(materials[i].angle, materials[i].cohesion, i ? CONFINED : tension, 3, 0, tests);
        check_ok(dem_mohr_coulomb_fit(tests, count, &fit, &error), error);
        dem_mohr_coulomb_draw(&svg, tests, count, &fit, false);
        check(!svg.failed && !strstr(svg.data, "nan") && !strstr(svg.data, "inf"));
        size_t circles = 0;
        for (const char *at = svg.data; (at = strstr(at, "<path")); at++)
            circles++;
        check(circles == count && strstr(svg.data, "#d55e00"));
        dem_buffer_release(&svg);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_gives_back_what_it_was_made_of),
        cmocka_unit_test(the_uniaxial_strength_has_two_forms),
        cmocka_unit_test(errors_tell_how_far_it_may_be_off),
        cmocka_unit_test(what_tells_no_line_is_refused),
        cmocka_unit_test(tables_are_read_with_their_units),
        cmocka_unit_test(the_picture_has_a_circle_for_each_test),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
