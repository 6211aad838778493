/// A square grid of lines along one axis and where each of them runs inside the grain.
#ifndef DEM_CLUMP_PACK_COLUMNS_H
#define DEM_CLUMP_PACK_COLUMNS_H

#include "clump/pack_grain.h"

/// Line (i, j) stands at coordinate origin[0] + i step on axis (axis + 1) % 3 and origin[1] + j step on axis
/// (axis + 2) % 3. Only lines near the grain's shadow are kept: of row j those from first[j] on.
typedef struct dem_columns {
    int axis;
    double step, origin[2];
    int32_t row_count;
    int32_t *first;     ///< [row_count] column of a row's first line
    uint32_t *line;     ///< [row_count + 1] index of a row's first line
    uint32_t *start;    ///< [lines + 1] index of a line's first crossing
    float *crossing;    ///< ascending coordinates, in and out in turn
} dem_columns;

/// `margin`: how far around the shadow lines are kept; `offset`: place of the grid in steps, 0..1 on either axis.
dem_status dem_columns_build(const dem_pack_grain *grain, int axis, double step, double margin, const double offset[2],
                             dem_columns *columns, dem_error *error);
void dem_columns_release(dem_columns *columns);

static inline size_t columns_lines(const dem_columns *columns)
{
    return columns->line[columns->row_count];
}

#endif
