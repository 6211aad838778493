#include "out/export_text.h"

// comments are one line each, whatever the name
static void put_title(dem_buffer *out, const dem_clump_def *clump)
{
    dem_buffer_text(out, "# ");
    for (const char *p = clump->name; *p; p++)
        dem_buffer_bytes(out, (unsigned char)*p < ' ' ? " " : p, 1);
    dem_buffer_print(out, "%s%zu spheres of dem-clump " DEM_VERSION "\n", *clump->name ? ": " : "", clump->ball_count);
}

static void put_head(dem_buffer *out, const dem_clump_def *clump, const dem_export_options *options)
{
    bool mesh_frame = options->frame == DEM_FRAME_MESH;
    dem_vec3 centre = export_ball(options, clump, (dem_ball){{0, 0, 0}, 0}).centre;
    put_title(out, clump);
    dem_buffer_print(out, "# frame: %s\n",
                     mesh_frame ? "mesh, that of the file it was made from, in metres"
                                : "principal, centre of mass at 0, axes I1 <= I2 <= I3");
    dem_buffer_text(out, "# unit of x y z r: m\n");
    dem_export_put_mass(out, "# ", clump, centre);
    dem_buffer_text(out, "# x y z r\n");
}

static dem_status write_xyzr(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                             dem_error *error)
{
    dem_clump_def def = dem_clump_view(clump);
    put_head(out, &def, options);
    for (size_t i = 0; i < def.ball_count; i++)
        dem_export_put_ball(out, export_ball(options, &def, def.balls[i]), " ");
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_xyzr;
const dem_exporter dem_export_xyzr = {
    .name = "xyzr",
    .suffix = "xyzr",
    .about = "text, one sphere x y z r a line; comments (#) tell unit, frame, mass and inertia",
    .write = write_xyzr,
};
