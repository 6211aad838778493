// The largest stable step of many bodies at once, against the bound that is taken from each body alone.
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/status.h"
#include "study/stability.h"

static const double RADIUS = 0.01, STIFFNESS = 1e4, DEEP = 1e-4, NUDGE = 1e-10;

static double frequency(void)
{
    return sqrt(STIFFNESS / model_ball_mass(RADIUS));
}

static void stick(model *m, double ratio)
{
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 1e3;
    m->laws[0].stiffness_ratio = ratio;
}

// ---- a crystal

// 3 x 3 x 3 cells of a face-centred cubic packing in a periodic domain
static void make_crystal(dem_trial *t, const void *user)
{
    model *m = t->model;
    double cell = (2 * RADIUS - DEEP) * sqrt(2);
    static const dem_vec3 places[] = {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}};
    if (*(const bool *)user)
        stick(m, 1);
    m->scene.domain.low = v3(0, 0, 0);
    m->scene.domain.high = v3(3 * cell, 3 * cell, 3 * cell);
    for (int k = 0; k < 3; k++)
        m->scene.domain.periodic[k] = true;
    uint32_t shape = model_sphere(m, RADIUS);
    for (int i = 0; i < 108; i++) {
        dem_vec3 corner = v3(i / 4 % 3, i / 12 % 3, i / 36);
        model_body(m, shape, v3_scale(v3_add(corner, places[i % 4]), cell));
    }
}

static void crystal(dem_trial *t)
{
    dem_limit_plot(t);
    for (int rough = 0; rough < 2; rough++) {
        const char *name = rough ? "rough crystal" : "smooth crystal";
        dem_limit l =
            dem_limit_find(t, &(dem_limit_def){make_crystal, &(bool){rough}, NUDGE * frequency(), RADIUS, 3000, name});
        dem_expect_least(t, l.measured / l.predicted, 1 - 5e-4, "", "%s: blows up at, over the predicted limit", name);
        if (rough)  // nothing better is known for it
            dem_expect_most(t, l.measured / l.predicted, 1.5, "", "%s: blows up at, over the predicted limit", name);
        else {
            // at X: 8 (k - F / d) / m, F / d of the force that turns with the contact
            double exact = 2 / (frequency() * sqrt(8 * (1 - DEEP / (2 * RADIUS - DEEP))));
            dem_expect(t, l.measured / exact, 1, 5e-4, "", "%s: blows up at, over the exact limit", name);
        }
    }
}

// ---- heaps in a box

enum { HEAP = 64 };

typedef struct heap {
    void (*shapes)(model *m);
    void (*law)(model *m);      // while it settles, too; NULL: linear
    void (*later)(model *m);    // has no force yet where all is at rest; NULL: nothing
    dem_body_def bodies[HEAP];  // at rest
} heap;

static void one_sphere(model *m)
{
    model_sphere(m, RADIUS);
}

// with spheres that overlap by all parts of their size, so that most contacts are double or more
static void two_clumps(model *m)
{
    model_cloud(m, 30, 3 * RADIUS, 4);
    model_cloud(m, 8, 2.5 * RADIUS, 5);
}

static void put_box(model *m)
{
    double side = 0.14;
    m->scene.gravity = v3(0, 0, -9.81);
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    model_plane(m, v3(0, 0, 0), v3(1, 0, 0));
    model_plane(m, v3(side, 0, 0), v3(-1, 0, 0));
    model_plane(m, v3(0, 0, 0), v3(0, 1, 0));
    model_plane(m, v3(0, side, 0), v3(0, -1, 0));
}

// smooth grains fall and come to rest; friction that is there from then on has no force yet
static void settle(dem_trial *t, heap *h)
{
    model *m = dem_trial_model(t);
    h->shapes(m);
    put_box(m);
    if (h->law)
        h->law(m);
    m->scene.output.energy = false;
    m->scene.damping.local = 0.5;
    m->scene.time.step = 0;
    model_lattice(m, HEAP, 0.035, 0.1, 3);
    dem_trial_start(t);
    for (int i = 0; i < 100 && dem_trial_step(t, 1000) && dem_trial_figures(t)->fastest > 1e-3 * NUDGE * frequency();)
        i++;
    for (size_t i = 0; i < HEAP; i++) {
        dem_motion b = dem_trial_body(t, i);
        h->bodies[i] = m->bodies[i];
        h->bodies[i].position = b.position;
        h->bodies[i].orientation = b.orientation;
        h->bodies[i].velocity = h->bodies[i].spin = v3(0, 0, 0);
    }
}

static void make_heap(dem_trial *t, const void *user)
{
    model *m = t->model;
    const heap *h = user;
    h->shapes(m);
    put_box(m);
    if (h->law)
        h->law(m);
    if (h->later)
        h->later(m);
    memcpy(m->bodies, h->bodies, sizeof h->bodies);
    m->scene.bodies.count = HEAP;
}

static void stick_alike(model *m)
{
    stick(m, 1);
}

// where it blows up over where that was predicted
static void try_heap(dem_trial *t, heap *h, const char *name)
{
    dem_limit l = dem_limit_find(t, &(dem_limit_def){make_heap, h, NUDGE * frequency(), RADIUS, 2000, name});
    dem_expect_least(t, l.measured / l.predicted, 1 - 5e-4, "", "%s: blows up at, over the predicted limit", name);
    // of 200 random networks the median is 1.37
    dem_expect_most(t, l.measured / l.predicted, 2, "", "%s: blows up at, over the predicted limit", name);
}

static heap *new_heap(dem_trial *t)
{
    heap *h = dem_alloc_zero(1, sizeof *h);
    if (!h && t->status == DEM_OK)
        t->status = dem_fail_memory(&t->error);
    return h;
}

static void try_heaps(dem_trial *t, void (*shapes)(model *m))
{
    heap *h = new_heap(t);
    if (!h)
        return;
    dem_limit_plot(t);
    h->shapes = shapes;
    settle(t, h);
    try_heap(t, h, "smooth");
    h->later = stick_alike;
    try_heap(t, h, "rough");
    free(h);
}

static void spheres(dem_trial *t)
{
    try_heaps(t, one_sphere);
}

static void clumps(dem_trial *t)
{
    try_heaps(t, two_clumps);
}

// ---- other laws

static void hertz(model *m)
{
    m->materials[0].young = 1e7;
    m->laws[0].normal = DEM_NORMAL_HERTZ;
}
static void hertz_rough(model *m)
{
    m->laws[0].friction = DEM_FRICTION_MINDLIN;
    m->laws[0].friction_coefficient = 1e3;
}
static void jkr(model *m)
{
    hertz(m);
    m->laws[0].normal = DEM_NORMAL_JKR;
    m->laws[0].work_of_adhesion = 0.1;
}
static void mean(model *m)
{
    m->scene.multiple = DEM_MULTIPLE_MEAN;
}
static void merge(model *m)
{
    m->scene.multiple = DEM_MULTIPLE_MERGE;
}
static void soft(model *m)
{
    m->scene.multiple = DEM_MULTIPLE_SOFT;
    m->scene.soft.tau = 2e-5;
}
static void rolling(model *m)
{
    stick(m, 0.5);
    m->laws[0].rolling = DEM_ROLLING_EPSD;
    m->laws[0].rolling_coefficient = 1;  // k_r = 2.25 k_n R*^2, more than what sliding turns with
    m->laws[0].twisting = DEM_TWISTING_MARSHALL;
}
static void rolling_damped(model *m)
{
    rolling(m);
    m->laws[0].rolling_damping = 0.5;
}
static void dashpots(model *m)
{
    stick(m, 1);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.1;
}

// a heap that drifts or creeps is no equilibrium; the bound for what is loose in it is that it does not blow up before
static void laws(dem_trial *t)
{
    static const struct {
        const char *name;
        void (*shapes)(model *m), (*law)(model *m), (*later)(model *m);
    } tries[] = {
        {"spheres, Hertz and Mindlin", one_sphere, hertz, hertz_rough},
        {"clumps, JKR", two_clumps, jkr, NULL},
        {"spheres, rolling springs", one_sphere, NULL, rolling},
        {"clumps, rolling springs and dashpots", two_clumps, NULL, rolling_damped},
        {"clumps, restitution 0.1", two_clumps, NULL, dashpots},
        {"clumps, mean of contacts", two_clumps, mean, stick_alike},
        {"clumps, merged contacts", two_clumps, merge, stick_alike},
        {"clumps, soft contacts", two_clumps, soft, stick_alike},
    };
    dem_limit_plot(t);
    for (size_t i = 0; i < sizeof tries / sizeof *tries; i++) {
        heap *h = new_heap(t);
        if (!h)
            return;
        h->shapes = tries[i].shapes;
        h->law = tries[i].law;
        h->later = tries[i].later;
        settle(t, h);
        try_heap(t, h, tries[i].name);
        free(h);
    }
}

const dem_case dem_stability_packings[] = {
    {"packing-crystal", "108 spheres of a face-centred cubic crystal", "phonons at X; PHYSICS 4", false, crystal},
    {"packing-spheres", "64 spheres at rest in a box", "PHYSICS 4: bound by bodies", false, spheres},
    {"packing-clumps", "64 clumps with many contacts to a pair, at rest in a box", "PHYSICS 4: bound by bodies", true,
     clumps},
    {"packing-laws", "the same with other laws", "PHYSICS 4: bound by bodies", true, laws},
    {0},
};
