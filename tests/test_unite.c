#include "shapes.h"

#include "base/random.h"
#include "geom/tree.h"

enum { SAMPLES = 40000 };

// volume of the points that the surface winds about, by sampling its box
static double winding_volume(const dem_mesh *mesh)
{
    dem_tree tree;
    dem_error error;
    check_ok(dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, &error), error);
    dem_box box = tree.nodes[0].box;
    dem_vec3 size = v3_sub(box.high, box.low);
    dem_random r = random_stream(1, 0);
    int inside = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double x = random_uniform(&r), y = random_uniform(&r), z = random_uniform(&r);
        inside += dem_tree_inside(&tree, v3_add(box.low, v3(x * size.x, y * size.y, z * size.z)));
    }
    dem_tree_release(&tree);
    return size.x * size.y * size.z * inside / SAMPLES;
}

static dem_mesh_report check_united(dem_mesh *mesh)
{
    dem_mesh_report report;
    dem_error error;
    check_ok(dem_mesh_repair(NULL, mesh, NULL, &report, &error), error);
    check(report.warnings >= 1 && report.self_intersections > 0);
    return report;
}

static dem_mesh two_boxes(dem_vec3 shift, double x, double y, double z)
{
    dem_mesh mesh = shape_box(1, 1, 1), other = shape_box(x, y, z);
    shape_move(&other, (dem_quat){1, 0, 0, 0}, shift);
    shape_append(&mesh, &other, 0, 12);
    dem_mesh_free(&other);
    return mesh;
}

static void two_boxes_that_overlap_are_united_exactly(void **state)
{
    (void)state;
    if (!DEM_CGAL)
        skip();
    const struct {
        dem_vec3 shift;
        double x, y, z, volume;
    } cases[] = {
        {{0.5, 0.25, 0.125}, 1, 1, 1, 2 - 0.5 * 0.75 * 0.875},  // corners in each other
        {{0.5, 0, 0}, 1, 1, 1, 1.5},                            // four sides in common planes
        {{0.25, 0.25, 0.5}, 0.5, 0.5, 2, 1 + 0.25 * 1.5},       // a post through the top
        {{0.25, 0.25, -0.5}, 0.5, 0.5, 2, 1 + 0.25},            // and right through
        {{1, 0.25, 0.25}, 1, 0.5, 0.5, 1.25},                   // side on side
        {{0, 0, 0}, 2, 1, 0.5, 1.5},                            // three common planes
        {{0.25, 0, 0.25}, 0.5, 1, 0.5, 1},                      // inside, touching two sides
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (int flip = 0; flip < 2; flip++) {
            dem_mesh mesh = two_boxes(cases[i].shift, cases[i].x, cases[i].y, cases[i].z);
            if (flip)
                shape_flip(&mesh, 0, 12);
            dem_mesh_report report = check_united(&mesh);
            check_close(report.volume, cases[i].volume, 1e-14);
            check(report.bodies == 1 && report.cavities == 0);
            dem_mesh_free(&mesh);
        }
}

static void overlapping_grains_have_the_volume_their_winding_numbers_say(void **state)
{
    (void)state;
    if (!DEM_CGAL)
        skip();
    dem_mesh mesh = shape_grain(9), other = shape_grain(9);
    for (int i = 0; i < 2; i++) {
        shape_move(&other, quat_unit((dem_quat){1, 0.3, 0.5 * i, -0.2}), v3(0.9, 0.1, 0.1 * i));
        shape_append(&mesh, &other, 0, other.triangle_count);
    }
    double want = winding_volume(&mesh), naive = dem_mesh_solid(&mesh).volume;
    dem_mesh_report report = check_united(&mesh);
    check_close(report.volume, want, 0.02);  // 3 standard deviations of the sampling are 0.016
    check(report.merged_shells == 3 && report.volume < 0.9 * naive);
    check_near(report.volume_change, (report.volume - naive) / report.volume, 1e-9);
    check_close(winding_volume(&mesh), report.volume, 0.02);
    dem_mesh_free(&mesh);
    dem_mesh_free(&other);
}

// a dent pressed through the other side: the surface winds about the bulge the wrong way round
static void a_surface_pressed_through_itself_has_the_volume_its_winding_numbers_say(void **state)
{
    (void)state;
    if (!DEM_CGAL)
        skip();
    dem_mesh mesh = shape_grain(9);
    for (size_t i = 0; i < mesh.vertex_count; i++)
        if (fabs(mesh.vertices[i].x) < 0.5 && mesh.vertices[i].z > 0.3)
            mesh.vertices[i].z -= 1.3;
    double want = winding_volume(&mesh), naive = dem_mesh_solid(&mesh).volume;
    dem_mesh_report report = check_united(&mesh);
    check_close(report.volume, want, 0.03);
    check(report.volume > 1.2 * naive && report.merged_shells == 0);
    dem_mesh_free(&mesh);
}

static void the_outline_does_not_depend_on_scale_or_place(void **state)
{
    (void)state;
    if (!DEM_CGAL)
        skip();
    double want = 0;
    for (int k = 0; k < 4; k++) {
        double s = k == 1 ? 1e-9 : k == 2 ? 1e9 : 1;
        dem_mesh mesh = shape_grain(7), other = shape_grain(7);
        shape_move(&other, (dem_quat){1, 0, 0, 0}, v3(0.7, 0.2, 0.1));
        shape_append(&mesh, &other, 0, other.triangle_count);
        if (k == 3)
            shape_move(&mesh, (dem_quat){1, 0, 0, 0}, v3(1e5, 1e5, -1e5));
        shape_scale(&mesh, s, s, s);
        double volume = check_united(&mesh).volume / (s * s * s);
        if (k == 0)
            want = volume;
        check_close(volume, want, 1e-9);
        dem_mesh_free(&mesh);
        dem_mesh_free(&other);
    }
}

static void a_surface_that_only_touches_itself_stays_as_it_is(void **state)
{
    (void)state;
    // a corner on the middle of a side is a touch, not a crossing
    dem_mesh mesh = shape_box(1, 1, 1);
    dem_mesh tip = shape_tetrahedron(v3(0.5, 0.5, 1), v3(0.6, 0.5, 2), v3(0.5, 0.6, 2), v3(0.4, 0.4, 2));
    shape_flip(&tip, 0, 4);
    shape_append(&mesh, &tip, 0, 4);
    dem_mesh_report report;
    dem_error error;
    dem_status status = dem_mesh_repair(NULL, &mesh, &(dem_repair_options){.keep = DEM_KEEP_ALL}, &report, &error);
    if (DEM_CGAL) {
        check_ok(status, error);
        check(report.self_intersections > 0 && report.triangles == 16);
    } else {
        check(status == DEM_BAD_INPUT && strstr(error.text, "CGAL"));
    }
    dem_mesh_free(&mesh);
    dem_mesh_free(&tip);
}

static void without_cgal_crossing_shells_are_refused(void **state)
{
    (void)state;
    if (DEM_CGAL)
        skip();
    dem_mesh mesh = two_boxes(v3(0.5, 0.25, 0.125), 1, 1, 1);
    dem_error error;
    check(dem_mesh_repair(NULL, &mesh, NULL, NULL, &error) == DEM_BAD_INPUT && strstr(error.text, "needs CGAL"));
    dem_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_boxes_that_overlap_are_united_exactly),
        cmocka_unit_test(overlapping_grains_have_the_volume_their_winding_numbers_say),
        cmocka_unit_test(a_surface_pressed_through_itself_has_the_volume_its_winding_numbers_say),
        cmocka_unit_test(the_outline_does_not_depend_on_scale_or_place),
        cmocka_unit_test(a_surface_that_only_touches_itself_stays_as_it_is),
        cmocka_unit_test(without_cgal_crossing_shells_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
