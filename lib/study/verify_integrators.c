// The integrators that can be chosen: how an oscillator grows a step, and in what order of the step a free top is off.
// PHYSICS 2.1 to 2.3.
#include "study/trial.h"
#include "study/verify.h"

static const double RADIUS = 0.01, STIFFNESS = 1e4;

// ---- translation

static double frequency(void)
{
    return sqrt(2 * STIFFNESS / model_ball_mass(RADIUS));
}

// a sphere pressed by two planes, a thousandth of the overlap beside its place; z = w h
static void oscillator(dem_trial *t, dem_translation scheme, double z)
{
    model *m = dem_trial_model(t);
    const double deep = 1e-3;
    m->scene.integrator.translation = scheme;
    m->scene.time.step = z / frequency();
    m->scene.output.energy = false;
    model_plane(m, v3(0, 0, deep - RADIUS), v3(0, 0, 1));
    model_plane(m, v3(0, 0, RADIUS - deep), v3(0, 0, -1));
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, 1e-3 * deep));
    dem_trial_start(t);
}

// x^2 + (v / w)^2 over that at first
static double square_amplitude(dem_trial *t)
{
    dem_motion b = dem_trial_body(t, 0);
    double v = b.velocity.z / frequency();
    return (b.position.z * b.position.z + v * v) / 1e-12;
}

static const struct {
    const char *name;
    dem_translation scheme;
    double growth;  // squared, a step, over z^2
    double order;
} translations[] = {
    {"central", DEM_TRANSLATION_CENTRAL, 0, 2},
    {"symplectic-euler", DEM_TRANSLATION_SYMPLECTIC_EULER, 0, 1},
    {"velocity-verlet", DEM_TRANSLATION_VELOCITY_VERLET, 0, 2},
    {"newmark", DEM_TRANSLATION_NEWMARK, 0, 2},
    {"taylor", DEM_TRANSLATION_TAYLOR, 0.5, 1},
    {"forward-euler", DEM_TRANSLATION_FORWARD_EULER, 1, 1},
};

static void growth(dem_trial *t)
{
    for (size_t i = 0; i < sizeof translations / sizeof *translations; i++) {
        const double z = 0.1, want = sqrt(1 + translations[i].growth * z * z);
        oscillator(t, translations[i].scheme, z);
        // the growth of a whole number of periods, as good as that can be with steps of z: a part of z of one
        dem_trial_step(t, 63);
        double before = square_amplitude(t);
        dem_trial_step(t, 10 * 63);
        double got = pow(square_amplitude(t) / before, 0.5 / 630);
        dem_expect(t, got, want, 2e-5 + (translations[i].order < 2 ? 1e-4 : 0), "", "%s: growth a step, w h = 0.1",
                   translations[i].name);
    }
}

// how far the place is from cos(w t) within a period
static double off_cosine(dem_trial *t, dem_translation scheme, int steps)
{
    double off = 0;
    oscillator(t, scheme, 2 * DEM_PI / steps);
    for (int i = 0; i < steps && dem_trial_step(t, 1); i++)
        off = fmax(off, fabs(dem_trial_body(t, 0).position.z / 1e-6 - cos(frequency() * dem_trial_time(t))));
    return off;
}

static void translation_order(dem_trial *t)
{
    for (size_t i = 0; i < sizeof translations / sizeof *translations; i++) {
        double order = log2(off_cosine(t, translations[i].scheme, 500) / off_cosine(t, translations[i].scheme, 1000));
        dem_expect(t, order, translations[i].order, 0.03, "", "%s: order", translations[i].name);
    }
}

// ---- rotation

static const dem_quat TOP_AT_10 = {0.729597833524, -0.030117639158, -0.333812224756, -0.596111841631};

// a free top with moments 1, 2, 3 after 10 s
static double off_top(dem_trial *t, dem_rotation scheme, int per_second)
{
    model *m = dem_trial_model(t);
    m->scene.integrator.rotation = scheme;
    m->scene.time.step = 1.0 / per_second;
    model_clump(m, (dem_ball[]){{{0, 0, 0}, 1}}, 1, 1, (double[]){1, 2, 3});
    model_body(m, 0, v3(0, 0, 0))->spin = v3(1, 0.5, 0.8);
    dem_trial_start(t);
    dem_trial_step(t, 10 * (uint64_t)per_second);
    return angle_between(dem_trial_body(t, 0).orientation, TOP_AT_10);
}

static void rotation_order(dem_trial *t)
{
    static const struct {
        const char *name;
        dem_rotation scheme;
        double order, within, most;  // most: off after 10 s with |w| h = 0.1 [rad]
    } rotations[] = {
        {"lsym", DEM_ROTATION_LSYM, 2, 0.02, 8e-4},
        {"lsym4", DEM_ROTATION_LSYM4, 4, 0.1, 1e-6},
        {"spiral", DEM_ROTATION_SPIRAL, 2, 0.1, 1e-2},
        {"no-squish", DEM_ROTATION_NO_SQUISH, 2, 0.05, 1e-2},
        {"omelyan", DEM_ROTATION_OMELYAN, 2, 0.1, 1e-2},
        {"fincham", DEM_ROTATION_FINCHAM, 2, 0.3, 5e-2},
        {"walton-braun", DEM_ROTATION_WALTON_BRAUN, 2, 0.2, 2e-2},
        {"pcdm", DEM_ROTATION_PCDM, 2, 0.2, 2e-2},
    };
    for (size_t i = 0; i < sizeof rotations / sizeof *rotations; i++) {
        double coarse = off_top(t, rotations[i].scheme, 14), off = off_top(t, rotations[i].scheme, 56),
               half = off_top(t, rotations[i].scheme, 112);
        dem_expect_most(t, coarse, rotations[i].most, "rad", "%s: off after 10 s, |w| h = 0.1", rotations[i].name);
        dem_expect(t, log2(off / half), rotations[i].order, rotations[i].within, "", "%s: order", rotations[i].name);
    }
}

const dem_case dem_verify_integrators[] = {
    {"integrator-growth", "an oscillator's growth a step, all schemes of translation", "eigenvalues of the step", false,
     growth},
    {"integrator-order", "an oscillator within a period, all schemes of translation", "cos(w t)", false,
     translation_order},
    {"integrator-rotation", "a free top after 10 s, all schemes of rotation", "Jacobi's functions", false,
     rotation_order},
    {0},
};
