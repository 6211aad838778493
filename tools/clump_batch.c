#define _GNU_SOURCE
#include "clump_batch.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "clump_labels.h"
#include "clump_outputs.h"
#include "clump_report.h"
#include "clump_scene.h"
#include "clump_table.h"
#include "out/picture.h"
#include "out/sheet.h"

enum { FAILURES_TOLD = 5 };

typedef struct batch {
    const cli_tool *tool;
    const job_options *options;
    const batch_options *asked;
    bool several;
    cli_session session;
    clump_table table;
    dem_sheet *sheet;
    clump_scene scene;  // of the volume at hand
    job_results *results;
    size_t made, kept, failed, undone;
    dem_buffer failures;
    dem_status status;     // of the last failed grain, of the table or of the sheet
    pthread_mutex_t lock;  // of everything above and of the tasks' `done`
} batch;

// one grain of a file, or all bodies of it
typedef struct task {
    const char *input, *name;
    const dem_volume *volume;  // NULL: a mesh
    const dem_label *label;
    job_results results;
    bool done;
} task;

static void tell_failure(batch *b, const job_result *r)
{
    if (b->failed++ < FAILURES_TOLD) {
        const char *file = r->error.file[0] ? r->error.file : r->input;
        dem_buffer_print(&b->failures, "%s%s: %.200s", b->failures.size ? "; " : "", file, r->error.text);
    }
    b->status = r->status;
}

// a table or sheet that cannot be written ends the batch's good status, not the batch
static void told(batch *b, dem_status status, const dem_error *error)
{
    if (status == DEM_OK)
        return;
    b->status = status;
    cli_session_error(&b->session, error);
}

static void show_on_sheet(batch *b, job_result *r)
{
    char note[80] = "failed";
    dem_error error;
    if (r->clump) {
        dem_clump_def c = dem_clump_view(r->clump);
        char gap[32];
        snprintf(note, sizeof note, "%zu spheres, gap %s %%", c.ball_count,
                 dem_format_double(gap, sizeof gap, 100 * c.fidelity.iou_gap, 3));
    }
    told(b, dem_sheet_add(b->sheet, &r->picture, r->name, note, &error), &error);
}

// what became of a grain goes to table, sheet and report; then its memory is given back
static void take_results(batch *b, task *t)
{
    for (size_t i = 0; i < t->results.count; i++) {
        job_result *r = &t->results.items[i];
        dem_error error;
        if (r->status == DEM_INTERRUPTED) {
            b->undone++;
            continue;
        }
        if (r->status != DEM_OK)
            tell_failure(b, r);
        else if (r->kept)
            b->kept++;
        else
            b->made++;
        told(b, clump_table_add(&b->table, r, &error), &error);
        if (b->sheet)
            show_on_sheet(b, r);
        if (t->volume && b->options->folder && r->status == DEM_OK)
            clump_scene_add(&b->scene, r);
    }
    if (b->asked->keep_results) {
        if (b->several)
            job_results_slim(&t->results);
        job_results_move(b->results, &t->results);
    }
    job_results_release(&t->results);
}

static void run_task(batch *b, task *t, int threads)
{
    dem_ctx ctx = cli_ctx(&b->session, t->input);
    if (threads)
        ctx.threads = threads;
    if (b->asked->resume && job_is_done(t->name, b->options))
        job_keep(t->input, t->name, t->volume, t->label, b->options, &t->results);
    else if (t->volume)
        job_run_label(&ctx, t->volume, t->label, t->input, t->name, b->options, &t->results);
    else
        job_run(&ctx, t->input, t->name, b->options, &t->results);
    for (size_t k = 0; k < t->results.count; k++) {
        dem_status status = t->results.items[k].status;
        if (status != DEM_OK && (status != DEM_INTERRUPTED || !b->several))
            cli_session_error(&b->session, &t->results.items[k].error);
    }
}

// told of in order: `told_of` counts the tasks in front that are
static void finish_task(batch *b, task *tasks, size_t count, size_t i, size_t *told_of)
{
    pthread_mutex_lock(&b->lock);
    tasks[i].done = true;
    for (; *told_of < count && tasks[*told_of].done; ++*told_of)
        take_results(b, &tasks[*told_of]);
    pthread_mutex_unlock(&b->lock);
    cli_job_done(&b->session);
}

// Grains run side by side, each on one core; alone, a grain gets them all: outside of any team, as inside of one each
// loop in parallel would make its threads anew.
static void run_tasks(batch *b, task *tasks, size_t count)
{
    dem_ctx all = cli_ctx(&b->session, NULL);
    size_t told_of = 0;
    b->session.jobs += count;
    if (count == 1 && !cli_interrupted()) {
        run_task(b, &tasks[0], 0);
        finish_task(b, tasks, count, 0, &told_of);
        return;
    }
#pragma omp parallel for schedule(dynamic, 1) num_threads(dem_threads(&all))
    for (size_t i = 0; i < count; i++) {
        bool stop = cli_interrupted();
        if (!stop)
            run_task(b, &tasks[i], 1);
        else {
            pthread_mutex_lock(&b->lock);
            b->undone++;
            pthread_mutex_unlock(&b->lock);
        }
        finish_task(b, tasks, count, i, &told_of);
    }
}

static void fail_input(batch *b, const clump_input *input, const dem_error *error)
{
    task t = {.input = input->path, .name = input->name};
    job_fail(input->path, input->name, error, &t.results);
    if (error->code != DEM_INTERRUPTED)
        cli_session_error(&b->session, error);
    take_results(b, &t);
}

// a volume's labels are a batch of their own; it is given back before the next one is read
static void run_volume(batch *b, const clump_input *input)
{
    dem_ctx ctx = cli_ctx(&b->session, input->path);
    dem_volume volume;
    label_list labels;
    dem_error error;
    if (labels_find(&ctx, input, b->options, b->asked, &volume, &labels, &error) != DEM_OK) {
        if (!error.file[0])
            snprintf(error.file, sizeof error.file, "%s", input->path);
        fail_input(b, input, &error);
        return;
    }
    task *tasks = dem_alloc_zero(labels.count, sizeof *tasks);
    for (size_t i = 0; tasks && i < labels.count; i++)
        tasks[i] = (task){.input = input->path, .name = labels.names[i], .volume = &volume, .label = labels.items[i]};
    if (tasks)
        run_tasks(b, tasks, labels.count);
    free(tasks);
    if (b->options->folder)
        told(b, clump_scene_finish(&b->scene, b->options->folder, input->name, &error), &error);
    labels_release(&labels);
    dem_volume_free(&volume);
}

static void run_meshes(batch *b, const clump_input *inputs, size_t count)
{
    task *tasks = dem_alloc_zero(count, sizeof *tasks);
    for (size_t i = 0; tasks && i < count; i++)
        tasks[i] = (task){.input = inputs[i].path, .name = inputs[i].name};
    if (tasks)
        run_tasks(b, tasks, count);
    free(tasks);
}

static void run_inputs(batch *b, const clump_inputs *inputs)
{
    for (size_t i = 0, end; i < inputs->count; i = end) {
        end = i + 1;
        if (inputs->items[i].labels) {
            if (!cli_interrupted())
                run_volume(b, &inputs->items[i]);
            continue;
        }
        while (end < inputs->count && !inputs->items[end].labels)
            end++;
        run_meshes(b, inputs->items + i, end - i);
    }
}

// the last line of a batch
static void sum_up(batch *b)
{
    dem_buffer text = {0};
    dem_buffer_print(&text, "%s%zu made", cli_interrupted() ? "interrupted: " : "", b->made);
    if (b->kept)
        dem_buffer_print(&text, ", %zu kept from before", b->kept);
    if (b->failed)
        dem_buffer_print(&text, ", %zu failed", b->failed);
    if (b->undone)
        dem_buffer_print(&text, ", %zu not done; --resume goes on", b->undone);
    if (b->failed)
        dem_buffer_print(&text, ": %s", b->failures.data ? b->failures.data : "");
    if (b->failed > FAILURES_TOLD)
        dem_buffer_print(&text, "; and %zu more", b->failed - FAILURES_TOLD);
    if (text.data && (b->failed || b->undone || !b->session.common->quiet))
        cli_session_say(&b->session, text.data);
    dem_buffer_release(&text);
}

// whether pictures can be made at all: better told before hours of packing than after each grain
static dem_status try_picture(dem_error *error)
{
    const dem_ball ball = {{0, 0, 0}, 1};
    const dem_mesh none = {0};
    dem_image image;
    dem_status status = dem_picture_render(&(dem_ctx){.threads = 1}, &none, &ball, 1, 8, 8, &image, NULL, error);
    dem_image_free(&image);
    return status;
}

int batch_run(const cli_tool *tool, const cli_common *common, const clump_inputs *inputs, const job_options *options,
              const batch_options *asked, job_results *results)
{
    batch b = {.tool = tool, .options = options, .asked = asked, .several = inputs->several, .results = results};
    dem_error error;
    bool labels = false;
    for (size_t i = 0; i < inputs->count; i++)
        labels |= inputs->items[i].labels;
    if (asked->sheet && try_picture(&error) != DEM_OK)
        return cli_error(tool, &error);
    if (clump_table_open(&b.table, asked->table, labels, asked->resume, &error) != DEM_OK)
        return cli_error(tool, &error);
    if (asked->sheet && !(b.sheet = dem_sheet_create(asked->sheet))) {
        clump_table_close(&b.table, &error);
        dem_fail_memory(&error);
        return cli_error(tool, &error);
    }
    cli_begin(&b.session, tool, common);
    pthread_mutex_init(&b.lock, NULL);
    run_inputs(&b, inputs);
    told(&b, clump_table_close(&b.table, &error), &error);
    if (b.sheet)
        told(&b, dem_sheet_finish(b.sheet, &error), &error);
    if (b.several)
        sum_up(&b);
    cli_end(&b.session);
    pthread_mutex_destroy(&b.lock);
    dem_buffer_release(&b.failures);
    return outputs_status(b.status, b.failed && b.several);
}
