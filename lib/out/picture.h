/// The picture of a mesh and its clump, in memory.
#ifndef DEM_OUT_PICTURE_H
#define DEM_OUT_PICTURE_H

#include "dem/picture.h"
#include "out/render.h"

/// A grain to draw: its mesh, its clump, or both side by side. Everything is borrowed.
typedef struct dem_grain_picture {
    const dem_mesh *mesh;  ///< NULL or without triangles: none
    const dem_ball *balls;
    size_t count;
    const dem_camera *camera;      ///< NULL: the grain lies flat and is seen from above
    double field_deg;              ///< angle of view; 0: parallel rays
    double zoom;                   ///< of what fits [-]; 0: 1
    const dem_vec3 *look_at;       ///< NULL: its middle
    double pixel;                  ///< at least this breadth of a pixel, so that grains are drawn to one scale [m]
    int samples;                   ///< 0: as many as look smooth
    const dem_colour *background;  ///< NULL: white
} dem_grain_picture;

/// How it is seen; of a pair its left half, as if it were a picture of its own. Error: DEM_USAGE where there is nothing.
dem_status dem_grain_view(const dem_grain_picture *grain, int width, int height, dem_view *view, dem_error *error);
dem_status dem_grain_render(const dem_ctx *ctx, const dem_grain_picture *grain, int width, int height, dem_image *image,
                            dem_view *view, dem_error *error);

/// Draws the mesh in the left half and the clump in the right one; a mesh without triangles: the clump alone.
/// `view` (may be NULL) receives that of the left half, as if it were a picture of its own.
dem_status dem_picture_render(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count, int width,
                              int height, dem_image *image, dem_view *view, dem_error *error);

/// Draws one of the two, at the scale and from the side that hold both: pictures of clumps that lie beside that of their
/// grain.
typedef enum dem_picture_part { DEM_PICTURE_GRAIN, DEM_PICTURE_BALLS } dem_picture_part;
dem_status dem_picture_render_part(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count,
                                   dem_picture_part part, int width, int height, dem_image *image, dem_error *error);

/// Appends the PNG file of dem_picture_clump.
dem_status dem_picture_draw(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count,
                            dem_buffer *out, dem_error *error);

#endif
