#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/units.h"
#include "clump/figures.h"
#include "clump/measures.h"
#include "clump_sweep.h"
#include "out/page.h"
#include "out/picture.h"
#include "out/plot.h"
#include "out/xml.h"

enum { PICTURE_WIDTH = 440, PICTURE_HEIGHT = 380, MOST_PICTURES = 4, COLUMNS = 3 };

static const double least_percent = 1e-6;  // what is less is noise of rounding
static const double floor_shown = 1e-4;    // [%] moments that are exact are noise far below

// ---- plots

// what is plotted of a grain: the columns of every series, cell by cell
typedef struct curves {
    dem_plot_series *spheres, *seconds;  // [measure][series]
    double *values;
    char titles[DEM_MEASURES][64];
} curves;

static void curves_release(curves *c)
{
    free(c->spheres);
    free(c->seconds);
    free(c->values);
}

static bool curves_make(curves *c, const sweep_grain *g)
{
    size_t series = g->sweep.series_count, counts = g->sweep.count_count, cells = series * counts;
    c->spheres = dem_alloc(DEM_MEASURES * series, sizeof *c->spheres);
    c->seconds = dem_alloc(DEM_MEASURES * series, sizeof *c->seconds);
    c->values = dem_alloc((DEM_MEASURES + 2) * cells, sizeof *c->values);
    if (!c->spheres || !c->seconds || !c->values)
        return false;
    double *spheres = c->values + DEM_MEASURES * cells, *seconds = spheres + cells;
    for (size_t i = 0; i < cells; i++) {
        const dem_sweep_cell *cell = &g->sweep.cells[i];
        bool good = cell->ran && cell->status == DEM_OK;
        spheres[i] = good ? (double)cell->pack.count : NAN;
        seconds[i] = good ? cell->seconds : NAN;
        for (size_t m = 0; m < DEM_MEASURES; m++) {
            double value = good ? dem_measure_of(&dem_measures[m], &cell->fidelity) : NAN;
            c->values[m * cells + i] = dem_measure_shown(&dem_measures[m], value);
        }
    }
    for (size_t m = 0; m < DEM_MEASURES; m++) {
        const dem_measure *measure = &dem_measures[m];
        snprintf(c->titles[m], sizeof c->titles[m], *measure->unit ? "%s [%s%s%s]" : "%s%s%s%s", measure->title,
                 measure->unit, *measure->of ? " " : "", measure->of);
        c->titles[m][0] = (char)(c->titles[m][0] - (c->titles[m][0] >= 'a' ? 'a' - 'A' : 0));
        for (size_t s = 0; s < series; s++) {
            dem_plot_series one = {.name = g->sweep.series[s].name,
                                   .x = spheres + s * counts,
                                   .y = c->values + m * cells + s * counts,
                                   .count = counts};
            c->spheres[m * series + s] = one;
            one.x = seconds + s * counts;
            c->seconds[m * series + s] = one;
        }
    }
    return true;
}

static dem_plot plot_of(const curves *c, const sweep_grain *g, size_t measure, bool against_seconds)
{
    const dem_plot_series *all = against_seconds ? c->seconds : c->spheres;
    bool part = dem_measures[measure].kind == DEM_MEASURE_PART;
    return (dem_plot){{against_seconds ? "packing time [s]" : "spheres", true, 0},
                      {c->titles[measure], true, part ? floor_shown : 0},
                      all + measure * g->sweep.series_count,
                      g->sweep.series_count};
}

// the number of the measure with this name
static size_t measure_number(const char *name)
{
    return (size_t)(dem_measure_find(name) - dem_measures);
}

static const char *const chosen[] = {"gap", "distance", "hausdorff", "normal", "volume", "inertia"};
enum { CHOSEN = sizeof chosen / sizeof *chosen };

dem_status sweep_svg(dem_buffer *out, const sweep_grain *g, dem_error *error)
{
    curves c = {0};
    dem_plot plots[2 * CHOSEN];
    char title[300];
    bool good = curves_make(&c, g);
    for (size_t i = 0; good && i < 2 * CHOSEN; i++)
        plots[i] = plot_of(&c, g, measure_number(chosen[i % CHOSEN]), i >= CHOSEN);
    snprintf(title, sizeof title, "%.200s: error against number of spheres and packing time", g->base.name);
    if (good)
        dem_plot_sheet_draw(
            out,
            &(dem_plot_sheet){.title = title,
                              .plots = plots,
                              .count = 2 * CHOSEN,
                              .columns = COLUMNS,
                              .note = "Measured between the mesh and the union of the spheres; d_eq: diameter of the "
                                      "sphere of equal volume. Hollow marks: smaller than the axis shows. "
                                      "Packing time: processor time."});
    curves_release(&c);
    return good ? DEM_OK : dem_fail_memory(error);
}

// all but the number of pieces
static bool page_plots(dem_buffer *out, const sweep_grain *g, bool against_seconds, const char *caption)
{
    curves c = {0};
    dem_plot plots[DEM_MEASURES - 1];
    bool good = curves_make(&c, g);
    for (size_t m = 0; good && m < DEM_MEASURES - 1; m++)
        plots[m] = plot_of(&c, g, m, against_seconds);
    if (good) {
        dem_page_figure_begin(out);
        dem_plot_sheet_draw(
            out, &(dem_plot_sheet){.plots = plots, .count = DEM_MEASURES - 1, .columns = COLUMNS, .fragment = true});
        dem_page_figure_end(out, caption);
    }
    curves_release(&c);
    return good;
}

// ---- pictures

static dem_status draw_part(const dem_ctx *ctx, const sweep_grain *g, const dem_sweep_cell *cell, dem_picture_part part,
                            dem_buffer *out, dem_error *error)
{
    dem_image image;
    DEM_TRY(dem_picture_render_part(ctx, &g->mesh, cell->pack.balls, cell->pack.count, part, PICTURE_WIDTH,
                                    PICTURE_HEIGHT, &image, error));
    dem_status status = dem_png_encode(&image, out, error);
    dem_image_free(&image);
    return status;
}

// the clump, and if there is none yet the grain
static dem_status draw_cell(const dem_ctx *ctx, const sweep_grain *g, const dem_sweep_cell *cell, dem_buffer *grain,
                            dem_buffer *clump, dem_error *error)
{
    if (grain->size == 0)
        DEM_TRY(draw_part(ctx, g, cell, DEM_PICTURE_GRAIN, grain, error));
    return draw_part(ctx, g, cell, DEM_PICTURE_BALLS, clump, error);
}

// every series has its row; the grain stands before the first
typedef struct gallery {
    size_t counts[MOST_PICTURES], count;
    dem_buffer grain, *clumps;  // [series * MOST_PICTURES]
    const char *missing;        // why there are none; NULL: there are
} gallery;

static void choose_counts(gallery *pictures, const sweep_grain *g)
{
    size_t all = g->sweep.count_count;
    pictures->count = all < MOST_PICTURES ? all : MOST_PICTURES;
    for (size_t i = 0; i < pictures->count; i++)
        pictures->counts[i] = pictures->count > 1 ? i * (all - 1) / (pictures->count - 1) : 0;
}

static dem_status gallery_make(const dem_ctx *ctx, const sweep_grain *g, gallery *pictures, dem_error *error)
{
    choose_counts(pictures, g);
    pictures->clumps = dem_alloc_zero(g->sweep.series_count * MOST_PICTURES, sizeof *pictures->clumps);
    if (!pictures->clumps)
        return dem_fail_memory(error);
    for (size_t s = 0; s < g->sweep.series_count; s++)
        for (size_t i = 0; i < pictures->count; i++) {
            const dem_sweep_cell *cell = dem_sweep_at(&g->sweep, s, pictures->counts[i]);
            if (!cell->ran || cell->status != DEM_OK)
                continue;
            double done = (double)(s * pictures->count + i) / (double)(g->sweep.series_count * pictures->count);
            dem_error reason;
            dem_status status = DEM_INTERRUPTED;
            if (!dem_progress(ctx, "pictures", done))
                status = draw_cell(&(dem_ctx){.threads = ctx->threads}, g, cell, &pictures->grain,
                                   &pictures->clumps[s * MOST_PICTURES + i], &reason);
            if (status == DEM_NO_MEMORY)
                return dem_fail_memory(error);
            if (status != DEM_OK) {
                pictures->missing = status == DEM_UNAVAILABLE ? "This build draws no pictures: it is without Embree."
                                                              : "Interrupted before the pictures were drawn.";
                return DEM_OK;
            }
        }
    return DEM_OK;
}

static void gallery_release(gallery *pictures, const sweep_grain *g)
{
    for (size_t i = 0; pictures->clumps && i < g->sweep.series_count * MOST_PICTURES; i++)
        dem_buffer_release(&pictures->clumps[i]);
    free(pictures->clumps);
    dem_buffer_release(&pictures->grain);
}

static void page_gallery(dem_buffer *out, const sweep_grain *g, const gallery *pictures)
{
    dem_page_heading(out, "The clumps");
    if (pictures->missing) {
        dem_page_paragraph(out, pictures->missing);
        return;
    }
    dem_page_grid_begin(out, pictures->count + 1);
    for (size_t s = 0; s < g->sweep.series_count; s++) {
        dem_page_row_begin(out, false);
        dem_page_picture(out, s ? NULL : &pictures->grain, s ? "" : "the grain");
        for (size_t i = 0; i < pictures->count; i++) {
            char caption[160];
            const dem_sweep_cell *cell = dem_sweep_at(&g->sweep, s, pictures->counts[i]);
            const dem_buffer *picture = &pictures->clumps[s * MOST_PICTURES + i];
            if (picture->size) {
                char gap[32];
                dem_format_double(gap, sizeof gap, 100 * cell->fidelity.iou_gap, 3);
                snprintf(caption, sizeof caption, "%s, %zu %s, gap %s %%", g->sweep.series[s].name, cell->pack.count,
                         cell->pack.count == 1 ? "sphere" : "spheres", gap);
            } else
                snprintf(caption, sizeof caption, "%s, %zu asked for: none", g->sweep.series[s].name,
                         g->sweep.counts[pictures->counts[i]]);
            dem_page_picture(out, picture, caption);
        }
        dem_page_row_end(out);
    }
    dem_page_grid_end(out);
}

// ---- the grain

static const char *length_unit(const sweep_grain *g, double *factor)
{
    const char *unit = dem_length_unit(g->shape.equivalent_diameter, factor);
    return strcmp(unit, "um") == 0 ? "µm" : unit;
}

static void page_repair(dem_buffer *out, const job_result *base)
{
    const dem_mesh_report *m = &base->report;
    char text[400];
    snprintf(
        text, sizeof text,
        "The file holds %zu vertices and %zu triangles; the closed surface that was packed has %zu and %zu, in %zu "
        "%s%s. %s",
        m->input_vertices, m->input_triangles, m->vertices, m->triangles, m->bodies, m->bodies == 1 ? "body" : "bodies",
        m->wrapped ? ", wrapped" : "",
        base->warning_count ? "What was found and done:" : "Nothing had to be repaired.");
    dem_page_paragraph(out, text);
    if (base->warning_count) {
        dem_page_list_begin(out);
        for (size_t i = 0; i < base->warning_count; i++)
            dem_page_item(out, NULL, base->warnings[i]);
        dem_page_list_end(out);
    }
}

static void quantity_row(dem_buffer *out, const char *name, double value, const char *unit)
{
    dem_page_row_begin(out, false);
    dem_page_cell(out, name);
    dem_page_number(out, value, 4);
    dem_page_cell(out, unit);
    dem_page_row_end(out);
}

static void page_shape(dem_buffer *out, const sweep_grain *g)
{
    static const char *const heads[] = {"Size and shape", "", ""};
    static const char *const titles[] = {"equivalent diameter d_eq",
                                         "longest edge of the box",
                                         "intermediate edge",
                                         "shortest edge",
                                         "elongation",
                                         "flatness",
                                         "sphericity",
                                         "convexity",
                                         "roundness",
                                         "angularity"};
    _Static_assert(sizeof titles / sizeof *titles == DEM_SHAPE_FIGURES, "a title for every figure");
    dem_shape shape = g->shape;
    double factor;
    const char *unit = length_unit(g, &factor);
    char text[32];
    dem_page_table_begin(out, NULL, heads, 3);
    for (int i = 0; i < DEM_SHAPE_FIGURES; i++) {
        bool length = *dem_shape_figures[i].unit != 0;
        double value = *figure_of(&shape, &dem_shape_figures[i]);
        quantity_row(out, titles[i], length ? factor * value : value, length ? unit : "");
    }
    snprintf(text, sizeof text, "%s³", unit);
    quantity_row(out, "volume", g->base.solid.volume * pow(factor, 3), text);
    snprintf(text, sizeof text, "%s²", unit);
    quantity_row(out, "surface area", g->base.solid.area * pow(factor, 2), text);
    dem_page_table_end(out);
}

static void page_grain(dem_buffer *out, const sweep_grain *g, const gallery *pictures)
{
    dem_page_heading(out, "The grain");
    dem_page_halves_begin(out);
    page_shape(out, g);
    dem_page_halves_next(out);
    page_repair(out, &g->base);
    if (pictures->grain.size) {
        dem_page_grid_begin(out, 1);
        dem_page_row_begin(out, false);
        dem_page_picture(out, &pictures->grain, "");
        dem_page_row_end(out);
        dem_page_grid_end(out);
    }
    dem_page_halves_end(out);
}

// ---- tables

// an error in percent
static void put_percent(dem_buffer *out, double part)
{
    double percent = 100 * part;
    dem_page_number(out, fabs(percent) < least_percent ? 0 : percent, 3);
}

static void put_failed(dem_buffer *out, size_t cells)
{
    dem_page_cell(out, "failed");
    for (size_t i = 1; i < cells; i++)
        dem_page_cell(out, "–");
}

static void page_mass(dem_buffer *out, const sweep_grain *g, double density)
{
    char caption[400], volume[32];
    const char *heads[12] = {"method",     "spheres",    volume,       "diff. [%]", "centre off [% d_eq]",
                             "I1 [kg m²]", "diff. [%]",  "I2 [kg m²]", "diff. [%]", "I3 [kg m²]",
                             "diff. [%]",  "moments met"};
    static const char *const met[] = {"none", "volume, centre", "all"};
    double factor, cube;
    const char *unit = length_unit(g, &factor);
    char number[32];
    cube = pow(factor, 3);
    snprintf(volume, sizeof volume, "volume [%s³]", unit);
    snprintf(caption, sizeof caption,
             "The union of the spheres against the mesh: volume, centre of mass and principal "
             "moments of inertia at %s kg/m³, all exact integrals. diff.: (union − mesh) / mesh, 0 below 10⁻⁶ %%.",
             dem_format_double(number, sizeof number, density, 6));
    dem_page_heading(out, "Mass properties");
    dem_page_table_begin(out, caption, heads, 12);
    dem_page_row_begin(out, false);
    dem_page_cell(out, "mesh");
    dem_page_cell(out, "–");
    dem_page_number(out, g->base.solid.volume * cube, 5);
    dem_page_cell(out, "–");
    dem_page_cell(out, "–");
    for (int k = 0; k < 3; k++) {
        dem_page_number(out, g->base.solid.principal[k] * density, 5);
        dem_page_cell(out, "–");
    }
    dem_page_cell(out, "");
    dem_page_row_end(out);
    for (size_t s = 0; s < g->sweep.series_count; s++)
        for (size_t k = 0; k < g->sweep.count_count; k++) {
            const dem_sweep_cell *c = dem_sweep_at(&g->sweep, s, k);
            if (!c->ran || c->status != DEM_OK)
                continue;
            dem_page_row_begin(out, k == 0);
            dem_page_cell(out, g->sweep.series[s].name);
            dem_page_number(out, (double)c->pack.count, 7);
            dem_page_number(out, c->whole.solid.volume * cube, 5);
            put_percent(out, c->fidelity.volume_error);
            put_percent(out, c->fidelity.centre_offset);
            for (int i = 0; i < 3; i++) {
                dem_page_number(out, c->whole.solid.principal[i] * density, 5);
                put_percent(out, c->inertia_errors[i]);
            }
            dem_page_cell(out, met[c->pack.moments]);
            dem_page_row_end(out);
        }
    dem_page_table_end(out);
}

static void page_figures(dem_buffer *out, const sweep_grain *g)
{
    char titles[DEM_MEASURES][64];
    const char *heads[DEM_MEASURES + 4] = {"method", "asked", "spheres"};
    for (int i = 0; i < DEM_MEASURES; i++) {
        const dem_measure *m = &dem_measures[i];
        snprintf(titles[i], sizeof titles[i], *m->unit ? "%s [%s]" : "%s%s", m->title, m->unit);
        heads[3 + i] = titles[i];
    }
    heads[3 + DEM_MEASURES] = "packing [s]";
    dem_page_heading(out, "All figures");
    dem_page_table_begin(
        out, "Lengths in % of d_eq; 0: below 10⁻⁶ %. Packing time: processor time of one packing that ran alone.",
        heads, DEM_MEASURES + 4);
    for (size_t s = 0; s < g->sweep.series_count; s++)
        for (size_t k = 0; k < g->sweep.count_count; k++) {
            const dem_sweep_cell *c = dem_sweep_at(&g->sweep, s, k);
            if (!c->ran)
                continue;
            dem_page_row_begin(out, k == 0);
            dem_page_cell(out, g->sweep.series[s].name);
            dem_page_number(out, (double)g->sweep.counts[k], 7);
            if (c->status != DEM_OK)
                put_failed(out, DEM_MEASURES + 2);
            else {
                dem_page_number(out, (double)c->pack.count, 7);
                for (int i = 0; i < DEM_MEASURES; i++) {
                    double value = dem_measure_of(&dem_measures[i], &c->fidelity);
                    if (dem_measures[i].kind == DEM_MEASURE_PART)
                        put_percent(out, value);
                    else
                        dem_page_number(out, value, 3);
                }
                dem_page_number(out, c->seconds, 3);
            }
            dem_page_row_end(out);
        }
    dem_page_table_end(out);
}

static void page_messages(dem_buffer *out, const sweep_grain *g)
{
    bool any = false;
    for (size_t s = 0; s < g->sweep.series_count; s++)
        for (size_t k = 0; k < g->sweep.count_count; k++) {
            const dem_sweep_cell *c = dem_sweep_at(&g->sweep, s, k);
            char name[96];
            if (!c->ran || !*c->message)
                continue;
            if (!any)
                dem_page_list_begin(out);
            any = true;
            snprintf(name, sizeof name, "%s, %zu", g->sweep.series[s].name, g->sweep.counts[k]);
            dem_page_item(out, name, c->message);
        }
    if (any)
        dem_page_list_end(out);
}

// ---- how it was made

static void page_measures(dem_buffer *out)
{
    static const char *const meaning[] = {
        "1 − (intersection / union) of the two solids, by exact lengths along bundles of parallel lines.",
        "surface to surface, the mean of both directions.",
        "the largest distance from a point of either surface to the other one.",
        "how far the union reaches outside the mesh.",
        ("mean angle between the normal of the union and that of the nearest place of the mesh: roughness the grain "
         "does not have."),
        "of the union of the spheres, exact.",
        "distance between the two centres of mass, exact.",
        "the largest relative error of the three principal moments, exact.",
        "sum of the volumes of the spheres over that of their union.",
        "connected pieces of the union; more than one is no rigid body."};
    _Static_assert(sizeof meaning / sizeof *meaning == DEM_MEASURES, "a meaning for every measure");
    dem_page_list_begin(out);
    for (int i = 0; i < DEM_MEASURES; i++)
        dem_page_item(out, dem_measures[i].title, meaning[i]);
    dem_page_list_end(out);
}

static void page_made(dem_buffer *out, const sweep_grain *g, const sweep_options *options)
{
    char text[400];
    const dem_pack_options *pack = &options->job->make.pack;
    dem_page_heading(out, "What the figures mean");
    page_measures(out);
    dem_page_heading(out, "How this was made");
    dem_page_command(out, options->command);
    snprintf(
        text, sizeof text,
        "dem-clump %s, seed %llu, on %d %s. The clumps are the same on every machine and for any number of threads; "
        "the seconds are this machine's. Every clump is measured by one evaluator that knows nothing of the packers.",
        dem_version(), (unsigned long long)pack->seed, options->threads, options->threads == 1 ? "thread" : "threads");
    dem_page_paragraph(out, text);
    dem_page_list_begin(out);
    for (size_t s = 0; s < g->sweep.series_count; s++) {
        const dem_packer *packer = g->sweep.series[s].packer;
        snprintf(text, sizeof text, "%s%s%s%s", packer->about, packer->paper ? " (" : "",
                 packer->paper ? packer->paper : "", packer->paper ? ")" : "");
        dem_page_item(out, g->sweep.series[s].name, text);
    }
    dem_page_list_end(out);
}

// what most want to know first
static void page_summary(dem_buffer *out, const sweep_grain *g)
{
    for (size_t k = g->sweep.count_count; k-- > 0;) {
        const dem_sweep_cell *best = NULL;
        size_t series = 0, ran = 0;
        for (size_t s = 0; s < g->sweep.series_count; s++) {
            const dem_sweep_cell *c = dem_sweep_at(&g->sweep, s, k);
            bool good = c->ran && c->status == DEM_OK;
            ran += good;
            if (good && (!best || c->fidelity.iou_gap < best->fidelity.iou_gap)) {
                best = c;
                series = s;
            }
        }
        if (!best)
            continue;
        char text[400], a[5][32];
        snprintf(text, sizeof text,
                 "With %zu spheres%s%s%s the IoU gap is %s %%, the mean surface distance %s %% of d_eq, the Hausdorff "
                 "distance %s %%, the mean angle between the normals %s degrees; packed in %s s.",
                 best->pack.count, ran > 1 ? " by the best method, " : "", ran > 1 ? g->sweep.series[series].name : "",
                 ran > 1 ? "," : "", dem_format_double(a[0], 32, 100 * best->fidelity.iou_gap, 3),
                 dem_format_double(a[1], 32, 100 * best->fidelity.distance_mean, 3),
                 dem_format_double(a[2], 32, 100 * best->fidelity.distance_max, 3),
                 dem_format_double(a[3], 32, best->fidelity.normal_deviation_deg, 3),
                 dem_format_double(a[4], 32, best->seconds, 3));
        dem_page_paragraph(out, text);
        return;
    }
}

dem_status sweep_page(const dem_ctx *ctx, dem_buffer *out, const sweep_grain *g, const sweep_options *options,
                      dem_error *error)
{
    gallery pictures = {0};
    char title[300];
    dem_status status = gallery_make(ctx, g, &pictures, error);
    snprintf(title, sizeof title, "Clumps of %s", g->base.name);
    dem_page_begin(out, title, "Error against number of spheres and against packing time");
    page_summary(out, g);
    page_grain(out, g, &pictures);
    dem_page_heading(out, "Error against number of spheres");
    bool good =
        page_plots(out, g, false,
                   "Errors between the mesh and the union of the spheres, by the number of spheres there are (not "
                   "the number asked for). Hollow marks: smaller than the axis shows.");
    dem_page_heading(out, "Error against packing time");
    good = page_plots(out, g, true, "The same errors by the processor time that the packing took.") && good;
    page_gallery(out, g, &pictures);
    page_mass(out, g, options->job->make.density);
    page_figures(out, g);
    page_messages(out, g);
    page_made(out, g, options);
    dem_page_end(out, NULL);
    gallery_release(&pictures, g);
    if (status == DEM_OK && !good)
        status = dem_fail_memory(error);
    return status;
}
