#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/units.h"
#include "clump/figures.h"
#include "clump/measures.h"
#include "clump_report.h"
#include "clump_sweep.h"

static const char *const moments_text[] = {"free", "volume", "exact"};

enum { BREADTH = 8 };

// of the measures
static const char *const heads[] = {"gap",    "mean",   "Hausd.",  "protr.",  "normal",
                                    "volume", "centre", "inertia", "overlap", "pieces"};
_Static_assert(sizeof heads / sizeof *heads == DEM_MEASURES, "a head for every measure");

static bool failed(const dem_sweep_cell *cell)
{
    return cell->status != DEM_OK;
}

// ---- text

static void put_aligned(dem_buffer *out, int breadth, const char *text)
{
    dem_buffer_print(out, "%*s", breadth, text);
}

static void put_figure(dem_buffer *out, int breadth, double value)
{
    char text[32];
    double size = fabs(value);
    if (size < 1e-4 && value != 0)
        snprintf(text, sizeof text, "%.0e", value);
    else
        dem_format_double(text, sizeof text, value, size < 0.1 ? 2 : 3);
    put_aligned(out, breadth, text);
}

static void text_row(dem_buffer *out, const sweep_grain *g, size_t series, size_t count)
{
    const dem_sweep_cell *c = dem_sweep_at(&g->sweep, series, count);
    if (!c->ran)
        return;
    dem_buffer_print(out, "  %-14s %6zu", g->sweep.series[series].name, g->sweep.counts[count]);
    if (failed(c)) {
        dem_buffer_print(out, "  failed: %s\n", c->message);
        return;
    }
    dem_buffer_print(out, " %7zu", c->pack.count);
    for (int i = 0; i < DEM_MEASURES; i++)
        put_figure(out, BREADTH, dem_measure_shown(&dem_measures[i], dem_measure_of(&dem_measures[i], &c->fidelity)));
    dem_buffer_print(out, "   ");
    put_figure(out, 8, c->seconds);
    dem_buffer_text(out, "\n");
}

void sweep_text(dem_buffer *out, const sweep_grain *g, const sweep_options *options)
{
    double factor;
    const char *unit = dem_length_unit(g->shape.equivalent_diameter, &factor);
    dem_buffer_print(out, "%s: %zu triangles, equivalent diameter ", g->base.name, g->base.report.triangles);
    dem_buffer_number(out, g->shape.equivalent_diameter * factor, 4);
    dem_buffer_print(out, " %s\n\n  %-14s %6s %7s", unit, "method", "asked", "spheres");
    for (int i = 0; i < DEM_MEASURES; i++)
        put_aligned(out, BREADTH, heads[i]);
    dem_buffer_print(out, "   %8s\n  %-14s %6s %7s", "packing", "", "", "");
    for (int i = 0; i < DEM_MEASURES; i++)
        put_aligned(out, BREADTH, *dem_measures[i].unit ? dem_measures[i].unit : "-");
    dem_buffer_print(out, "   %8s\n", "s");
    for (size_t s = 0; s < g->sweep.series_count; s++)
        for (size_t k = 0; k < g->sweep.count_count; k++)
            text_row(out, g, s, k);
    dem_buffer_print(out,
                     "\n  mean and Hausdorff distance of the surfaces, protrusion and centre offset in %% of the "
                     "equivalent diameter;\n  volume, centre and inertia: errors of the union against the mesh\n  "
                     "packing: processor time of a packing that runs alone, on %d %s\n",
                     options->threads, options->threads == 1 ? "thread" : "threads");
    for (size_t i = 0; i < options->job->outputs.count; i++)
        dem_buffer_print(out, "  wrote %s\n", options->job->outputs.items[i]);
    if (options->job->folder)
        dem_buffer_print(out, "  wrote %s.{csv,svg,html} in %s\n", g->base.name, options->job->folder);
    dem_buffer_text(out, "\n");
}

// ---- CSV

static void csv_number(dem_buffer *out, bool known, double value)
{
    dem_buffer_text(out, ",");
    if (known && isfinite(value))
        dem_buffer_number(out, value, 10);
}

static void csv_row(dem_buffer *out, const sweep_grain *g, size_t series, size_t count)
{
    const dem_sweep_cell *c = dem_sweep_at(&g->sweep, series, count);
    if (!c->ran)
        return;
    dem_fidelity f = c->fidelity;
    bool known = !failed(c);
    report_csv_text(out, g->base.name);
    dem_buffer_text(out, ",");
    report_csv_text(out, g->sweep.series[series].name);
    dem_buffer_print(out, ",%zu,%s", g->sweep.counts[count], known ? "done" : "failed");
    csv_number(out, known, (double)c->pack.count);
    for (int i = 0; i < DEM_FIDELITY_FIGURES; i++)
        csv_number(out, known, *figure_of(&f, &dem_fidelity_figures[i]));
    csv_number(out, known, (double)f.pieces);
    csv_number(out, known, g->base.solid.volume);
    csv_number(out, known, c->whole.solid.volume);
    for (int k = 0; k < 3; k++)
        csv_number(out, known, c->inertia_errors[k]);
    csv_number(out, known, c->seconds);
    csv_number(out, known, c->pack.seconds);
    dem_buffer_print(out, ",%s,", known ? moments_text[c->pack.moments] : "");
    report_csv_text(out, c->message);
    dem_buffer_text(out, "\n");
}

void sweep_csv(dem_buffer *out, const sweep_grain *g)
{
    dem_buffer_text(out, "grain,method,asked,status,spheres");
    for (int i = 0; i < DEM_FIDELITY_FIGURES; i++)
        dem_buffer_print(out, ",%s", dem_fidelity_figures[i].name);
    dem_buffer_text(out,
                    ",pieces,mesh_volume_m3,union_volume_m3,inertia1_error,inertia2_error,inertia3_error,seconds_s,"
                    "wall_seconds_s,moments,message\n");
    for (size_t s = 0; s < g->sweep.series_count; s++)
        for (size_t k = 0; k < g->sweep.count_count; k++)
            csv_row(out, g, s, k);
}

// ---- JSON

static void json_cell(dem_json_writer *w, const sweep_grain *g, size_t series, size_t count)
{
    const dem_sweep_cell *c = dem_sweep_at(&g->sweep, series, count);
    if (!c->ran)
        return;
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "method", g->sweep.series[series].name);
    dem_json_put_whole(w, "asked", (int64_t)g->sweep.counts[count]);
    dem_json_put_string(w, "status", failed(c) ? "failed" : "done");
    if (!failed(c)) {
        dem_fidelity f = c->fidelity;
        dem_vec3 centre = c->whole.solid.centre;
        dem_json_put_whole(w, "spheres", (int64_t)c->pack.count);
        dem_json_put_string(w, "moments", moments_text[c->pack.moments]);
        dem_json_open_object(w, "fidelity");
        for (int i = 0; i < DEM_FIDELITY_FIGURES; i++)
            dem_json_put_number(w, dem_fidelity_figures[i].name, *figure_of(&f, &dem_fidelity_figures[i]));
        dem_json_put_whole(w, "pieces", (int64_t)f.pieces);
        dem_json_close(w, '}');
        dem_json_open_object(w, "union");
        dem_json_put_number(w, "volume", c->whole.solid.volume);
        dem_json_put_numbers(w, "centre", (double[]){centre.x, centre.y, centre.z}, 3);
        dem_json_put_numbers(w, "inertia_errors", c->inertia_errors, 3);
        dem_json_close(w, '}');
        dem_json_put_number(w, "seconds", c->seconds);
        dem_json_put_number(w, "wall_seconds", c->pack.seconds);
    }
    if (*c->message)
        dem_json_put_string(w, "message", c->message);
    dem_json_close(w, '}');
}

void sweep_json(dem_json_writer *w, const sweep_grain *g, const sweep_options *options)
{
    dem_shape shape = g->shape;
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "input", g->base.input);
    dem_json_put_string(w, "name", g->base.name);
    dem_json_put_string(w, "status", g->base.status == DEM_OK ? "done" : "failed");
    if (g->base.status != DEM_OK)
        report_put_error(w, &g->base.error);
    report_put_mesh(w, &g->base.report);
    dem_json_open_object(w, "shape");
    for (int i = 0; i < DEM_SHAPE_FIGURES; i++)
        dem_json_put_number(w, dem_shape_figures[i].name, *figure_of(&shape, &dem_shape_figures[i]));
    dem_json_close(w, '}');
    dem_json_open_array(w, "cells", w->depth == 1);
    for (size_t s = 0; g->sweep.cells && s < g->sweep.series_count; s++)
        for (size_t k = 0; k < g->sweep.count_count; k++)
            json_cell(w, g, s, k);
    dem_json_close(w, ']');
    dem_json_put_whole(w, "threads", options->threads);
    report_put_texts(w, "warnings", g->base.warnings, g->base.warning_count);
    dem_json_close(w, '}');
}
