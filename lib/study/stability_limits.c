// The largest stable step of systems that can be solved by hand: predicted by the engine, and found by bisection.
// PHYSICS 2.1, 4 and 6.4.
#include <math.h>
#include <stdio.h>

#include "study/stability.h"

static const double RADIUS = 0.01, STIFFNESS = 1e4, DEEP = 1e-4, NUDGE = 1e-10;

// of a sphere on one spring [rad/s]
static double frequency(void)
{
    return sqrt(STIFFNESS / model_ball_mass(RADIUS));
}

static dem_limit find(dem_trial *t, void (*make)(dem_trial *, const void *), const void *user, const char *curve)
{
    return dem_limit_find(t, &(dem_limit_def){make, user, NUDGE * frequency(), RADIUS, 3000, curve});
}

// rough enough never to slide
static void stick(model *m, double ratio)
{
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 1e3;
    m->laws[0].stiffness_ratio = ratio;
}

// planes below and above that press what is between -half and half
static void press(model *m, double half)
{
    model_plane(m, v3(0, 0, DEEP - half), v3(0, 0, 1));
    model_plane(m, v3(0, 0, half - DEEP), v3(0, 0, -1));
}

static void expect_exact(dem_trial *t, const dem_limit *l, double want, const char *what)
{
    // bisection to 1e-4; growth is seen from 1e-5 beyond the limit
    dem_expect(t, l->measured / want, 1, 5e-4, "", "%s: blows up at, over the exact limit", what);
    dem_expect_least(t, l->measured / l->predicted, 1 - 5e-4, "", "%s: blows up at, over the predicted limit", what);
}

// ---- one contact

static void make_single(dem_trial *t, const void *user)
{
    (void)user;
    model *m = t->model;
    press(m, RADIUS);
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, 0));
}

static void single(dem_trial *t)
{
    dem_limit_plot(t);
    dem_limit l = find(t, make_single, NULL, "sphere between planes");
    expect_exact(t, &l, 2 / (sqrt(2) * frequency()), "sphere between planes");
    dem_expect(t, l.predicted * frequency(), sqrt(2), 1e-9, "", "predicted limit times frequency of one spring");
}

// sin(n a) z / sin a with cos a = 1 - z^2 / 2, from x = 0, v = w
static double largest(dem_trial *t, double z, int steps)
{
    model *m = dem_trial_model(t);
    double w = sqrt(2) * frequency(), most = 0;
    make_single(t, NULL);
    m->scene.time.step = z / w;
    m->bodies[0].velocity.z = NUDGE * w;
    dem_trial_start(t);
    for (int i = 0; i < steps && dem_trial_step(t, 1); i++)
        most = fmax(most, fabs(dem_trial_body(t, 0).position.z) / NUDGE);
    return most;
}

static void sweep(dem_trial *t)
{
    dem_trial_plot(t, (dem_plot_axis){.title = "w h"},
                   (dem_plot_axis){.title = "largest swing in 2000 steps", .log = true});
    static const double z[] = {0.5, 0.9, 1.5, 1.7, 1.9, 1.95, 1.99};
    for (size_t i = 0; i < sizeof z / sizeof *z; i++) {
        double got = largest(t, z[i], 2000), want = 1 / sqrt(1 - z[i] * z[i] / 4);
        dem_trial_point(t, "measured", z[i], got);
        // the phase of the largest swing is met within a part of the steps
        dem_expect(t, got, want, 1e-2 * want, "", "w h = %g: largest swing", z[i]);
    }
    double at = largest(t, 2, 1000);
    dem_expect(t, at, 2000, 2, "", "w h = 2: linear growth, after 1000 steps");
    double a = largest(t, 2.01, 30), b = largest(t, 2.01, 60);
    dem_expect(t, log(b / a) / 30, acosh(2.01 * 2.01 / 2 - 1), 1e-4, "", "w h = 2.01: growth of the logarithm a step");
}

// ---- several

// spheres in a row between planes: w^2 = 4 k / m sin^2(n pi / (2 n + 2))
static void make_chain(dem_trial *t, const void *user)
{
    model *m = t->model;
    const int n = *(const int *)user;
    double apart = 2 * RADIUS - DEEP, half = 0.5 * (n - 1) * apart;
    uint32_t shape = model_sphere(m, RADIUS);
    for (int i = 0; i < n; i++) {
        dem_body_def *b = model_body(m, shape, v3(0, 0, i * apart - half));
        b->hold = DEM_LOCK_X | DEM_LOCK_Y | DEM_LOCK_RX | DEM_LOCK_RY | DEM_LOCK_RZ;  // it would buckle
    }
    press(m, half + RADIUS);
}

static void chain(dem_trial *t)
{
    static const int counts[] = {2, 5, 20};
    dem_limit_plot(t);
    for (size_t i = 0; i < 3; i++) {
        char name[40];
        const int n = counts[i];
        snprintf(name, sizeof name, "%d spheres in a row", n);
        dem_limit l = find(t, make_chain, &n, name);
        expect_exact(t, &l, 1 / (frequency() * sin(n * DEM_PI / (2 * n + 2))), name);
    }
}

// n spheres in one place: each takes the whole overlap
static void make_duplicates(dem_trial *t, const void *user)
{
    model *m = t->model;
    const size_t n = *(const size_t *)user;
    dem_ball balls[MODEL_CLOUD];
    for (size_t i = 0; i < n; i++)
        balls[i] = (dem_ball){{0, 0, 0}, RADIUS};
    double mass = model_ball_mass(RADIUS), moment = 0.4 * mass * RADIUS * RADIUS;
    press(m, RADIUS);
    model_body(m, model_clump(m, balls, n, mass, (double[]){moment, moment, moment}), v3(0, 0, 0));
}

static void duplicates(dem_trial *t)
{
    static const size_t counts[] = {1, 4, 30, 300};
    dem_trial_plot(t, (dem_plot_axis){.title = "spheres in one place", .log = true},
                   (dem_plot_axis){.title = "limit of the step [s]", .log = true});
    dem_limit l[4];
    for (size_t i = 0; i < 4; i++) {
        char name[40];
        snprintf(name, sizeof name, "%zu spheres in one place", counts[i]);
        l[i] = find(t, make_duplicates, &counts[i], NULL);
        expect_exact(t, &l[i], 2 / (frequency() * sqrt(2.0 * (double)counts[i])), name);
    }
    for (size_t i = 0; i < 4; i++)
        dem_trial_point(t, "predicted", (double)counts[i], l[i].predicted);
    for (size_t i = 0; i < 4; i++)
        dem_trial_point(t, "measured", (double)counts[i], l[i].measured);
}

// ---- rotation

static void make_rough(dem_trial *t, const void *user)
{
    stick(t->model, 1);
    make_single(t, user);
}

// two spheres 10 radii apart with a hundredth of their moment of inertia
static void make_rod(dem_trial *t, const void *user)
{
    (void)user;
    model *m = t->model;
    const double far = 5 * RADIUS, mass = 2 * model_ball_mass(RADIUS), moment = 0.01 * mass * far * far;
    press(m, RADIUS);
    model_body(m,
               model_clump(m, (dem_ball[]){{{-far, 0, 0}, RADIUS}, {{far, 0, 0}, RADIUS}}, 2, mass,
                           (double[]){0.1 * moment, moment, moment}),
               v3(0, 0, 0));
}

static void rotation(dem_trial *t)
{
    dem_limit_plot(t);
    // both springs of 1e4 N/m turn it, at the planes: 2 k (r - overlap)^2 / (2/5 m r^2)
    dem_limit rough = find(t, make_rough, NULL, "rough sphere between planes");
    expect_exact(t, &rough, 2 / (sqrt(5) * (1 - DEEP / RADIUS) * frequency()), "rough sphere between planes");
    // four springs at 5 radii: 4 k l^2 / I, I = 0.01 m l^2
    dem_limit rod = find(t, make_rod, NULL, "light rod between planes");
    expect_exact(t, &rod, 2 / sqrt(4 * STIFFNESS / (0.02 * model_ball_mass(RADIUS))), "light rod between planes");
}

// ---- dashpots

typedef struct dashpot {
    double ratio;
    bool slide;
} dashpot;

// on a plane by its weight, against which it can move up and down, or along it
static void make_damped(dem_trial *t, const void *user)
{
    model *m = t->model;
    const dashpot *d = user;
    double rate = 2 * d->ratio * frequency();
    m->scene.gravity = v3(0, 0, -DEEP * frequency() * frequency());
    m->laws[0].effective_mass = DEM_MASS_BODY;
    m->laws[0].damping = DEM_DAMPING_RATE;
    m->laws[0].damping_rate = d->slide ? 0 : rate;
    if (d->slide) {
        stick(m, 1);
        m->laws[0].tangential_rate = rate;
    }
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, RADIUS - DEEP))->hold =
        DEM_LOCK_RX | DEM_LOCK_RY | DEM_LOCK_RZ | (d->slide ? DEM_LOCK_Z : DEM_LOCK_X | DEM_LOCK_Y);
}

// z^2 + 4 ratio z / (1 + ratio z / 2) = 4: normal dashpots are corrected for the velocity half a step ago
static double normal_limit(double ratio)
{
    double low = 0, high = 2;
    for (int i = 0; i < 60; i++) {
        double z = 0.5 * (low + high);
        if (z * z + 4 * ratio * z / (1 + 0.5 * ratio * z) < 4)
            low = z;
        else
            high = z;
    }
    return low;
}

static void damped(dem_trial *t)
{
    static const double ratios[] = {0.1, 0.3, 1, 3, 10};
    double z[2][5];
    dem_trial_plot(t, (dem_plot_axis){.title = "damping ratio", .log = true},
                   (dem_plot_axis){.title = "w h", .log = true});
    for (size_t i = 0; i < 5; i++)
        for (int slide = 0; slide < 2; slide++) {
            dashpot d = {ratios[i], slide};
            // an overdamped motion grows by 1 + e a step at e beyond the limit
            dem_limit l =
                dem_limit_find(t, &(dem_limit_def){make_damped, &d, NUDGE * frequency(), RADIUS, 10000, NULL});
            double exact = slide ? 2 * (sqrt(1 + d.ratio * d.ratio) - d.ratio) : normal_limit(d.ratio);
            char name[40];
            snprintf(name, sizeof name, "ratio %g, %s", d.ratio, slide ? "sliding" : "normal");
            z[slide][i] = l.measured * frequency();
            dem_expect(t, z[slide][i] / exact, 1, 3e-3, "", "%s: over the exact limit", name);
            dem_expect_least(t, l.measured / l.predicted, 1 - 3e-3, "", "%s: over the predicted limit", name);
        }
    for (int slide = 0; slide < 2; slide++)
        for (size_t i = 0; i < 5; i++)
            dem_trial_point(t, slide ? "sliding, measured" : "normal, measured", ratios[i], z[slide][i]);
    for (size_t i = 0; i <= 40; i++) {
        double ratio = 0.1 * pow(10, (double)i / 20);
        dem_trial_point(t, "2 (sqrt(1 + ratio^2) - ratio)", ratio, 2 * (sqrt(1 + ratio * ratio) - ratio));
    }
}

// ---- what else slows bodies

// between planes, with global damping, local damping or the drag of a fluid of the same rate
typedef enum slowed { VISCOUS, LOCAL, FLUID, VERY } slowed;

static void make_slowed(dem_trial *t, const void *user)
{
    model *m = t->model;
    make_single(t, NULL);
    switch (*(const slowed *)user) {
    case VISCOUS:
        m->scene.damping.viscous = 2 * frequency();
        break;
    case LOCAL:
        m->scene.damping.local = 0.7;
        break;
    case FLUID:  // Stokes: 6 pi viscosity r / m
        m->scene.damping.drag = (dem_drag_def){
            .density = 1e-9, .viscosity = 2 * frequency() * model_ball_mass(RADIUS) / (6 * DEM_PI * RADIUS)};
        break;
    case VERY:
        m->scene.damping.viscous = 100 * frequency();
        break;
    }
}

static void slow(dem_trial *t)
{
    static const char *const names[] = {"global, critical", "local, 0.7", "drag of a fluid, critical",
                                        "global, 50 times critical"};
    dem_limit_plot(t);
    for (int i = VISCOUS; i <= VERY; i++) {
        slowed kind = (slowed)i;
        dem_limit l = find(t, make_slowed, &kind, names[i]);
        // what is overdamped grows by 1 + e a step at e beyond the limit, to 1e4 in 3000 steps at 3e-3
        double z = frequency() * l.measured, exact = i == LOCAL ? sqrt(2 / 1.7) : 0;
        if (i == VISCOUS || i == VERY) {
            double rate = i == VISCOUS ? 2 : 100;  // 2 z^2 + 2 rate z = 4
            exact = 0.5 * (sqrt(rate * rate + 8) - rate);
        }
        if (exact > 0)
            dem_expect(t, z / exact, 1, 4e-3, "", "%s: blows up at, over the exact limit", names[i]);
        dem_expect_least(t, l.measured / l.predicted, 1 - 2e-3, "", "%s: blows up at, over the predicted limit",
                         names[i]);
    }
}

// ---- bonds

// a rod of spheres that touch, each bonded to the next: stretch, shear, bending and twist
static void make_bonds(dem_trial *t, const void *user)
{
    static dem_bond_def bond;
    model *m = t->model;
    const double damping = *(const double *)user;
    bond = dem_bond_defaults();
    bond.name = "rod";
    bond.young = 1e7;
    bond.gap = 1e-3 * RADIUS;
    bond.damping = damping;
    bond.contact = DEM_BOND_INSTEAD;
    m->scene.bonds = &bond;
    m->scene.bond_count = 1;
    uint32_t shape = model_sphere(m, RADIUS);
    for (int i = 0; i < 12; i++)
        model_body(m, shape, v3(2 * RADIUS * i, 0, 0));
}

static void bonds(dem_trial *t)
{
    static const double damping[] = {0, 0.3, 1};
    dem_limit_plot(t);
    for (size_t i = 0; i < 3; i++) {
        char name[40];
        snprintf(name, sizeof name, "dashpots of ratio %g", damping[i]);
        dem_limit l = find(t, make_bonds, &damping[i], name);
        dem_expect_least(t, l.measured / l.predicted, 1 - 5e-4, "", "%s: blows up at, over the predicted limit", name);
        dem_expect_most(t, l.measured / l.predicted, 2, "", "%s: blows up at, over the predicted limit", name);
    }
}

// ---- Hertz

static void make_hertz(dem_trial *t, const void *user)
{
    t->model->laws[0].normal = DEM_NORMAL_HERTZ;
    make_single(t, user);
}

static void hertz(dem_trial *t)
{
    dem_limit_plot(t);
    dem_limit l = find(t, make_hertz, NULL, "Hertz between planes");
    // tangent 2 E* sqrt(R overlap) on both sides, E* = E / (2 (1 - nu^2)) of two like surfaces
    double young = 1e9 / (2 * (1 - 0.25 * 0.25)), tangent = 2 * young * sqrt(RADIUS * DEEP);
    expect_exact(t, &l, 2 / sqrt(2 * tangent / model_ball_mass(RADIUS)), "Hertz between planes");
}

const dem_case dem_stability_limits[] = {
    {"limit-single", "one sphere between two planes", "w h = 2", false, single},
    {"limit-sweep", "swings near the limit, and beyond", "PHYSICS 6.4: eigenvalues of the step", false, sweep},
    {"limit-chain", "rows of spheres between two planes", "sine modes of the row", false, chain},
    {"limit-duplicates", "clumps of many spheres in one place", "stiffness times their number", false, duplicates},
    {"limit-rotation", "contacts whose fastest motion is a rotation", "k r^2 / I", false, rotation},
    {"limit-damped", "dashpots from weak to ten times critical", "PHYSICS 2.1", false, damped},
    {"limit-slowed", "global and local damping, and a fluid, with a contact", "PHYSICS 3; eigenvalues of the step",
     false, slow},
    {"limit-bonds", "a rod of bonded spheres", "PHYSICS 4: bound by bodies", false, bonds},
    {"limit-hertz", "Hertz, at the overlap there is", "tangent stiffness", false, hertz},
    {0},
};
