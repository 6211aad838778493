#include "out/plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "out/scale.h"
#include "out/xml.h"

// lengths in pixels of the picture
enum { LEFT = 52, TOP = 30, BOTTOM = 44, TICK = 5, SMALL_TICK = 3, CAP = 3, LABEL_APART = 13, LABEL_GAP = 10 };
enum { MARKS = 6, COLOURS = 8 };

static const double letter = 6.1;  // usual breadth of one at 11 pixels
static const double mark_size = 3.8;
static const char grey[] = "#8a8f98";

// told apart with every kind of colour blindness, and by lightness in a copy (after Okabe and Ito 2008)
static const char *const colours[COLOURS] = {"#0060a8", "#d55e00", "#009e73", "#b0529a",
                                             "#e0a000", "#45a5dd", "#7d5a3c", "#4a4e57"};

typedef struct panel {
    dem_buffer *out;
    const dem_plot *plot;
    dem_scale x, y;
    double left, right, top, bottom;
    bool floored;  // something stands on the axis
} panel;

static double at_x(const panel *p, double value)
{
    return p->left + (p->right - p->left) * dem_scale_map(&p->x, value);
}

static double at_y(const panel *p, double value)
{
    return p->bottom - (p->bottom - p->top) * dem_scale_map(&p->y, value);
}

// below the floor: stands on it
static bool is_floored(const dem_plot *plot, double value)
{
    return plot->y.log && plot->y.floor > 0 && isfinite(value) && value < plot->y.floor;
}

static bool takes(const dem_plot *plot, const dem_plot_series *s, size_t i)
{
    return dem_scale_takes(plot->x.log, s->x[i]) &&
           (dem_scale_takes(plot->y.log, s->y[i]) || is_floored(plot, s->y[i]));
}

static double height_of(const dem_plot *plot, double value)
{
    return is_floored(plot, value) ? plot->y.floor : value;
}

// ---- pieces of SVG

static void put_line(dem_buffer *out, double x1, double y1, double x2, double y2, const char *style)
{
    dem_buffer_text(out, "<line");
    dem_xml_attribute(out, "x1", x1);
    dem_xml_attribute(out, "y1", y1);
    dem_xml_attribute(out, "x2", x2);
    dem_xml_attribute(out, "y2", y2);
    dem_buffer_print(out, " %s/>\n", style);
}

static void put_text(dem_buffer *out, double x, double y, const char *style, const char *text)
{
    dem_buffer_text(out, "<text");
    dem_xml_attribute(out, "x", x);
    dem_xml_attribute(out, "y", y);
    dem_buffer_print(out, " %s>", style);
    dem_xml_text(out, text);
    dem_buffer_text(out, "</text>\n");
}

// the mark of a series: circle, square, triangle, diamond, triangle upside down, cross
static void put_mark(dem_buffer *out, size_t series, double x, double y, bool hollow)
{
    static const signed char corners[MARKS][12][2] = {{{0}},
                                                      {{-9, -9}, {9, -9}, {9, 9}, {-9, 9}},
                                                      {{0, -12}, {11, 8}, {-11, 8}},
                                                      {{0, -13}, {13, 0}, {0, 13}, {-13, 0}},
                                                      {{0, 12}, {11, -8}, {-11, -8}},
                                                      {{-3, -11},
                                                       {3, -11},
                                                       {3, -3},
                                                       {11, -3},
                                                       {11, 3},
                                                       {3, 3},
                                                       {3, 11},
                                                       {-3, 11},
                                                       {-3, 3},
                                                       {-11, 3},
                                                       {-11, -3},
                                                       {-3, -3}}};
    static const int counts[MARKS] = {0, 4, 3, 4, 3, 12};
    const char *colour = colours[series % COLOURS];
    size_t mark = series % MARKS;
    if (mark == 0) {
        dem_buffer_text(out, "<circle");
        dem_xml_attribute(out, "cx", x);
        dem_xml_attribute(out, "cy", y);
        dem_xml_attribute(out, "r", mark_size);
    } else {
        dem_buffer_text(out, "<path d=\"");
        for (int k = 0; k < counts[mark]; k++) {
            dem_buffer_text(out, k ? "L" : "M");
            dem_xml_number(out, x + corners[mark][k][0] * mark_size / 10);
            dem_buffer_text(out, " ");
            dem_xml_number(out, y + corners[mark][k][1] * mark_size / 10);
        }
        dem_buffer_text(out, "Z\"");
    }
    dem_buffer_print(out, " fill=\"%s\" stroke=\"%s\" stroke-width=\"%s\"/>\n", hollow ? "#fff" : colour,
                     hollow ? colour : "#fff", hollow ? "1.4" : "0.9");
}

// ---- axes

static void draw_ticks(panel *p, bool vertical)
{
    dem_tick ticks[DEM_MOST_TICKS];
    size_t count = dem_scale_ticks(vertical ? &p->y : &p->x, ticks);
    for (size_t i = 0; i < count; i++) {
        bool labelled = *ticks[i].label;
        double at = vertical ? at_y(p, ticks[i].value) : at_x(p, ticks[i].value), size = labelled ? TICK : SMALL_TICK;
        if (vertical) {
            if (labelled)
                put_line(p->out, p->left, at, p->right, at, "stroke=\"#e4e6ea\"");
            put_line(p->out, p->left - size, at, p->left, at, "stroke=\"#8a8f98\"");
        } else {
            if (labelled)
                put_line(p->out, at, p->top, at, p->bottom, "stroke=\"#e4e6ea\"");
            put_line(p->out, at, p->bottom, at, p->bottom + size, "stroke=\"#8a8f98\"");
        }
        if (!labelled)
            continue;
        char label[32] = "";
        if (vertical && p->floored && ticks[i].value <= p->plot->y.floor * 1.0001)
            strcpy(label, "≤ ");
        strncat(label, ticks[i].label, sizeof label - strlen(label) - 1);
        put_text(p->out, vertical ? p->left - TICK - 3 : at, vertical ? at + 4 : p->bottom + TICK + 12,
                 vertical ? "text-anchor=\"end\"" : "text-anchor=\"middle\"", label);
    }
}

static void draw_axes(panel *p)
{
    draw_ticks(p, false);
    draw_ticks(p, true);
    put_line(p->out, p->left, p->top, p->left, p->bottom, "stroke=\"#8a8f98\"");
    put_line(p->out, p->left, p->bottom, p->right, p->bottom, "stroke=\"#8a8f98\"");
    if (p->plot->y.title)
        put_text(p->out, p->left - LEFT + 8, p->top - 13, "font-weight=\"bold\" font-size=\"12.5\" fill=\"#1d2129\"",
                 p->plot->y.title);
    if (p->plot->x.title)
        put_text(p->out, (p->left + p->right) / 2, p->bottom + 34, "text-anchor=\"middle\"", p->plot->x.title);
}

// ---- data

static void draw_bars(const panel *p, const dem_plot_series *s, const char *colour)
{
    char style[64];
    snprintf(style, sizeof style, "stroke=\"%s\" stroke-width=\"1.2\"", colour);
    for (size_t i = 0; s->error && i < s->count; i++) {
        if (!takes(p->plot, s, i) || is_floored(p->plot, s->y[i]) || !(s->error[i] > 0) || !isfinite(s->error[i]))
            continue;
        double x = at_x(p, s->x[i]), high = s->y[i] + s->error[i], low = s->y[i] - s->error[i];
        double top = fmax(at_y(p, high), p->top), bottom = p->bottom;
        if (dem_scale_takes(p->plot->y.log, low) && low > p->y.low) {
            bottom = at_y(p, low);
            put_line(p->out, x - CAP, bottom, x + CAP, bottom, style);
        }
        put_line(p->out, x - CAP, top, x + CAP, top, style);
        put_line(p->out, x, top, x, bottom, style);
    }
}

static void draw_series(const panel *p, size_t number)
{
    const dem_plot_series *s = &p->plot->series[number];
    bool begun = false;
    for (size_t i = 0; !s->points_only && i < s->count; i++) {
        if (!takes(p->plot, s, i))
            continue;
        dem_buffer_text(p->out, begun ? " " : "<polyline points=\"");
        begun = true;
        dem_xml_number(p->out, at_x(p, s->x[i]));
        dem_buffer_text(p->out, " ");
        dem_xml_number(p->out, at_y(p, height_of(p->plot, s->y[i])));
    }
    if (begun)
        dem_buffer_print(p->out, "\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.8\" stroke-linejoin=\"round\"/>\n",
                         colours[number % COLOURS]);
    draw_bars(p, s, colours[number % COLOURS]);
    for (size_t i = 0; i < s->count; i++)
        if (takes(p->plot, s, i))
            put_mark(p->out, number, at_x(p, s->x[i]), at_y(p, height_of(p->plot, s->y[i])),
                     is_floored(p->plot, s->y[i]));
}

// ---- names at the ends of the lines

typedef struct end_label {
    size_t series;
    double x, y, at;  // of the last point; where the label goes
} end_label;

static int by_height(const void *a, const void *b)
{
    const end_label *p = a, *q = b;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    return p->series < q->series ? -1 : p->series > q->series;
}

// pushes labels apart, and back into the panel
static void spread(end_label *labels, size_t count, double top, double bottom)
{
    double apart = LABEL_APART;
    if (count > 1 && apart * (double)(count - 1) > bottom - top)
        apart = (bottom - top) / (double)(count - 1);
    for (size_t i = 0; i < count; i++) {
        labels[i].at = fmax(labels[i].y, top);
        if (i > 0 && labels[i].at < labels[i - 1].at + apart)
            labels[i].at = labels[i - 1].at + apart;
    }
    for (size_t i = count; i-- > 0;) {
        double most = i + 1 < count ? labels[i + 1].at - apart : bottom;
        labels[i].at = fmin(labels[i].at, most);
    }
}

static void draw_names(const panel *p)
{
    end_label *labels = dem_alloc(p->plot->series_count, sizeof *labels);
    size_t count = 0;
    for (size_t k = 0; labels && k < p->plot->series_count; k++) {
        const dem_plot_series *s = &p->plot->series[k];
        for (size_t i = s->count; i-- > 0;)
            if (takes(p->plot, s, i)) {
                labels[count++] = (end_label){k, at_x(p, s->x[i]), at_y(p, height_of(p->plot, s->y[i])), 0};
                break;
            }
    }
    if (!labels) {
        p->out->failed = true;
        return;
    }
    qsort(labels, count, sizeof *labels, by_height);
    spread(labels, count, p->top + 4, p->bottom - 2);
    for (size_t i = 0; i < count; i++) {
        const end_label *l = &labels[i];
        char style[80];
        if (fabs(l->at - l->y) > 3 || p->right - l->x > 4) {
            snprintf(style, sizeof style, "stroke=\"%s\" stroke-width=\"0.6\" stroke-dasharray=\"1.5 2\"",
                     colours[l->series % COLOURS]);
            put_line(p->out, l->x + mark_size + 1, l->y, p->right + LABEL_GAP - 2, l->at, style);
        }
        snprintf(style, sizeof style, "fill=\"%s\"", colours[l->series % COLOURS]);
        put_text(p->out, p->right + LABEL_GAP, l->at + 4, style, p->plot->series[l->series].name);
    }
    free(labels);
}

static double names_breadth(const dem_plot *plot)
{
    size_t longest = 0;
    for (size_t k = 0; k < plot->series_count; k++)
        longest = strlen(plot->series[k].name) > longest ? strlen(plot->series[k].name) : longest;
    return plot->series_count > 1 ? LABEL_GAP + letter * (double)(longest < 20 ? longest : 20) : LABEL_GAP;
}

// ---- the whole

// all values along x or y, ends of bars included; *count of them, NULL: out of memory
static double *collect(const dem_plot *plot, bool vertical, size_t *count)
{
    size_t most = 0;
    for (size_t k = 0; k < plot->series_count; k++)
        most += 3 * plot->series[k].count;
    double *values = dem_alloc(most, sizeof *values);
    *count = 0;
    for (size_t k = 0; values && k < plot->series_count; k++) {
        const dem_plot_series *s = &plot->series[k];
        for (size_t i = 0; i < s->count; i++) {
            if (!takes(plot, s, i))
                continue;
            values[(*count)++] = vertical ? height_of(plot, s->y[i]) : s->x[i];
            if (vertical && s->error) {
                values[(*count)++] = s->y[i] + s->error[i];
                values[(*count)++] = plot->y.log ? fmax(s->y[i] - s->error[i], s->y[i] / 3) : s->y[i] - s->error[i];
            }
        }
    }
    return values;
}

static bool fit(panel *p, bool vertical)
{
    size_t count;
    double *values = collect(p->plot, vertical, &count);
    if (!values)
        return false;
    if (vertical) {
        p->y = dem_scale_fit(p->plot->y.log, values, count);
        for (size_t i = 0; i < count; i++)
            p->floored |= p->plot->y.log && p->plot->y.floor > 0 && values[i] <= p->plot->y.floor;
        if (p->floored) {
            p->y.low = p->plot->y.floor;
            p->y.high = fmax(p->y.high, 100 * p->y.low);
        }
    } else
        p->x = dem_scale_fit(p->plot->x.log, values, count);
    free(values);
    return count > 0;
}

void dem_plot_draw(dem_buffer *out, const dem_plot *plot, double x, double y, double width, double height)
{
    panel p = {.out = out,
               .plot = plot,
               .left = x + LEFT,
               .right = x + width - names_breadth(plot),
               .top = y + TOP,
               .bottom = y + height - BOTTOM};
    bool any = fit(&p, false);
    any = fit(&p, true) && any;
    dem_buffer_text(out, "<g font-size=\"11\" fill=\"#4a4e57\">\n");
    draw_axes(&p);
    if (!any)
        put_text(out, (p.left + p.right) / 2, (p.top + p.bottom) / 2, "text-anchor=\"middle\"", "nothing to show");
    for (size_t k = plot->series_count; any && k-- > 0;)
        draw_series(&p, k);
    if (any && plot->series_count > 1)
        draw_names(&p);
    dem_buffer_text(out, "</g>\n");
}

// ---- sheets

enum { PANEL_WIDTH = 370, PANEL_HEIGHT = 270, MARGIN = 16, TITLE = 34, LEGEND_ROW = 22, NOTE = 26 };

// the legend in rows; returns its height, draws where `out` is given
static double legend(dem_buffer *out, const dem_plot *plot, double left, double top, double width)
{
    double x = left, y = top;
    if (plot->series_count < 2)
        return 0;
    for (size_t k = 0; k < plot->series_count; k++) {
        const char *name = plot->series[k].name;
        double breadth = 44 + 6.6 * (double)strlen(name);
        if (x > left && x + breadth > left + width) {
            x = left;
            y += LEGEND_ROW;
        }
        if (out) {
            char style[64];
            snprintf(style, sizeof style, "stroke=\"%s\" stroke-width=\"1.8\"", colours[k % COLOURS]);
            if (!plot->series[k].points_only)
                put_line(out, x, y + 10, x + 24, y + 10, style);
            put_mark(out, k, x + 12, y + 10, false);
            put_text(out, x + 30, y + 14, "font-size=\"12\"", name);
        }
        x += breadth;
    }
    return y + LEGEND_ROW - top;
}

static void open_sheet(dem_buffer *out, const dem_plot_sheet *sheet, double width, double height)
{
    if (!sheet->fragment)
        dem_buffer_text(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    dem_buffer_text(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ");
    dem_xml_number(out, width);
    dem_buffer_text(out, " ");
    dem_xml_number(out, height);
    dem_buffer_text(out, "\"");
    dem_xml_attribute(out, "width", width);
    dem_xml_attribute(out, "height", height);
    dem_buffer_print(out, " font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" fill=\"#4a4e57\">\n");
    if (!sheet->fragment)
        dem_buffer_text(out, "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n");
}

void dem_plot_sheet_draw(dem_buffer *out, const dem_plot_sheet *sheet)
{
    size_t columns = sheet->columns < sheet->count ? sheet->columns : sheet->count;
    columns = columns ? columns : 1;
    size_t rows = (sheet->count + columns - 1) / columns;
    double width = 2 * MARGIN + (double)columns * PANEL_WIDTH, top = MARGIN + (sheet->title ? TITLE : 0);
    double key = sheet->count ? legend(NULL, sheet->plots, MARGIN + 8, top, width - 2 * MARGIN) : 0;
    double height = top + key + (double)rows * PANEL_HEIGHT + (sheet->note ? NOTE : 0) + MARGIN / 2.0;
    open_sheet(out, sheet, width, height);
    if (sheet->title)
        put_text(out, MARGIN + 8, MARGIN + 16, "font-size=\"17\" font-weight=\"bold\" fill=\"#1d2129\"", sheet->title);
    if (sheet->count)
        legend(out, sheet->plots, MARGIN + 8, top, width - 2 * MARGIN);
    for (size_t i = 0; i < sheet->count; i++)
        dem_plot_draw(out, &sheet->plots[i], MARGIN + (double)(i % columns) * PANEL_WIDTH,
                      top + key + (double)(i / columns) * PANEL_HEIGHT + 6, PANEL_WIDTH - 14, PANEL_HEIGHT - 10);
    if (sheet->note) {
        char style[64];
        snprintf(style, sizeof style, "font-size=\"11\" fill=\"%s\"", grey);
        put_text(out, MARGIN + 8, height - MARGIN, style, sheet->note);
    }
    dem_buffer_text(out, "</svg>\n");
}
