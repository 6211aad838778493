/// What is written beside a picture: a colour bar or the colours of names, a scale bar.
#ifndef DEM_OUT_LEGEND_H
#define DEM_OUT_LEGEND_H

#include "out/palette.h"
#include "out/text_draw.h"

enum { DEM_TICKS = 24, DEM_LABEL_TEXT = 96 };

/// Round numbers within low .. high, at most `most` (2 to DEM_TICKS), ascending: multiples of `*step`, which is 1, 2 or
/// 5 times a power of ten; of 1 or more where numbers are `whole`. One where low is high. Returns how many.
size_t dem_ticks(double low, double high, size_t most, bool whole, double ticks[DEM_TICKS], double *step);

/// A multiple of a step as text with as many decimals as the step has; into `text` [DEM_LABEL_TEXT].
const char *dem_tick_text(double tick, double step, char *text);

/// How numbers up to `largest` in an SI unit ("m", "kg", "rad/s", NULL: none) are best written: as multiples of
/// *factor, in the unit *text [DEM_LABEL_TEXT], as in "mm" or "10⁻⁶ rad/s"; "" for none.
const char *dem_unit_for(const char *unit, double largest, double *factor, char *text);

/// "2.5 mm" for a number in an SI unit; `largest` chooses the unit.
const char *dem_quantity_text(double value, const char *unit, double largest, char *text);

/// A colour bar or, with `names`, a column of named colours.
typedef struct dem_legend {
    const char *title;  ///< NULL: none
    const char *unit;   ///< SI; NULL: none
    bool whole;
    double low, high;
    bool below, above;  ///< there are values beyond the ends
    const dem_palette *palette;
    const char *const *names;
    const dem_colour *colours;
    size_t count;
} dem_legend;

/// Free about what is written, and height of a line of it at the foot of a picture, for letters of a size [pixels].
double dem_label_margin(double size);
double dem_foot_height(double size);

/// Breadth it needs for letters of a size [pixels]; does not depend on the range, so that a sequence of pictures can be
/// laid out before its range is known.
double dem_legend_width(const dem_legend *legend, double size);

/// Draws it from (left, top) on, `height` high [pixels].
dem_status dem_legend_draw(dem_image *image, const dem_legend *legend, double left, double top, double height,
                           double size, dem_rgb ink, dem_error *error);

/// Draws a bar that stands for a round length, at most `room` long, from its lower left corner on, with its length
/// written beside it. `pixel`: length of a pixel [m], in `unit` "m", or in units of their own where that is "".
dem_status dem_scale_bar_draw(dem_image *image, double left, double base, double room, double pixel, const char *unit,
                              double size, dem_rgb ink, dem_error *error);

#endif
