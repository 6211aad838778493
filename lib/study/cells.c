#include "study/cells.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/status.h"
#include "base/threads.h"

static const char SCHEMA[] = "dem-cell/1";

typedef struct study {
    const dem_ctx *ctx;
    const dem_cells_def *def;
    dem_cell_result *results;
    size_t *todo, count;
    atomic_size_t next, done;
    _Atomic double told;  // how far: several cells are under way, and none of them knows of the others
    atomic_bool stop;
} study;

// one cell under way, as its run sees the caller
typedef struct cell_view {
    study *s;
    dem_ctx ctx;
} cell_view;

// ---- files

static char *file_of(const dem_cells_def *def, size_t cell)
{
    return dem_path_join(def->directory, "cells/%04zu.json", cell);
}

static char *inputs_of(const dem_cells_def *def, size_t cell)
{
    dem_buffer inputs = {0};
    dem_buffer_text(&inputs, dem_version());
    dem_buffer_text(&inputs, " ");
    def->describe(def->user, cell, &inputs);
    if (!inputs.failed)
        return inputs.data;
    dem_buffer_release(&inputs);
    return NULL;
}

// a file that is missing, broken or of other inputs is as none
static bool take_kept(const dem_cells_def *def, size_t cell, const char *inputs, dem_cell_result *r)
{
    char *path = file_of(def, cell);
    dem_buffer text = {0};
    dem_json *root = NULL;
    dem_error ignored;
    bool there = path && access(path, F_OK) == 0 && dem_file_read(path, &text, &ignored) == DEM_OK &&
                 dem_json_parse(text.data, text.size, path, &root, &ignored) == DEM_OK;
    const char *schema = dem_json_string(dem_json_member(root, "schema"));
    const char *same = dem_json_string(dem_json_member(root, "inputs"));
    char *found = dem_json_text(dem_json_member(root, "found"));
    r->kept = there && schema && strcmp(schema, SCHEMA) == 0 && same && strcmp(same, inputs) == 0 && found &&
              dem_json_number(dem_json_member(root, "seconds"), &r->seconds) &&
              dem_json_parse(found, strlen(found), path, &r->found, &ignored) == DEM_OK;
    if (r->kept)
        r->status = DEM_OK;
    free(found);
    dem_json_release(root);
    dem_buffer_release(&text);
    free(path);
    return r->kept;
}

static dem_status keep(const dem_cells_def *def, size_t cell, const char *inputs, const char *found, double seconds,
                       dem_error *error)
{
    dem_buffer text = {0};
    dem_json_writer w = dem_json_begin(&text);
    dem_json_open_object(&w, NULL);
    dem_json_put_string(&w, "schema", SCHEMA);
    dem_json_put_string(&w, "inputs", inputs);
    dem_json_put_number(&w, "seconds", seconds);
    dem_json_put_raw(&w, "found", found);
    dem_json_close(&w, '}');
    dem_buffer_text(&text, "\n");
    char *path = file_of(def, cell);
    dem_status status = path ? dem_file_write_buffer(path, &text, error) : dem_fail_memory(error);
    if (!path)
        dem_buffer_release(&text);
    free(path);
    return status;
}

// ---- running

static bool cell_progress(void *user, const char *what, double fraction)
{
    cell_view *v = user;
    double done = ((double)v->s->done + fraction) / (double)v->s->count;
    (void)what;
    if (done > v->s->told)
        v->s->told = done;
    return v->s->stop || dem_progress(v->s->ctx, "cells", v->s->told);
}

static void cell_log(void *user, dem_log_level level, const char *subject, const char *text)
{
    const cell_view *v = user;
    if (v->s->ctx && v->s->ctx->log)
        v->s->ctx->log(v->s->ctx->user, level, subject, text);
}

static dem_status run_cell(study *s, size_t cell, dem_cell_result *r, dem_error *error)
{
    cell_view view = {.s = s};
    view.ctx = (dem_ctx){.log = cell_log, .progress = cell_progress, .user = &view, .threads = 1};
    if (s->count == 1)
        view.ctx.threads = dem_threads(s->ctx);
    dem_buffer found = {0};
    dem_json_writer w = dem_json_begin(&found);
    double begin = dem_clock();
    dem_json_open_object(&w, NULL);
    dem_status status = s->def->run(s->def->user, cell, &view.ctx, &w, error);
    dem_json_close(&w, '}');
    r->seconds = dem_clock() - begin;
    char *inputs = status == DEM_OK ? inputs_of(s->def, cell) : NULL;
    if (status == DEM_OK && (!inputs || found.failed))
        status = dem_fail_memory(error);
    // what is kept is what is told, to the last digit
    if (status == DEM_OK)
        status = dem_json_parse(found.data, found.size, "cell", &r->found, error);
    if (status == DEM_OK && s->def->directory)
        status = keep(s->def, cell, inputs, found.data, r->seconds, error);
    free(inputs);
    dem_buffer_release(&found);
    return status;
}

static void run_some(void *user, int part)
{
    (void)part;
    study *s = user;
    size_t i;
    while ((i = atomic_fetch_add(&s->next, 1)) < s->count && !s->stop) {
        dem_cell_result *r = &s->results[s->todo[i]];
        r->status = run_cell(s, s->todo[i], r, &r->error);
        size_t done = atomic_fetch_add(&s->done, 1) + 1;
        if ((double)done / (double)s->count > s->told)
            s->told = (double)done / (double)s->count;
        bool asked = dem_progress(s->ctx, "cells", s->told);
        if (asked || r->status == DEM_INTERRUPTED || r->status == DEM_CANNOT_WRITE)
            s->stop = true;
    }
}

static dem_status run_all(study *s, dem_error *error)
{
    int threads = dem_threads(s->ctx);
    if ((size_t)threads > s->count)
        threads = (int)s->count;
    if (s->count == 0)
        return DEM_OK;
    dem_team *team = dem_team_create(threads);
    if (!team)
        return dem_fail_memory(error);
    dem_team_run(team, run_some, s);
    dem_team_destroy(team);
    size_t undone = 0;
    for (size_t i = 0; i < s->count; i++) {
        const dem_cell_result *r = &s->results[s->todo[i]];
        undone += r->status == DEM_INTERRUPTED;
        if (r->status == DEM_CANNOT_WRITE || r->status == DEM_NO_MEMORY) {
            if (error)
                *error = r->error;
            return r->status;
        }
    }
    return undone ? dem_fail(error, DEM_INTERRUPTED,
                             "interrupted with %zu of %zu cells to do; the same command goes on", undone, s->count)
                  : DEM_OK;
}

static dem_status choose(study *s, dem_error *error)
{
    for (size_t i = 0; i < s->def->count; i++) {
        s->results[i] = (dem_cell_result){.status = DEM_INTERRUPTED};
        char *inputs = inputs_of(s->def, i);
        if (!inputs)
            return dem_fail_memory(error);
        bool kept = s->def->directory && take_kept(s->def, i, inputs, &s->results[i]);
        free(inputs);
        if (!kept && (s->def->only == DEM_ALL_CELLS || s->def->only == i))
            s->todo[s->count++] = i;
    }
    return DEM_OK;
}

static dem_status make_folder(const dem_cells_def *def, dem_error *error)
{
    if (!def->directory)
        return DEM_OK;
    char *path = dem_path_join(def->directory, "cells");
    dem_status status = path ? dem_folder_create(path, error) : dem_fail_memory(error);
    free(path);
    return status;
}

dem_status dem_cells_run(const dem_ctx *ctx, const dem_cells_def *def, dem_cell_result *results, dem_error *error)
{
    study s = {.ctx = ctx, .def = def, .results = results, .todo = dem_alloc(def->count, sizeof(size_t))};
    memset(results, 0, def->count * sizeof *results);
    dem_status status = s.todo ? make_folder(def, error) : dem_fail_memory(error);
    if (status == DEM_OK)
        status = choose(&s, error);
    if (status == DEM_OK)
        status = run_all(&s, error);
    free(s.todo);
    return status;
}

void dem_cells_release(dem_cell_result *results, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        dem_json_release(results[i].found);
        results[i].found = NULL;
    }
}

double dem_cell_number(const dem_cell_result *result, const char *name)
{
    double value;
    return dem_json_number(dem_json_member(result->found, name), &value) ? value : NAN;
}

size_t dem_cell_numbers(const dem_cell_result *result, const char *name, double *values, size_t most)
{
    const dem_json *list = dem_json_member(result->found, name);
    size_t count = dem_json_length(list);
    count = count < most ? count : most;
    for (size_t i = 0; i < count; i++)
        if (!dem_json_number(dem_json_item(list, i), &values[i]))
            values[i] = NAN;
    return count;
}
