// The gap falls about as a power of the number of spheres. One quick run of few spheres finds the factor, runs at the
// asked effort then close in from both sides: the number taken works and the next smaller one tried does not.
#include "clump/pack_target.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/status.h"
#include "clump/fidelity.h"

enum { MOST_RUNS = 9, MOST_PROBE_SPHERES = 120 };

static const double usual_gap = 0.045, usual_count = 50; // of grains between a rock and a cube
static const double usual_power = 0.8, least_power = 0.35, most_power = 1.6;
static const double aim = 0.985;        // of the gap: runs scatter by a percent or two
static const double resolution = 0.015; // of the number of spheres where single ones do not show

// what a run said; passed on for the one whose result is taken
typedef struct run_notes {
    dem_log_level levels[4];
    char texts[4][400];
    int count;
} run_notes;

typedef struct tried {
    double count, gap; // count 0: none
} tried;

typedef struct search {
    const dem_ctx *ctx;
    const dem_pack_grain *grain;
    dem_pack_options options; // of the run at hand
    dem_pack_count_run *run;
    dem_ctx inner;               // of the run at hand: passes messages on, scales the progress
    double begin, end;           // of its progress
    run_notes notes, best_notes; // of the run at hand, of the best
    double asked, power;
    tried works, fails;
} search;

static void pass_log(void *user, dem_log_level level, const char *subject, const char *text)
{
    search *s = user;
    (void)subject;
    if (s->notes.count == 4)
        return;
    s->notes.levels[s->notes.count] = level;
    snprintf(s->notes.texts[s->notes.count++], sizeof s->notes.texts[0], "%s", text);
}

static bool pass_progress(void *user, const char *what, double fraction)
{
    const search *s = user;
    return dem_progress(s->ctx, what, s->begin + fraction * (s->end - s->begin));
}

// the spheres that a power law through what was tried asks for
static double predict(const search *s, tried from, double gap)
{
    return from.count * pow(from.gap / gap, 1 / s->power);
}

static dem_status try_count(search *s, size_t count, dem_pack *pack, dem_error *error)
{
    *pack = (dem_pack){.moment_residual = NAN, .gap_estimate = NAN};
    s->options.spheres = count;
    s->notes.count = 0;
    s->begin = s->end;
    s->end += (1 - s->end) * 0.35;
    dem_status status = s->run(&s->inner, s->grain, &s->options, pack, error);
    if (status == DEM_OK)
        status =
            dem_fidelity_gap(s->ctx, s->grain->mesh, pack->balls, pack->count, 0, &pack->gap_estimate, NULL, error);
    if (status != DEM_OK)
        dem_pack_free(pack);
    return status;
}

// where the gap stands for few spheres; sets the first guess
static dem_status probe(search *s, double *guess, dem_error *error)
{
    dem_pack pack;
    dem_effort effort = s->options.effort;
    dem_moments_kept moments = s->options.moments;
    double count = usual_count * pow(usual_gap / s->asked, 1 / usual_power);
    count = fmin(fmax(ceil(count), 2), fmin(MOST_PROBE_SPHERES, (double)s->options.max_spheres));
    s->options.effort = DEM_EFFORT_FAST;
    s->options.moments = DEM_MOMENTS_FREE;
    dem_status status = try_count(s, (size_t)count, &pack, error);
    s->options.effort = effort;
    s->options.moments = moments;
    if (status != DEM_OK)
        return status;
    *guess = predict(s, (tried){(double)pack.count, pack.gap_estimate}, aim * s->asked);
    dem_pack_free(&pack);
    return DEM_OK;
}

static void learn_power(search *s, tried a, tried b)
{
    if (a.count > 0 && b.count > 0 && fabs(log(a.count / b.count)) > 0.05) {
        double power = log(a.gap / b.gap) / log(b.count / a.count);
        s->power = fmin(fmax(power, least_power), most_power);
    }
}

// between what works and what fails, or farther on
static double next_guess(const search *s, tried last)
{
    double guess = predict(s, last, aim * s->asked);
    if (s->works.count == 0)
        return fmax(guess, s->fails.count * 1.02 + 1);
    double low = s->fails.count + 1, high = s->works.count - 1;
    if (s->fails.count > 0)
        guess = s->fails.count +
                (s->works.count - s->fails.count) * log(s->fails.gap / s->asked) / log(s->fails.gap / s->works.gap);
    return fmin(fmax(guess, low), high);
}

static bool close_enough(const search *s)
{
    return s->works.count > 0 && s->works.count - s->fails.count <= fmax(1, floor(resolution * s->works.count));
}

static void keep(search *s, dem_pack *best, dem_pack *pack)
{
    bool better = !best->balls || pack->reached || (!best->reached && pack->gap_estimate < best->gap_estimate);
    dem_pack_free(better ? best : pack);
    if (!better)
        return;
    *best = *pack;
    s->best_notes = s->notes;
}

static dem_status close_in(search *s, double guess, dem_pack *best, dem_error *error)
{
    double most = (double)s->options.max_spheres;
    tried last = {0};
    for (int k = 0; !close_enough(s) && s->fails.count < most && (k < MOST_RUNS || s->works.count == 0); k++) {
        dem_pack pack;
        // what has not been reached by then is tried once more with all there is
        double count = k + 1 >= MOST_RUNS && s->works.count == 0 ? most : fmin(fmax(round(guess), 1), most);
        DEM_TRY(try_count(s, (size_t)count, &pack, error));
        tried now = {count, pack.gap_estimate};
        pack.reached = now.gap <= s->asked;
        if (pack.reached)
            s->works = now;
        else
            s->fails = now;
        keep(s, best, &pack);
        learn_power(s, last, now);
        last = now;
        guess = next_guess(s, last);
    }
    return DEM_OK;
}

dem_status dem_pack_target(const dem_ctx *ctx, const dem_pack_grain *grain, const dem_pack_options *options,
                           dem_pack_count_run *run, dem_pack *pack, dem_error *error)
{
    search s = {
        .ctx = ctx, .grain = grain, .options = *options, .run = run, .asked = options->gap, .power = usual_power};
    s.inner = (dem_ctx){.log = pass_log, .progress = pass_progress, .user = &s, .threads = dem_threads(ctx)};
    double guess = 1;
    dem_pack best = {0};
    DEM_TRY(probe(&s, &guess, error));
    dem_status status = close_in(&s, guess, &best, error);
    if (status != DEM_OK) {
        dem_pack_free(&best);
        return status;
    }
    for (int i = 0; i < s.best_notes.count; i++)
        dem_log(ctx, s.best_notes.levels[i], "%s", s.best_notes.texts[i]);
    if (!best.reached)
        dem_log(ctx, DEM_LOG_WARNING,
                "%zu spheres come to a gap of %.3g %%, not to the %.3g %% asked for; allow more spheres "
                "or ask for a larger gap",
                best.count, 100 * best.gap_estimate, 100 * options->gap);
    *pack = best;
    return DEM_OK;
}
