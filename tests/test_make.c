// A clump with all that is told about it, as dem_clump_make measures it side by side.
#include "check.h"
#include "dem/dem.h"
#include "shapes.h"

static dem_clump *make(const dem_mesh *mesh, int threads)
{
    dem_ctx ctx = {.threads = threads};
    dem_make_options options = dem_make_defaults();
    dem_clump *clump = NULL;
    dem_error error;
    options.name = "box";
    options.pack.spheres = 40;
    options.pack.effort = DEM_EFFORT_FAST;
    options.surface_triangles = 200;
    check_ok(dem_clump_make(&ctx, mesh, &options, &clump, NULL, &error), error);
    return clump;
}

static void a_clump_is_told_the_same_by_any_number_of_threads_and_by_the_measures_alone(void **state)
{
    (void)state;
    dem_error error;
    dem_mesh box = shape_box(3, 2, 1.5);
    dem_clump *first = make(&box, 1);
    dem_clump_def one = dem_clump_view(first);
    for (int threads = 2; threads <= 6; threads += 2) {
        dem_clump *clump = make(&box, threads);
        dem_clump_def many = dem_clump_view(clump);
        check(many.ball_count == one.ball_count);
        check(memcmp(many.balls, one.balls, one.ball_count * sizeof *one.balls) == 0);
        check(memcmp(&many.fidelity, &one.fidelity, sizeof one.fidelity) == 0);
        many.shape.convexity = one.shape.convexity;  // the hull's last bit is not always the same
        check(memcmp(&many.shape, &one.shape, sizeof one.shape) == 0);
        check(many.union_volume == one.union_volume && many.surface.triangle_count == one.surface.triangle_count);
        dem_clump_destroy(clump);
    }
    dem_shape shape;
    check_ok(dem_shape_measure(NULL, &box, &shape, &error), error);
    shape.convexity = one.shape.convexity;
    check(memcmp(&shape, &one.shape, sizeof shape) == 0);
    check(one.fidelity.pieces == 1 && one.fidelity.iou_gap > 0.01 && one.fidelity.iou_gap < 0.2);
    check_close(one.mass, 2650 * 9, 1e-9);
    dem_clump_destroy(first);
    dem_mesh_free(&box);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clump_is_told_the_same_by_any_number_of_threads_and_by_the_measures_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
