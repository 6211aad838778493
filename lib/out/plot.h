/// Plots of lines and points as SVG: linear or logarithmic axes, error bars, small multiples on a sheet.
#ifndef DEM_OUT_PLOT_H
#define DEM_OUT_PLOT_H

#include "base/text.h"

/// One line of points; those that cannot stand on the axes (not finite, not positive on a logarithmic one) are left
/// out. Colour and mark follow the number of the series in its plot.
typedef struct dem_plot_series {
    const char *name;
    const double *x, *y;
    const double *error;  ///< half lengths of the bars along y; NULL: none
    size_t count;
    bool points_only;  ///< no line through them
} dem_plot_series;

typedef struct dem_plot_axis {
    const char *title;  ///< with its unit: "IoU gap [%]"; that of y stands as a heading over the plot
    bool log;
    double floor;  ///< of a logarithmic y: what is smaller stands hollow on the axis, also 0; 0: none
} dem_plot_axis;

typedef struct dem_plot {
    dem_plot_axis x, y;
    const dem_plot_series *series;
    size_t series_count;
} dem_plot;

/// What a sheet is made of. Everything is borrowed.
typedef struct dem_plot_sheet {
    const char *title, *note;  ///< above and below; NULL: none
    const dem_plot *plots;     ///< all of the same series
    size_t count, columns;
    bool fragment;  ///< for inside of a page: without the head of a file
} dem_plot_sheet;

/// Appends one plot as an SVG group with its upper left corner at (x, y).
void dem_plot_draw(dem_buffer *out, const dem_plot *plot, double x, double y, double width, double height);

/// Appends an SVG picture: all plots side by side, one legend for all.
void dem_plot_sheet_draw(dem_buffer *out, const dem_plot_sheet *sheet);

#endif
