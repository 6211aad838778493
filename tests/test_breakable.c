// Bonds between surfaces that touch: their strength in pull and shear, what is left of them, energy, lists, restarts.
#include "bench_contact.h"
#include "same_bits.h"

static const double R = 0.01, K = 1e5;

static dem_pair_law bond_law_of(double tension, double shear, dem_bonded bonded)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.stiffness = K;
    law.friction = DEM_FRICTION_LINEAR;
    law.friction_coefficient = 0.5;
    law.stiffness_ratio = 0.5;
    law.cohesion = DEM_COHESION_BREAKABLE;
    law.bond_tension = tension;
    law.bond_shear = shear;
    law.bonded = bonded;
    return law;
}

// two balls that are moved by hand, bonded at an overlap of 1 um by a first look
static bench bonded_pair(double tension, double shear)
{
    model *m = model_new();
    m->laws[0] = bond_law_of(tension, shear, DEM_BONDED_AT_START);
    bench b = bench_spheres(m, R, R, 1e-6);
    bench_step(&b, 0);
    return b;
}

static void a_bond_bears_both_ways_and_breaks_at_its_strength(void **state)
{
    (void)state;
    bench b = bonded_pair(20, 1e9);
    for (double d = 1e-5; d > -1.99e-4; d -= 1e-5) {
        set_pair(&b, R, R, d, v3(0.01, 0, 0));
        check_near(bench_force(&b, 1, 1e-5).x, K * d, 1e-9);
    }
    set_pair(&b, R, R, -1.99999e-4, v3(0, 0, 0));
    check_near(bench_force(&b, 1, 1e-5).x, -20, 1e-3);
    set_pair(&b, R, R, -2.00001e-4, v3(0, 0, 0));
    check_vec(bench_force(&b, 1, 1e-5), v3(0, 0, 0), 0);
    // it is gone, and does not come back when the surfaces are nearer again
    set_pair(&b, R, R, -1e-5, v3(0, 0, 0));
    check_vec(bench_force(&b, 1, 1e-5), v3(0, 0, 0), 0);
    set_pair(&b, R, R, 1e-5, v3(0, 0, 0));
    check_near(bench_force(&b, 1, 1e-5).x, 1, 1e-9);
    set_pair(&b, R, R, -1e-5, v3(0, 0, 0));
    check_vec(bench_force(&b, 1, 1e-5), v3(0, 0, 0), 0);
    bench_close(&b);
}

// beyond mu F_n, up to its strength; then the surfaces slide with mu F_n
static void a_bond_that_is_sheared_off_leaves_friction(void **state)
{
    (void)state;
    bench b = bonded_pair(20, 8);
    double slip = 0, kt = 0.5 * K;
    for (int i = 0; i < 15; i++) {
        set_pair(&b, R, R, 1e-5, v3(0, 1, 0));
        bench_step(&b, 1e-5);
        slip += 1e-5;
        check_near(bench_wrench(&b, 0).force.y, kt * slip, 1e-6 * kt * slip);
    }
    set_pair(&b, R, R, 1e-5, v3(0, 1.1, 0));
    bench_step(&b, 1e-5);
    check_near(bench_wrench(&b, 0).force.y, 0.5 * K * 1e-5, 1e-9);
    check_near(bench_wrench(&b, 0).force.x, -1, 1e-9);
    // as long as the surfaces touch
    set_pair(&b, R, R, -1e-7, v3(0, 0, 0));
    check_vec(bench_force(&b, 0, 1e-5), v3(0, 0, 0), 0);
    bench_close(&b);
}

static void a_bond_sheared_off_under_tension_leaves_nothing(void **state)
{
    (void)state;
    bench b = bonded_pair(20, 8);
    set_pair(&b, R, R, -1e-5, v3(0, 15, 0));
    bench_step(&b, 1e-5);
    check_near(bench_wrench(&b, 0).force.x, 1, 1e-6);
    check_near(bench_wrench(&b, 0).force.y, 7.5, 1e-6);
    set_pair(&b, R, R, -1e-5, v3(0, 2, 0));
    check_vec(bench_force(&b, 0, 1e-5), v3(0, 0, 0), 0);
    bench_close(&b);
}

// balls in a row: touching by a rounding, nearer than the gap, farther; the last meet later
static void what_is_bonded_is_said_by_the_gap_and_the_time(void **state)
{
    (void)state;
    for (dem_bonded bonded = DEM_BONDED_AT_START; bonded <= DEM_BONDED_AT_TOUCH; bonded++) {
        model *m = model_new();
        m->laws[0] = bond_law_of(50, 50, bonded);
        m->laws[0].bond_gap = bonded == DEM_BONDED_AT_START ? 1e-5 : 0;
        m->laws[0].damping = DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = 0.1;
        uint32_t shape = model_sphere(m, R);
        double at[] = {0, 0.02 * (1 + 1e-15), 0.1, 0.12 + 5e-6, 0.2, 0.22 + 2e-5};
        for (int i = 0; i < 6; i++)
            model_body(m, shape, v3(at[i], 0, 0));
        m->bodies[5].velocity = v3(-0.02, 0, 0);
        dem_world *w = model_world(m, 1);
        run_steps(w, 1);
        size_t holding = measured(w)->contacts;
        assert_int_equal(holding, bonded == DEM_BONDED_AT_START ? 2 : 1);
        run_steps(w, 20000);
        // the last two have met: they part again, or not
        bool parted = position_now(w, 5).x - position_now(w, 4).x > 0.0201;
        check(parted == (bonded == DEM_BONDED_AT_START));
        dem_world_destroy(w);
        model_free(m);
    }
}

// a chain hangs from a ceiling: each bond bears what hangs below it
static void a_chain_breaks_where_its_weight_is_too_large(void **state)
{
    (void)state;
    enum { LINKS = 10 };
    double mass = 2500 * 4 * DEM_PI / 3 * R * R * R, weight = mass * 9.81;
    for (int strong = 0; strong < 2; strong++) {
        model *m = model_new();
        // of the weight of all, and the swing of a weight that is let go
        m->laws[0] = bond_law_of(weight * LINKS * (strong ? 2.01 : 1.2), 1, DEM_BONDED_AT_START);
        m->laws[0].damping = DEM_DAMPING_RATE;
        m->laws[0].damping_rate = 2000;
        m->scene.gravity = v3(0, 0, -9.81);
        uint32_t shape = model_sphere(m, R);
        for (int i = 0; i < LINKS; i++)
            model_body(m, shape, v3(0, 0, -R - 2 * R * i));
        model_plane(m, v3(0, 0, 0), v3(0, 0, -1));
        dem_world *w = model_world(m, 1);
        double worst = 0;
        for (int i = 0; i < 200; i++) {
            run_steps(w, 100);
            worst = largest(worst, measured(w)->energy.error);
        }
        check(worst < 1e-3);
        if (strong) {
            assert_int_equal(measured(w)->contacts, LINKS - 1);
            assert_int_equal(measured(w)->wall_contacts, 1);
            run_steps(w, 100000);
            double stretch = 0;
            for (int i = 0; i < LINKS; i++)
                stretch += weight * (LINKS - i) / K;
            check_near(position_now(w, LINKS - 1).z, -R - 2 * R * (LINKS - 1) - stretch, 1e-3 * stretch);
        } else {
            // the topmost bond goes first
            assert_int_equal(measured(w)->wall_contacts, 0);
            assert_int_equal(measured(w)->contacts, LINKS - 1);
            check(dem_world_figures(w)->energy.broken > 0);
        }
        dem_world_destroy(w);
        model_free(m);
    }
}

// two balls fly apart and sideways: what they lose is what the bond held
static void the_ledger_holds_where_bonds_break(void **state)
{
    (void)state;
    for (int kind = 0; kind < 6; kind++) {
        model *m = model_new();
        double shear = kind % 3 ? 3 : 1e6, tension = kind % 3 == 2 ? 1e3 : 5;
        m->laws[0] = bond_law_of(tension, shear, DEM_BONDED_AT_START);
        if (kind >= 3) {
            m->laws[0].damping = DEM_DAMPING_RESTITUTION;
            m->laws[0].restitution = 0.7;
        }
        m->scene.time.step = 2e-6;
        uint32_t shape = model_sphere(m, R);
        model_body(m, shape, v3(0, 0, 0))->velocity = v3(0, 0, 0.01);
        model_body(m, shape, v3(2 * R - (kind % 3 == 2 ? 2e-5 : 1e-8), 0, 0))->velocity =
            kind % 3 == 2 ? v3(0, 0.6, 0.01) : v3(0.3, 0.2, -0.1);
        dem_world *w = model_world(m, 1);
        double worst = 0;
        for (int i = 0; i < 500; i++) {
            run_steps(w, 5);
            worst = largest(worst, measured(w)->energy.error);
        }
        const dem_figures *f = dem_world_figures(w);
        check(kind % 3 == 2 || f->contacts == 0);
        check(f->energy.broken + f->energy.friction > 1e-5);
        check(worst < 2e-3);  // of second order
        dem_world_destroy(w);
        model_free(m);
    }
}

static model *crumbling(void)
{
    model *m = model_new();
    m->laws[0] = bond_law_of(30, 20, DEM_BONDED_AT_TOUCH);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    m->laws[0].rolling = DEM_ROLLING_EPSD;
    m->laws[0].rolling_coefficient = 0.1;
    m->scene.time.step = 1e-5;
    model_sphere(m, 2 * R);
    model_dumbbell(m, 1.5 * R, 2 * R);
    model_lattice(m, 600, 4.6 * R, 1, 1);
    return m;
}

static void some_hold_and_some_broke(dem_world *w)
{
    const dem_figures *f = dem_world_figures(w);
    check(f->contacts > 50 && f->energy.broken > 0 && fabs(f->energy.error) < 1e-2);
}

static void crumbs_are_the_same_bits_everywhere(void **state)
{
    (void)state;
    check_same_bits(crumbling, 1000, some_hold_and_some_broke);
}

static void what_would_hold_too_far_is_refused(void **state)
{
    (void)state;
    model *m = model_new();
    m->laws[0] = bond_law_of(1e9, 1, DEM_BONDED_AT_START);
    model_body(m, model_sphere(m, R), v3(0, 0, 0));
    dem_world *w;
    dem_error error;
    check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "lower \"tension\""));
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bond_bears_both_ways_and_breaks_at_its_strength),
        cmocka_unit_test(a_bond_that_is_sheared_off_leaves_friction),
        cmocka_unit_test(a_bond_sheared_off_under_tension_leaves_nothing),
        cmocka_unit_test(what_is_bonded_is_said_by_the_gap_and_the_time),
        cmocka_unit_test(a_chain_breaks_where_its_weight_is_too_large),
        cmocka_unit_test(the_ledger_holds_where_bonds_break),
        cmocka_unit_test(crumbs_are_the_same_bits_everywhere),
        cmocka_unit_test(what_would_hold_too_far_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
