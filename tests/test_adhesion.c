// Pulls between surfaces: DMT and the area law, against formulas, by their work, and at rest.
#include "bench_contact.h"

// two balls, or a ball [1] and a plane, pulled by `law`; the force on the second
static double force_at(bool wall, const dem_pair_law *law, double overlap)
{
    model *m = model_new();
    m->materials[0].young = 1e7;
    m->laws[0] = *law;
    if (!wall) {
        bench b = bench_spheres(m, 0.01, 0.02, overlap);
        double force = bench_force(&b, 1, 1e-9).x;
        bench_close(&b);
        return force;
    }
    model_body(m, model_sphere(m, 0.02), v3(0, 0, 0.02 - overlap));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    bench b = bench_open(m);
    double force = bench_force(&b, 0, 1e-9).z;
    bench_close(&b);
    return force;
}

static dem_pair_law dmt_law(void)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.normal = DEM_NORMAL_DMT;
    law.work_of_adhesion = 0.05;
    return law;
}

static dem_pair_law area_law(void)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.stiffness = 1e4;
    law.cohesion = DEM_COHESION_SJKR;
    law.energy_density = 3e5;
    return law;
}

static void dmt_pulls_by_two_pi_w_r_more_than_hertz(void **state)
{
    (void)state;
    dem_pair_law law = dmt_law();
    for (int wall = 0; wall < 2; wall++) {
        double reduced = wall ? 0.02 : 0.01 * 0.02 / 0.03, modulus = 1e7 / 2 / (1 - 0.25 * 0.25);
        for (double d = 1e-7; d < 2e-3; d *= 10)
            check_near(force_at(wall, &law, d),
                       4.0 / 3 * modulus * sqrt(reduced) * pow(d, 1.5) - 2 * DEM_PI * 0.05 * reduced,
                       1e-12 + 1e-9 * modulus * sqrt(reduced) * pow(d, 1.5));
    }
}

// the circle that two balls share: by the cosine rule in the triangle of the centres and a point of the circle
static double shared_radius2(bool wall, double overlap)
{
    double a = 0.01, b = 0.02, d = a + b - overlap;
    if (wall)
        return b * b - (b - overlap) * (b - overlap);
    double along = (d * d + a * a - b * b) / (2 * d);
    return a * a - along * along;
}

static void the_area_law_pulls_by_the_area_of_the_shared_circle(void **state)
{
    (void)state;
    dem_pair_law law = area_law();
    for (int wall = 0; wall < 2; wall++)
        for (double d = 1e-6; d < 2e-3; d *= 3)
            check_near(force_at(wall, &law, d), 1e4 * d - 3e5 * DEM_PI * shared_radius2(wall, d), 1e-9);
}

// a ball on a plane sinks in until k d - C A(d) = m g
static void a_ball_at_rest_is_drawn_in(void **state)
{
    (void)state;
    model *m = model_new();
    m->laws[0] = area_law();
    m->laws[0].energy_density = 5e4;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.2;
    m->scene.gravity = v3(0, 0, -9.81);
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.01));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    run_steps(w, 20000);
    double d = 0.01 - position_now(w, 0).z, weight = 2500 * 4 * DEM_PI / 3 * 1e-6 * 9.81;
    check_close(1e4 * d - 5e4 * DEM_PI * d * (0.02 - d), weight, 1e-9);
    check(d > 1.4 * weight / 1e4);
    dem_world_destroy(w);
    model_free(m);
}

// without dashpots nothing is lost: the pull has an energy of its own
static void the_ledger_holds_for_pulls(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        model *m = model_new();
        m->materials[0].young = 1e7;
        m->laws[0] = kind & 1 ? dmt_law() : area_law();
        if (kind & 1)
            m->laws[0].work_of_adhesion = 20;
        m->scene.time.step = 2e-6;
        model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.01001))->velocity = v3(0.02, 0, kind & 1 ? -1 : -0.5);
        if (kind & 2)
            model_body(m, model_sphere(m, 0.02), v3(0.001, 0, -0.02));
        else
            model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        dem_world *w = model_world(m, 1);
        double deepest = 0, worst = 0;
        for (int i = 0; i < 500; i++) {
            run_steps(w, 5);
            worst = largest(worst, measured(w)->energy.error);
            deepest = fmin(deepest, dem_world_figures(w)->energy.elastic);
        }
        check(dem_world_figures(w)->largest_overlap_ratio > 1e-4);
        check(worst < 2e-3);  // the jump of the force where surfaces touch falls inside a step
        dem_world_destroy(w);
        model_free(m);
    }
}

// the cap of friction is that of the push alone
static void friction_does_not_feel_the_pull(void **state)
{
    (void)state;
    dem_pair_law law = area_law();
    law.friction = DEM_FRICTION_LINEAR;
    law.friction_coefficient = 0.3;
    model *m = model_new();
    m->laws[0] = law;
    bench b = bench_spheres(m, 0.01, 0.02, 1e-4);
    set_pair(&b, 0.01, 0.02, 1e-4, v3(0, 5, 0));
    for (int i = 0; i < 3; i++)
        bench_step(&b, 1e-3);
    check_near(bench_wrench(&b, 0).force.y, 0.3 * 1, 1e-9);
    check_near(bench_wrench(&b, 1).force.x, 1 - 3e5 * DEM_PI * shared_radius2(false, 1e-4), 1e-9);
    bench_close(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dmt_pulls_by_two_pi_w_r_more_than_hertz),
        cmocka_unit_test(the_area_law_pulls_by_the_area_of_the_shared_circle),
        cmocka_unit_test(a_ball_at_rest_is_drawn_in),
        cmocka_unit_test(the_ledger_holds_for_pulls),
        cmocka_unit_test(friction_does_not_feel_the_pull),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
