// Every stroke is a chain of short lines; a pixel is covered by how near its centre is to one of them. First the
// distances of all pixels of the text are found, then rim and ink are blended over the image at once.
#include "out/text_draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "out/glyphs.h"

enum { ARC_LINES = 8 };

static const double STROKE = 1.62;  // breadth of a stroke [units]
static const double BEARING = 1.7;  // free on either side of a character [units]
static const double RAISED = 7.5;   // superscripts [units]
static const double SUPER = 0.62;   // their size
static const double THIN = 4;       // strokes below this breadth are whole or half pixels broad

typedef struct point {
    double x, y;
} point;

typedef struct pen {
    double scale, left, base;  // pixels per unit; where the units' origin is [pixels]
    double half;               // half the breadth of a stroke [pixels]
    float *distance;           // of all pixels from the strokes
    int width, height;         // [pixels]
    double reach;              // distances beyond it do not matter [pixels]
} pen;

// a character as it is drawn: superscripts are smaller digits, set higher
typedef struct letter {
    const dem_glyph *glyph;
    double size, raise;
} letter;

static letter letter_of(uint32_t code)
{
    static const uint32_t raised[] = {0x2070, 0xB9, 0xB2, 0xB3, 0x2074, 0x2075, 0x2076, 0x2077, 0x2078, 0x2079};
    for (uint32_t k = 0; k < sizeof raised / sizeof *raised; k++)
        if (raised[k] == code)
            return (letter){dem_glyph_of('0' + k), SUPER, RAISED};
    if (code == 0x207B)
        return (letter){dem_glyph_of('-'), SUPER, RAISED};
    return (letter){dem_glyph_of(code), 1, 0};
}

static double stroke_of(double size)
{
    double breadth = fmax(1, STROKE * size / DEM_GLYPH_CAPITAL);
    return breadth < THIN ? round(2 * breadth) / 2 : breadth;
}

static double advance_of(const letter *l, double scale)
{
    return round((l->size * (double)l->glyph->width + BEARING * (1 + l->size)) * scale);
}

double dem_text_width(const char *text, double size)
{
    double width = 0;
    uint32_t code;
    while ((code = dem_utf8_next(&text))) {
        letter l = letter_of(code);
        width += advance_of(&l, size / DEM_GLYPH_CAPITAL);
    }
    return width;
}

// ---- strokes

static void draw_line(const pen *p, point a, point b)
{
    double reach = p->reach + 1, u = b.x - a.x, v = b.y - a.y, length = u * u + v * v;
    int x0 = (int)fmax(fmin(a.x, b.x) - reach, 0), x1 = (int)fmin(fmax(a.x, b.x) + reach, p->width - 1);
    int y0 = (int)fmax(fmin(a.y, b.y) - reach, 0), y1 = (int)fmin(fmax(a.y, b.y) + reach, p->height - 1);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            double s = x + 0.5 - a.x, t = y + 0.5 - a.y, along = length > 0 ? (s * u + t * v) / length : 0;
            along = along < 0 ? 0 : along > 1 ? 1 : along;
            float d = (float)hypot(s - along * u, t - along * v), *all = &p->distance[y * p->width + x];
            *all = d < *all ? d : *all;
        }
}

// the left and lower edges of strokes that lie along the grid fall between pixels; a capital is as high as the size
// says, from edge to edge
static double on_grid(const pen *p, double units)
{
    return round(units * p->scale) + p->half;
}

static point to_pixels(const pen *p, const letter *l, point units)
{
    return (point){p->left + on_grid(p, units.x * l->size), p->base - on_grid(p, units.y * l->size + l->raise)};
}

static void draw_arc(const pen *p, point a, point corner, point b)
{
    point last = a;
    for (int k = 1; k <= ARC_LINES; k++) {
        double angle = k * 1.5707963267948966 / ARC_LINES, s = 1 - sin(angle), c = 1 - cos(angle);
        point next = {corner.x + (a.x - corner.x) * s + (b.x - corner.x) * c,
                      corner.y + (a.y - corner.y) * s + (b.y - corner.y) * c};
        draw_line(p, last, next);
        last = next;
    }
}

static const char *read_point(const char *at, point *units)
{
    const char *end = at + strlen(at);
    at = dem_parse_double(at, end, &units->x);
    return at ? dem_parse_double(at + 1, end, &units->y) : NULL;
}

static void draw_glyph(const pen *p, const letter *l)
{
    const char *at = l->glyph->path;
    point last = {0, 0}, corner = {0, 0}, units;
    bool begun = false, round_off = false;
    while (at && *at) {
        if (*at == '/')
            begun = false;
        if (*at == '(')
            round_off = true;
        if (*at == ' ' || *at == '/' || *at == ')' || *at == '(') {
            at++;
            continue;
        }
        at = read_point(at, &units);
        point here = to_pixels(p, l, units);
        if (at && *at == ')') {
            corner = here;
            continue;
        }
        if (begun && round_off)
            draw_arc(p, last, corner, here);
        else if (begun)
            draw_line(p, last, here);
        last = here;
        begun = true;
        round_off = false;
    }
}

// ---- text

static uint8_t mixed(uint8_t under, uint8_t over, double part)
{
    return (uint8_t)(under + part * (over - under) + 0.5);
}

static void blend(uint8_t *pixel, dem_rgb ink, double part)
{
    part = part < 0 ? 0 : part > 1 ? 1 : part;
    pixel[0] = mixed(pixel[0], ink.r, part);
    pixel[1] = mixed(pixel[1], ink.g, part);
    pixel[2] = mixed(pixel[2], ink.b, part);
}

static void ink_pixels(const pen *p, dem_image *image, int left, int top, const dem_text_style *style)
{
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            int i = left + x, j = top + y;
            double d = (double)p->distance[y * p->width + x];
            if (!(d < p->reach + 1) || i < 0 || j < 0 || i >= image->width || j >= image->height)
                continue;
            uint8_t *pixel = image->pixels + 3 * ((size_t)j * (size_t)image->width + (size_t)i);
            if (style->halo > 0)
                blend(pixel, style->rim, p->half + style->halo - d + 0.5);
            blend(pixel, style->ink, p->half - d + 0.5);
        }
}

dem_status dem_text_draw(dem_image *image, double x, double y, const dem_text_style *style, const char *text,
                         dem_error *error)
{
    double width = dem_text_width(text, style->size), scale = style->size / DEM_GLYPH_CAPITAL;
    x -= style->align == DEM_ALIGN_RIGHT ? width : style->align == DEM_ALIGN_CENTRE ? width / 2 : 0;
    pen p = {.half = stroke_of(style->size) / 2};
    p.scale = (style->size - 2 * p.half) / DEM_GLYPH_CAPITAL;
    p.reach = p.half + style->halo;
    double rim = ceil(p.reach + 1), ascent = ceil(DEM_GLYPH_ASCENT * scale), descent = ceil(DEM_GLYPH_DESCENT * scale);
    double left = round(x) - rim, top = round(y) - ascent - rim;
    if (!(fabs(left) < 1e6 && fabs(top) < 1e6 && width < 1e6 && ascent < 1e5) || width <= 0)
        return DEM_OK;
    p.width = (int)(width + 2 * rim);
    p.height = (int)(ascent + descent + 2 * rim);
    p.base = ascent + rim;
    p.distance = dem_alloc((size_t)p.width * (size_t)p.height, sizeof *p.distance);
    if (!p.distance)
        return dem_fail_memory(error);
    for (size_t i = 0; i < (size_t)p.width * (size_t)p.height; i++)
        p.distance[i] = INFINITY;
    double at = rim;
    uint32_t code;
    while ((code = dem_utf8_next(&text))) {
        letter l = letter_of(code);
        p.left = at + round(BEARING * l.size * scale - p.half);
        draw_glyph(&p, &l);
        at += advance_of(&l, scale);
    }
    ink_pixels(&p, image, (int)left, (int)top, style);
    free(p.distance);
    return DEM_OK;
}

const char *dem_text_fit(const char *text, double size, double width, char *room, size_t room_size)
{
    static const char DOTS[] = "\xE2\x80\xA6";
    size_t length = strlen(text);
    if (dem_text_width(text, size) <= width || room_size < sizeof DOTS)
        return text;
    // the longest beginning and end of equal length that leave room for the dots
    for (size_t keep = length - 1; keep > 0; keep--) {
        size_t head = (keep + 1) / 2, tail = keep / 2;
        while (head > 0 && ((unsigned char)text[head] & 0xC0) == 0x80)  // not within a character
            head--;
        while (tail > 0 && ((unsigned char)text[length - tail] & 0xC0) == 0x80)
            tail--;
        if (head + tail + sizeof DOTS > room_size)
            continue;
        memcpy(room, text, head);
        memcpy(room + head, DOTS, sizeof DOTS - 1);
        memcpy(room + head + sizeof DOTS - 1, text + length - tail, tail + 1);
        if (dem_text_width(room, size) <= width)
            return room;
    }
    return DOTS;
}

void dem_fill_box(dem_image *image, double left, double top, double right, double bottom, dem_rgb ink)
{
    int x0 = (int)fmax(round(left), 0), x1 = (int)fmin(round(right), image->width);
    int y0 = (int)fmax(round(top), 0), y1 = (int)fmin(round(bottom), image->height);
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            memcpy(image->pixels + 3 * ((size_t)y * (size_t)image->width + (size_t)x), (uint8_t[]){ink.r, ink.g, ink.b},
                   3);
}
