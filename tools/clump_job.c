#define _GNU_SOURCE
#include "clump_job.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "clump/pack.h"
#include "out/export.h"
#include "out/picture.h"

enum { PICTURE_WIDTH = 240, PICTURE_HEIGHT = 120 };

// the caller's log and progress, with the warnings kept for the report; a warning belongs to the result that is
// being made, and those of reading and repairing to every body of the file
typedef struct job {
    const dem_ctx *caller;
    const char *input;
    const dem_volume *volume;  // NULL: the input is a mesh
    dem_label label;
    const job_options *options;
    job_results *results;
    dem_ctx ctx;
    char **warnings;
    size_t warning_count, warning_capacity;
    char sha256[65];
    dem_mesh_report report;
    double started, seconds_read, seconds_repair;
} job;

static void keep_text(char ***texts, size_t *count, size_t *capacity, const char *text)
{
    char *copy = strdup(text);
    if (copy && dem_grow(texts, capacity, *count, sizeof **texts))
        (*texts)[(*count)++] = copy;
    else
        free(copy);
}

static void job_log(void *user, dem_log_level level, const char *subject, const char *text)
{
    job *j = user;
    if (level == DEM_LOG_WARNING)
        keep_text(&j->warnings, &j->warning_count, &j->warning_capacity, text);
    if (j->caller->log)
        j->caller->log(j->caller->user, level, subject, text);
}

static bool job_progress(void *user, const char *what, double fraction)
{
    job *j = user;
    return dem_progress(j->caller, what, fraction);
}

static job_result *add_result(job *j, const char *name)
{
    job_results *all = j->results;
    if (!dem_grow(&all->items, &all->capacity, all->count, sizeof *all->items))
        return NULL;
    job_result *r = &all->items[all->count++];
    *r = (job_result){.input = j->input, .report = j->report, .seconds_read = j->seconds_read,
                      .seconds_repair = j->seconds_repair, .label = j->label};
    if (j->volume)
        r->voxel_volume = (double)j->label.voxels * dem_volume_voxel(j->volume);
    snprintf(r->name, sizeof r->name, "%s", name);
    return r;
}

static dem_status read_and_repair(job *j, dem_mesh *mesh, dem_error *error)
{
    const job_options *o = j->options;
    if (j->volume) {
        DEM_TRY(dem_label_surface(&j->ctx, j->volume, &j->label, o->repair.keep, mesh, error));
        snprintf(j->sha256, sizeof j->sha256, "%s", j->volume->sha256);
    } else {
        DEM_TRY(dem_mesh_import(&j->ctx, j->input, mesh, error));
        if (strcmp(j->input, "-") != 0)
            DEM_TRY(dem_sha256_file(j->input, j->sha256, error));
        dem_mesh_scale(mesh, o->unit);
    }
    j->seconds_read = dem_clock() - j->started;
    DEM_TRY(dem_mesh_repair(&j->ctx, mesh, &o->repair, &j->report, error));
    j->seconds_repair = dem_clock() - j->started - j->seconds_read;
    return DEM_OK;
}

// the file a format goes to: `base` with the format's suffix
static char *output_path(const char *folder, const char *base, const char *suffix)
{
    char *path = NULL;
    size_t length = folder ? strlen(folder) : 0;
    const char *slash = length && folder[length - 1] != '/' ? "/" : "";
    if (asprintf(&path, "%s%s%s.%s", folder ? folder : "", slash, base, suffix) < 0)
        return NULL;
    return path;
}

// `out.json` of body 2 of several: `out-2.json`
static char *numbered(const dem_exporter *exporter, const char *path, size_t body, size_t bodies)
{
    if (bodies < 2 || strcmp(path, "-") == 0)
        return strdup(path);
    size_t stem = dem_exporter_stem(exporter, path);
    char *numbered_path = NULL;
    if (asprintf(&numbered_path, "%.*s-%zu%s", (int)stem, path, body + 1, path + stem) < 0)
        return NULL;
    return numbered_path;
}

static dem_status write_one(job *j, job_result *r, const dem_mesh *mesh, const dem_exporter *exporter, char *path,
                            dem_error *error)
{
    if (!path)
        return dem_fail_memory(error);
    dem_export_options options = {.frame = j->options->frame, .mesh = mesh, .threads = j->ctx.threads};
    dem_status status = dem_export(exporter, r->clump, &options, path, error);
    size_t capacity = r->output_count;
    if (status == DEM_OK)
        keep_text(&r->outputs, &r->output_count, &capacity, path);
    free(path);
    return status;
}

static dem_status write_outputs(job *j, job_result *r, const dem_mesh *mesh, size_t body, size_t bodies,
                                dem_error *error)
{
    const job_options *o = j->options;
    // of a search that was stopped the best so far is written
    if (!r->pack.interrupted && dem_progress(&j->ctx, "writing", 1))
        return dem_fail(error, DEM_INTERRUPTED, "interrupted; nothing was written");
    if (o->folder || o->outputs.count == 0) {
        size_t count = o->formats.count ? o->formats.count : 1;
        for (size_t i = 0; i < count; i++) {
            const dem_exporter *exporter = dem_exporter_find(o->formats.count ? o->formats.items[i] : "json");
            dem_status status =
                write_one(j, r, mesh, exporter, output_path(o->folder, r->name, exporter->suffix), error);
            if (status == DEM_UNAVAILABLE && o->every_format)
                dem_log(&j->ctx, DEM_LOG_WARNING, "no %s: %s", exporter->name, error->text);
            else if (status != DEM_OK)
                return status;
        }
        return DEM_OK;
    }
    for (size_t i = 0; i < o->outputs.count; i++) {
        const char *path = o->outputs.items[i];
        const dem_exporter *exporter = dem_exporter_of_file(path);
        if (i < o->formats.count)
            exporter = dem_exporter_find(o->formats.items[i]);
        DEM_TRY(write_one(j, r, mesh, exporter, numbered(exporter, path, body, bodies), error));
    }
    return DEM_OK;
}

// from what the clump keeps: fast however large the mesh is
static dem_status draw(job *j, job_result *r, dem_error *error)
{
    dem_clump_def c = dem_clump_view(r->clump);
    dem_ctx ctx = {.threads = j->ctx.threads};
    return dem_picture_render(&ctx, &c.surface, c.balls, c.ball_count, PICTURE_WIDTH, PICTURE_HEIGHT, &r->picture, NULL,
                              error);
}

// to the size asked for
static void rescale(const job_options *o, job_result *r, dem_mesh *mesh)
{
    r->solid = dem_mesh_solid(mesh);
    if (o->size > 0) {
        dem_mesh_scale(mesh, o->size / cbrt(6 * r->solid.volume / 3.14159265358979323846));
        r->solid = dem_mesh_solid(mesh);
    }
}

static dem_status finish_body(job *j, job_result *r, dem_mesh *mesh, size_t body, size_t bodies, dem_error *error)
{
    const job_options *o = j->options;
    rescale(o, r, mesh);
    dem_make_options make = o->make;
    make.name = r->name;
    make.source_mesh = strcmp(j->input, "-") ? dem_file_name(j->input) : "standard input";
    make.source_sha256 = j->sha256;
    make.source_unit = j->volume && !o->unit_given && *j->volume->unit_name ? j->volume->unit_name : o->unit_name;
    DEM_TRY(dem_clump_make(&j->ctx, mesh, &make, &r->clump, &r->pack, error));
    free(r->pack.balls);
    r->pack.balls = NULL;
    if (o->picture)
        DEM_TRY(draw(j, r, error));
    if (o->moments_asked && make.pack.moments != DEM_MOMENTS_FREE && !dem_packer_find(make.pack.method)->keeps_moments)
        dem_log(&j->ctx, DEM_LOG_WARNING,
                "the method %s cannot give the spheres' union the grain's moments; the clump's own mass and inertia "
                "are the mesh's all the same", make.pack.method);
    return write_outputs(j, r, mesh, body, bodies, error);
}

static void run_body(job *j, dem_mesh *mesh, const char *name, size_t body, size_t bodies)
{
    char body_name[256];
    snprintf(body_name, sizeof body_name, bodies > 1 ? "%.240s-%zu" : "%.240s", name, body + 1);
    job_result *r = add_result(j, body_name);
    if (!r)
        return;
    size_t common = j->warning_count;
    r->status = finish_body(j, r, mesh, body, bodies, &r->error);
    if (r->status != DEM_OK && !r->error.file[0])
        snprintf(r->error.file, sizeof r->error.file, "%s", j->ctx.subject);
    r->seconds_total = dem_clock() - j->started;
    size_t capacity = 0;
    for (size_t i = 0; i < j->warning_count; i++)
        keep_text(&r->warnings, &r->warning_count, &capacity, j->warnings[i]);
    while (j->warning_count > common)
        free(j->warnings[--j->warning_count]);
}

static void run_bodies(job *j, dem_mesh *mesh, const char *name)
{
    if (!j->options->split) {
        run_body(j, mesh, name, 0, 1);
        return;
    }
    dem_mesh *bodies;
    size_t count;
    dem_error error;
    dem_status status = dem_mesh_split(mesh, &bodies, &count, &error);
    if (status != DEM_OK) {
        job_result *r = add_result(j, name);
        if (r) {
            r->status = status;
            r->error = error;
        }
        return;
    }
    for (size_t i = 0; i < count; i++) {
        run_body(j, &bodies[i], name, i, count);
        dem_mesh_free(&bodies[i]);
    }
    free(bodies);
}

static void open_job(job *j)
{
    j->started = dem_clock();
    j->ctx = (dem_ctx){.log = job_log, .progress = job_progress, .user = j, .subject = j->caller->subject,
                       .threads = j->caller->threads};
}

// a file as it is called in messages
static dem_ctx about_file(const dem_ctx *ctx, const char *input)
{
    dem_ctx about = *ctx;
    about.subject = strcmp(input, "-") ? input : "standard input";
    return about;
}

dem_status job_read(const dem_ctx *ctx, const char *input, const char *name, const job_options *options,
                    dem_mesh *mesh, job_result *result)
{
    dem_ctx about = about_file(ctx, input);
    job j = {.caller = &about, .input = input, .options = options};
    open_job(&j);
    *result = (job_result){.input = input};
    snprintf(result->name, sizeof result->name, "%s", name);
    result->status = read_and_repair(&j, mesh, &result->error);
    if (result->status == DEM_OK)
        rescale(options, result, mesh);
    else if (!result->error.file[0])
        snprintf(result->error.file, sizeof result->error.file, "%s", j.ctx.subject);
    result->report = j.report;
    result->seconds_read = j.seconds_read;
    result->seconds_repair = j.seconds_repair;
    result->warnings = j.warnings;
    result->warning_count = j.warning_count;
    return result->status;
}

static void run(job *j, const char *name)
{
    open_job(j);
    dem_mesh mesh = {0};
    dem_error error = {0};
    dem_status status = read_and_repair(j, &mesh, &error);
    if (status == DEM_OK)
        run_bodies(j, &mesh, name);
    else {
        job_result *r = add_result(j, name);
        if (r) {
            r->status = status;
            r->error = error;
            if (!error.file[0])
                snprintf(r->error.file, sizeof r->error.file, "%s", j->ctx.subject);
            r->seconds_total = dem_clock() - j->started;
            r->warnings = j->warnings;
            r->warning_count = j->warning_count;
            j->warnings = NULL;
            j->warning_count = 0;
        }
    }
    dem_mesh_free(&mesh);
    while (j->warning_count)
        free(j->warnings[--j->warning_count]);
    free(j->warnings);
}

void job_run(const dem_ctx *ctx, const char *input, const char *name, const job_options *options,
             job_results *results)
{
    dem_ctx about = about_file(ctx, input);
    run(&(job){.caller = &about, .input = input, .options = options, .results = results}, name);
}

void job_run_label(const dem_ctx *ctx, const dem_volume *volume, const dem_label *label, const char *input,
                   const char *name, const job_options *options, job_results *results)
{
    char subject[300];
    snprintf(subject, sizeof subject, "%.260s: label %u", input, label->value);
    dem_ctx about = *ctx;
    about.subject = subject;
    run(&(job){.caller = &about, .input = input, .volume = volume, .label = *label, .options = options,
               .results = results}, name);
}

bool job_is_done(const char *name, const job_options *o)
{
    bool done = o->folder || o->outputs.count == 0;
    for (size_t i = 0; done && i < (o->formats.count ? o->formats.count : 1); i++) {
        const dem_exporter *exporter = dem_exporter_find(o->formats.count ? o->formats.items[i] : "json");
        char *path = output_path(o->folder, name, exporter->suffix);
        done = path && access(path, R_OK) == 0;
        free(path);
    }
    return done;
}

void job_keep(const char *input, const char *name, const dem_volume *volume, const dem_label *label,
              const job_options *o, job_results *results)
{
    job j = {.input = input, .volume = volume, .options = o, .results = results};
    if (volume)
        j.label = *label;
    job_result *r = add_result(&j, name);
    if (!r)
        return;
    r->kept = true;
    r->solid = (dem_solid){.volume = NAN, .area = NAN};
    char *path = output_path(o->folder, name, "json");
    dem_error error;
    if (path && access(path, R_OK) == 0 && dem_clump_read(path, &r->clump, &error) == DEM_OK && o->picture)
        draw(&j, r, &error);
    free(path);
}

void job_fail(const char *input, const char *name, const dem_error *error, job_results *results)
{
    job j = {.input = input, .results = results};
    job_result *r = add_result(&j, name);
    if (r) {
        r->status = error->code;
        r->error = *error;
    }
}

void job_results_slim(job_results *results)
{
    for (size_t i = 0; i < results->count; i++) {
        job_result *r = &results->items[i];
        dem_image_free(&r->picture);
        if (!r->clump)
            continue;
        dem_clump_def def = dem_clump_view(r->clump);
        dem_clump *slim;
        dem_error error;
        def.surface = (dem_mesh){0};
        if (dem_clump_create(&def, &slim, &error) == DEM_OK) {
            dem_clump_destroy(r->clump);
            r->clump = slim;
        }
    }
}

void job_results_move(job_results *to, job_results *from)
{
    for (size_t i = 0; i < from->count; i++) {
        if (!dem_grow(&to->items, &to->capacity, to->count, sizeof *to->items))
            return;
        to->items[to->count++] = from->items[i];
        from->items[i] = (job_result){0};
    }
}

void job_result_release(job_result *r)
{
    dem_clump_destroy(r->clump);
    dem_image_free(&r->picture);
    for (size_t k = 0; k < r->warning_count; k++)
        free(r->warnings[k]);
    for (size_t k = 0; k < r->output_count; k++)
        free(r->outputs[k]);
    free(r->warnings);
    free(r->outputs);
    *r = (job_result){0};
}

void job_results_release(job_results *results)
{
    for (size_t i = 0; i < results->count; i++)
        job_result_release(&results->items[i]);
    free(results->items);
    *results = (job_results){0};
}

dem_status job_write(const dem_ctx *ctx, const job_options *options, job_result *result, const dem_mesh *mesh,
                     dem_error *error)
{
    job j = {.caller = ctx, .options = options, .ctx = *ctx};
    return write_outputs(&j, result, mesh, 0, 1, error);
}
