// Gases of elastic, smooth clumps: energy bounded and without a trend, momentum kept, energy shared alike by
// translation and rotation. PHYSICS 6.3.
#include "study/trial.h"
#include "study/verify.h"

enum { BODIES = 200 };

static const double CELL = 0.0175, RADIUS = 0.005;

// four balls in a tetrahedron
static uint32_t tetra(model *m)
{
    const double d = 0.0025, r = 0.004, ball = model_ball_mass(r);
    const double moment = 4 * 0.4 * ball * r * r + 8 * ball * d * d;
    dem_ball balls[4] = {{{d, d, d}, r}, {{d, -d, -d}, r}, {{-d, d, -d}, r}, {{-d, -d, d}, r}};
    return model_clump(m, balls, 4, 4 * ball, (double[]){moment, moment, moment});
}

typedef enum grains { DIMERS, TETRAS, ODD } grains;
static const char *const names[] = {[DIMERS] = "dimers", [TETRAS] = "tetrahedra", [ODD] = "odd grains"};

// 200 bodies in a cube of 6 cells; `parts` steps in the shortest contact
static void start_gas(dem_trial *t, grains kind, bool periodic, bool hertz, double parts)
{
    model *m = dem_trial_model(t);
    m->laws[0].stiffness = 1e4;
    if (hertz) {
        m->laws[0].normal = DEM_NORMAL_HERTZ;
        m->materials[0].young = 2e7;
    }
    m->scene.time.step = 0;
    m->scene.time.contact_steps = parts;
    if (kind == TETRAS)
        tetra(m);
    else if (kind == DIMERS)
        model_dumbbell(m, RADIUS, 0.006);
    else
        model_cloud(m, 5, 0.014, 1);
    model_lattice(m, BODIES, CELL, 1, 7);
    dem_vec3 high = v3(6 * CELL, 6 * CELL, 6 * CELL);
    if (periodic) {
        m->scene.domain.low = v3(0, 0, 0);
        m->scene.domain.high = high;
        for (int k = 0; k < 3; k++)
            m->scene.domain.periodic[k] = true;
    } else
        model_box(m, v3(0, 0, 0), high);
    dem_trial_start(t);
}

// of the energy over that at the start, less 1; the last: what a straight line through it gains
typedef struct drift {
    double largest, spread, trend;
    double change;                 // root of the sum of the squares of all changes from look to look
    double translation, rotation;  // means [J]
} drift;

// looks at it every so many steps
static drift watch(dem_trial *t, double time, size_t steps)
{
    double start = dem_trial_figures(t)->energy.start, begin = dem_trial_time(t), n = 0, sum = 0, square = 0,
           moment = 0, last = 0;
    drift d = {0};
    while (dem_trial_time(t) < begin + time && dem_trial_step(t, steps)) {
        const dem_energy *e = &dem_trial_figures(t)->energy;
        double off = (e->kinetic + e->rotational + e->elastic) / start - 1;
        d.largest = fmax(d.largest, fabs(off));
        sum += off;
        square += off * off;
        d.change += (off - last) * (off - last);
        last = off;
        moment += off * n++;
        d.translation += e->kinetic;
        d.rotation += e->rotational;
    }
    d.spread = sqrt(fmax(square / n - sum * sum / n / n, 0));
    d.change = sqrt(d.change);
    // least squares over the numbers 0 .. n - 1, spread over 1
    d.trend = (moment / n - sum / n * (n - 1) / 2) / (n / 12);
    d.translation /= n;
    d.rotation /= n;
    return d;
}

// PHYSICS 6.3: 1e-3 at 30 steps in the shortest contact, falling by h^2, change by change; a line through the energies finds no
// more than they vary by. The linear law's kink at first touch gives each collision a small random error, of third
// order, so these walk; the law of Hertz has no kink. 0.6 s are about 2e4 steps and 1e4 collisions
static void gas_energy(dem_trial *t, double time)
{
    for (int i = 0; i < 4; i++) {
        grains kind = i % 2 ? TETRAS : DIMERS;
        bool hertz = i / 2, periodic = (i + i / 2) % 2;
        start_gas(t, kind, periodic, hertz, 30);
        drift d = watch(t, time, 20);
        start_gas(t, kind, periodic, hertz, 60);
        drift half = watch(t, time, 40);
        const char *law = hertz ? "hertz" : "linear", *where = periodic ? "periodic" : "in a box";
        dem_expect_most(t, d.largest, hertz ? 2e-4 : 1e-3, "", "%s, %s, %s: energy off by", names[kind], law, where);
        dem_expect_most(t, fabs(d.trend) / d.spread, 4, "", "%s, %s, %s: trend over spread", names[kind], law, where);
        dem_expect_least(t, d.change / half.change, 3, "", "%s, %s, %s: half the step, changes 1/", names[kind],
                         law, where);
    }
}
static void gas_energy_short(dem_trial *t)
{
    gas_energy(t, 0.05);
}
static void gas_energy_long(dem_trial *t)
{
    gas_energy(t, 0.6);
}

static double axial_spin(dem_trial *t, size_t body)
{
    dem_motion b = dem_trial_body(t, body);
    return v3_dot(b.spin, quat_rotate(b.orientation, v3(1, 0, 0)));
}

// what a dimer has in the spin about its axis stays there
static double axial_energy(dem_trial *t)
{
    double sum = 0, inertia = 2 * 0.4 * model_ball_mass(RADIUS) * RADIUS * RADIUS;
    for (size_t i = 0; i < BODIES; i++)
        sum += axial_spin(t, i) * axial_spin(t, i) * inertia / 2;
    return sum;
}

// means over some hundred collisions of each body: half a percent, two for the odd grains, which are nearly smooth
static void equipartition(dem_trial *t)
{
    static const double turning[] = {[DIMERS] = 2, [TETRAS] = 3, [ODD] = 3};
    for (int kind = 0; kind < 3; kind++) {
        start_gas(t, (grains)kind, true, false, 15);
        dem_trial_step(t, 10000);
        drift d = watch(t, 2, 20);
        double rotation = d.rotation - (kind == DIMERS ? axial_energy(t) : 0);
        dem_expect(t, rotation / turning[kind] / (d.translation / 3), 1, 0.03, "",
                   "%s: energy of a turn over that of a way", names[kind]);
    }
}

static dem_vec3 momentum_of(dem_trial *t, double *sum)
{
    dem_vec3 p = v3(0, 0, 0);
    *sum = 0;
    for (size_t i = 0; i < BODIES; i++) {
        dem_vec3 v = dem_trial_body(t, i).velocity;
        p = v3_add(p, v);
        *sum += v3_norm(v);
    }
    return p;
}

// smooth contacts have no moment about the axis of a dimer, and none changes the sum of all momenta
static void gas_momentum(dem_trial *t)
{
    double spin[BODIES], sum, off = 0;
    start_gas(t, DIMERS, true, false, 30);
    dem_vec3 before = momentum_of(t, &sum);
    for (size_t i = 0; i < BODIES; i++)
        spin[i] = axial_spin(t, i);
    dem_trial_step(t, 20000);
    for (size_t i = 0; i < BODIES; i++)
        off = fmax(off, fabs(axial_spin(t, i) - spin[i]));
    dem_expect_most(t, v3_distance(momentum_of(t, &sum), before) / sum, 1e-14, "", "momentum of all, off by");
    dem_expect_most(t, off, 1e-12 * 57, "rad/s", "axial spin, off by");  // spins are up to speed / cell
}

const dem_case dem_verify_gas[] = {
    {"gas-energy", "an elastic gas of clumps, 3 thousand steps", "conserved energy", false, gas_energy_short},
    {"gas-energy-long", "an elastic gas of clumps, 20 thousand steps", "conserved energy", true, gas_energy_long},
    {"gas-momentum", "a gas of dimers keeps momentum and axial spins", "conserved momentum", false, gas_momentum},
    {"gas-equipartition", "translation and rotation share the energy", "equipartition", true, equipartition},
    {0},
};
