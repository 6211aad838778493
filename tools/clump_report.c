#include "clump_report.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/json.h"
#include "base/units.h"
#include "clump/figures.h"
#include "clump/file.h"
#include "clump/measures.h"

static const char *const moments_text[] = {"free", "volume", "exact"};

// ---- text

// 4 significant digits, thousands without exponent
static const char *number(char text[32], double value)
{
    if (isnan(value))
        return "-";
    return dem_format_double(text, 32, value, fabs(value) >= 1e4 && fabs(value) < 1e7 ? 7 : 5);
}

void report_compare(dem_buffer *out, const char *name, double mesh, double balls)
{
    char a[32], b[32];
    dem_buffer_print(out, "  %-18s %15s %18s", name, number(a, mesh), number(b, balls));
    double difference = 100 * (balls - mesh) / mesh;
    if (isnan(difference)) {
        dem_buffer_text(out, "\n");
        return;
    }
    dem_buffer_print(out, fabs(difference) < 1e-4 && difference != 0 ? "    %+.1e %%\n" : "    %+.4f %%\n", difference);
}

static void text_mesh(dem_buffer *out, const job_result *r)
{
    const dem_mesh_report *m = &r->report;
    dem_buffer_print(out, "  mesh      %zu triangles, %zu vertices, %zu %s%s", m->triangles, m->vertices, m->bodies,
                     m->bodies == 1 ? "body" : "bodies", m->wrapped ? ", wrapped" : "");
    dem_buffer_print(out, "; %s\n", m->warnings ? "repaired, see the warnings" : "closed, nothing to repair");
    if (r->pack.stand_in_triangles)
        dem_buffer_print(out,
                         "            spheres were sought in %zu triangles that stand for them: volume %+.3f %%, farthest "
                         "vertex %.3f %% of d_eq\n",
                         r->pack.stand_in_triangles, 100 * r->pack.stand_in_volume, 100 * r->pack.stand_in_distance);
}

static void text_shape(dem_buffer *out, const dem_shape *s)
{
    char a[32], b[32], c[32], d[32];
    double factor;
    const char *unit = dem_length_unit(s->equivalent_diameter, &factor);
    dem_buffer_print(out, "  size      equivalent diameter %s %s; box %s x %s x %s %s\n",
                     number(a, s->equivalent_diameter * factor), unit, number(b, s->longest * factor),
                     number(c, s->intermediate * factor), number(d, s->shortest * factor), unit);
    dem_buffer_print(out,
                     "  shape     elongation %.3f  flatness %.3f  sphericity %.3f  convexity %.3f  roundness %.3f  "
                     "angularity %.3f\n\n",
                     s->elongation, s->flatness, s->sphericity, s->convexity, s->roundness, s->angularity);
}

static void text_mass(dem_buffer *out, const job_result *r, const dem_clump_def *c, const dem_shape *s)
{
    static const char *const axes[] = {"I1", "I2", "I3"};
    char name[32];
    double factor;
    const char *unit = dem_length_unit(s->equivalent_diameter, &factor);
    dem_buffer_print(out, "  %-18s %15s %18s    difference\n", "", "mesh", "union of spheres");
    snprintf(name, sizeof name, "volume [%s^3]", unit);
    double cube = factor * factor * factor;
    report_compare(out, name, r->solid.volume * cube, c->union_volume * cube);
    report_compare(out, "mass   [kg]", r->solid.volume * c->density, c->union_volume * c->density);
    for (int i = 0; i < 3; i++) {
        snprintf(name, sizeof name, "%s     [kg m^2]", axes[i]);
        report_compare(out, name, r->solid.principal[i] * c->density, c->union_inertia[i]);
    }
    dem_buffer_print(out, "  the clump has the mass, centre and inertia of the %s; density ",
                     c->mass_from == DEM_MASS_FROM_UNION ? "union" : "mesh");
    dem_buffer_number(out, c->density, 6);
    dem_buffer_text(out, " kg/m^3\n\n");
}

static void text_fidelity(dem_buffer *out, const dem_fidelity *f)
{
    dem_buffer_print(out, "  fidelity  IoU gap            %8.3f %%\n", 100 * f->iou_gap);
    dem_buffer_print(out, "            surface distance   %8.3f %% of d_eq mean, %.2f %% largest (Hausdorff)\n",
                     100 * f->distance_mean, 100 * f->distance_max);
    dem_buffer_print(out, "            protrusion         %8.3f %% of d_eq\n", 100 * f->protrusion);
    dem_buffer_print(out, "            centre offset      %8.1e %% of d_eq;  inertia error %.1e %%\n",
                     100 * f->centre_offset, 100 * f->inertia_error);
    dem_buffer_print(out, "            normal deviation   %8.2f deg\n", f->normal_deviation_deg);
    dem_buffer_print(out, "            overlap ratio      %8.3f;  %zu %s\n", f->overlap_ratio, f->pieces,
                     f->pieces == 1 ? "piece" : "pieces");
}

static void text_targets(dem_buffer *out, const job_options *options, const dem_fidelity *fidelity)
{
    const dem_pack_options *pack = &options->make.pack;
    for (size_t i = 0; i < pack->target_count; i++) {
        char is[32], asked[32];
        const dem_measure *m = dem_measure_find(pack->targets[i].measure);
        double value = dem_measure_of(m, fidelity), bound = pack->targets[i].bound;
        dem_buffer_print(out, "  target    %s %s %s, asked for at most %s %s: %s\n", m->title,
                         number(is, dem_measure_shown(m, value)), m->unit, number(asked, dem_measure_shown(m, bound)),
                         m->unit, value <= bound ? "reached" : "NOT reached");
    }
}

void report_text(dem_buffer *out, const job_result *r, const job_options *options)
{
    if (!r->clump)
        return;
    dem_clump_def c = dem_clump_view(r->clump);
    dem_buffer_print(out, "%s: %zu spheres, IoU gap %.2f %%, moments met: %s  (%.2f s, packing %.2f s)\n\n", r->name,
                     c.ball_count, 100 * c.fidelity.iou_gap, moments_text[r->pack.moments], r->seconds_total,
                     r->pack.seconds);
    if (options->make.pack.gap > 0 && c.fidelity.iou_gap > options->make.pack.gap)
        dem_buffer_print(out, "  the asked gap of %.3f %% was not reached\n", 100 * options->make.pack.gap);
    if (options->make.pack.target_count)
        text_targets(out, options, &c.fidelity);
    text_mesh(out, r);
    text_shape(out, &c.shape);
    text_mass(out, r, &c, &c.shape);
    text_fidelity(out, &c.fidelity);
    for (size_t i = 0; i < r->output_count; i++)
        if (strcmp(r->outputs[i], "-"))
            dem_buffer_print(out, "%s  wrote %s\n", i ? "" : "\n", r->outputs[i]);
}

// ---- figures of JSON and CSV

typedef struct figure {
    const char *name, *unit;  // unit "": pure number
    double value;
} figure;

enum { MAX_FIGURES = 24 };

static size_t report_figures(const dem_mesh_report *m, figure *f)
{
    const figure all[] = {{"input_vertices", "", (double)m->input_vertices},
                          {"input_triangles", "", (double)m->input_triangles},
                          {"vertices", "", (double)m->vertices},
                          {"triangles", "", (double)m->triangles},
                          {"unreferenced_vertices", "", (double)m->unreferenced_vertices},
                          {"welded_vertices", "", (double)m->welded_vertices},
                          {"weld_tolerance", "m", m->weld_tolerance},
                          {"degenerate_triangles", "", (double)m->degenerate_triangles},
                          {"duplicate_triangles", "", (double)m->duplicate_triangles},
                          {"nonmanifold_edges", "", (double)m->nonmanifold_edges},
                          {"dropped_triangles", "", (double)m->dropped_triangles},
                          {"reoriented_triangles", "", (double)m->reoriented_triangles},
                          {"boundary_edges", "", (double)m->boundary_edges},
                          {"holes_filled", "", (double)m->holes_filled},
                          {"shells", "", (double)m->shells},
                          {"bodies", "", (double)m->bodies},
                          {"cavities", "", (double)m->cavities},
                          {"ignored_shells", "", (double)m->ignored_shells},
                          {"merged_shells", "", (double)m->merged_shells},
                          {"self_intersections", "", (double)m->self_intersections},
                          {"volume_before", "m3", m->volume_before},
                          {"volume", "m3", m->volume},
                          {"volume_change", "", m->volume_change}};
    _Static_assert(sizeof all / sizeof *all <= MAX_FIGURES, "room for the figures of a mesh report");
    memcpy(f, all, sizeof all);
    return sizeof all / sizeof *all;
}

// ---- JSON

static void put_figures(dem_json_writer *w, const figure *figures, size_t count)
{
    for (size_t i = 0; i < count; i++)
        dem_json_put_number(w, figures[i].name, figures[i].value);
}

void report_put_texts(dem_json_writer *w, const char *key, char **texts, size_t count)
{
    dem_json_open_array(w, key, false);
    for (size_t i = 0; i < count; i++)
        dem_json_put_string(w, NULL, texts[i]);
    dem_json_close(w, ']');
}

void report_put_mesh(dem_json_writer *w, const dem_mesh_report *report)
{
    figure figures[MAX_FIGURES];
    dem_json_open_object(w, "mesh");
    put_figures(w, figures, report_figures(report, figures));
    dem_json_put_bool(w, "inside_out", report->inside_out);
    dem_json_put_bool(w, "wrapped", report->wrapped);
    dem_json_close(w, '}');
}

void report_put_error(dem_json_writer *w, const dem_error *error)
{
    dem_json_open_object(w, "error");
    dem_json_put_string(w, "file", error->file);
    dem_json_put_whole(w, "line", error->line);
    dem_json_put_string(w, "text", error->text);
    dem_json_close(w, '}');
}

// what was asked for, and what is
static void json_targets(dem_json_writer *w, const job_options *options, const dem_fidelity *fidelity)
{
    const dem_pack_options *pack = &options->make.pack;
    dem_json_open_object(w, "targets");
    for (size_t i = 0; i < pack->target_count; i++) {
        const dem_measure *m = dem_measure_find(pack->targets[i].measure);
        double value = dem_measure_of(m, fidelity);
        dem_json_open_object(w, m->field);
        dem_json_put_number(w, "at_most", pack->targets[i].bound);
        dem_json_put_number(w, "is", value);
        dem_json_put_bool(w, "reached", value <= pack->targets[i].bound);
        dem_json_close(w, '}');
    }
    dem_json_close(w, '}');
}

static void json_clump(dem_json_writer *w, const job_result *r, const job_options *options)
{
    dem_clump_def c = dem_clump_view(r->clump);
    dem_json_put_whole(w, "spheres", (int64_t)c.ball_count);
    dem_json_put_bool(w, "reached", r->pack.reached);
    if (options->make.pack.target_count)
        json_targets(w, options, &c.fidelity);
    dem_json_put_string(w, "moments", moments_text[r->pack.moments]);
    dem_json_put_number(w, "moment_residual", r->pack.moment_residual);
    if (r->pack.stand_in_triangles) {
        dem_json_open_object(w, "stand_in");
        dem_json_put_whole(w, "triangles", (int64_t)r->pack.stand_in_triangles);
        dem_json_put_number(w, "volume_change", r->pack.stand_in_volume);
        dem_json_put_number(w, "distance", r->pack.stand_in_distance);
        dem_json_close(w, '}');
    }
    dem_clump_put_figures(w, &c);
    dem_json_open_object(w, "solid");
    dem_json_put_number(w, "volume", r->solid.volume);
    dem_json_put_number(w, "area", r->solid.area);
    dem_json_put_numbers(w, "centre", (double[]){r->solid.centre.x, r->solid.centre.y, r->solid.centre.z}, 3);
    double inertia[3] = {c.density * r->solid.principal[0], c.density * r->solid.principal[1],
                         c.density * r->solid.principal[2]};
    dem_json_put_numbers(w, "inertia", inertia, 3);
    dem_json_close(w, '}');
}

static void json_result(dem_json_writer *w, const job_result *r, const job_options *options)
{
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "input", r->input);
    if (!r->clump)
        dem_json_put_string(w, "name", r->name);
    dem_json_put_string(w, "status", r->kept ? "kept" : r->status == DEM_OK ? "done" : "failed");
    if (r->label.voxels) {
        dem_json_put_whole(w, "label", r->label.value);
        dem_json_put_whole(w, "voxels", (int64_t)r->label.voxels);
        dem_json_put_number(w, "voxel_volume", r->voxel_volume);
    }
    if (r->status != DEM_OK)
        report_put_error(w, &r->error);
    if (r->clump)
        json_clump(w, r, options);
    report_put_mesh(w, &r->report);
    dem_json_open_object(w, "seconds");
    dem_json_put_number(w, "read", r->seconds_read);
    dem_json_put_number(w, "repair", r->seconds_repair);
    dem_json_put_number(w, "pack", r->pack.seconds);
    dem_json_put_number(w, "total", r->seconds_total);
    dem_json_close(w, '}');
    report_put_texts(w, "warnings", r->warnings, r->warning_count);
    report_put_texts(w, "outputs", r->outputs, r->output_count);
    dem_json_close(w, '}');
}

void report_json(dem_buffer *out, const job_results *results, const job_options *options, bool several)
{
    dem_json_writer w = dem_json_begin(out);
    if (!several && results->count == 1) {
        json_result(&w, &results->items[0], options);
        return;
    }
    size_t failed = 0;
    dem_json_open_object(&w, NULL);
    dem_json_open_array(&w, "grains", true);
    for (size_t i = 0; i < results->count; i++) {
        json_result(&w, &results->items[i], options);
        failed += results->items[i].status != DEM_OK;
    }
    dem_json_close(&w, ']');
    dem_json_put_whole(&w, "failed", (int64_t)failed);
    dem_json_close(&w, '}');
}

// ---- CSV

// quoted where needed (RFC 4180)
void report_csv_text(dem_buffer *out, const char *text)
{
    if (!strpbrk(text, ",\"\n\r")) {
        dem_buffer_text(out, text);
        return;
    }
    dem_buffer_text(out, "\"");
    for (; *text; text++)
        dem_buffer_bytes(out, *text == '"' ? "\"\"" : text, *text == '"' ? 2 : 1);
    dem_buffer_text(out, "\"");
}

static size_t listed_figures(const dem_figure *list, size_t count, void *values, figure *f)
{
    for (size_t i = 0; i < count; i++)
        f[i] = (figure){list[i].name, list[i].unit, *figure_of(values, &list[i])};
    return count;
}

// as the volume's header has it, and where the grain lies in the image
static size_t label_figures(const job_result *r, const dem_clump_def *c, figure *f)
{
    const figure all[] = {{"label", "", (double)r->label.value},
                          {"voxels", "", (double)r->label.voxels},
                          {"voxel_volume", "m3", r->voxel_volume},
                          {"centre_x", "m", c->position.x},
                          {"centre_y", "m", c->position.y},
                          {"centre_z", "m", c->position.z}};
    memcpy(f, all, sizeof all);
    return sizeof all / sizeof *all;
}

static size_t row_figures(const job_result *r, bool labels, figure *f)
{
    dem_clump_def c = {0};
    if (r->clump)
        c = dem_clump_view(r->clump);
    size_t n = 0;
    f[n++] = (figure){"spheres", "", (double)c.ball_count};
    f[n++] = (figure){"triangles", "", r->kept ? NAN : (double)r->report.triangles};
    f[n++] = (figure){"volume", "m3", r->solid.volume};
    f[n++] = (figure){"area", "m2", r->solid.area};
    f[n++] = (figure){"mass", "kg", c.mass};
    f[n++] = (figure){"inertia1", "kgm2", c.inertia[0]};
    f[n++] = (figure){"inertia2", "kgm2", c.inertia[1]};
    f[n++] = (figure){"inertia3", "kgm2", c.inertia[2]};
    n += listed_figures(dem_shape_figures, DEM_SHAPE_FIGURES, &c.shape, f + n);
    n += listed_figures(dem_fidelity_figures, DEM_FIDELITY_FIGURES, &c.fidelity, f + n);
    f[n++] = (figure){"pieces", "", (double)c.fidelity.pieces};
    f[n++] = (figure){"union_volume", "m3", c.union_volume};
    f[n++] = (figure){"seconds_pack", "s", r->kept ? c.seconds : r->pack.seconds};
    f[n++] = (figure){"seconds_total", "s", r->kept ? NAN : r->seconds_total};
    if (labels)
        n += label_figures(r, &c, f + n);
    return n;
}

void report_csv_header(dem_buffer *out, bool labels)
{
    figure figures[3 * MAX_FIGURES];
    job_result none = {0};
    size_t count = row_figures(&none, labels, figures);
    dem_buffer_text(out, "input,name,status");
    for (size_t i = 0; i < count; i++)
        dem_buffer_print(out, ",%s%s%s", figures[i].name, *figures[i].unit ? "_" : "", figures[i].unit);
    dem_buffer_text(out, ",moments,warnings,message\n");
}

void report_csv_start(dem_buffer *out, const job_result *r, const char *status)
{
    report_csv_text(out, r->input);
    dem_buffer_text(out, ",");
    report_csv_text(out, r->name);
    dem_buffer_print(out, ",%s,", status);
}

void report_csv_row(dem_buffer *out, const job_result *r, bool labels)
{
    figure figures[3 * MAX_FIGURES];
    size_t count = row_figures(r, labels, figures);
    report_csv_start(out, r, r->kept ? "kept" : r->status == DEM_OK ? "done" : "failed");
    for (size_t i = 0; i < count; i++) {
        if (r->clump && isfinite(figures[i].value))
            dem_buffer_number(out, figures[i].value, 10);
        dem_buffer_text(out, ",");
    }
    dem_buffer_print(out, "%s,%zu,", r->clump && !r->kept ? moments_text[r->pack.moments] : "", r->warning_count);
    report_csv_text(out, r->status == DEM_OK ? "" : r->error.text);
    dem_buffer_text(out, "\n");
}
