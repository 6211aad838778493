#include "check.h"

#include "math/vec.h"
#include "sim/impact.h"

// PHYSICS 6.1, tests 1 to 3: radius, Young, Poisson, density, speed of approach, partner (0: rigid wall, 1: its twin)
static const struct {
    double radius, young, poisson, density, speed;
    int twin;
    double overlap, force, duration;
} CHUNG_OOI[] = {
    {0.01, 48e9, 0.2, 2800, 20, 1, 2.74112702e-4, 10696.889, 4.03394557e-5},
    {0.01, 20e9, 0.25, 2500, 20, 1, 3.68304026e-4, 7108.24128, 5.42010049e-5},
    {0.1, 70e9, 0.3, 2699, 0.2, 0, 4.97171752e-5, 11369.8583, 7.31656641e-4},
    {0.1, 40e9, 0.35, 1800, 0.2, 0, 5.21232883e-5, 7232.68103, 7.67065905e-4},
    {0.0025, 380e9, 0.23, 4000, 3.9, 0, 8.08880826e-6, 615.351569, 6.10450991e-6},
    {0.0025, 100e9, 0.25, 7000, 3.9, 0, 1.71887136e-5, 506.760233, 1.29720806e-5},
};

static void elastic_impacts_are_those_of_chung_and_ooi(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof CHUNG_OOI / sizeof CHUNG_OOI[0]; i++) {
        double r = CHUNG_OOI[i].radius, nu = CHUNG_OOI[i].poisson;
        double mass = CHUNG_OOI[i].density * 4 / 3 * DEM_PI * r * r * r, modulus = CHUNG_OOI[i].young / (1 - nu * nu);
        if (CHUNG_OOI[i].twin)
            mass /= 2, modulus /= 2, r /= 2;
        double k = dem_hertz_stiffness(modulus, r), v = CHUNG_OOI[i].speed;
        // nine digits are printed there, the duration's factor with eight
        check_close(dem_hertz_overlap(mass, k, v), CHUNG_OOI[i].overlap, 1e-8);
        check_close(dem_hertz_force(mass, k, v), CHUNG_OOI[i].force, 1e-8);
        check_close(dem_hertz_duration(mass, k, v), CHUNG_OOI[i].duration, 1e-7);
    }
}

// int_0^1 dx / sqrt(1 - x^p) by the midpoint rule with x = 1 - u^2, which has no pole
static double rise(double p)
{
    double sum = 0;
    int n = 20000;
    for (int i = 0; i < n; i++) {
        double u = (i + 0.5) / n;
        sum += 2 * u / sqrt(-expm1(p * log1p(-u * u)));
    }
    return sum / n;
}

static void the_duration_is_the_integral_over_the_path(void **state)
{
    (void)state;
    double m = 3, k = 7e5, v = 0.4;
    // the midpoint rule is left with an error of order 1/n^2
    check_close(dem_hertz_duration(m, k, v), 2 * rise(2.5) * dem_hertz_overlap(m, k, v) / v, 1e-8);
    check_close(dem_linear_duration(m, k), 2 * rise(2) * dem_linear_overlap(m, k, v) / v, 1e-8);
}

static void all_of_the_energy_is_in_the_spring_at_the_turn(void **state)
{
    (void)state;
    for (double v = 1e-6; v < 1e3; v *= 7) {
        double m = 2e-3, k = 3e8, energy = m * v * v / 2;
        double hertz = dem_hertz_overlap(m, k, v), linear = dem_linear_overlap(m, k, v);
        check_close(0.4 * k * pow(hertz, 2.5), energy, 1e-14);
        check_close(k * linear * linear / 2, energy, 1e-14);
        check_close(dem_hertz_force(m, k, v), k * pow(hertz, 1.5), 1e-15);
        check_close(dem_linear_force(m, k, v), k * linear, 1e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elastic_impacts_are_those_of_chung_and_ooi),
        cmocka_unit_test(the_duration_is_the_integral_over_the_path),
        cmocka_unit_test(all_of_the_energy_is_in_the_spring_at_the_turn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
