/// Text drawn into images by the stroke font of out/glyphs.h: crisp at any size, because stems and bars lie on whole
/// pixels. UTF-8; superscript digits are known.
#ifndef DEM_OUT_TEXT_DRAW_H
#define DEM_OUT_TEXT_DRAW_H

#include "out/png.h"

/// Plain sRGB, as in the pixels of an image.
typedef struct dem_rgb {
    uint8_t r, g, b;
} dem_rgb;

/// Where text stands about the point it is drawn at.
typedef enum dem_align { DEM_ALIGN_LEFT, DEM_ALIGN_CENTRE, DEM_ALIGN_RIGHT } dem_align;

typedef struct dem_text_style {
    double size;  ///< height of a capital letter [pixels]
    dem_rgb ink;
    double halo;  ///< breadth of a rim about the strokes, so that it can be read on anything [pixels]; 0: none
    dem_rgb rim;
    dem_align align;
} dem_text_style;

/// Breadth of a text [pixels].
double dem_text_width(const char *text, double size);

/// Draws a line of text; `y` is the line of writing [pixels from the upper left corner]. What lies outside of the image
/// is left out. Error: DEM_NO_MEMORY.
dem_status dem_text_draw(dem_image *image, double x, double y, const dem_text_style *style, const char *text,
                         dem_error *error);

/// The text, shortened with an ellipsis in its middle where it is broader than `width` [pixels]; into `room`.
const char *dem_text_fit(const char *text, double size, double width, char *room, size_t room_size);

/// Fills a rectangle, its sides rounded to whole pixels.
void dem_fill_box(dem_image *image, double left, double top, double right, double bottom, dem_rgb ink);

#endif
