// Impacts that are hard on the automatic step: fast, stiff, of very different masses and sizes, out of deep overlaps.
// PHYSICS 2.1, 6.4.
#include <math.h>
#include <stdio.h>

#include "sim/validate.h"
#include "study/stability.h"

static const double RADIUS = 0.01;

// ---- a sphere and a plane, without weight

typedef struct shot {
    double speed, young, restitution, gap;
    double steps;  // in a contact, 0: the step is `step`
    double step;
} shot;

// speed after over speed before; and the largest overlap over the radius
static double bounce(dem_trial *t, const shot *s, double *deepest)
{
    model *m = dem_trial_model(t);
    m->materials[0].young = s->young;
    m->laws[0].normal = DEM_NORMAL_HERTZ;
    if (s->restitution < 1) {
        m->laws[0].damping = DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = s->restitution;
    }
    m->scene.time.step = s->step;
    if (s->steps > 0)
        m->scene.time.contact_steps = s->steps;
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, RADIUS * (1 + s->gap)))->velocity.z = -s->speed;
    dem_trial_start(t);
    double deep = 0;
    for (int i = 0; i < 100000 && dem_trial_step(t, 1); i++) {
        deep = fmax(deep, 1 - dem_trial_body(t, 0).position.z / RADIUS);
        if (dem_trial_body(t, 0).velocity.z > 0 && dem_trial_body(t, 0).position.z > RADIUS)
            break;
    }
    if (deepest)
        *deepest = deep;
    if (t->status == DEM_FAILED) {  // only where the step is asked to be too large
        t->status = s->step > 0 ? DEM_OK : t->status;
        return INFINITY;
    }
    return dem_trial_body(t, 0).velocity.z / s->speed;
}

// off by at most, over where in a step the contact begins
static double worst_bounce(dem_trial *t, shot s)
{
    double off = 0;
    for (int i = 0; i < 8; i++) {
        s.gap = 0.01 * (1 + i / 7.0);
        double got = bounce(t, &s, NULL);
        off = fmax(off, isfinite(got) ? fabs(got - s.restitution) : INFINITY);
    }
    return off;
}

static void hertz_impact(dem_trial *t)
{
    static const double speeds[] = {1e-3, 0.1, 1, 10, 50};
    for (size_t i = 0; i < 5; i++) {
        double deepest;
        shot s = {.speed = speeds[i], .young = 1e9, .restitution = 1};
        // Hertz in 10 steps, the worst beginning: 0.26 %
        dem_expect_most(t, worst_bounce(t, s), 2.6e-3, "", "%g m/s: speed after / before, off by", s.speed);
        s.gap = 0.015;
        bounce(t, &s, &deepest);
        double mass = model_ball_mass(RADIUS), young = 1e9 / (2 * (1 - 0.25 * 0.25));
        double want = pow(15 * mass * s.speed * s.speed / (16 * young * sqrt(RADIUS)), 0.4) / RADIUS;
        // seen once a step: (pi / 2 / 10)^2 / 2 of it may be missed
        dem_expect(t, deepest / want, 1, 0.02, "", "%g m/s: deepest overlap over Hertz' (%.2g radii)", s.speed, want);
    }
}

// an impact of Hertz has no limit of its own: energy that comes from too large steps, against the tangent at the
// deepest
static void hertz_limit(dem_trial *t)
{
    dem_trial_plot(t, (dem_plot_axis){.title = "step / limit at the deepest overlap", .log = true},
                   (dem_plot_axis){.title = "speed after / before: largest error", .log = true, .floor = 1e-5});
    const double mass = model_ball_mass(RADIUS), young = 1e9 / (2 * (1 - 0.25 * 0.25));
    double deepest = pow(15 * mass / (16 * young * sqrt(RADIUS)), 0.4);
    double limit = 2 / sqrt(2 * young * sqrt(RADIUS * deepest) / mass);
    static const double parts[] = {0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.4, 2};
    for (size_t i = 0; i < 8; i++) {
        double off = worst_bounce(t, (shot){.speed = 1, .young = 1e9, .restitution = 1, .step = parts[i] * limit});
        dem_trial_point(t, "error", parts[i], fmin(off, 1e3));
        if (parts[i] == 0.5)  // 4 steps in a contact; 5 are 1.6 %, and it goes with the third power
            dem_expect_most(t, off, 0.016 * pow(1.25, 3), "", "half of the limit: speed after / before, off by");
        if (parts[i] == 0.1)
            dem_expect_most(t, off, 1e-3, "", "a tenth of the limit: off by");
    }
}

static void stiff(dem_trial *t)
{
    static const double factors[] = {1, 1e2, 1e4, 1e6};
    double first = NAN;
    for (size_t i = 0; i < 4; i++) {
        // that begins with a step: the phase is the same for all
        shot s = {.speed = 1, .young = 1e8 * factors[i], .restitution = 0.5, .gap = 0};
        double got = bounce(t, &s, NULL);
        first = i ? first : got;
        dem_expect_most(t, worst_bounce(t, s), 1e-2, "", "stiffness x %g: restitution 0.5, off by", factors[i]);
        dem_expect(t, got / first, 1, 1e-3, "", "stiffness x %g: over that of 1", factors[i]);
    }
}

// ---- very different bodies

// Spheres of equal size; the heavy one is at rest. With N steps in the contact, where it begins and ends within a step
// makes (pi / N)^2 / 16 at most.
static void head_on(dem_trial *t)
{
    static const double ratios[] = {1, 1e3, 1e6, 1e9};
    for (size_t i = 0; i < 4; i++) {
        model *m = dem_trial_model(t);
        m->materials[1] = (dem_material){"heavy", 2500 * ratios[i], 1e9, 0.25};
        m->laws[1] = m->laws[2] = m->laws[0];
        m->laws[1].materials[1] = m->laws[2].materials[0] = m->laws[2].materials[1] = 1;
        m->scene.material_count = 2;
        m->scene.law_count = 3;
        m->scene.time.step = 0;
        m->scene.time.contact_steps = 50000;
        uint32_t light = model_sphere(m, RADIUS), heavy = model_sphere(m, RADIUS);
        m->shapes[heavy].material = 1;
        model_body(m, light, v3(0, 0, 0))->velocity.x = 1;
        model_body(m, heavy, v3(2.001 * RADIUS, 0, 0));
        dem_trial_start(t);
        while (dem_trial_step(t, 10000) && dem_trial_time(t) < 1)
            if (dem_trial_body(t, 1).position.x - dem_trial_body(t, 0).position.x > 2.002 * RADIUS)
                break;
        double r = ratios[i], after = (1 - r) / (1 + r), other = 2 / (1 + r);
        dem_expect(t, dem_trial_body(t, 0).velocity.x, after, 1e-9, "m/s", "masses 1 : %g: light after", r);
        dem_expect(t, dem_trial_body(t, 1).velocity.x / other, 1, 1e-9, "", "masses 1 : %g: heavy after, of exact", r);
        double sum = dem_trial_body(t, 0).velocity.x + r * dem_trial_body(t, 1).velocity.x;
        dem_expect(t, sum, 1, 1e-12, "", "masses 1 : %g: momentum after / before", r);
    }
}

// grains of a thousandth of its size rain on a sphere that is free
static void small_on_large(dem_trial *t)
{
    model *m = dem_trial_model(t);
    m->scene.time.step = 0;
    m->laws[0].stiffness = 1e3;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.8;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.3;
    model_body(m, model_sphere(m, 1), v3(0, 0, 0));
    uint32_t small = model_sphere(m, 1e-3);
    dem_random r = random_stream(3, 3);
    for (int i = 0; i < 200; i++) {
        dem_vec3 cell = v3(i % 5 - 2, i / 5 % 5 - 2, i / 25);
        dem_vec3 p = v3_add(v3(0, 0, 1.003), v3_scale(cell, 4e-3));
        p = v3_add(p, v3_scale(random_in(&r, v3(-1, -1, -1), v3(1, 1, 1)), 9e-4));
        model_body(m, small, p)->velocity.z = -1;
    }
    dem_trial_start(t);
    size_t missed = 0, met = 0;
    for (int i = 0; i < 400 && dem_trial_step(t, 20); i++) {
        dem_truth truth;
        t->status = dem_world_validate(t->world, &truth, &t->error);
        missed += truth.missed + truth.doubled + truth.unsound;
        met += truth.contacts;
    }
    const dem_figures *f = dem_trial_figures(t);
    dem_expect_least(t, (double)met, 100, "", "contacts looked at");
    dem_expect_most(t, (double)missed, 0, "", "contacts missed or doubled");
    // 10 steps in a contact; beyond a hundredth the engine warns
    dem_expect_most(t, fabs(f->energy.error), 1e-2, "", "energy off by");
    dem_expect_most(t, f->largest_overlap_ratio, 0.2, "", "largest overlap over the smaller radius");
}

// ---- deep overlaps

static void overlap(dem_trial *t)
{
    // in the same place they would have no direction to part: refused, see test_stability.c
    static const double apart[] = {1.5, 1, 0.5, 1e-3, 1e-9};
    for (int hertz = 0; hertz < 2; hertz++)
        for (size_t i = 0; i < 5; i++) {
            model *m = dem_trial_model(t);
            const char *law = hertz ? "Hertz" : "linear";
            m->scene.time.step = 0;
            m->laws[0].normal = hertz ? DEM_NORMAL_HERTZ : DEM_NORMAL_LINEAR;
            uint32_t s = model_sphere(m, RADIUS);
            model_body(m, s, v3(0, 0, 0));
            model_body(m, s, v3(apart[i] * RADIUS, 0, 0));
            dem_trial_start(t);
            double stored = dem_trial_figures(t)->energy.elastic;
            for (int k = 0; k < 1000 && dem_trial_step(t, 10); k++)
                if (dem_trial_figures(t)->contacts == 0)
                    break;
            const dem_figures *f = dem_trial_figures(t);
            dem_vec3 sum = v3_add(dem_trial_body(t, 0).velocity, dem_trial_body(t, 1).velocity);
            // energy at half steps is less by (w h)^2 / 4 of it, and w h is pi / 10 by 10 steps in a contact; of
            // Hertz the step is by stability alone, w h <= 1, for speeds that are to come are not known
            dem_expect_most(t, f->energy.kinetic / stored, 1 + 1e-3, "", "%s, %g radii apart: energy after / stored",
                            law, apart[i]);
            dem_expect_least(t, f->energy.kinetic / stored, hertz ? 0.75 : 1 - DEM_PI * DEM_PI / 400, "",
                             "%s, %g radii apart: energy after / stored", law, apart[i]);
            dem_expect_most(t, v3_norm(sum) / v3_norm(dem_trial_body(t, 0).velocity), 1e-12, "",
                            "%s, %g radii apart: momentum", law, apart[i]);
        }
}

// the worst a file of bodies can hold
static void heap(dem_trial *t)
{
    model *m = dem_trial_model(t);
    dem_random r = random_stream(5, 5);
    m->scene.time.step = 0;
    model_sphere(m, RADIUS);
    model_dumbbell(m, RADIUS, RADIUS);
    for (uint32_t i = 0; i < 40; i++)
        model_body(m, i % 2, random_in(&r, v3(-RADIUS, -RADIUS, -RADIUS), v3(RADIUS, RADIUS, RADIUS)));
    dem_trial_start(t);
    double stored = dem_trial_figures(t)->energy.elastic;
    dem_trial_step(t, 5000);
    // less by (w h)^2 / 4 at most, and w h <= 1.6
    double after = dem_trial_figures(t)->energy.kinetic + dem_trial_figures(t)->energy.rotational;
    dem_expect_most(t, after / stored, 1 + 1e-3, "", "energy after / stored");
    dem_expect_least(t, after / stored, 0.36, "", "energy after / stored");
    dem_expect(t, (double)dem_trial_figures(t)->contacts, 0, 0, "", "contacts left");
}

const dem_case dem_stability_impacts[] = {
    {"impact-hertz", "spheres of Hertz on a plane, the automatic step", "PHYSICS 2.1; Hertz' impact", false,
     hertz_impact},
    {"impact-step", "the same at steps up to twice the limit", "PHYSICS 2.1", false, hertz_limit},
    {"impact-stiff", "stiffness up to a million times, the automatic step", "similarity", false, stiff},
    {"impact-masses", "head on, masses up to 1 : 1e9", "elastic impact of two spheres", false, head_on},
    {"impact-sizes", "grains of 1 mm on a sphere of 1 m", "brute force; energy", false, small_on_large},
    {"impact-overlap", "two spheres that overlap up to the same place", "stored energy", false, overlap},
    {"impact-heap", "40 bodies within the radius of one", "stored energy", false, heap},
    {0},
};
