// Moments against rolling and twisting: against hand calculations, at rest and in motion, and in the energy ledger.
#include "bench_contact.h"

static const double R = 0.01, G = 9.81;

static double ball_mass(void)
{
    return 2500 * 4 * DEM_PI / 3 * R * R * R;
}

static dem_pair_law rolling_law(dem_rolling_law rolling, double coefficient)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.stiffness = 1e5;
    law.damping = DEM_DAMPING_RESTITUTION;
    law.restitution = 0.3;
    law.friction = DEM_FRICTION_LINEAR;
    law.friction_coefficient = 0.8;
    law.rolling = rolling;
    law.rolling_coefficient = coefficient;
    return law;
}

// a ball pressed by its weight into a plane that is inclined by `slope` towards +x
static model *ball_on_plane(const dem_pair_law *law, double slope)
{
    model *m = model_new();
    m->laws[0] = *law;
    m->scene.gravity = v3(G * sin(slope), 0, -G * cos(slope));
    model_body(m, model_sphere(m, R), v3(0, 0, R - ball_mass() * G * cos(slope) / 1e5));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    return m;
}

// ---- rolling

static void a_bound_stops_a_spin_and_never_turns_it_round(void **state)
{
    (void)state;
    dem_pair_law law = rolling_law(DEM_ROLLING_BOUNDED, 0.3);
    law.friction = DEM_FRICTION_NONE;
    model *m = ball_on_plane(&law, 0);
    m->bodies[0].spin = v3(2, -1, 3);
    dem_world *w = model_world(m, 1);
    // L falls by mu R m g t along itself
    double l0 = 0.4 * ball_mass() * R * R * sqrt(14), t = 0.4 * l0 / (0.3 * R * ball_mass() * G);
    uint64_t steps = (uint64_t)llround(t / 1e-5);
    run_steps(w, steps);
    double moment = 0.3 * R * ball_mass() * G, left = l0 - ((double)steps - 0.5) * 1e-5 * moment;
    check_close(v3_norm(spin_before(w, 0)) * 0.4 * ball_mass() * R * R, left, 1e-3);
    check_vec(v3_unit(spin_before(w, 0)), v3_unit(v3(2, -1, 3)), 1e-12);
    for (int i = 0; i < 20; i++) {
        run_steps(w, steps / 5);
        check(v3_dot(spin_before(w, 0), v3(2, -1, 3)) >= 0);
    }
    check_vec(spin_before(w, 0), v3(0, 0, 0), 0);
    dem_world_destroy(w);
    model_free(m);
}

// two balls in line; the second rolls over the first
static bench rolling_pair(dem_pair_law law, model *m)
{
    m->laws[0] = law;
    return bench_spheres(m, 0.01, 0.02, 1e-4);
}

static void a_rolling_spring_has_its_stiffness_dashpot_and_cap(void **state)
{
    (void)state;
    dem_pair_law law = rolling_law(DEM_ROLLING_EPSD, 0.2);
    law.friction = DEM_FRICTION_NONE;
    law.damping = DEM_DAMPING_NONE;
    bench b = rolling_pair(law, model_new());
    double reduced = 0.01 * 0.02 / 0.03, stiffness = 2.25 * 1e5 * 0.04 * reduced * reduced;
    double i1 = 1.4 * ball_mass() * R * R, i2 = 1.4 * 8 * ball_mass() * 4 * R * R;
    double dashpot = 2 * 0.3 * sqrt(stiffness / (1 / i1 + 1 / i2));
    dem_vec3 spin = v3(7, 0.3, -0.4);  // the part along the normal is no rolling
    bench_put(&b, 1, v3(0.03 - 1e-4, 0, 0), v3(0, 0, 0), spin);
    bench_step(&b, 1e-3);
    dem_vec3 rolling = v3(0, spin.y, spin.z);
    wrench first = bench_wrench(&b, 0), second = bench_wrench(&b, 1);
    check_vec(first.moment, v3_scale(rolling, stiffness * 1e-3 + dashpot), 1e-12 * stiffness);
    check_vec(second.moment, v3_scale(first.moment, -1), 0);
    check_vec(first.force, v3(-10, 0, 0), 1e-9);
    // rolled on, it slides: no dashpot
    bench_put(&b, 1, v3(0.03 - 1e-4, 0, 0), v3(0, 0, 0), rolling);
    for (int i = 0; i < 5; i++)
        bench_step(&b, 0.1);
    double cap = 0.2 * reduced * 10;
    check_vec(bench_wrench(&b, 0).moment, v3_scale(v3_unit(rolling), cap), 1e-9 * cap);
    // and back by a part of the spring's angle
    bench_put(&b, 1, v3(0.03 - 1e-4, 0, 0), v3(0, 0, 0), v3_scale(rolling, -1));
    bench_step(&b, 1e-3);
    check_close(v3_norm(bench_wrench(&b, 0).moment), fabs(cap - (1e-3 * stiffness + dashpot) * 0.5), 1e-9);
    bench_close(&b);
}

static void a_rolling_stiffness_that_is_given_is_taken(void **state)
{
    (void)state;
    dem_pair_law law = rolling_law(DEM_ROLLING_EPSD, 0.2);
    law.friction = DEM_FRICTION_NONE;
    law.damping = DEM_DAMPING_NONE;
    law.rolling_stiffness = 0.125;
    law.rolling_damping = 0;
    bench b = rolling_pair(law, model_new());
    bench_put(&b, 1, v3(0.03 - 1e-4, 0, 0), v3(0, 0, 0), v3(0, 0, 1));
    bench_step(&b, 1e-3);
    check_vec(bench_wrench(&b, 0).moment, v3(0, 0, 0.125e-3), 1e-16);
    bench_close(&b);
}

static void constant_moments_are_against_the_rate_and_nothing_at_rest(void **state)
{
    (void)state;
    dem_pair_law law = rolling_law(DEM_ROLLING_CONSTANT, 0.2);
    law.friction = DEM_FRICTION_NONE;
    law.damping = DEM_DAMPING_NONE;
    law.twisting = DEM_TWISTING_CONSTANT;
    law.twisting_coefficient = 0.3;
    bench b = rolling_pair(law, model_new());
    double hold = 0.01 * 0.02 / 0.03 * 10;
    bench_put(&b, 1, v3(0.03 - 1e-4, 0, 0), v3(0, 0, 0), v3(-2, 3, 4));
    bench_step(&b, 1e-5);
    check_vec(bench_wrench(&b, 0).moment, v3(-0.3 * hold, 0.2 * hold * 0.6, 0.2 * hold * 0.8), 1e-9 * hold);
    bench_put(&b, 1, v3(0.03 - 1e-4, 0, 0), v3(0, 0, 0), v3(0, 0, 0));
    bench_step(&b, 1e-5);
    check_vec(bench_wrench(&b, 0).moment, v3(0, 0, 0), 0);
    bench_close(&b);
}

// ---- twisting

static void a_twist_below_the_cap_is_held_by_a_spring(void **state)
{
    (void)state;
    dem_pair_law law = rolling_law(DEM_ROLLING_NONE, 0);
    law.damping = DEM_DAMPING_NONE;
    law.stiffness_ratio = 0.5;
    law.twisting = DEM_TWISTING_MARSHALL;
    bench b = rolling_pair(law, model_new());
    double patch2 = 0.01 * 0.02 / 0.03 * 1e-4, stiffness = 0.5 * 0.5e5 * patch2;
    bench_put(&b, 1, v3(0.03 - 1e-4, 0, 0), v3(0, 0, 0), v3(-2, 0, 0));
    bench_step(&b, 1e-3);
    bench_step(&b, 1e-3);
    check_vec(bench_wrench(&b, 0).moment, v3(-4e-3 * stiffness, 0, 0), 1e-12 * stiffness);
    bench_close(&b);
}

// ---- all together

// an oblique impact with spins; what is lost and what is there stay what was there
static void the_ledger_holds_for_moments(void **state)
{
    (void)state;
    for (int kind = 0; kind < 10; kind++) {
        model *m = model_new();
        m->materials[0].young = 1e8;
        m->laws[0] = rolling_law(kind % 5 == 4 ? DEM_ROLLING_NONE : (dem_rolling_law)(kind % 5), 0.3);
        m->laws[0].twisting = kind % 5 == 4 ? DEM_TWISTING_CONSTANT : DEM_TWISTING_MARSHALL;
        m->laws[0].twisting_coefficient = 0.2;
        if (kind >= 5) {
            m->laws[0].normal = DEM_NORMAL_HERTZ;
            m->laws[0].friction = DEM_FRICTION_MINDLIN;
        }
        m->scene.time.step = kind >= 5 ? 1e-6 : 4e-6;
        uint32_t shape = model_dumbbell(m, R, 0.016);
        dem_body_def *a = model_body(m, shape, v3(0, 0, 0)), *b = model_body(m, shape, v3(0.003, 0.006, 0.0192));
        a->spin = v3(30, -60, 50);
        b->spin = v3(-20, 40, 80);
        b->velocity = v3(-0.3, 0.2, -2);
        dem_world *w = model_world(m, 1);
        double worst = 0, lost = 0;
        bool touched = false;
        for (int i = 0; i < 400; i++) {
            run_steps(w, 5);
            const dem_figures *f = measured(w);
            touched |= f->contacts > 0;
            worst = largest(worst, f->energy.error);
            lost = f->energy.friction;
        }
        check(touched && lost > 1e-5);
        check(worst < 2e-3);  // of second order: some tens of steps in the contact
        dem_world_destroy(w);
        model_free(m);
    }
}

// balls at rest under an automatic step: the bound knows of the rolling springs
static void an_automatic_step_is_lowered_for_stiff_rolling_springs(void **state)
{
    (void)state;
    double step[2];
    for (int stiff = 0; stiff < 2; stiff++) {
        dem_pair_law law = rolling_law(DEM_ROLLING_EPSD, 0.5);
        law.rolling_stiffness = stiff ? 1e4 : 1e-9;
        model *m = ball_on_plane(&law, 0);
        m->scene.time.step = 0;
        dem_world *w = model_world(m, 1);
        run_steps(w, 200);
        step[stiff] = dem_world_step_size(w);
        // I_r = 7/5 m R^2, its spin has 2/5 m R^2: h^2 k + 2 h c < 4 I
        double inertia = 0.4 * ball_mass() * R * R, k = law.rolling_stiffness;
        double c = 2 * law.rolling_damping * sqrt(k * 1.4 * ball_mass() * R * R);
        check(step[stiff] * step[stiff] * k + 2 * step[stiff] * c < 4 * inertia);
        dem_world_destroy(w);
        model_free(m);
    }
    check(step[1] < 0.5 * step[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bound_stops_a_spin_and_never_turns_it_round),
        cmocka_unit_test(a_rolling_spring_has_its_stiffness_dashpot_and_cap),
        cmocka_unit_test(a_rolling_stiffness_that_is_given_is_taken),
        cmocka_unit_test(constant_moments_are_against_the_rate_and_nothing_at_rest),
        cmocka_unit_test(a_twist_below_the_cap_is_held_by_a_spring),
        cmocka_unit_test(the_ledger_holds_for_moments),
        cmocka_unit_test(an_automatic_step_is_lowered_for_stiff_rolling_springs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
