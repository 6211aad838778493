#include "out/colour.h"

#include <math.h>

#include "base/random.h"
#include "math/vec.h"

static float held(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : (float)x;
}

dem_colour dem_colour_lch(double lightness, double chroma, double hue)
{
    double a = chroma * cos(2 * DEM_PI * hue), b = chroma * sin(2 * DEM_PI * hue);
    double l = pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
    double m = pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
    double s = pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
    return (dem_colour){held(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
                        held(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
                        held(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

dem_colour dem_colour_of_number(uint64_t number)
{
    // lightness, chroma, hue in turns: brick, sand, straw, olive, slate, chalk
    static const double family[][3] = {{0.62, 0.075, 0.12}, {0.74, 0.065, 0.20}, {0.82, 0.060, 0.25},
                                       {0.66, 0.045, 0.31}, {0.60, 0.032, 0.68}, {0.87, 0.016, 0.22}};
    enum { MEMBERS = sizeof family / sizeof *family };
    dem_random r = random_stream(number, 7);
    const double *one = family[random_below(&r, MEMBERS)];
    double lightness = one[0] + 0.08 * (random_uniform(&r) - 0.5), hue = one[2] + 0.03 * (random_uniform(&r) - 0.5);
    return dem_colour_lch(lightness, one[1], hue);
}

uint8_t dem_colour_srgb(float linear)
{
    float x = linear < 0 ? 0 : linear > 1 ? 1 : linear;
    x = x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1 / 2.4f) - 0.055f;
    return (uint8_t)(255 * x + 0.5f);
}

dem_colour dem_colour_of_srgb(uint8_t r, uint8_t g, uint8_t b)
{
    const uint8_t bytes[3] = {r, g, b};
    float light[3];
    for (int k = 0; k < 3; k++) {
        float x = (float)bytes[k] / 255;
        light[k] = x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
    }
    return (dem_colour){light[0], light[1], light[2]};
}
