#include "check.h"
#include "shapes.h"

#include "geom/tree.h"
#include "mesh/decimate.h"
#include "mesh/edges.h"

static void a_decimated_surface_has_the_volume_and_the_centre_at_any_scale(void **state)
{
    (void)state;
    for (int k = -9; k <= 9; k += 9) {
        double s = pow(10, k);
        dem_mesh grain = shape_grain(25), few;
        shape_scale(&grain, s, s, s);
        dem_error error;
        check_ok(dem_mesh_decimate(&grain, 1000, &few, &error), error);
        check(few.triangle_count == 1000);
        dem_solid want = dem_mesh_solid(&grain), got = dem_mesh_solid(&few);
        check_close(got.volume, want.volume, 1e-12);
        check_vec(v3_scale(got.centre, 1 / s), v3_scale(want.centre, 1 / s), 1e-3);
        dem_mesh_free(&few);
        dem_mesh_free(&grain);
    }
}

static void a_coarse_mesh_is_copied_and_a_huge_one_thinned_first(void **state)
{
    (void)state;
    dem_mesh box = shape_box(1, 2, 3), copy, huge = shape_grain(90), few;
    dem_error error;
    check_ok(dem_mesh_decimate(&box, 1000, &copy, &error), error);
    check(copy.triangle_count == 12 && copy.vertices != box.vertices);
    check_ok(dem_mesh_decimate(&huge, 500, &few, &error), error);
    check(huge.triangle_count > 60000 && few.triangle_count <= 500);
    check_close(dem_mesh_solid(&few).volume, dem_mesh_solid(&huge).volume, 0.01);
    dem_mesh_free(&box);
    dem_mesh_free(&copy);
    dem_mesh_free(&huge);
    dem_mesh_free(&few);
}

// closed, without folds, and near: a grain of 5000 triangles with a tenth of them
static void a_decimated_surface_is_closed_and_near(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(25), few;
    dem_error error;
    dem_edges edges = {0};
    dem_tree tree;
    check_ok(dem_mesh_decimate(&grain, 500, &few, &error), error);
    check_ok(dem_edges_build(&edges, &few, &error), error);
    check(edges.border == 0 && edges.many == 0 && edges.duplicates == 0);
    check(few.triangle_count == 2 * few.vertex_count - 4);
    check_ok(dem_tree_build(&tree, grain.vertices, grain.triangles, grain.triangle_count, &error), error);
    double size = cbrt(6 * dem_mesh_solid(&grain).volume / DEM_PI), farthest = 0;
    for (size_t i = 0; i < few.vertex_count; i++)
        farthest = fmax(farthest, dem_tree_closest(&tree, few.vertices[i], INFINITY, NULL, NULL));
    check(farthest < 0.01 * size);  // the length of an edge is some .15 of it
    double area = 0;
    for (size_t t = 0; t < few.triangle_count; t++) {
        dem_vec3 p[3];
        for (int k = 0; k < 3; k++)
            p[k] = few.vertices[few.triangles[3 * t + (size_t)k]];
        area += v3_norm(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]))) / 2;
    }
    check_close(area, dem_mesh_solid(&grain).area, 0.02);  // folds would add to it
    dem_tree_release(&tree);
    dem_edges_release(&edges);
    dem_mesh_free(&few);
    dem_mesh_free(&grain);
}

// a ring keeps its hole
static void a_ring_is_not_pinched(void **state)
{
    (void)state;
    enum { ROUND = 40, TUBE = 10 };
    dem_vec3 vertices[ROUND * TUBE];
    uint32_t triangles[2 * ROUND * TUBE * 3], *t = triangles;
    for (uint32_t i = 0; i < ROUND; i++)
        for (uint32_t j = 0; j < TUBE; j++) {
            double a = 2 * DEM_PI * i / ROUND, b = 2 * DEM_PI * j / TUBE, r = 1 + 0.3 * cos(b);
            uint32_t i1 = (i + 1) % ROUND, j1 = (j + 1) % TUBE;
            vertices[i * TUBE + j] = v3(r * cos(a), r * sin(a), 0.3 * sin(b));
            uint32_t corners[4] = {i * TUBE + j, i1 * TUBE + j, i1 * TUBE + j1, i * TUBE + j1};
            for (int k = 0; k < 6; k++)
                *t++ = corners[(const int[6]){0, 1, 2, 0, 2, 3}[k]];
        }
    dem_mesh ring = shape_copy(vertices, ROUND * TUBE, triangles, 2 * ROUND * TUBE), few;
    dem_error error;
    dem_edges edges = {0};
    check_ok(dem_mesh_decimate(&ring, 100, &few, &error), error);
    check_ok(dem_edges_build(&edges, &few, &error), error);
    check(edges.border == 0 && edges.many == 0 && edges.duplicates == 0);
    check(few.triangle_count == 2 * few.vertex_count && few.triangle_count <= 100);
    check_close(dem_mesh_solid(&few).volume, dem_mesh_solid(&ring).volume, 1e-12);
    dem_edges_release(&edges);
    dem_mesh_free(&few);
    dem_mesh_free(&ring);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_decimated_surface_has_the_volume_and_the_centre_at_any_scale),
        cmocka_unit_test(a_coarse_mesh_is_copied_and_a_huge_one_thinned_first),
        cmocka_unit_test(a_decimated_surface_is_closed_and_near),
        cmocka_unit_test(a_ring_is_not_pinched),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
