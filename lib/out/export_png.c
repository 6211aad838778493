#include <stdlib.h>

#include "out/export.h"
#include "out/picture.h"

static dem_status write_png(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                            dem_error *error)
{
    dem_clump_def def = dem_clump_view(clump);
    dem_ctx ctx = {.threads = options->threads};
    if (!options->mesh)
        return dem_picture_draw(&ctx, &def.surface, def.balls, def.ball_count, out, error);
    dem_export_options in_mesh_frame = {.frame = DEM_FRAME_MESH};
    dem_ball *balls = dem_export_balls(&in_mesh_frame, &def);
    dem_status status =
        balls ? dem_picture_draw(&ctx, options->mesh, balls, def.ball_count, out, error) : dem_fail_memory(error);
    free(balls);
    return status;
}

extern const dem_exporter dem_export_png;
const dem_exporter dem_export_png = {
    .name = "png",
    .suffix = "png",
    .about = "picture of the mesh and its clump side by side, same view and scale",
    .needs_mesh = true,
    .write = write_png,
};
