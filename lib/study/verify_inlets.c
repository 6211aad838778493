// What comes through inlets: the mass of the rate, to the last body, and never an overlap. PHYSICS 5.
#include "study/trial.h"
#include "study/verify.h"

static const double RADIUS = 0.01;

// Spheres of many sizes by mass from a box, of one size by number from a generator far from it. Without gravity none
// that comes later is overtaken, so any overlap is one at birth.
static void flow(dem_trial *t)
{
    model *m = dem_trial_model(t);
    uint32_t sphere = model_sphere(m, RADIUS);
    const dem_mix_def mixed = {sphere, 1, {.law = DEM_SIZE_UNIFORM, .a = RADIUS, .b = 2 * RADIUS, .largest = INFINITY}};
    const dem_mix_def same = {sphere, 1, {.largest = INFINITY}};
    const double heaviest = 2500 * DEM_PI / 6 * pow(2 * RADIUS, 3), mass = 2.5, bodies = 20, time = 1;
    const dem_inlet_def inlets[] = {{.name = "box",
                                     .low = {0, 0, 0.4},
                                     .high = {0.2, 0.2, 0.5},
                                     .mix = &mixed,
                                     .mix_count = 1,
                                     .rate = mass,
                                     .by_mass = true,
                                     .velocity = {0, 0, -1},
                                     .stop = INFINITY,
                                     .seed = 3},
                                    {.name = "generator",
                                     .kind = DEM_INLET_SPHERE,
                                     .centre = {1, 0, 0},
                                     .radius = 1.5 * RADIUS,
                                     .mix = &same,
                                     .mix_count = 1,
                                     .rate = bodies,
                                     .velocity = {1, 0, 0},
                                     .stop = INFINITY,
                                     .seed = 4}};
    m->scene.inlets = inlets;
    m->scene.inlet_count = 2;
    m->scene.time.step = 1e-4;
    m->scene.time.end = time;
    dem_trial_start(t);
    double overlap = 0;
    for (int i = 0; i < 100 && dem_trial_step(t, 100); i++)
        overlap = fmax(overlap, dem_trial_figures(t)->largest_overlap_ratio);
    // those that are there, not what the inlets say of themselves
    dem_body_view there = t->status == DEM_OK ? dem_world_bodies(t->world) : (dem_body_view){0};
    double sum = 0, generated = 0;
    for (size_t i = 0; i < there.count; i++) {
        bool far = there.position[i].x > 0.9;
        sum += far ? 0 : there.mass[i];
        generated += far;
    }
    dem_expect(t, sum, mass * time, heaviest, "kg", "mass through the box");
    dem_expect(t, generated, bodies * time, 1, "", "bodies through the generator");
    dem_expect_most(t, overlap, 0, "", "largest overlap");
}

const dem_case dem_verify_inlets[] = {
    {"inlet-flow", "mass and bodies through inlets in a second", "rate x time, within one body", false, flow},
    {0},
};
