// The automatic time step: what it promises while a scene runs, and motion across a change of the step.
#include "sim/impact.h"
#include "sim/timestep.h"
#include "worlds.h"

static double sphere_mass(double r)
{
    return 2500 * 4 * DEM_PI / 3 * r * r * r;
}

static model *auto_model(bool hertz)
{
    model *m = model_new();
    m->scene.time.step = 0;
    m->scene.gravity = v3(0, 0, -9.81);
    m->materials[0].young = 1e7;
    dem_pair_law *law = &m->laws[0];
    if (hertz)
        law->normal = DEM_NORMAL_HERTZ;
    law->damping = DEM_DAMPING_RESTITUTION;
    law->restitution = 0.5;
    law->friction = hertz ? DEM_FRICTION_MINDLIN : DEM_FRICTION_LINEAR;
    law->friction_coefficient = 0.5;
    return m;
}

// ---- stability

// clumps and spheres fall into a box and settle; the limit of the contacts that touch is asked all the time
static void no_step_is_above_the_limit_while_a_heap_is_poured(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        bool hertz = i % 2, clumps = i / 2 % 2;
        model *m = auto_model(hertz);
        m->scene.time.contact_steps = i / 4 % 2 ? 10 : 0;  // stability alone
        if (clumps)
            model_cloud(m, 30, 0.02, 1);
        model_sphere(m, 0.01);
        model_lattice(m, 64, 0.024, 0.5, 1);
        model_box(m, v3(0, 0, 0), v3(0.1, 0.1, 0.3));
        dem_world *w = model_world(m, 1);
        double safety = hertz ? 0.5 : 0.8, worst = 0, smallest = INFINITY, largest = 0;
        while (dem_world_time(w) < 0.3) {
            run_steps(w, 5);
            double step = dem_world_step_size(w);
            worst = fmax(worst, step / dem_world_critical_step(w));
            smallest = fmin(smallest, step);
            largest = fmax(largest, step);
        }
        // never above it. A new contact counts a step later, and a body may strain a little more before it is asked:
        // that is what the safety is for
        check(worst < 1 && worst < 1.25 * safety);
        // it makes use of what it may, and changes where stability rules
        check(worst > 0.6 * safety);
        if (m->scene.time.contact_steps == 0)
            check(largest > 1.2 * smallest);
        check(measured(w)->contacts > 20 && fabs(measured(w)->energy.error) < 0.05);
        dem_world_destroy(w);
        model_free(m);
    }
}

// a sphere squeezed by as many walls as you like
static model *squeezed(int walls, double safety)
{
    model *m = model_new();
    m->scene.time.step = 0;
    m->scene.time.contact_steps = 0;
    m->scene.time.safety = safety;
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0));
    for (int k = 0; k < walls; k++) {
        double a = 2 * DEM_PI * k / walls;
        dem_vec3 out = v3(cos(a), sin(a), 0);
        model_plane(m, v3_scale(out, 0.0099), v3_scale(out, -1));
    }
    return m;
}

static void the_share_of_the_limit_is_the_one_asked_for(void **state)
{
    (void)state;
    static const double safeties[] = {NAN, 0.3, 0.6};
    for (int i = 0; i < 3; i++) {
        model *m = squeezed(12, safeties[i]);
        dem_world *w = model_world(m, 1);
        // twelve walls around: each direction of the plane has six of them
        double bound = 2 / sqrt(6 * 1e4 / sphere_mass(0.01)), safety = i ? safeties[i] : 0.8;
        check_close(dem_world_critical_step(w), bound, 1e-12);
        check_close(dem_world_step_size(w), safety * bound, 1e-12);
        run_steps(w, 3000);
        check_close(dem_world_step_size(w), safety * bound, 1e-9);
        dem_world_destroy(w);
        model_free(m);
    }
}

// walls that come together and part again: the step falls with the contacts and rises behind them
static void the_step_falls_at_once_and_rises_again_in_time(void **state)
{
    (void)state;
    model *m = squeezed(12, 0.5);
    for (int k = 0; k < 12; k++) {
        // not yet there; they turn back in a later world
        m->walls[k].point = v3_scale(m->walls[k].point, 1.02);
        m->walls[k].velocity = v3_scale(m->walls[k].normal, 0.1);
    }
    dem_world *w = model_world(m, 1);
    double free_step = dem_world_step_size(w), bound = 2 / sqrt(6 * 1e4 / sphere_mass(0.01));
    check(isinf(dem_world_critical_step(w)) && free_step > 0.6 * bound);
    while (measured(w)->wall_contacts < 12)
        run_steps(w, 1);
    run_steps(w, 1);
    check(dem_world_step_size(w) <= 0.5 * bound && dem_world_step_size(w) > 0.45 * bound);
    dem_world_destroy(w);
    // out again: the sphere is set free
    for (int k = 0; k < 12; k++) {
        m->walls[k].point = v3_scale(m->walls[k].point, 1 / 1.02);
        m->walls[k].velocity = v3_scale(m->walls[k].normal, -1);
    }
    w = model_world(m, 1);
    check_close(dem_world_step_size(w), 0.5 * bound, 1e-12);
    run_steps(w, 2100);  // asked every 1000 steps
    check(measured(w)->wall_contacts == 0);
    check_close(dem_world_step_size(w), free_step, 1e-12);
    dem_world_destroy(w);
    model_free(m);
}

// ---- accuracy

static void a_linear_contact_takes_the_steps_asked_for(void **state)
{
    (void)state;
    static const double asked[] = {10, 25, 100};
    for (int i = 0; i < 3; i++) {
        model *m = model_new();
        m->scene.time.step = 0;
        m->scene.time.contact_steps = asked[i];
        model_sphere(m, 0.02);
        model_sphere(m, 0.01);  // the smaller one counts
        model_body(m, 0, v3(0, 1, 0));
        model_body(m, 1, v3(0, 0, 0))->velocity = v3(0.5, 0, 0);
        model_body(m, 1, v3(0.0201, 0, 0));
        dem_world *w = model_world(m, 1);
        double duration = dem_linear_duration(sphere_mass(0.01) / 2, 1e4);
        check_close(dem_world_step_size(w), duration / asked[i], 1e-12);
        size_t touched = 0;
        for (int k = 0; k < 10 * asked[i]; k++) {
            run_steps(w, 1);
            touched += measured(w)->contacts;
        }
        check_near((double)touched, asked[i], 1);
        dem_world_destroy(w);
        model_free(m);
    }
}

// its contacts are the shorter the faster: speeds of falls by some sizes and twice those that are there are expected
static void a_hertz_contact_takes_at_least_the_steps_asked_for(void **state)
{
    (void)state;
    static const double speeds[] = {0.01, 0.3, 3};
    for (int i = 0; i < 3; i++) {
        model *m = auto_model(true);
        m->laws[0].damping = DEM_DAMPING_NONE;
        m->scene.time.contact_steps = 20;
        m->scene.gravity = v3(0, 0, 0);
        model_sphere(m, 0.01);
        model_body(m, 0, v3(0, 0, 0))->velocity = v3(speeds[i], 0, 0);
        model_body(m, 0, v3(0.0201, 0, 0));
        dem_world *w = model_world(m, 1);
        double k = dem_hertz_stiffness(1e7 / 2 / (1 - 0.0625), 0.005), mass = sphere_mass(0.01) / 2;
        double duration = dem_hertz_duration(mass, k, speeds[i]), h = dem_world_step_size(w);
        check(h <= duration / 20);
        check(h > duration / 20 / 1.6);  // twice the speed bound makes 2.8^0.2 of it
        size_t touched = 0;
        for (double t = 0; t < 3e-4 / speeds[i] + 2 * duration; t += h) {
            run_steps(w, 1);
            touched += measured(w)->contacts;
        }
        check(touched >= 19 && touched < 40);
        dem_world_destroy(w);
        model_free(m);
    }
}

static void a_scene_without_a_law_in_sight_lives_with_its_end(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.time.step = 0;
    m->scene.time.end = 2;
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0));
    m->laws[0].normal = DEM_NORMAL_HERTZ;  // at rest, without weight: no speed to expect
    dem_world *w = model_world(m, 1);
    check_close(dem_world_step_size(w), 2.0 / 1000, 1e-15);
    dem_world_destroy(w);
    model_free(m);
}

// ---- time and motion across a change

// a fall under Hertz is expected to end ever harder, so its step falls; x and v stay exact
static void a_fall_is_exact_however_often_the_step_changes(void **state)
{
    (void)state;
    model *m = auto_model(true);
    model_sphere(m, 0.01);
    model_body(m, 0, v3(0, 0, 0));
    dem_world *w = model_world(m, 1);
    double before = 0, step = dem_world_step_size(w);
    int changes = 0;
    for (int i = 0; i < 20000; i++) {
        run_steps(w, 1);
        double t = dem_world_time(w);
        check_near(t - before, step, 1e-15);
        before = t;
        changes += dem_world_step_size(w) != step;
        step = dem_world_step_size(w);
        if (i % 500 == 499) {
            measured(w);
            check_near(dem_world_bodies(w).velocity[0].z, -9.81 * t, 1e-11 * 9.81 * t);
            check_near(dem_world_bodies(w).position[0].z, -9.81 * t * t / 2, 1e-11 * 9.81 * t * t);
        }
    }
    check(changes > 5 && dem_world_time(w) > 1);
    dem_world_destroy(w);
    model_free(m);
}

// as the automatic step sets it
static void change_step(dem_world *w, double step)
{
    w->epoch_time = dem_world_time(w);
    w->epoch_steps = w->steps;
    w->next_step = step;
}

// A swing between two walls, the step changed by a third every few steps: errors fall with its square. If velocities
// were taken on by the new step alone, they would be off by the first order at each change.
static void a_swing_keeps_the_second_order_across_changes(void **state)
{
    (void)state;
    double mass = sphere_mass(0.01), rate = sqrt(2e4 / mass), error[3];
    for (int fine = 0; fine < 3; fine++) {
        model *m = model_new();
        double h = 0.04 / rate / (1 << fine);
        m->scene.time.step = h;
        model_body(m, model_sphere(m, 0.01), v3(0, 0, 0))->velocity = v3(0, 0, 0.005);
        model_plane(m, v3(0, 0, -0.0099), v3(0, 0, 1));
        model_plane(m, v3(0, 0, 0.0099), v3(0, 0, -1));
        dem_world *w = model_world(m, 1);
        error[fine] = 0;
        for (int i = 0; i < 60; i++) {
            change_step(w, i % 2 ? h : 2 * h / 3);
            run_steps(w, 5 << fine);
            measured(w);
            double t = dem_world_time(w), x = 0.005 / rate * sin(rate * t), v = 0.005 * cos(rate * t);
            error[fine] = fmax(error[fine], fabs(dem_world_bodies(w).position[0].z - x) * rate / 0.005);
            error[fine] = fmax(error[fine], fabs(dem_world_bodies(w).velocity[0].z - v) / 0.005);
        }
        dem_world_destroy(w);
        model_free(m);
    }
    check(error[0] < 2e-3);
    check(error[0] / error[1] > 3.5 && error[1] / error[2] > 3.5);
}

// what friction and dashpots remember is of the step that was, not of the one to come
static void springs_grow_by_the_step_that_was(void **state)
{
    (void)state;
    model *m = model_new();
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 1e6;
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.00999))->velocity = v3(0.001, 0, 0);
    m->materials[0].density = 1e12;  // too heavy to be slowed down
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    for (int i = 0; i < 12; i++) {
        change_step(w, i % 3 ? 1e-5 : 4e-5);
        run_steps(w, 1);
        const dem_figures *f = measured(w);
        size_t count;
        double slipped = 0.001 * f->time, force = dem_world_contacts(w, &count)->friction_force.x;
        check_close(force, -2.0 / 7 * 1e4 * slipped, 1e-6);
    }
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_step_is_above_the_limit_while_a_heap_is_poured),
        cmocka_unit_test(the_share_of_the_limit_is_the_one_asked_for),
        cmocka_unit_test(the_step_falls_at_once_and_rises_again_in_time),
        cmocka_unit_test(a_linear_contact_takes_the_steps_asked_for),
        cmocka_unit_test(a_hertz_contact_takes_at_least_the_steps_asked_for),
        cmocka_unit_test(a_scene_without_a_law_in_sight_lives_with_its_end),
        cmocka_unit_test(a_fall_is_exact_however_often_the_step_changes),
        cmocka_unit_test(a_swing_keeps_the_second_order_across_changes),
        cmocka_unit_test(springs_grow_by_the_step_that_was),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
