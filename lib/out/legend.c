#include "out/legend.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// in heights of a capital letter
static const double BAR = 1.3;          // breadth of the colour bar
static const double TICK = 0.4;         // length of a tick
static const double GAP = 0.45;         // between a tick and its number
static const double LINE_HEIGHT = 1.9;  // from line to line
static const double TIP = 1.1;          // the pointed ends of a bar that goes on

double dem_label_margin(double size)
{
    return 1.4 * size;
}

double dem_foot_height(double size)
{
    return 3.2 * size;
}

// ---- numbers

// the least of 1, 2, 5 times a power of ten that is not below x
static double round_up(double x)
{
    double power = pow(10, floor(log10(x) + 1e-9));
    double lead = x / power;
    return (lead <= 1 + 1e-9 ? 1 : lead <= 2 + 1e-9 ? 2 : lead <= 5 + 1e-9 ? 5 : 10) * power;
}

size_t dem_ticks(double low, double high, size_t most, bool whole, double ticks[DEM_TICKS], double *step)
{
    double span = high - low;
    if (!(span > 0 && isfinite(span)) || span <= 1e-12 * fmax(fabs(low), fabs(high))) {
        *step = low != 0 && isfinite(low) ? pow(10, floor(log10(fabs(low))) - 3) : 1;
        ticks[0] = low;
        return 1;
    }
    most = most < 2 ? 2 : most > DEM_TICKS ? DEM_TICKS : most;
    *step = round_up(span / (double)most);
    *step = whole ? fmax(*step, 1) : *step;
    for (;;) {
        double first = ceil(low / *step - 1e-9), last = floor(high / *step + 1e-9);
        if (last - first + 1 > (double)most) {
            *step = round_up(*step * 1.5);
            continue;
        }
        size_t count = 0;
        for (double k = first; k <= last; k++)
            ticks[count++] = k * *step + 0.0;  // no -0
        return count;
    }
}

const char *dem_tick_text(double tick, double step, char *text)
{
    int decimals = (int)fmin(fmax(-floor(log10(step) + 1e-9), 0), 12);
    double power = pow(10, decimals), whole = round(fabs(tick) * power);
    if (!(whole < 1e15))
        return dem_format_double(text, DEM_LABEL_TEXT, tick, 4);
    char digits[24];
    int count = snprintf(digits, sizeof digits, "%015llu", (unsigned long long)whole), first = 0;
    while (first < count - decimals - 1 && digits[first] == '0')
        first++;
    snprintf(text, DEM_LABEL_TEXT, "%s%.*s%s%s", tick < 0 && whole > 0 ? "-" : "", count - decimals - first,
             digits + first, decimals ? "." : "", digits + count - decimals);
    return text;
}

// "10⁻⁶ "
static void put_power(int power, char *text, size_t size)
{
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    snprintf(text, size, "10%s", power < 0 ? "⁻" : "");
    int n = abs(power);
    if (n >= 100)
        snprintf(text + strlen(text), size - strlen(text), "%s", raised[n / 100 % 10]);
    if (n >= 10)
        snprintf(text + strlen(text), size - strlen(text), "%s", raised[n / 10 % 10]);
    snprintf(text + strlen(text), size - strlen(text), "%s", raised[n % 10]);
}

const char *dem_unit_for(const char *unit, double largest, double *factor, char *text)
{
    static const struct {
        const char *letter;
        double factor;
    } prefixes[] = {{"n", 1e-9}, {"µ", 1e-6}, {"m", 1e-3}, {"", 1}, {"k", 1e3}, {"M", 1e6}, {"G", 1e9}};
    static const char *const with_prefix[] = {"m", "m/s", "m/s2", "s", "N", "N m", "Pa", "J", "W", "Hz"};
    const char *base = unit ? unit : "";
    double own = 1;  // of the unit that takes the prefix, in SI units
    bool takes = strcmp(base, "kg") == 0;
    if (takes)
        base = "g", own = 1e-3;
    for (size_t i = 0; i < sizeof with_prefix / sizeof *with_prefix; i++)
        takes |= strcmp(base, with_prefix[i]) == 0;
    *factor = 1;
    snprintf(text, DEM_LABEL_TEXT, "%s", unit ? unit : "");
    if (!(largest > 0 && isfinite(largest)))
        return text;
    if (takes) {
        size_t best = 0, last = base[0] == 's' ? 3 : 6;
        for (size_t i = 1; i <= last; i++)
            best = largest >= 0.5 * own * prefixes[i].factor ? i : best;
        *factor = own * prefixes[best].factor;
        if (largest / *factor < 1e4 && largest / *factor >= 0.01) {
            snprintf(text, DEM_LABEL_TEXT, "%s%s", prefixes[best].letter, base);
            return text;
        }
    }
    *factor = 1;
    if (largest < 1e-2 || largest >= 1e5) {
        int power = (int)floor(log10(largest) + 1e-9);
        *factor = pow(10, power);
        put_power(power, text, DEM_LABEL_TEXT);
        snprintf(text + strlen(text), DEM_LABEL_TEXT - strlen(text), "%s%s", unit && *unit ? " " : "",
                 unit ? unit : "");
    }
    return text;
}

const char *dem_quantity_text(double value, const char *unit, double largest, char *text)
{
    char number[DEM_LABEL_TEXT], name[DEM_LABEL_TEXT];
    double factor;
    dem_unit_for(unit, largest, &factor, name);
    dem_format_double(number, sizeof number, value / factor, 4);
    snprintf(text, DEM_LABEL_TEXT, "%.40s%s%.50s", number, *name ? " " : "", name);
    return text;
}

// ---- the legend

typedef struct scale {
    double ticks[DEM_TICKS], step, factor;
    size_t count;
    char unit[DEM_LABEL_TEXT];
} scale;

static scale scale_of(const dem_legend *l, double height, double size)
{
    scale s;
    dem_unit_for(l->unit, fmax(fabs(l->low), fabs(l->high)), &s.factor, s.unit);
    double room = height / (3.2 * size);
    s.count =
        dem_ticks(l->low / s.factor, l->high / s.factor, (size_t)fmin(fmax(room, 2), 8), l->whole, s.ticks, &s.step);
    return s;
}

// one or two lines above the bar
static int title_lines(const dem_legend *l, const char *unit, double size, double room,
                       char lines[2][2 * DEM_LABEL_TEXT])
{
    if (!l->title && !*unit)
        return 0;
    snprintf(lines[0], sizeof lines[0], "%.90s%s%s%s%s", l->title ? l->title : "", l->title && *unit ? " " : "",
             *unit ? "[" : "", unit, *unit ? "]" : "");
    if (!l->title || !*unit || dem_text_width(lines[0], size) <= room)
        return 1;
    snprintf(lines[0], sizeof lines[0], "%.90s", l->title);
    snprintf(lines[1], sizeof lines[1], "[%s]", unit);
    return 2;
}

static double named_width(const dem_legend *l, double size)
{
    double width = l->title ? dem_text_width(l->title, size) : 0;
    for (size_t i = 0; i < l->count; i++)
        width = fmax(width, (BAR + GAP) * size + dem_text_width(l->names[i], size));
    return width;
}

double dem_legend_width(const dem_legend *l, double size)
{
    char unit[DEM_LABEL_TEXT];
    if (l->names)
        return named_width(l, size);
    snprintf(unit, sizeof unit, "[10⁻⁶ %.60s]", l->unit ? l->unit : "");  // as broad as any
    double width = (BAR + TICK + GAP) * size + dem_text_width("-0.0025", size);
    return fmax(width, fmax(dem_text_width(l->title ? l->title : "", size), dem_text_width(unit, size)));
}

static dem_rgb rgb_of(dem_colour c)
{
    return (dem_rgb){dem_colour_srgb(c.r), dem_colour_srgb(c.g), dem_colour_srgb(c.b)};
}

static dem_status draw_names(dem_image *image, const dem_legend *l, double left, double top, double height, double size,
                             dem_rgb ink, dem_error *error)
{
    dem_text_style style = {.size = size, .ink = ink};
    double y = top + size;
    if (l->title) {
        DEM_TRY(dem_text_draw(image, left, y, &style, l->title, error));
        y += LINE_HEIGHT * size;
    }
    for (size_t i = 0; i < l->count; i++, y += LINE_HEIGHT * size) {
        if (y + LINE_HEIGHT * size > top + height && i + 1 < l->count)
            return dem_text_draw(image, left + (BAR + GAP) * size, y, &style, "…", error);
        dem_fill_box(image, left, y - size * 1.1, left + BAR * size, y + size * 0.1, rgb_of(l->colours[i]));
        DEM_TRY(dem_text_draw(image, left + (BAR + GAP) * size, y, &style, l->names[i], error));
    }
    return DEM_OK;
}

// rows of a bar whose ends are pointed where it goes on
static void draw_bar(dem_image *image, const dem_legend *l, double left, double top, double bottom, double size)
{
    double tip = TIP * size, first = round(top - (l->above ? tip : 0)), last = round(bottom + (l->below ? tip : 0));
    for (double y = first; y < last; y++) {
        double part = (bottom - y - 0.5) / (bottom - top), off = fmax(top - y - 0.5, y + 0.5 - bottom);
        double narrow = off > 0 ? off / tip * BAR * size / 2 : 0;
        dem_fill_box(image, left + narrow, y, left + BAR * size - narrow, y + 1,
                     rgb_of(dem_palette_at(l->palette, part)));
    }
}

dem_status dem_legend_draw(dem_image *image, const dem_legend *l, double left, double top, double height, double size,
                           dem_rgb ink, dem_error *error)
{
    char lines[2][2 * DEM_LABEL_TEXT], text[DEM_LABEL_TEXT];
    if (l->names)
        return draw_names(image, l, left, top, height, size, ink, error);
    scale s = scale_of(l, height, size);
    dem_text_style style = {.size = size, .ink = ink};
    int count = title_lines(l, s.unit, size, dem_legend_width(l, size), lines);
    for (int k = 0; k < count; k++)
        DEM_TRY(dem_text_draw(image, left, top + (1 + LINE_HEIGHT * 0.85 * k) * size, &style, lines[k], error));
    double bar_top =
        round(top + (count ? 2.2 + LINE_HEIGHT * 0.85 * (count - 1) : 0.5) * size + (l->above ? TIP * size : 0));
    double bar_bottom = round(top + height - 0.5 * size - (l->below ? TIP * size : 0));
    if (bar_bottom - bar_top < 2 * size)
        return DEM_OK;
    left = round(left);
    draw_bar(image, l, left, bar_top, bar_bottom, size);
    double thick = fmax(1, round(0.09 * size)), right = left + round(BAR * size);
    for (size_t i = 0; i < s.count; i++) {
        double span = l->high - l->low, part = span > 0 ? (s.ticks[i] * s.factor - l->low) / span : 0.5;
        double y = bar_bottom - part * (bar_bottom - bar_top);
        double line = fmin(fmax(round(y - thick / 2), bar_top), bar_bottom - thick);
        dem_fill_box(image, right, line, right + TICK * size, line + thick, ink);
        DEM_TRY(dem_text_draw(image, right + (TICK + GAP) * size, line + thick / 2 + size / 2, &style,
                              dem_tick_text(s.ticks[i], s.step, text), error));
    }
    return DEM_OK;
}

// ---- the scale bar

dem_status dem_scale_bar_draw(dem_image *image, double left, double base, double room, double pixel, const char *unit,
                              double size, dem_rgb ink, dem_error *error)
{
    char text[DEM_LABEL_TEXT];
    double largest = room * pixel, thick = fmax(2, round(0.28 * size));
    if (!(largest > 0 && isfinite(largest)))
        return DEM_OK;
    double length = round_up(largest / 2.5);
    length = length > largest ? round_up(largest / 5.1) : length;
    left = round(left);
    dem_fill_box(image, left, base - size / 2 - thick / 2, left + length / pixel, base - size / 2 + thick / 2, ink);
    dem_text_style style = {.size = size, .ink = ink};
    return dem_text_draw(image, left + round(length / pixel) + 0.6 * size, base, &style,
                         dem_quantity_text(length, unit, length, text), error);
}
