#include "study/dimers.h"

#include "base/status.h"
#include "study/cluster.h"

// Bernal & Mason 1960, Berryman 1983; Baule et al. 2013 (figure of dimers)
const dem_dimers_known dem_dimers_sphere = {1, 0.64}, dem_dimers_peak = {1.4, 0.703};
const double dem_dimers_tolerance = 0.01;

static void describe(void *user, size_t cell, dem_buffer *inputs)
{
    const dem_dimers *d = user;
    const dem_jam_def *j = &d->jam;
    const double numbers[] = {d->aspects[cell % d->count], j->begin, j->growth, j->pressure, j->friction};
    dem_buffer_print(inputs, "dimers of %zu, %zu steps, seed %llu:", j->bodies, j->steps,
                     (unsigned long long)(j->seed + cell / d->count));
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        dem_buffer_text(inputs, " ");
        dem_buffer_shortest(inputs, numbers[i]);
    }
}

static dem_status run(void *user, size_t cell, const dem_ctx *ctx, dem_json_writer *found, dem_error *error)
{
    const dem_dimers *d = user;
    dem_jam_def def = d->jam;
    dem_clump *clump = NULL;
    dem_jam jam;
    double aspect = d->aspects[cell % d->count];
    DEM_TRY(dem_cluster_regular(2, aspect - 1, &clump, error));
    def.clump = clump;
    def.seed += cell / d->count;
    dem_status status = dem_jam_run(ctx, &def, &jam, error);
    dem_clump_destroy(clump);
    if (status != DEM_OK)
        return status;
    dem_json_put_number(found, "aspect", aspect);
    dem_json_put_whole(found, "seed", (int64_t)def.seed);
    dem_json_put_number(found, "solid_fraction", jam.solid_fraction);
    dem_json_put_number(found, "contacts", jam.contacts);
    dem_json_put_number(found, "loose", jam.loose);
    dem_json_put_number(found, "pressure", jam.pressure);
    dem_json_put_whole(found, "steps", (int64_t)jam.steps);
    dem_json_put_number(found, "seconds", jam.seconds);
    return DEM_OK;
}

dem_status dem_dimers_run(const dem_ctx *ctx, const dem_dimers *d, dem_cell_result *results, dem_error *error)
{
    for (size_t i = 0; i < d->count; i++)
        if (!(d->aspects[i] >= 1 && d->aspects[i] <= 2))
            return dem_fail(error, DEM_USAGE, "an aspect ratio of dimers is from 1 to 2, not %g", d->aspects[i]);
    const dem_cells_def def = {.directory = d->directory,
                               .count = d->count * d->seeds,
                               .only = d->only,
                               .user = (void *)d,
                               .describe = describe,
                               .run = run};
    return dem_cells_run(ctx, &def, results, error);
}
