#include "shapes.h"

#include "base/random.h"
#include "mesh/crossings.h"

static bool cross(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 d, dem_vec3 e, dem_vec3 f)
{
    dem_vec3 vertices[6] = {a, b, c, d, e, f};
    uint32_t triangles[6] = {0, 1, 2, 3, 4, 5};
    // equal places are one vertex, as after welding
    for (int i = 1; i < 6; i++)
        for (int k = 0; k < i; k++)
            if (memcmp(&vertices[i], &vertices[k], sizeof a) == 0) {
                triangles[i] = (uint32_t)k;
                break;
            }
    dem_mesh mesh = {.vertices = vertices, .triangles = triangles, .vertex_count = 6, .triangle_count = 2};
    bool there = dem_triangles_cross(&mesh, 0, 1), back = dem_triangles_cross(&mesh, 1, 0);
    check(there == back);
    return there;
}

static void triangles_that_pierce_touch_or_overlap_cross(void **state)
{
    (void)state;
    dem_vec3 a = v3(0, 0, 0), b = v3(4, 0, 0), c = v3(0, 4, 0);
    check(cross(a, b, c, v3(1, 1, -1), v3(1, 1, 1), v3(3, 3, 1)));           // pierced by an edge
    check(cross(a, b, c, v3(1, 1, 0), v3(1, 2, 5), v3(2, 1, 5)));            // touched by a corner inside
    check(cross(a, b, c, v3(2, 0, 0), v3(2, -3, 1), v3(2, -3, -1)));         // touched by a corner on an edge
    check(cross(a, b, c, v3(1, -1, 0), v3(1, 1, 0), v3(-5, 0, 3)));          // an edge lies across in the plane
    check(cross(a, b, c, v3(1, 1, 0), v3(2, 1, 0), v3(1, 2, 0)));            // one inside the other, same plane
    check(cross(a, b, c, v3(-1, 1, 0), v3(9, 1, 0), v3(-1, 2, 0)));          // edges cross in the same plane
    check(cross(a, b, c, v3(1, 0, 0), v3(3, 0, 0), v3(2, -1, 0)));           // part of an edge in common
}

static void triangles_apart_do_not_cross(void **state)
{
    (void)state;
    dem_vec3 a = v3(0, 0, 0), b = v3(4, 0, 0), c = v3(0, 4, 0);
    double tiny = 0x1p-1000;
    check(!cross(a, b, c, v3(1, 1, tiny), v3(1, 2, 5), v3(2, 1, 5)));
    check(!cross(a, b, c, v3(3, 3, -1), v3(3, 3, 1), v3(9, 9, 0)));          // plane pierced outside
    check(!cross(a, b, c, v3(5, 0, 0), v3(9, 0, 0), v3(7, 3, 0)));           // same plane, apart
    check(!cross(a, b, c, v3(5, 0, 0), v3(9, 0, 0), v3(7, -3, 1)));          // in line with an edge, apart
    check(!cross(a, b, c, v3(2.5, 2.5, -1), v3(2.5, 2.5, 1), v3(8, 9, 0)));
}

static void neighbours_cross_only_beyond_what_they_share(void **state)
{
    (void)state;
    dem_vec3 a = v3(0, 0, 0), b = v3(4, 0, 0), c = v3(0, 4, 0);
    check(!cross(a, b, c, a, b, v3(0, -4, 0)));         // across an edge, flat
    check(!cross(a, b, c, b, a, v3(1, 1, 1)));          // folded up
    check(cross(a, b, c, b, a, v3(1, 1, 0)));           // folded flat onto it
    check(!cross(a, b, c, a, v3(-1, 0, 0), v3(0, -1, 0)));
    check(!cross(a, b, c, a, v3(-1, 3, 1), v3(3, -1, 2)));
    check(cross(a, b, c, a, v3(1, 1, -1), v3(1, 1, 1)));           // its far side pierces
    check(cross(a, b, c, a, v3(9, 9, -1), v3(9, 9, 1)));           // the other's far side pierces
    check(cross(a, b, c, a, v3(1, 2, 0), v3(2, 1, 0)));            // in the same plane, same sector
    check(cross(a, b, c, a, v3(2, 0, 0), v3(0, -1, 3)));           // along half of an edge
}

static void the_tree_finds_what_all_pairs_find(void **state)
{
    (void)state;
    enum { COUNT = 600 };
    dem_random r = random_stream(5, 0);
    for (int round = 0; round < 6; round++) {
        dem_vec3 vertices[3 * COUNT];
        uint32_t triangles[3 * COUNT];
        // small whole numbers: touching, coplanar and degenerate triangles abound; neighbours share vertices
        for (uint32_t i = 0; i < 3 * COUNT; i++) {
            double x = (double)random_below(&r, 9), y = (double)random_below(&r, 9), z = (double)random_below(&r, 9);
            vertices[i] = round % 2 ? v3(x, y, z) : v3(x + random_uniform(&r), y + random_uniform(&r), z);
            triangles[i] = i % 3 && random_below(&r, 3) == 0 ? (uint32_t)random_below(&r, i + 1) : i;
        }
        dem_mesh mesh = {.vertices = vertices, .triangles = triangles, .vertex_count = 3 * COUNT, .triangle_count = COUNT};
        for (uint32_t t = 0; t < COUNT; t++)
            for (int k = 0; k < 3; k++)
                if (triangles[3 * t + (uint32_t)k] == triangles[3 * t + (uint32_t)(k + 1) % 3])
                    triangles[3 * t + (uint32_t)k] = 3 * t + (uint32_t)k;
        dem_tree tree;
        dem_error error;
        dem_crossings found;
        check_ok(dem_tree_build(&tree, vertices, triangles, COUNT, &error), error);
        check_ok(dem_mesh_crossings(NULL, &mesh, &tree, SIZE_MAX, &found, &error), error);
        size_t want = 0;
        for (uint32_t i = 0; i < COUNT; i++)
            for (uint32_t k = 0; k < i; k++) {
                dem_vec3 n[2];
                for (int side = 0; side < 2; side++) {
                    const uint32_t *t = triangles + 3 * (side ? k : i);
                    n[side] = v3_cross(v3_sub(vertices[t[1]], vertices[t[0]]), v3_sub(vertices[t[2]], vertices[t[0]]));
                }
                want += v3_norm2(n[0]) > 0 && v3_norm2(n[1]) > 0 && dem_triangles_cross(&mesh, i, k);
            }
        check(found.complete && found.count == want && want > 100);
        for (int threads = 1; threads <= 3; threads++) {
            dem_crossings again;
            check_ok(dem_mesh_crossings(&(dem_ctx){.threads = threads}, &mesh, &tree, SIZE_MAX, &again, &error), error);
            check(again.count == want && memcmp(again.pairs, found.pairs, want * sizeof *found.pairs) == 0);
            free(again.pairs);
        }
        free(found.pairs);
        // and stops where it is told to
        check_ok(dem_mesh_crossings(NULL, &mesh, &tree, 10, &found, &error), error);
        check(!found.complete && found.count > 10 && found.count < want);
        free(found.pairs);
        dem_tree_release(&tree);
    }
}

static void a_clean_grain_does_not_cross_itself_and_two_interlocked_ones_do(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(12), other = shape_grain(12);
    for (int k = 0; k < 2; k++) {
        dem_tree tree;
        dem_error error;
        dem_crossings found;
        check_ok(dem_tree_build(&tree, grain.vertices, grain.triangles, grain.triangle_count, &error), error);
        check_ok(dem_mesh_crossings(NULL, &grain, &tree, SIZE_MAX, &found, &error), error);
        check(k == 0 ? found.count == 0 : found.count > 20);
        for (size_t i = 0; i < found.count; i++)
            check((found.pairs[i][0] < 1152) != (found.pairs[i][1] < 1152));
        free(found.pairs);
        dem_tree_release(&tree);
        shape_move(&other, (dem_quat){1, 0, 0, 0}, v3(0.9, 0.1, 0.05));
        shape_append(&grain, &other, 0, other.triangle_count);
    }
    dem_mesh_free(&grain);
    dem_mesh_free(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_that_pierce_touch_or_overlap_cross),
        cmocka_unit_test(triangles_apart_do_not_cross),
        cmocka_unit_test(neighbours_cross_only_beyond_what_they_share),
        cmocka_unit_test(the_tree_finds_what_all_pairs_find),
        cmocka_unit_test(a_clean_grain_does_not_cross_itself_and_two_interlocked_ones_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
