#define _GNU_SOURCE
#include "study_lab.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text.h"
#include "base/units.h"
#include "out/page.h"
#include "out/plot.h"
#include "study_output.h"

typedef struct arguments {
    cli_common common;
    bool list;
    const char *grain, *output;
    int contacts;
    cli_texts values, outputs;
} arguments;

// what is told about a test
typedef struct lab_settings {
    const dem_lab_test *test;
    dem_lab_grain grain;
    dem_clump *clump;  // owned
    double values[DEM_LAB_PARAMS];
} lab_settings;

static const char contacts_choices[] = "sum|mean|merge|soft";

// ---- what is asked

static bool any_test_has(const char *name, size_t length)
{
    const dem_lab_test *test;
    const dem_parameter *p;
    double standard;
    for (size_t t = 0; (test = dem_lab_test_at(t)); t++)
        for (size_t i = 0; (p = dem_lab_param(test, i, &standard)); i++)
            if (strlen(p->name) == length && strncmp(p->name, name, length) == 0)
                return true;
    return false;
}

static int read_value(const cli_tool *tool, const dem_lab_test *test, const char *text, bool of_any_test,
                      double *values)
{
    const char *equals = strchr(text, '=');
    const dem_parameter *p;
    double standard;
    if (!equals)
        return cli_wrong_usage(tool, "-D %s has no value; write -D name=value", text);
    size_t length = (size_t)(equals - text);
    for (size_t i = 0; (p = dem_lab_param(test, i, &standard)); i++) {
        if (strlen(p->name) != length || strncmp(p->name, text, length) != 0)
            continue;
        dem_error error;
        if (dem_quantity(equals + 1, dem_dimension_of(p->unit), &values[i], &error) != DEM_OK)
            return cli_wrong_usage(tool, "-D %s: %s", text, error.text);
        if (!(values[i] >= p->low && values[i] <= p->high))
            return cli_wrong_usage(tool, "-D %s is out of range, %g to %g [%s]", text, p->low, p->high, p->unit);
        return 0;
    }
    if (of_any_test && any_test_has(text, length))
        return 0;
    return cli_wrong_usage(tool, "test %s has no '%.*s'; --list shows what there is", test->name, (int)length, text);
}

int lab_read_values(const cli_tool *tool, const dem_lab_test *test, const cli_texts *texts, bool of_any_test,
                    double *values)
{
    int status = 0;
    for (size_t i = 0; i < DEM_LAB_PARAMS; i++)
        values[i] = NAN;
    for (size_t i = 0; i < texts->count && status == 0; i++)
        status = read_value(tool, test, texts->items[i], of_any_test, values);
    return status;
}

static void put_list(dem_buffer *out)
{
    const dem_lab_test *test;
    const dem_parameter *p;
    for (size_t t = 0; (test = dem_lab_test_at(t)); t++) {
        double standard;
        dem_buffer_print(out, "%s: %s\n", test->name, test->about);
        for (size_t i = 0; (p = dem_lab_param(test, i, &standard)); i++) {
            char value[32], unit[40] = "";
            if (strcmp(p->unit, "-") != 0 && strcmp(p->unit, "count") != 0)
                snprintf(unit, sizeof unit, " %s", p->unit);
            dem_buffer_print(out, "  %-16s %s (default %s%s)\n", p->name, p->help,
                             dem_format_double(value, sizeof value, standard, 6), unit);
        }
    }
}

static int choose(const cli_tool *tool, const arguments *a, const cli_texts *words, lab_settings *s)
{
    if (words->count != 1)
        return cli_wrong_usage(tool, words->count ? "one test at a time" : "name a test; --list shows all");
    s->test = dem_lab_test_find(words->items[0]);
    if (!s->test)
        return cli_wrong_usage(tool, "there is no test '%s'; --list shows all", words->items[0]);
    s->grain.multiple = (dem_multiple)a->contacts;
    return lab_read_values(tool, s->test, &a->values, false, s->values);
}

static dem_status read_grain(const arguments *a, lab_settings *s, dem_error *error)
{
    if (!a->grain)
        return DEM_OK;
    s->grain.clump_file = a->grain;
    DEM_TRY(dem_clump_read(a->grain, &s->clump, error));
    s->grain.clump = s->clump;
    return DEM_OK;
}

// ---- scene

// as seen from the folder of the scene
static char *clump_path(const char *clump, const char *scene)
{
    bool same = strcmp(scene, "-") == 0 || dem_file_name(scene) == scene;
    char *whole = same || *clump == '/' ? NULL : realpath(clump, NULL);
    return whole ? whole : strdup(clump);
}

static dem_status write_scene(const dem_ctx *ctx, const arguments *a, lab_settings *s, dem_error *error)
{
    DEM_TRY(read_grain(a, s, error));
    dem_lab lab;
    dem_buffer scene = {0}, bodies = {0};
    const char *name = dem_file_name(a->output);
    char *clump = a->grain ? clump_path(a->grain, a->output) : NULL;
    char *table = dem_path_join(".", "%.*s-bodies.csv", (int)strcspn(name, "."), name);
    if ((a->grain && !clump) || !table) {
        free(clump);
        free(table);
        return dem_fail_memory(error);
    }
    const char *beside = dem_file_name(table);
    s->grain.clump_file = clump;
    dem_status status = dem_lab_begin(&lab, ctx, s->test, &s->grain, s->values, (uint64_t)a->common.seed, error);
    if (status == DEM_OK)
        status = dem_lab_scene(&lab, beside, &scene, &bodies, error);
    if (status == DEM_OK && bodies.size) {
        char *path = dem_path_join(".", "%.*s%s", (int)(name - a->output), a->output, beside);
        // an absolute folder stands for itself
        const char *at = path && *a->output == '/' ? path + 2 : path;
        status = path ? dem_file_write_buffer(at, &bodies, error) : dem_fail_memory(error);
        free(path);
    }
    if (status == DEM_OK)
        status = dem_file_write_buffer(a->output, &scene, error);
    dem_buffer_release(&scene);
    dem_buffer_release(&bodies);
    dem_lab_end(&lab);
    free(clump);
    free(table);
    return status;
}

// ---- test

static void put_text(dem_buffer *out, const dem_lab *l)
{
    dem_buffer_print(out, "%s: %s\n", l->test->name, l->test->about);
    for (size_t i = 0; i < l->test->figure_count; i++) {
        const dem_lab_name *f = &l->test->figures[i];
        char value[32];
        dem_buffer_print(out, "  %-22s %12s %-6s %s\n", f->name,
                         dem_format_double(value, sizeof value, l->figures[i], 5), strcmp(f->unit, "-") ? f->unit : "",
                         f->about);
    }
    char seconds[32];
    dem_buffer_print(out, "%llu steps in %s s\n", (unsigned long long)l->steps,
                     dem_format_double(seconds, sizeof seconds, l->seconds, 3));
}

static void put_json(dem_buffer *out, cli_session *session, const dem_lab *l)
{
    dem_json_writer w = dem_json_begin(out);
    dem_json_open_object(&w, NULL);
    dem_json_put_string(&w, "test", l->test->name);
    dem_json_open_object(&w, "figures");
    for (size_t i = 0; i < l->test->figure_count; i++)
        dem_json_put_number(&w, l->test->figures[i].name, l->figures[i]);
    dem_json_close(&w, '}');
    dem_json_put_whole(&w, "steps", (int64_t)l->steps);
    dem_json_put_number(&w, "seconds", l->seconds);
    cli_put_warnings(session, &w);
    dem_json_close(&w, '}');
}

// the path, or where there is none the figures
static void put_csv(dem_buffer *out, const dem_lab *l)
{
    const dem_lab_name *names = l->test->columns ? l->test->columns : l->test->figures;
    size_t width = l->test->columns ? l->test->column_count : l->test->figure_count;
    const double *values = l->test->columns ? l->path : l->figures;
    size_t rows = l->test->columns ? l->rows : 1;
    for (size_t i = 0; i < width; i++)
        dem_buffer_print(out, strcmp(names[i].unit, "-") ? "%s%s_%s" : "%s%s", i ? "," : "", names[i].name,
                         names[i].unit);
    for (size_t i = 0; i < rows * width; i++) {
        dem_buffer_text(out, i % width ? "," : "\n");
        dem_buffer_shortest(out, values[i]);
    }
    dem_buffer_text(out, "\n");
}

static bool put_page(dem_buffer *out, const dem_lab *l)
{
    static const char *const heads[] = {"", "value", "unit", ""};
    size_t width = l->test->column_count;
    double *columns = malloc((l->rows + 1) * (width + 1) * sizeof *columns);
    if (!columns)
        return false;
    for (size_t i = 0; i < l->rows * width; i++)
        columns[i % width * l->rows + i / width] = l->path[i];
    dem_page_begin(out, l->test->name, l->test->about);
    dem_page_table_begin(out, NULL, heads, 4);
    for (size_t i = 0; i < l->test->figure_count; i++) {
        dem_page_row_begin(out, false);
        dem_page_cell(out, l->test->figures[i].name);
        dem_page_number(out, l->figures[i], 5);
        dem_page_cell(out, l->test->figures[i].unit);
        dem_page_cell(out, l->test->figures[i].about);
        dem_page_row_end(out);
    }
    dem_page_table_end(out);
    if (width > 1) {
        dem_plot plots[DEM_LAB_COLUMNS];
        dem_plot_series series[DEM_LAB_COLUMNS];
        char titles[DEM_LAB_COLUMNS][80];
        for (size_t k = 0; k < width; k++)
            snprintf(titles[k], sizeof titles[k], "%s [%s]", l->test->columns[k].about, l->test->columns[k].unit);
        for (size_t k = 1; k < width; k++) {
            series[k] =
                (dem_plot_series){.name = l->test->name, .x = columns, .y = columns + k * l->rows, .count = l->rows};
            plots[k - 1] = (dem_plot){{titles[0], false, 0}, {titles[k], false, 0}, &series[k], 1};
        }
        dem_page_figure_begin(out);
        dem_plot_sheet_draw(out, &(dem_plot_sheet){.plots = plots, .count = width - 1, .columns = 2, .fragment = true});
        dem_page_figure_end(out, "The path of the test.");
    }
    dem_page_end(out, "dem-study test");
    free(columns);
    return true;
}

static dem_status write_outputs(const arguments *a, const dem_lab *l, dem_error *error)
{
    for (size_t i = 0; i < a->outputs.count; i++) {
        dem_buffer text = {0};
        if (study_output_form(a->outputs.items[i]) == STUDY_CSV)
            put_csv(&text, l);
        else if (!put_page(&text, l))
            return dem_fail_memory(error);
        DEM_TRY(dem_file_write_buffer(a->outputs.items[i], &text, error));
    }
    return DEM_OK;
}

static int run_test(const cli_tool *tool, const arguments *a, lab_settings *s)
{
    cli_session session;
    dem_error error;
    dem_lab lab = {0};
    dem_buffer text = {0};
    cli_begin(&session, tool, &a->common);
    dem_ctx ctx = cli_ctx(&session, NULL);
    ctx.threads = (int)a->common.threads;
    dem_status status = read_grain(a, s, &error);
    if (status == DEM_OK)
        status = dem_lab_begin(&lab, &ctx, s->test, &s->grain, s->values, (uint64_t)a->common.seed, &error);
    if (status == DEM_OK) {
        status = dem_lab_run(&lab, &error);
        if (status == DEM_OK)
            status = write_outputs(a, &lab, &error);
        if (status == DEM_OK && a->common.json)
            put_json(&text, &session, &lab);
        else if (status == DEM_OK && !a->common.quiet)
            put_text(&text, &lab);
        dem_lab_end(&lab);
    }
    int exit_status = status == DEM_OK ? 0 : cli_session_error(&session, &error);
    cli_end(&session);
    int printed = text.size ? cli_print(tool, &text) : 0;
    return exit_status ? exit_status : printed;
}

static int run_scene(const cli_tool *tool, const arguments *a, lab_settings *s)
{
    cli_session session;
    dem_error error;
    cli_begin(&session, tool, &a->common);
    dem_ctx ctx = cli_ctx(&session, NULL);
    ctx.threads = (int)a->common.threads;
    int status = write_scene(&ctx, a, s, &error) == DEM_OK ? 0 : cli_session_error(&session, &error);
    cli_end(&session);
    return status;
}

static int begin(const cli_tool *tool, arguments *a, int argc, char **argv,
                 int (*run)(const cli_tool *, const arguments *, lab_settings *))
{
    cli_texts words = {0};
    lab_settings s = {0};
    int status;
    if (cli_parse(tool, argc, argv, &words, &status) == CLI_GO) {
        if (a->list) {
            dem_buffer text = {0};
            put_list(&text);
            status = cli_print(tool, &text);
        } else if ((status = choose(tool, a, &words, &s)) == 0 &&
                   (status = study_check_outputs(tool, &a->outputs, false)) == 0)
            status = run(tool, a, &s);
    }
    dem_clump_destroy(s.clump);
    cli_texts_release(&words);
    cli_texts_release(&a->values);
    cli_texts_release(&a->outputs);
    return status;
}

#define LAB_OPTIONS(a)                                                                                                 \
    {"list", 0, CLI_FLAG, NULL, "list the tests and what can be set of each, and leave", &(a).list, 0, 0},             \
        {"set", 'D', CLI_TEXTS, "NAME=VALUE", "set a number of the test; repeatable", &(a).values, 0, 0},              \
        {"grain", 'g', CLI_TEXT, "CLUMP", "clump file of the grain (default: a sphere)", &(a).grain, 0, 0},            \
    {                                                                                                                  \
        "contacts", 0, CLI_CHOICE, contacts_choices, "how several contacts of two grains add up (default sum)",        \
            &(a).contacts, 0, 0                                                                                        \
    }

int study_scene(int argc, char **argv)
{
    static const char about[] =
        "Writes a measured test of granular matter as a scene for dem-run, with comments that say what it shows. A "
        "test "
        "whose sample has to be prepared (packed and pressed) does that first and writes the bodies beside the scene.";
    static const char epilogue[] =
        "Examples:\n"
        "  dem-study scene --list\n"
        "  dem-study scene heap -D friction=0.3 -o heap.json && dem-run heap.json\n"
        "  dem-study scene pour --grain grain_clump.json -D diameter='2 mm' -o pour.json\n"
        "Exit status: 0 done, 1 a preparation failed, 2 wrong usage, 3 bad input, 4 cannot write, 130 interrupted.";
    arguments a = {.common = CLI_COMMON_DEFAULTS, .output = "-"};
    const cli_option options[] = {
        LAB_OPTIONS(a),
        {"output", 'o', CLI_TEXT, "FILE", "the scene (default: standard output)", &a.output, 0, 0},
        CLI_COMMON_OPTIONS(a.common),
    };
    const cli_tool tool = {"dem-study scene", "TEST [options]", about, options, sizeof options / sizeof *options,
                           epilogue};
    return begin(&tool, &a, argc, argv, run_scene);
}

int study_test(int argc, char **argv)
{
    static const char about[] =
        "Does a measured test of granular matter and tells what it finds: the same scene that dem-study scene writes.";
    static const char epilogue[] =
        "Examples:\n"
        "  dem-study test heap\n"
        "  dem-study test pour --grain grain_clump.json -D friction=0.3 --json\n"
        "  dem-study test heap -D bodies=3000 -o heap.html -o heap.csv\n"
        "Exit status: 0 done, 1 the test failed, 2 wrong usage, 3 bad input, 4 cannot write, 130 interrupted.";
    arguments a = {.common = CLI_COMMON_DEFAULTS};
    const cli_option options[] = {
        LAB_OPTIONS(a),
        {"output", 'o', CLI_TEXTS, "FILE", "write path and figures to .html or .csv; repeatable", &a.outputs, 0, 0},
        CLI_COMMON_OPTIONS(a.common),
    };
    const cli_tool tool = {"dem-study test", "TEST [options]", about, options, sizeof options / sizeof *options,
                           epilogue};
    return begin(&tool, &a, argc, argv, run_test);
}
