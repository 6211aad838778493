// LAMMPS molecule file for `fix rigid/small ... mol`. Its reader takes the products of inertia in another order than
// its manual says; in the principal frame they are 0. The masses of the atoms are those that let a sum over them come
// as near as can be to the clump, for where LAMMPS sums: bodies of create_atoms, and every run without `reinit no`.
#include <stdlib.h>

#include "base/memory.h"
#include "out/export_text.h"
#include "out/mass_shares.h"

static const char MARK[] = "# ";

static void put_use(dem_buffer *out, const dem_clump_def *clump, const dem_export_options *options,
                    dem_shares_meet meet)
{
    static const char *const met[] = {
        [DEM_SHARES_MASS] = "mass, but not the centre and the inertia: use only fix pour or fix deposit",
        [DEM_SHARES_CENTRE] = "mass and centre, but less inertia: use fix pour or fix deposit where rotation matters",
        [DEM_SHARES_INERTIA] = "mass, centre and inertia too"};
    dem_plain_name id = dem_export_identifier(clump), file = dem_export_file_name(clump, options, "mol");
    const char *const none[] = {NULL};
    dem_export_put_head(
        out,
        &(dem_export_head){MARK, "LAMMPS molecule for fix rigid/small; tried with the version of January 2022", none,
                           "mol"},
        clump, options);
    dem_export_put_comment(
        out, MARK, "use, with `units si`, `atom_style hybrid sphere molecular`, `mass 1 1.0` (wanted, not used):");
    dem_export_put_comment(out, MARK, "  molecule %s %s", id.text, file.text);
    dem_export_put_comment(out, MARK, "  fix body all rigid/small molecule mol %s reinit no", id.text);
    dem_export_put_comment(out, MARK, "  fix fill all pour 1000 0 4767548 region slab mol %s rigid body", id.text);
    dem_export_put_comment(out, MARK, "  neigh_modify exclude molecule/intra all");
    dem_buffer_text(out, "#   comm_modify vel yes cutoff ");
    dem_buffer_number(out, 2.2 * dem_export_reach(clump), 3);
    dem_buffer_text(out, "  (more than the size of the clump)\n");
    dem_export_put_comment(out, MARK, "without `reinit no` the next run command forgets this mass and inertia;");
    dem_export_put_comment(out, MARK, "gravity: fix g all gravity ... disable, and `gravity g` behind `reinit no`");
    dem_export_put_comment(out, MARK, "bodies of create_atoms get what the masses of their atoms add up to: %s",
                           met[meet]);
    dem_export_put_comment(out, MARK, "atom type: 1, in the section Types");
}

// the section of one column behind the number of the atom
static void put_section(dem_buffer *out, const char *name, const dem_clump_def *clump, const double *values)
{
    dem_buffer_print(out, "\n%s\n\n", name);
    for (size_t i = 0; i < clump->ball_count; i++) {
        dem_buffer_print(out, "%zu ", i + 1);
        dem_export_put_row(out, &values[i], 1, "");
    }
}

static void put_atoms(dem_buffer *out, const dem_clump_def *clump, double *diameters, const double *masses)
{
    dem_buffer_text(out, "\nCoords\n\n");
    for (size_t i = 0; i < clump->ball_count; i++) {
        dem_vec3 c = clump->balls[i].centre;
        dem_buffer_print(out, "%zu ", i + 1);
        dem_export_put_row(out, (double[]){c.x, c.y, c.z}, 3, " ");
        diameters[i] = 2 * clump->balls[i].radius;
    }
    dem_buffer_text(out, "\nTypes\n\n");
    for (size_t i = 0; i < clump->ball_count; i++)
        dem_buffer_print(out, "%zu 1\n", i + 1);
    put_section(out, "Diameters", clump, diameters);
    put_section(out, "Masses", clump, masses);
}

static dem_status write_lammps(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                               dem_error *error)
{
    dem_clump_def def = dem_clump_view(clump);
    double *masses = dem_alloc(2 * def.ball_count, sizeof *masses);  // then the diameters
    if (!masses)
        return dem_fail_memory(error);
    dem_shares_meet meet;
    dem_status status = dem_mass_shares(&def, masses, &meet, error);
    if (status == DEM_OK) {
        const double *moment = def.inertia;
        put_use(out, &def, options, meet);
        dem_buffer_print(out, "\n%zu atoms\n", def.ball_count);
        dem_buffer_number(out, def.mass, 17);
        dem_buffer_text(out, " mass\n0 0 0 com\n");
        for (int k = 0; k < 3; k++) {
            dem_buffer_number(out, moment[k], 17);
            dem_buffer_text(out, k < 2 ? " " : " 0 0 0 inertia\n");
        }
        put_atoms(out, &def, masses + def.ball_count, masses);
    }
    free(masses);
    if (status == DEM_OK && out->failed)
        status = dem_fail_memory(error);
    return status;
}

extern const dem_exporter dem_export_lammps;
const dem_exporter dem_export_lammps = {
    .name = "lammps",
    .suffix = "mol",
    .about = "LAMMPS: molecule file for fix rigid/small",
    .for_engine = true,
    .write = write_lammps,
};
