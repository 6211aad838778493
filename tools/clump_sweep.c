#include "clump_sweep.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

typedef struct sweep_job {
    const cli_tool *tool;
    const sweep_options *options;
    cli_session session;
    dem_buffer text;  // for standard output
    dem_json_writer json;
    size_t failed;
} sweep_job;

static dem_status measure_grain(const dem_ctx *ctx, const char *input, const char *name, const sweep_options *options,
                                sweep_grain *g, dem_error *error)
{
    const job_options *job = options->job;
    DEM_TRY(job_read(ctx, input, name, job, &g->mesh, &g->base));
    DEM_TRY(dem_shape_measure(ctx, &g->mesh, &g->shape, error));
    return dem_sweep_run(ctx, &g->mesh, &job->make.pack, &g->sweep, error);
}

static bool has_cells(const sweep_grain *g)
{
    for (size_t i = 0; g->sweep.cells && i < g->sweep.series_count * g->sweep.count_count; i++)
        if (g->sweep.cells[i].ran)
            return true;
    return false;
}

static dem_status write_report(const dem_ctx *ctx, const sweep_grain *g, const sweep_options *options, const char *path,
                               dem_error *error)
{
    dem_buffer text = {0};
    dem_status status = DEM_OK;
    if (dem_file_has_suffix(path, "csv"))
        sweep_csv(&text, g);
    else if (dem_file_has_suffix(path, "svg"))
        status = sweep_svg(&text, g, error);
    else
        status = sweep_page(ctx, &text, g, options, error);
    if (status == DEM_OK)
        return dem_file_write_buffer(path, &text, error);
    dem_buffer_release(&text);
    return status;
}

static dem_status write_reports(const dem_ctx *ctx, sweep_grain *g, const sweep_options *options, dem_error *error)
{
    static const char *const kinds[] = {"csv", "svg", "html"};
    const job_options *job = options->job;
    for (size_t i = 0; i < job->outputs.count; i++)
        DEM_TRY(write_report(ctx, g, options, job->outputs.items[i], error));
    for (size_t i = 0; job->folder && i < 3; i++) {
        char *path = dem_path_join(job->folder, "%s.%s", g->base.name, kinds[i]);
        dem_status status = path ? write_report(ctx, g, options, path, error) : dem_fail_memory(error);
        free(path);
        DEM_TRY(status);
    }
    return DEM_OK;
}

// what is there is told and written, also of a sweep that was stopped
static dem_status run_grain(sweep_job *job, const char *input, const char *name)
{
    dem_ctx ctx = cli_ctx(&job->session, input);
    sweep_grain g = {.sweep = job->options->plan};
    dem_error error = {0}, second = {0};
    dem_status status = measure_grain(&ctx, input, name, job->options, &g, &error);
    if (g.base.status != DEM_OK)
        error = g.base.error;
    if (has_cells(&g)) {
        if (!job->options->json && !job->options->quiet)
            sweep_text(&job->text, &g, job->options);
        dem_status written = write_reports(&ctx, &g, job->options, &second);
        if (written != DEM_OK && status == DEM_OK) {
            status = written;
            error = second;
        }
    }
    g.base.status = status;
    g.base.error = error;
    if (status != DEM_OK) {
        if (!error.file[0] && status != DEM_CANNOT_WRITE)
            snprintf(error.file, sizeof error.file, "%s", input);
        cli_session_error(&job->session, &error);
        job->failed++;
    }
    if (job->options->json)
        sweep_json(&job->json, &g, job->options);
    dem_sweep_release(&g.sweep);
    dem_mesh_free(&g.mesh);
    job_result_release(&g.base);
    return status;
}

static int status_of(dem_status status, bool several)
{
    if (status == DEM_NO_MEMORY)
        return DEM_FAILED;
    if (status == DEM_UNAVAILABLE || (several && status != DEM_OK && status != DEM_CANNOT_WRITE))
        return DEM_BAD_INPUT;
    return (int)status;
}

int sweep_run(const cli_tool *tool, const cli_common *common, const clump_inputs *inputs, const sweep_options *options)
{
    sweep_job job = {.tool = tool, .options = options};
    bool several = inputs->several;
    int status = 0;
    job.json = dem_json_begin(&job.text);
    cli_begin(&job.session, tool, common);
    if (options->json && several) {
        dem_json_open_object(&job.json, NULL);
        dem_json_open_array(&job.json, "grains", true);
    }
    for (size_t i = 0; i < inputs->count && !cli_interrupted(); i++) {
        dem_status one = run_grain(&job, inputs->items[i].path, inputs->items[i].name);
        if (one != DEM_OK)
            status = status_of(one, several);
    }
    if (options->json && several) {
        dem_json_close(&job.json, ']');
        dem_json_put_whole(&job.json, "failed", (int64_t)job.failed);
        dem_json_close(&job.json, '}');
    }
    cli_end(&job.session);
    int printed = job.text.size ? cli_print(tool, &job.text) : 0;
    if (printed)
        status = printed;
    return cli_interrupted() ? DEM_INTERRUPTED : status;
}
