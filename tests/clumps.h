/// A clump for tests with a value of its own in every field.
#ifndef DEM_TESTS_CLUMPS_H
#define DEM_TESTS_CLUMPS_H

#include "check.h"

#include "math/vec.h"

enum { SAMPLE_BALLS = 3 };

/// Three balls in a row and a tetrahedron; its pointers are to constants.
static inline dem_clump_def sample_clump(void)
{
    static const dem_ball balls[SAMPLE_BALLS] = {
        {{-0.0, 1.0 / 3, 1e-9}, 0.5}, {{0.6, 0.1, -0.2}, 0.4}, {{-0.7, 0, 123456789.0 / (1 << 30)}, 1.0 / 7}};
    static dem_vec3 vertices[4] = {{0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}, {0, 0, 2.0 / 3}};
    static uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    return (dem_clump_def){
        .name = "grain \"7\" µ",
        .source_mesh = "scans/grain 7.stl",
        .source_sha256 = "00ff",
        .source_unit = "mm",
        .density = 2650,
        .mass = 2650 * 0.7,
        .volume = 0.7,
        .inertia = {0.1, 0.2, 0.3 - 1e-17},
        .mass_from = DEM_MASS_FROM_UNION,
        .position = {1e6, -2, 3},
        .orientation = {0.6, 0, 0.8, 0},
        .union_volume = 0.71,
        .union_centre = {1e-3, 2e-3, 3e-3},
        .union_inertia = {0.11, 0.21, 0.29},
        .balls = balls,
        .ball_count = SAMPLE_BALLS,
        .surface = {.vertices = vertices, .triangles = triangles, .vertex_count = 4, .triangle_count = 4},
        .fidelity = {0.05, -0.01, 0.02, 0.1, 0.06, 1e-9, 1e-10, 12.5, 2.5, 1},
        .shape = {1.1, 2, 1.5, 1, 0.75, 2.0 / 3, 0.9, 0.95, 0.6, 0.3},
        .method = "optimal",
        .parameters = "{ \"spheres\": 50, \"gap\": 0.1 }",
        .seed = UINT64_MAX - 5,
        .seconds = 0.25,
        .version = "0.1.0"};
}

/// Equal in every bit.
static inline void check_same_clump(const dem_clump *a, const dem_clump *b)
{
    check(dem_clump_bytes(a) == dem_clump_bytes(b));
    assert_memory_equal(a, b, dem_clump_bytes(a));
}

static inline dem_clump *made_clump(const dem_clump_def *def)
{
    dem_clump *clump;
    dem_error error;
    check_ok(dem_clump_create(def, &clump, &error), error);
    return clump;
}

#endif
