#include "study/stability.h"

#include <math.h>

#include "base/status.h"
#include "sim/state.h"

static const dem_case *const parts[] = {
    dem_stability_limits, dem_stability_packings, dem_stability_impacts, dem_stability_extremes,
    dem_stability_rest,   dem_stability_places,   dem_stability_walls,
};

const dem_case *dem_stability_case(size_t index)
{
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        for (const dem_case *c = parts[i]; c->name; c++)
            if (index-- == 0)
                return c;
    return NULL;
}

// ---- the limit of the step

enum { LOOKS = 20, HALVINGS = 15 };

// A mode just below the limit swings by 1 / sqrt(1 - z^2 / 4), which is 100 at 5e-5 below; one above it grows by
// sqrt(8 (z / 2 - 1)) in each step.
static const double GROWN = 1e4;

static void start(dem_trial *t, const dem_limit_def *d, double step)
{
    model *m = dem_trial_model(t);
    d->make(t, d->user);
    m->scene.time.step = step;
    m->scene.output.energy = false;
    dem_random r = random_stream(7, 1);
    for (size_t i = 0; i < m->scene.bodies.count; i++) {
        dem_body_def *b = &m->bodies[i];
        b->velocity = v3_add(b->velocity, v3_scale(random_in(&r, v3(-1, -1, -1), v3(1, 1, 1)), d->speed));
        b->spin = v3_add(b->spin, v3_scale(random_in(&r, v3(-1, -1, -1), v3(1, 1, 1)), d->speed / d->size));
    }
    dem_trial_start(t);
}

// at half steps: what swings from step to step has no speed between them
static double fastest(const dem_trial *t, double size)
{
    double most = 0;
    for (size_t row = 0; t->status == DEM_OK && row < t->world->bodies.count; row++) {
        const double *m = body_pose(&t->world->bodies, row) + 8;
        most = fmax(most, v3_norm(v3(m[0], m[1], m[2])) + size * v3_norm(v3(m[3], m[4], m[5])));
    }
    return most;
}

// how much the fastest surface has become faster, GROWN where it has run away
static double growth(dem_trial *t, const dem_limit_def *d, double step)
{
    double grown = 1;
    start(t, d, step);
    double first = fastest(t, d->size);
    for (int i = 0; i < LOOKS && grown < GROWN && dem_trial_step(t, d->steps / LOOKS); i++)
        grown = fmax(grown, fastest(t, d->size) / first);
    if (t->status == DEM_FAILED) {  // the engine says so itself
        t->status = DEM_OK;
        return GROWN;
    }
    return grown < GROWN ? grown : GROWN;
}

dem_limit dem_limit_find(dem_trial *t, const dem_limit_def *d)
{
    dem_limit l = {NAN, NAN};
    start(t, d, 1e-12);
    if (t->status != DEM_OK)
        return l;
    l.predicted = dem_world_critical_step(t->world);
    double low = 0.26, high = 4;
    for (int i = 0; i < HALVINGS && t->status == DEM_OK; i++) {
        double middle = sqrt(low * high), grown = growth(t, d, middle * l.predicted);
        if (d->curve)
            dem_trial_point(t, d->curve, middle, grown);
        if (grown < GROWN)
            low = middle;
        else
            high = middle;
    }
    l.measured = low > 0.26 && high < 4 ? sqrt(low * high) * l.predicted : NAN;
    return l;
}

void dem_limit_plot(dem_trial *t)
{
    dem_trial_plot(t, (dem_plot_axis){.title = "step / predicted limit", .log = true},
                   (dem_plot_axis){.title = "growth of the speed", .log = true});
}
