#include "study_mohr.h"

#include <stdlib.h>

#include "base/file.h"
#include "base/units.h"
#include "math/vec.h"
#include "out/page.h"
#include "study/mohr_coulomb.h"
#include "study_output.h"

typedef struct arguments {
    cli_common common;
    const char *unit;
    cli_texts outputs;
} arguments;

// the figures of a fit, as they are told everywhere
enum { FIGURES = 8 };
typedef struct figure {
    const char *name, *key, *unit;
    double value;
} figure;

static void set_figures(const dem_mohr_coulomb *f, figure figures[FIGURES])
{
    const double degree = DEM_PI / 180;
    const figure all[FIGURES] = {
        {"friction angle", "friction_angle_deg", "deg", f->friction_angle / degree},
        {"  its standard error", "friction_angle_error_deg", "deg", f->angle_error / degree},
        {"cohesion", "cohesion_Pa", "Pa", f->cohesion},
        {"  its standard error", "cohesion_error_Pa", "Pa", f->cohesion_error},
        {"uniaxial strength, axial stress: 2 c cos / (1 - sin)", "uniaxial_axial_strength_Pa", "Pa", f->axial_strength},
        {"uniaxial strength, shear stress: c cos / (1 - sin)", "uniaxial_shear_strength_Pa", "Pa", f->shear_strength},
        {"tensile cutoff: 2 c cos / (1 + sin)", "tensile_cutoff_Pa", "Pa", f->tensile_cutoff},
        {"tests off the line, root mean square", "residual_Pa", "Pa", f->residual},
    };
    for (int i = 0; i < FIGURES; i++)
        figures[i] = all[i];
}

static void put_text(dem_buffer *out, const char *path, const figure *figures, const dem_mohr_coulomb *f)
{
    dem_buffer_print(out, "%s: %zu tests, t = s sin(phi) + c cos(phi)\n", path, f->count);
    for (int i = 0; i < FIGURES; i++) {
        char value[32];
        if (isnan(figures[i].value))
            continue;
        dem_format_double(value, sizeof value, figures[i].value, 8);
        dem_buffer_print(out, "  %-54s %14s %s\n", figures[i].name, value, figures[i].unit);
    }
}

static void put_json(dem_buffer *out, cli_session *session, const char *path, const figure *figures,
                     const dem_mohr_coulomb *f)
{
    dem_json_writer w = dem_json_begin(out);
    dem_json_open_object(&w, NULL);
    dem_json_put_string(&w, "file", path);
    dem_json_put_whole(&w, "tests", (int64_t)f->count);
    for (int i = 0; i < FIGURES; i++)
        dem_json_put_number(&w, figures[i].key, figures[i].value);
    cli_put_warnings(session, &w);
    dem_json_close(&w, '}');
}

static void put_csv(dem_buffer *out, const figure *figures)
{
    for (int i = 0; i < FIGURES; i++)
        dem_buffer_print(out, "%s%s", i ? "," : "", figures[i].key);
    dem_buffer_text(out, "\n");
    for (int i = 0; i < FIGURES; i++) {
        dem_buffer_text(out, i ? "," : "");
        dem_buffer_shortest(out, figures[i].value);
    }
    dem_buffer_text(out, "\n");
}

static void put_page(dem_buffer *out, const char *path, const dem_failure *tests, const figure *figures,
                     const dem_mohr_coulomb *f)
{
    static const char *const heads[] = {"", "value", "unit"}, *const test_heads[] = {"test", "sigma1 [Pa]",
                                                                                     "sigma3 [Pa]"};
    dem_page_begin(out, "Mohr-Coulomb strength", dem_file_name(path));
    dem_page_figure_begin(out);
    dem_mohr_coulomb_draw(out, tests, f->count, f, true);
    dem_page_figure_end(out, "Circles of the tests at failure and the line t = s sin(phi) + c cos(phi) fitted to their "
                             "tops, drawn as tau = c + sigma tan(phi), with the tensile cutoff.");
    dem_page_table_begin(out, NULL, heads, 3);
    for (int i = 0; i < FIGURES; i++) {
        dem_page_row_begin(out, false);
        dem_page_cell(out, figures[i].name);
        dem_page_number(out, figures[i].value, 8);
        dem_page_cell(out, figures[i].unit);
        dem_page_row_end(out);
    }
    dem_page_table_end(out);
    dem_page_table_begin(out, NULL, test_heads, 3);
    for (size_t i = 0; i < f->count; i++) {
        char number[24];
        snprintf(number, sizeof number, "%zu", i + 1);
        dem_page_row_begin(out, false);
        dem_page_cell(out, number);
        dem_page_number(out, tests[i].sigma1, 8);
        dem_page_number(out, tests[i].sigma3, 8);
        dem_page_row_end(out);
    }
    dem_page_table_end(out);
    dem_page_end(out, "dem-study mohr-coulomb");
}

static dem_status write_file(const char *path, const char *input, const dem_failure *tests, const figure *figures,
                             const dem_mohr_coulomb *f, dem_error *error)
{
    dem_buffer text = {0};
    study_form form = study_output_form(path);
    if (form == STUDY_CSV)
        put_csv(&text, figures);
    else if (form == STUDY_SVG)
        dem_mohr_coulomb_draw(&text, tests, f->count, f, false);
    else
        put_page(&text, input, tests, figures, f);
    return dem_file_write_buffer(path, &text, error);
}

static dem_status read_tests(const arguments *a, const char *path, dem_failure **tests, size_t *count, dem_error *error)
{
    dem_buffer text;
    double unit = 1;
    *tests = NULL;
    if (a->unit)
        DEM_TRY(dem_unit(a->unit, DEM_DIMENSION_PRESSURE, &unit, error));
    DEM_TRY(dem_file_read(path, &text, error));
    dem_status status = dem_failures_parse(text.data, text.size, path, unit, tests, count, error);
    dem_buffer_release(&text);
    return status;
}

static int run(const cli_tool *tool, const arguments *a, const char *path)
{
    cli_session session;
    dem_error error;
    dem_failure *tests = NULL;
    size_t count = 0;
    dem_mohr_coulomb fit = {0};
    figure figures[FIGURES];
    dem_buffer text = {0};
    cli_begin(&session, tool, &a->common);
    dem_ctx ctx = cli_ctx(&session, path);
    dem_status status = read_tests(a, path, &tests, &count, &error);
    if (status == DEM_OK) {
        status = dem_mohr_coulomb_fit(tests, count, &fit, &error);
        if (status != DEM_OK)
            snprintf(error.file, sizeof error.file, "%s", path);
    }
    if (status == DEM_OK && count < 3)
        dem_log(&ctx, DEM_LOG_WARNING, "two tests always fit a line; take three or more confinements");
    if (status == DEM_OK && fit.cohesion < 0)
        dem_log(&ctx, DEM_LOG_WARNING, "the cohesion comes out below 0; the strengths do not lie on a line");
    set_figures(&fit, figures);
    for (size_t i = 0; i < a->outputs.count && status == DEM_OK; i++)
        status = write_file(a->outputs.items[i], path, tests, figures, &fit, &error);
    int exit_status = status == DEM_OK ? 0 : cli_session_error(&session, &error);
    if (status == DEM_OK && a->common.json)
        put_json(&text, &session, path, figures, &fit);
    else if (status == DEM_OK && !a->common.quiet)
        put_text(&text, path, figures, &fit);
    cli_end(&session);
    free(tests);
    int printed = text.size ? cli_print(tool, &text) : 0;
    return exit_status ? exit_status : printed;
}

int study_mohr_coulomb(int argc, char **argv)
{
    static const char about[] =
        "Friction angle and cohesion of a set of tests: the line t = s sin(phi) + c cos(phi) through the largest and "
        "smallest principal stress of each at failure, pressure positive. FILE is a CSV table with columns sigma1 and "
        "sigma3 (or with their unit, as in sigma1_kPa); '-' reads standard input.";
    static const char epilogue[] =
        "Both forms of the uniaxial strength found in books are told: the axial stress 2 c cos(phi) / (1 - sin(phi)), "
        "and the shear stress of the same test, half of it.\n"
        "Examples:\n"
        "  dem-study mohr-coulomb tests.csv                          the figures\n"
        "  dem-study mohr-coulomb tests.csv -o circles.svg           circles and line\n"
        "  dem-study mohr-coulomb tests.csv --unit kPa -o tests.html\n"
        "Exit status: 0 done, 2 wrong usage, 3 bad input, 4 cannot write.";
    arguments a = {.common = CLI_COMMON_DEFAULTS};
    const cli_option options[] = {
        {"unit", 0, CLI_TEXT, "UNIT", "of columns whose names tell none (default Pa)", &a.unit, 0, 0},
        {"output", 'o', CLI_TEXTS, "FILE", "write .html, .svg or .csv; repeatable", &a.outputs, 0, 0},
        {"json", 0, CLI_FLAG, NULL, "one JSON object on standard output instead of the table", &a.common.json, 0, 0},
        {"quiet", 'q', CLI_FLAG, NULL, "only errors", &a.common.quiet, 0, 0},
        {"verbose", 'v', CLI_FLAG, NULL, "say more", &a.common.verbose, 0, 0},
    };
    const cli_tool tool = {"dem-study mohr-coulomb",         "FILE [options]", about, options,
                           sizeof options / sizeof *options, epilogue};
    cli_texts words = {0};
    int status;
    dem_error error;
    double unit;
    if (cli_parse(&tool, argc, argv, &words, &status) == CLI_GO) {
        if (words.count != 1)
            status = cli_wrong_usage(&tool, words.count ? "one file at a time" : "name the file of the tests");
        else if (a.unit && dem_unit(a.unit, DEM_DIMENSION_PRESSURE, &unit, &error) != DEM_OK)
            status = cli_wrong_usage(&tool, "--unit: %s", error.text);
        else if ((status = study_check_outputs(&tool, &a.outputs, true)) == 0)
            status = run(&tool, &a, words.items[0]);
    }
    cli_texts_release(&words);
    cli_texts_release(&a.outputs);
    return status;
}
