/// The scale of an axis: its range, where values fall on it, its ticks.
#ifndef DEM_OUT_SCALE_H
#define DEM_OUT_SCALE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct dem_scale {
    bool log;
    double low, high;
} dem_scale;

typedef struct dem_tick {
    double value;
    char label[24];  ///< empty: a small one without
} dem_tick;
enum { DEM_MOST_TICKS = 256 };

/// Can it stand on such an axis? Finite and, on a logarithmic one, positive.
bool dem_scale_takes(bool log, double value);

/// A range that holds all values that can stand on the axis, with a little room; 1..10 or 0..1 without any.
dem_scale dem_scale_fit(bool log, const double *values, size_t count);

/// 0 at the low end, 1 at the high one.
double dem_scale_map(const dem_scale *scale, double value);

/// Ticks within the range, ascending; at least two have labels. On a logarithmic scale the labels are decades, or
/// 1, 2, 5 or more of each where decades are too few.
size_t dem_scale_ticks(const dem_scale *scale, dem_tick ticks[DEM_MOST_TICKS]);

/// 0.001, 50, 10⁻⁵; `text` has room for a label.
void dem_tick_label(double value, char *text, size_t size);

#endif
