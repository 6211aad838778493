#include "mesh/fracture.h"

#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"

enum { STREAM = 4, POINTS_PER_BIN = 2, CELLS_BETWEEN_REPORTS = 512 };

// points sorted into the bins of a grid over the block
typedef struct bins {
    dem_box block;
    size_t along[3];
    double width[3];  // [m]
    uint32_t *first;  // [bins + 1] in `points`
    uint32_t *points;
} bins;

void dem_fracture_release(dem_fracture *f)
{
    for (size_t i = 0; i < f->count && f->cells; i++)
        dem_polyhedron_release(&f->cells[i]);
    free(f->cells);
    free(f->points);
    *f = (dem_fracture){0};
}

static size_t bin_along(const bins *b, int axis, double x)
{
    double at = (x - v3_get(b->block.low, axis)) / b->width[axis];
    return at < 0 ? 0 : at >= (double)b->along[axis] ? b->along[axis] - 1 : (size_t)at;
}

static size_t bin_of(const bins *b, dem_vec3 p)
{
    return (bin_along(b, 2, p.z) * b->along[1] + bin_along(b, 1, p.y)) * b->along[0] + bin_along(b, 0, p.x);
}

static dem_status fill_bins(bins *b, const dem_fracture *f, dem_box block, dem_error *error)
{
    dem_vec3 extent = v3_sub(block.high, block.low);
    double edge = cbrt(extent.x * extent.y * extent.z / (double)f->count * POINTS_PER_BIN);
    *b = (bins){.block = block};
    size_t count = 1;
    for (int k = 0; k < 3; k++) {
        double along = fmin(ceil(v3_get(extent, k) / edge), (double)f->count);
        b->along[k] = along > 1 ? (size_t)along : 1;
        b->width[k] = v3_get(extent, k) / (double)b->along[k];
        count *= b->along[k];
    }
    b->first = dem_alloc_zero(count + 2, sizeof *b->first);
    b->points = dem_alloc(f->count, sizeof *b->points);
    if (!b->first || !b->points)
        return dem_fail_memory(error);
    for (size_t i = 0; i < f->count; i++)
        b->first[bin_of(b, f->points[i]) + 2]++;
    for (size_t i = 1; i < count + 2; i++)
        b->first[i] += b->first[i - 1];
    for (size_t i = 0; i < f->count; i++)
        b->points[b->first[bin_of(b, f->points[i]) + 1]++] = (uint32_t)i;
    return DEM_OK;
}

static double reach(const dem_polyhedron *cell, dem_vec3 from)
{
    double far = 0;
    for (size_t i = 0; i < cell->loop_count; i++)
        far = fmax(far, v3_norm2(v3_sub(cell->corners[cell->loops[i]], from)));
    return sqrt(far);
}

static dem_status cut_by_bin(const dem_fracture *f, const bins *b, size_t bin, size_t me, double *far, dem_error *error)
{
    dem_polyhedron *cell = &f->cells[me];
    for (uint32_t i = b->first[bin]; i < b->first[bin + 1]; i++) {
        size_t other = b->points[i];
        dem_vec3 apart = v3_sub(f->points[other], f->points[me]);
        double distance = v3_norm(apart);
        if (other == me || distance > 2 * *far || distance == 0)
            continue;
        dem_vec3 normal = v3_scale(apart, 1 / distance);
        dem_vec3 middle = v3_along(f->points[me], 0.5, apart);
        bool cut;
        DEM_TRY(dem_polyhedron_cut(cell, (dem_plane){normal, v3_dot(normal, middle)}, (int)other, &cut, error));
        if (cut)
            *far = reach(cell, f->points[me]);
    }
    return DEM_OK;
}

// the bins ring by ring around the point's own, until none can hold a point whose plane reaches the cell
static dem_status make_cell(const dem_fracture *f, const bins *b, size_t me, dem_error *error)
{
    DEM_TRY(dem_polyhedron_box(&f->cells[me], b->block, error));
    dem_vec3 p = f->points[me];
    double far = reach(&f->cells[me], p), narrowest = fmin(b->width[0], fmin(b->width[1], b->width[2]));
    long at[3] = {(long)bin_along(b, 0, p.x), (long)bin_along(b, 1, p.y), (long)bin_along(b, 2, p.z)};
    long most = (long)(b->along[0] + b->along[1] + b->along[2]);
    for (long ring = 0; ring <= most && (double)(ring - 1) * narrowest <= 2 * far; ring++)
        for (long z = at[2] - ring; z <= at[2] + ring; z++)
            for (long y = at[1] - ring; y <= at[1] + ring; y++) {
                bool whole = z == at[2] - ring || z == at[2] + ring || y == at[1] - ring || y == at[1] + ring;
                for (long x = at[0] - ring; x <= at[0] + ring; x += whole || ring == 0 ? 1 : 2 * ring) {
                    if (x < 0 || y < 0 || z < 0 || x >= (long)b->along[0] || y >= (long)b->along[1] ||
                        z >= (long)b->along[2])
                        continue;
                    size_t bin = ((size_t)z * b->along[1] + (size_t)y) * b->along[0] + (size_t)x;
                    DEM_TRY(cut_by_bin(f, b, bin, me, &far, error));
                }
            }
    return DEM_OK;
}

static dem_status make_cells(const dem_ctx *ctx, const dem_fracture *f, dem_box block, double done, double share,
                             dem_error *error)
{
    bins b;
    dem_status status = fill_bins(&b, f, block, error);
    for (size_t begin = 0; begin < f->count && status == DEM_OK; begin += CELLS_BETWEEN_REPORTS) {
        size_t end = begin + CELLS_BETWEEN_REPORTS < f->count ? begin + CELLS_BETWEEN_REPORTS : f->count;
        bool bad = false;
#pragma omp parallel for num_threads(dem_threads(ctx)) schedule(dynamic, 8) reduction(|| : bad)
        for (size_t i = begin; i < end; i++)
            bad = make_cell(f, &b, i, NULL) != DEM_OK || bad;
        if (bad)
            status = dem_fail_memory(error);
        else if (dem_progress(ctx, "breaking", done + share * (double)end / (double)f->count))
            status = dem_fail(error, DEM_INTERRUPTED, "interrupted; nothing was written");
    }
    free(b.first);
    free(b.points);
    return status;
}

static dem_status move_to_middles(const dem_fracture *f, dem_error *error)
{
    for (size_t i = 0; i < f->count; i++) {
        dem_polyhedron_measures m;
        DEM_TRY(dem_polyhedron_measure(&f->cells[i], &m, error));
        f->points[i] = m.centre;
    }
    return DEM_OK;
}

dem_status dem_fracture_block(const dem_ctx *ctx, dem_box block, size_t count, size_t evenings, uint64_t seed,
                              dem_fracture *f, dem_error *error)
{
    *f = (dem_fracture){dem_alloc(count, sizeof *f->points), dem_alloc_zero(count, sizeof *f->cells), count};
    if (!f->points || !f->cells) {
        dem_fracture_release(f);
        return dem_fail_memory(error);
    }
    dem_random random = random_stream(seed, STREAM);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            double s = random_uniform(&random);
            v3_set(&f->points[i], k, (1 - s) * v3_get(block.low, k) + s * v3_get(block.high, k));
        }
    double share = 1 / (double)(evenings + 1);
    dem_status status = make_cells(ctx, f, block, 0, share, error);
    for (size_t i = 1; i <= evenings && status == DEM_OK; i++) {
        status = move_to_middles(f, error);
        if (status == DEM_OK)
            status = make_cells(ctx, f, block, (double)i * share, share, error);
    }
    if (status != DEM_OK)
        dem_fracture_release(f);
    return status;
}
