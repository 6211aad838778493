/// The picture of many bodies, in memory.
#ifndef DEM_OUT_SCENE_PICTURE_H
#define DEM_OUT_SCENE_PICTURE_H

#include "dem/picture.h"
#include "out/render.h"
#include "out/text_draw.h"

/// What the pictures of a sequence have in common: the place of the camera, the range of the colours, where walls
/// without an end are cut, the unit of the time. Zero-initialise, then measure each state.
typedef struct dem_picture_span {
    bool begun;
    dem_fit fit;
    dem_box bodies;    ///< holds them all [m]
    double low, high;  ///< of the values shown; low > high: there are none
    double end;        ///< latest time [s]; NAN: none
} dem_picture_span;

dem_status dem_scene_picture_measure(const dem_body_view *bodies, const dem_clump *const *shapes, size_t shape_count,
                                     const dem_picture_options *options, dem_picture_span *span, dem_error *error);

/// Draws what dem_picture_bodies writes. `span`: of the sequence; NULL: this picture stands alone. `view` (may be NULL)
/// receives how the bodies are seen: in the part of the picture that begins in its upper left corner.
dem_status dem_scene_picture_render(const dem_ctx *ctx, const dem_body_view *bodies, const dem_clump *const *shapes,
                                    size_t shape_count, const dem_picture_options *options,
                                    const dem_picture_span *span, dem_image *image, dem_view *view, dem_error *error);

/// The values with the colours of the ends, and the map, of a sequence.
dem_picture_map dem_picture_range(const dem_picture_options *options, const dem_picture_span *span, double *low,
                                  double *high);

/// Black or white, whichever is seen on a background.
dem_rgb dem_ink_on(const uint8_t background[3]);

/// The height of capital letters that suits a picture [pixels].
double dem_label_size(int width, int height);

#endif
