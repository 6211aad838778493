#include "clump/pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/status.h"
#include "clump/pack_target.h"

enum { MOST_SPHERES = 100000 };

static const dem_packer *const packers[] = {
    &dem_packer_optimal,
};

const dem_packer *const *dem_packers(size_t *count)
{
    *count = sizeof packers / sizeof *packers;
    return packers;
}

const dem_packer *dem_packer_find(const char *name)
{
    for (size_t i = 0; i < sizeof packers / sizeof *packers; i++)
        if (strcmp(packers[i]->name, name) == 0)
            return packers[i];
    return NULL;
}

dem_pack_options dem_pack_defaults(void)
{
    return (dem_pack_options){.method = "optimal",
                              .spheres = 50,
                              .max_spheres = 2000,
                              .effort = DEM_EFFORT_DEFAULT,
                              .moments = DEM_MOMENTS_EXACT,
                              .seed = 1};
}

static dem_status complete(dem_pack_options *options, dem_error *error)
{
    dem_pack_options defaults = dem_pack_defaults();
    if (!options->method)
        options->method = defaults.method;
    if (!options->spheres)
        options->spheres = defaults.spheres;
    if (!options->max_spheres)
        options->max_spheres = defaults.max_spheres;
    if (!options->seed)
        options->seed = defaults.seed;
    if (options->spheres > MOST_SPHERES || options->max_spheres > MOST_SPHERES)
        return dem_fail(error, DEM_USAGE, "%zu spheres are too many for one clump; ask for at most %d",
                        options->spheres > MOST_SPHERES ? options->spheres : options->max_spheres, MOST_SPHERES);
    if (!(options->gap >= 0 && options->gap < 1))
        return dem_fail(error, DEM_USAGE, "a gap of %g %% is out of range; ask for more than 0 and less than 100 %%",
                        100 * options->gap);
    return DEM_OK;
}

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

dem_status dem_clump_pack(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *given, dem_pack *pack,
                          dem_error *error)
{
    *pack = (dem_pack){.moment_residual = NAN, .gap_estimate = NAN};
    dem_pack_options options = *given;
    DEM_TRY(complete(&options, error));
    const dem_packer *packer = dem_packer_find(options.method);
    if (!packer)
        return dem_fail(error, DEM_USAGE, "there is no packing method '%s'; --methods lists them", options.method);
    double start = seconds_now();
    bool searched = options.gap > 0 || options.target_count > 0;
    dem_status status = searched ? dem_pack_target(ctx, mesh, packer, &options, pack, error)
                                 : packer->run(ctx, mesh, &options, pack, error);
    if (status != DEM_OK) {
        dem_pack_free(pack);
        return status;
    }
    pack->seconds = seconds_now() - start;
    return DEM_OK;
}

void dem_pack_free(dem_pack *pack)
{
    free(pack->balls);
    *pack = (dem_pack){0};
}
