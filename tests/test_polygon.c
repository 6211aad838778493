#include "check.h"

#include "base/memory.h"
#include "base/random.h"
#include "math/vec.h"
#include "mesh/polygon.h"

enum { MOST = 5000 };

typedef struct cut {
    dem_vec3 vertices[MOST];
    uint32_t corners[MOST], triangles[3 * MOST];
    dem_polygon_work work;
} cut;

// cuts the polygon of the first `count` vertices
static dem_status split(cut *c, size_t count)
{
    for (size_t i = 0; i < count; i++)
        c->corners[i] = (uint32_t)i;
    return dem_polygon_split(&c->work, c->vertices, c->corners, count, c->triangles);
}

static double area_along(const cut *c, size_t triangle, dem_vec3 normal)
{
    const uint32_t *t = c->triangles + 3 * triangle;
    dem_vec3 a = c->vertices[t[0]];
    return 0.5 * v3_dot(v3_cross(v3_sub(c->vertices[t[1]], a), v3_sub(c->vertices[t[2]], a)), normal);
}

// all triangles face along `normal` with more than nothing, and fill `area`: a valid triangulation
static void check_fills(const cut *c, size_t count, dem_vec3 normal, double area)
{
    double sum = 0, least = INFINITY;
    for (size_t i = 0; i < count - 2; i++) {
        double one = area_along(c, i, normal);
        sum += one;
        least = fmin(least, one);
    }
    check(least > 1e-10 * area);
    check_close(sum, area, 1e-12);  // rounding of a few thousand terms
}

// every side once in its own direction, every diagonal once in each
static void check_sides(const cut *c, size_t count)
{
    int8_t *seen = dem_alloc_zero(count * count, 1);
    assert_non_null(seen);
    for (size_t i = 0; i < 3 * (count - 2); i++) {
        size_t from = c->triangles[i], to = c->triangles[i % 3 == 2 ? i - 2 : i + 1];
        seen[from * count + to]++;
        seen[to * count + from]--;
    }
    for (size_t i = 0; i < count * count; i++)
        if (seen[i] != (i % count == (i / count + 1) % count) - (i / count == (i % count + 1) % count))
            fail_msg("side %zu-%zu is used %d times", i / count, i % count, seen[i]);
    free(seen);
}

static int set_up(void **state)
{
    *state = dem_alloc_zero(1, sizeof(cut));
    return *state ? 0 : -1;
}

static int tear_down(void **state)
{
    cut *c = *state;
    dem_polygon_work_release(&c->work);
    free(c);
    return 0;
}

// an L of area 3 in any plane, at any scale, far from the origin
static void a_concave_polygon_is_filled_in_its_own_plane(void **state)
{
    cut *c = *state;
    static const double l[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    dem_random r = random_stream(1, 0);
    for (int trial = 0; trial < 300; trial++) {
        dem_vec3 n = v3_unit(v3(random_normal(&r), random_normal(&r), random_normal(&r)));
        dem_vec3 u = v3_normal_to(n), v = v3_cross(n, u);
        double size = pow(10, 18 * (random_uniform(&r) - 0.5));
        dem_vec3 origin = v3_scale(v3(random_normal(&r), random_normal(&r), random_normal(&r)), 1000 * size);
        for (size_t i = 0; i < 6; i++)
            c->vertices[i] = v3_along(v3_along(origin, size * l[(i + (size_t)trial) % 6][0], u),
                                      size * l[(i + (size_t)trial) % 6][1], v);
        check(split(c, 6) == DEM_OK);
        double sum = 0;
        for (size_t i = 0; i < 4; i++) {
            check(area_along(c, i, n) > 0.1 * size * size);
            sum += area_along(c, i, n);
        }
        check_close(sum, 3 * size * size, 1e-11);  // coordinates a thousand sizes away: 1e-13 each
        check_sides(c, 6);
    }
}

static void a_quad_is_cut_as_other_programs_cut_it(void **state)
{
    cut *c = *state;
    static const dem_vec3 warped[4] = {{0, 0, 0}, {1, 0, 0.2}, {1, 1, 0}, {0, 1, 0.2}};
    memcpy(c->vertices, warped, sizeof warped);
    check(split(c, 4) == DEM_OK);
    assert_memory_equal(c->triangles, ((uint32_t[]){0, 1, 2, 0, 2, 3}), 6 * sizeof(uint32_t));
}

static void a_concave_quad_is_cut_from_its_inner_corner(void **state)
{
    cut *c = *state;
    static const dem_vec3 arrow[4] = {{0, 0, 0}, {4, 2, 0}, {0, 4, 0}, {1, 2, 0}};
    for (size_t turn = 0; turn < 4; turn++) {
        for (size_t i = 0; i < 4; i++)
            c->vertices[i] = arrow[(i + turn) % 4];
        check(split(c, 4) == DEM_OK);
        check_fills(c, 4, v3(0, 0, 1), 6);
    }
}

static void corners_on_a_straight_side_make_no_flat_triangles(void **state)
{
    cut *c = *state;
    // a triangle with every side divided in five
    static const dem_vec3 ends[3] = {{0, 0, 1}, {5, 0, 1}, {0, 5, 1}};
    for (size_t shift = 0; shift < 15; shift++) {
        for (size_t i = 0; i < 15; i++) {
            size_t k = (i + shift) % 15;
            dem_vec3 a = ends[k / 5], b = ends[(k / 5 + 1) % 3];
            c->vertices[i] = v3_along(a, (double)(k % 5) / 5, v3_sub(b, a));
        }
        check(split(c, 15) == DEM_OK);
        check_fills(c, 15, v3(0, 0, 1), 12.5);
        check_sides(c, 15);
    }
}

// star-shaped about the origin, radii at random: simple, mostly concave
static void random_polygons_are_filled_exactly(void **state)
{
    cut *c = *state;
    dem_random r = random_stream(2, 0);
    for (size_t count = 5; count < 400; count += 13) {
        double area = 0;
        for (size_t i = 0; i < count; i++) {
            double angle = 2 * DEM_PI * (double)i / (double)count, radius = 0.2 + random_uniform(&r);
            c->vertices[i] = v3(0.5, radius * cos(angle), radius * sin(angle));
        }
        for (size_t i = 0; i < count; i++)
            area += 0.5 * v3_cross(c->vertices[i], c->vertices[(i + 1) % count]).x;
        check(split(c, count) == DEM_OK);
        check_fills(c, count, v3(1, 0, 0), area);
        check_sides(c, count);
    }
}

// a spiral corridor: nearly all corners of its inner walls are reflex
static void a_spiral_of_thousands_of_corners_is_filled(void **state)
{
    cut *c = *state;
    size_t half = 2000, count = 2 * half;
    for (size_t i = 0; i < half; i++) {
        double angle = 0.02 * (double)i, radius = 3 + angle;
        c->vertices[i] = v3(radius * cos(angle), radius * sin(angle), 0);
        c->vertices[count - 1 - i] = v3((radius - 2) * cos(angle), (radius - 2) * sin(angle), 0);
    }
    double area = 0;
    for (size_t i = 0; i < count; i++)
        area += 0.5 * v3_cross(c->vertices[i], c->vertices[(i + 1) % count]).z;
    check(split(c, count) == DEM_OK);
    check_fills(c, count, v3(0, 0, 1), area);
    check_sides(c, count);
}

static void garbage_still_gives_triangles_of_its_own_corners(void **state)
{
    cut *c = *state;
    dem_random r = random_stream(3, 0);
    for (int trial = 0; trial < 400; trial++) {
        size_t count = 4 + random_below(&r, 60);
        for (size_t i = 0; i < count; i++) {
            double flat = trial % 3 ? random_normal(&r) : 0, wide = trial % 5 ? 1 : 1e200;
            c->vertices[i] = v3(wide * random_normal(&r), trial % 7 ? wide * random_normal(&r) : 0, flat);
            if (i && trial % 4 == 0 && random_uniform(&r) < 0.3)
                c->vertices[i] = c->vertices[random_below(&r, i)];
        }
        memset(c->triangles, 0xff, sizeof c->triangles);
        check(split(c, count) == DEM_OK);
        for (size_t i = 0; i < 3 * (count - 2); i++)
            check(c->triangles[i] < count);
        check(c->triangles[3 * (count - 2)] == UINT32_MAX);
        check_sides(c, count);
    }
}

static void only_huge_concave_polygons_are_refused(void **state)
{
    cut *c = *state;
    size_t count = DEM_POLYGON_MOST_CORNERS + 1;
    for (int concave = 0; concave < 2; concave++) {
        for (size_t i = 0; i < count; i++) {
            double angle = 2 * DEM_PI * (double)i / (double)count, radius = concave && i % 2 ? 0.9 : 1;
            c->vertices[i] = v3(radius * cos(angle), radius * sin(angle), 0);
        }
        check(split(c, count) == (concave ? DEM_BAD_INPUT : DEM_OK));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_concave_polygon_is_filled_in_its_own_plane),
        cmocka_unit_test(a_quad_is_cut_as_other_programs_cut_it),
        cmocka_unit_test(a_concave_quad_is_cut_from_its_inner_corner),
        cmocka_unit_test(corners_on_a_straight_side_make_no_flat_triangles),
        cmocka_unit_test(random_polygons_are_filled_exactly),
        cmocka_unit_test(a_spiral_of_thousands_of_corners_is_filled),
        cmocka_unit_test(garbage_still_gives_triangles_of_its_own_corners),
        cmocka_unit_test(only_huge_concave_polygons_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
