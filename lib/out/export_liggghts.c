// LIGGGHTS: the file of spheres, with the commands that use it as comments marked "#:". Mass and inertia are given:
// what 3.8.0 finds itself by sampling has a wrong product of inertia. With use_density the origin is the centre.
#include "out/export_text.h"

static const char MARK[] = "# ", COMMAND[] = "#: ";

static void put_value(dem_buffer *out, const char *before, double value)
{
    dem_buffer_text(out, before);
    dem_buffer_number(out, value, 17);
}

// LIGGGHTS takes a template below 1e-12 m^3 for a mistake of units, unless it is told
static void put_volume_limit(dem_buffer *out, double volume)
{
    if (volume >= 2e-12)
        return;
    dem_buffer_text(out, " volume_limit ");
    dem_buffer_number(out, volume / 10, 3);
}

// a line that ends in '&' would go on, also a comment, so each command is one line
static void put_command(dem_buffer *out, const dem_clump_def *clump, const dem_export_options *options)
{
    dem_plain_name id = dem_export_identifier(clump), file = dem_export_file_name(clump, options, "liggghts");
    dem_buffer_print(out, "%sfix pts_%s all particletemplate/multisphere 15485863 atom_type 1", COMMAND, id.text);
    put_value(out, " density constant ", clump->density);
    put_volume_limit(out, clump->mass / clump->density);
    dem_buffer_print(out, " nspheres %zu ntry 100000 spheres file %s scale 1.0 type 1", clump->ball_count, file.text);
    put_value(out, " mass ", clump->mass);
    put_value(out, " inertia_tensor ", clump->inertia[0]);
    put_value(out, " 0 0 ", clump->inertia[1]);
    put_value(out, " 0 ", clump->inertia[2]);
    dem_buffer_text(out, " use_density\n");
}

// LIGGGHTS has no clump of one sphere
static void put_sphere_command(dem_buffer *out, const dem_clump_def *clump)
{
    dem_plain_name id = dem_export_identifier(clump);
    double r = clump->balls[0].radius, volume = 4 * DEM_PI / 3 * r * r * r;
    dem_buffer_print(out, "%sfix pts_%s all particletemplate/sphere 15485863 atom_type 1", COMMAND, id.text);
    put_value(out, " density constant ", clump->mass / volume);
    put_volume_limit(out, volume);
    put_value(out, " radius constant ", r);
    dem_buffer_text(out, "\n");
}

static dem_status write_liggghts(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                                 dem_error *error)
{
    static const char *const several[] = {
        "tried with 3.8.0; the file is that of `spheres file` in the line marked #: below, which defines the template.",
        "sed -n 's/^#: //p' FILE >in.grain puts it into a script to include; then",
        "  fix pdd all particledistribution/discrete 15485867 1 pts_NAME 1.0",
        "  fix ins all insert/pack seed 32452843 distributiontemplate pdd ... orientation random",
        "  fix integr all multisphere",
        "to change: atom_type, the seed (a prime above 10000), ntry (its own sampling, of which nothing is used),",
        "type (numbers the templates from 1); scale must stay 1: it leaves mass and inertia as they are",
        "mass and inertia_tensor (Ixx Ixy Ixz Iyy Iyz Izz) are what it uses, the origin is the centre (use_density);",
        "compute erotate/multisphere and ke/multisphere are right for bodies, erotate/sphere and ke are not",
        NULL};
    static const char *const one[] = {
        "a multisphere needs two spheres, so this is a plain sphere: its mass is right, its inertia 2/5 m r^2", NULL};
    dem_clump_def def = dem_clump_view(clump);
    dem_export_put_head(out,
                        &(dem_export_head){MARK, "LIGGGHTS spheres for fix particletemplate/multisphere",
                                           def.ball_count > 1 ? several : one, "liggghts"},
                        &def, options);
    if (def.ball_count > 1)
        put_command(out, &def, options);
    else
        put_sphere_command(out, &def);
    dem_export_put_comment(out, MARK, "x y z r");
    for (size_t i = 0; i < def.ball_count; i++)
        dem_export_put_ball(out, def.balls[i], " ");
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_liggghts;
const dem_exporter dem_export_liggghts = {
    .name = "liggghts",
    .suffix = "liggghts",
    .about = "LIGGGHTS: spheres for particletemplate/multisphere, its command in the comments",
    .for_engine = true,
    .write = write_liggghts,
};
