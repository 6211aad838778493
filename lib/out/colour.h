/// Colours for pictures, in linear light.
#ifndef DEM_OUT_COLOUR_H
#define DEM_OUT_COLOUR_H

#include "dem/base.h"

/// Linear light reflected, 0..1 [-]
typedef struct dem_colour {
    float r, g, b;
} dem_colour;

/// OKLCh (Ottosson 2020) to linear light; `hue` in turns. Held within 0..1.
dem_colour dem_colour_lch(double lightness, double chroma, double hue);

/// One of a family of earthy colours, always the same for a number.
dem_colour dem_colour_of_number(uint64_t number);

/// Linear light as an sRGB byte, and back.
uint8_t dem_colour_srgb(float linear);
dem_colour dem_colour_of_srgb(uint8_t r, uint8_t g, uint8_t b);

#endif
