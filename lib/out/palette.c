// A map is a smooth curve through a few colours of OKLab, walked at a constant pace: equal steps of the value are equal
// steps of what the eye sees. All but the diverging one grow lighter all the way, so they survive without colour too;
// none begins so dark that the shading of a body is lost in it.
#include "out/palette.h"

#include <math.h>

#include "math/vec.h"

enum { KNOTS = 5, PIECES = 64, WAY = PIECES * (KNOTS - 1) };

// lightness, chroma, hue in turns
static const double knots[][KNOTS][3] = {
    [DEM_PICTURE_MAP_RAMP] = {{.36, .135, .79}, {.50, .115, .69}, {.64, .105, .52}, {.78, .15, .39}, {.92, .16, .295}},
    [DEM_PICTURE_MAP_DIVERGING] = {{.46, .14, .715}, {.68, .11, .69}, {.93, 0, 0}, {.68, .13, .08}, {.46, .16, .065}},
    [DEM_PICTURE_MAP_WARM] = {{.34, .10, .83}, {.47, .15, .96}, {.60, .165, .07}, {.76, .14, .17}, {.93, .10, .27}},
    [DEM_PICTURE_MAP_GREY] = {{.36, 0, 0}, {.5, 0, 0}, {.64, 0, 0}, {.78, 0, 0}, {.93, 0, 0}},
};

typedef struct lab {
    double l, a, b;
} lab;

static lab knot(dem_picture_map map, int k)
{
    const double *c = knots[map][k];
    return (lab){c[0], c[1] * cos(2 * DEM_PI * c[2]), c[1] * sin(2 * DEM_PI * c[2])};
}

// one component between two knots, with slopes at both (Hermite)
static double between(double from, double to, double slope_from, double slope_to, double t)
{
    double rise = to - from;
    return from +
           t * (slope_from + t * (3 * rise - 2 * slope_from - slope_to + t * (slope_from + slope_to - 2 * rise)));
}

// a point of the curve, `at` from 0 to KNOTS - 1: slopes as of the chords beside a knot (Catmull & Rom), but none
// across the turning point of the diverging map
static lab curve(dem_picture_map map, double at)
{
    int i = at < KNOTS - 1 ? (int)at : KNOTS - 2;
    lab p[4];
    for (int k = 0; k < 4; k++) {
        int n = i - 1 + k, low = 0, high = KNOTS - 1;
        if (map == DEM_PICTURE_MAP_DIVERGING)
            low = i < KNOTS / 2 ? 0 : KNOTS / 2, high = i < KNOTS / 2 ? KNOTS / 2 : KNOTS - 1;
        p[k] = knot(map, n < low ? low : n > high ? high : n);
    }
    double t = at - i;
    return (lab){between(p[1].l, p[2].l, (p[2].l - p[0].l) / 2, (p[3].l - p[1].l) / 2, t),
                 between(p[1].a, p[2].a, (p[2].a - p[0].a) / 2, (p[3].a - p[1].a) / 2, t),
                 between(p[1].b, p[2].b, (p[2].b - p[0].b) / 2, (p[3].b - p[1].b) / 2, t)};
}

// the curve in steps of equal length
static void walk(dem_picture_map map, double from, double to, dem_colour *colours, int steps)
{
    double lengths[WAY + 1] = {0};
    lab last = curve(map, from);
    for (int k = 1; k <= WAY; k++) {
        lab here = curve(map, from + (to - from) * k / WAY);
        lengths[k] = lengths[k - 1] + hypot(hypot(here.l - last.l, here.a - last.a), here.b - last.b);
        last = here;
    }
    for (int i = 0, k = 1; i <= steps; i++) {
        double want = lengths[WAY] * i / steps;
        while (k < WAY && lengths[k] < want)
            k++;
        double part = (k - 1 + (want - lengths[k - 1]) / (lengths[k] - lengths[k - 1])) / WAY;
        lab c = curve(map, from + (to - from) * part);
        colours[i] = dem_colour_lch(c.l, hypot(c.a, c.b), atan2(c.b, c.a) / (2 * DEM_PI));
    }
}

void dem_palette_make(dem_picture_map map, dem_palette *palette)
{
    enum { HALF = DEM_PALETTE_STEPS / 2 };
    if (map == DEM_PICTURE_MAP_AUTO)
        map = DEM_PICTURE_MAP_RAMP;
    if (map == DEM_PICTURE_MAP_DIVERGING) {  // the middle stays the middle
        walk(map, 0, KNOTS / 2, palette->at, HALF);
        walk(map, KNOTS / 2, KNOTS - 1, palette->at + HALF, DEM_PALETTE_STEPS - HALF);
    } else {
        walk(map, 0, KNOTS - 1, palette->at, DEM_PALETTE_STEPS);
    }
}

dem_colour dem_palette_at(const dem_palette *palette, double part)
{
    if (isnan(part))
        return dem_colour_lch(0.6, 0, 0);
    double at = DEM_PALETTE_STEPS * (part < 0 ? 0 : part > 1 ? 1 : part);
    int i = at < DEM_PALETTE_STEPS ? (int)at : DEM_PALETTE_STEPS - 1;
    float t = (float)(at - i);
    const dem_colour *a = &palette->at[i], *b = a + 1;
    return (dem_colour){a->r + t * (b->r - a->r), a->g + t * (b->g - a->g), a->b + t * (b->b - a->b)};
}
