// Every number of spheres the search asks for is packed and measured by the independent evaluator; the best packing is
// kept, with what it said.
#include "clump/pack_target.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/status.h"
#include "clump/fewest.h"
#include "clump/fidelity.h"
#include "clump/measures.h"

enum { MOST_NOTES = 4, MOST_TARGETS = DEM_MEASURES + 1, FEWEST_FIRST = 1, UNKNOWN_FIRST = 16, MOST_FIRST = 64 };

static const double usual_count = 50, usual_power = 0.8;
static const double share = 0.35;  // of the progress left that a packing takes: nobody knows how many come

// what a run said; passed on for the one whose result is taken
typedef struct run_notes {
    dem_log_level levels[MOST_NOTES];
    char texts[MOST_NOTES][400];
    int count;
} run_notes;

typedef struct search {
    const dem_ctx *ctx;
    const dem_mesh *mesh;
    const dem_packer *packer;
    dem_pack_options options;  // of the run at hand
    dem_target targets[MOST_TARGETS];
    size_t target_count;
    bool gap_only;
    bool given;         // the parameters leave nothing to search
    dem_ctx inner;      // of the run at hand: keeps messages, scales the progress
    double begin, end;  // of its progress
    run_notes notes, best_notes;
    dem_pack best;
    dem_fewest_try best_try;
    dem_fidelity best_fidelity;
    dem_error failed;  // of a number that could not be packed
} search;

static void keep_note(void *user, dem_log_level level, const char *subject, const char *text)
{
    search *s = user;
    (void)subject;
    if (s->notes.count == MOST_NOTES)
        return;
    s->notes.levels[s->notes.count] = level;
    snprintf(s->notes.texts[s->notes.count++], sizeof s->notes.texts[0], "%s", text);
}

static bool pass_progress(void *user, const char *what, double fraction)
{
    const search *s = user;
    char text[80];
    snprintf(text, sizeof text, "%.24s, trying %zu spheres,", what, s->options.spheres);
    return dem_progress(s->ctx, text, s->begin + fraction * (s->end - s->begin));
}

static dem_status measure(search *s, const dem_pack *pack, dem_fidelity *f, dem_error *error)
{
    *f = (dem_fidelity){0};
    if (s->gap_only)
        return dem_fidelity_gap(s->ctx, s->mesh, pack->balls, pack->count, 0, &f->iou_gap, NULL, error);
    return dem_fidelity_measure(s->ctx, s->mesh, pack->balls, pack->count, 0, f, error);
}

static dem_status pack_and_measure(search *s, dem_pack *pack, dem_fidelity *f, dem_error *error)
{
    *pack = (dem_pack){.moment_residual = NAN, .gap_estimate = NAN};
    s->notes.count = 0;
    s->begin = s->end;
    s->end += (1 - s->end) * share;
    DEM_TRY(s->packer->run(&s->inner, s->mesh, &s->options, pack, error));
    DEM_TRY(measure(s, pack, f, error));
    pack->gap_estimate = f->iou_gap;
    return DEM_OK;
}

static dem_status attempt(void *user, dem_fewest_try *now, dem_error *error)
{
    search *s = user;
    dem_pack pack;
    dem_fidelity f;
    s->options.spheres = now->asked;
    dem_status status = pack_and_measure(s, &pack, &f, error);
    if (status != DEM_OK) {
        dem_pack_free(&pack);
        // a method may not be able to make this number; another one may do
        if (status == DEM_FAILED)
            dem_fail(&s->failed, status, "%s", error ? error->text : "no packing");
        return status == DEM_FAILED ? DEM_OK : status;
    }
    now->got = pack.count;
    now->worst = dem_target_ratio(s->targets, s->target_count, &f);
    if (s->best.balls && !dem_fewest_better(*now, s->best_try)) {
        dem_pack_free(&pack);
        return DEM_OK;
    }
    dem_pack_free(&s->best);
    s->best = pack;
    s->best_try = *now;
    s->best_fidelity = f;
    s->best_notes = s->notes;
    return DEM_OK;
}

// as many as the usual grain needs
static size_t first_guess(const search *s)
{
    double count = 0;
    for (size_t i = 0; i < s->target_count; i++) {
        double usual = dem_measure_find(s->targets[i].measure)->usual;
        if (usual > 0)
            count = fmax(count, usual_count * pow(usual / s->targets[i].bound, 1 / usual_power));
    }
    return count > 0 ? (size_t)fmin(fmax(ceil(count), FEWEST_FIRST), MOST_FIRST) : UNKNOWN_FIRST;
}

static dem_status set_targets(search *s, const dem_pack_options *options, dem_error *error)
{
    if (options->gap > 0)
        s->targets[s->target_count++] = (dem_target){"iou_gap", options->gap};
    s->gap_only = options->target_count == 0;
    for (size_t i = 0; i < options->target_count; i++) {
        const dem_measure *m = dem_measure_find(options->targets[i].measure);
        if (!m || !(options->targets[i].bound > 0))
            return dem_fail(error, DEM_USAGE, "a target must name a measure and a bound above 0");
        // the tighter one of two of the same
        size_t at = 0;
        while (at < s->target_count && strcmp(s->targets[at].measure, m->field) != 0)
            at++;
        double bound =
            at < s->target_count ? fmin(s->targets[at].bound, options->targets[i].bound) : options->targets[i].bound;
        s->targets[at] = (dem_target){m->field, bound};
        s->target_count += at == s->target_count;
    }
    return DEM_OK;
}

static void warn_missed(const search *s)
{
    char missed[400] = "";
    for (size_t i = 0; i < s->target_count; i++) {
        const dem_measure *m = dem_measure_find(s->targets[i].measure);
        double value = dem_measure_of(m, &s->best_fidelity);
        if (value <= s->targets[i].bound)
            continue;
        size_t length = strlen(missed);
        snprintf(missed + length, sizeof missed - length, "%s%s of %.3g%s%s, not the %.3g%s%s", length ? ", " : "",
                 m->title, dem_measure_shown(m, value), *m->unit ? " " : "", m->unit,
                 dem_measure_shown(m, s->targets[i].bound), *m->unit ? " " : "", m->unit);
    }
    dem_log(s->ctx, DEM_LOG_WARNING, "%zu spheres come to %s asked for; %s", s->best.count, missed,
            s->best.interrupted ? "the search was interrupted"
            : s->given          ? "leave out a parameter of the method and it is searched for"
                                : "allow more spheres or ask for less");
}

dem_status dem_pack_target(const dem_ctx *ctx, const dem_mesh *mesh, const dem_packer *packer,
                           const dem_pack_options *options, dem_pack *pack, dem_error *error)
{
    search s = {.ctx = ctx, .mesh = mesh, .packer = packer, .options = *options};
    s.inner = (dem_ctx){.log = keep_note, .progress = pass_progress, .user = &s, .threads = dem_threads(ctx)};
    DEM_TRY(set_targets(&s, options, error));
    s.options.gap = 0;
    s.options.target_count = 0;
    dem_fewest_try best = {.asked = options->max_spheres, .worst = INFINITY};
    s.given = dem_packer_sets_count(packer, options);
    dem_status status = s.given ? attempt(&s, &best, error)
                                : dem_fewest_search(first_guess(&s), options->max_spheres, attempt, &s, &best, error);
    s.best.interrupted = status == DEM_INTERRUPTED;
    if (status == DEM_OK && !s.best.balls)
        status = dem_fail(error, s.failed.code, "%s", s.failed.text);
    if (!s.best.balls || (status != DEM_OK && status != DEM_INTERRUPTED)) {
        dem_pack_free(&s.best);
        return status;
    }
    s.best.reached = best.worst <= 1;
    for (int i = 0; i < s.best_notes.count; i++)
        dem_log(ctx, s.best_notes.levels[i], "%s", s.best_notes.texts[i]);
    if (!s.best.reached)
        warn_missed(&s);
    else if (s.best.interrupted)
        dem_log(ctx, DEM_LOG_WARNING, "the search was interrupted; fewer than %zu spheres may do", s.best.count);
    *pack = s.best;
    return DEM_OK;
}
