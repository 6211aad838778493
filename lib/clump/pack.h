/// The registry of packers: one constant record per method, one line per record in pack.c.
#ifndef DEM_CLUMP_PACK_H
#define DEM_CLUMP_PACK_H

#include "dem/clump.h"

typedef struct dem_packer_parameter {
    const char *name;
    double value;       ///< default
    double low, high;   ///< range, both ends allowed
    const char *unit;   ///< "-" for a pure number
    const char *help;
} dem_packer_parameter;

typedef struct dem_packer {
    const char *name;
    const char *paper;
    const char *about;
    const dem_packer_parameter *parameters;
    size_t parameter_count;
    /// Fills everything of `pack` but `seconds`; the options have been checked and completed, and ask for a number of
    /// spheres (not for a gap or targets). DEM_FAILED: not with this number.
    dem_status (*run)(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *options, dem_pack *pack,
                      dem_error *error);
} dem_packer;

/// All packers, the default first.
const dem_packer *const *dem_packers(size_t *count);
/// NULL: no packer of that name.
const dem_packer *dem_packer_find(const char *name);

extern const dem_packer dem_packer_optimal;

#endif
