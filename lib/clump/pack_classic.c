#include "clump/pack_classic.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "clump/farthest.h"

// of the lattice that ranks choices
enum { FEWEST_POINTS = 20000, POINTS_PER_SPHERE = 300, MOST_POINTS = 200000 };

dem_status dem_classic_go_on(const dem_classic *c, double fraction, dem_error *error)
{
    if (dem_progress(c->ctx, "packing", fmin(fmax(fraction, 0), 1)))
        return dem_fail(error, DEM_INTERRUPTED, "packing was interrupted");
    return DEM_OK;
}

double dem_classic_depth(const dem_classic *c, dem_vec3 p)
{
    dem_vec3 closest;
    return -dem_mesh_level(&c->grain->tree, p, INFINITY, &closest);
}

double dem_classic_gap(dem_classic *c, const dem_ball *balls, size_t count)
{
    dem_lattice *lattice = &c->lattice;
    int64_t gain = 0, inside = 0;
    dem_lattice_clear(lattice);
    for (size_t i = 0; i < count; i++)
        gain += c->kernels->lattice_gain(lattice, balls[i], lattice->covered);
    size_t words = lattice->word[columns_lines(&lattice->rows)];
    for (size_t w = 0; w < words; w++)
        inside += __builtin_popcountll(lattice->inside[w] & lattice->covered[w]);
    return 1 - (double)inside / (double)((int64_t)lattice->inside_count + inside - gain);
}

dem_status dem_classic_offer(dem_classic *c, const dem_ball *balls, size_t count, double *least, bool *kept,
                             dem_error *error)
{
    double gap = count ? dem_classic_gap(c, balls, count) : INFINITY;
    bool better = gap < *least;
    if (kept)
        *kept = better;
    if (!better)
        return DEM_OK;
    dem_ball *copy = dem_alloc(count, sizeof *copy);
    if (!copy)
        return dem_fail_memory(error);
    memcpy(copy, balls, count * sizeof *copy);
    free(c->balls);
    c->balls = copy;
    c->count = count;
    *least = gap;
    return DEM_OK;
}

// --inscribed: no ball reaches out
static void pull_inside(dem_classic *c)
{
    size_t kept = 0;
#pragma omp parallel for num_threads(c->threads) schedule(dynamic, 64)
    for (size_t i = 0; i < c->count; i++)
        c->balls[i].radius = fmin(c->balls[i].radius, dem_classic_depth(c, c->balls[i].centre));
    for (size_t i = 0; i < c->count; i++)
        if (c->balls[i].radius > 0)
            c->balls[kept++] = c->balls[i];
    c->count = kept;
}

static void cap(dem_classic *c)
{
    size_t most = c->options->spheres;
    if (c->count <= most)
        return;
    dem_log(c->ctx, DEM_LOG_WARNING,
            "the parameters of the method %s come to %zu spheres: the first %zu are kept, %s, and %zu left out; allow "
            "more spheres or change the parameters",
            c->packer->name, c->count, most, c->packer->order, c->count - most);
    c->count = most;
}

static dem_status hand_over(dem_classic *c, dem_pack *pack, dem_error *error)
{
    if (c->count == 0)
        return dem_fail(error, DEM_FAILED, "the method %s finds no sphere for this grain%s; %s", c->packer->name,
                        c->options->value_count ? " with these parameters" : "",
                        c->options->value_count ? "change them" : "take another method");
    pack->balls = dem_alloc(c->count, sizeof *pack->balls);
    if (!pack->balls)
        return dem_fail_memory(error);
    pack->count = c->count;
    pack->gap_estimate = dem_classic_gap(c, c->balls, c->count);
    pack->reached = true;
    for (size_t i = 0; i < c->count; i++)
        pack->balls[i] = dem_pack_grain_leave(c->grain, c->balls[i]);
    for (size_t k = 0; k < c->packer->parameter_count; k++)
        pack->used[pack->used_count++] = (dem_pack_value){c->packer->parameters[k].name, c->value[k]};
    return DEM_OK;
}

static dem_status place_count(const dem_ctx *ctx, const dem_pack_grain *grain, const dem_pack_options *options,
                              dem_pack *pack, dem_error *error)
{
    dem_classic c = {.ctx = ctx, .packer = dem_packer_find(options->method), .options = options, .grain = grain,
                     .kernels = dem_pack_kernels_choose(NULL), .threads = dem_threads(ctx)};
    for (size_t k = 0; k < c.packer->parameter_count; k++)
        c.value[k] = dem_packer_value(c.packer, options, k);
    double points = fmin(fmax(FEWEST_POINTS, (double)POINTS_PER_SPHERE * (double)options->spheres), MOST_POINTS);
    DEM_TRY(dem_lattice_build(grain, (size_t)points, &c.lattice, error));
    dem_status status = dem_classic_go_on(&c, 0, error);
    if (status == DEM_OK)
        status = c.packer->place(&c, error);
    if (status == DEM_OK) {
        if (options->side == DEM_SIDE_INSCRIBED)
            pull_inside(&c);
        cap(&c);
        status = hand_over(&c, pack, error);
    }
    dem_lattice_release(&c.lattice);
    free(c.balls);
    return status;
}

dem_status dem_classic_run(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *options, dem_pack *pack,
                           dem_error *error)
{
    const dem_packer *packer = dem_packer_find(options->method);
    if (options->side == DEM_SIDE_OUTER)
        return dem_fail(error, DEM_USAGE,
                        "the method %s cannot cover the whole grain; leave --outer out or take the method optimal",
                        packer->name);
    dem_pack_grain grain;
    DEM_TRY(dem_pack_grain_open(mesh, &grain, error));
    dem_status status = place_count(ctx, &grain, options, pack, error);
    dem_pack_grain_close(&grain);
    return status;
}
