// Laws beyond springs and dashpots: friction that is larger at rest, cohesion that breaks, drag of a fluid.
// PHYSICS 1.1, 1.6 and 3.
#include "sim/impact.h"
#include "study/trial.h"
#include "study/verify.h"

static const double RADIUS = 0.01, G = 9.81;

// ---- friction that is larger at rest

// three balls that cannot roll on a slope of tan = 0.4, with friction 0.5 at rest and 0.3 in motion; speed after 0.05 s
static double on_slope(dem_trial *t, double decay, double speed)
{
    model *m = dem_trial_model(t);
    double angle = atan(0.4), k = 1e6, mass = 3 * model_ball_mass(RADIUS), d = 1.2 * RADIUS;
    m->scene.gravity = v3(G * sin(angle), 0, -G * cos(angle));
    dem_pair_law *law = &m->laws[0];
    law->stiffness = k;
    law->damping = DEM_DAMPING_RESTITUTION;
    law->restitution = 0.3;
    law->friction = DEM_FRICTION_LINEAR;
    law->friction_coefficient = 0.3;
    law->static_coefficient = 0.5;
    law->friction_decay = decay;
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_ball balls[3];
    for (int i = 0; i < 3; i++)
        balls[i] = (dem_ball){v3(d * cos(2 * DEM_PI / 3 * i), d * sin(2 * DEM_PI / 3 * i), 0), RADIUS};
    double own = 0.4 * mass * RADIUS * RADIUS, in_plane = own + mass / 2 * d * d, across = own + mass * d * d;
    m->scene.time.step = dem_linear_duration(mass / 3, k) / 40;
    model_body(m, model_clump(m, balls, 3, mass, (double[]){in_plane, in_plane, across}),
               v3(0, 0, RADIUS - mass * G * cos(angle) / (3 * k)))
        ->velocity = v3(speed, 0, 0);
    dem_trial_start(t);
    dem_trial_step(t, (uint64_t)(0.05 / m->scene.time.step));
    return dem_trial_body(t, 0).velocity.x - speed;
}

static void static_friction(dem_trial *t)
{
    double angle = atan(0.4), gain = G * (sin(angle) - 0.3 * cos(angle)) * 0.05,
           brake = G * (sin(angle) - 0.5 * cos(angle)) * 0.05;
    dem_expect(t, on_slope(t, 100, 0), 0, 1e-6, "m/s", "at rest it stays: speed after 0.05 s");
    dem_expect(t, on_slope(t, 100, 1), gain, 2e-3 * gain, "m/s", "in motion it slides on: gain in 0.05 s");
    // with a small decay the friction at 1 m/s is still nearly that at rest
    dem_expect(t, on_slope(t, 1e-6, 1), brake, 2e-3 * fabs(brake), "m/s",
               "decay 0: friction of rest slows it: gain in 0.05 s");
}

// ---- cohesion that breaks

static const double K = 1e4, TENSION = 2, SHEAR = 3;  // [N/m], [N], [N]

// two heavy spheres that move against each other steadily
static void bonded_pair(dem_trial *t, double overlap, dem_vec3 velocity)
{
    model *m = dem_trial_model(t);
    m->materials[0].density = 1e12;
    dem_pair_law *law = &m->laws[0];
    law->stiffness = K;
    law->stiffness_ratio = 0.5;
    law->friction = DEM_FRICTION_LINEAR;
    law->friction_coefficient = 0.2;
    law->cohesion = DEM_COHESION_BREAKABLE;
    law->bond_tension = TENSION;
    law->bond_shear = SHEAR;
    uint32_t ball = model_sphere(m, RADIUS);
    m->scene.time.step = 1e-6;
    model_body(m, ball, v3(0, 0, 0));
    model_body(m, ball, v3(2 * RADIUS - overlap, 0, 0))->velocity = velocity;
    dem_trial_start(t);
}

static void cohesion(dem_trial *t)
{
    size_t count;
    double most = 0, at = 0, after = 0;
    bonded_pair(t, 1e-5, v3(1e-2, 0, 0));
    while (dem_trial_step(t, 1) && dem_trial_time(t) < 0.03) {
        const dem_contact *c = dem_trial_contacts(t, &count);
        double pull = c ? -c->normal_force : 0;
        double gap = dem_trial_body(t, 1).position.x - dem_trial_body(t, 0).position.x - 2 * RADIUS;
        if (pull > most) {
            most = pull;
            at = gap;
        }
        after = pull;
    }
    // a step is 1e-8 m
    dem_expect(t, most, TENSION, 2e-8 * K, "N", "largest pull");
    dem_expect(t, at, TENSION / K, 2e-8, "m", "gap at breaking");
    dem_expect(t, after, 0, 0, "N", "pull after it");
    double largest = 0, deep = 2e-4;
    bonded_pair(t, deep, v3(0, 1e-1, 0));
    const dem_contact *c = NULL;
    while (dem_trial_step(t, 1) && dem_trial_time(t) < 0.01 && (c = dem_trial_contacts(t, &count)))
        largest = fmax(largest, v3_norm(c->friction_force));
    // the friction spring grows by k_t v h = 5e-4 N a step
    dem_expect(t, largest, SHEAR, 1e-3, "N", "largest shear");
    c = dem_trial_contacts(t, &count);
    dem_expect(t, c ? v3_norm(c->friction_force) : NAN, c ? 0.2 * c->normal_force : 0, 1e-9, "N",
               "broken, it slides with mu F_n");
}

// ---- drag

// Schiller & Naumann
static double drag_of(double speed, double diameter, double density, double viscosity)
{
    double re = density * speed * diameter / viscosity;
    double c = re < 1000 ? 24 / re * (1 + 0.15 * pow(re, 0.687)) : 0.44;
    return c * DEM_PI / 8 * density * diameter * diameter * speed * speed;
}

static void drag(dem_trial *t)
{
    static const struct {
        const char *fluid;
        double diameter, density, viscosity;
        bool buoyancy;
    } cases[] = {{"water, 0.1 mm", 1e-4, 1000, 1e-3, true},
                 {"water, 1 mm", 1e-3, 1000, 1e-3, true},
                 {"water, 1 mm, no buoyancy", 1e-3, 1000, 1e-3, false},
                 {"air, 1 mm", 1e-3, 1.2, 1.8e-5, false},
                 {"air, 3 mm", 3e-3, 1.2, 1.8e-5, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        model *m = dem_trial_model(t);
        double d = cases[i].diameter, weight = model_ball_mass(d / 2) * G;
        weight *= cases[i].buoyancy ? 1 - cases[i].density / 2500 : 1;
        m->scene.gravity = v3(0, 0, -G);
        m->scene.damping.drag = (dem_drag_def){cases[i].density, cases[i].viscosity, {0, 0, 0}, cases[i].buoyancy};
        double low = 0, high = 1e4;
        for (int k = 0; k < 200; k++) {
            double v = (low + high) / 2;
            *(drag_of(v, d, cases[i].density, cases[i].viscosity) < weight ? &low : &high) = v;
        }
        m->scene.time.step = fmin(low / G / 200, 0.2 * d / low);
        model_body(m, model_sphere(m, d / 2), v3(0, 0, 0))->velocity = v3(0, 0, -0.7 * low);
        dem_trial_start(t);
        dem_trial_step(t, (uint64_t)(14 * low / (weight / model_ball_mass(d / 2)) / m->scene.time.step));
        dem_expect(t, -dem_trial_body(t, 0).velocity.z, low, 1e-5 * low, "m/s", "%s: terminal speed", cases[i].fluid);
    }
}

const dem_case dem_verify_laws[] = {
    {"static-friction", "friction that is larger at rest, on a slope between", "Coulomb", false, static_friction},
    {"breakable-cohesion", "pulled and sheared until it breaks", "strengths", false, cohesion},
    {"drag", "terminal speeds of spheres in water and air", "Schiller & Naumann 1933", false, drag},
    {0},
};
