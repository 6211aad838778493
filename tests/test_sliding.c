// Sliding, rolling, tipping and resting on planes and in a cylinder, against rigid bodies with Coulomb's friction.
// PHYSICS 6.2, 6.3.
#include "sim/impact.h"
#include "worlds.h"

static const double RADIUS = 0.01, G = 9.81;

static double sphere_mass(double radius)
{
    return 2500 * 4 * DEM_PI / 3 * radius * radius * radius;
}

static dem_vec3 slope(double angle)
{
    return v3(G * sin(angle), 0, -G * cos(angle));
}

// the plane z = 0 under gravity that leans towards x: stiff, with friction, damped
static model *model_slope(double angle, double friction, double stiffness)
{
    model *m = model_new();
    m->scene.gravity = slope(angle);
    m->laws[0].stiffness = stiffness;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.3;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = friction;
    m->scene.output.energy = false;
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    return m;
}

static double slip_of(const dem_world *w, double arm)
{
    return velocity_before(w, 0).x - arm * spin_before(w, 0).y;
}

// ---- one sphere

// v0 = 1 m/s, no spin: slips until 5/7 of that, at the time and place of PHYSICS 6.2. A tangential dashpot would end
// the sliding at a slip of c / k times its decay, so there is none here.
static void a_sliding_sphere_comes_to_roll_in_time(void **state)
{
    (void)state;
    const double mu = 0.3, k = 1e6;
    double mass = sphere_mass(RADIUS), sinks = mass * G / k;
    check_near(2 / (7 * mu * G), 0.0970826659, 1e-10);
    check_near(12 / (49 * mu * G), 0.0832137136, 1e-10);
    model *m = model_slope(0, mu, k);
    m->laws[0].damping = DEM_DAMPING_NONE;
    m->scene.time.step = dem_linear_duration(mass, k) / 100;
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, RADIUS - sinks))->velocity = v3(1, 0, 0);
    dem_world *w = model_world(m, 1);
    double before = 0, h = m->scene.time.step, slip;
    while ((slip = slip_of(w, RADIUS - sinks)) > 0) {
        before = slip;
        run_steps(w, 1);
    }
    // the slip falls steadily until the very end, from one step after the first; velocities are half a step old
    double t = dem_world_time(w) - h / 2 - h * slip / (slip - before);
    check_near(t, 0.0970826659, h);
    check_near(position_now(w, 0).x, 0.0832137136, 2 * h);
    dem_world_destroy(w);
    model_free(m);
}

// however the sliding ends: angular momentum about the line of contact is kept
static void a_sliding_sphere_ends_at_five_sevenths(void **state)
{
    (void)state;
    const double k = 1e6;
    double mass = sphere_mass(RADIUS), arm = 1 - mass * G / k / RADIUS, end = 1 / (1 + arm * arm / 0.4);
    model *m = model_slope(0, 0.3, k);
    m->scene.time.step = dem_linear_duration(mass, k) / 30;
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, arm * RADIUS))->velocity = v3(1, 0, 0);
    dem_world *w = model_world(m, 1);
    run_steps(w, (uint64_t)(0.2 / m->scene.time.step));
    check_close(velocity_before(w, 0).x, 1 - end, 1e-9);
    check_close(spin_before(w, 0).y * RADIUS * arm, 1 - end, 1e-9);
    check_close(1 - end, 5. / 7, 1e-5);
    dem_world_destroy(w);
    model_free(m);
}

typedef struct run_down {
    double acceleration, spin_up, slip;  // the last: growth of the slip [m/s^2], [rad/s^2], [m/s^2]
} run_down;

// a sphere let go at rest: its rates between one and two units of time
static run_down let_go(double angle, double mu, double time)
{
    const double k = 1e6;
    double mass = sphere_mass(RADIUS), sinks = mass * G * cos(angle) / k;
    model *m = model_slope(angle, mu, k);
    m->scene.time.step = dem_linear_duration(mass, k) / 30;
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, RADIUS - sinks));
    dem_world *w = model_world(m, 1);
    uint64_t steps = (uint64_t)(time / m->scene.time.step);
    run_steps(w, steps);
    double v = velocity_before(w, 0).x, spin = spin_before(w, 0).y;
    double slip = slip_of(w, RADIUS - sinks), t = dem_world_time(w);
    run_steps(w, steps);
    t = dem_world_time(w) - t;
    run_down r = {(velocity_before(w, 0).x - v) / t, (spin_before(w, 0).y - spin) / t,
                  (slip_of(w, RADIUS - sinks) - slip) / t};
    dem_world_destroy(w);
    model_free(m);
    return r;
}

static void a_sphere_rolls_down_as_long_as_friction_can_turn_it(void **state)
{
    (void)state;
    double degree = DEM_PI / 180, limit = atan(3.5 * 0.3);
    check_close(limit / degree, 46.3971810, 1e-9);
    // the arm of friction is shorter than the radius by the overlap
    double arm = 1 - sphere_mass(RADIUS) * G * cos(20 * degree) / 1e6 / RADIUS, inertia = 0.4 / (arm * arm);
    run_down roll = let_go(20 * degree, 0.3, 0.2);
    check_close(roll.acceleration, G * sin(20 * degree) / (1 + inertia), 1e-8);
    check_close(roll.acceleration, 2.39658400, 1e-5);
    check_close(roll.spin_up, roll.acceleration / (arm * RADIUS), 1e-8);
    check_near(roll.slip, 0, 1e-9);
    run_down slide = let_go(20 * degree, 0.05, 0.2);
    check_close(slide.acceleration, 2.89429838, 5e-9);
    check_close(slide.spin_up, 115.229808 * arm, 5e-9);
    // beyond the limit slip grows with g (sin - 3.5 mu cos)
    double over = limit + 0.02 * degree, gains = G * (sin(over) - 1.05 * cos(over));
    check_near(let_go(limit - 0.02 * degree, 0.3, 0.2).slip, 0, 1e-9);
    check_close(let_go(over, 0.3, 0.2).slip, gains, 0.02);
}

// rolls to and fro in a cylinder: a pendulum of 7/5 its length, of any amplitude (elliptic integral by means)
static void a_sphere_rolls_in_a_cylinder_as_a_pendulum(void **state)
{
    (void)state;
    const double k = 1e6, large = 0.08, angle = 0.6;
    double mass = sphere_mass(RADIUS);
    model *m = model_slope(0, 1, k);
    m->walls[0] = (dem_wall_def){.name = "pipe", .kind = DEM_WALL_CYLINDER, .normal = v3(0, 1, 0), .radius = large};
    m->laws[0].damping = DEM_DAMPING_NONE;
    m->scene.time.step = dem_linear_duration(mass, k) / 30;
    double sinks = mass * G * cos(angle) / k, arm = large - RADIUS;
    dem_body_def *b = model_body(m, model_sphere(m, RADIUS), v3(0, 0, 0));
    b->position = v3_scale(v3(sin(angle), 0, -cos(angle)), arm + sinks);
    double x = 1, y = cos(angle / 2);
    for (int i = 0; i < 10; i++) {
        double mean = (x + y) / 2;
        y = sqrt(x * y);
        x = mean;
    }
    double period = 2 * DEM_PI / x * sqrt(7 * arm / (5 * G));
    dem_world *w = model_world(m, 1);
    double last = position_now(w, 0).x, passed = 0, most = 0;
    int passes = 0;
    while (passes < 11) {
        run_steps(w, 1);
        dem_vec3 p = position_now(w, 0);
        if ((p.x < 0) != (last < 0)) {
            passed = dem_world_time(w) - m->scene.time.step * p.x / (p.x - last);
            passes++;
            most = 0;
        }
        most = fmax(most, atan2(fabs(p.x), -p.z));
        last = p.x;
    }
    check_close(passed, 5.25 * period, 1e-5);
    while (velocity_before(w, 0).x * last > 0) {
        run_steps(w, 1);
        last = position_now(w, 0).x;
        most = fmax(most, atan2(fabs(last), -position_now(w, 0).z));
    }
    check_close(most, angle, 5e-6);
    check(position_now(w, 0).y == 0);
    dem_world_destroy(w);
    model_free(m);
}

// ---- blocks

// n x n x n balls, `apart` from each other; mass and moments of separate spheres
static uint32_t model_block(model *m, int n, int high, double apart)
{
    dem_ball balls[32];
    int count = 0;
    double ball = sphere_mass(RADIUS), own = 0.4 * ball * RADIUS * RADIUS, xx = 0, zz = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            for (int k = 0; k < high; k++) {
                dem_vec3 c = v3_scale(v3(i - (n - 1) / 2.0, j - (n - 1) / 2.0, k - (high - 1) / 2.0), apart);
                balls[count++] = (dem_ball){c, RADIUS};
                xx += own + ball * (c.y * c.y + c.z * c.z);
                zz += own + ball * (c.x * c.x + c.y * c.y);
            }
    check(count <= 32);
    return model_clump(m, balls, (size_t)count, count * ball, (double[]){xx, xx, fmax(zz, xx)});
}

static void a_block_slides_down_by_coulomb(void **state)
{
    (void)state;
    const double k = 1e6, angle = 20 * DEM_PI / 180;
    double mass = 16 * sphere_mass(RADIUS);
    model *m = model_slope(angle, 0.3, k);
    m->scene.time.step = dem_linear_duration(sphere_mass(RADIUS), k) / 20;
    uint32_t shape = model_block(m, 4, 1, 2 * RADIUS);
    model_body(m, shape, v3(0, 0, RADIUS - mass * G * cos(angle) / (16 * k)));
    dem_world *w = model_world(m, 1);
    uint64_t steps = (uint64_t)(0.1 / m->scene.time.step);
    run_steps(w, steps);
    double v = velocity_before(w, 0).x, t = dem_world_time(w);
    run_steps(w, steps);
    check_close((velocity_before(w, 0).x - v) / (dem_world_time(w) - t), 0.589702223, 5e-9);
    dem_world_destroy(w);
    model_free(m);
}

// whether a cube of eight balls falls over the edge of its support
static bool tips(double apart, double angle)
{
    const double k = 1e7;
    double mass = 8 * sphere_mass(RADIUS);
    model *m = model_slope(angle, 2, k);
    m->scene.time.step = dem_linear_duration(sphere_mass(RADIUS), k) / 10;
    uint32_t shape = model_block(m, 2, 2, apart);
    model_body(m, shape, v3(0, 0, RADIUS + apart / 2 - mass * G * cos(angle) / (4 * k)));
    dem_world *w = model_world(m, 1);
    double lean = 0;
    while (dem_world_time(w) < 1 && lean < 0.1) {
        run_steps(w, 1000);
        lean = acos(quat_rotate(orientation_now(w, 0), v3(0, 0, 1)).z);
    }
    dem_world_destroy(w);
    model_free(m);
    return lean >= 0.1;
}

static void a_cube_tips_over_the_centres_of_its_balls(void **state)
{
    (void)state;
    const double table[][2] = {{2, 26.5650512}, {1.5, 23.1985905}, {1, 18.4349488}}, degree = DEM_PI / 180;
    for (int i = 0; i < 3; i++) {
        double s = table[i][0] * RADIUS, angle = atan(s / 2 / (RADIUS + s / 2));
        check_close(angle / degree, table[i][1], 1e-8);
        check(!tips(s, angle - 0.1 * degree));
        check(tips(s, angle + 0.1 * degree));
    }
}

// ---- rest

// three balls flat on a slope of 0.8 of the friction's
static void a_clump_at_rest_on_a_slope_does_not_creep(void **state)
{
    (void)state;
    const double k = 1e5, mu = 0.5, angle = atan(0.8 * mu), d = 1.1 * RADIUS;
    double ball = sphere_mass(RADIUS), own = 1.2 * ball * RADIUS * RADIUS;
    double in_plane = own + 1.5 * ball * d * d, across = own + 3 * ball * d * d;
    model *m = model_slope(angle, mu, k);
    m->scene.time.step = dem_linear_duration(ball, k) / 20;
    dem_ball balls[3];
    for (int i = 0; i < 3; i++)
        balls[i] = (dem_ball){v3(d * cos(2 * DEM_PI / 3 * i + 0.2), d * sin(2 * DEM_PI / 3 * i + 0.2), 0), RADIUS};
    uint32_t shape = model_clump(m, balls, 3, 3 * ball, (double[]){in_plane, in_plane, across});
    model_body(m, shape, v3(0, 0, RADIUS));
    dem_world *w = model_world(m, 1);
    run_steps(w, 20000);
    dem_vec3 x = position_now(w, 0);
    dem_quat q = orientation_now(w, 0);
    double t = dem_world_time(w);
    run_steps(w, 200000);
    t = dem_world_time(w) - t;
    // PHYSICS asks for 1e-9 m/s; what is left are the last bits
    check(v3_distance(x, position_now(w, 0)) / t < 1e-17);
    check(angle_between(q, orientation_now(w, 0)) / t < 1e-15);
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sliding_sphere_comes_to_roll_in_time),
        cmocka_unit_test(a_sliding_sphere_ends_at_five_sevenths),
        cmocka_unit_test(a_sphere_rolls_down_as_long_as_friction_can_turn_it),
        cmocka_unit_test(a_sphere_rolls_in_a_cylinder_as_a_pendulum),
        cmocka_unit_test(a_block_slides_down_by_coulomb),
        cmocka_unit_test(a_cube_tips_over_the_centres_of_its_balls),
        cmocka_unit_test(a_clump_at_rest_on_a_slope_does_not_creep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
