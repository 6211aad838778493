#include "mesh/voxels.h"

#include <stdlib.h>

#include "base/memory.h"

static const double CRUMBS = 0.05;  // part of the voxels that is dropped without being asked for

void dem_voxels_release(dem_voxels *voxels)
{
    free(voxels->inside);
    *voxels = (dem_voxels){0};
}

dem_status dem_voxels_cut(const dem_volume *volume, const dem_label *label, dem_voxels *voxels, dem_error *error)
{
    *voxels = (dem_voxels){0};
    for (int k = 0; k < 3; k++) {
        voxels->low[k] = label->low[k];
        voxels->size[k] = label->high[k] - label->low[k] + 3;
    }
    const size_t *n = voxels->size;
    voxels->inside = dem_alloc_zero(n[0] * n[1], n[2]);
    if (!voxels->inside)
        return dem_fail_memory(error);
    for (size_t z = 0; z + 2 < n[2]; z++)
        for (size_t y = 0; y + 2 < n[1]; y++) {
            size_t from = ((z + label->low[2]) * volume->size[1] + y + label->low[1]) * volume->size[0] + label->low[0];
            uint8_t *to = voxels->inside + ((z + 1) * n[1] + y + 1) * n[0] + 1;
            for (size_t x = 0; x + 2 < n[0]; x++) {
                to[x] = dem_volume_label(volume, from + x) == label->value;
                voxels->count += to[x];
            }
        }
    return DEM_OK;
}

// ---- pieces: runs along x, joined where they overlap with one of the row or layer before

typedef struct voxel_run {
    uint32_t begin, end;
    size_t parent;
} voxel_run;

typedef struct piece_work {
    voxel_run *runs;
    size_t count, capacity;
    size_t *rows;    // [size[1] size[2] + 1] first run of each row
    size_t *voxels;  // [count] of the piece, at its root
} piece_work;

static size_t root(voxel_run *runs, size_t i)
{
    while (runs[i].parent != i)
        i = runs[i].parent = runs[runs[i].parent].parent;
    return i;
}

static void join_rows(piece_work *w, size_t row, size_t other)
{
    size_t a = w->rows[row], b = w->rows[other];
    while (a < w->rows[row + 1] && b < w->rows[other + 1]) {
        if (w->runs[a].begin < w->runs[b].end && w->runs[b].begin < w->runs[a].end) {
            size_t x = root(w->runs, a), y = root(w->runs, b);
            w->runs[x > y ? x : y].parent = x > y ? y : x;
        }
        if (w->runs[a].end < w->runs[b].end)
            a++;
        else
            b++;
    }
}

static bool find_runs(piece_work *w, const dem_voxels *v)
{
    size_t rows = v->size[1] * v->size[2];
    w->rows = dem_alloc(rows + 1, sizeof *w->rows);
    for (size_t row = 0; w->rows && row < rows; row++) {
        const uint8_t *inside = v->inside + row * v->size[0];
        w->rows[row] = w->count;
        for (size_t x = 0, end; x < v->size[0]; x = end) {
            const uint8_t *next = memchr(inside + x, !inside[x], v->size[0] - x);
            end = next ? (size_t)(next - inside) : v->size[0];
            if (!inside[x])
                continue;
            if (!dem_grow(&w->runs, &w->capacity, w->count, sizeof *w->runs))
                return false;
            w->runs[w->count] = (voxel_run){(uint32_t)x, (uint32_t)end, w->count};
            w->count++;
        }
        w->rows[row + 1] = w->count;
        if (row % v->size[1] > 0)
            join_rows(w, row, row - 1);
        if (row >= v->size[1])
            join_rows(w, row, row - v->size[1]);
    }
    return w->rows != NULL;
}

// clears every run that is not of the piece `kept`
static void clear_others(const piece_work *w, dem_voxels *v, size_t kept)
{
    for (size_t row = 0; row < v->size[1] * v->size[2]; row++)
        for (size_t i = w->rows[row]; i < w->rows[row + 1]; i++)
            if (root(w->runs, i) != kept) {
                size_t length = w->runs[i].end - w->runs[i].begin;
                memset(v->inside + row * v->size[0] + w->runs[i].begin, 0, length);
                v->count -= length;
            }
}

static dem_status choose(const dem_ctx *ctx, piece_work *w, dem_voxels *v, dem_keep keep, dem_error *error)
{
    size_t pieces = 0, largest = 0;
    w->voxels = dem_alloc_zero(w->count, sizeof *w->voxels);
    if (!w->voxels)
        return dem_fail_memory(error);
    for (size_t i = 0; i < w->count; i++) {
        size_t of = root(w->runs, i);
        pieces += of == i;
        w->voxels[of] += w->runs[i].end - w->runs[i].begin;
        largest = w->voxels[of] > w->voxels[largest] ? of : largest;
    }
    double rest = 1 - (double)w->voxels[largest] / (double)v->count;
    if (pieces == 1 || keep == DEM_KEEP_ALL)
        return DEM_OK;
    if (keep == DEM_KEEP_ONE && rest > CRUMBS)
        return dem_fail(error, DEM_BAD_INPUT,
                        "the label is in %zu pieces, the largest has %.0f %% of its voxels; use "
                        "--keep largest, --keep all or --split",
                        pieces, 100 * (1 - rest));
    dem_log(ctx, DEM_LOG_WARNING, "dropped %zu piece%s apart from the largest, %.2g %% of the voxels", pieces - 1,
            pieces == 2 ? "" : "s", 100 * rest);
    clear_others(w, v, largest);
    return DEM_OK;
}

dem_status dem_voxels_keep(const dem_ctx *ctx, dem_voxels *voxels, dem_keep keep, dem_error *error)
{
    piece_work w = {0};
    dem_status status = find_runs(&w, voxels) ? choose(ctx, &w, voxels, keep, error) : dem_fail_memory(error);
    free(w.runs);
    free(w.rows);
    free(w.voxels);
    return status;
}
