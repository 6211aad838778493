// MercuryDPM: a folder as its tool MClump makes them. Its files have no comments; a README beside them says the rest.
#include "out/export_text.h"

static dem_status done(const dem_buffer *out, dem_error *error)
{
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

static dem_status write_pebbles(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                                dem_error *error)
{
    (void)options;
    dem_clump_def def = dem_clump_view(clump);
    for (size_t i = 0; i < def.ball_count; i++)
        dem_export_put_ball(out, def.balls[i], ",");
    return done(out, error);
}

static dem_status write_mass(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                             dem_error *error)
{
    (void)options;
    dem_clump_def def = dem_clump_view(clump);
    dem_export_put_row(out, &def.mass, 1, "");
    return done(out, error);
}

static dem_status write_tensor(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                               dem_error *error)
{
    (void)options;
    dem_clump_def def = dem_clump_view(clump);
    for (int k = 0; k < 3; k++) {
        double row[3] = {0, 0, 0};
        row[k] = def.inertia[k];
        dem_export_put_row(out, row, 3, ",");
    }
    return done(out, error);
}

static dem_status write_axes(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                             dem_error *error)
{
    (void)clump;
    (void)options;
    dem_buffer_text(out, "1,0,0\n0,1,0\n0,0,1\n");
    return done(out, error);
}

static dem_status write_readme(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                               dem_error *error)
{
    static const char *const use[] = {
        "untested: written after MercuryDPM's ClumpInput.h",
        "use: copy this folder into Tools/MClump/Clumps/ of MercuryDPM's source; LoadClumps() of",
        "Drivers/Clump/ClumpHeaders/ClumpInput.h reads every folder there, in the order of their names.",
        "Clump/Clump.txt: pebbles x,y,z,r; Inertia/Mass.txt: mass; Inertia/TOI.txt: tensor of inertia;",
        "Inertia/PD.txt: principal directions. The loader keeps 7 digits (it reads floats).",
        "The mass is that of the file; the density of the species plays no part in it.",
        NULL};
    dem_clump_def def = dem_clump_view(clump);
    dem_export_put_head(out, &(dem_export_head){"", "MercuryDPM clump", use, "mercury"}, &def, options);
    return done(out, error);
}

static const dem_export_part parts[] = {{"Clump/Clump.txt", write_pebbles}, {"Inertia/Mass.txt", write_mass},
                                        {"Inertia/TOI.txt", write_tensor},  {"Inertia/PD.txt", write_axes},
                                        {"README.txt", write_readme},       {NULL, NULL}};

extern const dem_exporter dem_export_mercury;
const dem_exporter dem_export_mercury = {
    .name = "mercury",
    .suffix = "mercury",
    .about = "MercuryDPM: a folder as its tool MClump makes them",
    .for_engine = true,
    .parts = parts,
};
