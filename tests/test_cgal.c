#include "shapes.h"

#include "mesh/cgal.h"
#include "mesh/decimate.h"

static void the_hull_of_a_grain_with_a_dent_is_convex_and_holds_it(void **state)
{
    (void)state;
    if (!DEM_CGAL)
        skip();
    dem_mesh mesh = shape_sphere(12), hull;
    for (size_t i = 0; i < mesh.vertex_count; i++)
        if (mesh.vertices[i].z > 0.8)
            mesh.vertices[i].z = 1.6 - mesh.vertices[i].z;
    dem_error error;
    check_ok(dem_mesh_hull(&mesh, &hull, &error), error);
    check(hull.triangle_count == 2 * hull.vertex_count - 4);
    for (size_t i = 0; i < hull.triangle_count; i++) {
        const uint32_t *t = hull.triangles + 3 * i;
        dem_vec3 a = hull.vertices[t[0]];
        dem_vec3 n = v3_unit(v3_cross(v3_sub(hull.vertices[t[1]], a), v3_sub(hull.vertices[t[2]], a)));
        for (size_t k = 0; k < mesh.vertex_count; k++)
            check(v3_dot(n, v3_sub(mesh.vertices[k], a)) < 1e-14);
    }
    check(dem_mesh_solid(&hull).volume > dem_mesh_solid(&mesh).volume);
    dem_mesh_free(&hull);
    dem_mesh_free(&mesh);
}

static void the_hull_of_a_box_is_the_box_at_any_scale(void **state)
{
    (void)state;
    if (!DEM_CGAL)
        skip();
    for (int k = -9; k <= 9; k += 9) {
        double s = pow(10, k);
        dem_mesh box = shape_box(3 * s, 2 * s, s), hull;
        dem_error error;
        check_ok(dem_mesh_hull(&box, &hull, &error), error);
        check(hull.vertex_count == 8 && hull.triangle_count == 12);
        check_close(dem_mesh_solid(&hull).volume, 6 * s * s * s, 1e-14);
        dem_mesh_free(&hull);
        dem_mesh_free(&box);
    }
}

static void a_flat_mesh_has_no_hull(void **state)
{
    (void)state;
    dem_mesh plate = shape_box(1, 1, 0), hull;
    dem_error error;
    check(dem_mesh_hull(&plate, &hull, &error) == (DEM_CGAL ? DEM_BAD_INPUT : DEM_UNAVAILABLE));
    check(!hull.vertices && strlen(error.text) > 20);
    dem_mesh_free(&plate);
}

static void decimation_keeps_volume_and_scale(void **state)
{
    (void)state;
    for (int k = -9; k <= 9; k += 9) {
        double s = pow(10, k);
        dem_mesh grain = shape_grain(25), few;
        shape_scale(&grain, s, s, s);
        dem_error error;
        check_ok(dem_mesh_decimate(&grain, 1000, &few, &error), error);
        check(few.triangle_count > 500 && few.triangle_count < 1500);
        dem_solid want = dem_mesh_solid(&grain), got = dem_mesh_solid(&few);
        check_close(got.volume, want.volume, DEM_CGAL ? 1e-10 : 0.03);
        check_vec(v3_scale(got.centre, 1 / s), v3_scale(want.centre, 1 / s), DEM_CGAL ? 1e-3 : 0.03);
        if (DEM_CGAL)
            check(few.triangle_count == 1000);
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
    check(huge.triangle_count > 60000 && few.triangle_count <= (DEM_CGAL ? 500 : 800));
    check_close(dem_mesh_solid(&few).volume, dem_mesh_solid(&huge).volume, DEM_CGAL ? 0.01 : 0.05);
    dem_mesh_free(&box);
    dem_mesh_free(&copy);
    dem_mesh_free(&huge);
    dem_mesh_free(&few);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hull_of_a_grain_with_a_dent_is_convex_and_holds_it),
        cmocka_unit_test(the_hull_of_a_box_is_the_box_at_any_scale),
        cmocka_unit_test(a_flat_mesh_has_no_hull),
        cmocka_unit_test(decimation_keeps_volume_and_scale),
        cmocka_unit_test(a_coarse_mesh_is_copied_and_a_huge_one_thinned_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
