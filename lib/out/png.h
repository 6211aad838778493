/// PNG images.
#ifndef DEM_OUT_PNG_H
#define DEM_OUT_PNG_H

#include "base/text.h"

/// 8-bit sRGB pixels, row by row from the top, three bytes each.
typedef struct dem_image {
    uint8_t *pixels;
    int width, height;
} dem_image;

dem_status dem_image_create(int width, int height, dem_image *image, dem_error *error);
void dem_image_free(dem_image *image);

/// Appends the image as a PNG file.
dem_status dem_png_encode(const dem_image *image, dem_buffer *out, dem_error *error);
/// Writes it as a file ("-" is standard output) and frees it either way.
dem_status dem_png_write(dem_image *image, const char *path, dem_error *error);

#endif
