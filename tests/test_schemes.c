// The schemes of integration beside the default: how they grow, what they keep, their errors and orders (PHYSICS 2.1 to
// 2.3).
#include "rotor.h"

#include "sim/schemes.h"

static const dem_quat NOT_TURNED = {1, 0, 0, 0};

// ---- rotation

static dem_world *lone_body(dem_rotation scheme, const double inertia[3], dem_quat q, dem_vec3 spin, double step)
{
    model *m = model_new();
    m->scene.time.step = step;
    m->scene.integrator.rotation = scheme;
    model_clump(m, (dem_ball[]){{{0, 0, 0}, 1}}, 1, 1, inertia);
    dem_body_def *b = model_body(m, 0, v3(0, 0, 0));
    b->orientation = q;
    b->spin = quat_rotate(q, spin);
    dem_world *w = model_world(m, 1);
    model_free(m);
    return w;
}

// the largest angle between a free body and the solution of rotor.h
static double free_error(dem_rotation scheme, const double inertia[3], dem_vec3 spin, double time, int steps)
{
    double h = time / steps;
    dem_world *w = lone_body(scheme, inertia, NOT_TURNED, spin, h);
    double most = rotor_error(w, inertia, spin, h, (uint64_t)steps);
    dem_world_destroy(w);
    return most;
}

// the same for a heavy top in steady slow precession: azimuth and spin run on, the tilt stays
static double top_error(dem_rotation scheme, int steps)
{
    const double i[3] = {0.2, 0.2, 0.3}, weight = 2, theta = DEM_PI / 6, time = 20;
    double a = i[0] * cos(theta), b = i[2] * 20, rate = (b - sqrt(b * b - 4 * a * weight)) / (2 * a), most = 0;
    dem_vec3 axis = v3(0, -sin(theta), cos(theta)), up = v3(0, 0, 1);
    dem_quat q = quat_about(v3(theta, 0, 0));
    dem_vec3 turning = v3_along(v3_scale(axis, 20), rate, v3_along(up, -cos(theta), axis));
    dem_world *w = lone_body(scheme, i, q, quat_unrotate(q, turning), time / steps);
    for (int k = 0; k < steps; k++) {
        dem_vec3 now = quat_rotate(orientation_now(w, 0), up);
        dem_world_push(w, 0, v3(0, 0, 0), v3_scale(v3_cross(now, v3(0, 0, -1)), weight));
        run_steps(w, 1);
        double t = dem_world_time(w);
        dem_quat own = quat_about(v3_scale(up, (20 - rate * cos(theta)) * t));
        dem_quat exact = quat_multiply(quat_multiply(quat_about(v3_scale(up, rate * t)), q), own);
        most = largest(most, angle_between(orientation_now(w, 0), exact));
    }
    dem_world_destroy(w);
    return most;
}

typedef struct rotation_case {
    const char *table;  // name in refdata/integrator_comparison.csv
    double free[2], flips[2], plate[2], top[2];
} rotation_case;

// the largest error of that table [rad] at two steps each; pi where the body flips to the wrong side
static const rotation_case ROTATIONS[DEM_ROTATION_SCHEMES] = {
    [DEM_ROTATION_LSYM] =
        {"LF-SYM", {7.535e-3, 1.883e-3}, {5.580e-3, 1.661e-3}, {1.798e-4, 4.716e-5}, {7.283e-5, 1.911e-5}},
    [DEM_ROTATION_LSYM4] =
        {"LF-SYM4(Suzuki)", {3.303e-7, 2.070e-8}, {2.6e-7, 4e-8}, {3.120e-8, 2.175e-9}, {7.283e-5, 1.911e-5}},
    [DEM_ROTATION_SPIRAL] =
        {"SPIRAL-LF", {2.585e-2, 4.204e-3}, {3.091e-3, 6.444e-4}, {2.447e-2, 3.503e-3}, {1.234e-3, 3.235e-4}},
    [DEM_ROTATION_NO_SQUISH] =
        {"NO_SQUISH", {5.073e-2, 1.266e-2}, {2.620e-2, 7.812e-3}, {7.699e-2, 2.085e-2}, {1.917e-4, 5.091e-5}},
    [DEM_ROTATION_OMELYAN] =
        {"Omelyan98(LF)", {1.903e-2, 4.849e-3}, {2.017e-2, 6.001e-3}, {8.150e-2, 2.136e-2}, {7.553e-2, 1.982e-2}},
    [DEM_ROTATION_FINCHAM] =
        {"Fincham92(LF)", {2.525e-1, 3.044e-2}, {3.138, 3.141}, {2.673e-1, 4.745e-2}, {3.785e-2, 9.930e-3}},
    [DEM_ROTATION_WALTON_BRAUN] =
        {"Walton-Braun93", {8.752e-2, 1.490e-2}, {2.314e-2, 8.162e-3}, {1.110e-1, 2.397e-2}, {7.529e-2, 1.981e-2}},
    [DEM_ROTATION_PCDM] =
        {"ZhaoVW13-PCDM", {8.571e-2, 1.472e-2}, {1.592e-2, 4.562e-3}, {8.650e-2, 1.479e-2}, {2.710e-1, 1.389e-1}},
};

// the errors are those of the table (some start a little otherwise), and so are the orders between the two steps
static void rotations_err_as_in_the_comparison(void **state)
{
    (void)state;
    const double one[3] = {1, 2, 3}, plate[3] = {1, 1.05, 1.95};
    for (int s = 0; s < DEM_ROTATION_SCHEMES; s++) {
        const rotation_case *c = &ROTATIONS[s];
        double loose = s == DEM_ROTATION_WALTON_BRAUN ? 1.4 : 1.13;
        const double *table[4] = {c->free, c->flips, c->plate, c->top};
        for (int i = 0; i < 2; i++) {
            double got[4] = {free_error((dem_rotation)s, one, v3(1, 0.5, 0.8), 100, 1400 << i),
                             free_error((dem_rotation)s, one, v3(1e-3, 1, 0), 100, i ? 2200 : 1200),
                             free_error((dem_rotation)s, plate, v3(3, 0.5, 20), 20, i ? 8200 : 4200),
                             top_error((dem_rotation)s, i ? 8200 : 4200)};
            for (int k = 0; k < 4; k++)
                if (!(got[k] < loose * table[k][i] && got[k] > table[k][i] / loose)) {
                    print_error("%s, test %d, step %d: %g, not %g\n", dem_rotations[s].name, k, i, got[k], table[k][i]);
                    fail();
                }
        }
    }
}

// whatever the scheme: |q| stays 1; those that turn L itself keep it to the last bits
static void norms_and_momenta_are_kept(void **state)
{
    (void)state;
    const double one[3] = {1, 2, 3};
    for (int s = 0; s < DEM_ROTATION_SCHEMES; s++) {
        dem_world *w = lone_body((dem_rotation)s, one, NOT_TURNED, v3(1, 0.5, 0.8), 1.0 / 14);
        double l0 = v3_norm(v3(1, 1, 2.4)), off = 0, norm = 0;
        for (int k = 0; k < 5000; k++) {
            run_steps(w, 1);
            dem_quat q = orientation_now(w, 0);
            const double *l = w->bodies.momentum + DEM_ROW * row_of(w, 0) + 3;
            norm = largest(norm, sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z) - 1);
            off = largest(off, v3_norm(v3(l[0], l[1], l[2])) / l0 - 1);
        }
        bool keeps = strstr(dem_rotations[s].about, "keeps L") || s == DEM_ROTATION_FINCHAM;
        check(norm < 1e-13 && (keeps ? off < 1e-13 : off > 1e-6 && off < 0.1));
        dem_world_destroy(w);
    }
}

// the views bring spins to the time of the orientations: of second order, where half a step off would be of first
static void spins_are_shown_at_the_time_of_the_orientations(void **state)
{
    (void)state;
    const double one[3] = {1, 2, 3};
    const dem_vec3 exact = {0.439875092142, 1.027866675845, 0.609231783119};  // after 1 s, by Jacobi's functions
    for (int s = 0; s < DEM_ROTATION_SCHEMES; s++) {
        double off[2];
        for (int i = 0; i < 2; i++) {
            dem_world *w = lone_body((dem_rotation)s, one, NOT_TURNED, v3(1, 0.5, 0.8), 0.02 / (1 << i));
            run_steps(w, 50u << i);
            measured(w);
            dem_body_view v = dem_world_bodies(w);
            off[i] = v3_distance(quat_unrotate(v.orientation[0], v.spin[0]), exact);
            dem_world_destroy(w);
        }
        check(off[0] < 4e-4 && off[0] > 3.5 * off[1]);
    }
}

// ---- translation

// a ball on a plane that it never leaves, as an oscillator with (w h) = z, away from rest by x and v / w
static dem_world *oscillator(dem_translation scheme, double z, double x, double v)
{
    model *m = model_new();
    double r = 0.01, mass = 2500 * 4 * DEM_PI / 3 * r * r * r, k = 1e4, w0 = sqrt(k / mass);
    m->scene.gravity = v3(0, 0, -1e-3 * k / mass);  // it lies 1 mm deep
    m->scene.time.step = z / w0;
    m->scene.integrator.translation = scheme;
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    model_body(m, model_sphere(m, r), v3(0, 0, r - 1e-3 + x))->velocity.z = v * w0;
    dem_world *w = model_world(m, 1);
    model_free(m);
    return w;
}

// the area between two motions in the plane of x and v: what each step multiplies it by is the square of the growth
static double growth(dem_translation scheme, double z)
{
    double x = 1e-6, w0 = sqrt(1e4 / (2500 * 4 * DEM_PI / 3 * 1e-6)), area[2];
    dem_world *a = oscillator(scheme, z, x, 0), *b = oscillator(scheme, z, 0, x);
    for (int i = 0; i < 2; i++) {
        run_steps(a, i ? 40 : 1);  // behind the start
        run_steps(b, i ? 40 : 1);
        double xa = position_now(a, 0).z - 9e-3, xb = position_now(b, 0).z - 9e-3;
        area[i] = xa * velocity_before(b, 0).z / w0 - xb * velocity_before(a, 0).z / w0;
    }
    dem_world_destroy(a);
    dem_world_destroy(b);
    return pow(area[1] / area[0], 1.0 / 80);
}

static void translations_grow_as_they_must(void **state)
{
    (void)state;
    for (int s = 0; s < DEM_TRANSLATION_SCHEMES; s++)
        for (double z = 0.1; z < 0.5; z *= 2) {
            double want = s == DEM_TRANSLATION_FORWARD_EULER ? sqrt(1 + z * z)
                          : s == DEM_TRANSLATION_TAYLOR      ? sqrt(1 + z * z / 2)
                                                             : 1;
            // positions of 0.01 m round by 1e-18, and amplitudes are 1e-6 m
            check_near(growth((dem_translation)s, z), want, 1e-11);
        }
    check_near(growth(DEM_TRANSLATION_FORWARD_EULER, 0.1), 1.004988, 1e-6);
    check_near(growth(DEM_TRANSLATION_TAYLOR, 0.1), 1.002497, 1e-6);
}

// the largest way from rest, over the first, in so many steps
static double widest(dem_translation scheme, double z, int steps)
{
    dem_world *w = oscillator(scheme, z, 1e-7, 0);
    double most = 0;
    for (int i = 0; i < steps; i++) {
        run_steps(w, 1);
        most = largest(most, position_now(w, 0).z - 9e-3);
    }
    dem_world_destroy(w);
    return most / 1e-7;
}

// bounded up to z = 2 by 1 / sqrt(1 - z^2 / 4), where the start does not stand in for half a step (PHYSICS 6.4)
static void symplectic_translations_hold_up_to_two(void **state)
{
    (void)state;
    static const dem_translation schemes[] = {DEM_TRANSLATION_CENTRAL, DEM_TRANSLATION_SYMPLECTIC_EULER,
                                              DEM_TRANSLATION_VELOCITY_VERLET, DEM_TRANSLATION_NEWMARK};
    for (int i = 0; i < 4; i++) {
        bool late = schemes[i] == DEM_TRANSLATION_SYMPLECTIC_EULER;
        check_near(widest(schemes[i], 1.9, 2000), late ? 3.2026 : 1, 1e-2);
        check_near(widest(schemes[i], 1.99, 4000), late ? 10.01 : 1, 1e-2 * (late ? 10 : 1));
        check(widest(schemes[i], 2.01, 40) > 100);
    }
}

// ---- a fall, whose formulas are exact

static void falls_are_those_of_the_formulas(void **state)
{
    (void)state;
    static const double shift[DEM_TRANSLATION_SCHEMES] = {
        [DEM_TRANSLATION_SYMPLECTIC_EULER] = 1, [DEM_TRANSLATION_FORWARD_EULER] = -1};
    for (int s = 0; s < DEM_TRANSLATION_SCHEMES; s++) {
        model *m = model_new();
        m->scene.gravity = v3(0, 0, -10);
        m->scene.time.step = 1e-3;
        m->scene.integrator.translation = (dem_translation)s;
        model_body(m, model_sphere(m, 0.01), v3(0, 0, 0))->velocity = v3(0, 0, 2);
        dem_world *w = model_world(m, 1);
        for (int i = 1; i <= 400; i++) {
            run_steps(w, 1);
            double t = dem_world_time(w);
            check_near(position_now(w, 0).z, 2 * t - 5 * t * (t + shift[s] * 1e-3), 1e-13);
            if (i % 100 == 0) {
                measured(w);
                check_near(dem_world_bodies(w).velocity[0].z, 2 - 10 * t, 1e-13);
            }
        }
        dem_world_destroy(w);
        model_free(m);
    }
}

// ---- clumps that fall and tumble

static model *tumbling(dem_integrator_def schemes, size_t bodies)
{
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    m->scene.integrator = schemes;
    m->laws[0].stiffness = 3e4;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.8;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    m->scene.damping.local = 0.05;
    model_cloud(m, 6, 0.02, 1);
    model_sphere(m, 0.006);
    model_lattice(m, bodies, 0.024, 1, 4);
    double side = 0.024 * ceil(cbrt((double)bodies) - 1e-9);
    model_box(m, v3(0, 0, 0), v3(side, side, side));
    return m;
}

static void verlet_and_newmark_step_as_central_differences(void **state)
{
    (void)state;
    uint64_t hash[3];
    static const dem_translation schemes[] = {DEM_TRANSLATION_CENTRAL, DEM_TRANSLATION_VELOCITY_VERLET,
                                              DEM_TRANSLATION_NEWMARK};
    for (int i = 0; i < 3; i++) {
        model *m = tumbling((dem_integrator_def){schemes[i], DEM_ROTATION_LSYM}, 27);
        dem_world *w = model_world(m, 1);
        run_steps(w, 3000);
        check(measured(w)->energy.viscous > 0);
        hash[i] = dem_world_hash(w);
        dem_world_destroy(w);
        model_free(m);
    }
    check(hash[0] == hash[1] && hash[0] == hash[2]);
}

// the ledger knows the schemes of second order; the others show what they feed in
static void the_ledger_closes_with_every_rotation(void **state)
{
    (void)state;
    for (int s = 0; s < DEM_ROTATION_SCHEMES; s++) {
        model *m = tumbling((dem_integrator_def){DEM_TRANSLATION_CENTRAL, (dem_rotation)s}, 27);
        dem_world *w = model_world(m, 1);
        double worst = 0;
        for (int i = 0; i < 40; i++) {
            run_steps(w, 200);
            worst = largest(worst, measured(w)->energy.error);
        }
        check(measured(w)->energy.friction > 0 && measured(w)->energy.local > 0);
        // pcdm takes moments and dashpots half a step apart
        check(worst < (dem_rotations[s].half ? 5e-4 : 5e-2));
        dem_world_destroy(w);
        model_free(m);
    }
}

static dem_integrator_def every(int i)
{
    return (dem_integrator_def){(dem_translation)(i % DEM_TRANSLATION_SCHEMES),
                                (dem_rotation)(i % DEM_ROTATION_SCHEMES)};
}
enum { COMBINATIONS = 24 };

static void runs_go_on_from_a_saved_state(void **state)
{
    (void)state;
    for (int i = 0; i < COMBINATIONS; i++) {
        model *m = tumbling(every(i), 27);
        dem_world *w = model_world(m, 1), *other = model_world(m, 1);
        void *bytes;
        size_t size;
        dem_error error;
        run_steps(w, 700);
        check_ok(dem_world_save(w, &bytes, &size, &error), error);
        check_ok(dem_world_restore(other, bytes, size, &error), error);
        run_steps(w, 700);
        run_steps(other, 700);
        check(dem_world_hash(w) == dem_world_hash(other));
        measured(w);
        measured(other);
        check(memcmp(dem_world_figures(w), dem_world_figures(other), sizeof(dem_figures)) == 0);
        dem_world_destroy(w);
        dem_world_destroy(other);
        model_free(m);
        // a world with other schemes does not take it up
        m = tumbling(every(i + 1), 27);
        other = model_world(m, 1);
        check(dem_world_restore(other, bytes, size, &error) == DEM_BAD_INPUT);
        dem_world_destroy(other);
        model_free(m);
        free(bytes);
    }
}

static void threads_and_instruction_sets_change_no_bit(void **state)
{
    (void)state;
    static const char *const sets[] = {"plain", "v3", "v4"};
    for (int i = 0; i < 4; i++) {
        model *m = tumbling(every(5 * i + 4), 600);
        uint64_t first = 0;
        for (int k = 0; k < 6; k++) {
            dem_world *w = model_world(m, k < 3 ? 1 << (k + k / 2) : 1);
            const dem_kernels *kernels = k < 3 ? w->kernels : dem_kernels_choose(sets[k - 3]);
            if (kernels) {
                w->kernels = kernels;
                w->instance = w->wall_instance = &kernels->instances[kernels->instance_count - 1];
                run_steps(w, 300);
                first = k ? first : dem_world_hash(w);
                check(dem_world_hash(w) == first);
            }
            dem_world_destroy(w);
        }
        model_free(m);
    }
}

static void explain_says_which_scheme_runs(void **state)
{
    (void)state;
    dem_integrator_def schemes = {DEM_TRANSLATION_TAYLOR, DEM_ROTATION_SPIRAL};
    for (int other = 0; other < 2; other++) {
        model *m = tumbling(other ? schemes : (dem_integrator_def){0}, 1);
        dem_world *w = model_world(m, 1);
        char *text;
        dem_error error;
        check_ok(dem_world_explain(w, &text, &error), error);
        const char *line = other ? "motion: Taylor, order 1 in the velocity, which feeds energy in, rotation by spiral "
                                   "(order 2, energy drifts)\n    one evaluation of the forces a step; body by body"
                                 : "motion: central differences, rotation by lsym\n  with damping of the motion";
        check(strstr(text, line));
        free(text);
        dem_world_destroy(w);
        model_free(m);
    }
}

static void what_is_no_scheme_is_refused(void **state)
{
    (void)state;
    model *m = tumbling((dem_integrator_def){(dem_translation)17, DEM_ROTATION_LSYM}, 1);
    dem_world *w;
    dem_error error;
    check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_USAGE && !w && strstr(error.text, "no such scheme;"));
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotations_err_as_in_the_comparison),
        cmocka_unit_test(norms_and_momenta_are_kept),
        cmocka_unit_test(spins_are_shown_at_the_time_of_the_orientations),
        cmocka_unit_test(translations_grow_as_they_must),
        cmocka_unit_test(symplectic_translations_hold_up_to_two),
        cmocka_unit_test(falls_are_those_of_the_formulas),
        cmocka_unit_test(verlet_and_newmark_step_as_central_differences),
        cmocka_unit_test(the_ledger_closes_with_every_rotation),
        cmocka_unit_test(runs_go_on_from_a_saved_state),
        cmocka_unit_test(threads_and_instruction_sets_change_no_bit),
        cmocka_unit_test(explain_says_which_scheme_runs),
        cmocka_unit_test(what_is_no_scheme_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
