// Friction that is larger at rest: its exponential, a block on an incline, the ledger, the same bits everywhere.
#include "bench_contact.h"
#include "same_bits.h"

static const double R = 0.01, G = 9.81, AT_REST = 0.6, SLIDING = 0.4;

static void the_exponential_is_right_to_the_last_bits(void **state)
{
    (void)state;
    double worst = 0;
    for (double x = -707.9; x <= 0; x += 0.0137) {
        double in[8], out[8];
        for (int i = 0; i < 8; i++)
            in[i] = x;
        wide_store(out, wide_exp(wide_load(in)));
        worst = largest(worst, out[0] / exp(x) - 1);
    }
    check(worst < 4.5e-16);  // two roundings
    double ends[][2] = {{0, 1}, {-709, 0}, {-1e300, 0}, {-INFINITY, 0}, {-1e-300, 1}};
    for (int i = 0; i < 5; i++) {
        double in[8], out[8];
        for (int k = 0; k < 8; k++)
            in[k] = ends[i][0];
        wide_store(out, wide_exp(wide_load(in)));
        check(out[0] == ends[i][1]);
    }
}

static dem_pair_law static_law(void)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.stiffness = 1e5;
    law.damping = DEM_DAMPING_RESTITUTION;
    law.restitution = 0.3;
    law.friction = DEM_FRICTION_LINEAR;
    law.friction_coefficient = SLIDING;
    law.static_coefficient = AT_REST;
    return law;
}

// four balls in a square, as a block, on a plane that is inclined towards +x
static model *block_on_plane(double slope)
{
    model *m = model_new();
    m->laws[0] = static_law();
    m->scene.gravity = v3(G * sin(slope), 0, -G * cos(slope));
    double ball = 2500 * 4 * DEM_PI / 3 * R * R * R, side = 2 * ball * R * R + 0.4 * ball * R * R;
    dem_ball balls[4];
    for (int i = 0; i < 4; i++)
        balls[i] = (dem_ball){v3((i & 1 ? 2 : -2) * R, (i & 2 ? 2 : -2) * R, 0), R};
    uint32_t shape = model_clump(m, balls, 4, 4 * ball, (double[]){8 * side, 8 * side, 16 * side});
    model_body(m, shape, v3(0, 0, R - ball * G * cos(slope) / 1e5));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    return m;
}

static void a_block_starts_to_slide_at_the_static_coefficient_and_slides_with_the_other(void **state)
{
    (void)state;
    for (int over = 0; over < 2; over++) {
        double slope = atan(AT_REST * (over ? 1.01 : 0.99));
        model *m = block_on_plane(0);
        dem_world *w = model_world(m, 1);
        run_steps(w, 20000);
        // tilted slowly, so that nothing is thrown over the edge
        for (int i = 1; i <= 40000; i++) {
            double a = slope * i / 40000;
            w->gravity = v3(G * sin(a), 0, -G * cos(a));
            run_steps(w, 1);
        }
        run_steps(w, over ? 30000 : 10000);
        double before = velocity_before(w, 0).x;
        run_steps(w, 10000);
        double gained = velocity_before(w, 0).x - before;
        if (over)
            check_close(gained, G * (sin(slope) - SLIDING * cos(slope)) * 0.1, 2e-3);  // exp(-500 s/m v)
        else
            check(fabs(before) < 1e-4 && fabs(gained) < 1e-4);
        dem_world_destroy(w);
        model_free(m);
    }
}

// spheres that slide on each other at a given speed
static void the_coefficient_falls_with_the_speed(void **state)
{
    (void)state;
    model *m = model_new();
    m->laws[0] = static_law();
    m->laws[0].damping = DEM_DAMPING_NONE;
    m->laws[0].friction_decay = 20;
    bench b = bench_spheres(m, 0.01, 0.02, 1e-4);
    for (double speed = 1e-3; speed < 2; speed *= 3) {
        set_pair(&b, 0.01, 0.02, 1e-4, v3(0, speed, 0));
        for (int i = 0; i < 4; i++)
            bench_step(&b, 1 / speed);
        double mu = SLIDING + (AT_REST - SLIDING) * exp(-20 * speed);
        check_close(bench_wrench(&b, 0).force.y, mu * 10, 1e-11);
    }
    bench_close(&b);
}

static model *rough_gas(void)
{
    model *m = model_new();
    m->laws[0] = static_law();
    m->scene.time.step = 2e-5;
    model_sphere(m, 2 * R);
    model_dumbbell(m, 1.5 * R, 2 * R);
    model_lattice(m, 600, 4.8 * R, 1, 1);
    return m;
}

static void the_ledger_holds(dem_world *w)
{
    const dem_energy *e = &dem_world_figures(w)->energy;
    check(e->friction > 0.05 * e->kinetic && fabs(e->error) < 5e-3);
}

static void a_gas_is_the_same_bits_everywhere(void **state)
{
    (void)state;
    check_same_bits(rough_gas, 1000, the_ledger_holds);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_exponential_is_right_to_the_last_bits),
        cmocka_unit_test(a_block_starts_to_slide_at_the_static_coefficient_and_slides_with_the_other),
        cmocka_unit_test(the_coefficient_falls_with_the_speed),
        cmocka_unit_test(a_gas_is_the_same_bits_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
