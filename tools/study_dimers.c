#include "study_dimers.h"

#include <stdlib.h>

#include "base/memory.h"
#include "out/page.h"
#include "out/plot.h"
#include "study/dimers.h"
#include "study/statistics.h"
#include "study_output.h"

enum { MOST_ASPECTS = 64, FINDINGS = 3 };

typedef struct arguments {
    cli_common common;
    const char *folder, *aspects_text;
    double aspects[MOST_ASPECTS], growth;
    long only, seeds, bodies, steps;
    bool count_cells;
} arguments;

// what is to be, and is
typedef struct finding {
    const char *what;
    double expected, got, tolerance;
    bool passed;
} finding;

// everything that is told about a study
typedef struct study {
    dem_dimers of;
    dem_cell_result *results;
    size_t missing, failed;
    dem_mean solid[MOST_ASPECTS], contacts[MOST_ASPECTS], seconds[MOST_ASPECTS];
    finding findings[FINDINGS];
    bool passed;
} study;

static dem_mean mean_of(const study *s, size_t aspect, const char *name)
{
    double values[1000];
    for (size_t i = 0; i < s->of.seeds; i++)
        values[i] = dem_cell_number(&s->results[i * s->of.count + aspect], name);
    return dem_mean_of(values, s->of.seeds);
}

static void judge(study *s)
{
    const dem_dimers_known *sphere = &dem_dimers_sphere, *peak = &dem_dimers_peak;
    double ball = NAN, most = NAN, at = NAN, last = NAN;
    for (size_t i = 0; i < s->of.count; i++) {
        double solid = s->solid[i].mean;
        if (s->of.aspects[i] == sphere->aspect)
            ball = solid;
        if (!(solid <= most) && isfinite(solid)) {
            most = solid;
            at = s->of.aspects[i];
        }
        last = solid;
    }
    const finding all[FINDINGS] = {
        {"solid fraction of spheres", sphere->solid_fraction, ball, dem_dimers_tolerance, false},
        {"largest solid fraction", peak->solid_fraction, most, dem_dimers_tolerance, false},
        {"aspect ratio there", peak->aspect, at, 0.1001, false},
    };
    s->passed = s->missing == 0 && last < most;
    for (int i = 0; i < FINDINGS; i++) {
        s->findings[i] = all[i];
        s->findings[i].passed = fabs(all[i].got - all[i].expected) <= all[i].tolerance;
        // without a sphere among them, nothing is said of it
        s->passed = s->passed && (s->findings[i].passed || (i == 0 && isnan(ball)));
    }
}

static void gather(study *s)
{
    for (size_t i = 0; i < s->of.count * s->of.seeds; i++) {
        s->missing += s->results[i].found == NULL;
        s->failed += s->results[i].status == DEM_FAILED;
    }
    for (size_t i = 0; i < s->of.count; i++) {
        s->solid[i] = mean_of(s, i, "solid_fraction");
        s->contacts[i] = mean_of(s, i, "contacts");
        s->seconds[i] = mean_of(s, i, "seconds");
    }
    judge(s);
}

// ---- what is told

static void put_csv(dem_buffer *out, const study *s)
{
    dem_buffer_text(out, "aspect,seeds,solid_fraction,solid_fraction_error95,contacts,contacts_error95,seconds\n");
    for (size_t i = 0; i < s->of.count; i++) {
        const double numbers[] = {s->of.aspects[i],    (double)s->solid[i].count, s->solid[i].mean,  s->solid[i].error,
                                  s->contacts[i].mean, s->contacts[i].error,      s->seconds[i].mean};
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
            dem_buffer_text(out, k ? "," : "");
            dem_buffer_shortest(out, numbers[k]);
        }
        dem_buffer_text(out, "\n");
    }
}

static void put_text(dem_buffer *out, const study *s)
{
    char text[3][32];
    dem_buffer_text(out, "aspect  solid fraction      contacts   seconds\n");
    for (size_t i = 0; i < s->of.count; i++) {
        dem_buffer_print(out, "%6s", dem_format_double(text[0], 32, s->of.aspects[i], 4));
        dem_buffer_print(out, "  %7s +- %-7s", dem_format_double(text[0], 32, s->solid[i].mean, 4),
                         dem_format_double(text[1], 32, s->solid[i].error, 2));
        dem_buffer_print(out, " %8s %9s\n", dem_format_double(text[0], 32, s->contacts[i].mean, 4),
                         dem_format_double(text[1], 32, s->seconds[i].mean, 3));
    }
    for (int i = 0; i < FINDINGS; i++) {
        const finding *f = &s->findings[i];
        dem_buffer_print(out, "%s %s: %s, known %s +- %s\n", f->passed ? "passed" : "off   ", f->what,
                         dem_format_double(text[0], 32, f->got, 4), dem_format_double(text[1], 32, f->expected, 4),
                         dem_format_double(text[2], 32, f->tolerance, 2));
    }
    if (s->missing)
        dem_buffer_print(out, "%zu of %zu cells are not known yet\n", s->missing, s->of.count * s->of.seeds);
}

static void put_json(dem_buffer *out, cli_session *session, const study *s)
{
    dem_json_writer w = dem_json_begin(out);
    dem_json_open_object(&w, NULL);
    dem_json_put_whole(&w, "cells", (int64_t)(s->of.count * s->of.seeds));
    dem_json_put_whole(&w, "missing", (int64_t)s->missing);
    dem_json_put_bool(&w, "passed", s->passed);
    dem_json_open_array(&w, "aspects", true);
    for (size_t i = 0; i < s->of.count; i++) {
        dem_json_open_object(&w, NULL);
        dem_json_put_number(&w, "aspect", s->of.aspects[i]);
        dem_json_put_whole(&w, "seeds", (int64_t)s->solid[i].count);
        dem_json_put_number(&w, "solid_fraction", s->solid[i].mean);
        dem_json_put_number(&w, "solid_fraction_error95", s->solid[i].error);
        dem_json_put_number(&w, "contacts", s->contacts[i].mean);
        dem_json_close(&w, '}');
    }
    dem_json_close(&w, ']');
    cli_put_warnings(session, &w);
    dem_json_close(&w, '}');
}

static void put_plots(dem_buffer *out, const study *s)
{
    double solid[MOST_ASPECTS], bars[MOST_ASPECTS], contacts[MOST_ASPECTS], contact_bars[MOST_ASPECTS];
    for (size_t i = 0; i < s->of.count; i++) {
        solid[i] = s->solid[i].mean;
        bars[i] = isnan(s->solid[i].error) ? 0 : s->solid[i].error;
        contacts[i] = s->contacts[i].mean;
        contact_bars[i] = isnan(s->contacts[i].error) ? 0 : s->contacts[i].error;
    }
    const double known_x[] = {dem_dimers_sphere.aspect, dem_dimers_peak.aspect},
                 known_y[] = {dem_dimers_sphere.solid_fraction, dem_dimers_peak.solid_fraction},
                 within[] = {dem_dimers_tolerance, dem_dimers_tolerance}, isostatic[] = {6, 10};
    const dem_plot_series dense[] = {{"measured here", s->of.aspects, solid, bars, s->of.count, false},
                                     {"known", known_x, known_y, within, 2, true}},
                          touching[] = {{"measured here", s->of.aspects, contacts, contact_bars, s->of.count, false},
                                        {"known", known_x, isostatic, NULL, 2, true}};
    const dem_plot plots[] = {{{"aspect ratio", false, 0}, {"solid fraction [-]", false, 0}, dense, 2},
                              {{"aspect ratio", false, 0}, {"contacts of a grain [-]", false, 0}, touching, 2}};
    dem_page_figure_begin(out);
    dem_plot_sheet_draw(out, &(dem_plot_sheet){.plots = plots, .count = 2, .columns = 2, .fragment = true});
    dem_page_figure_end(out, "Bars: 95 % of the mean over seeds. Known: random close packing of spheres (0.64) and the "
                             "densest random dimers of simulations (0.703 near 1.4; Baule et al. 2013), with the 0.01 "
                             "that protocols differ by; as many contacts as hold grains without friction (6 for "
                             "spheres, 10 for grains that are round about an axis).");
}

static void put_page(dem_buffer *out, const study *s)
{
    static const char *const heads[] = {"aspect ratio", "seeds", "solid fraction", "+-", "contacts", "+-", "seconds"};
    char text[300];
    snprintf(text, sizeof text, "%zu grains in a periodic box, %zu seeds", s->of.jam.bodies, s->of.seeds);
    dem_page_begin(out, "Random packing of dimers", text);
    dem_page_paragraph(out, s->passed    ? "Densest state and its aspect ratio are those that are known."
                            : s->missing ? "The study is not complete yet."
                                         : "The densest state is not the known one.");
    put_plots(out, s);
    dem_page_paragraph(out, "Grains without friction, all of one size, begin small at random places and orientations "
                            "and grow in stages until they bear a pressure of 0.1 % of their stiffness; then they "
                            "shrink until it is gone. What counts is the solid fraction there. There are no walls.");
    dem_page_table_begin(out, NULL, heads, 7);
    for (size_t i = 0; i < s->of.count; i++) {
        dem_page_row_begin(out, false);
        dem_page_number(out, s->of.aspects[i], 3);
        dem_page_number(out, (double)s->solid[i].count, 3);
        dem_page_number(out, s->solid[i].mean, 4);
        dem_page_number(out, s->solid[i].error, 2);
        dem_page_number(out, s->contacts[i].mean, 4);
        dem_page_number(out, s->contacts[i].error, 2);
        dem_page_number(out, s->seconds[i].mean, 3);
        dem_page_row_end(out);
    }
    dem_page_table_end(out);
    dem_page_end(out, "dem-study dimers");
}

static int tell(const cli_tool *tool, cli_session *session, const arguments *a, study *s)
{
    dem_buffer page = {0}, table = {0}, text = {0};
    gather(s);
    put_page(&page, s);
    put_csv(&table, s);
    int status = study_write(session, a->folder, "dimers.html", &page);
    int second = study_write(session, a->folder, "dimers.csv", &table);
    if (a->common.json)
        put_json(&text, session, s);
    else if (!a->common.quiet)
        put_text(&text, s);
    int printed = text.size ? cli_print(tool, &text) : 0;
    if (status || second || printed)
        return status ? status : second ? second : printed;
    return s->failed || (s->missing == 0 && !s->passed) ? DEM_FAILED : 0;
}

static int run(const cli_tool *tool, const arguments *a, study *s)
{
    cli_session session;
    dem_error error;
    cli_begin(&session, tool, &a->common);
    dem_ctx ctx = cli_ctx(&session, NULL);
    ctx.threads = (int)a->common.threads;
    dem_status status = dem_dimers_run(&ctx, &s->of, s->results, &error);
    int exit_status = status == DEM_OK ? 0 : cli_session_error(&session, &error);
    if (status == DEM_OK || status == DEM_INTERRUPTED) {
        int told = tell(tool, &session, a, s);
        exit_status = exit_status ? exit_status : told;
    }
    cli_end(&session);
    return exit_status;
}

static int run_chosen(const cli_tool *tool, arguments *a, const cli_texts *words)
{
    size_t count = 0;
    int status = words->count
                     ? cli_wrong_usage(tool, "takes options only, not '%s'", words->items[0])
                     : study_read_numbers(tool, "aspects", a->aspects_text, 1, 2, a->aspects, MOST_ASPECTS, &count);
    if (status)
        return status;
    size_t cells = count * (size_t)a->seeds;
    if (a->count_cells) {
        dem_buffer text = {0};
        dem_buffer_print(&text, "%zu\n", cells);
        return cli_print(tool, &text);
    }
    if (a->only >= (long)cells)
        return cli_wrong_usage(tool, "there is no cell %ld; they are numbered from 0 to %zu", a->only, cells - 1);
    study *s = dem_alloc_zero(1, sizeof *s);
    dem_cell_result *results = dem_alloc_zero(cells, sizeof *results);
    if (s && results) {
        s->results = results;
        s->of = (dem_dimers){.aspects = a->aspects,
                             .count = count,
                             .seeds = (size_t)a->seeds,
                             .jam = dem_jam_defaults(),
                             .directory = a->folder,
                             .only = a->only < 0 ? DEM_ALL_CELLS : (size_t)a->only};
        s->of.jam.bodies = (size_t)a->bodies;
        s->of.jam.growth = a->growth;
        s->of.jam.steps = (size_t)a->steps;
        s->of.jam.seed = (uint64_t)a->common.seed;
        status = run(tool, a, s);
        dem_cells_release(results, cells);
    } else
        status = cli_error(tool, &(dem_error){.code = DEM_NO_MEMORY, .text = "out of memory"});
    free(results);
    free(s);
    return status;
}

int study_dimers(int argc, char **argv)
{
    static const char about[] =
        "Reproduces how densely dimers (two spheres that overlap) without friction pack at random, against their "
        "aspect "
        "ratio: 0.64 for spheres, 0.70 near 1.4, less beyond. Each cell grows the grains of one aspect ratio and seed "
        "in "
        "a periodic box until they bear a pressure. What cells have found is kept, and the same command goes on.";
    static const char epilogue[] =
        "Examples:\n"
        "  dem-study dimers                                    9 aspect ratios, 3 seeds\n"
        "  dem-study dimers --bodies 100 --seeds 2    a quick look\n"
        "  dem-study dimers --cell $SLURM_ARRAY_TASK_ID        one cell of an array; without --cell for the page\n"
        "Exit status: 0 done, 1 off what is known, 2 wrong usage, 4 cannot write, 130 interrupted.";
    dem_jam_def jam = dem_jam_defaults();
    arguments a = {.common = CLI_COMMON_DEFAULTS,
                   .folder = "dimers",
                   .aspects_text = "1,1.1,1.2,1.3,1.4,1.5,1.6,1.8,2",
                   .growth = jam.growth,
                   .only = -1,
                   .seeds = 3,
                   .bodies = (long)jam.bodies,
                   .steps = (long)jam.steps};
    const cli_option options[] = {
        {"aspects", 0, CLI_TEXT, "LIST", "aspect ratios, 1 to 2 (default 1,1.1,1.2,1.3,1.4,1.5,1.6,1.8,2)",
         &a.aspects_text, 0, 0},
        {"seeds", 0, CLI_WHOLE, "N", "repetitions (default 3)", &a.seeds, 1, 1000},
        {"bodies", 0, CLI_WHOLE, "N", "grains (default 500)", &a.bodies, 30, 1e6},
        {"growth", 0, CLI_NUMBER, "X", "solid fraction added in a stage (default 0.002)", &a.growth, 1e-5, 0.05},
        {"steps", 0, CLI_WHOLE, "N", "of a stage (default 2000)", &a.steps, 10, 1e7},
        STUDY_CELL_OPTIONS(a),
        CLI_COMMON_OPTIONS(a.common),
    };
    const cli_tool tool = {"dem-study dimers", "[options]", about, options, sizeof options / sizeof *options, epilogue};
    cli_texts words = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &words, &status) == CLI_GO)
        status = run_chosen(&tool, &a, &words);
    cli_texts_release(&words);
    return status;
}
