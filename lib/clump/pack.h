/// The registry of packers: one constant record per method, one line per record in pack.c.
#ifndef DEM_CLUMP_PACK_H
#define DEM_CLUMP_PACK_H

#include "base/parameter.h"
#include "dem/clump.h"

typedef struct dem_classic dem_classic;  // pack_classic.h

typedef struct dem_packer {
    const char *name;
    const char *paper;
    const char *about;
    const dem_parameter *parameters;  ///< standard NAN: found for the number of spheres asked for
    size_t parameter_count;           ///< at most DEM_PACK_VALUES
    bool keeps_moments;               ///< the union can have the grain's moments
    size_t count_parameters;          ///< the first so many, all given, decide the number of spheres; 0: none do
    /// Fills everything of `pack` but `seconds`; the options have been checked and completed, and ask for a number of
    /// spheres (not for a gap or targets). DEM_FAILED: not with this number.
    dem_status (*run)(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *options, dem_pack *pack,
                      dem_error *error);
    const char *order;                ///< of the classics: that of their spheres, "largest first"
    /// Of the classics: chooses the balls, for dem_classic_run.
    dem_status (*place)(dem_classic *classic, dem_error *error);
} dem_packer;

/// All packers, the default first.
const dem_packer *const *dem_packers(size_t *count);
/// NULL: no packer of that name.
const dem_packer *dem_packer_find(const char *name);

/// Fills in the defaults (spheres 0: 50, or as many as the parameters given come to, up to max_spheres), having checked
/// everything. Twice does no harm.
dem_status dem_pack_complete(dem_pack_options *options, dem_error *error);
/// True where the parameters given decide the number of spheres.
bool dem_packer_sets_count(const dem_packer *packer, const dem_pack_options *options);
/// What the options give for a parameter, its standard where they give nothing; the options have been checked.
double dem_packer_value(const dem_packer *packer, const dem_pack_options *options, size_t parameter);

extern const dem_packer dem_packer_optimal, dem_packer_bubble, dem_packer_favier, dem_packer_ferellec,
    dem_packer_euclidean, dem_packer_grid;

#endif
