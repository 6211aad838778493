/// A stroke font: digits, letters and signs as lines and quarter ellipses, for labels in pictures.
///
/// Capitals are 14 units high, small letters 10, the lowest strokes reach 4 below the line of writing. A path is points
/// "x,y" joined by lines; a point in brackets is the corner that the ellipse from the point before it to the point
/// behind it rounds off; '/' begins another stroke.
#ifndef DEM_OUT_GLYPHS_H
#define DEM_OUT_GLYPHS_H

#include <stdint.h>

enum { DEM_GLYPH_CAPITAL = 14, DEM_GLYPH_SMALL = 10, DEM_GLYPH_DESCENT = 4, DEM_GLYPH_ASCENT = 16 };

typedef struct dem_glyph {
    uint32_t code;  ///< Unicode
    float width;    ///< from the middle of the leftmost stroke to that of the rightmost one [units]
    const char *path;
} dem_glyph;

/// That of a character; an empty box where there is none.
const dem_glyph *dem_glyph_of(uint32_t code);

/// Reads one character of UTF-8 and steps over it; 0 at the end, 0xFFFD for what is not UTF-8.
uint32_t dem_utf8_next(const char **text);

#endif
