// The rotation of bodies against exact solutions: free tops, the heavy top, fast spins, and any choice of body axes.
// PHYSICS 2.3 and 6.3; the figures of the default scheme there are the bounds here.
#include "worlds.h"

// a body alone in space, one ball with the moments given; spin along the principal axes
static dem_world *lone_body(const double inertia[3], double radius, double mass, dem_quat q, dem_vec3 spin, double step)
{
    model *m = model_new();
    m->scene.time.step = step;
    model_clump(m, (dem_ball[]){{{0, 0, 0}, radius}}, 1, mass, inertia);
    dem_body_def *b = model_body(m, 0, v3(0, 0, 0));
    b->orientation = q;
    b->spin = quat_rotate(quat_unit(q), spin);
    dem_world *w = model_world(m, 1);
    model_free(m);
    return w;
}

static const dem_quat NOT_TURNED = {1, 0, 0, 0};

// spin along the principal axes; alone in space it is the same at half steps
static dem_vec3 own_spin(const dem_world *w)
{
    return quat_unrotate(orientation_now(w, 0), spin_before(w, 0));
}

static dem_vec3 times_inertia(const double i[3], dem_vec3 spin)
{
    return v3(i[0] * spin.x, i[1] * spin.y, i[2] * spin.z);
}
static double energy_of(const double i[3], dem_vec3 spin)
{
    return v3_dot(times_inertia(i, spin), spin) / 2;
}

// ---- the free asymmetric top

static const double ONE_TWO_THREE[3] = {1, 2, 3};
static const dem_vec3 TOP_SPIN = {1, 0.5, 0.8};

// after 10 s, by Jacobi's functions (PHYSICS 6.3)
static const dem_vec3 TOP_SPIN_AT_10 = {0.471913952806, 1.013556718268, 0.617171715396};
static const dem_quat TOP_AT_10 = {0.729597833524, -0.030117639158, -0.333812224756, -0.596111841631};

static void a_free_top_is_where_jacobi_has_it_to_the_second_order(void **state)
{
    (void)state;
    double turned_off[3], spin_off[3];
    for (int i = 0; i < 3; i++) {
        int per_second = 14 << i;  // |w| h = 0.1 first
        dem_world *w = lone_body(ONE_TWO_THREE, 1, 1, NOT_TURNED, TOP_SPIN, 1.0 / per_second);
        run_steps(w, 10 * (uint64_t)per_second);
        turned_off[i] = angle_between(orientation_now(w, 0), TOP_AT_10);
        spin_off[i] = v3_distance(own_spin(w), TOP_SPIN_AT_10);
        dem_world_destroy(w);
    }
    check(turned_off[0] < 8e-4);  // a tenth of the bound for 100 s
    for (int i = 0; i < 2; i++) {
        // the next order is h^2 = 0.01 of this one
        check_near(turned_off[i] / turned_off[i + 1], 4, 0.04);
        check_near(spin_off[i] / spin_off[i + 1], 4, 0.04);
    }
}

// the largest angle between a run and the rows t, w, q of a table
static double off_table(const char *path, const double inertia[3], dem_vec3 spin, int per_second)
{
    dem_world *w = lone_body(inertia, 1, 1, NOT_TURNED, spin, 1.0 / per_second);
    FILE *f = fopen(path, "r");
    check(f);
    char line[1000];
    double t, wx, wy, wz, most = 0;
    dem_quat q;
    while (fgets(line, sizeof line, f)) {
        if (sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &t, &wx, &wy, &wz, &q.w, &q.x, &q.y, &q.z) != 8)
            continue;
        run_steps(w, (uint64_t)llround(t * per_second) - dem_world_steps(w));
        most = fmax(most, angle_between(orientation_now(w, 0), q));
    }
    check_near(dem_world_time(w), 100, 1e-9);
    fclose(f);
    dem_world_destroy(w);
    return most;
}

static void tops_stay_near_the_tables_for_a_hundred_seconds(void **state)
{
    (void)state;
    const char *top = SHARED_DATA("free_top_I123_w1_05_08.csv"),
               *flips = SHARED_DATA("dzhanibekov_I123_w_1e-3_1_0.csv");
    check_shared(top);
    double off = off_table(top, ONE_TWO_THREE, TOP_SPIN, 14);
    check(off < 8e-3);
    check_near(off / off_table(top, ONE_TWO_THREE, TOP_SPIN, 28), 4, 0.04);
    check(off_table(flips, ONE_TWO_THREE, v3(1e-3, 1, 0), 12) < 6e-3);
}

// what the spin and the orientation say of L, and the energy: bounded, without a trend
static void a_free_top_keeps_its_angular_momentum_and_bounds_its_energy(void **state)
{
    (void)state;
    dem_world *w = lone_body(ONE_TWO_THREE, 1, 1, NOT_TURNED, TOP_SPIN, 1.0 / 14);
    dem_vec3 l0 = times_inertia(ONE_TWO_THREE, TOP_SPIN);
    double e0 = energy_of(ONE_TWO_THREE, TOP_SPIN), most[2] = {0};
    for (int i = 0; i < 140000; i++) {
        run_steps(w, 1);
        dem_vec3 spin = own_spin(w);
        dem_vec3 l = quat_rotate(orientation_now(w, 0), times_inertia(ONE_TWO_THREE, spin));
        check_vec(l, l0, 1e-13 * v3_norm(l0));
        most[i >= 70000] = fmax(most[i >= 70000], fabs(energy_of(ONE_TWO_THREE, spin) / e0 - 1));
    }
    check(most[0] < 8e-5);  // 7.5e-5 in the table, at this step
    check_close(most[1], most[0], 1e-3);
    dem_world_destroy(w);
}

// ---- flips about the middle axis (Dzhanibekov)

// the time between flips: 2 K(m) / p for a spin near the middle axis (Jacobi); the axis with the larger share of the
// energy, first or third, is the one that keeps its side
static double time_between_flips(const double i[3], dem_vec3 spin)
{
    double e = energy_of(i, spin), l2 = v3_norm2(times_inertia(i, spin));
    bool first = l2 < 2 * e * i[1];
    double a = first ? i[2] : i[0], b = i[1], c = first ? i[0] : i[2];
    double p = sqrt((c - b) * (l2 - 2 * e * a) / (a * b * c)),
           m = (b - a) * (2 * e * c - l2) / ((c - b) * (l2 - 2 * e * a));
    double x = 1, y = sqrt(1 - m);
    for (int k = 0; k < 10; k++) {
        double mean = (x + y) / 2;
        y = sqrt(x * y);
        x = mean;
    }
    return DEM_PI / x / p;
}

// when the spin about the middle axis goes through 0 for the last time before 1000 s; how often it does so, and the
// least spin about the axis `side`
static double last_flip(dem_vec3 spin, int side, double step, int *flips, double *least)
{
    dem_world *w = lone_body(ONE_TWO_THREE, 1, 1, NOT_TURNED, spin, step);
    double last = spin.y, t = 0;
    *flips = 0;
    *least = INFINITY;
    while (dem_world_time(w) < 1000) {
        run_steps(w, 1);
        dem_vec3 now = own_spin(w);
        *least = fmin(*least, v3_get(now, side));
        if ((now.y < 0) != (last < 0)) {
            t = dem_world_time(w) - step * now.y / (now.y - last);
            (*flips)++;
        }
        last = now.y;
    }
    dem_world_destroy(w);
    return t;
}

// a hair beside the middle axis, towards the axis of the smallest or of the largest moment: the spin about that axis
// never changes its sign, however often the body turns over, and always comes back to its least
static void flips_come_in_time_and_on_their_own_side(void **state)
{
    (void)state;
    check_near(time_between_flips(ONE_TWO_THREE, v3(1e-3, 1, 0)), 28.7314244372, 1e-9);  // PHYSICS 6.3
    for (int side = 0; side < 3; side += 2) {
        dem_vec3 spin = side ? v3(0, 1, 1e-3) : v3(1e-3, 1, 0);
        double between = time_between_flips(ONE_TWO_THREE, spin), off[2], least;
        for (int i = 0; i < 2; i++) {
            int flips;
            double t = last_flip(spin, side, 0.1 / (1 << i), &flips, &least);
            assert_int_equal(flips, (int)(1000 / between + 0.5));
            off[i] = t / ((flips - 0.5) * between) - 1;
            check_near(least, 1e-3, 1e-5);
        }
        check_near(off[0], 0, 2e-4);  // of second order: (w h)^2 / 50
        check_near(off[0] / off[1], 4, 0.04);
    }
}

// ---- the heavy top, on its pivot

typedef struct top {
    dem_world *world;
    double weight;  // m g l [N m]
} top;

static const double TOP[3] = {0.2, 0.2, 0.3};

static top top_at(double theta, double precession, double spin, double step)
{
    dem_vec3 axis = v3(0, -sin(theta), cos(theta)), up = v3(0, 0, 1);
    dem_quat q = quat_about(v3(theta, 0, 0));
    dem_vec3 turning = v3_along(v3_scale(axis, spin), precession, v3_along(up, -cos(theta), axis));
    return (top){lone_body(TOP, 1, 1, q, quat_unrotate(q, turning), step), 2};
}

static dem_vec3 top_axis(const top *t)
{
    return quat_rotate(orientation_now(t->world, 0), v3(0, 0, 1));
}

static void top_step(top *t)
{
    dem_vec3 moment = v3_scale(v3_cross(top_axis(t), v3(0, 0, -1)), t->weight);
    dem_world_push(t->world, 0, v3(0, 0, 0), moment);
    run_steps(t->world, 1);
}

// after a time at the rate W of steady precession, I1 W^2 cos(tilt) - I3 w W + m g l = 0: how far the axis is off in
// azimuth, and at most in tilt
static void precess(double theta, double rate, double time, int steps, double *azimuth, double *tilt)
{
    top t = top_at(theta, rate, 20, time / steps);
    *tilt = 0;
    for (int k = 0; k < steps; k++) {
        top_step(&t);
        *tilt = fmax(*tilt, fabs(acos(top_axis(&t).z) - theta));
    }
    dem_vec3 axis = top_axis(&t);
    *azimuth = fabs(remainder(atan2(axis.x, -axis.y) - time * rate, 2 * DEM_PI));
    dem_world_destroy(t.world);
}

static void a_heavy_top_precesses_steadily(void **state)
{
    (void)state;
    double theta = DEM_PI / 6, a = TOP[0] * cos(theta), b = TOP[2] * 20, root = sqrt(b * b - 4 * a * 2);
    double slow = (b - root) / (2 * a), fast = (b + root) / (2 * a), azimuth[2], tilt[2];
    check_near(slow, 0.336604089, 1e-9);
    check_near(fast, 34.3044121, 1e-7);
    for (int i = 0; i < 2; i++)
        precess(theta, slow, 20, 4200 << i, &azimuth[i], &tilt[i]);  // w h = 0.095, 0.048
    check(tilt[0] < 2e-5 && azimuth[0] * sin(theta) < 8e-5);         // 1.94e-5 and 7.28e-5 in the table
    check_near(tilt[0] / tilt[1], 4, 0.04);
    check_near(azimuth[0] / azimuth[1], 4, 0.04);
    precess(theta, fast, 1, 10000, &azimuth[0], &tilt[0]);
    check(tilt[0] < 1e-7 && azimuth[0] < 1e-6);
}

// w3 = 2 sqrt(m g l I1) / I3 = 4.2164: faster ones sleep, slower ones fall at the rate of the linear theory
static void a_sleeping_top_wakes_below_its_limit(void **state)
{
    (void)state;
    for (int slow = 0; slow < 2; slow++) {
        double spin = slow ? 4.2 : 4.23, tilt = 1e-7, most = 0, at[2] = {0};
        double half = TOP[2] * spin / (2 * TOP[0]), rate2 = 2 / TOP[0] - half * half;
        // turning with the half of I3 w3 / I1, the linear motion is cosh(rate t) there
        top t = top_at(tilt, half, spin, 0.005);
        for (int k = 0; k <= 5000; k++) {
            top_step(&t);
            dem_vec3 axis = top_axis(&t);
            double now = hypot(axis.x, axis.y);
            most = fmax(most, now);
            if (k == 3000 || k == 5000)
                at[k == 5000] = now;
        }
        if (slow)
            check_close(log(at[1] / at[0]) / 10, sqrt(rate2), 2e-3);
        else
            check(most < 1.01 * tilt && rate2 < 0);
        dem_world_destroy(t.world);
    }
}

// ---- needles and plates

// Euler's equations and the turning of the body by Runge and Kutta's fourth order
typedef struct rotor_state {
    double y[7];  // q, spin in the body
} rotor_state;

static rotor_state rotor_rate(const double i[3], const rotor_state *s)
{
    const double *y = s->y;
    dem_quat q = {y[0], y[1], y[2], y[3]}, d = quat_multiply(q, (dem_quat){0, y[4], y[5], y[6]});
    return (rotor_state){{d.w / 2, d.x / 2, d.y / 2, d.z / 2, (i[1] - i[2]) * y[5] * y[6] / i[0],
                          (i[2] - i[0]) * y[6] * y[4] / i[1], (i[0] - i[1]) * y[4] * y[5] / i[2]}};
}
static rotor_state rotor_add(rotor_state a, double h, rotor_state b)
{
    for (int k = 0; k < 7; k++)
        a.y[k] += h * b.y[k];
    return a;
}
static rotor_state rotor_step(const double i[3], rotor_state s, double h)
{
    rotor_state a = rotor_rate(i, &s), t = rotor_add(s, h / 2, a), b = rotor_rate(i, &t);
    t = rotor_add(s, h / 2, b);
    rotor_state c = rotor_rate(i, &t);
    t = rotor_add(s, h, c);
    rotor_state d = rotor_rate(i, &t);
    return rotor_add(rotor_add(rotor_add(rotor_add(s, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
}

// the largest angle to that solution within 20 s
static double off_exact(const double inertia[3], dem_vec3 spin, uint64_t steps)
{
    // PHYSICS' needle has moments that no body can have, so they are put in later
    bool body = inertia[2] <= inertia[0] + inertia[1];
    double h = 20.0 / (double)steps, most = 0;
    dem_world *w =
        lone_body(body ? inertia : (double[]){inertia[0], inertia[1], inertia[1]}, 1, 1, NOT_TURNED, spin, h);
    if (!body) {
        // run frame: y z x
        w->bodies.inertia[2] = 1 / inertia[2];
        w->bodies.momentum[5] = inertia[2] * spin.z;
    }
    rotor_state s = {{1, 0, 0, 0, spin.x, spin.y, spin.z}};
    int parts = 20;
    for (uint64_t k = 0; k < steps; k++) {
        run_steps(w, 1);
        for (int i = 0; i < parts; i++)
            s = rotor_step(inertia, s, h / parts);
        most = fmax(most, angle_between(orientation_now(w, 0), quat_unit((dem_quat){s.y[0], s.y[1], s.y[2], s.y[3]})));
    }
    dem_world_destroy(w);
    return most;
}

static void needles_and_plates_turn_as_they_should(void **state)
{
    (void)state;
    // bounds from the table: 3.065e-3 and 1.798e-4 at w h = 0.098 and 0.096
    const double needle[3] = {1e-4, 1, 1.02}, thin[3] = {1e-4, 1, 1.0001}, plate[3] = {1, 1.05, 1.95};
    dem_vec3 fast = v3(50, 0.3, 0.2), flat = v3(3, 0.5, 20);
    double off = off_exact(needle, fast, 10200);
    check(off < 3.1e-3);
    check_near(off / off_exact(needle, fast, 20400), 4, 0.04);
    check(off_exact(thin, fast, 10200) < 2e-5);
    off = off_exact(plate, flat, 4200);
    check(off < 1.85e-4);
    check_near(off / off_exact(plate, flat, 8400), 4, 0.04);
}

// ---- fast spins

// a symmetric body turns about L by |L| t / I and about its own axis by what is left: exact whatever the step
static void a_symmetric_body_turns_exactly_at_any_spin(void **state)
{
    (void)state;
    const double mass = 2.1e-5, inertia[2][3] = {{1e-11, 3e-11, 3e-11}, {2e-11, 2e-11, 3.5e-11}};
    for (int disc = 0; disc < 2; disc++) {
        const double *i = inertia[disc], across = i[1];
        dem_vec3 spin = v3_scale(v3(0.8, 0.36, 0.48), 1e5), l = times_inertia(i, spin);
        dem_quat q0 = quat_unit((dem_quat){0.3, -0.5, 0.7, 0.2});
        dem_world *w = lone_body(i, 1e-3, mass, q0, spin, 1e-5);  // a radian in a step
        run_steps(w, 20000);
        double t = dem_world_time(w), e0 = energy_of(i, spin);
        dem_vec3 own = disc ? v3(0, 0, (1 / i[2] - 1 / across) * l.z * t) : v3((1 / i[0] - 1 / across) * l.x * t, 0, 0);
        dem_quat want =
            quat_multiply(quat_multiply(quat_about(v3_scale(quat_rotate(q0, l), t / across)), q0), quat_about(own));
        dem_quat q = orientation_now(w, 0);
        check_near(sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z), 1, 1e-13);
        check_near(energy_of(i, own_spin(w)) / e0, 1, 1e-12);
        // 2e4 radians, at a rate that is as good as the energy
        check_near(angle_between(q, want), 0, 2e4 * 1e-13);
        dem_world_destroy(w);
    }
}

static void a_sphere_turns_exactly_at_any_spin(void **state)
{
    (void)state;
    dem_vec3 spin = v3_scale(v3(0.8, 0.36, 0.48), 1e5);
    dem_world *w = lone_body((double[]){1e-11, 1e-11, 1e-11}, 1e-3, 2e-5, NOT_TURNED, spin, 1e-5);
    run_steps(w, 20000);
    // of 2e4 radians the last bits
    dem_quat want = quat_about(v3_scale(spin, dem_world_time(w)));
    check_near(angle_between(orientation_now(w, 0), want), 0, 2e4 * 1e-15);
    dem_world_destroy(w);
}

static void a_body_that_turns_by_three_radians_in_a_step_stays_finite(void **state)
{
    (void)state;
    double e0 = energy_of(ONE_TWO_THREE, TOP_SPIN), most = 0;
    dem_world *w = lone_body(ONE_TWO_THREE, 1, 1, NOT_TURNED, TOP_SPIN, 3 / v3_norm(TOP_SPIN));
    for (int i = 0; i < 20000; i++) {
        run_steps(w, 1);
        most = fmax(most, fabs(energy_of(ONE_TWO_THREE, own_spin(w)) / e0 - 1));
    }
    check(most < 1e-3);  // ten turns of 0.3 a step: 9 times what 0.1 gives, 7.5e-5
    dem_world_destroy(w);
}

// ---- the choice of body axes

// two bodies on a rough plane that hit each other; balls turned by q, the pose against it
static void collide(const dem_ball *balls, size_t count, const double inertia[3], dem_quat turn, uint64_t steps,
                    dem_body_view *view, dem_world **world)
{
    dem_ball turned[8];
    for (size_t i = 0; i < count; i++)
        turned[i] = (dem_ball){quat_rotate(turn, balls[i].centre), balls[i].radius};
    model *m = model_new();
    m->scene.gravity = v3(0.3, 0, -9.81);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.7;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    model_clump(m, turned, count, 0.05, inertia);
    model_plane(m, v3(0, 0, 0), v3(0.1, 0, 1));
    for (int i = 0; i < 2; i++) {
        dem_body_def *b = model_body(m, 0, v3(0.045 * i, 0.002 * i, 0.03));
        dem_quat q = quat_unit((dem_quat){0.4, 0.1 + i, -0.7, 0.3});
        b->orientation = quat_multiply(q, quat_conjugate(turn));
        b->velocity = v3(0.5 - i, 0.1, -0.4);
        b->spin = v3(5, -11, 20 * i);
    }
    *world = model_world(m, 1);
    run_steps(*world, steps);  // before a grazing hit makes more of the last bits
    const dem_figures *f = measured(*world);
    check(f->energy.friction > 0 && f->energy.viscous > 0);
    *view = dem_world_bodies(*world);
    model_free(m);
}

static void results_do_not_depend_on_the_body_axes(void **state)
{
    (void)state;
    const double r = 0.008, d = 0.007;
    dem_ball cube[8], disc[5],
        odd[4] = {{{0.011, 0.001, 0}, r},
                  {{-0.01, 0.004, 0.002}, 0.9 * r},
                  {{0.001, -0.008, 0.003}, r},
                  {{0, 0.002, -0.005}, r}};
    for (int i = 0; i < 8; i++)
        cube[i] = (dem_ball){v3(i & 1 ? d : -d, i & 2 ? d : -d, i & 4 ? d : -d), r};
    for (int i = 0; i < 5; i++)
        disc[i] = (dem_ball){v3(2 * d * cos(0.4 * DEM_PI * i), 2 * d * sin(0.4 * DEM_PI * i), 0), r};
    // what leaves the moments as they are: any turn, one about the third axis, half turns about the axes
    const struct {
        const dem_ball *balls;
        size_t count;
        double inertia[3];
        dem_quat turns[3];
        uint64_t steps;
    } cases[] = {
        {cube, 8, {5e-6, 5e-6, 5e-6}, {{0.5, 0.1, -0.7, 0.3}, {0.2, 0.9, 0.1, -0.6}, {0, 1, 1, 0}}, 1500},
        {disc, 5, {5e-6, 5e-6, 8e-6}, {{0.8, 0, 0, 0.6}, {0.1, 0, 0, 0.7}, {0, 0.6, 0.8, 0}}, 1500},
        {odd, 4, {4e-6, 5e-6, 8e-6}, {{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}, 2500},
    };
    for (int c = 0; c < 3; c++) {
        dem_world *plain, *other;
        dem_body_view want, view;
        collide(cases[c].balls, cases[c].count, cases[c].inertia, NOT_TURNED, cases[c].steps, &want, &plain);
        for (int k = 0; k < 3; k++) {
            dem_quat turn = quat_unit(cases[c].turns[k]);
            collide(cases[c].balls, cases[c].count, cases[c].inertia, turn, cases[c].steps, &view, &other);
            for (int i = 0; i < 2; i++) {
                dem_quat back = quat_multiply(view.orientation[i], turn);
                check_vec(view.position[i], want.position[i], 1e-12);
                check_vec(view.velocity[i], want.velocity[i], 1e-12);
                check_vec(view.spin[i], want.spin[i], 1e-12 * 100);
                check_near(angle_between(back, want.orientation[i]), 0, 1e-11);
            }
            dem_world_destroy(other);
        }
        dem_world_destroy(plain);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_free_top_is_where_jacobi_has_it_to_the_second_order),
        cmocka_unit_test(tops_stay_near_the_tables_for_a_hundred_seconds),
        cmocka_unit_test(a_free_top_keeps_its_angular_momentum_and_bounds_its_energy),
        cmocka_unit_test(flips_come_in_time_and_on_their_own_side),
        cmocka_unit_test(a_heavy_top_precesses_steadily),
        cmocka_unit_test(a_sleeping_top_wakes_below_its_limit),
        cmocka_unit_test(needles_and_plates_turn_as_they_should),
        cmocka_unit_test(a_symmetric_body_turns_exactly_at_any_spin),
        cmocka_unit_test(a_sphere_turns_exactly_at_any_spin),
        cmocka_unit_test(a_body_that_turns_by_three_radians_in_a_step_stays_finite),
        cmocka_unit_test(results_do_not_depend_on_the_body_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
