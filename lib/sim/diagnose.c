#include "sim/diagnose.h"

#include "base/status.h"
#include "sim/timestep.h"

typedef enum warning {
    WARN_STEP,
    WARN_RESOLUTION,
    WARN_PENETRATION,
    WARN_PASSED,
    WARN_TUNNEL,
    WARN_ENERGY,
    WARN_SEARCH,
    WARN_INLET,
    WARN_SOFT,
} warning;

static const double PENETRATION = 0.05;  // of the smaller radius
static const double SOFT_DEPTH = 10;     // of tau
static const double TUNNEL = 0.1;        // of a radius in a step
static const double ENERGY_OFF = 0.01;   // of the energy turned over
static const double CONTACT_STEPS = 10;  // least number of steps in a contact
static const double INLET_BEHIND = 0.02;  // of what is asked for
static const double SEARCH_EVERY = 5;    // steps between searches

// true: not said yet, or by now twice as bad
static bool worse(dem_world *w, warning which, double how)
{
    if (!(how > 2 * w->warned[which]))
        return false;
    w->warned[which] = how;
    return true;
}

static void judge_step(dem_world *w, double critical)
{
    double accurate = dem_step_accurate(w) * (w->time_def.contact_steps > 0 ? w->time_def.contact_steps : DEM_PI);
    if (w->next_step > critical && worse(w, WARN_STEP, w->next_step / critical))
        dem_log(
            w->ctx, DEM_LOG_WARNING,
            "the time step %.3g s is above the limit of stability %.3g s of the contacts now; lower the step, or let "
            "it be \"auto\"",
            w->next_step, critical);
    else if (accurate < CONTACT_STEPS * w->next_step && worse(w, WARN_RESOLUTION, w->next_step / accurate))
        dem_log(w->ctx, DEM_LOG_WARNING,
                "the shortest contact takes %.3g steps, less than %g: bodies will bounce too much; lower the step to "
                "%.2g s, or the stiffness",
                accurate / w->next_step, CONTACT_STEPS, accurate / CONTACT_STEPS);
}

// overlaps of impacts go with 1 / sqrt(k), those of weight with 1 / k (Hertz: with k^-2/5 and k^-2/3)
static void judge_penetration(dem_world *w, double critical)
{
    const dem_figures *f = &w->views.figures;
    double ratio = f->largest_overlap_ratio;
    if (!(ratio > PENETRATION) || !worse(w, WARN_PENETRATION, ratio))
        return;
    double much = ratio / PENETRATION, power = w->features.hertz ? 2.5 : 2;
    if (w->next_step > critical)
        dem_log(w->ctx, DEM_LOG_WARNING,
                "bodies overlap by %.2g %% of the smaller radius (over %g %%), because the time step is too large",
                100 * ratio, 100 * PENETRATION);
    else
        dem_log(w->ctx, DEM_LOG_WARNING,
                "bodies overlap by %.2g %% of the smaller radius (over %g %%): the contacts are too soft for these "
                "speeds and weights; %.2g times the stiffness would do, or bodies that start apart",
                100 * ratio, 100 * PENETRATION, pow(much, power));
}

// with more the soft maximum is nearly the deepest overlap alone, whose place jumps from sphere to sphere
static void judge_soft(dem_world *w)
{
    double depth = w->views.figures.largest_soft_overlap;
    if (depth > SOFT_DEPTH && worse(w, WARN_SOFT, depth))
        dem_log(w->ctx, DEM_LOG_WARNING,
                "soft contacts overlap by %.3g tau (over %g): the spheres begin to be felt; give a larger tau, \"soft\": "
                "{ \"tau\": %.2g }",
                depth, SOFT_DEPTH, 0.25 * depth * w->soft.tau);
}

static void judge_walls(dem_world *w)
{
    const dem_views *v = &w->views;
    if (v->passed > 1 && worse(w, WARN_PASSED, v->passed))
        dem_log(w->ctx, DEM_LOG_WARNING,
                "the centre of a sphere of body %u has passed wall \"%s\"; the wall is too soft, or the body too fast",
                (unsigned)v->passed_body, w->walls.items[v->passed_wall].name);
}

static void judge_speed(dem_world *w)
{
    double most = 0;
    uint32_t fastest = 0;
    for (size_t i = 0; i < w->bodies.living; i++) {
        size_t row = w->bodies.place[i];
        double radius = w->templates.items[w->bodies.shape[row]].radius_min * body_scale(&w->bodies, row);
        double moved = body_stride(&w->bodies, row, w->next_step) / radius;
        if (moved > most) {
            most = moved;
            fastest = (uint32_t)i;
        }
    }
    if (most > TUNNEL && worse(w, WARN_TUNNEL, most))
        dem_log(
            w->ctx, DEM_LOG_WARNING,
            "body %u moves by %.2g of its smallest sphere's radius in a step (over %g): it may pass through others; "
            "lower the time step",
            (unsigned)fastest, most, TUNNEL);
}

static void judge_energy(dem_world *w)
{
    double off = w->views.figures.energy.error;
    if (isfinite(off) && fabs(off) > ENERGY_OFF && worse(w, WARN_ENERGY, fabs(off)))
        dem_log(w->ctx, DEM_LOG_WARNING,
                "energy is off by %.2g %% of what was turned over; the time step is too large for the contacts",
                100 * off);
}

static void judge_search(dem_world *w)
{
    if (w->population || w->steps < 1000 || w->searches * SEARCH_EVERY < (double)w->steps)
        return;
    double often = (double)w->searches / (double)w->steps;
    if (worse(w, WARN_SEARCH, often))
        dem_log(
            w->ctx, DEM_LOG_WARNING,
            "neighbours are searched every %.2g steps: single bodies are very fast for the others' size; the run is "
            "right but slow",
            1 / often);
}

// more behind than a body or two, and not because it has only just begun to wait
static void judge_inlets(dem_world *w)
{
    size_t count;
    const dem_inlet_view *views = dem_world_inlets(w, &count), *worst = NULL;
    double most = 0;
    for (size_t i = 0; i < count; i++) {
        double part = views[i].asked > 0 ? views[i].behind / views[i].asked : 0;
        if (views[i].behind > 0 && part > INLET_BEHIND && part > most) {
            most = part;
            worst = &views[i];
        }
    }
    if (worst && worse(w, WARN_INLET, most))
        dem_log(w->ctx, DEM_LOG_WARNING,
                "inlet \"%.60s\" is %.3g%s behind of %.3g asked for by its rate, as there is no room; make it larger, "
                "let bodies leave it faster, or lower the rate",
                worst->name, worst->behind, worst->by_mass ? " kg" : " bodies", worst->asked);
}

dem_status dem_world_diagnose(dem_world *w, dem_error *error)
{
    dem_step_bound bound;
    DEM_TRY(dem_step_stable(w, false, &bound, error));
    judge_step(w, bound.step);
    judge_penetration(w, bound.step);
    judge_soft(w);
    judge_walls(w);
    judge_speed(w);
    judge_energy(w);
    judge_search(w);
    judge_inlets(w);
    return DEM_OK;
}
