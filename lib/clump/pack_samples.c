#include "clump/pack_samples.h"

#include <stdlib.h>

// the number's digits in this base mirrored at the point (van der Corput 1935; two bases: Halton 1960)
static double radical_inverse(unsigned base, size_t number)
{
    double digit = 1, value = 0;
    for (; number; number /= base) {
        digit /= base;
        value += digit * (double)(number % base);
    }
    return value;
}

void dem_surface_spread(dem_corners_of *corners_of, const void *surface, size_t triangle_count, double area,
                        size_t point_count, dem_visit_point *visit, void *user)
{
    double passed = 0, share = area / (double)point_count;
    size_t next = 0;
    for (size_t t = 0; t < triangle_count && next < point_count; t++) {
        dem_vec3 c[3];
        corners_of(surface, t, c);
        dem_vec3 e1 = v3_sub(c[1], c[0]), e2 = v3_sub(c[2], c[0]), normal = v3_cross(e1, e2);
        passed += v3_norm(normal) / 2;
        // the last triangle takes what rounding left over
        double until = t + 1 == triangle_count ? INFINITY : passed;
        for (; next < point_count && ((double)next + 0.5) * share < until; next++) {
            double u = radical_inverse(2, next + 1), v = radical_inverse(3, next + 1);
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            visit(user, next, v3_along(v3_along(c[0], u, e1), v, e2), v3_unit(normal));
        }
    }
}

static void grain_corners(const void *surface, size_t triangle, dem_vec3 corners[3])
{
    dem_pack_grain_corners(surface, triangle, corners);
}

static void keep_point(void *user, size_t number, dem_vec3 point, dem_vec3 normal)
{
    (void)normal;
    ((dem_vec3 *)user)[number] = point;
}

// quickselect: points[begin, end) so that those before `middle` are not above it on the axis
static void split_points(dem_vec3 *points, size_t begin, size_t end, size_t middle, int axis)
{
    ptrdiff_t low = (ptrdiff_t)begin, high = (ptrdiff_t)end - 1, wanted = (ptrdiff_t)middle;
    while (low < high) {
        double pivot = v3_get(points[low + (high - low) / 2], axis);
        ptrdiff_t i = low, j = high;
        while (i <= j) {
            while (v3_get(points[i], axis) < pivot)
                i++;
            while (v3_get(points[j], axis) > pivot)
                j--;
            if (i <= j) {
                dem_vec3 swap = points[i];
                points[i++] = points[j];
                points[j--] = swap;
            }
        }
        if (wanted <= j)
            high = j;
        else if (wanted >= i)
            low = i;
        else
            return;
    }
}

// a k-d tree whose leaves are the blocks
static void sort_into_blocks(dem_vec3 *points, size_t begin, size_t end)
{
    if (end - begin <= DEM_BLOCK)
        return;
    dem_box box = box_empty();
    for (size_t i = begin; i < end; i++)
        box = box_with(box, points[i]);
    dem_vec3 size = v3_sub(box.high, box.low);
    int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    size_t middle = begin + (end - begin) / DEM_BLOCK / 2 * DEM_BLOCK;
    split_points(points, begin, end, middle, axis);
    sort_into_blocks(points, begin, middle);
    sort_into_blocks(points, middle, end);
}

static void fill_block(const dem_vec3 *points, double weight, dem_sample_block *block, dem_block_bound *bound)
{
    dem_box box = box_empty();
    for (int l = 0; l < DEM_BLOCK; l++) {
        block->x[l] = (float)points[l].x;
        block->y[l] = (float)points[l].y;
        block->z[l] = (float)points[l].z;
        block->weight[l] = (float)weight;
        box = box_with(box, points[l]);
    }
    dem_vec3 centre = v3_along(box.low, 0.5, v3_sub(box.high, box.low));
    double radius = 0;
    for (int l = 0; l < DEM_BLOCK; l++)
        radius = fmax(radius, v3_distance(points[l], centre));
    // wider than the rounding of a float at the far end of a long grain
    *bound = (dem_block_bound){(float)centre.x, (float)centre.y, (float)centre.z,
                               (float)(radius + 1e-6 * (1 + v3_norm(centre)))};
}

dem_status dem_samples_build(const dem_pack_grain *grain, const dem_lattice *lattice, size_t surface, size_t interior,
                             dem_samples *samples, dem_error *error)
{
    *samples = (dem_samples){0};
    surface -= surface % DEM_BLOCK;
    dem_vec3 *points = dem_alloc(surface + interior, sizeof *points);
    if (!points)
        return dem_fail_memory(error);
    dem_surface_spread(grain_corners, grain, grain->mesh->triangle_count, grain->area, surface, keep_point, points);
    interior = dem_lattice_sample(lattice, interior, points + surface);
    interior -= interior % DEM_BLOCK;
    sort_into_blocks(points, 0, surface);
    sort_into_blocks(points + surface, 0, interior);
    samples->surface_blocks = surface / DEM_BLOCK;
    samples->block_count = (surface + interior) / DEM_BLOCK;
    samples->blocks = dem_alloc(samples->block_count, sizeof *samples->blocks);
    samples->bounds = dem_alloc(samples->block_count, sizeof *samples->bounds);
    if (!samples->blocks || !samples->bounds) {
        free(points);
        dem_samples_release(samples);
        return dem_fail_memory(error);
    }
    for (size_t b = 0; b < samples->block_count; b++) {
        double weight = b < samples->surface_blocks ? grain->area / (double)surface
                                                    : grain->moments.volume / (double)interior;
        fill_block(points + b * DEM_BLOCK, weight, &samples->blocks[b], &samples->bounds[b]);
    }
    free(points);
    return DEM_OK;
}

void dem_samples_release(dem_samples *samples)
{
    free(samples->blocks);
    free(samples->bounds);
    *samples = (dem_samples){0};
}
