// The energy ledger: whatever is lost in contacts and whatever walls and pushes do, the sum stays what it was.
#include "sim/impact.h"
#include "worlds.h"

// ---- impacts of every kind

typedef enum pairing { ON_PLANE, TWO_SPHERES, TWO_CLUMPS, PAIRINGS } pairing;

typedef struct kind {
    pairing bodies;
    dem_normal_law normal;
    dem_damping_law damping;
    dem_tail tail;
    dem_friction_law friction;
    bool rescale, tangential_rate;
} kind;

static double duration_of(const kind *k)
{
    double r = 0.01, mass = 2500 * 4 * DEM_PI / 3 * r * r * r * (k->bodies == ON_PLANE ? 1 : 0.5);
    if (k->normal == DEM_NORMAL_LINEAR)
        return dem_linear_duration(mass, 1e5);
    double radius = k->bodies == ON_PLANE ? r : r / 2, modulus = 1e8 / 2 / (1 - 0.25 * 0.25);
    return dem_hertz_duration(mass, dem_hertz_stiffness(modulus, radius), 2);
}

static dem_pair_law law_of(const kind *k)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.normal = k->normal;
    law.stiffness = k->normal == DEM_NORMAL_LINEAR ? 1e5 : 0;
    law.damping = k->damping;
    law.restitution = 0.6;
    law.damping_rate = 0.6 / duration_of(k);
    law.tail = k->tail;
    law.friction = k->friction;
    law.friction_coefficient = 0.3;
    law.rescale = k->rescale;
    if (k->tangential_rate)
        law.tangential_rate = 0.3 / duration_of(k);
    return law;
}

// an oblique impact with spins and weight; the first touch falls at `phase` of a step
static model *impact_of(const kind *k, double steps, double phase)
{
    model *m = model_new();
    double r = 0.01, h = duration_of(k) / steps, gap = 2 * h * (3 + phase);
    m->materials[0].young = 1e8;
    m->laws[0] = law_of(k);
    m->scene.time.step = h;
    m->scene.gravity = v3(0, 0, -9.81);
    uint32_t shape = k->bodies == TWO_CLUMPS ? model_dumbbell(m, r, 0.016) : model_sphere(m, r);
    dem_body_def *b = model_body(m, shape, v3(0, 0, r + gap));
    b->velocity = v3(1.5, 0.3, -2);
    b->spin = v3(20, -30, 50);
    if (k->bodies == ON_PLANE) {
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        return m;
    }
    b->velocity.z = -1;
    model_body(m, shape, v3(k->bodies == TWO_CLUMPS ? 0.012 : 0, 0, -r))->velocity = v3(0, 0, 1);
    return m;
}

// the largest imbalance of the whole contact, over starts at any part of a step
static double worst_error(const kind *k, double steps)
{
    double worst = 0;
    for (double phase = 0; phase < 1; phase += 0.25) {
        model *m = impact_of(k, steps, phase);
        dem_world *w = model_world(m, 1);
        bool touched = false;
        for (int i = 0; i < 1000; i++) {
            run_steps(w, 1 + (uint64_t)steps / 50);
            const dem_figures *f = measured(w);
            worst = largest(worst, f->energy.error);
            if (f->contacts + f->wall_contacts > 0)
                touched = true;
            else if (touched)
                break;
        }
        check(touched);
        dem_world_destroy(w);
        model_free(m);
    }
    return worst;
}

static void check_kind(const kind *k)
{
    // The force sets in and ends within a step, which costs up to (pi / 2N)^2 of the energy of the normal motion: 1e-3
    // at 50 steps. Eight times the steps: an eighth at most, but for the luck of the phases.
    double coarse = worst_error(k, 50), fine = worst_error(k, 400);
    if (!(coarse <= 1e-3) || !(fine <= 1.5 * fmax(coarse, 1e-3) / 8)) {
        print_error("bodies %d, normal %d, damping %d, tail %d, friction %d, rescale %d, tangential rate %d: %g, %g\n",
                    k->bodies, k->normal, k->damping, k->tail, k->friction, k->rescale, k->tangential_rate, coarse,
                    fine);
        fail();
    }
}

static void the_ledger_of_every_kind_of_impact_closes(void **state)
{
    (void)state;
    for (int i = 0; i < PAIRINGS * 2 * 3 * 2 * 3 * 2 * 2; i++) {
        kind k = {.bodies = (pairing)(i % PAIRINGS),
                  .normal = (dem_normal_law)(i / PAIRINGS % 2),
                  .damping = (dem_damping_law)(i / PAIRINGS / 2 % 3),
                  .tail = (dem_tail)(i / PAIRINGS / 6 % 2),
                  .friction = (dem_friction_law)(i / PAIRINGS / 12 % 3),
                  .rescale = i / PAIRINGS / 36 % 2,
                  .tangential_rate = i / PAIRINGS / 72 % 2};
        bool pointless = (k.friction == DEM_FRICTION_MINDLIN && k.normal != DEM_NORMAL_HERTZ) ||
                         (k.tail == DEM_TAIL_TENSION && k.damping == DEM_DAMPING_NONE) ||
                         (!k.rescale && k.friction != DEM_FRICTION_MINDLIN) ||
                         (k.tangential_rate && (k.damping != DEM_DAMPING_RATE || !k.friction));
        if (!pointless)
            check_kind(&k);
    }
}

static double sum_of(const dem_energy *e)
{
    return e->kinetic + e->rotational + e->potential + e->elastic + e->friction + e->viscous + e->local + e->drag -
           e->work;
}

static void the_parts_add_up_to_the_start_and_the_error(void **state)
{
    (void)state;
    kind k = {TWO_CLUMPS, DEM_NORMAL_LINEAR, DEM_DAMPING_RESTITUTION, DEM_TAIL_CUT, DEM_FRICTION_LINEAR, true, false};
    model *m = impact_of(&k, 50, 0.3);
    dem_world *w = model_world(m, 1);
    const dem_energy *e = &measured(w)->energy;
    double start = e->start, most = start - e->potential;
    check(e->error == 0 && e->start == sum_of(e));
    for (int i = 0; i < 200; i++) {
        run_steps(w, 1);
        e = &measured(w)->energy;
        check(e->start == start && e->elastic >= 0 && e->kinetic > 0 && e->rotational > 0);
        check_near(sum_of(e) - start, e->error * most, 0.02 * fabs(e->error * most) + 1e-15);
    }
    check(e->friction > 0 && e->viscous > 0 && e->local == 0 && e->drag == 0 && e->work == 0);
    dem_world_destroy(w);
    model_free(m);
}

// what is lost goes to the right account: a normal impact loses 1 - e^2, sliding throughout mu J (v + v')/2
static void losses_go_to_their_own_accounts(void **state)
{
    (void)state;
    for (int slides = 0; slides < 2; slides++) {
        model *m = model_new();
        m->laws[0].stiffness = 1e6;
        m->laws[0].damping = slides ? DEM_DAMPING_NONE : DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = 0.6;
        m->laws[0].friction = slides ? DEM_FRICTION_LINEAR : DEM_FRICTION_NONE;
        m->laws[0].friction_coefficient = 0.2;
        double mass = 2500 * 4 * DEM_PI / 3 * 1e-6;
        m->scene.time.step = dem_linear_duration(mass, 1e6) / 2000;
        dem_body_def *b = model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.01));
        b->velocity = v3(slides ? 5 : 0, 0, -1);
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        dem_world *w = model_world(m, 1);
        run_steps(w, 3000);
        const dem_energy *e = &measured(w)->energy;
        // slip 5 falls by 3.5 mu (1 + e) v
        double slip = 5 - 3.5 * 0.2 * 2, friction = 0.2 * 2 * mass * (5 + slip) / 2;
        // to overlap / R and a step of 2000
        check_near(e->viscous, slides ? 0 : mass / 2 * (1 - 0.36), 1e-3 * mass);
        check_near(e->friction, slides ? friction : 0, 5e-3 * friction);
        check_near(e->elastic, 0, 1e-20);
        dem_world_destroy(w);
        model_free(m);
    }
}

static void a_scene_without_a_ledger_says_so(void **state)
{
    (void)state;
    kind k = {TWO_SPHERES, DEM_NORMAL_LINEAR, DEM_DAMPING_NONE, DEM_TAIL_CUT, DEM_FRICTION_LINEAR, true, false};
    model *m = impact_of(&k, 50, 0);
    m->scene.output.energy = false;
    dem_world *w = model_world(m, 1);
    check(isnan(measured(w)->energy.error) && !w->features.ledger);
    dem_world_destroy(w);
    m->laws[0].friction = DEM_FRICTION_NONE;  // nothing can be lost
    w = model_world(m, 1);
    check(measured(w)->energy.error == 0);
    dem_world_destroy(w);
    model_free(m);
}

// ---- walls that do work

static void a_piston_gives_the_sphere_twice_its_speed(void **state)
{
    (void)state;
    model *m = model_new();
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.0101));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1))->velocity = v3(0, 0, 0.5);
    m->scene.time.step = 1e-6;
    dem_world *w = model_world(m, 1);
    double mass = 2500 * 4 * DEM_PI / 3 * 1e-6, contact = dem_linear_duration(mass, 1e4);
    for (double t = 0; t < 2.5e-4 + contact; t += contact / 50) {
        run_steps(w, (uint64_t)(contact / 50 / 1e-6));
        check(fabs(measured(w)->energy.error) < 1e-4);
    }
    const dem_energy *e = &measured(w)->energy;
    check_close(dem_world_bodies(w).velocity[0].z, 1, 1e-4);
    check_close(e->work, mass / 2, 1e-4);
    dem_world_destroy(w);
    model_free(m);
}

// a sphere is set on a belt and is taken along until it rolls: half of the work is lost at most
static void check_belt(dem_damping_law damping)
{
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.3;
    m->laws[0].damping = damping;
    m->laws[0].restitution = 0.3;
    m->laws[0].damping_rate = m->laws[0].tangential_rate = 200;
    if (damping == DEM_DAMPING_RESTITUTION)
        m->laws[0].tangential_rate = NAN;
    double mass = 2500 * 4 * DEM_PI / 3 * 1e-6, sink = mass * 9.81 / 1e4;
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.01 - sink));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1))->velocity = v3(1, 0, 0);
    dem_world *w = model_world(m, 1);
    measured(w);  // looking twice at the start is the same
    check(measured(w)->energy.work == 0 && measured(w)->energy.error == 0);
    // the spring that a dashpot's slip puts in at once has cost nobody anything
    check_close(measured(w)->energy.start, mass * 9.81 * (0.01 - sink) + 1e4 * sink * sink / 2, 1e-12);
    for (int i = 0; i < 40; i++) {
        run_steps(w, i == 0 ? 1 : 500);  // 0.2 s: twice as long as it slides
        const dem_energy *e = &measured(w)->energy;
        // what the dashpot did in the first step, when the slip was there at once: less than half of the force's work
        double off = e->kinetic + e->rotational + e->potential + e->elastic + e->friction + e->viscous - e->work;
        check_near(off, e->start, 0.3 * mass * 9.81 * 1e-5 / 2);
        check(e->work > 0);
    }
    const dem_energy *e = &measured(w)->energy;
    // rolls with v = 2/7 of the belt, R w = -5/7: the force mu m g acted for v / (mu g), the belt passed by
    double v = 2.0 / 7, turning = 0.2 * mass * (5.0 / 7) * (5.0 / 7);
    check_near(e->work, mass * v, 2e-3 * mass);
    check_near(e->kinetic + e->rotational, mass / 2 * v * v + turning, 2e-3 * mass);
    check_near(e->friction + e->viscous, mass / 2 * v, 2e-3 * mass);
    dem_world_destroy(w);
    model_free(m);
}

static void a_belt_does_work_on_what_it_takes_along(void **state)
{
    (void)state;
    check_belt(DEM_DAMPING_RESTITUTION);
    check_belt(DEM_DAMPING_RATE);
}

// a box of bouncing clumps whose lid comes down while a drum of them turns
static void moving_walls_about_many_clumps_keep_the_balance(void **state)
{
    (void)state;
    for (int drum = 0; drum < 2; drum++) {
        model *m = model_new();
        m->scene.gravity = v3(0, 0, -9.81);
        m->laws[0].stiffness = 2e4;
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.4;
        m->laws[0].damping = DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = 0.8;
        model_cloud(m, 6, 0.02, 1);
        model_dumbbell(m, 0.006, 0.008);
        model_lattice(m, 27, 0.025, 1, 1);
        model_box(m, v3(-0.01, -0.01, -0.01), v3(0.085, 0.085, 0.085));
        if (drum) {
            m->walls[1].kind = DEM_WALL_CYLINDER;  // about x, instead of the far side in x
            m->walls[1].point = m->walls[1].through = v3(0, 0.0375, 0.0375);
            m->walls[1].normal = v3(1, 0, 0);
            m->walls[1].radius = 0.06;
            m->walls[1].spin = v3(8, 0, 0);
            m->walls[0].velocity = v3(0.05, 0, 0);
        } else
            m->walls[5].velocity = v3(0, 0, -0.2);
        double error[2];
        for (int fine = 0; fine < 2; fine++) {
            m->scene.time.step = fine ? 2.5e-6 : 1e-5;
            dem_world *w = model_world(m, 1);
            error[fine] = 0;
            for (int i = 0; i < 20; i++) {
                run_steps(w, fine ? 800 : 200);
                error[fine] = fmax(error[fine], fabs(measured(w)->energy.error));
            }
            const dem_energy *e = &measured(w)->energy;
            check(fabs(e->work) > 0.01 * e->kinetic && e->friction > 0 && e->viscous > 0);
            dem_world_destroy(w);
        }
        // some 50 steps a contact, a hundred contacts whose errors have either sign
        check(error[0] < 1e-3 && error[1] < 0.4e-3);
        model_free(m);
    }
}

// ---- pushes

static void a_push_does_force_times_way(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    model_cloud(m, 6, 0.02, 1);
    model_body(m, 0, v3(0, 0, 0))->velocity = v3(1, 0, 0);
    dem_world *w = model_world(m, 1);
    dem_vec3 force = v3(0.1, -0.2, 0.3);
    double mass = w->templates.items[0].mass;
    for (int i = 0; i < 2000; i++) {
        dem_world_push(w, 0, force, v3(0, 0, 0));
        run_steps(w, 1);
        if (i % 100 == 0)  // the half kick and the weight of the first step meet: h^2 f.g / 4
            check(fabs(measured(w)->energy.error) < 2e-8);
    }
    const dem_figures *f = measured(w);
    dem_vec3 x = dem_world_bodies(w).position[0];
    // a push is a kick at the beginning of its step, the first of half a step: the last is early by half of its way
    check_close(f->energy.work, v3_dot(force, v3_along(x, -0.5e-5, dem_world_bodies(w).velocity[0])), 1e-7);
    check_close(f->energy.kinetic, 0.5 * mass + f->energy.work - 9.81 * mass * x.z, 2e-8);
    dem_world_destroy(w);
    model_free(m);
}

// about a principal axis: M times the angle
static void a_moment_does_work_on_the_turn(void **state)
{
    (void)state;
    model *m = model_new();
    model_dumbbell(m, 0.01, 0.03);
    model_body(m, 0, v3(0, 0, 0));
    dem_world *w = model_world(m, 1);
    for (int i = 0; i < 4000; i++) {
        dem_world_push(w, 0, v3(0, 0, 0), v3(0, 0, 1e-4));
        run_steps(w, 1);
    }
    const dem_figures *f = measured(w);
    double rate = 1e-4 / w->templates.items[0].inertia[0], t = dem_world_time(w);
    check_close(dem_world_bodies(w).spin[0].z, rate * t, 1e-3);  // kicks
    check_close(f->energy.work, 1e-4 * rate * t * t / 2, 1e-3);
    check(fabs(f->energy.error) < 1e-12);
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_ledger_of_every_kind_of_impact_closes),
        cmocka_unit_test(the_parts_add_up_to_the_start_and_the_error),
        cmocka_unit_test(losses_go_to_their_own_accounts),
        cmocka_unit_test(a_scene_without_a_ledger_says_so),
        cmocka_unit_test(a_piston_gives_the_sphere_twice_its_speed),
        cmocka_unit_test(a_belt_does_work_on_what_it_takes_along),
        cmocka_unit_test(moving_walls_about_many_clumps_keep_the_balance),
        cmocka_unit_test(a_push_does_force_times_way),
        cmocka_unit_test(a_moment_does_work_on_the_turn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
