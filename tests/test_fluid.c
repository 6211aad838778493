// The drag of a fluid: terminal velocities at any Reynolds number, grains that are stiff against the step, buoyancy,
// and the ledger.
#include "sim/fluid.h"
#include "same_bits.h"

static const double G = 9.81, STONE = 2500;

// Schiller and Naumann's drag coefficient with Newton's behind it, as users know them
static double drag_coefficient(double reynolds)
{
    double smooth = 24 / reynolds * (1 + 0.15 * pow(reynolds, 0.687));
    return smooth > 0.44 ? smooth : 0.44;
}

static double drag_force(const dem_drag_def *f, double d, double speed)
{
    return drag_coefficient(f->density * speed * d / f->viscosity) * f->density * speed * speed / 2 * DEM_PI / 4 * d *
           d;
}

// where weight and drag are equal, by halving
static double terminal_speed(const dem_drag_def *f, double d)
{
    double weight = (STONE - (f->buoyancy ? f->density : 0)) * DEM_PI / 6 * d * d * d * G, low = 0, high = 1e6;
    for (int i = 0; i < 200; i++) {
        double middle = (low + high) / 2;
        *(drag_force(f, d, middle) < weight ? &low : &high) = middle;
    }
    return low;
}

static dem_world *grain_in(const dem_drag_def *fluid, double d, double step, dem_vec3 velocity)
{
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -G);
    m->scene.time.step = step;
    m->scene.damping.drag = *fluid;
    model_body(m, model_sphere(m, d / 2), v3(0, 0, 0))->velocity = velocity;
    dem_world *w = model_world(m, 1);
    model_free(m);
    return w;
}

static const dem_drag_def WATER = {.density = 1000, .viscosity = 1e-3, .velocity = {0.1, -0.2, 0.3}};
static const dem_drag_def AIR = {.density = 1.2, .viscosity = 1.8e-5};

static void the_force_is_that_of_schiller_and_naumann(void **state)
{
    (void)state;
    for (double d = 1e-7; d < 1; d *= 3)
        for (double speed = 1e-9; speed < 100; speed *= 3)
            check_close(dem_fluid_drag(&WATER, d, speed), drag_force(&WATER, d, speed), 1e-13);
    dem_drag_def thick = {.viscosity = 2}, thin = {.density = 3};
    check_close(dem_fluid_drag(&thick, 0.1, 5), 3 * DEM_PI * 2 * 0.1 * 5, 1e-15);
    check_close(dem_fluid_drag(&thin, 0.1, 5), 0.44 * DEM_PI / 8 * 3 * 0.01 * 25, 1e-14);
    check(dem_fluid_drag(&thin, 0.1, 0) == 0 && dem_fluid_drag(&WATER, 0.1, 0) == 0);
}

// from dust of a micrometre, whose own time is 1e-4 of the step, to stones that are turbulent
static void grains_end_at_their_terminal_speed(void **state)
{
    (void)state;
    double least = INFINITY, most = 0;
    for (int water = 0; water < 2; water++)
        for (int buoyancy = 0; buoyancy < 2; buoyancy++)
            for (double d = 1e-6; d < (water ? 0.05 : 0.001); d *= 6) {
                dem_drag_def fluid = water ? WATER : AIR;
                fluid.buoyancy = buoyancy;
                fluid.velocity = v3(0, 0, 0);
                double speed = terminal_speed(&fluid, d), step = fmin(1e-3, 0.5 * d / speed);
                dem_world *w = grain_in(&fluid, d, step, v3(0.1 * speed, 0, 0));
                run_steps(w, (uint64_t)(40 * speed / G / step) + 40);
                measured(w);
                dem_vec3 v = dem_world_bodies(w).velocity[0];
                check_close(v.z, -speed, 1e-9);
                check(fabs(v.x) < 1e-6 * speed && v.y == 0);
                double reynolds = fluid.density * speed * d / fluid.viscosity;
                least = fmin(least, reynolds);
                most = fmax(most, reynolds);
                dem_world_destroy(w);
            }
    check(least < 1e-5 && most > 1e4);
}

// a step of any length takes a grain towards the fluid and never beyond, slow or fast
static void no_step_is_too_long_for_the_drag(void **state)
{
    (void)state;
    for (double speed = 1e-6; speed < 1e6; speed *= 100)
        for (double step = 1e-9; step < 1e3; step *= 1000) {
            model *m = model_new();
            m->scene.time.step = step;
            m->scene.damping.drag = WATER;
            m->scene.damping.drag.velocity = v3(0, 0, 0);
            m->scene.domain.leaving = DEM_LEAVING_IGNORE;
            model_body(m, model_sphere(m, 1e-5), v3(0, 0, 0));
            dem_world *w = model_world(m, 1);
            double last = speed;
            for (int i = 0; i < 6; i++) {
                dem_vec3 p = dem_fluid_impulse(w, 0, v3(0, last, 0), step);
                double next = last + p.y * w->bodies.inertia[0];
                check(next >= -1e-13 * last && next < last + 1e-300 && p.x == 0 && p.z == 0);
                // and by the force at the end
                if (next > 1e-8 * last)  // else nothing is left of it but rounding
                    check_close(-p.y, step * drag_force(&WATER, 2e-5, next), 1e-6);
                last = fmax(next, 0);
                if (last < 1e-30)
                    break;
            }
            dem_world_destroy(w);
            model_free(m);
        }
}

// v0 exp(-t/T) with T = m / (3 pi mu d): of the first order
static void a_grain_without_weight_follows_by_its_own_time(void **state)
{
    (void)state;
    dem_drag_def thick = {.viscosity = 0.1};
    double d = 1e-3, own = STONE * d * d / 18 / thick.viscosity, off[2];
    for (int i = 0; i < 2; i++) {
        double step = own / (100 << i);
        model *m = model_new();
        m->scene.time.step = step;
        m->scene.damping.drag = thick;
        model_body(m, model_sphere(m, d / 2), v3(0, 0, 0))->velocity = v3(0, 1, 0);
        dem_world *w = model_world(m, 1);
        run_steps(w, 200u << i);
        measured(w);
        off[i] = dem_world_bodies(w).velocity[0].y - exp(-2);
        dem_world_destroy(w);
        model_free(m);
    }
    check(fabs(off[0]) < 0.02 * exp(-2));
    check_near(off[0] / off[1], 2, 0.1);
}

static model *sediment(dem_vec3 flow, dem_integrator_def schemes, size_t bodies, double step)
{
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -G);
    m->scene.time.step = step;
    m->scene.integrator = schemes;
    m->scene.damping.drag = (dem_drag_def){.density = 1000, .viscosity = 0.05, .velocity = flow, .buoyancy = true};
    m->scene.damping.local = 0.1;
    m->laws[0].stiffness = 3e4;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.8;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    model_cloud(m, 6, 0.02, 1);
    model_dumbbell(m, 0.006, 0.008);
    model_lattice(m, bodies, 0.024, 1, 4);
    static const uint32_t holds[] = {0, DEM_LOCK_X, DEM_HOLD_VELOCITY, DEM_HOLD_SPIN, DEM_LOCK_RX};
    for (size_t i = 0; i < bodies; i++)
        m->bodies[i].hold = i % 3 ? 0 : holds[i / 3 % 5];
    for (size_t i = 0; i < bodies; i++)
        m->bodies[i].velocity = v3_scale(m->bodies[i].velocity, m->bodies[i].hold & DEM_HOLD_VELOCITY ? 0.05 : 1);
    double side = 0.024 * ceil(cbrt((double)bodies) - 1e-9);
    model_box(m, v3(0, 0, 0), v3(side, side, side));
    return m;
}

static void the_ledger_closes_in_a_fluid(void **state)
{
    (void)state;
    for (int flows = 0; flows < 2; flows++) {
        double worst[2] = {0};
        for (int fine = 0; fine < 2; fine++) {
            model *m = sediment(v3(0.3 * flows, 0, 0.1 * flows), (dem_integrator_def){0}, 27, fine ? 5e-6 : 1e-5);
            dem_world *w = model_world(m, 1);
            for (int i = 0; i < 40; i++) {
                run_steps(w, fine ? 400 : 200);
                worst[fine] = largest(worst[fine], measured(w)->energy.error);
            }
            const dem_energy *e = &measured(w)->energy;
            check(fabs(e->drag) > 0.02 * e->start && e->viscous > 0);
            dem_world_destroy(w);
            model_free(m);
        }
        check(worst[0] < 1e-3 && worst[1] < 0.7e-3);
    }
}

static void fluids_survive_a_save_and_change_no_bit_with_threads(void **state)
{
    (void)state;
    static const dem_integrator_def schemes[] = {{0}, {DEM_TRANSLATION_TAYLOR, DEM_ROTATION_PCDM}};
    for (int s = 0; s < 2; s++) {
        model *m = sediment(v3(0.3, 0, 0), schemes[s], 600, 1e-5);
        check_same_threads(m, 200);
        model_free(m);
    }
}

static void what_is_no_fluid_is_refused(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        model *m = model_new();
        dem_drag_def *f = &m->scene.damping.drag;
        *f = WATER;
        *(i == 0 ? &f->density : i == 1 ? &f->viscosity : &f->velocity.y) = i ? NAN : -1;
        model_body(m, model_sphere(m, 1), v3(0, 0, 0));
        dem_world *w;
        dem_error error;
        check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_USAGE && strstr(error.text, "damping.drag"));
        model_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_force_is_that_of_schiller_and_naumann),
        cmocka_unit_test(grains_end_at_their_terminal_speed),
        cmocka_unit_test(no_step_is_too_long_for_the_drag),
        cmocka_unit_test(a_grain_without_weight_follows_by_its_own_time),
        cmocka_unit_test(the_ledger_closes_in_a_fluid),
        cmocka_unit_test(fluids_survive_a_save_and_change_no_bit_with_threads),
        cmocka_unit_test(what_is_no_fluid_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
