#include "shapes.h"

#include "base/random.h"

static dem_status wrap(dem_mesh *mesh, double detail, dem_mesh_report *report, dem_error *error)
{
    dem_repair_options options = {.repair = DEM_REPAIR_WRAP, .wrap_detail = detail};
    return dem_mesh_repair(NULL, mesh, &options, report, error);
}

static void a_wrapped_grain_is_not_blown_up(void **state)
{
    (void)state;
    if (!DEM_CGAL)
        skip();
    for (int k = -9; k <= 9; k += 9) {
        double s = pow(10, k);
        dem_mesh grain = shape_grain(15);
        shape_scale(&grain, s, s, s);
        double volume = dem_mesh_solid(&grain).volume;
        dem_mesh_report report;
        dem_error error;
        check_ok(wrap(&grain, 0.04, &report, &error), error);
        check(report.wrapped && report.bodies == 1);
        // its vertices lie on the grain: the facets of length 0.12 cut off 0.12^2 / 8 of the radius, and as much at its sides
        check_close(report.volume, volume, 4e-3);
        dem_mesh_free(&grain);
    }
}

static void a_large_hole_is_wrapped_as_if_it_were_filled(void **state)
{
    (void)state;
    if (!DEM_CGAL)
        skip();
    dem_mesh box = shape_box(1, 1, 1);
    memmove(box.triangles, box.triangles + 6, 30 * sizeof *box.triangles);
    box.triangle_count = 10;
    dem_mesh_report report;
    dem_error error;
    check_ok(wrap(&box, 0.08, &report, &error), error);
    check(report.holes_filled == 1 && report.warnings == 2);
    check_close(report.volume, 1.0, 0.02);
    dem_mesh_free(&box);
}

// a ball of triangles none of which touches another
static void loose_triangles_are_wrapped_with_balls_that_do_not_fall_between_them(void **state)
{
    (void)state;
    if (!DEM_CGAL)
        skip();
    dem_mesh sphere = shape_sphere(10), soup = {0};
    for (size_t t = 0; t < sphere.triangle_count; t++) {
        dem_vec3 p[3], middle = {0, 0, 0};
        for (size_t k = 0; k < 3; k++) {
            p[k] = sphere.vertices[sphere.triangles[3 * t + k]];
            middle = v3_along(middle, 1.0 / 3, p[k]);
        }
        for (size_t k = 0; k < 3; k++)
            p[k] = v3_along(middle, 0.7, v3_sub(p[k], middle));
        dem_mesh one = {.vertices = p, .triangles = (uint32_t[]){0, 1, 2}, .vertex_count = 3, .triangle_count = 1};
        shape_append(&soup, &one, 0, 1);
    }
    dem_mesh_report report;
    dem_error error;
    check_ok(wrap(&soup, 0.04, &report, &error), error);
    check_close(report.volume, 4 * DEM_PI / 3, 0.1);
    dem_mesh_free(&sphere);
    dem_mesh_free(&soup);
}

static void what_has_no_inside_is_refused_even_so(void **state)
{
    (void)state;
    dem_mesh plate = shape_box(2, 1, 0), line = shape_box(1, 0, 0);
    dem_mesh_report report;
    dem_error error;
    check(wrap(&plate, 0.1, &report, &error) == (DEM_CGAL ? DEM_BAD_INPUT : DEM_UNAVAILABLE));
    check(strstr(error.text, DEM_CGAL ? "encloses no volume" : "needs CGAL"));
    check(wrap(&line, 0.1, &report, &error) == DEM_BAD_INPUT);
    dem_mesh_free(&plate);
    dem_mesh_free(&line);
}

static void the_open_coral_is_wrapped(void **state)
{
    (void)state;
    if (!DEM_CGAL)
        skip();
    check_shared(SHARED_MESH("coral_mcap_open.obj"));
    dem_mesh coral;
    dem_error error;
    check_ok(dem_mesh_read(NULL, SHARED_MESH("coral_mcap_open.obj"), &coral, &error), error);
    dem_mesh_report report;
    check_ok(wrap(&coral, 0.02, &report, &error), error);
    check_close(report.volume, 0.00842, 0.1);  // of the surface with its hole filled
    dem_mesh_free(&coral);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wrapped_grain_is_not_blown_up),
        cmocka_unit_test(a_large_hole_is_wrapped_as_if_it_were_filled),
        cmocka_unit_test(loose_triangles_are_wrapped_with_balls_that_do_not_fall_between_them),
        cmocka_unit_test(what_has_no_inside_is_refused_even_so),
        cmocka_unit_test(the_open_coral_is_wrapped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
