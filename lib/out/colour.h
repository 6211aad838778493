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

/// From dark blue over green to light yellow, evenly in what the eye sees, also without colour; `part` is held within
/// 0..1. Grey where it is not a number.
dem_colour dem_colour_ramp(double part);

#endif
