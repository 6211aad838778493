#include "study_shape.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "study_lab.h"
#include "study_output.h"

typedef struct arguments {
    cli_common common;
    const char *folder, *spheres, *tests;
    long only, seeds, bodies;
    int family, contacts, effort, repair;
    bool count_cells;
    cli_texts values;
    shape_request request;
} arguments;

static const char family_choices[] = "none|aspect|roundness|angularity|clusters";
static const char contacts_choices[] = "sum|mean|merge|soft", effort_choices[] = "fast|default|best";
static const char repair_choices[] = "auto|strict|wrap|none";

static int read_tests(const cli_tool *tool, const arguments *a, dem_shape_study *s)
{
    for (const char *at = a->tests;;) {
        char name[32];
        size_t length = strcspn(at, ",");
        snprintf(name, sizeof name, "%.*s", (int)(length < 31 ? length : 31), at);
        const dem_lab_test *test = dem_lab_test_find(name);
        if (!test)
            return cli_wrong_usage(tool, "there is no test '%s'; dem-study scene --list shows all", name);
        if (s->test_count == DEM_STUDY_TESTS)
            return cli_wrong_usage(tool, "--tests names more than there are");
        double *values = s->values[s->test_count];
        int status = lab_read_values(tool, test, &a->values, true, values);
        if (status)
            return status;
        if (a->bodies)
            values[LAB_BODIES] = (double)a->bodies;
        s->tests[s->test_count++] = test;
        if (!at[length])
            return 0;
        at += length + 1;
    }
}

static int by_number(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int read_request(const cli_tool *tool, arguments *a, const cli_texts *words)
{
    shape_request *q = &a->request;
    if (a->family == SHAPE_GRAIN && words->count != 1)
        return cli_wrong_usage(tool, words->count ? "one grain at a time" : "name the mesh of a grain, or a --family");
    if (a->family != SHAPE_GRAIN && words->count)
        return cli_wrong_usage(tool, "a family makes its own grains; leave '%s' out", words->items[0]);
    int status = study_read_numbers(tool, "spheres", a->spheres, 1, 5000, q->counts, SHAPE_MOST, &q->count_count);
    if (status)
        return status;
    for (size_t i = 0; i < q->count_count; i++)
        if (q->counts[i] != floor(q->counts[i]))
            return cli_wrong_usage(tool, "--spheres is whole numbers, not %g", q->counts[i]);
    qsort(q->counts, q->count_count, sizeof *q->counts, by_number);
    q->series = (shape_series)a->family;
    q->mesh = words->count ? words->items[0] : NULL;
    q->effort = a->effort;
    q->repair = a->repair;
    q->seed = (uint64_t)a->common.seed;
    q->folder = a->folder;
    return 0;
}

static dem_status write_all(const cli_tool *tool, cli_session *session, const dem_ctx *ctx, const arguments *a,
                            shape_told *told, int *exit_status, dem_error *error)
{
    dem_buffer page = {0}, table = {0}, text = {0};
    DEM_TRY(shape_page(ctx, &page, told, error));
    shape_csv(&table, told);
    int first = study_write(session, a->folder, "shape.html", &page);
    int second = study_write(session, a->folder, "shape.csv", &table);
    if (a->common.json)
        shape_json(&text, session, told);
    else if (!a->common.quiet)
        shape_text(&text, told);
    int third = text.size ? cli_print(tool, &text) : 0;
    *exit_status = first ? first : second ? second : third;
    return DEM_OK;
}

static int run_cells(const cli_tool *tool, cli_session *session, const dem_ctx *ctx, const arguments *a,
                     dem_shape_study *s, const shape_grains *grains)
{
    dem_error error;
    size_t cells = dem_shape_cells(s);
    if (a->only >= (long)cells)
        return cli_wrong_usage(tool, "there is no cell %ld; they are numbered from 0 to %zu", a->only, cells - 1);
    dem_cell_result *results = dem_alloc_zero(cells, sizeof *results);
    if (!results)
        return cli_session_error(session, &(dem_error){.code = DEM_NO_MEMORY, .text = "out of memory"});
    dem_status status = dem_shape_run(ctx, s, results, &error);
    int exit_status = status == DEM_OK ? 0 : cli_session_error(session, &error);
    shape_told told = {.study = s, .results = results, .grains = grains, .series = (shape_series)a->family};
    static const char *const families[] = {"", "ellipsoids of different aspect ratio",
                                           "polyhedra of different roundness", "polyhedra of different angularity",
                                           "clusters of one to four spheres"};
    told.title = a->request.mesh ? a->request.mesh : families[a->family];
    for (size_t i = 0; i < cells; i++) {
        told.missing += results[i].found == NULL;
        told.failed += results[i].found == NULL && results[i].status != DEM_INTERRUPTED;
        if (results[i].found == NULL && results[i].status != DEM_INTERRUPTED)
            dem_log(ctx, DEM_LOG_WARNING, "cell %zu failed: %s", i, results[i].error.text);
    }
    if (status == DEM_OK || status == DEM_INTERRUPTED) {
        int told_status = 0;
        if (write_all(tool, session, ctx, a, &told, &told_status, &error) != DEM_OK)
            told_status = cli_session_error(session, &error);
        exit_status = exit_status ? exit_status : told_status ? told_status : told.failed ? DEM_FAILED : 0;
    }
    dem_cells_release(results, cells);
    free(results);
    return exit_status;
}

static int run(const cli_tool *tool, arguments *a, dem_shape_study *s)
{
    cli_session session;
    dem_error error;
    cli_begin(&session, tool, &a->common);
    dem_ctx ctx = cli_ctx(&session, NULL);
    ctx.threads = (int)a->common.threads;
    shape_grains *grains = dem_alloc_zero(1, sizeof *grains);
    dem_status status = grains ? shape_grains_make(&ctx, &a->request, grains, &error) : dem_fail_memory(&error);
    int exit_status = status == DEM_OK ? 0 : cli_session_error(&session, &error);
    if (status == DEM_OK) {
        s->variants = grains->variants;
        s->variant_count = grains->count;
        s->multiple = (dem_multiple)a->contacts;
        s->seeds = (size_t)a->seeds;
        s->seed = (uint64_t)a->common.seed;
        s->directory = a->folder;
        s->only = a->only < 0 ? DEM_ALL_CELLS : (size_t)a->only;
        if (a->count_cells) {
            dem_buffer text = {0};
            dem_buffer_print(&text, "%zu\n", dem_shape_cells(s));
            exit_status = cli_print(tool, &text);
        } else
            exit_status = run_cells(tool, &session, &ctx, a, s, grains);
    }
    if (grains)
        shape_grains_release(grains);
    free(grains);
    cli_end(&session);
    return exit_status;
}

int study_shape(int argc, char **argv)
{
    static const char about[] =
        "What the form of grains does to what they do together. GRAIN is a mesh that is packed with different numbers "
        "of spheres, its mass and inertia the same for all; or a family of grains is made, or clusters of one to four "
        "spheres. Each goes through measured tests (see dem-study scene --list) with several seeds. The page shows "
        "every "
        "figure with its error against the number of spheres and the run time, and says from where on more spheres "
        "cannot be told from the finest. What cells have found is kept, and the same command goes on.";
    static const char epilogue[] =
        "Examples:\n"
        "  dem-study shape grain.obj\n"
        "  dem-study shape grain.obj --spheres 1,5,20,100 --tests pour,heap --seeds 8 -o grain-study\n"
        "  dem-study shape --family aspect --spheres 20 --tests pour,triaxial -D friction=0.3\n"
        "  dem-study shape --family clusters --tests heap,triaxial\n"
        "  dem-study shape grain.obj --cell $SLURM_ARRAY_TASK_ID   one cell of an array; without --cell for the page\n"
        "Exit status: 0 done, 1 a cell failed, 2 wrong usage, 3 bad input, 4 cannot write, 130 interrupted.";
    arguments a = {.common = CLI_COMMON_DEFAULTS,
                   .folder = "shape",
                   .spheres = "1,2,5,10,20,50,100,500",
                   .tests = "pour,heap,shear-box,triaxial,drum",
                   .only = -1,
                   .seeds = 4,
                   .effort = DEM_EFFORT_DEFAULT};
    const cli_option options[] = {
        {.help = "Grains"},
        {"spheres", 0, CLI_TEXT, "LIST",
         "numbers of spheres (default 1,2,5,10,20,50,100,500); of a family the last one", &a.spheres, 0, 0},
        {"family", 0, CLI_CHOICE, family_choices, "make a family of grains instead of reading one", &a.family, 0, 0},
        {"effort", 0, CLI_CHOICE, effort_choices, "of the packing (default default)", &a.effort, 0, 0},
        {"repair", 0, CLI_CHOICE, repair_choices, "what to do with a faulty mesh (default auto)", &a.repair, 0, 0},
        {.help = "Tests"},
        {"tests", 0, CLI_TEXT, "LIST", "which (default pour,heap,shear-box,triaxial,drum)", &a.tests, 0, 0},
        {"seeds", 0, CLI_WHOLE, "N", "repetitions of each (default 4)", &a.seeds, 1, 1000},
        {"bodies", 0, CLI_WHOLE, "N", "grains of each (default: the test's)", &a.bodies, 20, 1e6},
        {"set", 'D', CLI_TEXTS, "NAME=VALUE", "set a number of the tests that have it; repeatable", &a.values, 0, 0},
        {"contacts", 0, CLI_CHOICE, contacts_choices, "how several contacts of two grains add up (default sum)",
         &a.contacts, 0, 0},
        STUDY_CELL_OPTIONS(a),
        CLI_COMMON_OPTIONS(a.common),
    };
    const cli_tool tool = {"dem-study shape", "[GRAIN] [options]", about, options, sizeof options / sizeof *options,
                           epilogue};
    cli_texts words = {0};
    dem_shape_study *s = dem_alloc_zero(1, sizeof *s);
    int status;
    if (s && cli_parse(&tool, argc, argv, &words, &status) == CLI_GO) {
        status = read_request(&tool, &a, &words);
        if (status == 0)
            status = read_tests(&tool, &a, s);
        if (status == 0)
            status = run(&tool, &a, s);
    }
    if (!s)
        status = cli_error(&tool, &(dem_error){.code = DEM_NO_MEMORY, .text = "out of memory"});
    free(s);
    cli_texts_release(&words);
    cli_texts_release(&a.values);
    return status;
}
