// Mohr's circles and the line that touches them, normal and shear stress to one scale.
#include <math.h>
#include <stdio.h>

#include "math/vec.h"
#include "out/scale.h"
#include "out/xml.h"
#include "study/mohr_coulomb.h"

enum { WIDTH = 760, LEFT = 64, RIGHT = 24, TOP = 34, BOTTOM = 56, MOST_HEIGHT = 560 };

typedef struct panel {
    dem_buffer *out;
    double low, high, top;  // of the axes [Pa, in `unit`]
    double pixel;           // of a unit of stress
    double height;
} panel;

static double at_x(const panel *p, double value)
{
    return LEFT + (value - p->low) * p->pixel;
}
static double at_y(const panel *p, double value)
{
    return p->height - BOTTOM - value * p->pixel;
}

static void put_line(const panel *p, double x1, double y1, double x2, double y2, const char *style)
{
    dem_buffer_text(p->out, "<line");
    dem_xml_attribute(p->out, "x1", x1);
    dem_xml_attribute(p->out, "y1", y1);
    dem_xml_attribute(p->out, "x2", x2);
    dem_xml_attribute(p->out, "y2", y2);
    dem_buffer_print(p->out, " %s/>\n", style);
}

static void put_text(const panel *p, double x, double y, const char *style, const char *text)
{
    dem_buffer_text(p->out, "<text");
    dem_xml_attribute(p->out, "x", x);
    dem_xml_attribute(p->out, "y", y);
    dem_buffer_print(p->out, " %s>", style);
    dem_xml_text(p->out, text);
    dem_buffer_text(p->out, "</text>\n");
}

// the upper half
static void put_circle(const panel *p, double low, double high)
{
    double r = (high - low) / 2 * p->pixel;
    dem_buffer_text(p->out, "<path d=\"M");
    dem_xml_number(p->out, at_x(p, low));
    dem_buffer_text(p->out, " ");
    dem_xml_number(p->out, at_y(p, 0));
    dem_buffer_text(p->out, "A");
    dem_xml_number(p->out, r);
    dem_buffer_text(p->out, " ");
    dem_xml_number(p->out, r);
    dem_buffer_text(p->out, " 0 0 1 ");
    dem_xml_number(p->out, at_x(p, high));
    dem_buffer_text(p->out, " ");
    dem_xml_number(p->out, at_y(p, 0));
    dem_buffer_text(p->out, "\" fill=\"#0060a8\" fill-opacity=\"0.06\" stroke=\"#0060a8\" stroke-width=\"1.4\"/>\n");
}

static void put_axes(const panel *p, const char *unit)
{
    dem_tick ticks[DEM_MOST_TICKS];
    char title[64];
    const dem_scale x = {false, p->low, p->high}, y = {false, 0, p->top};
    static const char line[] = "stroke=\"#8a8f98\" stroke-width=\"1\"",
                      grid[] = "stroke=\"#eceef1\" stroke-width=\"1\"";
    size_t count = dem_scale_ticks(&x, ticks);
    for (size_t i = 0; i < count; i++)
        if (*ticks[i].label) {
            put_line(p, at_x(p, ticks[i].value), at_y(p, 0), at_x(p, ticks[i].value), at_y(p, 0) + 5, line);
            put_text(p, at_x(p, ticks[i].value), at_y(p, 0) + 19, "text-anchor=\"middle\" font-size=\"11\"",
                     ticks[i].label);
        }
    count = dem_scale_ticks(&y, ticks);
    for (size_t i = 0; i < count; i++)
        if (*ticks[i].label) {
            put_line(p, LEFT, at_y(p, ticks[i].value), WIDTH - RIGHT, at_y(p, ticks[i].value), grid);
            put_text(p, LEFT - 8, at_y(p, ticks[i].value) + 4, "text-anchor=\"end\" font-size=\"11\"", ticks[i].label);
        }
    put_line(p, LEFT, at_y(p, 0), WIDTH - RIGHT, at_y(p, 0), line);
    put_line(p, at_x(p, 0), at_y(p, 0), at_x(p, 0), at_y(p, p->top), line);
    snprintf(title, sizeof title, "normal stress [%s], pressure positive", unit);
    put_text(p, (LEFT + WIDTH - RIGHT) / 2.0, p->height - 14, "text-anchor=\"middle\" font-size=\"12\"", title);
    snprintf(title, sizeof title, "shear stress [%s]", unit);
    put_text(p, LEFT - 48, TOP - 14, "font-size=\"12\"", title);
}

// the line tau = c + sigma tan(phi), broken off at the tensile cutoff
static void put_envelope(const panel *p, const dem_mohr_coulomb *fit, double unit)
{
    double slope = tan(fit->friction_angle), c = fit->cohesion / unit, from = -fit->tensile_cutoff / unit;
    static const char style[] = "stroke=\"#d55e00\" stroke-width=\"2\"";
    double low = fmax(from, p->low), high = p->high;
    if (slope > 0 && c + slope * high > p->top)
        high = (p->top - c) / slope;
    if (slope > 0 && c + slope * low < 0)
        low = -c / slope;
    if (!(high > low))
        return;
    put_line(p, at_x(p, low), at_y(p, c + slope * low), at_x(p, high), at_y(p, c + slope * high), style);
    if (from > p->low && c > 0)
        put_line(p, at_x(p, from), at_y(p, 0), at_x(p, from), at_y(p, c + slope * from), style);
}

void dem_mohr_coulomb_draw(dem_buffer *out, const dem_failure *tests, size_t count, const dem_mohr_coulomb *fit,
                           bool fragment)
{
    double low = -fmax(fit->tensile_cutoff, 0), high = 0, top = 0;
    for (size_t i = 0; i < count; i++) {
        low = fmin(low, tests[i].sigma3);
        high = fmax(high, tests[i].sigma1);
        top = fmax(top, (tests[i].sigma1 - tests[i].sigma3) / 2);
    }
    double span = fmax(high - low, 1e-300);
    static const char *const units[] = {"Pa", "kPa", "MPa", "GPa"};
    int power = (int)fmin(fmax(floor(log10(fmax(span, 1)) / 3 + 1e-9), 0), 3);
    double unit = pow(1000, power);
    panel p = {out, (low - 0.04 * span) / unit, (high + 0.04 * span) / unit, (top + 0.08 * span) / unit, 0, 0};
    p.pixel = fmin((WIDTH - LEFT - RIGHT) / (p.high - p.low), (MOST_HEIGHT - TOP - BOTTOM) / p.top);
    p.high = p.low + (WIDTH - LEFT - RIGHT) / p.pixel;
    p.height = TOP + BOTTOM + p.top * p.pixel;
    dem_buffer_text(out, "<svg xmlns=\"http://www.w3.org/2000/svg\"");
    dem_xml_attribute(out, "width", WIDTH);
    dem_xml_attribute(out, "height", p.height);
    dem_buffer_print(out,
                     " viewBox=\"0 0 %d %d\" font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" "
                     "fill=\"#24272d\">\n",
                     WIDTH, (int)ceil(p.height));
    if (!fragment)
        dem_buffer_text(out, "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n");
    put_axes(&p, units[power]);
    for (size_t i = 0; i < count; i++)
        put_circle(&p, tests[i].sigma3 / unit, tests[i].sigma1 / unit);
    put_envelope(&p, fit, unit);
    dem_buffer_text(out, "</svg>\n");
}
