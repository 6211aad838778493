#include "clump/pack_lattice.h"

#include <stdlib.h>
#include <string.h>

// spheres may stick out this far and still be counted in full [d_eq]
static const double margin = 0.1;
// the place of the lattice against the grain: generic, so that no flat face lies in a lattice plane
static const double offsets[3] = {0.2718, 0.3141, 0.5};

// word range of each row: from the rows around it, so that balls sticking out sideways are counted as well
static dem_status set_words(dem_lattice *lattice, double high_x, dem_error *error)
{
    const dem_columns *c = &lattice->rows;
    size_t rows = columns_lines(c);
    int32_t last = (int32_t)floor((high_x + margin - lattice->origin) / c->step) >> 6;
    lattice->first = dem_alloc(rows, sizeof *lattice->first);
    lattice->word = dem_alloc_zero(rows + 1, sizeof *lattice->word);
    if (!lattice->first || !lattice->word)
        return dem_fail_memory(error);
    for (size_t l = 0; l < rows; l++) {
        int32_t from = 0, to = last;
        if (c->start[l] < c->start[l + 1]) {
            from = (int32_t)floor((c->crossing[c->start[l]] - 2 * margin - lattice->origin) / c->step) >> 6;
            to = (int32_t)floor((c->crossing[c->start[l + 1] - 1] + 2 * margin - lattice->origin) / c->step) >> 6;
            from = from < 0 ? 0 : from;
            to = to > last ? last : to;
        }
        lattice->first[l] = from;
        lattice->word[l + 1] = lattice->word[l] + (uint32_t)(to - from + 1);
    }
    return DEM_OK;
}

static void set_inside(dem_lattice *lattice, size_t row)
{
    const dem_columns *c = &lattice->rows;
    for (uint32_t k = c->start[row]; k < c->start[row + 1]; k += 2) {
        int32_t i0 = (int32_t)ceil((c->crossing[k] - lattice->origin) / c->step);
        int32_t i1 = (int32_t)ceil((c->crossing[k + 1] - lattice->origin) / c->step) - 1;
        if (i1 < i0)
            continue;
        for (int32_t w = i0 >> 6; w <= i1 >> 6; w++)
            lattice->inside[lattice->word[row] + (uint32_t)(w - lattice->first[row])] |= lattice_mask(w, i0, i1);
        lattice->inside_count += (size_t)(i1 - i0 + 1);
    }
}

dem_status dem_lattice_build(const dem_pack_grain *grain, size_t points, dem_lattice *lattice, dem_error *error)
{
    *lattice = (dem_lattice){0};
    double step = cbrt(grain->moments.volume / (double)points);
    dem_status status = dem_columns_build(grain, 0, step, margin, offsets + 1, &lattice->rows, error);
    if (status != DEM_OK)
        return status;
    lattice->origin = grain->box.low.x - margin - offsets[0] * step;
    status = set_words(lattice, grain->box.high.x, error);
    if (status == DEM_OK) {
        size_t rows = columns_lines(&lattice->rows);
        lattice->inside = dem_alloc_zero(lattice->word[rows], sizeof *lattice->inside);
        lattice->covered = dem_alloc_zero(lattice->word[rows], sizeof *lattice->covered);
        if (!lattice->inside || !lattice->covered)
            status = dem_fail_memory(error);
        else
            for (size_t l = 0; l < rows; l++)
                set_inside(lattice, l);
    }
    if (status != DEM_OK)
        dem_lattice_release(lattice);
    return status;
}

void dem_lattice_release(dem_lattice *lattice)
{
    dem_columns_release(&lattice->rows);
    free(lattice->first);
    free(lattice->word);
    free(lattice->inside);
    free(lattice->covered);
    *lattice = (dem_lattice){0};
}

void dem_lattice_clear(dem_lattice *lattice)
{
    memset(lattice->covered, 0, lattice->word[columns_lines(&lattice->rows)] * sizeof *lattice->covered);
}

size_t dem_lattice_sample(const dem_lattice *lattice, size_t count, dem_vec3 *points)
{
    const dem_columns *c = &lattice->rows;
    size_t written = 0;
    double share = (double)count / (double)lattice->inside_count, due = 0.5;
    for (int32_t j = 0; j < c->row_count; j++)
        for (uint32_t l = c->line[j]; l < c->line[j + 1]; l++)
            for (uint32_t w = lattice->word[l]; w < lattice->word[l + 1]; w++)
                for (uint64_t bits = lattice->inside[w]; bits; bits &= bits - 1) {
                    due += share;
                    if (due < 1 || written == count)
                        continue;
                    due -= 1;
                    int32_t i = 64 * (lattice->first[l] + (int32_t)(w - lattice->word[l])) + __builtin_ctzll(bits);
                    points[written++] = v3(lattice->origin + i * c->step,
                                           c->origin[0] + (c->first[j] + (int32_t)(l - c->line[j])) * c->step,
                                           c->origin[1] + j * c->step);
                }
    return written;
}
