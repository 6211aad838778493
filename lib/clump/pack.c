#include "clump/pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/status.h"
#include "clump/pack_target.h"

enum { MOST_SPHERES = 100000 };

static const dem_packer *const packers[] = {
    &dem_packer_optimal,
    &dem_packer_bubble,
    &dem_packer_favier,
    &dem_packer_ferellec,
    &dem_packer_euclidean,
    &dem_packer_grid,
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

double dem_packer_value(const dem_packer *packer, const dem_pack_options *options, size_t parameter)
{
    const dem_parameter *p = &packer->parameters[parameter];
    for (size_t i = options->value_count; i-- > 0;)
        if (strcmp(options->values[i].name, p->name) == 0 && !isnan(options->values[i].value))
            return options->values[i].value;
    return p->standard;
}

// every value given is one of the method's and within its range
static dem_status check_values(const dem_packer *packer, const dem_pack_options *options, dem_error *error)
{
    DEM_ASSERT(packer->parameter_count <= DEM_PACK_VALUES);
    for (size_t i = 0; i < options->value_count; i++) {
        const dem_pack_value *v = &options->values[i];
        size_t at = 0;
        while (at < packer->parameter_count && strcmp(packer->parameters[at].name, v->name) != 0)
            at++;
        if (at == packer->parameter_count)
            return dem_fail(error, DEM_USAGE, "the method %s has no parameter '%s'; --methods lists them", packer->name,
                            v->name);
        const dem_parameter *p = &packer->parameters[at];
        if (isnan(v->value))
            continue;
        bool whole = strcmp(p->unit, "count") != 0 || v->value == floor(v->value);
        if (!(v->value >= p->low && v->value <= p->high) || !whole)
            return dem_fail(error, DEM_USAGE, "%s is %g; the method %s takes %s%g to %g%s%s", p->name, v->value,
                            packer->name, whole ? "" : "whole numbers from ", p->low, p->high,
                            strcmp(p->unit, "-") == 0 || strcmp(p->unit, "count") == 0 ? "" : " ",
                            strcmp(p->unit, "-") == 0 || strcmp(p->unit, "count") == 0 ? "" : p->unit);
    }
    return DEM_OK;
}

// what the packer did not say it used is what was given
static void complete_used(const dem_packer *packer, const dem_pack_options *options, dem_pack *pack)
{
    for (size_t k = 0; k < packer->parameter_count; k++) {
        bool said = false;
        for (size_t i = 0; i < pack->used_count; i++)
            said = said || strcmp(pack->used[i].name, packer->parameters[k].name) == 0;
        if (!said && pack->used_count < DEM_PACK_VALUES)
            pack->used[pack->used_count++] =
                (dem_pack_value){packer->parameters[k].name, dem_packer_value(packer, options, k)};
    }
}

bool dem_packer_sets_count(const dem_packer *packer, const dem_pack_options *options)
{
    for (size_t k = 0; k < packer->count_parameters; k++)
        if (isnan(dem_packer_value(packer, options, k)))
            return false;
    return packer->count_parameters > 0;
}

dem_status dem_pack_complete(dem_pack_options *options, dem_error *error)
{
    dem_pack_options defaults = dem_pack_defaults();
    if (!options->method)
        options->method = defaults.method;
    if (!options->max_spheres)
        options->max_spheres = defaults.max_spheres;
    const dem_packer *packer = dem_packer_find(options->method);
    if (!packer)
        return dem_fail(error, DEM_USAGE, "there is no packing method '%s'; --methods lists them", options->method);
    DEM_TRY(check_values(packer, options, error));
    if (!options->spheres)
        options->spheres = dem_packer_sets_count(packer, options) ? options->max_spheres : defaults.spheres;
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

dem_status dem_clump_pack(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *given, dem_pack *pack,
                          dem_error *error)
{
    *pack = (dem_pack){.moment_residual = NAN, .gap_estimate = NAN};
    dem_pack_options options = *given;
    DEM_TRY(dem_pack_complete(&options, error));
    const dem_packer *packer = dem_packer_find(options.method);
    double start = dem_clock();
    bool searched = options.gap > 0 || options.target_count > 0;
    dem_status status = searched ? dem_pack_target(ctx, mesh, packer, &options, pack, error)
                                 : packer->run(ctx, mesh, &options, pack, error);
    if (status != DEM_OK) {
        dem_pack_free(pack);
        return status;
    }
    complete_used(packer, &options, pack);
    pack->seconds = dem_clock() - start;
    return DEM_OK;
}

void dem_pack_free(dem_pack *pack)
{
    free(pack->balls);
    *pack = (dem_pack){0};
}
