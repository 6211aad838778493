// What a study of convergence has found: text, JSON, CSV, a page.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "out/page.h"
#include "out/plot.h"
#include "study_convergence.h"

static const dem_convergence_point *point_of(const dem_convergence *c, size_t method, size_t level)
{
    return &c->points[method * c->levels + level];
}

static double error_of(const dem_convergence *c, size_t method, size_t level, size_t quantity)
{
    return point_of(c, method, level)->errors[quantity].error;
}

static const dem_order *order_of(const dem_convergence *c, size_t method, size_t quantity)
{
    return &c->orders[method * c->quantity_count + quantity];
}

// "2", "1", "1/2", "1/4" of the scene's own step
static void level_name(size_t level, char *text, size_t size)
{
    if (level == 0)
        snprintf(text, size, "2 h");
    else if (level == 1)
        snprintf(text, size, "h");
    else
        snprintf(text, size, "h/%zu", (size_t)1 << (level - 1));
}

// the column that a scheme's name needs
static int name_width(const dem_convergence *c)
{
    int width = 8;
    for (size_t m = 0; m < c->method_count; m++)
        if ((int)strlen(c->names[m]) > width)
            width = (int)strlen(c->names[m]);
    return width;
}

static const char *quantity_unit(const dem_convergence *c, size_t quantity)
{
    static const char *const units[DEM_QUANTITIES] = {[DEM_QUANTITY_STATE] = "sizes or rad",
                                                      [DEM_QUANTITY_PLACE] = "sizes",
                                                      [DEM_QUANTITY_TURN] = "rad",
                                                      [DEM_QUANTITY_ENERGY] = "of the energy turned over"};
    return quantity < DEM_QUANTITIES ? units[quantity] : c->chaotic ? "of its range, means" : "of its range";
}

// ---- sentences

static void put_probe(dem_buffer *out, const dem_convergence *c)
{
    char number[2][32];
    if (c->flows)
        dem_buffer_text(out, "Bodies come or leave, so that runs are compared by the means of ensembles.");
    else {
        dem_buffer_print(out, "Two runs that differ by 1e-12 in places and orientations come %s times as far apart",
                         dem_format_double(number[0], sizeof number[0], c->growth, 3));
        if (c->chaotic && c->rate > 0)
            dem_buffer_print(out, ", ten times within %s s",
                             dem_format_double(number[1], sizeof number[1], log(10) / c->rate, 2));
        dem_buffer_text(out, c->chaotic ? ": no trajectory is right, and ensembles are compared by their means."
                                        : ": trajectories can be compared.");
    }
}

static void put_reference(dem_buffer *out, const dem_convergence *c)
{
    char number[2][32];
    dem_buffer_print(out, "Reference: %s with a step of %s s", c->reference_name,
                     dem_format_double(number[0], sizeof number[0], c->finest.step, 4));
    if (c->chaotic)
        dem_buffer_print(out, ", %zu runs", c->members);
    dem_buffer_print(out, "; the scene's own step is h = %s s",
                     dem_format_double(number[0], sizeof number[0], c->points[0].step / 2, 6));
    if (isfinite(c->contact))
        dem_buffer_print(out, ", its shortest contact takes %s s or %s steps",
                         dem_format_double(number[0], sizeof number[0], c->contact, 3),
                         dem_format_double(number[1], sizeof number[1], 2 * c->contact / c->points[0].step, 3));
    dem_buffer_text(out, ".");
}

static void put_best(dem_buffer *out, const dem_convergence *c, const char *scene)
{
    (void)scene;
    char number[4][32];
    dem_format_double(number[0], sizeof number[0], 100 * c->asked, 3);
    if (c->best == SIZE_MAX) {
        dem_buffer_print(out, "No setting of these has an error of %s below %s %%; take more --levels%s.",
                         c->quantities[c->of], number[0], c->chaotic ? " or more --members" : "");
        return;
    }
    const dem_convergence_point *p = &c->points[c->best];
    const dem_error_found *e = &p->errors[c->of];
    dem_buffer_print(out, "The cheapest with an error of %s below %s %% (%s %%, doubt %s %%; ", c->quantities[c->of],
                     number[0], dem_format_double(number[1], sizeof number[1], 100 * e->error, 3),
                     dem_format_double(number[2], sizeof number[2], 100 * e->doubt, 2));
    dem_buffer_print(
        out, "%s s of one processor, at h %s s):", dem_format_double(number[1], sizeof number[1], p->seconds, 3),
        dem_format_double(number[2], sizeof number[2], point_of(c, 0, 1)->seconds, 3));
}

static bool is_file(const char *scene)
{
    const dem_convergence_scene *s;
    for (size_t i = 0; (s = dem_convergence_scene_at(i)); i++)
        if (strcmp(s->name, scene) == 0)
            return false;
    return true;
}

static void put_command(dem_buffer *out, const dem_convergence *c, const char *scene)
{
    if (is_file(scene))
        dem_buffer_print(out, "dem-run %s ", scene);
    dem_convergence_override(c, c->best, out);
}

// ---- text

static void text_table(dem_buffer *out, const dem_convergence *c, size_t quantity)
{
    int width = name_width(c);
    char text[32];
    dem_buffer_print(out, "\nerror of %s [%s]\n%*s  order", c->quantities[quantity], quantity_unit(c, quantity), -width,
                     "");
    for (size_t l = 0; l < c->levels; l++) {
        level_name(l, text, sizeof text);
        dem_buffer_print(out, " %9s", text);
    }
    dem_buffer_text(out, "\n");
    for (size_t m = 0; m < c->method_count; m++) {
        const dem_order *o = order_of(c, m, quantity);
        if (isnan(o->order))
            snprintf(text, sizeof text, "-");
        else
            snprintf(text, sizeof text, "%s%.2f", o->points > 2 ? "" : "~", o->order);
        dem_buffer_print(out, "%*s  %5s", -width, c->names[m], text);
        for (size_t l = 0; l < c->levels; l++) {
            dem_error_found e = point_of(c, m, l)->errors[quantity];
            if (*point_of(c, m, l)->failed)
                snprintf(text, sizeof text, "failed");
            else if (isnan(e.error))
                snprintf(text, sizeof text, "-");
            else if (e.error < e.doubt)
                snprintf(text, sizeof text, "<%.1e", e.error + e.doubt);
            else
                snprintf(text, sizeof text, "%.2e", e.error);
            dem_buffer_print(out, " %9s", text);
        }
        dem_buffer_text(out, "\n");
    }
}

static void text_seconds(dem_buffer *out, const dem_convergence *c)
{
    int width = name_width(c);
    dem_buffer_print(out, "\nseconds of one processor\n");
    for (size_t m = 0; m < c->method_count; m++) {
        dem_buffer_print(out, "%*s       ", -width, c->names[m]);
        for (size_t l = 0; l < c->levels; l++) {
            char text[32];
            snprintf(text, sizeof text, "%.2e", point_of(c, m, l)->seconds);
            dem_buffer_print(out, " %9s", text);
        }
        dem_buffer_text(out, "\n");
    }
}

void convergence_text(dem_buffer *out, const dem_convergence *c, const char *scene)
{
    dem_buffer_print(out, "%s\n", scene);
    put_probe(out, c);
    dem_buffer_text(out, "\n");
    put_reference(out, c);
    dem_buffer_text(out, "\n");
    text_table(out, c, c->of);
    if (c->of != DEM_QUANTITY_ENERGY && !isnan(error_of(c, 0, c->levels - 1, DEM_QUANTITY_ENERGY)))
        text_table(out, c, DEM_QUANTITY_ENERGY);
    text_seconds(out, c);
    dem_buffer_text(out, "~: of two points alone; <: not told from zero\n");
    if (isnan(c->asked))
        return;
    dem_buffer_text(out, "\n");
    put_best(out, c, scene);
    dem_buffer_text(out, "\n");
    if (c->best != SIZE_MAX) {
        dem_buffer_text(out, "  ");
        put_command(out, c, scene);
        dem_buffer_text(out, "\n");
    }
}

// ---- JSON

static void json_point(dem_json_writer *w, const dem_convergence *c, size_t at)
{
    const dem_convergence_point *p = &c->points[at];
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "scheme", c->names[at / c->levels]);
    dem_json_put_number(w, "step", p->step);
    dem_json_put_whole(w, "steps", (int64_t)p->steps);
    dem_json_put_number(w, "steps_per_contact", c->contact / p->step);
    dem_json_put_number(w, "seconds", p->seconds);
    if (*p->failed)
        dem_json_put_string(w, "failed", p->failed);
    dem_json_put_number(w, "error", p->errors[c->of].error);
    dem_json_put_number(w, "doubt", p->errors[c->of].doubt);
    dem_json_put_number(w, "energy", p->errors[DEM_QUANTITY_ENERGY].error);
    dem_json_close(w, '}');
}

void convergence_json(dem_buffer *out, const dem_convergence *c, const char *scene, cli_session *session)
{
    dem_json_writer w = dem_json_begin(out);
    dem_json_open_object(&w, NULL);
    dem_json_put_string(&w, "scene", scene);
    dem_json_put_bool(&w, "chaotic", c->chaotic);
    dem_json_put_number(&w, "growth", c->growth);
    dem_json_put_number(&w, "growth_rate", c->rate);
    dem_json_put_number(&w, "step", c->points[0].step / 2);
    dem_json_put_number(&w, "contact_time", c->contact);
    dem_json_put_whole(&w, "members", (int64_t)c->members);
    dem_json_put_string(&w, "of", c->quantities[c->of]);
    dem_json_open_array(&w, "points", true);
    for (size_t i = 0; i < c->method_count * c->levels; i++)
        json_point(&w, c, i);
    dem_json_close(&w, ']');
    dem_json_open_array(&w, "orders", true);
    for (size_t m = 0; m < c->method_count; m++) {
        const dem_order *o = order_of(c, m, c->of);
        dem_json_open_object(&w, NULL);
        dem_json_put_string(&w, "scheme", c->names[m]);
        dem_json_put_number(&w, "order", o->order);
        dem_json_put_number(&w, "coarse", o->coarse);
        dem_json_put_number(&w, "fine", o->fine);
        dem_json_put_whole(&w, "points", (int64_t)o->points);
        dem_json_close(&w, '}');
    }
    dem_json_close(&w, ']');
    if (c->best != SIZE_MAX) {
        dem_buffer best = {0};
        dem_convergence_override(c, c->best, &best);
        dem_json_put_string(&w, "override", best.failed ? "" : best.data);
        dem_buffer_release(&best);
    }
    cli_put_warnings(session, &w);
    dem_json_close(&w, '}');
}

// ---- CSV

void convergence_csv(dem_buffer *out, const dem_convergence *c)
{
    dem_buffer_text(out, "scheme,step_s,steps,steps_per_contact,processor_s,failed");
    for (size_t q = 0; q < c->quantity_count; q++)
        dem_buffer_print(out, ",%s,%s_doubt", c->quantities[q], c->quantities[q]);
    dem_buffer_text(out, "\n");
    for (size_t i = 0; i < c->method_count * c->levels; i++) {
        const dem_convergence_point *p = &c->points[i];
        dem_buffer_print(out, "%s,", c->names[i / c->levels]);
        dem_buffer_shortest(out, p->step);
        dem_buffer_print(out, ",%llu,", (unsigned long long)p->steps);
        dem_buffer_number(out, c->contact / p->step, 6);
        dem_buffer_text(out, ",");
        dem_buffer_number(out, p->seconds, 6);
        dem_buffer_text(out, *p->failed ? ",1" : ",0");
        for (size_t q = 0; q < c->quantity_count; q++) {
            dem_buffer_text(out, ",");
            dem_buffer_shortest(out, p->errors[q].error);
            dem_buffer_text(out, ",");
            dem_buffer_shortest(out, p->errors[q].doubt);
        }
        dem_buffer_text(out, "\n");
    }
}

void convergence_orders_csv(dem_buffer *out, const dem_convergence *c)
{
    dem_buffer_text(out, "scheme,quantity,order,coarse_step_s,fine_step_s,points\n");
    for (size_t m = 0; m < c->method_count; m++)
        for (size_t q = 0; q < c->quantity_count; q++) {
            const dem_order *o = order_of(c, m, q);
            dem_buffer_print(out, "%s,%s,", c->names[m], c->quantities[q]);
            dem_buffer_shortest(out, o->order);
            dem_buffer_text(out, ",");
            dem_buffer_shortest(out, o->coarse);
            dem_buffer_text(out, ",");
            dem_buffer_shortest(out, o->fine);
            dem_buffer_print(out, ",%zu\n", o->points);
        }
}

// ---- the page

enum { PLOTTED = 2, PLOTS = 2 * PLOTTED };

// errors in percent of the quantity asked for and of the energy, against steps and seconds
typedef struct curves {
    dem_plot_series *series;  // [plot][method]
    double *values;           // [steps, seconds, then error and doubt of each plotted quantity][point]
    char titles[PLOTTED][DEM_CONVERGENCE_NAME + 40];
} curves;

static bool curves_make(curves *v, const dem_convergence *c, const size_t plotted[PLOTTED])
{
    size_t points = c->method_count * c->levels;
    v->series = dem_alloc(PLOTS * c->method_count, sizeof *v->series);
    v->values = dem_alloc((2 + 2 * PLOTTED) * points, sizeof *v->values);
    if (!v->series || !v->values)
        return false;
    double *steps = v->values, *seconds = steps + points;
    for (size_t i = 0; i < points; i++) {
        const dem_convergence_point *p = &c->points[i];
        steps[i] = isfinite(c->contact) ? c->contact / p->step : (double)p->steps;
        seconds[i] = p->seconds;
        for (size_t k = 0; k < PLOTTED; k++) {
            const dem_error_found *e = &p->errors[plotted[k]];
            v->values[(2 + 2 * k) * points + i] = 100 * e->error;
            v->values[(3 + 2 * k) * points + i] = 100 * e->doubt;
        }
    }
    for (size_t k = 0; k < PLOTTED; k++)
        snprintf(v->titles[k], sizeof v->titles[k], "error of %s [%%]", c->quantities[plotted[k]]);
    for (size_t i = 0; i < PLOTS; i++)
        for (size_t m = 0; m < c->method_count; m++) {
            size_t k = i / 2;
            v->series[i * c->method_count + m] =
                (dem_plot_series){.name = c->names[m],
                                  .x = (i % 2 ? seconds : steps) + m * c->levels,
                                  .y = v->values + (2 + 2 * k) * points + m * c->levels,
                                  .error = c->chaotic ? v->values + (3 + 2 * k) * points + m * c->levels : NULL,
                                  .count = c->levels};
        }
    return true;
}

static bool page_curves(dem_buffer *out, const dem_convergence *c)
{
    curves v = {0};
    size_t plotted[PLOTTED] = {c->of, DEM_QUANTITY_ENERGY};
    if (c->of == DEM_QUANTITY_ENERGY)
        plotted[0] = c->chaotic ? DEM_QUANTITIES : DEM_QUANTITY_STATE;
    dem_plot plots[PLOTS];
    bool good = curves_make(&v, c, plotted);
    for (size_t i = 0; good && i < PLOTS; i++)
        plots[i] = (dem_plot){{i % 2                  ? "seconds of one processor"
                               : isfinite(c->contact) ? "steps in the shortest contact"
                                                      : "steps",
                               true, 0},
                              {v.titles[i / 2], true, 0},
                              v.series + i * c->method_count,
                              c->method_count};
    if (good) {
        dem_page_figure_begin(out);
        dem_plot_sheet_draw(out, &(dem_plot_sheet){.plots = plots, .count = PLOTS, .columns = 2, .fragment = true});
        dem_page_figure_end(out, c->chaotic ? "Error of the mean, with its 95 % interval; what is zero is not shown."
                                            : "Largest error of any time; what is zero is not shown.");
    }
    free(v.series);
    free(v.values);
    return good;
}

static void page_apart(dem_buffer *out, const dem_convergence *c)
{
    double times[DEM_CONVERGENCE_SAMPLES + 1];
    for (size_t i = 0; i <= c->samples; i++)
        times[i] = c->end * (double)i / (double)c->samples;
    dem_plot_series one = {.name = "distance", .x = times, .y = c->apart, .count = c->samples + 1};
    dem_plot plot = {{"time [s]", false, 0}, {"distance [sizes or rad]", true, 0}, &one, 1};
    dem_page_figure_begin(out);
    dem_plot_sheet_draw(out, &(dem_plot_sheet){.plots = &plot, .count = 1, .columns = 1, .fragment = true});
    dem_page_figure_end(out, "How two runs part that differ by 1e-12 at the start.");
}

static void page_table(dem_buffer *out, const dem_convergence *c, size_t quantity)
{
    const char *heads[3 + DEM_CONVERGENCE_LEVELS] = {"scheme", "order", "between [s]"};
    char names[DEM_CONVERGENCE_LEVELS][16], caption[200], text[80];
    for (size_t l = 0; l < c->levels; l++) {
        level_name(l, names[l], sizeof names[l]);
        heads[3 + l] = names[l];
    }
    snprintf(caption, sizeof caption, "Error of %s [%s]", c->quantities[quantity], quantity_unit(c, quantity));
    dem_page_table_begin(out, caption, heads, 3 + c->levels);
    for (size_t m = 0; m < c->method_count; m++) {
        const dem_order *o = order_of(c, m, quantity);
        dem_page_row_begin(out, false);
        dem_page_cell(out, c->names[m]);
        dem_page_number(out, o->order, 3);
        char number[2][32];
        snprintf(text, sizeof text, "%s to %s", dem_format_double(number[0], sizeof number[0], o->coarse, 3),
                 dem_format_double(number[1], sizeof number[1], o->fine, 3));
        dem_page_cell(out, isnan(o->order) ? "–" : text);
        for (size_t l = 0; l < c->levels; l++)
            if (*point_of(c, m, l)->failed)
                dem_page_cell(out, "failed");
            else
                dem_page_number(out, error_of(c, m, l, quantity), 3);
        dem_page_row_end(out);
    }
    dem_page_table_end(out);
}

static void page_failures(dem_buffer *out, const dem_convergence *c)
{
    bool any = false;
    for (size_t i = 0; i < c->method_count * c->levels; i++) {
        char text[300], step[32];
        if (!*c->points[i].failed)
            continue;
        if (!any)
            dem_page_list_begin(out);
        any = true;
        snprintf(text, sizeof text, "%s, step %s s", c->names[i / c->levels],
                 dem_format_double(step, sizeof step, c->points[i].step, 3));
        dem_page_item(out, text, c->points[i].failed);
    }
    if (any)
        dem_page_list_end(out);
}

static void page_sentence(dem_buffer *out, const dem_convergence *c, const char *scene,
                          void (*put)(dem_buffer *, const dem_convergence *, const char *),
                          void (*page)(dem_buffer *, const char *))
{
    dem_buffer text = {0};
    put(&text, c, scene);
    page(out, text.failed ? "" : text.data);
    dem_buffer_release(&text);
}

static void put_start(dem_buffer *out, const dem_convergence *c, const char *scene)
{
    (void)scene;
    put_probe(out, c);
    dem_buffer_text(out, " ");
    put_reference(out, c);
}

bool convergence_page(dem_buffer *out, const dem_convergence *c, const char *scene)
{
    dem_page_begin(out, scene, "Errors against step and run time");
    page_sentence(out, c, scene, put_start, dem_page_paragraph);
    if (!isnan(c->asked)) {
        page_sentence(out, c, scene, put_best, dem_page_paragraph);
        if (c->best != SIZE_MAX)
            page_sentence(out, c, scene, put_command, dem_page_command);
    }
    bool good = page_curves(out, c);
    dem_page_heading(out, "Errors");
    page_table(out, c, c->of);
    if (c->of != DEM_QUANTITY_ENERGY)
        page_table(out, c, DEM_QUANTITY_ENERGY);
    page_failures(out, c);
    dem_page_heading(out, c->chaotic ? "A trajectory does not tell" : "Trajectories tell");
    page_apart(out, c);
    dem_page_end(out, "The other quantities are in errors.csv and orders.csv.");
    return good;
}
