#include "study_convergence.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "sim/schemes.h"
#include "study/model.h"
#include "study_output.h"

typedef struct arguments {
    cli_common common;
    cli_texts overrides;
    const char *integrators, *of, *output;
    double error;
    long levels, members, cell;
    bool list;
} arguments;

// what is compared, and where from
typedef struct work {
    model *model;  // of a scene of our own
    dem_scene scene;
    const dem_convergence_scene *own;
    const char *name;
    dem_integrator_def methods[DEM_CONVERGENCE_METHODS];
    size_t method_count;
} work;

// ---- integrators

static int index_of(const dem_scheme *schemes, int count, const char *name, size_t length)
{
    for (int i = 0; i < count; i++)
        if (strlen(schemes[i].name) == length && strncmp(schemes[i].name, name, length) == 0)
            return i;
    return -1;
}

static void add_method(work *w, dem_integrator_def method)
{
    for (size_t i = 0; i < w->method_count; i++)
        if (w->methods[i].translation == method.translation && w->methods[i].rotation == method.rotation)
            return;
    if (w->method_count < DEM_CONVERGENCE_METHODS)
        w->methods[w->method_count++] = method;
}

// three of them step alike
static bool steps_as_central(dem_translation t)
{
    return t == DEM_TRANSLATION_CENTRAL || t == DEM_TRANSLATION_VELOCITY_VERLET || t == DEM_TRANSLATION_NEWMARK;
}

// each rotation by the scene's translation, then each translation that differs by its rotation
static void add_all(work *w)
{
    dem_integrator_def own = w->scene.integrator;
    for (int i = 0; i < DEM_ROTATION_SCHEMES; i++)
        add_method(w, (dem_integrator_def){own.translation, (dem_rotation)i});
    bool central = steps_as_central(own.translation);
    for (int i = 0; i < DEM_TRANSLATION_SCHEMES; i++) {
        bool known = central && steps_as_central((dem_translation)i);
        central |= steps_as_central((dem_translation)i);
        if (!known)
            add_method(w, (dem_integrator_def){(dem_translation)i, own.rotation});
    }
}

// "lsym4", "taylor" or "taylor+pcdm"
static bool read_method(const char *word, size_t length, dem_integrator_def *method)
{
    const char *plus = memchr(word, '+', length);
    size_t first = plus ? (size_t)(plus - word) : length;
    int translation = index_of(dem_translations, DEM_TRANSLATION_SCHEMES, word, first);
    int rotation = plus ? index_of(dem_rotations, DEM_ROTATION_SCHEMES, plus + 1, length - first - 1)
                        : index_of(dem_rotations, DEM_ROTATION_SCHEMES, word, length);
    if (plus ? translation < 0 || rotation < 0 : translation < 0 && rotation < 0)
        return false;
    if (translation >= 0)
        method->translation = (dem_translation)translation;
    if (rotation >= 0)
        method->rotation = (dem_rotation)rotation;
    return true;
}

static int choose_methods(const cli_tool *tool, const arguments *a, work *w)
{
    add_method(w, w->scene.integrator);
    for (const char *word = a->integrators; word;) {
        size_t length = strcspn(word, ",");
        dem_integrator_def method = w->scene.integrator;
        if (length == 3 && strncmp(word, "all", 3) == 0)
            add_all(w);
        else if (read_method(word, length, &method))
            add_method(w, method);
        else if (length != 3 || strncmp(word, "own", 3) != 0)
            return cli_wrong_usage(tool,
                                   "there is no integrator '%.*s'; take all, own, or names as in the scene's "
                                   "integrator.translation and .rotation, also both: taylor+pcdm",
                                   (int)length, word);
        word = word[length] ? word + length + 1 : NULL;
    }
    return 0;
}

// ---- scenes

static const dem_convergence_scene *own_scene(const char *name)
{
    const dem_convergence_scene *s;
    for (size_t i = 0; (s = dem_convergence_scene_at(i)); i++)
        if (strcmp(s->name, name) == 0)
            return s;
    return NULL;
}

static dem_status read_scene(const dem_ctx *ctx, const arguments *a, work *w, dem_error *error)
{
    w->own = own_scene(w->name);
    if (!w->own) {
        const char **overrides = dem_alloc_zero(a->overrides.count + 1, sizeof *overrides);
        if (!overrides)
            return dem_fail_memory(error);
        for (size_t i = 0; i < a->overrides.count; i++)
            overrides[i] = a->overrides.items[i];
        dem_status status = dem_scene_read(ctx, w->name, overrides, &w->scene, error);
        free(overrides);
        return status;
    }
    if (a->overrides.count)
        return dem_fail(error, DEM_USAGE, "-D changes scenes in files, not %s; write its like as a file", w->name);
    w->model = dem_alloc_zero(1, sizeof *w->model);
    if (!w->model)
        return dem_fail_memory(error);
    model_begin(w->model);
    w->own->make(w->model);
    if (w->model->status != DEM_OK && error)
        *error = w->model->error;
    w->scene = w->model->scene;
    return w->model->status;
}

static void work_release(work *w)
{
    if (w->model)
        model_end(w->model);
    else
        dem_scene_release(&w->scene);
    free(w->model);
}

static int put_list(const cli_tool *tool)
{
    dem_buffer text = {0};
    const dem_convergence_scene *s;
    for (size_t i = 0; (s = dem_convergence_scene_at(i)); i++)
        dem_buffer_print(&text, "%-16s %s\n", s->name, s->about);
    return cli_print(tool, &text);
}

// ---- the study

static int write_files(cli_session *session, const arguments *a, const dem_convergence *c, const char *scene)
{
    static const char *const names[] = {"errors.csv", "orders.csv", "convergence.html"};
    dem_buffer texts[3] = {{0}};
    int status = 0;
    convergence_csv(&texts[0], c);
    convergence_orders_csv(&texts[1], c);
    if (!convergence_page(&texts[2], c, scene))
        texts[2].failed = true;
    for (int i = 0; i < 3; i++)
        if (status == 0)
            status = study_write(session, a->output, names[i], &texts[i]);
        else
            dem_buffer_release(&texts[i]);
    return status;
}

static int run(const cli_tool *tool, const arguments *a, work *w, cli_session *session)
{
    dem_ctx ctx = cli_ctx(session, NULL);
    ctx.threads = (int)a->common.threads;
    dem_error error;
    dem_convergence c;
    dem_buffer text = {0};
    dem_convergence_def def = {.name = w->name,
                               .scene = &w->scene,
                               .push = w->own ? w->own->push : NULL,
                               .methods = w->methods,
                               .method_count = w->method_count,
                               .levels = (size_t)a->levels,
                               .members = (size_t)a->members,
                               .each_method = a->integrators != NULL,
                               .of = a->of    ? a->of
                                     : w->own ? w->own->of
                                              : NULL,
                               .asked = a->error,
                               .directory = a->output,
                               .only = a->cell < 0 ? DEM_ALL_CELLS : (size_t)a->cell};
    if (dem_convergence_run(&ctx, &def, &c, &error) != DEM_OK)
        return cli_session_error(session, &error);
    int status = c.undone ? 0 : write_files(session, a, &c, w->name);
    if (c.undone)
        dem_buffer_print(&text, "%zu of %zu cells are there; the pages come with the last one\n", c.cells - c.undone,
                         c.cells);
    else if (status == 0 && a->common.json)
        convergence_json(&text, &c, w->name, session);
    else if (status == 0)
        convergence_text(&text, &c, w->name);
    if (status == 0 && !c.undone && !isnan(a->error) && c.best == SIZE_MAX)
        status = DEM_FAILED;
    dem_convergence_release(&c);
    if (a->common.quiet && !a->common.json) {
        dem_buffer_release(&text);
        return status;
    }
    int printed = cli_print(tool, &text);
    return status ? status : printed;
}

static int begin(const cli_tool *tool, const arguments *a, const cli_texts *words)
{
    if (a->list)
        return put_list(tool);
    if (words->count != 1)
        return cli_wrong_usage(tool,
                               words->count ? "one scene at a time" : "name a scene; --list shows those built in");
    cli_session session;
    dem_error error;
    cli_begin(&session, tool, &a->common);
    dem_ctx ctx = cli_ctx(&session, NULL);
    work w = {.name = words->items[0]};
    int status = read_scene(&ctx, a, &w, &error) == DEM_OK ? 0 : cli_session_error(&session, &error);
    if (status == 0)
        status = choose_methods(tool, a, &w);
    if (status == 0)
        status = run(tool, a, &w, &session);
    work_release(&w);
    cli_end(&session);
    return status;
}

int study_convergence(int argc, char **argv)
{
    static const char about[] =
        "Runs a scene at a ladder of time steps (twice its own, once, 1/2, 1/4, ...) and by several schemes of "
        "integration, and measures errors against a converged reference, orders, and what each costs. With --error "
        "it "
        "names the cheapest setting that is good enough. Scenes whose trajectories depend on the last digit (many "
        "bodies "
        "that collide) are recognised and judged by the means of ensembles.";
    static const char epilogue[] =
        "Examples:\n"
        "  dem-study convergence sand.json -o study                  the scene's own schemes\n"
        "  dem-study convergence free-top --integrators all          a scene of its own, all schemes\n"
        "  dem-study convergence drum.json --error 1 --of kinetic_J  the cheapest step for 1 %\n"
        "  dem-study convergence drum.json -o study --cell 7         one run of it, for job arrays\n"
        "Files: DIR/convergence.html, errors.csv, orders.csv; DIR/cells is what an interrupted study goes on from.\n"
        "Errors of positions are in sizes of a body (diameter of its bounding ball), of orientations in radians (1 is "
        "100 %), of the energy the imbalance of the ledger, of columns of the series in parts of their range.\n"
        "Exit status: 0 done, 1 no setting is below the asked error or the scene does not run, 2 wrong usage, 3 bad "
        "input, 4 cannot write, 130 interrupted.";
    arguments a = {
        .common = CLI_COMMON_DEFAULTS, .error = NAN, .levels = 5, .members = 8, .cell = -1, .output = "convergence"};
    const cli_option options[] = {
        {"define", 'D', CLI_TEXTS, "PATH=VALUE", "set a value of the scene, as in -D time.step=1e-6; repeatable",
         &a.overrides, 0, 0},
        {"integrators", 0, CLI_TEXT, "NAMES", "all, or names with commas between (default: the scene's own)",
         &a.integrators, 0, 0},
        {"levels", 0, CLI_WHOLE, "N", "steps on the ladder (default 5: 2, 1, 1/2, 1/4, 1/8)", &a.levels, 2,
         DEM_CONVERGENCE_LEVELS - 2},
        {"members", 0, CLI_WHOLE, "N", "runs of each setting of an ensemble (default 8)", &a.members, 3,
         DEM_CONVERGENCE_MEMBERS},
        {"error", 0, CLI_PERCENT, "PCT", "find the cheapest setting with an error of at most this", &a.error,
         CLI_POSITIVE, INFINITY},
        {"of", 0, CLI_TEXT, "QUANTITY", "whose error: state, position, orientation, energy or a column of series.csv",
         &a.of, 0, 0},
        {"output", 'o', CLI_TEXT, "DIR", "folder for the results (default convergence)", &a.output, 0, 0},
        {"cell", 0, CLI_WHOLE, "N", "run cell N alone, from 0 on", &a.cell, 0, 1e9},
        {"list", 0, CLI_FLAG, NULL, "list the scenes that are built in and leave", &a.list, 0, 0},
        CLI_COMMON_OPTIONS(a.common),
    };
    const cli_tool tool = {"dem-study convergence",          "SCENE [options]", about, options,
                           sizeof options / sizeof *options, epilogue};
    cli_texts words = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &words, &status) == CLI_GO)
        status = begin(&tool, &a, &words);
    cli_texts_release(&words);
    cli_texts_release(&a.overrides);
    return status;
}
