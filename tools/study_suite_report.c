// What came of the cases, as tables.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "dem/base.h"
#include "out/page.h"
#include "study_suite.h"

suite_counts suite_count(const tried *items, size_t count)
{
    suite_counts c = {0};
    for (size_t i = 0; i < count; i++) {
        if (!items[i].ran)
            continue;
        c.cases++;
        c.findings += items[i].trial.count;
        c.skipped += items[i].trial.skipped != NULL;
        c.passed += !items[i].trial.skipped && dem_trial_passed(&items[i].trial);
        c.failed += !dem_trial_passed(&items[i].trial);
    }
    return c;
}

static const char *verdict_of(const tried *v)
{
    return v->trial.skipped ? "skipped" : dem_trial_passed(&v->trial) ? "passed" : "FAILED";
}

// "1.2346e-05": six digits, NAN a dash
static const char *figure(char text[32], double value)
{
    if (isnan(value))
        return "-";
    double size = fabs(value);
    if (value != 0 && (size < 1e-3 || size >= 1e6))
        snprintf(text, 32, "%.5e", value);
    else
        dem_format_double(text, 32, value, 6);
    return text;
}

static const char *tolerance(char text[32], const dem_finding *f)
{
    if (f->bound != DEM_BOUND_NEAR)
        return f->bound == DEM_BOUND_MOST ? "at most" : "at least";
    snprintf(text, 32, "%.1e", f->tolerance);
    return text;
}

// ---- text

static void text_finding(dem_buffer *out, const dem_finding *f)
{
    char a[3][32];
    dem_buffer_print(out, "  %-50s %13s %13s %9s  %-6s %s\n", f->what, figure(a[0], f->expected), figure(a[1], f->got),
                     tolerance(a[2], f), f->unit, f->passed ? "" : "FAILED");
}

void suite_text(dem_buffer *out, const tried *items, size_t count, bool all)
{
    bool head = false;
    for (size_t i = 0; i < count; i++) {
        const tried *v = &items[i];
        const dem_trial *t = &v->trial;
        if (!v->ran)
            continue;
        bool shown = all || !dem_trial_passed(t);
        if (shown && !head)
            dem_buffer_print(out, "  %-50s %13s %13s %9s  %-6s\n", "", "expected", "got", "tolerance", "unit");
        head = head || shown;
        char seconds[32];
        dem_format_double(seconds, sizeof seconds, t->seconds, t->seconds < 1 ? 1 : 2);
        dem_buffer_print(out, "%-7s  %-20s %3zu figure%s %5s s  %s (%s)\n", verdict_of(v), v->about->name, t->count,
                         t->count == 1 ? " " : "s", seconds, v->about->about, v->about->source);
        for (size_t k = 0; k < t->count; k++)
            if (all || !t->findings[k].passed)
                text_finding(out, &t->findings[k]);
        if (t->skipped)
            dem_buffer_print(out, "  %s\n", t->skipped);
        if (t->status != DEM_OK)
            dem_buffer_print(out, "  stopped: %s\n", t->error.text);
    }
    suite_counts c = suite_count(items, count);
    dem_buffer_print(out, "%zu case%s, %zu figures: %zu passed, %zu failed, %zu skipped\n", c.cases,
                     c.cases == 1 ? "" : "s", c.findings, c.passed, c.failed, c.skipped);
}

// ---- CSV

// no text of ours has a quote in it
static void csv_text(dem_buffer *out, const char *text)
{
    bool plain = !strpbrk(text, ",\"");
    dem_buffer_print(out, plain ? "%s" : "\"%s\"", text);
}

void suite_csv(dem_buffer *out, const tried *items, size_t count)
{
    static const char *const bounds[] = {"near", "at most", "at least"};
    dem_buffer_text(out, "case,what,unit,bound,expected,got,tolerance,verdict,source\n");
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < items[i].trial.count; k++) {
            const dem_finding *f = &items[i].trial.findings[k];
            csv_text(out, items[i].about->name);
            dem_buffer_text(out, ",");
            csv_text(out, f->what);
            dem_buffer_print(out, ",%s,%s,", f->unit, bounds[f->bound]);
            dem_buffer_shortest(out, f->expected);
            dem_buffer_text(out, ",");
            dem_buffer_shortest(out, f->got);
            dem_buffer_text(out, ",");
            dem_buffer_shortest(out, f->tolerance);
            dem_buffer_print(out, ",%s,", f->passed ? "passed" : "failed");
            csv_text(out, items[i].about->source);
            dem_buffer_text(out, "\n");
        }
}

// ---- page

static void page_overview(dem_buffer *out, const tried *items, size_t count)
{
    static const char *const heads[] = {"case", "what", "expected from", "figures", "seconds", "verdict"};
    dem_page_table_begin(out, NULL, heads, sizeof heads / sizeof *heads);
    for (size_t i = 0; i < count; i++) {
        const tried *v = &items[i];
        char text[32];
        if (!v->ran)
            continue;
        dem_page_row_begin(out, false);
        dem_page_cell(out, v->about->name);
        dem_page_cell(out, v->about->about);
        dem_page_cell(out, v->about->source);
        snprintf(text, sizeof text, "%zu", v->trial.count);
        dem_page_cell(out, text);
        dem_page_number(out, v->trial.seconds, 2);
        dem_page_cell(out, verdict_of(v));
        dem_page_row_end(out);
    }
    dem_page_table_end(out);
}

static void page_plot(dem_buffer *out, const dem_trial *t)
{
    dem_plot_series series[DEM_CURVES];
    if (!t->axes[0].title || !t->curve_count)
        return;
    for (size_t i = 0; i < t->curve_count; i++) {
        const dem_curve *c = &t->curves[i];
        series[i] = (dem_plot_series){.name = c->name, .x = c->x, .y = c->y, .count = c->count};
    }
    dem_plot plot = {.x = t->axes[0], .y = t->axes[1], .series = series, .series_count = t->curve_count};
    dem_page_figure_begin(out);
    dem_plot_sheet_draw(out, &(dem_plot_sheet){.plots = &plot, .count = 1, .columns = 1, .fragment = true});
    dem_page_figure_end(out, NULL);
}

static void page_case(dem_buffer *out, const tried *v)
{
    static const char *const heads[] = {"figure", "expected", "got", "tolerance", "unit", "verdict"};
    char text[3][32], caption[300];
    dem_page_heading(out, v->about->name);
    snprintf(caption, sizeof caption, "%s (%s)", v->about->about, v->about->source);
    dem_page_table_begin(out, caption, heads, sizeof heads / sizeof *heads);
    for (size_t k = 0; k < v->trial.count; k++) {
        const dem_finding *f = &v->trial.findings[k];
        dem_page_row_begin(out, false);
        dem_page_cell(out, f->what);
        dem_page_cell(out, figure(text[0], f->expected));
        dem_page_cell(out, figure(text[1], f->got));
        dem_page_cell(out, tolerance(text[2], f));
        dem_page_cell(out, f->unit);
        dem_page_cell(out, f->passed ? "passed" : "FAILED");
        dem_page_row_end(out);
    }
    dem_page_table_end(out);
    page_plot(out, &v->trial);
    if (v->trial.skipped)
        dem_page_paragraph(out, v->trial.skipped);
    if (v->trial.status != DEM_OK)
        dem_page_paragraph(out, v->trial.error.text);
}

void suite_page(dem_buffer *out, const suite *s, const tried *items, size_t count)
{
    suite_counts c = suite_count(items, count);
    char text[200];
    snprintf(text, sizeof text, "%zu %s, %zu figures: %zu passed, %zu failed, %zu skipped",
             c.cases, s->cases, c.findings, c.passed, c.failed, c.skipped);
    dem_page_begin(out, s->title, text);
    page_overview(out, items, count);
    for (size_t i = 0; i < count; i++)
        if (items[i].ran)
            page_case(out, &items[i]);
    snprintf(text, sizeof text, "%s, dem-clump %s", s->tool, dem_version());
    dem_page_end(out, text);
}
