// A study of shape as a page, as a table, and in words.
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "out/page.h"
#include "out/picture.h"
#include "out/plot.h"
#include "study_shape.h"

enum { WIDTH = 260, HEIGHT = 220, MOST_FIGURES = 16, SERIES = 3 };

// one figure of one test that is compared
typedef struct shown {
    size_t test;
    const dem_lab_name *figure;
    char title[80];
    double mean[SHAPE_MOST], error[SHAPE_MOST];
    size_t enough;  // variant; the number of them: not known
} shown;

// what is shown of all
typedef struct sheet {
    const shape_told *told;
    size_t variants, count;
    shown items[MOST_FIGURES];
    double x[SHAPE_MOST], seconds[DEM_STUDY_TESTS][SHAPE_MOST];
    dem_plot_series series[2][MOST_FIGURES][SERIES];
} sheet;

// what is known of clusters of 1 to 4 spheres with a friction of 0.5, mostly from simulations: spheres 18 to 24
// degrees of repose, 4 to 8 more of two, 8 to 12 more of three and four; 25 to 30 degrees of dense spheres, 35 to 45 of
// clumps
typedef struct known {
    const char *test, *figure;
    double low[DEM_STUDY_TESTS], high[DEM_STUDY_TESTS];
} known;
static const double one_to_four[] = {1, 2, 3, 4};
static const known knowns[] = {{"heap", "repose", {18, 22, 26, 26}, {24, 32, 36, 36}},
                               {"triaxial", "peak_angle", {25, 35, 35, 35}, {30, 45, 45, 45}}};

static const known *known_of(const shape_told *t, const shown *item)
{
    for (size_t i = 0; t->series == SHAPE_CLUSTERS && i < sizeof knowns / sizeof *knowns; i++)
        if (strcmp(knowns[i].test, t->study->tests[item->test]->name) == 0 &&
            strcmp(knowns[i].figure, item->figure->name) == 0)
            return &knowns[i];
    return NULL;
}

static void set_item(sheet *s, size_t test, const dem_lab_name *figure)
{
    const shape_told *t = s->told;
    shown *item = &s->items[s->count++];
    item->test = test;
    item->figure = figure;
    snprintf(item->title, sizeof item->title, "%s: %s [%s]", t->study->tests[test]->name, figure->name, figure->unit);
    for (char *c = item->title; *c; c++)
        *c = *c == '_' ? ' ' : *c;
    for (size_t i = 0; i < s->variants; i++) {
        dem_mean m = dem_shape_mean(t->study, t->results, i, test, figure->name);
        item->mean[i] = m.mean;
        item->error[i] = isnan(m.error) ? 0 : m.error;
    }
    item->enough = t->grains->spheres ? dem_shape_enough(t->study, t->results, test, figure->name) : s->variants;
}

static sheet *sheet_make(const shape_told *t)
{
    sheet *s = dem_alloc_zero(1, sizeof *s);
    if (!s)
        return NULL;
    s->told = t;
    s->variants = t->study->variant_count;
    for (size_t i = 0; i < s->variants; i++) {
        s->x[i] = t->study->variants[i].x;
        for (size_t k = 0; k < t->study->test_count; k++)
            s->seconds[k][i] = dem_shape_mean(t->study, t->results, i, k, "seconds").mean;
    }
    for (size_t k = 0; k < t->study->test_count; k++)
        for (size_t i = 0; i < t->study->tests[k]->main_count && s->count < MOST_FIGURES; i++)
            set_item(s, k, &t->study->tests[k]->figures[i]);
    return s;
}

// ---- plots

static void set_series(sheet *s, bool against_seconds)
{
    for (size_t i = 0; i < s->count; i++) {
        const shown *item = &s->items[i];
        const known *k = against_seconds ? NULL : known_of(s->told, item);
        dem_plot_series *of = s->series[against_seconds][i];
        of[0] = (dem_plot_series){.name = "measured here",
                                  .x = against_seconds ? s->seconds[item->test] : s->x,
                                  .y = item->mean,
                                  .error = item->error,
                                  .count = s->variants};
        of[1] = (dem_plot_series){"known, from", one_to_four, k ? k->low : NULL, NULL, k ? 4 : 0, false};
        of[2] = (dem_plot_series){"known, to", one_to_four, k ? k->high : NULL, NULL, k ? 4 : 0, false};
    }
}

static void put_plots(dem_buffer *out, sheet *s, bool against_seconds, const char *caption)
{
    dem_plot plots[MOST_FIGURES];
    bool log = against_seconds || s->told->grains->log;
    set_series(s, against_seconds);
    for (size_t i = 0; i < s->count; i++)
        plots[i] = (dem_plot){{against_seconds ? "run time [s]" : s->told->grains->axis, log, 0},
                              {s->items[i].title, false, 0},
                              s->series[against_seconds][i],
                              s->told->series == SHAPE_CLUSTERS && !against_seconds ? SERIES : 1};
    dem_page_figure_begin(out);
    dem_plot_sheet_draw(out, &(dem_plot_sheet){.plots = plots, .count = s->count, .columns = 3, .fragment = true});
    dem_page_figure_end(out, caption);
}

// ---- words

static void say_enough(dem_buffer *out, const sheet *s, const shown *item)
{
    char text[3][32];
    size_t last = s->variants - 1;
    dem_format_double(text[0], 32, item->mean[last], 4);
    dem_format_double(text[1], 32, item->error[last], 2);
    if (item->enough >= s->variants)
        dem_buffer_print(out, "not enough seeds to tell");
    else if (item->enough == last)
        dem_buffer_print(out, "still changes at %.0f spheres (%s +- %s)", s->x[last], text[0], text[1]);
    else
        dem_buffer_print(
            out, "from %.0f spheres on not to be told from %.0f spheres (%s +- %s), in %s of the run time",
            s->x[item->enough], s->x[last], text[0], text[1],
            dem_format_double(text[2], 32, s->seconds[item->test][item->enough] / s->seconds[item->test][last], 2));
}

// from where on no figure changes
static size_t enough_of_all(const sheet *s)
{
    size_t most = 0;
    for (size_t i = 0; i < s->count; i++)
        most = s->items[i].enough > most ? s->items[i].enough : most;
    return s->count ? most : s->variants;
}

// whether grains that are not convex are stronger than the sphere
static void say_clusters(dem_buffer *out, const sheet *s)
{
    size_t more = 0, less = 0;
    for (size_t i = 0; i < s->count; i++) {
        const shown *item = &s->items[i];
        if (strstr(item->figure->name, "angle") || strcmp(item->figure->name, "repose") == 0)
            for (size_t v = 1; v < s->variants; v++) {
                double by = item->mean[v] - item->mean[0], error = hypot(item->error[v], item->error[0]);
                more += by > error;
                less += by < -error;
            }
    }
    if (more && !less)
        dem_buffer_print(out,
                         "Grains that are not convex are stronger than spheres: %zu angles are larger by more "
                         "than their error, none is smaller",
                         more);
    else
        dem_buffer_print(out,
                         "Of the angles of grains that are not convex %zu are larger than those of spheres by more "
                         "than their error, %zu are smaller",
                         more, less);
}

static void say_all(dem_buffer *out, const sheet *s)
{
    size_t all = enough_of_all(s), last = s->variants - 1;
    if (s->told->series == SHAPE_CLUSTERS)
        say_clusters(out, s);
    else if (!s->told->grains->spheres)
        dem_buffer_print(out, "%zu grains of different %s", s->variants, s->told->grains->axis);
    else if (all < last)
        dem_buffer_print(out, "More than %.0f spheres do not pay: no figure can be told from that of %.0f spheres",
                         s->x[all], s->x[last]);
    else if (all == last)
        dem_buffer_print(out, "Some figures still change up to the finest clump");
    else
        dem_buffer_print(out, "The seeds are too few to say where more spheres stop paying");
    if (s->told->missing)
        dem_buffer_print(out, "; %zu of %zu cells are not known yet", s->told->missing,
                         dem_shape_cells(s->told->study));
    dem_buffer_text(out, ".");
}

// ---- page

static void put_table(dem_buffer *out, const sheet *s)
{
    const char *heads[2 + MOST_FIGURES + 1] = {"grain", s->told->grains->axis};
    for (size_t i = 0; i < s->count; i++)
        heads[2 + i] = s->items[i].title;
    dem_page_table_begin(out, "Means over the seeds, and 95 % of their error", heads, 2 + s->count);
    for (size_t v = 0; v < s->variants; v++) {
        dem_page_row_begin(out, false);
        dem_page_cell(out, s->told->study->variants[v].name);
        dem_page_number(out, s->x[v], 4);
        for (size_t i = 0; i < s->count; i++) {
            char text[2][32], cell[80];
            dem_format_double(text[0], 32, s->items[i].mean[v], 4);
            dem_format_double(text[1], 32, s->items[i].error[v], 2);
            // of one seed there is no error
            snprintf(cell, sizeof cell, s->items[i].error[v] > 0 ? "%s ± %s" : "%s", text[0], text[1]);
            dem_page_cell(out, isnan(s->items[i].mean[v]) ? "-" : cell);
        }
        dem_page_row_end(out);
    }
    dem_page_table_end(out);
}

// none where this build draws none
static dem_status put_pictures(const dem_ctx *ctx, dem_buffer *out, const sheet *s, dem_error *error)
{
    const dem_variant *v = s->told->study->variants;
    const dem_ball sphere = {{0, 0, 0}, 0.5};
    bool begun = false;
    for (size_t i = 0; i < s->variants; i++) {
        dem_clump_def c = v[i].clump ? dem_clump_view(v[i].clump) : (dem_clump_def){.balls = &sphere, .ball_count = 1};
        const dem_grain_picture grain = {.balls = c.balls, .count = c.ball_count};
        dem_image image;
        dem_buffer png = {0};
        dem_error reason;
        dem_status status =
            dem_grain_render(&(dem_ctx){.threads = ctx->threads}, &grain, WIDTH, HEIGHT, &image, NULL, &reason);
        if (status == DEM_UNAVAILABLE)
            return DEM_OK;
        if (status == DEM_OK) {
            status = dem_png_encode(&image, &png, &reason);
            dem_image_free(&image);
        }
        if (status != DEM_OK) {
            *error = reason;
            return status;
        }
        if (!begun)
            dem_page_grid_begin(out, 4);
        begun = true;
        dem_page_picture(out, &png, v[i].name);
        dem_buffer_release(&png);
    }
    if (begun)
        dem_page_grid_end(out);
    return DEM_OK;
}

static void put_protocol(dem_buffer *out, const sheet *s)
{
    const dem_shape_study *study = s->told->study;
    dem_page_heading(out, "What was done");
    dem_page_list_begin(out);
    for (size_t k = 0; k < study->test_count; k++) {
        const dem_lab_test *test = study->tests[k];
        const dem_parameter *p;
        double standard;
        dem_buffer text = {0};
        dem_buffer_print(&text, "%s With", test->about);
        for (size_t i = 0; (p = dem_lab_param(test, i, &standard)); i++) {
            double value = isnan(study->values[k][i]) ? standard : study->values[k][i];
            char number[32];
            dem_buffer_print(&text, "%s %s %s", i ? "," : "", p->name, dem_format_double(number, 32, value, 6));
            if (strcmp(p->unit, "-") != 0 && strcmp(p->unit, "count") != 0)
                dem_buffer_print(&text, " %s", p->unit);
        }
        dem_buffer_text(&text, ".");
        dem_page_item(out, test->name, text.failed ? "" : text.data);
        dem_buffer_release(&text);
    }
    dem_page_list_end(out);
}

dem_status shape_page(const dem_ctx *ctx, dem_buffer *out, const shape_told *t, dem_error *error)
{
    sheet *s = sheet_make(t);
    char subtitle[200];
    if (!s)
        return dem_fail_memory(error);
    snprintf(subtitle, sizeof subtitle, "%.100s, %zu seeds", dem_file_name(t->title), t->study->seeds);
    dem_page_begin(out, "What the form of grains does", subtitle);
    dem_buffer text = {0};
    say_all(&text, s);
    dem_page_paragraph(out, text.failed ? "" : text.data);
    dem_buffer_release(&text);
    dem_status status = put_pictures(ctx, out, s, error);
    put_plots(
        out, s, false,
        t->series == SHAPE_CLUSTERS
            ? "Bars: 95 % of the mean over seeds. Known: what simulations and tests of others span; protocols differ."
            : "Bars: 95 % of the mean over seeds.");
    if (t->grains->spheres) {
        dem_page_heading(out, "Where more spheres stop paying");
        dem_page_list_begin(out);
        for (size_t i = 0; i < s->count; i++) {
            dem_buffer line = {0};
            say_enough(&line, s, &s->items[i]);
            dem_page_item(out, s->items[i].title, line.failed ? "" : line.data);
            dem_buffer_release(&line);
        }
        dem_page_list_end(out);
        put_plots(out, s, true, "The same against the time that one run takes, on one thread.");
    }
    put_table(out, s);
    put_protocol(out, s);
    dem_page_end(out, "dem-study shape");
    free(s);
    return status;
}

// ---- tables

void shape_csv(dem_buffer *out, const shape_told *t)
{
    const dem_shape_study *study = t->study;
    dem_buffer_text(out, "grain,x,spheres,test,figure,unit,seeds,mean,deviation,error95,seconds\n");
    for (size_t k = 0; k < study->test_count; k++)
        for (size_t f = 0; f < study->tests[k]->figure_count; f++)
            for (size_t v = 0; v < study->variant_count; v++) {
                const dem_lab_name *figure = &study->tests[k]->figures[f];
                const dem_variant *variant = &study->variants[v];
                dem_mean m = dem_shape_mean(study, t->results, v, k, figure->name);
                size_t spheres = variant->clump ? dem_clump_view(variant->clump).ball_count : 1;
                dem_buffer_print(out, "%s,", variant->name);
                dem_buffer_shortest(out, variant->x);
                dem_buffer_print(out, ",%zu,%s,%s,%s,%zu", spheres, study->tests[k]->name, figure->name, figure->unit,
                                 m.count);
                const double numbers[] = {m.mean, m.deviation, m.error,
                                          dem_shape_mean(study, t->results, v, k, "seconds").mean};
                for (size_t i = 0; i < 4; i++) {
                    dem_buffer_text(out, ",");
                    dem_buffer_shortest(out, numbers[i]);
                }
                dem_buffer_text(out, "\n");
            }
}

void shape_text(dem_buffer *out, const shape_told *t)
{
    sheet *s = sheet_make(t);
    if (!s)
        return;
    for (size_t i = 0; i < s->count; i++) {
        char text[2][32];
        dem_buffer_print(out, "%s\n", s->items[i].title);
        for (size_t v = 0; v < s->variants; v++)
            dem_buffer_print(out, "  %-28s %9s +- %s\n", t->study->variants[v].name,
                             dem_format_double(text[0], 32, s->items[i].mean[v], 5),
                             dem_format_double(text[1], 32, s->items[i].error[v], 2));
        if (t->grains->spheres) {
            dem_buffer_text(out, "  ");
            say_enough(out, s, &s->items[i]);
            dem_buffer_text(out, "\n");
        }
    }
    say_all(out, s);
    dem_buffer_text(out, "\n");
    free(s);
}

void shape_json(dem_buffer *out, cli_session *session, const shape_told *t)
{
    sheet *s = sheet_make(t);
    if (!s)
        return;
    dem_json_writer w = dem_json_begin(out);
    dem_json_open_object(&w, NULL);
    dem_json_put_whole(&w, "cells", (int64_t)dem_shape_cells(t->study));
    dem_json_put_whole(&w, "missing", (int64_t)t->missing);
    dem_json_put_whole(&w, "failed", (int64_t)t->failed);
    dem_json_open_array(&w, "figures", true);
    for (size_t i = 0; i < s->count; i++) {
        const shown *item = &s->items[i];
        dem_json_open_object(&w, NULL);
        dem_json_put_string(&w, "test", t->study->tests[item->test]->name);
        dem_json_put_string(&w, "figure", item->figure->name);
        dem_json_put_string(&w, "unit", item->figure->unit);
        if (t->grains->spheres && item->enough < s->variants)
            dem_json_put_number(&w, "enough_spheres", s->x[item->enough]);
        dem_json_put_numbers(&w, "x", s->x, s->variants);
        dem_json_put_numbers(&w, "mean", item->mean, s->variants);
        dem_json_put_numbers(&w, "error95", item->error, s->variants);
        dem_json_put_numbers(&w, "seconds", s->seconds[item->test], s->variants);
        dem_json_close(&w, '}');
    }
    dem_json_close(&w, ']');
    cli_put_warnings(session, &w);
    dem_json_close(&w, '}');
    free(s);
}
