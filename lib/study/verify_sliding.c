// Sliding, rolling, tipping and resting on planes and in a cylinder, against rigid bodies with Coulomb's friction.
// PHYSICS 6.2, 6.3, and 1.8 for what resists rolling and twisting.
#include "sim/impact.h"
#include "study/trial.h"
#include "study/verify.h"

static const double RADIUS = 0.01, G = 9.81, DEGREE = DEM_PI / 180;

// the plane z = 0 under gravity that leans towards x: stiff, with friction, damped
static model *slope(dem_trial *t, double angle, double friction, double stiffness)
{
    model *m = dem_trial_model(t);
    m->scene.gravity = v3(G * sin(angle), 0, -G * cos(angle));
    m->laws[0].stiffness = stiffness;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.3;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = friction;
    m->scene.output.energy = false;
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    return m;
}

static double slip_of(dem_motion b, double arm)
{
    return b.velocity.x - arm * b.spin.y;
}

// ---- one sphere

// v0 = 1 m/s, no spin: slips until 5/7 of that, at the time and place of PHYSICS 6.2. A tangential dashpot would end
// the sliding at a slip of c / k times its decay, so there is none at first; however it ends, angular momentum about
// the line of contact is kept.
static void sliding_to_rolling(dem_trial *t)
{
    const double mu = 0.3, k = 1e6;
    double mass = model_ball_mass(RADIUS), sinks = mass * G / k, before = 0, slip;
    model *m = slope(t, 0, mu, k);
    m->laws[0].damping = DEM_DAMPING_NONE;
    double h = m->scene.time.step = dem_linear_duration(mass, k) / 100;
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, RADIUS - sinks))->velocity = v3(1, 0, 0);
    dem_trial_start(t);
    while ((slip = slip_of(dem_trial_body(t, 0), RADIUS - sinks)) > 0 && dem_trial_step(t, 1) &&
           dem_trial_time(t) < 0.2)
        before = slip;
    // the slip falls steadily until the very end
    dem_expect(t, dem_trial_time(t) - h * slip / (slip - before), 0.0970826659, h, "s", "sliding ends at");
    dem_expect(t, dem_trial_body(t, 0).position.x, 0.0832137136, 2 * h, "m", "and after");
    m = slope(t, 0, mu, k);
    m->scene.time.step = dem_linear_duration(mass, k) / 30;
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, RADIUS - sinks))->velocity = v3(1, 0, 0);
    dem_trial_start(t);
    dem_trial_step(t, (uint64_t)(0.2 / m->scene.time.step));
    dem_motion b = dem_trial_body(t, 0);
    double arm = 1 - sinks / RADIUS, end = 1 - 1 / (1 + arm * arm / 0.4);
    dem_expect(t, b.velocity.x, end, 1e-9, "m/s", "final speed, with the arm R - overlap");
    dem_expect(t, b.velocity.x, 5. / 7, 1e-5, "m/s", "final speed");
    dem_expect(t, b.spin.y * RADIUS * arm, end, 1e-9, "m/s", "final spin by the arm");
}

typedef struct run_down {
    double acceleration, spin_up, slip;  // the last: growth of the slip [m/s^2], [rad/s^2], [m/s^2]
} run_down;

// a sphere let go at rest: its rates between one and two units of time
static run_down let_go(dem_trial *t, double angle, double mu)
{
    const double k = 1e6;
    double mass = model_ball_mass(RADIUS), arm = RADIUS - mass * G * cos(angle) / k;
    model *m = slope(t, angle, mu, k);
    m->scene.time.step = dem_linear_duration(mass, k) / 30;
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, arm));
    dem_trial_start(t);
    uint64_t steps = (uint64_t)(0.2 / m->scene.time.step);
    dem_trial_step(t, steps);
    dem_motion a = dem_trial_body(t, 0);
    double time = dem_trial_time(t);
    dem_trial_step(t, steps);
    dem_motion b = dem_trial_body(t, 0);
    time = dem_trial_time(t) - time;
    return (run_down){(b.velocity.x - a.velocity.x) / time, (b.spin.y - a.spin.y) / time,
                      (slip_of(b, arm) - slip_of(a, arm)) / time};
}

static void incline(dem_trial *t)
{
    double limit = atan(3.5 * 0.3);
    dem_expect(t, limit / DEGREE, 46.3971810, 1e-7, "deg", "rolls without slip up to, mu = 0.3");
    // the arm of friction is shorter than the radius by the overlap
    double arm = 1 - model_ball_mass(RADIUS) * G * cos(20 * DEGREE) / 1e6 / RADIUS;
    run_down roll = let_go(t, 20 * DEGREE, 0.3);
    dem_expect(t, roll.acceleration, 2.39658400, 1e-5 * 2.4, "m/s^2", "20 deg, mu = 0.3: acceleration");
    dem_expect(t, roll.acceleration, G * sin(20 * DEGREE) / (1 + 0.4 / (arm * arm)), 1e-8 * 2.4, "m/s^2",
               "20 deg, mu = 0.3: with the arm R - overlap");
    dem_expect(t, roll.spin_up, roll.acceleration / (arm * RADIUS), 1e-8 * 240, "rad/s^2", "20 deg, mu = 0.3: spin up");
    dem_expect(t, roll.slip, 0, 1e-9, "m/s^2", "20 deg, mu = 0.3: slip");
    run_down slide = let_go(t, 20 * DEGREE, 0.05);
    dem_expect(t, slide.acceleration, 2.89429838, 2e-8, "m/s^2", "20 deg, mu = 0.05: acceleration");
    dem_expect(t, slide.spin_up, 115.229808 * arm, 6e-7, "rad/s^2", "20 deg, mu = 0.05: spin up");
    // beyond the limit slip grows with g (sin - 3.5 mu cos)
    double over = limit + 0.02 * DEGREE, gains = G * (sin(over) - 1.05 * cos(over));
    dem_expect(t, let_go(t, limit - 0.02 * DEGREE, 0.3).slip, 0, 1e-9, "m/s^2", "0.02 deg below the limit: slip");
    dem_expect(t, let_go(t, over, 0.3).slip, gains, 0.02 * gains, "m/s^2", "0.02 deg above the limit: slip");
}

// rolls to and fro in a cylinder: a pendulum of 7/5 its length, of any amplitude (elliptic integral by means)
static void pendulum(dem_trial *t)
{
    const double k = 1e6, large = 0.08, angle = 0.6;
    double mass = model_ball_mass(RADIUS), sinks = mass * G * cos(angle) / k, arm = large - RADIUS;
    model *m = slope(t, 0, 1, k);
    m->walls[0] = (dem_wall_def){.name = "pipe", .kind = DEM_WALL_CYLINDER, .normal = v3(0, 1, 0), .radius = large};
    m->laws[0].damping = DEM_DAMPING_NONE;
    double h = m->scene.time.step = dem_linear_duration(mass, k) / 30;
    model_body(m, model_sphere(m, RADIUS), v3_scale(v3(sin(angle), 0, -cos(angle)), arm + sinks));
    double x = 1, y = cos(angle / 2);
    for (int i = 0; i < 10; i++) {
        double mean = (x + y) / 2;
        y = sqrt(x * y);
        x = mean;
    }
    double period = 2 * DEM_PI / x * sqrt(7 * arm / (5 * G)), passed = 0, most = 0;
    dem_trial_start(t);
    double last = dem_trial_body(t, 0).position.x;
    for (int passes = 0; passes < 11 && dem_trial_step(t, 1);) {
        dem_vec3 p = dem_trial_body(t, 0).position;
        if ((p.x < 0) != (last < 0)) {
            passed = dem_trial_time(t) - h * p.x / (p.x - last);
            passes++;
            most = 0;
        }
        most = fmax(most, atan2(fabs(p.x), -p.z));
        last = p.x;
    }
    for (dem_motion b = dem_trial_body(t, 0); b.velocity.x * last > 0 && dem_trial_step(t, 1);) {
        b = dem_trial_body(t, 0);
        last = b.position.x;
        most = fmax(most, atan2(fabs(last), -b.position.z));
    }
    dem_expect(t, passed, 5.25 * period, 1e-5 * 5.25 * period, "s", "5 1/4 periods");
    dem_expect(t, most, angle, 3e-6, "rad", "amplitude after them");
    dem_expect(t, dem_trial_body(t, 0).position.y, 0, 0, "m", "way aside");
}

// ---- blocks

// n x n x high balls, `apart` from each other; mass and moments of separate spheres
static uint32_t block(model *m, int n, int high, double apart)
{
    dem_ball balls[32];
    int count = 0;
    double ball = model_ball_mass(RADIUS), own = 0.4 * ball * RADIUS * RADIUS, xx = 0, zz = 0;
    DEM_ASSERT(n * n * high <= 32);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            for (int k = 0; k < high; k++) {
                dem_vec3 c = v3_scale(v3(i - (n - 1) / 2.0, j - (n - 1) / 2.0, k - (high - 1) / 2.0), apart);
                balls[count++] = (dem_ball){c, RADIUS};
                xx += own + ball * (c.y * c.y + c.z * c.z);
                zz += own + ball * (c.x * c.x + c.y * c.y);
            }
    return model_clump(m, balls, (size_t)count, count * ball, (double[]){xx, xx, fmax(zz, xx)});
}

static void sliding_block(dem_trial *t)
{
    const double k = 1e6, angle = 20 * DEGREE;
    double mass = 16 * model_ball_mass(RADIUS);
    model *m = slope(t, angle, 0.3, k);
    m->scene.time.step = dem_linear_duration(model_ball_mass(RADIUS), k) / 20;
    model_body(m, block(m, 4, 1, 2 * RADIUS), v3(0, 0, RADIUS - mass * G * cos(angle) / (16 * k)));
    dem_trial_start(t);
    uint64_t steps = (uint64_t)(0.1 / m->scene.time.step);
    dem_trial_step(t, steps);
    double v = dem_trial_body(t, 0).velocity.x, time = dem_trial_time(t);
    dem_trial_step(t, steps);
    dem_expect(t, (dem_trial_body(t, 0).velocity.x - v) / (dem_trial_time(t) - time), 0.589702223, 3e-9, "m/s^2",
               "acceleration, 20 deg, mu = 0.3");
}

// how far a cube of eight balls leans over within a second
static double lean(dem_trial *t, double apart, double angle)
{
    const double k = 1e7;
    double mass = 8 * model_ball_mass(RADIUS), lean = 0;
    model *m = slope(t, angle, 2, k);
    m->scene.time.step = dem_linear_duration(model_ball_mass(RADIUS), k) / 10;
    model_body(m, block(m, 2, 2, apart), v3(0, 0, RADIUS + apart / 2 - mass * G * cos(angle) / (4 * k)));
    dem_trial_start(t);
    while (dem_trial_time(t) < 1 && lean < 0.1 && dem_trial_step(t, 1000))
        lean = acos(fmin(quat_rotate(dem_trial_body(t, 0).orientation, v3(0, 0, 1)).z, 1));
    return lean;
}

static void tipping(dem_trial *t)
{
    static const double table[][2] = {{2, 26.5650512}, {1.5, 23.1985905}, {1, 18.4349488}};
    for (int i = 0; i < 3; i++) {
        double s = table[i][0] * RADIUS;
        dem_expect(t, atan(s / 2 / (RADIUS + s / 2)) / DEGREE, table[i][1], 1e-7, "deg", "centres %g R apart: tips at",
                   table[i][0]);
        dem_expect_most(t, lean(t, s, (table[i][1] - 0.1) * DEGREE), 0.01, "rad", "%g R, 0.1 deg below: lean",
                        table[i][0]);
        dem_expect_least(t, lean(t, s, (table[i][1] + 0.1) * DEGREE), 0.1, "rad", "%g R, 0.1 deg above: lean",
                         table[i][0]);
    }
}

// three balls flat on a slope of 0.8 of the friction's; PHYSICS asks for 1e-9 m/s, what is left are the last bits
static void rest_on_slope(dem_trial *t)
{
    const double k = 1e5, mu = 0.5, d = 1.1 * RADIUS;
    double ball = model_ball_mass(RADIUS), own = 1.2 * ball * RADIUS * RADIUS;
    double in_plane = own + 1.5 * ball * d * d, across = own + 3 * ball * d * d;
    model *m = slope(t, atan(0.8 * mu), mu, k);
    m->scene.time.step = dem_linear_duration(ball, k) / 20;
    dem_ball balls[3];
    for (int i = 0; i < 3; i++)
        balls[i] = (dem_ball){v3(d * cos(2 * DEM_PI / 3 * i + 0.2), d * sin(2 * DEM_PI / 3 * i + 0.2), 0), RADIUS};
    model_body(m, model_clump(m, balls, 3, 3 * ball, (double[]){in_plane, in_plane, across}), v3(0, 0, RADIUS));
    dem_trial_start(t);
    dem_trial_step(t, 20000);
    dem_motion a = dem_trial_body(t, 0);
    double time = dem_trial_time(t);
    dem_trial_step(t, 200000);
    dem_motion b = dem_trial_body(t, 0);
    time = dem_trial_time(t) - time;
    dem_expect_most(t, v3_distance(a.position, b.position) / time, 1e-17, "m/s", "creep");
    dem_expect_most(t, angle_between(a.orientation, b.orientation) / time, 1e-15, "rad/s", "turning");
}

// ---- what resists rolling and twisting

static model *ball_on_plane(dem_trial *t, dem_rolling_law rolling, double coefficient, double angle)
{
    model *m = slope(t, angle, 0.8, 1e5);
    m->laws[0].rolling = rolling;
    m->laws[0].rolling_coefficient = coefficient;
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, RADIUS - model_ball_mass(RADIUS) * G * cos(angle) / 1e5));
    return m;
}

static const char *const rolling_names[] = {"", "bounded", "epsd", "constant"};

// without slip, (m + I / R^2) a = F - M / R
static void rolling_friction(dem_trial *t)
{
    const double mu = 0.05;
    for (int rolling = DEM_ROLLING_BOUNDED; rolling <= DEM_ROLLING_CONSTANT; rolling++) {
        model *m = ball_on_plane(t, (dem_rolling_law)rolling, mu, 0);
        m->bodies[0].velocity = v3(0.5, 0, 0);
        m->bodies[0].spin = v3(0, 0.5 / RADIUS, 0);
        dem_trial_start(t);
        dem_trial_step(t, 5000);  // the springs are at their caps
        double v = dem_trial_body(t, 0).velocity.x, want = 5.0 / 7 * mu * G;
        dem_trial_step(t, 20000);
        dem_expect(t, (v - dem_trial_body(t, 0).velocity.x) / 0.2, want, 2e-3 * want, "m/s^2",
                   "%s: slowed by (5/7) mu_r g", rolling_names[rolling]);
    }
    // the moment of the weight about the contact is m g R sin, the resistance mu R m g cos
    for (int rolling = DEM_ROLLING_BOUNDED; rolling <= DEM_ROLLING_EPSD; rolling++)
        for (int over = 0; over < 2; over++) {
            double angle = atan(mu * (over ? 1.2 : 0.9)),
                   want = over ? 5.0 / 14 * G * (sin(angle) - mu * cos(angle)) : 0;
            ball_on_plane(t, (dem_rolling_law)rolling, mu, angle);
            dem_trial_start(t);
            dem_trial_step(t, 50000);
            // less what the spring took to its cap
            dem_expect(t, dem_trial_body(t, 0).velocity.x, want, over ? 0.05 * want : 1e-6, "m/s",
                       "%s: speed after 0.5 s, slope %s the resistance", rolling_names[rolling],
                       over ? "above" : "below");
        }
}

// a ball that spins about the normal: I dw/dt = -M
static void twisting_friction(dem_trial *t)
{
    static const char *const names[] = {"", "marshall", "constant"};
    double load = model_ball_mass(RADIUS) * G, patch = sqrt(RADIUS * load / 1e5);
    for (int twisting = DEM_TWISTING_MARSHALL; twisting <= DEM_TWISTING_CONSTANT; twisting++) {
        model *m = ball_on_plane(t, DEM_ROLLING_NONE, 0, 0);
        m->laws[0].twisting = (dem_twisting_law)twisting;
        m->laws[0].twisting_coefficient = 0.02;
        m->bodies[0].spin = v3(0, 0, 40);
        double moment = twisting == DEM_TWISTING_CONSTANT ? 0.02 * RADIUS * load : 2.0 / 3 * 0.8 * patch * load;
        double want = moment / (0.4 * model_ball_mass(RADIUS) * RADIUS * RADIUS);
        dem_trial_start(t);
        dem_trial_step(t, 2000);
        double w = dem_trial_body(t, 0).spin.z;
        dem_trial_step(t, 5000);
        dem_expect(t, (w - dem_trial_body(t, 0).spin.z) / 0.05, want, 1e-6 * want, "rad/s^2", "%s: spin is slowed by",
                   names[twisting]);
    }
}

const dem_case dem_verify_sliding[] = {
    {"slide-to-roll", "a sliding sphere comes to roll", "rigid body, 5/7", false, sliding_to_rolling},
    {"incline", "a sphere rolls or slides down a slope", "rigid body", false, incline},
    {"pipe", "a sphere rolls to and fro in a cylinder", "pendulum of 7/5 of the length", false, pendulum},
    {"sliding-block", "a block of 16 balls slides down a slope", "Coulomb", false, sliding_block},
    {"tipping", "a cube of 8 balls tips over on a slope", "statics", false, tipping},
    {"rest-on-slope", "a clump at rest on a slope does not creep", "statics", false, rest_on_slope},
    {"rolling-friction", "a ball is slowed, held on a slope, or rolls", "rigid body, 5/7 mu_r g", false,
     rolling_friction},
    {"twisting-friction", "a ball that spins on a plane is slowed", "Marshall 2009", false, twisting_friction},
    {0},
};
