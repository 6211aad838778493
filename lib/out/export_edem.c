// EDEM has no import of spheres from a file: its table of spheres takes rows from the clipboard.
#include "out/export_text.h"

static const char MARK[] = "# ";

static dem_status write_edem(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                             dem_error *error)
{
    static const char *const use[] = {
        "untested: written after its help pages. EDEM calculates mass and inertia from the spheres by itself, with the",
        "error of its sampling; so set the particle's properties by hand instead: mass, volume and moments of inertia",
        "below. The centre must stay at the origin and the axes as they are (Add Multi-Sphere Particles in its help).",
        "use: set the project's length unit to m, add as many spheres to the particle as there are rows below,",
        "copy the rows without the comments and paste them into its table of spheres.",
        "columns: radius, x, y, z, contact radius (equal to the radius; leave the column out where it is not shown)",
        NULL};
    dem_clump_def def = dem_clump_view(clump);
    double volume = def.mass / def.density;
    dem_export_put_head(out, &(dem_export_head){MARK, "EDEM table of spheres", use, "edem.txt"}, &def, options);
    dem_export_put_figures(out, MARK, "volume [m^3]", &volume, 1);
    for (size_t i = 0; i < def.ball_count; i++) {
        dem_ball b = def.balls[i];
        dem_export_put_row(out, (double[]){b.radius, b.centre.x, b.centre.y, b.centre.z, b.radius}, 5, "\t");
    }
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_edem;
const dem_exporter dem_export_edem = {
    .name = "edem",
    .suffix = "edem.txt",
    .about = "EDEM: table of spheres to paste",
    .for_engine = true,
    .write = write_edem,
};
