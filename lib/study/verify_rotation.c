// The rotation of bodies against exact solutions: free tops, the heavy top, fast spins. PHYSICS 2.3 and 6.3; the
// figures of the default scheme there are the bounds here.
#include "study/trial.h"
#include "study/verify.h"

static const dem_quat NOT_TURNED = {1, 0, 0, 0};

// a body alone in space, one ball with the moments given; spin along the principal axes
static void lone_body(dem_trial *t, const double inertia[3], double radius, double mass, dem_quat q, dem_vec3 spin,
                      double step)
{
    model *m = dem_trial_model(t);
    m->scene.time.step = step;
    model_clump(m, (dem_ball[]){{{0, 0, 0}, radius}}, 1, mass, inertia);
    dem_body_def *b = model_body(m, 0, v3(0, 0, 0));
    b->orientation = q;
    b->spin = quat_rotate(quat_unit(q), spin);
    dem_trial_start(t);
}

static dem_vec3 own_spin(dem_trial *t)
{
    dem_motion b = dem_trial_body(t, 0);
    return dem_motion_own_spin(&b);
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

static void free_top(dem_trial *t)
{
    double turned[3], spin[3];
    for (int i = 0; i < 3; i++) {
        int per_second = 14 << i;  // |w| h = 0.1 first
        lone_body(t, ONE_TWO_THREE, 1, 1, NOT_TURNED, TOP_SPIN, 1.0 / per_second);
        dem_trial_step(t, 10 * (uint64_t)per_second);
        turned[i] = angle_between(dem_trial_body(t, 0).orientation, TOP_AT_10);
        spin[i] = v3_distance(own_spin(t), TOP_SPIN_AT_10);
    }
    dem_expect_most(t, turned[0], 8e-4, "rad", "orientation after 10 s, off by");  // a tenth of the bound for 100 s
    for (int i = 0; i < 2; i++) {
        // the next order is h^2 = 0.01 of this one
        dem_expect(t, turned[i] / turned[i + 1], 4, 0.04, "", "orientation: half the step, off by 1/");
        dem_expect(t, spin[i] / spin[i + 1], 4, 0.04, "", "spin: half the step, off by 1/");
    }
}

// what the spin and the orientation say of L, and the energy: bounded, without a trend
static void free_top_long(dem_trial *t)
{
    dem_vec3 l0 = times_inertia(ONE_TWO_THREE, TOP_SPIN);
    double e0 = energy_of(ONE_TWO_THREE, TOP_SPIN), most[2] = {0}, off = 0;
    lone_body(t, ONE_TWO_THREE, 1, 1, NOT_TURNED, TOP_SPIN, 1.0 / 14);
    for (int i = 0; i < 140000 && dem_trial_step(t, 1); i++) {
        dem_motion b = dem_trial_body(t, 0);
        dem_vec3 spin = dem_motion_own_spin(&b);
        off = fmax(off, v3_distance(quat_rotate(b.orientation, times_inertia(ONE_TWO_THREE, spin)), l0));
        most[i >= 70000] = fmax(most[i >= 70000], fabs(energy_of(ONE_TWO_THREE, spin) / e0 - 1));
    }
    dem_expect_most(t, off / v3_norm(l0), 1e-13, "", "angular momentum within 10000 s, off by");
    dem_expect_most(t, most[0], 8e-5, "", "energy within 5000 s, off by");  // 7.5e-5 in the table, at this step
    dem_expect(t, most[1], most[0], 1e-3 * most[0], "", "energy within the second 5000 s, off by");
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
static double last_flip(dem_trial *t, dem_vec3 spin, int side, double step, int *flips, double *least)
{
    double last = spin.y, time = 0;
    *flips = 0;
    *least = INFINITY;
    lone_body(t, ONE_TWO_THREE, 1, 1, NOT_TURNED, spin, step);
    while (dem_trial_time(t) < 1000 && dem_trial_step(t, 1)) {
        dem_vec3 now = own_spin(t);
        *least = fmin(*least, v3_get(now, side));
        if ((now.y < 0) != (last < 0)) {
            time = dem_trial_time(t) - step * now.y / (now.y - last);
            (*flips)++;
        }
        last = now.y;
    }
    return time;
}

// a hair beside the middle axis, towards the axis of the smallest or of the largest moment: the spin about that axis
// never changes its sign, however often the body turns over, and always comes back to its least
static void dzhanibekov(dem_trial *t)
{
    dem_expect(t, time_between_flips(ONE_TWO_THREE, v3(1e-3, 1, 0)), 28.7314244372, 1e-9, "s", "time between flips");
    for (int side = 0; side < 3; side += 2) {
        const char *axis = side ? "third" : "first";
        dem_vec3 spin = side ? v3(0, 1, 1e-3) : v3(1e-3, 1, 0);
        double between = time_between_flips(ONE_TWO_THREE, spin), off[2], least;
        for (int i = 0; i < 2; i++) {
            int flips;
            double time = last_flip(t, spin, side, 0.1 / (1 << i), &flips, &least);
            dem_expect(t, flips, floor(1000 / between + 0.5), 0, "", "near the %s axis: flips within 1000 s", axis);
            off[i] = time / ((flips - 0.5) * between) - 1;
            dem_expect(t, least, 1e-3, 1e-5, "rad/s", "near the %s axis: least spin about it", axis);
        }
        dem_expect(t, off[0], 0, 2e-4, "", "near the %s axis: time of the last flip, off by", axis);  // (w h)^2 / 50
        dem_expect(t, off[0] / off[1], 4, 0.04, "", "near the %s axis: half the step, off by 1/", axis);
    }
}

// ---- the heavy top, on its pivot

static const double TOP[3] = {0.2, 0.2, 0.3}, TOP_WEIGHT = 2;  // m g l [N m]

static void top_at(dem_trial *t, double theta, double precession, double spin, double step)
{
    dem_vec3 axis = v3(0, -sin(theta), cos(theta)), up = v3(0, 0, 1);
    dem_quat q = quat_about(v3(theta, 0, 0));
    dem_vec3 turning = v3_along(v3_scale(axis, spin), precession, v3_along(up, -cos(theta), axis));
    lone_body(t, TOP, 1, 1, q, quat_unrotate(q, turning), step);
}

static dem_vec3 top_axis(dem_trial *t)
{
    return quat_rotate(dem_trial_body(t, 0).orientation, v3(0, 0, 1));
}

static void top_step(dem_trial *t)
{
    dem_vec3 moment = v3_scale(v3_cross(top_axis(t), v3(0, 0, -1)), TOP_WEIGHT);
    if (t->world)
        dem_world_push(t->world, 0, v3(0, 0, 0), moment);
    dem_trial_step(t, 1);
}

// after a time at the rate W of steady precession, I1 W^2 cos(tilt) - I3 w W + m g l = 0: how far the axis is off in
// azimuth, and at most in tilt
static void precess(dem_trial *t, double theta, double rate, double time, int steps, double *azimuth, double *tilt)
{
    top_at(t, theta, rate, 20, time / steps);
    *tilt = 0;
    for (int k = 0; k < steps && t->status == DEM_OK; k++) {
        top_step(t);
        *tilt = fmax(*tilt, fabs(acos(top_axis(t).z) - theta));
    }
    dem_vec3 axis = top_axis(t);
    *azimuth = fabs(remainder(atan2(axis.x, -axis.y) - time * rate, 2 * DEM_PI));
}

static void heavy_top(dem_trial *t)
{
    double theta = DEM_PI / 6, a = TOP[0] * cos(theta), b = TOP[2] * 20, root = sqrt(b * b - 4 * a * 2);
    double slow = (b - root) / (2 * a), fast = (b + root) / (2 * a), azimuth[2], tilt[2];
    dem_expect(t, slow, 0.336604089, 1e-9, "rad/s", "slow precession");
    dem_expect(t, fast, 34.3044121, 1e-7, "rad/s", "fast precession");
    for (int i = 0; i < 2; i++)
        precess(t, theta, slow, 20, 4200 << i, &azimuth[i], &tilt[i]);  // w h = 0.095, 0.048
    // 1.94e-5 and 7.28e-5 in the table
    dem_expect_most(t, tilt[0], 2e-5, "rad", "slow, tilt within 20 s, off by");
    dem_expect_most(t, azimuth[0] * sin(theta), 8e-5, "rad", "slow, azimuth after 20 s, off by");
    dem_expect(t, tilt[0] / tilt[1], 4, 0.04, "", "tilt: half the step, off by 1/");
    dem_expect(t, azimuth[0] / azimuth[1], 4, 0.04, "", "azimuth: half the step, off by 1/");
    precess(t, theta, fast, 1, 10000, &azimuth[0], &tilt[0]);
    dem_expect_most(t, tilt[0], 1e-7, "rad", "fast, tilt within 1 s, off by");
    dem_expect_most(t, azimuth[0], 1e-6, "rad", "fast, azimuth after 1 s, off by");
}

// w3 = 2 sqrt(m g l I1) / I3 = 4.2164: faster ones sleep, slower ones fall at the rate of the linear theory
static void sleeping_top(dem_trial *t)
{
    for (int slow = 0; slow < 2; slow++) {
        double spin = slow ? 4.2 : 4.23, tilt = 1e-7, most = 0, at[2] = {0};
        double half = TOP[2] * spin / (2 * TOP[0]), rate2 = TOP_WEIGHT / TOP[0] - half * half;
        // turning with the half of I3 w3 / I1, the linear motion is cosh(rate t) there
        top_at(t, tilt, half, spin, 0.005);
        for (int k = 0; k <= 5000 && t->status == DEM_OK; k++) {
            top_step(t);
            dem_vec3 axis = top_axis(t);
            double now = hypot(axis.x, axis.y);
            most = fmax(most, now);
            if (k == 3000 || k == 5000)
                at[k == 5000] = now;
        }
        if (slow)
            dem_expect(t, log(at[1] / at[0]) / 10, sqrt(rate2), 2e-3 * sqrt(rate2), "1/s", "w3 = 4.2: rate of falling");
        else
            dem_expect_most(t, most / tilt, 1.01, "", "w3 = 4.23: tilt within 25 s over the tilt at first");
    }
}

// ---- fast spins

// a symmetric body turns about L by |L| t / I and about its own axis by what is left: exact whatever the step
static void fast_spin(dem_trial *t)
{
    static const double mass = 2.1e-5,
                        inertia[3][3] = {{1e-11, 3e-11, 3e-11}, {2e-11, 2e-11, 3.5e-11}, {1e-11, 1e-11, 1e-11}};
    static const char *const names[] = {"needle", "disc", "sphere"};
    for (int kind = 0; kind < 3; kind++) {
        const double *i = inertia[kind], across = i[1];
        dem_vec3 spin = v3_scale(v3(0.8, 0.36, 0.48), 1e5), l = times_inertia(i, spin);
        dem_quat q0 = quat_unit((dem_quat){0.3, -0.5, 0.7, 0.2});
        lone_body(t, i, 1e-3, mass, q0, spin, 1e-5);  // a radian in a step
        dem_trial_step(t, 20000);
        double time = dem_trial_time(t), e0 = energy_of(i, spin);
        dem_vec3 own =
            kind == 1 ? v3(0, 0, (1 / i[2] - 1 / across) * l.z * time) : v3((1 / i[0] - 1 / across) * l.x * time, 0, 0);
        dem_quat want =
            quat_multiply(quat_multiply(quat_about(v3_scale(quat_rotate(q0, l), time / across)), q0), quat_about(own));
        dem_quat q = dem_trial_body(t, 0).orientation;
        dem_expect(t, sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z), 1, 1e-13, "", "%s: norm", names[kind]);
        dem_expect(t, energy_of(i, own_spin(t)) / e0, 1, 1e-12, "", "%s: energy", names[kind]);
        // 2e4 radians, at a rate that is as good as the energy
        dem_expect_most(t, angle_between(q, want), 2e4 * 1e-13, "rad", "%s: orientation after 20000 rad", names[kind]);
    }
}

static void three_radians_a_step(dem_trial *t)
{
    double e0 = energy_of(ONE_TWO_THREE, TOP_SPIN), most = 0;
    lone_body(t, ONE_TWO_THREE, 1, 1, NOT_TURNED, TOP_SPIN, 3 / v3_norm(TOP_SPIN));
    for (int i = 0; i < 20000 && dem_trial_step(t, 1); i++)
        most = fmax(most, fabs(energy_of(ONE_TWO_THREE, own_spin(t)) / e0 - 1));
    // ten turns of 0.3 a step: 9 times what 0.1 gives, 7.5e-5
    dem_expect_most(t, most, 1e-3, "", "energy within 20000 steps, off by");
}

const dem_case dem_verify_rotation[] = {
    {"free-top", "an asymmetric top after 10 s", "Jacobi's functions", false, free_top},
    {"free-top-long", "an asymmetric top within 10000 s", "conserved quantities", false, free_top_long},
    {"dzhanibekov", "a body that turns over about its middle axis", "Jacobi's functions", false, dzhanibekov},
    {"heavy-top", "a top on its pivot precesses steadily", "Euler's equations", false, heavy_top},
    {"sleeping-top", "an upright top sleeps or falls", "linear theory", false, sleeping_top},
    {"fast-spin", "symmetric bodies at 1e5 rad/s", "exact rotation", false, fast_spin},
    {"fast-spin-steps", "a top that turns by three radians in a step", "conserved quantities", false,
     three_radians_a_step},
    {0},
};
