/// Colour maps: the colours of a range of values, in steps that look equal.
#ifndef DEM_OUT_PALETTE_H
#define DEM_OUT_PALETTE_H

#include "dem/picture.h"
#include "out/colour.h"

enum { DEM_PALETTE_STEPS = 256 };

/// A map made ready: dem_palette_make, then dem_palette_at.
typedef struct dem_palette {
    dem_colour at[DEM_PALETTE_STEPS + 1];
} dem_palette;

/// DEM_PICTURE_MAP_AUTO is the first of the others.
void dem_palette_make(dem_picture_map map, dem_palette *palette);

/// The colour of a part of the range, held within 0..1; grey where it is not a number.
dem_colour dem_palette_at(const dem_palette *palette, double part);

#endif
