/// dem-run: runs scenes of clumps.
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "cli.h"
#include "dem/scene.h"
#include "dem/world.h"
#include "out/run.h"
#include "out/run_report.h"

typedef struct arguments {
    cli_common common;
    const char *output, *resume;
    double until;
    long steps, warmup;
    bool check, explain, defaults;
    cli_texts overrides;
} arguments;

static const char about[] =
    "Runs a scene (dem-scene/1, JSON with comments) of clumps and walls: full 6-DOF central differences, contact laws, "
    "mesh walls. Results go to the scene's output directory: frames for ParaView, series.csv, final.csv, run.json, "
    "checkpoints.";

static const char epilogue[] =
    "Examples:\n"
    "  dem-run sand.json                                run it\n"
    "  dem-run sand.json --check                        is it right?\n"
    "  dem-run sand.json --explain                      what does it pay for?\n"
    "  dem-run sand.json -D contacts.0.friction.coefficient=0.3 -o out-0.3\n"
    "  dem-run sand.json --resume out/checkpoint-5000.dem\n"
    "Files:\n"
    "  DIR/run.pvd, walls.pvd    frames for ParaView, with frames/ and shapes/\n"
    "  DIR/series.csv            energies, contacts, forces on walls over time\n"
    "  DIR/final.csv             the last state; may be the bodies of another scene\n"
    "  DIR/run.json              the resolved scene, timings, the ledger of energies\n"
    "  DIR/checkpoint-STEP.dem   for --resume\n"
    "Exit status: 0 done, 1 the run failed, 2 wrong usage, 3 bad input, 4 cannot write, 130 interrupted.";

static int print_text(const cli_tool *tool, char *text)
{
    dem_buffer out = {0};
    dem_buffer_text(&out, text);
    free(text);
    return cli_print(tool, &out);
}

static int print_defaults(const cli_tool *tool)
{
    dem_scene scene = dem_scene_defaults();
    dem_error error;
    char *text;
    if (dem_scene_resolved(&scene, &text, &error) != DEM_OK)
        return cli_error(tool, &error);
    return print_text(tool, text);
}

// --check and --explain: makes the world, which tries everything short of running
static int look(cli_session *session, const arguments *a, const dem_scene *scene, const char *file)
{
    dem_ctx ctx = cli_ctx(session, NULL);
    dem_world *world;
    dem_error error;
    char *text = NULL;
    if (dem_world_create(&ctx, scene, &world, &error) != DEM_OK)
        return cli_session_error(session, &error);
    int status = 0;
    const dem_figures *f = dem_world_figures(world);
    dem_buffer out = {0};
    if (a->explain) {
        if (dem_world_explain(world, &text, &error) != DEM_OK)
            status = cli_session_error(session, &error);
        else
            status = print_text(session->tool, text);
    } else if (!a->common.quiet) {
        dem_buffer_print(&out, "%s: good: %zu bodies of %zu spheres, %zu walls, step ", file, f->bodies, f->spheres,
                         scene->wall_count);
        dem_buffer_number(&out, dem_world_step_size(world), 4);
        dem_buffer_text(&out, " s\n");
        status = cli_print(session->tool, &out);
    }
    dem_world_destroy(world);
    return status;
}

static dem_run_report report_of(const cli_session *session, const dem_scene *scene, const dem_run_result *r,
                                const char *resolved)
{
    return (dem_run_report){.title = scene->title,
                            .scene = resolved,
                            .ended = r->stopped ? r->stopped : "done",
                            .figures = r->figures,
                            .steps = r->timed_steps,
                            .warmup = r->warmup,
                            .step = r->step,
                            .critical_step = r->critical_step,
                            .loop_seconds = r->loop_seconds,
                            .setup_seconds = r->setup_seconds,
                            .bytes_per_clump = r->bytes_per_body,
                            .threads = r->threads,
                            .passes = r->passes,
                            .pass_count = r->pass_count,
                            .inlets = r->inlets,
                            .inlet_count = r->inlet_count,
                            .warnings = (const char *const *)session->warnings.items,
                            .warning_count = session->warnings.count};
}

static int write_report(cli_session *session, const arguments *a, const dem_scene *scene, const dem_run_result *result)
{
    dem_error error;
    char *resolved;
    if (dem_scene_resolved(scene, &resolved, &error) != DEM_OK)
        return cli_session_error(session, &error);
    dem_run_report report = report_of(session, scene, result, resolved);
    dem_status status = dem_run_report_write(scene->output.directory, &report, &error);
    free(resolved);
    if (status != DEM_OK)
        return cli_session_error(session, &error);
    dem_buffer out = {0};
    if (a->common.json)
        dem_run_report_json(&out, &report);
    else if (!a->common.quiet)
        dem_run_report_text(&out, &report);
    return out.size ? cli_print(session->tool, &out) : 0;
}

static int run(cli_session *session, const arguments *a, dem_scene *scene)
{
    dem_ctx ctx = cli_ctx(session, NULL);
    dem_run_options options = {a->resume, a->until, (uint64_t)a->steps, (uint64_t)a->warmup, scene};
    dem_run_result result;
    dem_error error;
    dem_status status = dem_run(&ctx, scene, &options, &result, &error);
    int reported = 0;
    if (result.passes)
        reported = write_report(session, a, scene, &result);
    if (status != DEM_OK)
        reported = cli_session_error(session, &error);
    dem_run_release(&result);
    return reported;
}

static int start(const cli_tool *tool, arguments *a, const cli_texts *operands)
{
    if (a->defaults)
        return print_defaults(tool);
    if (operands->count != 1)
        return cli_wrong_usage(tool, operands->count ? "one scene at a time" : "name the scene to run");
    const char **overrides = calloc(a->overrides.count + 1, sizeof *overrides), *file = operands->items[0];
    cli_session session;
    cli_begin(&session, tool, &a->common);
    dem_ctx ctx = cli_ctx(&session, NULL);
    dem_scene scene;
    dem_error error;
    int status = 0;
    if (!overrides)
        status = DEM_FAILED;
    else {
        for (size_t i = 0; i < a->overrides.count; i++)
            overrides[i] = a->overrides.items[i];
        if (dem_scene_read(&ctx, file, overrides, &scene, &error) != DEM_OK)
            status = cli_session_error(&session, &error);
        else {
            if (a->output)
                scene.output.directory = a->output;
            status = a->check || a->explain ? look(&session, a, &scene, file) : run(&session, a, &scene);
            dem_scene_release(&scene);
        }
    }
    cli_end(&session);
    free(overrides);
    return status;
}

int main(int argc, char **argv)
{
    arguments a = {.common = CLI_COMMON_DEFAULTS, .until = NAN};
    const cli_option options[] = {
        {.help = "Running"},
        {"output", 'o', CLI_TEXT, "DIR", "where results go (default: the scene's output.directory)", &a.output, 0, 0},
        {"until", 0, CLI_TIME, "T", "end at this time (default: the scene's time.end)", &a.until, CLI_POSITIVE,
         INFINITY},
        {"steps", 0, CLI_WHOLE, "N",
         "end after N steps, counted from the scene's start; with --until, what comes first", &a.steps, 1, 0x1p53},
        {"warmup", 0, CLI_WHOLE, "N", "N more steps before those, which are not timed", &a.warmup, 0, 0x1p53},
        {"resume", 0, CLI_TEXT, "CHECKPOINT", "go on from here, bit for bit", &a.resume, 0, 0},
        {"define", 'D', CLI_TEXTS, "PATH=VALUE", "set a value of the scene, as in -D time.step=1e-6", &a.overrides, 0,
         0},
        {.help = "Looking"},
        {"check", 0, CLI_FLAG, NULL, "read and prepare the scene, say whether it is right, and leave", &a.check, 0, 0},
        {"explain", 0, CLI_FLAG, NULL, "tell what the scene pays for: columns, passes, kernel, libraries, time step",
         &a.explain, 0, 0},
        {"defaults", 0, CLI_FLAG, NULL, "print a scene with every default and leave", &a.defaults, 0, 0},
        CLI_COMMON_OPTIONS(a.common),
    };
    const cli_tool tool = {.name = "dem-run",
                           .usage = "SCENE [options]",
                           .about = about,
                           .options = options,
                           .option_count = sizeof options / sizeof *options,
                           .epilogue = epilogue};
    cli_texts operands = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &operands, &status) == CLI_GO)
        status = start(&tool, &a, &operands);
    cli_texts_release(&operands);
    cli_texts_release(&a.overrides);
    return status;
}
