// The time step: the bound of stability against the step at which runs really blow up, and what the automatic one does.
#include "sim/impact.h"
#include "sim/timestep.h"
#include "worlds.h"

// ---- the largest eigenvalue

static void known_matrices_have_their_eigenvalues(void **state)
{
    (void)state;
    double a[6][6] = {0};
    for (int i = 0; i < 6; i++)
        a[i][i] = 10 - (i - 2) * (i - 2);
    check_near(dem_largest_eigenvalue6(a), 10, 0);
    // second differences: 2 - 2 cos(k pi / 7)
    memset(a, 0, sizeof a);
    for (int i = 0; i < 6; i++) {
        a[i][i] = 2;
        if (i)
            a[i][i - 1] = a[i - 1][i] = -1;
    }
    check_close(dem_largest_eigenvalue6(a), 2 + 2 * cos(DEM_PI / 7), 1e-14);
    // v v^T
    double v[6] = {1, -2, 3, 0, 5, -6}, norm2 = 75;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            a[i][j] = v[i] * v[j];
    check_close(dem_largest_eigenvalue6(a), norm2, 1e-14);
    memset(a, 0, sizeof a);
    check_near(dem_eigenvalue_bound6(a), 0, 0);
    check_near(dem_largest_eigenvalue6(a), 0, 0);
    for (int i = 0; i < 6; i++)
        a[i][i] = 3e200;
    check_close(dem_eigenvalue_bound6(a), 3e200 * pow(6, 1.0 / 8), 2e-6);
}

static void random_matrices_agree_with_power_iteration(void **state)
{
    (void)state;
    dem_random r = random_stream(3, 1);
    for (int round = 0; round < 200; round++) {
        // B B^T with rows of very different size, as masses and moments make them
        double b[6][6], a[6][6], x[6], lambda = 0;
        for (int i = 0; i < 6; i++) {
            double size = pow(10, 6 * random_uniform(&r) - 3);
            for (int j = 0; j < 6; j++)
                b[i][j] = size * random_normal(&r);
            x[i] = random_normal(&r);
        }
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++) {
                a[i][j] = 0;
                for (int k = 0; k < 6; k++)
                    a[i][j] += b[i][k] * b[j][k];
            }
        for (int step = 0; step < 20000; step++) {
            double y[6] = {0}, norm = 0;
            for (int i = 0; i < 6; i++)
                for (int j = 0; j < 6; j++)
                    y[i] += a[i][j] * x[j];
            for (int i = 0; i < 6; i++)
                norm += y[i] * y[i];
            lambda = sqrt(norm);
            for (int i = 0; i < 6; i++)
                x[i] = y[i] / lambda;
        }
        double bound = dem_eigenvalue_bound6(a), got = dem_largest_eigenvalue6(a);
        // the eighth root of the sum of six eighth powers
        check(bound >= got && bound <= 1.0001 * pow(6, 1.0 / 8) * got);
        // two eigenvalues that nearly agree slow the iteration down
        check_close(got, lambda, 1e-6);
        check(got >= lambda * (1 - 1e-13));
    }
}

// ---- the bound against real runs

static const double SLIGHT = 1e-7;  // of the radius: overlaps; what they are loaded by does not count beside k
static const double SEED = 1e-15, BLOWN = 1e-11;  // of a step's motion: at first, and where it grows [m]

static double motion_of_step(const dem_world *w, double step)
{
    double most = 0;
    for (size_t row = 0; row < w->bodies.count; row++) {
        const double *v = body_pose(&w->bodies, row) + 8;
        double turning = 0.01 * v3_norm(v3(v[3], v[4], v[5])), speed = v3_norm(v3(v[0], v[1], v[2])) + turning;
        if (!(speed * step <= most))
            most = speed * step;  // also where it is none
    }
    return most;
}

// Everything is held in balance by pushes; true: a small vibration grows.
static bool grows(model *m, double step)
{
    m->scene.time.step = step;
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(3, 2);
    size_t n = w->bodies.count;
    dem_vec3 force[16], moment[16];
    for (size_t row = 0; row < n; row++) {  // at rest, for the dashpots
        memset(w->bodies.momentum + DEM_ROW * row, 0, 6 * sizeof(double));
        memset(body_pose(&w->bodies, row) + 8, 0, 6 * sizeof(double));
    }
    measured(w);
    dem_body_view v = dem_world_bodies(w);
    for (size_t i = 0; i < n; i++) {
        force[i] = v3_scale(v.force[i], -1);
        moment[i] = v3_scale(v.moment[i], -1);
        // momenta alone: the first step makes velocities of them
        double *p = w->bodies.momentum + DEM_ROW * w->bodies.place[i];
        for (int k = 0; k < 6; k++)
            p[k] = SEED / step * v.mass[i] * random_normal(&r) * (k < 3 ? 1 : 0.003);
    }
    bool blown = false;
    dem_error error;
    for (int i = 0; i < 3000 && !blown; i++) {
        for (size_t k = 0; k < n; k++)
            dem_world_push(w, k, force[k], moment[k]);
        blown = dem_world_step(w, 1, &error) != DEM_OK || !(motion_of_step(w, step) < BLOWN);
    }
    dem_world_destroy(w);
    return blown;
}

static double bound_of(model *m)
{
    m->scene.time.step = 1e-9;
    dem_world *w = model_world(m, 1);
    double step = dem_world_critical_step(w);
    dem_world_destroy(w);
    return step;
}

// the step that separates what stays from what grows, to 1e-4 [s]
static double measured_limit(model *m, double bound)
{
    double low = 0.9 * bound, high = 3 * bound;
    check(!grows(m, low));
    check(grows(m, high));
    while (high / low > 1 + 1e-4) {
        double middle = (low + high) / 2;
        if (grows(m, middle))
            high = middle;
        else
            low = middle;
    }
    return low;
}

// a wall that the sphere of radius r at x touches
static void add_wall(model *m, dem_vec3 x, dem_vec3 out, double r)
{
    model_plane(m, v3_along(x, r * (1 - SLIGHT), out), v3_scale(out, -1));
}

static void one_and_two_spheres_between_walls_blow_up_at_the_bound(void **state)
{
    (void)state;
    double mass = 2500 * 4 * DEM_PI / 3 * 1e-6;
    for (int n = 1; n <= 2; n++) {
        model *m = model_new();
        model_sphere(m, 0.01);
        for (int i = 0; i < n; i++)
            model_body(m, 0, v3(0.02 * (1 - SLIGHT / 2) * i, 0, 0));
        add_wall(m, v3(0, 0, 0), v3(-1, 0, 0), 0.01);
        add_wall(m, m->bodies[n - 1].position, v3(1, 0, 0), 0.01);
        double bound = bound_of(m);
        // 2k of two walls; k of the wall and twice that of the other sphere, which is what the pair really has
        check_close(bound, 2 / sqrt((n == 1 ? 2 : 3) * 1e4 / mass), 1e-12);
        check_close(measured_limit(m, bound), bound, 1e-3);
        model_free(m);
    }
}

static void two_spheres_pressed_together_blow_up_at_the_bound(void **state)
{
    (void)state;
    model *m = model_new();
    model_sphere(m, 0.01);
    model_body(m, 0, v3(0, 0, 0));
    model_body(m, 0, v3(0.02 * (1 - SLIGHT), 0, 0));
    double bound = bound_of(m), mass = 2500 * 4 * DEM_PI / 3 * 1e-6;
    check_close(bound, 2 * sqrt(mass / 2 / 1e4), 1e-12);
    check_close(measured_limit(m, bound), bound, 1e-3);
    model_free(m);
}

// friction couples shift and turn: k_t (1/m + r^2/I) = 3.5 k_t / m for one contact
static void a_sticking_sphere_has_two_sevenths_of_its_mass(void **state)
{
    (void)state;
    model *m = model_new();
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 1;
    m->laws[0].stiffness_ratio = 0.8;
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0));
    add_wall(m, v3(0, 0, 0), v3(0, 0, -1), 0.01);
    double bound = bound_of(m), mass = 2500 * 4 * DEM_PI / 3 * 1e-6;
    check_close(bound, 2 / sqrt(0.8 * 1e4 * 3.5 / mass), 1e-6);
    check_close(measured_limit(m, bound), bound, 1e-3);
    model_free(m);
}

// spheres of a clump at one place count each; those of a rod on its side turn it, too
static void duplicate_contacts_lower_the_limit(void **state)
{
    (void)state;
    for (size_t n = 1; n <= 4; n++) {
        model *m = model_new();
        dem_ball balls[4];
        for (size_t i = 0; i < n; i++)
            balls[i] = (dem_ball){v3(0, 0, 0), 0.01};
        double i = 0.4 * 0.01 * 1e-4;
        model_body(m, model_clump(m, balls, n, 0.01, (double[]){i, i, i}), v3(0, 0, 0));
        add_wall(m, v3(0, 0, 0), v3(0, 0, -1), 0.01);
        double bound = bound_of(m);
        check_close(bound, 2 / sqrt((double)n * 1e4 / 0.01), 1e-12);
        check_close(measured_limit(m, bound), bound, 1e-3);
        model_free(m);
    }
    model *m = model_new();
    model_body(m, model_dumbbell(m, 0.01, 0.03), v3(0, 0, 0));
    add_wall(m, v3(0, 0, 0), v3(0, 0, -1), 0.01);
    double ball = 2500 * 4 * DEM_PI / 3 * 1e-6, i = 2 * 0.4 * ball * 1e-4 + 2 * ball * 0.015 * 0.015;
    double bound = bound_of(m), heave = 2e4 / (2 * ball), pitch = 2e4 * 0.015 * 0.015 / i;
    check_close(bound, 2 / sqrt(fmax(heave, pitch)), 1e-12);
    check_close(measured_limit(m, bound), bound, 1e-3);
    model_free(m);
}

// one clump held by six walls, each at one of its spheres: all contacts are its own, so the bound is the limit
static void a_clump_held_from_all_sides_blows_up_at_the_bound(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        model *m = model_new();
        if (seed % 2) {
            m->laws[0].friction = DEM_FRICTION_LINEAR;
            m->laws[0].friction_coefficient = 1;
            m->laws[0].stiffness_ratio = 0.5;
        }
        uint32_t shape = model_cloud(m, 12, 0.02, seed);
        dem_random r = random_stream(seed, 3);
        dem_body_def *b = model_body(m, shape, v3(0, 0, 0));
        b->orientation = random_quat(&r);
        dem_clump_def def = dem_clump_view(m->clumps[shape]);
        for (int k = 0; k < 6; k++) {
            dem_vec3 out = v3((k == 0) - (k == 1), (k == 2) - (k == 3), (k == 4) - (k == 5));
            double top = 0;
            for (size_t i = 0; i < def.ball_count; i++)
                top = fmax(top, v3_dot(out, quat_rotate(b->orientation, def.balls[i].centre)) + def.balls[i].radius);
            model_plane(m, v3_scale(out, top - 0.005 * SLIGHT), v3_scale(out, -1));
        }
        double bound = bound_of(m);
        check_close(measured_limit(m, bound), bound, 1e-3);
        model_free(m);
    }
}

// least distance of the surfaces of two bodies of the model [m]
static double gap_of(const model *m, const dem_body_def *a, const dem_body_def *b)
{
    dem_clump_def p = dem_clump_view(m->clumps[a->shape]), q = dem_clump_view(m->clumps[b->shape]);
    double gap = INFINITY;
    for (size_t i = 0; i < p.ball_count; i++)
        for (size_t j = 0; j < q.ball_count; j++) {
            dem_vec3 x = v3_add(a->position, quat_rotate(a->orientation, p.balls[i].centre));
            dem_vec3 y = v3_add(b->position, quat_rotate(b->orientation, q.balls[j].centre));
            gap = fmin(gap, v3_distance(x, y) - p.balls[i].radius - q.balls[j].radius);
        }
    return gap;
}

// a heap of clumps, each brought up to the others along a random line until it just touches
static model *random_heap(uint64_t seed, size_t count, bool friction)
{
    model *m = model_new();
    if (friction) {
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 1;
        m->laws[0].stiffness_ratio = 0.7;
    }
    model_cloud(m, 10, 0.02, seed);
    model_dumbbell(m, 0.006, 0.009);
    dem_random r = random_stream(seed, 4);
    for (size_t i = 0; i < count; i++) {
        dem_body_def *b = model_body(m, (uint32_t)(i % 2), v3(0, 0, 0));
        b->orientation = random_quat(&r);
        dem_vec3 out = v3_unit(v3(random_normal(&r), random_normal(&r), random_normal(&r)));
        double low = 0, high = 0.2;
        for (int k = 0; i && k < 60; k++) {
            double middle = (low + high) / 2, gap = INFINITY;
            b->position = v3_scale(out, middle);
            for (size_t j = 0; j < i; j++)
                gap = fmin(gap, gap_of(m, b, &m->bodies[j]));
            if (gap < -0.005 * SLIGHT)
                low = middle;
            else
                high = middle;
        }
    }
    return m;
}

static void heaps_blow_up_beyond_the_bound_never_below(void **state)
{
    (void)state;
    double sum = 0;
    int heaps = SLOW_BUILD ? 3 : 12;
    for (int i = 0; i < heaps; i++) {
        model *m = random_heap((uint64_t)i + 1, 3 + (size_t)i % 6, i % 2);
        double bound = bound_of(m), limit = measured_limit(m, bound);
        check(limit >= bound * (1 - 2e-4));  // of the bisection
        sum += limit / bound;
        model_free(m);
    }
    // not far beyond: PHYSICS 4 has a median of 1.37
    check(sum / heaps < 1.6);
}

// x = w h where x^2 + 4 z x / (1 + z x / 2) = 4: a normal dashpot is smaller by what its old velocity makes it larger
static double mended_limit(double z)
{
    double low = 0, high = 2;
    for (int i = 0; i < 60; i++) {
        double x = (low + high) / 2;
        if (x * x + 4 * z * x / (1 + z * x / 2) < 4)
            low = x;
        else
            high = x;
    }
    return low;
}

// dashpots see velocities half a step old: the limit falls by sqrt(1 + z^2) - z at most
static void lagged_dashpots_lower_the_limit_as_predicted(void **state)
{
    (void)state;
    static const double ratios[] = {0.1, 0.2, 0.3, 0.5, 1};
    static const double wanted[] = {1.809975, 1.639608, 1.488061, 1.236068, 0.828427};  // PHYSICS 2.1
    double mass = 2500 * 4 * DEM_PI / 3 * 1e-6, rate = sqrt(1e4 / mass);
    for (int i = 0; i < 5; i++)
        for (int friction = 0; friction < 2; friction++) {
            model *m = model_new();
            m->laws[0].damping = DEM_DAMPING_RATE;
            m->laws[0].damping_rate = 2 * ratios[i] * rate;
            m->laws[0].tail = i % 2 ? DEM_TAIL_CUT : DEM_TAIL_TENSION;  // under load alike
            if (friction) {
                // the tangential dashpot sees the mass m, the motion 2/7 of it
                m->laws[0].friction = DEM_FRICTION_LINEAR;
                m->laws[0].friction_coefficient = 1;
                m->laws[0].tangential_stiffness = 1e4;
                m->laws[0].tangential_rate = 2 * ratios[i] * rate / sqrt(3.5);
            }
            model_body(m, model_sphere(m, 0.01), v3(0, 0, 0));
            add_wall(m, v3(0, 0, 0), v3(0, 0, -1), 0.01);
            double bound = bound_of(m), limit = measured_limit(m, bound);
            check(limit >= bound * (1 - 2e-4));
            if (friction)  // nothing mends the tangential dashpot, so this is the limit, or that of the normal one
                check_close(limit, bound, i < 4 ? 1e-3 : 0.5);
            else {
                check_close(bound, wanted[i] / rate, 1e-6);
                check_close(limit, mended_limit(ratios[i]) / rate, 1e-3);
            }
            model_free(m);
        }
}

static void nothing_that_touches_sets_no_limit(void **state)
{
    (void)state;
    model *m = model_new();
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0));
    model_body(m, 0, v3(0.0201, 0, 0));
    dem_world *w = model_world(m, 1);
    check(isinf(dem_world_critical_step(w)));
    dem_step_bound bound;
    dem_error error;
    check_ok(dem_step_stable(w, true, &bound, &error), error);  // but what is listed may
    check_close(bound.step, 2 * sqrt(2500 * 4 * DEM_PI / 3 * 1e-6 / 2 / 1e4), 1e-12);
    dem_world_destroy(w);
    model_free(m);
}

// a sphere between two walls, whose bound is its limit, at the automatic step: local damping takes the limit below the
// usual safety of it, and so does fast global damping
static void an_automatic_step_knows_of_local_and_global_damping(void **state)
{
    (void)state;
    static const struct {
        double local, viscous;
    } cases[] = {{0.7, 0}, {0.95, 0}, {0, 2000}, {0, 1e5}, {0.7, 2000}};
    double w = sqrt(2 * 1e4 / (2500 * 4 * DEM_PI / 3 * 1e-6));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        model *m = model_new();
        m->scene.damping.local = cases[i].local;
        m->scene.damping.viscous = cases[i].viscous;
        m->scene.time.step = 0;
        m->scene.time.contact_steps = 0;  // stability alone
        model_plane(m, v3(0, 0, 0.0001 - 0.01), v3(0, 0, 1));
        model_plane(m, v3(0, 0, 0.01 - 0.0001), v3(0, 0, -1));
        model_body(m, model_sphere(m, 0.01), v3(0, 0, 0))->velocity.z = 1e-9;
        dem_world *world = model_world(m, 1);
        double c = cases[i].viscous, h = dem_world_critical_step(world);
        check_close((1 + cases[i].local) * w * w * h * h + 2 * c * h, 4, 1e-9);
        check(dem_world_step_size(world) <= 0.8 * h * (1 + 1e-12));
        run_steps(world, 3000);
        check(fabs(measured(world)->energy.kinetic) < 1e-18 && fabs(position_now(world, 0).z) < 1e-10);
        dem_world_destroy(world);
        model_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_matrices_have_their_eigenvalues),
        cmocka_unit_test(random_matrices_agree_with_power_iteration),
        cmocka_unit_test(one_and_two_spheres_between_walls_blow_up_at_the_bound),
        cmocka_unit_test(two_spheres_pressed_together_blow_up_at_the_bound),
        cmocka_unit_test(a_sticking_sphere_has_two_sevenths_of_its_mass),
        cmocka_unit_test(duplicate_contacts_lower_the_limit),
        cmocka_unit_test(a_clump_held_from_all_sides_blows_up_at_the_bound),
        cmocka_unit_test(heaps_blow_up_beyond_the_bound_never_below),
        cmocka_unit_test(lagged_dashpots_lower_the_limit_as_predicted),
        cmocka_unit_test(nothing_that_touches_sets_no_limit),
        cmocka_unit_test(an_automatic_step_knows_of_local_and_global_damping),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
