#include "out/run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "base/status.h"
#include "out/breakages.h"
#include "out/checkpoint.h"
#include "out/final.h"
#include "out/frames.h"
#include "out/network.h"
#include "out/series.h"
#include "sim/diagnose.h"
#include "sim/scene.h"
#include "sim/state.h"

static const double LOOK_EVERY = 0.1;        // [s] of the wall's clock: progress, signals
static const double DIAGNOSE_EVERY = 5;      // [s] of the wall's clock, at least: warnings
static const double DIAGNOSE_SHARE = 0.01;   // of the time, at most: a million bodies take seconds to look at
static const double EVENT_TOLERANCE = 1e-6;  // of a step: how much before its time an event counts as due

typedef struct runner {
    const dem_ctx *ctx;
    const dem_scene *scene;
    const dem_run_options *options;
    dem_run_result *result;
    dem_world *w;
    dem_frames *frames;
    dem_file_queue *queue;  // of frames and networks
    dem_series *series;
    dem_network *network, *bonds;
    const dem_clump **clumps;  // of the shapes, as the world runs them
    char sha[65];
    double end;                                       // [s]
    uint64_t last_step;                               // 0: by time
    double next_frame, next_series, next_network, next_checkpoint;  // [s]; the last by either clock
    double started, diagnosed;                        // by the wall's clock
    double diagnosing;                                // what it took the last time [s]
    double output_seconds, ending_seconds, timed_since;
    uint64_t timed_from;     // step
    uint64_t measured_step;  // of the views; UINT64_MAX: none
} runner;

// ---- what is written

static dem_status measure(runner *r, dem_error *error)
{
    if (r->measured_step == dem_world_steps(r->w))
        return DEM_OK;
    DEM_TRY(dem_world_measure(r->w, error));
    r->measured_step = dem_world_steps(r->w);
    return DEM_OK;
}

static dem_status write_frame(runner *r, dem_error *error)
{
    size_t count;
    DEM_TRY(measure(r, error));
    dem_body_view bodies = dem_world_bodies(r->w);
    return dem_frames_write(r->frames, dem_world_time(r->w), &bodies, dem_world_walls(r->w, &count), error);
}

static dem_status write_row(runner *r, dem_error *error)
{
    size_t count;
    DEM_TRY(measure(r, error));
    return dem_series_write(r->series, dem_world_figures(r->w), dem_world_walls(r->w, &count),
                            dem_world_measures(r->w, &count), error);
}

static dem_status write_network(runner *r, dem_error *error)
{
    size_t count;
    DEM_TRY(measure(r, error));
    dem_body_view bodies = dem_world_bodies(r->w);
    const dem_contact *contacts = dem_world_contacts(r->w, &count);
    return dem_network_write(r->network, dem_world_time(r->w), &bodies, contacts, count, error);
}

// the table of what has broken
static dem_status write_breakages(runner *r, dem_error *error)
{
    size_t count;
    DEM_TRY(measure(r, error));
    const dem_bond_view *bonds = dem_world_bonds(r->w, &count);
    return dem_breakages_write(r->queue, r->scene->output.directory, r->scene->bonds, bonds, count, error);
}

// with every frame: lines as they are
static dem_status write_bonds(runner *r, dem_error *error)
{
    size_t count;
    DEM_TRY(write_breakages(r, error));
    dem_body_view bodies = dem_world_bodies(r->w);
    const dem_bond_view *bonds = dem_world_bonds(r->w, &count);
    return dem_network_write_bonds(r->bonds, dem_world_time(r->w), &bodies, bonds, count, error);
}

static dem_status write_checkpoint(runner *r, dem_error *error)
{
    void *bytes;
    size_t size;
    // a checkpoint counts the frames that are there
    DEM_TRY(dem_file_queue_wait(r->queue, error));
    DEM_TRY(dem_world_save(r->w, &bytes, &size, error));
    dem_checkpoint c = {.title = r->scene->title,
                        .time = dem_world_time(r->w),
                        .step = dem_world_steps(r->w),
                        .frames = r->frames ? dem_frames_count(r->frames) : 0,
                        .rows = r->series ? dem_series_rows(r->series) : 0,
                        .state = bytes,
                        .state_size = size};
    memcpy(c.scene, r->sha, sizeof c.scene);
    dem_status status = dem_checkpoint_write(r->scene->output.directory, &c, error);
    free(bytes);
    if (status == DEM_OK) {
        free(r->result->checkpoint);
        r->result->checkpoint = dem_checkpoint_path(r->scene->output.directory, c.step);
    }
    return status;
}

// ---- events

static double wall_or_time(const runner *r)
{
    return r->scene->output.checkpoint_wall ? dem_clock() - r->started : dem_world_time(r->w);
}

// the first multiple of the interval behind t
static double next_multiple(double t, double interval)
{
    double n = floor(t / interval + 1e-9) + 1;
    return n * interval;
}

static bool due(const runner *r, double when)
{
    return dem_world_time(r->w) >= when - EVENT_TOLERANCE * dem_world_step_size(r->w);
}

static dem_status do_events(runner *r, dem_error *error)
{
    const dem_output_def *o = &r->scene->output;
    double begin = dem_clock(), t = dem_world_time(r->w) + EVENT_TOLERANCE * dem_world_step_size(r->w);
    if (r->frames && due(r, r->next_frame)) {
        DEM_TRY(write_frame(r, error));
        if (r->bonds)
            DEM_TRY(write_bonds(r, error));
        r->next_frame = next_multiple(t, o->frames);
    }
    if (r->series && due(r, r->next_series)) {
        DEM_TRY(write_row(r, error));
        r->next_series = next_multiple(t, o->series);
    }
    if (r->network && due(r, r->next_network)) {
        DEM_TRY(write_network(r, error));
        r->next_network = next_multiple(t, o->contacts);
    }
    if (o->checkpoint > 0 && wall_or_time(r) >= r->next_checkpoint - EVENT_TOLERANCE * dem_world_step_size(r->w)) {
        DEM_TRY(write_checkpoint(r, error));
        r->next_checkpoint = next_multiple(wall_or_time(r), o->checkpoint);
    }
    double now = dem_clock();
    if (now - r->diagnosed > DIAGNOSE_EVERY && now - r->diagnosed > r->diagnosing / DIAGNOSE_SHARE) {
        DEM_TRY(measure(r, error));
        DEM_TRY(dem_world_diagnose(r->w, error));
        r->diagnosed = dem_clock();
        r->diagnosing = r->diagnosed - now;
    }
    r->output_seconds += dem_clock() - begin;
    return DEM_OK;
}

// steps to the next event, not more than the wall's clock allows between looks
static uint64_t steps_ahead(const runner *r, double steps_per_second)
{
    double h = dem_world_step_size(r->w), t = dem_world_time(r->w), next = r->end;
    if (r->frames)
        next = fmin(next, r->next_frame);
    if (r->series)
        next = fmin(next, r->next_series);
    if (r->network)
        next = fmin(next, r->next_network);
    if (r->scene->output.checkpoint > 0 && !r->scene->output.checkpoint_wall)
        next = fmin(next, r->next_checkpoint);
    double n = fmin(ceil((next - t) / h - EVENT_TOLERANCE), fmax(steps_per_second * LOOK_EVERY, 1));
    if (r->last_step)
        n = fmin(n, (double)(r->last_step - dem_world_steps(r->w)));
    return n >= 1 ? (uint64_t)n : 1;
}

static bool over(const runner *r)
{
    return (r->last_step && dem_world_steps(r->w) >= r->last_step) || due(r, r->end);
}

static double fraction(const runner *r)
{
    double by_time = isfinite(r->end) ? dem_world_time(r->w) / r->end : 0;
    double by_steps = r->last_step ? (double)dem_world_steps(r->w) / (double)r->last_step : 0;
    return fmax(by_time, by_steps);
}

static bool tell(const runner *r, double steps_per_second)
{
    char what[64];
    snprintf(what, sizeof what, "running, t = %.4g s, %.3g steps/s,", dem_world_time(r->w), steps_per_second);
    return dem_progress(r->ctx, what, fraction(r));
}

// ---- the run

static dem_status interrupted(runner *r, dem_error *error)
{
    DEM_TRY(write_checkpoint(r, error));
    DEM_TRY(measure(r, error));
    return dem_fail(error, DEM_INTERRUPTED, "interrupted at step %llu; go on with --resume %s",
                    (unsigned long long)dem_world_steps(r->w), r->result->checkpoint ? r->result->checkpoint : "");
}

static dem_status step_ahead(runner *r, uint64_t steps, dem_error *error)
{
    dem_error why;
    dem_status status = dem_world_step(r->w, steps, &why);
    if (status == DEM_FAILED)
        return dem_fail(error, status, "%s; %s%s", why.text,
                        r->result->checkpoint ? "the last checkpoint is "
                                              : "there is no checkpoint (output.checkpoint)",
                        r->result->checkpoint ? r->result->checkpoint : "");
    if (status != DEM_OK && error)
        *error = why;
    return status;
}

// what is timed: everything from here on
static void start_clock(runner *r)
{
    dem_world_reset_clocks(r->w);
    r->timed_from = dem_world_steps(r->w);
    r->output_seconds = 0;
    r->timed_since = dem_clock();
}

static dem_status step_to_end(runner *r, dem_error *error)
{
    double rate = 1000, looked = dem_clock();
    uint64_t warmup = r->options->warmup;
    while (!over(r)) {
        uint64_t ahead = steps_ahead(r, rate), at = dem_world_steps(r->w);
        if (at < warmup && at + ahead > warmup)
            ahead = warmup - at;
        double t0 = dem_clock();
        DEM_TRY(step_ahead(r, ahead, error));
        double spent = dem_clock() - t0;
        rate = spent > 0 ? 0.5 * rate + 0.5 * (double)ahead / spent : rate;
        DEM_TRY(do_events(r, error));
        if (dem_clock() - looked > LOOK_EVERY / 2) {
            looked = dem_clock();
            if (tell(r, rate))
                return interrupted(r, error);
        }
        if (at < warmup && dem_world_steps(r->w) >= warmup)
            start_clock(r);
    }
    return DEM_OK;
}

// also a run that fails tells how far it came
static dem_status loop(runner *r, dem_error *error)
{
    r->timed_from = dem_world_steps(r->w);
    r->output_seconds = 0;
    r->timed_since = dem_clock();
    dem_status status = step_to_end(r, error);
    if (status == DEM_FAILED)
        measure(r, NULL);
    r->result->loop_seconds = dem_clock() - r->timed_since;
    r->result->timed_steps = dem_world_steps(r->w) - r->timed_from;
    return status;
}

// a name for the scene that does not depend on when it ends and what it writes
static dem_status name_scene(runner *r, dem_error *error)
{
    dem_scene bare = *r->scene;
    dem_scene defaults = dem_scene_defaults();
    char *text;
    bare.output = defaults.output;
    bare.time.end = NAN;
    bare.title = NULL;
    bare.measure_count = 0;
    DEM_TRY(dem_scene_resolved(&bare, &text, error));
    dem_sha256(text, strlen(text), r->sha);
    free(text);
    return DEM_OK;
}

static dem_status take_up(runner *r, double *resume_time, dem_error *error)
{
    dem_checkpoint c;
    *resume_time = NAN;
    if (!r->options->resume)
        return DEM_OK;
    DEM_TRY(dem_checkpoint_read(r->options->resume, r->sha, &c, error));
    dem_status status = dem_world_restore(r->w, c.state, c.state_size, error);
    if (status == DEM_BAD_INPUT && error)
        snprintf(error->file, sizeof error->file, "%s", r->options->resume);
    if (status == DEM_OK) {
        *resume_time = c.time;
        r->result->checkpoint = strdup(r->options->resume);
    }
    dem_checkpoint_release(&c);
    return status;
}

static dem_status open_outputs(runner *r, double resume, dem_error *error)
{
    const dem_output_def *o = &r->scene->output;
    if (o->frames > 0 || o->contacts > 0)
        DEM_TRY(dem_file_queue_create(&r->queue, error));
    if (o->frames > 0) {
        r->clumps = dem_alloc(r->scene->shape_count, sizeof *r->clumps);
        if (!r->clumps)
            return dem_fail_memory(error);
        for (uint32_t i = 0; i < r->scene->shape_count; i++)
            r->clumps[i] = dem_world_clump(r->w, i);
        dem_frames_def def = {o->directory,    r->scene->shapes,     r->clumps,        r->scene->shape_count,
                              r->scene->walls, r->scene->wall_count, r->scene->domain, r->queue,
                              resume};
        DEM_TRY(dem_frames_open(&def, &r->frames, error));
    }
    if (o->series > 0) {
        dem_series_def def = dem_series_def_of(r->scene, o->directory, r->w->population != NULL);
        DEM_TRY(dem_series_open(&def, resume, &r->series, error));
    }
    if (o->contacts > 0)
        DEM_TRY(dem_network_open(o->directory, "contacts", &r->scene->domain, r->queue, resume, &r->network, error));
    if (o->frames > 0 && r->scene->bond_count)
        DEM_TRY(dem_network_open(o->directory, "bonds", &r->scene->domain, r->queue, resume, &r->bonds, error));
    double t = isnan(resume) ? -1 : resume + EVENT_TOLERANCE * dem_world_step_size(r->w);
    r->next_frame = o->frames > 0 && t >= 0 ? next_multiple(t, o->frames) : 0;
    r->next_series = o->series > 0 && t >= 0 ? next_multiple(t, o->series) : 0;
    r->next_network = o->contacts > 0 && t >= 0 ? next_multiple(t, o->contacts) : 0;
    r->next_checkpoint = o->checkpoint > 0 ? next_multiple(fmax(wall_or_time(r), 0), o->checkpoint) : 0;
    return DEM_OK;
}

static dem_status finish(runner *r, dem_error *error)
{
    double begin = dem_clock();
    DEM_TRY(measure(r, error));
    DEM_TRY(dem_world_diagnose(r->w, error));
    dem_body_view bodies = dem_world_bodies(r->w);
    DEM_TRY(
        dem_final_write(r->ctx, r->scene->output.directory, r->scene->shapes, r->scene->shape_count, &bodies, error));
    if (r->scene->bond_count)
        DEM_TRY(write_breakages(r, error));
    DEM_TRY(dem_file_queue_wait(r->queue, error));
    r->ending_seconds = dem_clock() - begin;
    return DEM_OK;
}

// figures as far as the run came
static dem_status conclude(runner *r, dem_error *error)
{
    dem_run_result *result = r->result;
    size_t count;
    const dem_pass_time *passes = dem_world_passes(r->w, &count);
    result->figures = *dem_world_figures(r->w);
    result->step = dem_world_step_size(r->w);
    result->critical_step = dem_world_critical_step(r->w);
    result->bytes_per_body = dem_world_bytes_per_body(r->w);
    result->threads = r->w->threads;
    result->warmup = r->options->warmup;
    result->passes = dem_alloc(count + 2, sizeof *result->passes);
    if (!result->passes)
        return dem_fail_memory(error);
    const dem_inlet_view *inlets = dem_world_inlets(r->w, &result->inlet_count);
    result->inlets = dem_alloc(result->inlet_count, sizeof *result->inlets);
    if (!result->inlets)
        return dem_fail_memory(error);
    for (size_t i = 0; i < result->inlet_count; i++) {
        result->inlets[i] = inlets[i];
        result->inlets[i].name = r->scene->inlets[i].name;
    }
    memcpy(result->passes, passes, count * sizeof *passes);
    result->passes[count] = (dem_pass_time){"output", r->output_seconds};
    result->passes[count + 1] = (dem_pass_time){"ending", r->ending_seconds};
    result->pass_count = count + 2;
    return DEM_OK;
}

static dem_status set_end(runner *r, dem_error *error)
{
    const dem_run_options *o = r->options;
    r->end = isnan(o->until) ? r->scene->time.end : o->until;
    r->last_step = o->steps ? o->steps + o->warmup : 0;
    if (isnan(r->end) && !r->last_step)
        return dem_fail(error, DEM_USAGE, "nothing tells when to end; give time.end in the scene, --until or --steps");
    if (isnan(r->end) || (o->steps && isnan(o->until)))
        r->end = INFINITY;
    return DEM_OK;
}

dem_status dem_run(const dem_ctx *ctx, const dem_scene *scene, const dem_run_options *options, dem_run_result *result,
                   dem_error *error)
{
    double begin = dem_clock(), resume;
    runner r = {.ctx = ctx,
                .scene = scene,
                .options = options,
                .result = result,
                .measured_step = UINT64_MAX,
                .started = begin,
                .diagnosed = begin};
    *result = (dem_run_result){0};
    DEM_TRY(set_end(&r, error));
    DEM_TRY(name_scene(&r, error));
    dem_status status = options->spent ? dem_world_create_spending(ctx, options->spent, &r.w, error)
                                       : dem_world_create(ctx, scene, &r.w, error);
    if (status == DEM_OK)
        status = take_up(&r, &resume, error);
    if (status == DEM_OK)
        status = open_outputs(&r, resume, error);
    result->setup_seconds = dem_clock() - begin;
    if (status == DEM_OK)
        status = do_events(&r, error);
    if (status == DEM_OK)
        status = loop(&r, error);
    if (status == DEM_OK)
        status = finish(&r, error);
    if (r.w && (status == DEM_OK || status == DEM_FAILED || status == DEM_INTERRUPTED)) {
        if (status != DEM_OK && error)
            result->stopped = strdup(error->text);
        dem_status concluded = conclude(&r, status == DEM_OK ? error : NULL);
        status = status == DEM_OK ? concluded : status;
    }
    dem_frames_close(r.frames);
    dem_file_queue_destroy(r.queue);
    dem_series_close(r.series);
    dem_network_close(r.network);
    dem_network_close(r.bonds);
    free(r.clumps);
    dem_world_destroy(r.w);
    return status;
}

void dem_run_release(dem_run_result *result)
{
    free(result->passes);
    free(result->inlets);
    free(result->checkpoint);
    free(result->stopped);
}
