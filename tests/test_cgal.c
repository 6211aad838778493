#include "shapes.h"

#include "mesh/cgal.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hull_of_a_grain_with_a_dent_is_convex_and_holds_it),
        cmocka_unit_test(the_hull_of_a_box_is_the_box_at_any_scale),
        cmocka_unit_test(a_flat_mesh_has_no_hull),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
