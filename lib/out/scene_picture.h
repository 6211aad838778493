/// The picture of many bodies, in memory.
#ifndef DEM_OUT_SCENE_PICTURE_H
#define DEM_OUT_SCENE_PICTURE_H

#include "dem/picture.h"
#include "out/render.h"

/// Draws what dem_picture_bodies writes; `view` (may be NULL) receives how.
dem_status dem_scene_picture_render(const dem_ctx *ctx, const dem_body_view *bodies, const dem_clump *const *shapes,
                                    size_t shape_count, const dem_picture_options *options, dem_image *image,
                                    dem_view *view, dem_error *error);

#endif
