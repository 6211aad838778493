#include "check.h"

#include "math/vec.h"
#include "sim/restitution.h"

// PHYSICS 1.2 (exact map), six and more digits: asked, ratio with tension, realised with the tail cut, ratio with cut
static const double MAP[][4] = {
    {0.05, 0.690106731, 0.213699817, 1.94534618},   {0.1, 0.591155034, 0.25272938, 1.24318785},
    {0.2, 0.455949811, 0.324862848, 0.731246927},   {0.3, 0.357857131, 0.3971405, 0.497239395},
    {0.5, 0.215453762, 0.55028317, 0.255275638},    {0.7, 0.112808451, 0.718201361, 0.122214748},
    {0.8, 0.0708503002, 0.808099335, 0.0743550971}, {0.9, 0.0335184491, 0.902026069, 0.0342652041}};
enum { MAPPED = sizeof MAP / sizeof MAP[0] };

static void the_maps_are_those_of_the_reference(void **state)
{
    (void)state;
    for (int i = 0; i < MAPPED; i++) {
        double ratio = dem_damping_ratio(MAP[i][0]);
        // nine digits are printed there
        check_close(ratio, MAP[i][1], 1e-8);
        check_close(dem_restitution_cut(ratio), MAP[i][2], 1e-8);
        check_close(dem_damping_ratio_cut(MAP[i][0]), MAP[i][3], 1e-8);
    }
}

static void each_map_is_the_inverse_of_the_other(void **state)
{
    (void)state;
    // e moves by zeta times the relative error of zeta, at most a few units of the last place times ln(1/e)
    for (double e = 1e-6; e <= 1; e *= 1.01) {
        check_close(dem_restitution(dem_damping_ratio(e)), e, 1e-12);
        check_close(dem_restitution_cut(dem_damping_ratio_cut(e)), e, 1e-13);
    }
    for (double zeta = 1e-9; zeta < 1e6; zeta *= 1.01)
        // where damping is weak e is near 1 and carries no more than 1e-16 / zeta of it
        check_close(dem_damping_ratio_cut(dem_restitution_cut(zeta)), zeta, 1e-13 + 1e-15 / zeta);
}

static void the_map_goes_smoothly_through_critical_damping(void **state)
{
    (void)state;
    check_close(dem_restitution_cut(1), exp(-2), 1e-15);
    check_near(dem_damping_ratio_cut(exp(-2)), 1, 1e-13);
    // d ln(1/e) / d zeta is 4/3 there
    for (double h = 1e-12; h < 1e-3; h *= 3) {
        check_near(-log(dem_restitution_cut(1 + h)), 2 + 4 * h / 3, 1e-15 + h * h);
        check_near(-log(dem_restitution_cut(1 - h)), 2 - 4 * h / 3, 1e-15 + h * h);
        check_near(dem_damping_ratio_cut(exp(-2 - 4 * h / 3)), 1 + h, 1e-15 + h * h);
    }
    // the closed form of the over-damped branch, PHYSICS 1.2
    for (double zeta = 1.5; zeta < 100; zeta *= 1.5) {
        double b = sqrt(zeta * zeta - 1);
        check_close(dem_restitution_cut(zeta), exp(-zeta / b * log((zeta + b) / (zeta - b))), 1e-11);
    }
}

static void less_restitution_is_more_damping(void **state)
{
    (void)state;
    double before = -1, before_cut = -1;
    for (double e = 1; e > 1e-300; e *= 0.999) {
        double ratio = dem_damping_ratio(e), cut = dem_damping_ratio_cut(e);
        check(ratio > before && cut > before_cut && ratio <= cut);
        before = ratio;
        before_cut = cut;
    }
    check(dem_damping_ratio(1) == 0 && dem_damping_ratio_cut(1) == 0);
    check(dem_damping_ratio(0) == 1 && isinf(dem_damping_ratio_cut(0)));
    check(isfinite(dem_damping_ratio_cut(5e-324)) && dem_restitution_cut(0) == 1);
}

typedef struct law {
    bool hertz, cut;
    double zeta;
} law;

static double force(const law *l, double d, double v)
{
    return l->hertz ? d * sqrt(d) + sqrt(5) * l->zeta * sqrt(sqrt(d)) * v : d + 2 * l->zeta * v;
}

// whether the contact is over; Hertz's dashpot dies with the overlap, so it ends at 0 only with it
static bool over(const law *l, double d, double v)
{
    return l->cut ? d > 0 && v < 0 && force(l, d, v) <= 0 : d <= 0;
}

// one step of the classical Runge-Kutta method for d'' = -F
static void runge_kutta(const law *l, double h, double *d, double *v)
{
    double kd[4], kv[4];
    for (int i = 0; i < 4; i++) {
        double part = i == 0 ? 0 : i == 3 ? h : h / 2;
        double at = i ? fmax(*d + part * kd[i - 1], 0) : *d, speed = i ? *v + part * kv[i - 1] : *v;
        kd[i] = speed;
        kv[i] = -force(l, at, speed);
    }
    *d += h / 6 * (kd[0] + 2 * kd[1] + 2 * kd[2] + kd[3]);
    *v += h / 6 * (kv[0] + 2 * kv[1] + 2 * kv[2] + kv[3]);
}

// speed after / speed before an impact of unit mass, stiffness and speed; the step is halved towards the end
static double integrated(const law *l)
{
    double d = 0, v = 1;
    for (double h = 1e-4; h > 1e-13;) {
        double next = d, speed = v;
        runge_kutta(l, h, &next, &speed);
        if (over(l, next, speed)) {
            h /= 2;
            continue;
        }
        d = next;
        v = speed;
    }
    return -v;
}

static void the_oscillator_comes_out_as_asked(void **state)
{
    (void)state;
    const double asked[] = {0.05, 0.13, 0.3, 0.5, 0.8, 0.95};
    for (int i = 0; i < 6; i++)
        for (int cut = 0; cut < 2; cut++)
            for (int hertz = 0; hertz < 2; hertz++) {
                double e = asked[i];
                law l = {hertz, cut, cut ? dem_damping_ratio_cut(e) : dem_damping_ratio(e)};
                // Hertz's force has the root of the overlap at both ends, which costs the method its order:
                // h^1.25 of the dashpot in the first step
                check_close(integrated(&l), e, hertz ? 1e-5 : 1e-9);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_maps_are_those_of_the_reference),
        cmocka_unit_test(each_map_is_the_inverse_of_the_other),
        cmocka_unit_test(the_map_goes_smoothly_through_critical_damping),
        cmocka_unit_test(less_restitution_is_more_damping),
        cmocka_unit_test(the_oscillator_comes_out_as_asked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
