// Chrono DEM-Engine: CSV of the spheres; mass and moments are given to LoadClumpType.
#include "out/export_text.h"

static const char MARK[] = "# ";

static void put_numbers(dem_buffer *out, const double *values, int count)
{
    for (int i = 0; i < count; i++) {
        dem_buffer_number(out, values[i], 9);  // a float's
        dem_buffer_text(out, i + 1 < count ? "f, " : "f");
    }
}

static void put_snippet(dem_buffer *out, const dem_clump_def *clump, const dem_export_options *options)
{
    dem_plain_name file = dem_export_file_name(clump, options, "deme.csv");
    double volume = clump->mass / clump->density;
    dem_buffer_text(out, "#   auto grain = DEMSim.LoadClumpType(");
    put_numbers(out, &clump->mass, 1);
    dem_buffer_text(out, ", make_float3(");
    put_numbers(out, clump->inertia, 3);
    dem_buffer_print(out, "), \"%s\", material);\n#   grain->SetVolume(", file.text);
    put_numbers(out, &volume, 1);
    dem_buffer_text(out, ");\n");
}

static dem_status write_deme(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                             dem_error *error)
{
    static const char *const use[] = {
        "untested: written after its source of 2025",
        "use: the lines of C++ below; the volume is needed for void ratios",
        "the coordinates are those InformCentroidPrincipal asks for: there is no need to call it",
        "grain->Scale(s) also scales mass and moments", NULL};
    dem_clump_def def = dem_clump_view(clump);
    dem_export_put_head(out, &(dem_export_head){MARK, "Chrono DEM-Engine clump", use, "deme.csv"}, &def, options);
    put_snippet(out, &def, options);
    dem_buffer_text(out, "x,y,z,r\n");
    for (size_t i = 0; i < def.ball_count; i++)
        dem_export_put_ball(out, def.balls[i], ",");
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_deme;
const dem_exporter dem_export_deme = {
    .name = "deme",
    .suffix = "deme.csv",
    .about = "Chrono DEM-Engine: CSV of the spheres, the C++ that loads it in the comments",
    .for_engine = true,
    .write = write_deme,
};
