/// Writes a CT scan as it might be after segmentation: bench_scan SIZE GRAINS FILE.nrrd, SIZE^3 voxels of uint16 with
/// GRAINS^3 wavy ellipsoids, some of which touch.
#include <stdio.h>
#include <stdlib.h>

#include "base/random.h"
#include "math/vec.h"

typedef struct lump {
    dem_vec3 centre, axes;
    double phase;
} lump;

static lump make_lump(size_t number, size_t grains, double pitch)
{
    dem_random r = random_stream(1, number);
    size_t x = number % grains, y = number / grains % grains, z = number / grains / grains;
    lump l = {.centre = {((double)x + 0.5) * pitch, ((double)y + 0.5) * pitch, ((double)z + 0.5) * pitch}};
    l.axes = (dem_vec3){pitch * (0.33 + 0.17 * random_uniform(&r)), pitch * (0.33 + 0.17 * random_uniform(&r)),
                        pitch * (0.33 + 0.17 * random_uniform(&r))};
    l.phase = 6 * random_uniform(&r);
    return l;
}

static bool is_in(const lump *l, double x, double y, double z, double pitch)
{
    dem_vec3 q = {(x - l->centre.x) / l->axes.x, (y - l->centre.y) / l->axes.y, (z - l->centre.z) / l->axes.z};
    double k = 6 / pitch;
    return v3_norm2(q) + 0.25 * sin(k * x + l->phase) * cos(k * y) * sin(k * z + 2 * l->phase) < 1;
}

int main(int argc, char **argv)
{
    size_t size = argc == 4 ? (size_t)atol(argv[1]) : 0, grains = argc == 4 ? (size_t)atol(argv[2]) : 0;
    FILE *file = size && grains ? fopen(argv[3], "wb") : NULL;
    uint16_t *slice = malloc(size * size * sizeof *slice + 1);
    lump *lumps = malloc(grains * grains * grains * sizeof *lumps + 1);
    if (!file || !slice || !lumps || grains * grains * grains > UINT16_MAX)
        return fprintf(stderr, "usage: bench_scan SIZE GRAINS FILE.nrrd\n"), 2;
    double pitch = (double)size / (double)grains;
    for (size_t i = 0; i < grains * grains * grains; i++)
        lumps[i] = make_lump(i, grains, pitch);
    fprintf(file,
            "NRRD0004\ntype: uint16\ndimension: 3\nsizes: %zu %zu %zu\nencoding: raw\nendian: little\n"
            "space directions: (5,0,0) (0,5,0) (0,0,5)\nspace origin: (0,0,0)\nspace units: \"um\" \"um\" \"um\"\n\n",
            size, size, size);
    for (size_t z = 0; z < size; z++) {
        for (size_t y = 0; y < size; y++)
            for (size_t x = 0; x < size; x++) {
                size_t a = (size_t)((double)x / pitch), b = (size_t)((double)y / pitch),
                       c = (size_t)((double)z / pitch);
                size_t number = (c * grains + b) * grains + a;
                bool in = is_in(&lumps[number], (double)x, (double)y, (double)z, pitch);
                slice[y * size + x] = in ? (uint16_t)(number + 1) : 0;
            }
        fwrite(slice, sizeof *slice, size * size, file);
    }
    return fclose(file) == 0 ? 0 : 4;
}
