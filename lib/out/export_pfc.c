// Itasca PFC: a command file with a clump template. PFC wants volume and inertia at unit density [m^3, m^5] and
// multiplies with the density of the clump.
#include "out/export_text.h"

static const char MARK[] = "; ";

static void put_vector(dem_buffer *out, dem_vec3 v)
{
    dem_buffer_text(out, "(");
    dem_buffer_number(out, v.x, 17);
    dem_buffer_text(out, ",");
    dem_buffer_number(out, v.y, 17);
    dem_buffer_text(out, ",");
    dem_buffer_number(out, v.z, 17);
    dem_buffer_text(out, ")");
}

static dem_status write_pfc(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                            dem_error *error)
{
    static const char *const use[] = {
        "untested: written after the manual of PFC 6 to 9; for PFC 5 take away the brackets and commas of positions",
        "use: program call 'FILE', then clump replicate, clump generate or clump distribute ... template 'NAME'",
        "a clump weighs volume x its density: clump attribute density, with the density below gives the mass below",
        "volume and inertia (11 22 33 12 13 23) stand at unit density [m^3, m^5], as PFC wants them",
        "to show the mesh in place of the pebbles: geometry import 'MESH.stl', and `geometry NAME` behind `name`",
        NULL};
    dem_clump_def def = dem_clump_view(clump);
    dem_plain_name name = dem_export_identifier(&def);
    dem_export_put_head(out, &(dem_export_head){MARK, "Itasca PFC clump template", use, "p3dat"}, &def, options);
    dem_buffer_print(out, "clump template create ...\n    name '%s' ...\n    pebbles %zu ...\n", name.text,
                     def.ball_count);
    for (size_t i = 0; i < def.ball_count; i++) {
        dem_buffer_text(out, "        ");
        dem_buffer_number(out, def.balls[i].radius, 17);
        dem_buffer_text(out, " ");
        put_vector(out, def.balls[i].centre);
        dem_buffer_text(out, " ...\n");
    }
    dem_buffer_text(out, "    volume ");
    dem_buffer_number(out, def.mass / def.density, 17);
    dem_buffer_text(out, " ...\n    inertia ");
    for (int k = 0; k < 3; k++) {
        dem_buffer_number(out, def.inertia[k] / def.density, 17);
        dem_buffer_text(out, k < 2 ? " " : " 0 0 0 ...\n    position ");
    }
    put_vector(out, (dem_vec3){0, 0, 0});
    dem_buffer_text(out, "\n");
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_pfc;
const dem_exporter dem_export_pfc = {
    .name = "pfc",
    .suffix = "p3dat",
    .about = "Itasca PFC: clump template as a command file",
    .for_engine = true,
    .write = write_pfc,
};
