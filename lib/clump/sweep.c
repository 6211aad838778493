#include "clump/sweep.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/memory.h"
#include "base/nearest.h"
#include "base/status.h"
#include "base/text.h"

enum { MOST_SPHERES = 100000, MEASURING = 40 };  // measuring takes as long as packing so many spheres

static const double packing_part = 0.8;  // of the progress of a packing and its measuring

static const char *const efforts[] = {"fast", "default", "best"};

static const char *packer_name(const void *unused, size_t index)
{
    (void)unused;
    size_t count;
    const dem_packer *const *packers = dem_packers(&count);
    return index < count ? packers[index]->name : NULL;
}

static dem_status refuse_counts(const char *text, dem_error *error)
{
    return dem_fail(error, DEM_USAGE, "'%s' is no list of at most %d numbers of spheres from 1 to %d, as in 10,20,50",
                    text, DEM_SWEEP_COUNTS, MOST_SPHERES);
}

// in order, each once
static bool insert_count(dem_sweep *sweep, size_t value)
{
    size_t at = 0;
    while (at < sweep->count_count && sweep->counts[at] < value)
        at++;
    if (at < sweep->count_count && sweep->counts[at] == value)
        return true;
    if (sweep->count_count == DEM_SWEEP_COUNTS)
        return false;
    memmove(&sweep->counts[at + 1], &sweep->counts[at], (sweep->count_count - at) * sizeof *sweep->counts);
    sweep->counts[at] = value;
    sweep->count_count++;
    return true;
}

dem_status dem_sweep_read_counts(dem_sweep *sweep, const char *text, dem_error *error)
{
    const char *end = text + strlen(text), *at = text;
    sweep->count_count = 0;
    do {
        long value;
        at += strspn(at, " ");
        at = dem_parse_long(at, end, &value);
        if (!at || value < 1 || value > MOST_SPHERES || !insert_count(sweep, (size_t)value))
            return refuse_counts(text, error);
        at += strspn(at, " ");
        if (*at && *at != ',')
            return refuse_counts(text, error);
    } while (*at++ == ',');
    return DEM_OK;
}

static dem_status add_series(dem_sweep *sweep, const dem_packer *packer, const char *name, dem_effort effort,
                             dem_error *error)
{
    for (size_t i = 0; i < sweep->series_count; i++)
        if (sweep->series[i].packer == packer && sweep->series[i].effort == effort)
            return DEM_OK;
    if (sweep->series_count == DEM_SWEEP_SERIES)
        return dem_fail(error, DEM_USAGE, "too many methods; name at most %d", DEM_SWEEP_SERIES);
    dem_sweep_series *s = &sweep->series[sweep->series_count++];
    *s = (dem_sweep_series){.packer = packer, .effort = effort};
    snprintf(s->name, sizeof s->name, "%s", name);
    return DEM_OK;
}

static dem_status add_named(dem_sweep *sweep, char *word, dem_effort effort, dem_error *error)
{
    size_t count;
    const dem_packer *const *packers = dem_packers(&count);
    char whole[48];
    snprintf(whole, sizeof whole, "%s", word);
    if (strcmp(word, "all") == 0) {
        for (size_t i = 0; i < count; i++)
            DEM_TRY(add_series(sweep, packers[i], packers[i]->name, effort, error));
        return DEM_OK;
    }
    char *colon = strchr(word, ':');
    if (colon) {
        *colon = 0;
        int chosen = -1;
        for (int k = 0; k < 3; k++)
            if (strcmp(colon + 1, efforts[k]) == 0)
                chosen = k;
        if (chosen < 0)
            return dem_fail(error, DEM_USAGE, "'%s' is no effort; write %s:fast, %s:default or %s:best", colon + 1,
                            word, word, word);
        effort = (dem_effort)chosen;
    }
    const dem_packer *packer = dem_packer_find(word);
    if (packer)
        return add_series(sweep, packer, whole, effort, error);
    const char *near = dem_nearest(word, packer_name, NULL);
    if (near)
        return dem_fail(error, DEM_USAGE, "there is no packing method '%s'; did you mean %s?", word, near);
    return dem_fail(error, DEM_USAGE, "there is no packing method '%s'; --methods lists them", word);
}

dem_status dem_sweep_read_series(dem_sweep *sweep, const char *text, dem_effort effort, dem_error *error)
{
    sweep->series_count = 0;
    for (const char *at = text;; at++) {
        char word[48];
        size_t length = strcspn(at, ",");
        if (length == 0 || length >= sizeof word)
            return dem_fail(error, DEM_USAGE, "'%s' is no list of packing methods, as in optimal,optimal:fast or all",
                            text);
        memcpy(word, at, length);
        word[length] = 0;
        DEM_TRY(add_named(sweep, word, effort, error));
        at += length;
        if (!*at)
            return DEM_OK;
    }
}

// ---- running

typedef struct cell_run {
    const dem_ctx *ctx;
    dem_sweep_cell *cell;
    char what[96];
    double begin, length;  // of its part in the progress
    double furthest;       // told of it: it never goes back
    bool stopped;
} cell_run;

static void keep_warning(void *user, dem_log_level level, const char *subject, const char *text)
{
    cell_run *run = user;
    (void)subject;
    if (level == DEM_LOG_WARNING && !*run->cell->message)
        snprintf(run->cell->message, sizeof run->cell->message, "%.255s", text);
}

static bool pass_progress(void *user, const char *what, double fraction)
{
    cell_run *run = user;
    (void)what;
    run->furthest = fmax(run->furthest, packing_part * fraction);
    run->stopped |= dem_progress(run->ctx, run->what, run->begin + run->furthest * run->length);
    return run->stopped;
}

static double processor_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static dem_status pack_and_measure(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *options,
                                   dem_sweep_cell *cell, dem_error *error)
{
    double start = processor_seconds();
    DEM_TRY(dem_clump_pack(ctx, mesh, options, &cell->pack, error));
    cell->seconds = processor_seconds() - start;
    DEM_TRY(dem_balls_union(cell->pack.balls, cell->pack.count, &cell->whole, error));
    DEM_TRY(dem_fidelity_measure(ctx, mesh, cell->pack.balls, cell->pack.count, 0, &cell->fidelity, error));
    dem_solid solid = dem_mesh_solid(mesh);
    for (int k = 0; k < 3; k++)
        cell->inertia_errors[k] = cell->whole.solid.principal[k] / solid.principal[k] - 1;
    return DEM_OK;
}

static dem_status run_cell(cell_run *run, const dem_mesh *mesh, const dem_pack_options *options, dem_error *error)
{
    dem_error reason = {0};
    dem_ctx inner = {.log = keep_warning, .progress = pass_progress, .user = run, .threads = run->ctx->threads};
    dem_sweep_cell *cell = run->cell;
    cell->status = pack_and_measure(&inner, mesh, options, cell, &reason);
    if (cell->status != DEM_OK) {
        dem_pack_free(&cell->pack);
        snprintf(cell->message, sizeof cell->message, "%.255s", reason.text);
    }
    if (cell->status == DEM_INTERRUPTED || cell->status == DEM_NO_MEMORY)
        return dem_fail(error, cell->status, "%s", reason.text);
    cell->ran = true;
    return run->stopped ? dem_fail(error, DEM_INTERRUPTED, "interrupted") : DEM_OK;
}

dem_status dem_sweep_run(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *common, dem_sweep *sweep,
                         dem_error *error)
{
    double whole = 0, done = 0;
    sweep->cells = dem_alloc_zero(sweep->series_count * sweep->count_count, sizeof *sweep->cells);
    if (!sweep->cells)
        return dem_fail_memory(error);
    for (size_t k = 0; k < sweep->count_count; k++)
        whole += (double)sweep->series_count * (double)(sweep->counts[k] + MEASURING);
    for (size_t k = 0; k < sweep->count_count; k++)
        for (size_t s = 0; s < sweep->series_count; s++) {
            const dem_sweep_series *series = &sweep->series[s];
            double share = (double)(sweep->counts[k] + MEASURING) / whole;
            cell_run run = {
                .ctx = ctx, .cell = &sweep->cells[s * sweep->count_count + k], .begin = done, .length = share};
            dem_pack_options options = *common;
            snprintf(run.what, sizeof run.what, "sweep, %s with %zu spheres,", series->name, sweep->counts[k]);
            if (dem_progress(ctx, run.what, done))
                return dem_fail(error, DEM_INTERRUPTED, "interrupted");
            options.method = series->packer->name;
            options.effort = series->effort;
            options.spheres = sweep->counts[k];
            options.values = series->values;
            options.value_count = series->value_count;
            options.gap = 0;
            options.target_count = 0;
            DEM_TRY(run_cell(&run, mesh, &options, error));
            done += share;
        }
    return DEM_OK;
}

void dem_sweep_release(dem_sweep *sweep)
{
    for (size_t i = 0; sweep->cells && i < sweep->series_count * sweep->count_count; i++)
        dem_pack_free(&sweep->cells[i].pack);
    free(sweep->cells);
    sweep->cells = NULL;
}
