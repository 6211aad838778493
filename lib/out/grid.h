/// A sheet of pictures with names under them, in rows.
#ifndef DEM_OUT_GRID_H
#define DEM_OUT_GRID_H

#include "out/text_draw.h"

typedef struct dem_grid {
    size_t count, columns, rows;
    int width, height;            ///< of the sheet [pixels]
    int cell_width, cell_height;  ///< of a picture, without its name [pixels]; the last row may be short
    int name_height;              ///< under each picture [pixels]; 0: no names
    double text_size;             ///< of the names: height of a capital letter [pixels]
} dem_grid;

/// Divides width x height among `count` pictures that are best seen `aspect` times as broad as high. `columns` 0: as
/// many as make them largest. `text_size` 0: as the pictures need.
dem_grid dem_grid_divide(size_t count, int width, int height, size_t columns, double aspect, bool names,
                           double text_size);

/// Where the picture of a cell begins [pixels].
void dem_grid_cell(const dem_grid *grid, size_t cell, int *left, int *top);

/// Copies an image into another one; what does not fit is left out.
void dem_image_paste(dem_image *image, const dem_image *part, int left, int top);
void dem_image_fill(dem_image *image, dem_rgb colour);

/// Writes the name of a cell, shortened where it must be.
dem_status dem_grid_name(const dem_grid *grid, dem_image *image, size_t cell, const char *name, dem_rgb ink,
                          dem_error *error);

#endif
