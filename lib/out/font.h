/// A small font for captions in pictures, 5 by 7 pixels, drawn for this program.
#ifndef DEM_OUT_FONT_H
#define DEM_OUT_FONT_H

#include <string.h>

#include "out/png.h"

enum { DEM_FONT_WIDTH = 6, DEM_FONT_HEIGHT = 9 };  // with the gaps between signs and lines

/// Draws a line of text whose upper left corner is (x, y); what does not fit is cut off. What is not ASCII or not in
/// the font is a small frame.
void dem_font_draw(dem_image *image, int x, int y, const char *text, const uint8_t colour[3]);

#endif
