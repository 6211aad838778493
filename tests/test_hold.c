// Bodies that are held: fixed ones are walls to the others, given motions do work, locked axes are constraints, and two
// dimensions are three of which one is locked.
#include "same_bits.h"

#include "sim/impact.h"
#include "sim/timestep.h"
#include "sim/validate.h"

static const uint32_t FIXED = DEM_HOLD_VELOCITY | DEM_HOLD_SPIN;

static double sphere_mass(double radius)
{
    return 2500 * 4 * DEM_PI / 3 * radius * radius * radius;
}

// ---- fixed bodies

// the speed at which a ball leaves another over that at which it came, and what the ledger says then
static double rebound(uint32_t hold, dem_effective_mass mass, double *imbalance)
{
    model *m = model_new();
    double r = 0.01;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.6;
    m->laws[0].effective_mass = mass;
    m->scene.time.step = dem_linear_duration(sphere_mass(r), 1e4) / 400;
    model_body(m, model_sphere(m, r), v3(0, 0, 2.02 * r))->velocity = v3(0, 0, -0.1);
    model_body(m, 0, v3(0, 0, 0))->hold = hold;
    dem_world *w = model_world(m, 1);
    *imbalance = 0;
    for (int i = 0; i < 100; i++) {
        run_steps(w, 50);
        *imbalance = largest(*imbalance, measured(w)->energy.error);
    }
    dem_body_view v = dem_world_bodies(w);
    double e = (v.velocity[0].z - v.velocity[1].z) / 0.1;
    if (hold) {
        check(v.position[1].z == 0 && v.velocity[1].z == 0 && v.mass[1] == v.mass[0]);
        check_close(measured(w)->energy.viscous, sphere_mass(r) / 2 * 0.01 * (1 - e * e), 1e-3);
        check(measured(w)->energy.work == 0);
    }
    dem_world_destroy(w);
    model_free(m);
    return e;
}

static void a_fixed_body_is_a_wall_to_the_others(void **state)
{
    (void)state;
    for (int mass = 0; mass < 2; mass++) {
        static const uint32_t holds[] = {0, FIXED, FIXED | DEM_LOCK_X,
                                         DEM_LOCK_X | DEM_LOCK_Y | DEM_LOCK_Z | DEM_HOLD_SPIN, DEM_HOLD_VELOCITY};
        for (int i = 0; i < 5; i++) {
            double off;
            // as of a free pair in test_impacts, 400 steps a contact
            check_near(rebound(holds[i], (dem_effective_mass)mass, &off), 0.6, 2e-3);
            check(off < 2e-4);
        }
    }
}

// a pair counts each contact twice, a wall once
static void the_step_knows_what_is_fixed(void **state)
{
    (void)state;
    for (int fixed = 0; fixed < 2; fixed++) {
        model *m = model_new();
        model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.0199));
        model_body(m, 0, v3(0, 0, 0))->hold = fixed ? FIXED : 0;
        dem_world *w = model_world(m, 1);
        check_close(dem_world_critical_step(w), 2 * sqrt(sphere_mass(0.01) / (fixed ? 1 : 2) / 1e4), 1e-12);
        dem_world_destroy(w);
        model_free(m);
    }
}

// bodies that nothing can move need no contact, with each other or with walls; rollers that may turn do
static void held_bodies_that_overlap_are_no_trouble(void **state)
{
    (void)state;
    for (int rollers = 0; rollers < 2; rollers++) {
        model *m = model_new();
        m->scene.gravity = v3(0, 0, -9.81);
        m->laws[0].damping = DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = 0.5;
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.5;
        model_sphere(m, 0.01);
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        for (int i = 0; i < 2; i++) {
            dem_body_def *b = model_body(m, 0, v3(0.019 * i, 0, 0.009 + 0.01 * rollers));
            b->hold = rollers ? DEM_HOLD_VELOCITY : FIXED;
            b->spin = v3(0, rollers && i ? 20 : 0, 0);
        }
        dem_world *w = model_world(m, 1);
        run_steps(w, 20000);
        const dem_figures *f = measured(w);
        check(f->contacts + f->wall_contacts == (size_t)rollers);
        dem_body_view v = dem_world_bodies(w);
        // two equal wheels share the spin of one: 20 = 10 + 10, against each other. Their dashpots see no end of mass,
        // so that the friction between them trembles at its cap
        check_near(v.spin[0].y, rollers ? -10 : 0, 0.5 * rollers);
        check_near(v.spin[1].y, rollers ? 10 : 0, 0.5 * rollers);
        check(v.position[1].x == 0.019 && fabs(f->energy.error) < 1e-3);
        dem_truth truth;
        dem_error error;
        check_ok(dem_world_validate(w, &truth, &error), error);
        check(truth.missed == 0 && truth.unsound == 0 && truth.doubled == 0);
        dem_world_destroy(w);
        model_free(m);
    }
}

// ---- given motions

static void a_body_at_a_given_velocity_is_a_piston(void **state)
{
    (void)state;
    model *m = model_new();
    double mass = sphere_mass(0.01), contact = dem_linear_duration(mass, 1e4);
    m->scene.gravity = v3(3, 0, 0);
    m->scene.time.step = 1e-6;
    dem_body_def *free = model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.0201));
    free->hold = DEM_LOCK_X;
    dem_body_def *piston = model_body(m, 0, v3(0, 0, 0));
    piston->velocity = v3(0, 0, 0.5);
    piston->hold = DEM_HOLD_VELOCITY;
    dem_world *w = model_world(m, 1);
    for (double t = 0; t < 2.5e-4 + contact; t += contact / 50) {
        run_steps(w, (uint64_t)(contact / 50 / 1e-6));
        check(fabs(measured(w)->energy.error) < 1e-4);
    }
    dem_body_view v = dem_world_bodies(w);
    check_near(v.position[1].z, 0.5 * dem_world_time(w), 1e-15);
    check_close(v.velocity[0].z, 1, 1e-4);
    check(v.position[0].x == 0 && v.velocity[0].x == 0);
    check_close(measured(w)->energy.work, mass / 2, 1e-4);
    dem_world_destroy(w);
    model_free(m);
}

// a given spin turns any body about that axis of space, whatever its moments and the contacts
static void a_given_spin_turns_exactly(void **state)
{
    (void)state;
    model *m = model_new();
    dem_vec3 spin = v3(3, -5, 7);
    dem_quat q = quat_unit((dem_quat){1, 2, -1, 0.5});
    dem_body_def *b = model_body(m, model_cloud(m, 6, 0.02, 1), v3(0, 0, 0));
    b->spin = spin;
    b->orientation = q;
    b->hold = DEM_HOLD_SPIN;
    m->scene.gravity = v3(0, 0, -9.81);
    dem_world *w = model_world(m, 1);
    run_steps(w, 10000);
    measured(w);
    dem_body_view v = dem_world_bodies(w);
    check_near(angle_between(v.orientation[0], quat_multiply(quat_about(v3_scale(spin, 0.1)), q)), 0, 1e-12);
    check_vec(v.spin[0], spin, 0);
    check_close(v.position[0].z, -9.81 * 0.01 / 2, 1e-10);
    dem_world_destroy(w);
    model_free(m);
}

// ---- locked axes

static dem_world *locked_body(uint32_t hold, double step, dem_vec3 spin)
{
    model *m = model_new();
    m->scene.time.step = step;
    model_clump(m, (dem_ball[]){{{0, 0, 0}, 1}}, 1, 1, (double[]){1, 2, 2.5});
    dem_body_def *b = model_body(m, 0, v3(0, 0, 0));
    b->orientation = quat_unit((dem_quat){1, 0.4, -0.7, 0.2});
    b->spin = spin;
    b->hold = hold;
    dem_world *w = model_world(m, 1);
    model_free(m);
    return w;
}

// about one axis: the moment of inertia about it is what counts, and the body turns evenly
static void a_body_locked_to_one_axis_is_a_wheel(void **state)
{
    (void)state;
    dem_world *w = locked_body(DEM_LOCK_RX | DEM_LOCK_RY, 1e-3, v3(0, 0, 5));
    dem_quat q0 = orientation_now(w, 0);
    dem_vec3 axis = quat_unrotate(q0, v3(0, 0, 1));
    double inertia = axis.x * axis.x + 2 * axis.y * axis.y + 2.5 * axis.z * axis.z;
    run_steps(w, 1000);
    check_near(angle_between(orientation_now(w, 0), quat_multiply(quat_about(v3(0, 0, 5)), q0)), 0, 1e-12);
    for (int i = 0; i < 1000; i++) {
        dem_world_push(w, 0, v3(0, 0, 0), v3(3, -4, 2));  // only the part about z turns it
        run_steps(w, 1);
    }
    measured(w);
    dem_vec3 spin = dem_world_bodies(w).spin[0];
    check_near(spin.z, 5 + 2 * 1.0 / inertia, 1e-11);
    check(spin.x == 0 && spin.y == 0);
    check(fabs(measured(w)->energy.error) < 1e-12);
    dem_world_destroy(w);
}

// about two axes: what holds the third does no work, so the energy is kept, to the second order of the step; "not a
// torque of zero": the spin about the others goes on changing
static void a_lock_of_one_axis_does_no_work(void **state)
{
    (void)state;
    double off[2];
    for (int i = 0; i < 2; i++) {
        dem_world *w = locked_body(DEM_LOCK_RY, 0.02 / (1 << i), v3(2, 0, 3));
        double start = measured(w)->energy.rotational, least = 2, most = 2;
        off[i] = 0;
        for (int k = 0; k < 2000 << i; k++) {
            run_steps(w, 1);
            const dem_energy *e = &measured(w)->energy;
            dem_vec3 spin = dem_world_bodies(w).spin[0];
            check(spin.y == 0);
            least = fmin(least, spin.x);
            most = fmax(most, spin.x);
            off[i] = largest(off[i], e->rotational / start - 1);
        }
        check(most - least > 0.5);
        dem_world_destroy(w);
    }
    check(off[0] < 2e-3 && off[0] > 3 * off[1]);
}

static void a_body_falls_along_what_is_free(void **state)
{
    (void)state;
    for (uint32_t lock = 0; lock < 8; lock++) {
        model *m = model_new();
        m->scene.gravity = v3(1, 2, 3);
        m->scene.damping.local = 0.5;
        model_body(m, model_sphere(m, 0.01), v3(0, 0, 0))->hold = lock;
        dem_world *w = model_world(m, 1);
        run_steps(w, 1000);
        measured(w);
        dem_vec3 x = dem_world_bodies(w).position[0], v = dem_world_bodies(w).velocity[0];
        for (int k = 0; k < 3; k++) {
            bool free = !(lock >> k & 1);
            // at rest nothing is damped: the first half kick is a whole one
            check_near(v3_get(x, k), free ? (k + 1) * 0.25e-4 : 0, free ? 2e-3 * (k + 1) * 0.25e-4 : 0);
            check_near(v3_get(v, k), free ? (k + 1) * 0.5e-2 : 0, free ? 1e-3 * (k + 1) * 0.5e-2 : 0);
        }
        check(fabs(measured(w)->energy.error) < 1e-3);
        dem_world_destroy(w);
        model_free(m);
    }
}

// ---- two dimensions

// balls and dumbbells whose centres lie in a plane stay there by symmetry; the locks must not be felt
static model *flat_model(unsigned dimension)
{
    model *m = model_new();
    m->scene.dimension = dimension;
    m->scene.gravity = v3(0, -9.81, 0);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.7;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    model_sphere(m, 0.01);
    model_dumbbell(m, 0.008, 0.012);
    dem_random r = random_stream(3, 1);
    for (int i = 0; i < 36; i++) {
        dem_body_def *b = model_body(m, (uint32_t)(i % 2), v3(0.03 * (i % 6) + 0.02, 0.03 * (i / 6) + 0.02, 0.005));
        b->velocity = v3(random_uniform(&r) - 0.5, random_uniform(&r) - 0.5, 0);
        b->spin = v3(0, 0, 40 * random_uniform(&r) - 20);
        b->orientation = quat_about(v3(0, 0, 6 * random_uniform(&r)));
    }
    model_plane(m, v3(0, 0, 0), v3(1, 0, 0));
    model_plane(m, v3(0, 0, 0), v3(0, 1, 0));
    model_plane(m, v3(0.19, 0, 0), v3(-1, 0, 0));
    return m;
}

static void two_dimensions_are_three_with_a_plane_of_symmetry(void **state)
{
    (void)state;
    dem_world *w[2];
    for (int k = 0; k < 2; k++) {
        model *m = flat_model(2 + (unsigned)k);
        w[k] = model_world(m, 1);
        run_steps(w[k], 6000);
        measured(w[k]);
        model_free(m);
    }
    check(dem_world_figures(w[0])->contacts > 0 && dem_world_figures(w[0])->energy.friction > 1e-3);
    dem_body_view a = dem_world_bodies(w[0]), b = dem_world_bodies(w[1]);
    for (size_t i = 0; i < a.count; i++) {
        check(a.position[i].z == 0.005 && a.velocity[i].z == 0 && a.spin[i].x == 0 && a.spin[i].y == 0);
        // impacts make some hundred times more of the last bits
        check_vec(a.position[i], b.position[i], 1e-11);
        check_vec(a.velocity[i], b.velocity[i], 1e-8);
        check_vec(a.spin[i], b.spin[i], 1e-6);
    }
    check(fabs(dem_world_figures(w[0])->energy.error) < 1e-3);
    dem_world_destroy(w[0]);
    dem_world_destroy(w[1]);
}

static void what_leaves_the_plane_is_refused(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        model *m = flat_model(2);
        if (i == 2)
            m->bodies[4].velocity.z = 1e-3;
        else
            *(i ? &m->bodies[4].spin.x : &m->bodies[4].spin.y) = 1;
        dem_world *w;
        dem_error error;
        check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_BAD_INPUT);
        check(strstr(error.text, "body 4 leaves the plane"));
        model_free(m);
    }
    model *m = flat_model(3);
    m->bodies[7].hold = 256;
    dem_world *w;
    dem_error error;
    check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_BAD_INPUT && strstr(error.text, "dem_hold"));
    model_free(m);
}

// ---- discs

static model *discs(size_t count, double low, double high, double thickness)
{
    model *m = model_new();
    m->scene.dimension = 2;
    m->scene.gravity = v3(0, -9.81, 0);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.7;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    m->shapes[model_sphere(m, 0.01)].disc_thickness = thickness;
    dem_random r = random_stream(5, 1);
    for (size_t i = 0; i < count; i++) {
        dem_body_def *b = model_body(m, 0, v3(0.05 * (double)i, 0, 0.3));
        b->scale = low + (high - low) * random_uniform(&r);
    }
    return m;
}

// of any size a disc is as thick as its shape
static void discs_have_the_mass_of_their_area(void **state)
{
    (void)state;
    model *m = discs(20, 0.5, 2, 0.3);
    dem_world *w = model_world(m, 1);
    dem_body_view v = dem_world_bodies(w);
    for (size_t i = 0; i < v.count; i++) {
        double r = 0.01 * v.scale[i], mass = 2500 * DEM_PI * r * r * 0.3;
        check_close(v.mass[i], mass, 1e-14);
        dem_world_push(w, i, v3(1, 2, 0), v3(0, 0, 3));
    }
    run_steps(w, 1);
    for (size_t i = 0; i < v.count; i++) {
        double r = 0.01 * v.scale[i], mass = 2500 * DEM_PI * r * r * 0.3, kick = 0.5e-5;
        check_close(velocity_before(w, i).x, kick / mass, 1e-12);
        check_close(velocity_before(w, i).y, kick * (2 / mass - 9.81), 1e-12);
        check_close(spin_before(w, i).z, kick * 3 / (mass * r * r / 2), 1e-12);
    }
    dem_world_destroy(w);
    model_free(m);
}

// down a slope a disc rolls by 2/3 of what it would slide, a ball by 5/7
static void a_disc_rolls_as_a_disc(void **state)
{
    (void)state;
    for (int disc = 0; disc < 2; disc++) {
        model *m = discs(1, 1, 1, disc ? 1e-3 : 0);
        double g = 9.81 * sin(0.3), mass = 2500 * (disc ? DEM_PI * 1e-4 * 1e-3 : 4 * DEM_PI / 3 * 1e-6);
        m->scene.gravity = v3(g, -9.81 * cos(0.3), 0);
        m->bodies[0].position = v3(0, 0.01 - mass * 9.81 * cos(0.3) / 1e4, 0);
        model_plane(m, v3(0, 0, 0), v3(0, 1, 0));
        dem_world *w = model_world(m, 1);
        run_steps(w, 20000);
        measured(w);
        check_close(dem_world_bodies(w).velocity[0].x, g * 0.2 * (disc ? 2.0 / 3 : 5.0 / 7), 1e-3);
        dem_world_destroy(w);
        model_free(m);
    }
}

static void discs_need_two_dimensions(void **state)
{
    (void)state;
    model *m = discs(1, 1, 1, 1);
    m->scene.dimension = 3;
    dem_world *w;
    dem_error error;
    check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_USAGE &&
          strstr(error.text, "set the scene's dimension"));
    model_free(m);
}

// fills of two dimensions lie in a plane, and as dense as discs can be thrown and shaken
static void fills_lie_in_the_plane(void **state)
{
    (void)state;
    for (int clumps = 0; clumps < 2; clumps++) {
        model *m = discs(0, 1, 1, 1);
        if (clumps)
            model_dumbbell(m, 0.008, 0.01);
        dem_mix_def mix[2] = {{.shape = (uint32_t)clumps,
                               .share = 1,
                               .size = {.law = DEM_SIZE_UNIFORM, .a = 0.01, .b = 0.02, .largest = INFINITY}}};
        dem_fill_def fill = {.mix = mix,
                             .mix_count = 1,
                             .low = {0, 0, 0},
                             .high = {0.3, 0.3, 0.01},
                             .void_ratio = clumps ? 0.9 : 0.35,
                             .seed = 3};
        m->scene.bodies.fills = &fill;
        m->scene.bodies.fill_count = 1;
        model_plane(m, v3(0, 0, 0), v3(1, 0, 0));
        dem_world *w = model_world(m, 1);
        dem_body_view v = dem_world_bodies(w);
        double area = 0;
        for (size_t i = 0; i < v.count; i++) {
            double r = w->templates.items[clumps].equivalent_diameter / 2 * v.scale[i];
            area += DEM_PI * r * r;
            check(v.position[i].z == 0.005 && v.position[i].x > 0 && v.position[i].y < 0.3);
            dem_vec3 axis = quat_rotate(v.orientation[i], v3(0, 0, 1));
            check(clumps || axis.z == 1);
            check_near(axis.z, 1, 1e-15);
        }
        check_near(0.09 / area - 1, fill.void_ratio, 0.02);
        check(measured(w)->contacts == 0 && dem_world_figures(w)->wall_contacts == 0);
        dem_world_destroy(w);
        model_free(m);
    }
}

// ---- everything at once

// free clumps that fall about fixed, moved, spun and locked ones
static model *crowd(size_t bodies, bool local)
{
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    m->laws[0].stiffness = 3e4;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.7;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    m->laws[0].rolling = DEM_ROLLING_BOUNDED;
    m->laws[0].rolling_coefficient = 0.02;
    m->scene.damping.local = local ? 0.2 : 0;
    m->scene.damping.viscous = local ? 2 : 0;
    model_cloud(m, 6, 0.02, 1);
    model_dumbbell(m, 0.006, 0.008);
    model_lattice(m, bodies, 0.024, 1, 4);
    static const uint32_t holds[] = {DEM_HOLD_VELOCITY | DEM_HOLD_SPIN, DEM_HOLD_SPIN,
                                     DEM_LOCK_X | DEM_LOCK_RZ,          DEM_HOLD_VELOCITY,
                                     DEM_LOCK_RX | DEM_LOCK_RY,         DEM_LOCK_RX | DEM_LOCK_RY | DEM_LOCK_RZ};
    for (size_t i = 0; i < bodies; i++)
        if (i % 4 == 1) {
            dem_body_def *b = &m->bodies[i];
            b->hold = holds[i / 4 % 6];
            b->velocity = v3_scale(b->velocity, b->hold & DEM_HOLD_VELOCITY ? 0.05 : 1);
            if (i / 4 % 12 == 0)
                b->velocity = b->spin = v3(0, 0, 0);
        }
    double side = 0.024 * ceil(cbrt((double)bodies) - 1e-9);
    model_box(m, v3(0, 0, 0), v3(side, side, side));
    return m;
}

static void the_ledger_closes_about_held_bodies(void **state)
{
    (void)state;
    for (int local = 0; local < 2; local++) {
        model *m = crowd(64, local);
        dem_world *w = model_world(m, 1);
        double worst = 0;
        for (int i = 0; i < 50; i++) {
            run_steps(w, 200);
            worst = largest(worst, measured(w)->energy.error);
        }
        const dem_energy *e = &measured(w)->energy;
        check(fabs(e->work) > 0.02 * (e->kinetic + e->rotational) && e->friction > 0 && e->viscous > 0);
        check(worst < 1e-3);
        dem_world_destroy(w);
        model_free(m);
    }
}

static void held_bodies_go_on_from_a_saved_state_and_with_any_threads(void **state)
{
    (void)state;
    model *m = crowd(600, true);
    check_same_threads(m, 300);
    model_free(m);
}

static void an_automatic_step_runs_with_held_bodies(void **state)
{
    (void)state;
    model *m = crowd(64, false);
    m->scene.time.step = 0;
    dem_world *w = model_world(m, 1);
    run_steps(w, 3000);
    check(fabs(measured(w)->energy.error) < 1e-2 && dem_world_step_size(w) > 0 && isfinite(dem_world_critical_step(w)));
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fixed_body_is_a_wall_to_the_others),
        cmocka_unit_test(the_step_knows_what_is_fixed),
        cmocka_unit_test(held_bodies_that_overlap_are_no_trouble),
        cmocka_unit_test(a_body_at_a_given_velocity_is_a_piston),
        cmocka_unit_test(a_given_spin_turns_exactly),
        cmocka_unit_test(a_body_locked_to_one_axis_is_a_wheel),
        cmocka_unit_test(a_lock_of_one_axis_does_no_work),
        cmocka_unit_test(a_body_falls_along_what_is_free),
        cmocka_unit_test(two_dimensions_are_three_with_a_plane_of_symmetry),
        cmocka_unit_test(what_leaves_the_plane_is_refused),
        cmocka_unit_test(discs_have_the_mass_of_their_area),
        cmocka_unit_test(a_disc_rolls_as_a_disc),
        cmocka_unit_test(discs_need_two_dimensions),
        cmocka_unit_test(fills_lie_in_the_plane),
        cmocka_unit_test(the_ledger_closes_about_held_bodies),
        cmocka_unit_test(held_bodies_go_on_from_a_saved_state_and_with_any_threads),
        cmocka_unit_test(an_automatic_step_runs_with_held_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
