// Kratos DEMApplication cluster. The point of Particle_center_and_diameter is subtracted from the centres, so it must
// be the centre of mass; mass = density of the material x volume.
#include "out/export_text.h"

static const char MARK[] = "// ";

static dem_status write_kratos(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                               dem_error *error)
{
    static const char *const use[] = {
        "untested: written after its cluster_file_reader.py",
        "use: name this file in the mdpa of the inlet or of the clusters; PARTICLE_DENSITY of the material must be the",
        "density below for the mass below. Size is the diameter of the sphere about the centre of mass that holds all",
        "spheres: a cluster of another diameter D is scaled by D / Size, its mass with the third power", NULL};
    dem_clump_def def = dem_clump_view(clump);
    dem_plain_name name = dem_name_plain(def.name, "grain", NULL, 0);
    double diameter = 2 * dem_export_reach(&def), volume = def.mass / def.density;
    dem_export_put_head(out, &(dem_export_head){MARK, "Kratos DEM cluster", use, "clu"}, &def, options);
    dem_buffer_print(out, "\nName\n%s\n\nBegin centers_and_radii\n", name.text);
    for (size_t i = 0; i < def.ball_count; i++)
        dem_export_put_ball(out, def.balls[i], " ");
    dem_buffer_text(out, "End centers_and_radii\n\nParticle_center_and_diameter\n");
    dem_export_put_row(out, (double[]){0, 0, 0, diameter}, 4, " ");
    dem_buffer_text(out, "\nSize\n");
    dem_export_put_row(out, &diameter, 1, "");
    dem_buffer_text(out, "\nVolume\n");
    dem_export_put_row(out, &volume, 1, "");
    dem_buffer_text(out, "\nInertia per unit mass\n");
    for (int k = 0; k < 3; k++)
        dem_export_put_row(out, (double[]){def.inertia[k] / def.mass}, 1, "");
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_kratos;
const dem_exporter dem_export_kratos = {
    .name = "kratos",
    .suffix = "clu",
    .about = "Kratos: cluster file (.clu)",
    .for_engine = true,
    .write = write_kratos,
};
