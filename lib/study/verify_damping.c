// Local (Cundall) and global viscous damping against their exact consequences. PHYSICS 3.
#include "sim/impact.h"
#include "study/trial.h"
#include "study/verify.h"

static const double RADIUS = 0.01, G = 9.81;

static double acceleration(dem_trial *t, double local, bool exclude_gravity, dem_local_frame frame, double upwards)
{
    model *m = dem_trial_model(t);
    m->scene.gravity = v3(0, 0, -G);
    m->scene.damping.local = local;
    m->scene.damping.exclude_gravity = exclude_gravity;
    m->scene.damping.local_frame = frame;
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, 1))->velocity = v3(0, 0, upwards);
    dem_trial_start(t);
    dem_trial_step(t, 1);
    double before = dem_trial_body(t, 0).velocity.z;
    dem_trial_step(t, 1000);
    return (dem_trial_body(t, 0).velocity.z - before) / (1000 * m->scene.time.step);
}

static void local_fall(dem_trial *t)
{
    for (int frame = 0; frame < 2; frame++) {
        const char *name = frame ? "vector" : "space";
        dem_local_frame f = (dem_local_frame)frame;
        dem_expect(t, acceleration(t, 0.7, false, f, -1), -2.943, 1e-9, "m/s^2", "%s, 0.7: falling", name);
        dem_expect(t, acceleration(t, 0.7, false, f, 1), -16.677, 1e-9, "m/s^2", "%s, 0.7: rising", name);
        dem_expect(t, acceleration(t, 0.7, true, f, -1), -G, 1e-9, "m/s^2", "%s, without gravity: falling", name);
        dem_expect(t, acceleration(t, 0.7, true, f, 1), -G, 1e-9, "m/s^2", "%s, without gravity: rising", name);
    }
}

// e = sqrt((1 - a) / (1 + a)) at every speed, and a quarter of the period slowed and one hastened. 5000 steps; the
// table has seven digits
static void local_restitution(dem_trial *t)
{
    static const double table[][2] = {
        {0.1, 0.9045340}, {0.3, 0.7337994}, {0.5, 0.5773503}, {0.7, 0.4200840}, {0.8, 1. / 3}};
    double k = 1e6, contact = dem_linear_duration(model_ball_mass(RADIUS), k);
    for (int i = 0; i < 5; i++)
        for (int fast = 0; fast < 2; fast++) {
            double alpha = table[i][0], speed = fast ? 1 : 0.01, z = RADIUS;
            model *m = dem_trial_model(t);
            m->laws[0].stiffness = k;
            m->scene.time.step = contact / 5000;
            m->scene.damping.local = alpha;
            model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
            model_body(m, model_sphere(m, RADIUS), v3(0, 0, z))->velocity = v3(0, 0, -speed);
            dem_trial_start(t);
            while (dem_trial_step(t, 1) && (z = dem_trial_body(t, 0).position.z) < RADIUS)
                ;
            dem_expect(t, dem_trial_body(t, 0).velocity.z / speed, table[i][1], 2e-7, "", "%g, %g m/s: restitution",
                       alpha, speed);
            dem_expect(t, dem_trial_time(t) / contact, (1 / sqrt(1 + alpha) + 1 / sqrt(1 - alpha)) / 2, 1.5 / 5000, "",
                       "%g, %g m/s: duration over the undamped one", alpha, speed);
        }
}

// a sphere that lies on a plane and never leaves it: (1 - a) / (1 + a) a cycle
static void local_oscillator(dem_trial *t)
{
    for (int i = 1; i < 8; i += 3) {
        double alpha = 0.1 * i, mass = model_ball_mass(RADIUS), k = 1e4, lies = RADIUS - mass * G / k;
        model *m = dem_trial_model(t);
        m->scene.gravity = v3(0, 0, -G);
        m->scene.damping.local = alpha;
        m->scene.time.step = dem_linear_duration(mass, k) / 5000;
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        model_body(m, model_sphere(m, RADIUS), v3(0, 0, lies + 0.9 * mass * G / k));
        dem_trial_start(t);
        double highest[3] = {0.9 * mass * G / k}, last = 0;
        for (int cycle = 1; cycle < 3 && dem_trial_step(t, 1);) {
            dem_motion b = dem_trial_body(t, 0);
            if (b.velocity.z < 0 && last > 0)
                highest[cycle++] = b.position.z - lies;
            last = b.velocity.z;
        }
        double ratio = (1 - alpha) / (1 + alpha);
        dem_expect(t, highest[1] / highest[0], ratio, 1e-6, "", "%g: amplitude after the first cycle", alpha);
        dem_expect(t, highest[2] / highest[1], ratio, 1e-6, "", "%g: amplitude after the second", alpha);
    }
}

// of first order: (1 - c h)^n is off by c^2 h t / 2 of itself
static void viscous(dem_trial *t)
{
    const double c = 25;
    model *m = dem_trial_model(t);
    m->scene.time.step = 1e-4;
    m->scene.damping.viscous = c;
    dem_body_def *b = model_body(m, model_cloud(m, 5, 0.02, 1), v3(0, 0, 0));
    b->velocity = v3(3, 0, 0);
    m->scene.gravity = v3(0, 0, -G);
    dem_trial_start(t);
    dem_trial_step(t, 1000);
    dem_expect(t, dem_trial_body(t, 0).velocity.x, 3 * exp(-c * 0.1), 8e-4, "m/s", "speed aside after 0.1 s");
    dem_trial_step(t, 19000);
    dem_expect(t, dem_trial_body(t, 0).velocity.z, -G / c, 2e-3 * G / c, "m/s", "terminal speed, g / c");
}

const dem_case dem_verify_damping[] = {
    {"local-damping-fall", "local damping: free fall and rise", "(1 -+ a) g", false, local_fall},
    {"local-damping-restitution", "local damping: restitution of a linear contact", "sqrt((1 - a) / (1 + a))", false,
     local_restitution},
    {"local-damping-decay", "local damping: an oscillator that never parts", "(1 - a) / (1 + a) a cycle", false,
     local_oscillator},
    {"viscous-damping", "global viscous damping: decay and terminal speed", "exponential, g / c", false, viscous},
    {0},
};
