#include "out/png.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>

#include "base/file.h"
#include "base/memory.h"

dem_status dem_image_create(int width, int height, dem_image *image, dem_error *error)
{
    *image = (dem_image){dem_alloc_zero((size_t)width * (size_t)height, 3), width, height};
    return image->pixels ? DEM_OK : dem_fail_memory(error);
}

void dem_image_free(dem_image *image)
{
    free(image->pixels);
    *image = (dem_image){0};
}

static void append(png_structp png, png_bytep bytes, size_t size)
{
    dem_buffer *out = png_get_io_ptr(png);
    dem_buffer_bytes(out, bytes, size);
    if (out->failed)
        png_error(png, "out of memory");
}

static void append_nothing(png_structp png)
{
    (void)png;
}

// libpng's default would print
static void give_up(png_structp png, png_const_charp text)
{
    (void)text;
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp text)
{
    (void)png, (void)text;
}

dem_status dem_png_encode(const dem_image *image, dem_buffer *out, dem_error *error)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, give_up, ignore);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return dem_fail_memory(error);
    }
    png_set_write_fn(png, out, append, append_nothing);
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (int y = 0; y < image->height; y++)
        png_write_row(png, image->pixels + (size_t)y * (size_t)image->width * 3);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return DEM_OK;
}

dem_status dem_png_write(dem_image *image, const char *path, dem_error *error)
{
    dem_buffer png = {0};
    dem_status status = dem_png_encode(image, &png, error);
    dem_image_free(image);
    if (status == DEM_OK)
        return dem_file_write_buffer(path, &png, error);
    dem_buffer_release(&png);
    return status;
}
