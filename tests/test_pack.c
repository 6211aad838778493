#include "check.h"
#include "shapes.h"

#include "clump/pack.h"
#include "geom/union.h"

static dem_pack pack(const dem_ctx *ctx, const dem_mesh *mesh, dem_pack_options options)
{
    dem_pack result;
    dem_error error;
    check_ok(dem_clump_pack(ctx, mesh, &options, &result, &error), error);
    return result;
}

static dem_pack_options spheres(size_t count, dem_effort effort)
{
    dem_pack_options options = dem_pack_defaults();
    options.spheres = count;
    options.effort = effort;
    return options;
}

static void a_packed_box_has_the_volume_centre_and_inertia_of_the_box_and_is_one_piece(void **state)
{
    (void)state;
    dem_mesh box = shape_box(3, 2, 1);
    dem_pack p = pack(NULL, &box, spheres(30, DEM_EFFORT_FAST));
    dem_solid want = dem_mesh_solid(&box);
    dem_union got;
    dem_error error;
    check_ok(dem_balls_union(p.balls, p.count, &got, &error), error);
    check(p.count == 30 && p.moments == DEM_MOMENTS_EXACT);
    check(p.moment_residual < 1e-9);
    check_close(got.solid.volume, want.volume, 1e-9);
    check_vec(got.solid.centre, want.centre, 1e-9 * 3);
    for (int k = 0; k < 3; k++)
        check_close(got.solid.principal[k], want.principal[k], 1e-9);
    check(dem_ball_pieces(p.balls, p.count, 0, NULL) == 1);
    check(got.redundant == 0);
    dem_pack_free(&p);
    dem_mesh_free(&box);
}

static void one_sphere_is_the_sphere_of_equal_volume_about_the_centroid(void **state)
{
    (void)state;
    dem_mesh box = shape_box(1, 1, 1);
    dem_pack p = pack(NULL, &box, spheres(1, DEM_EFFORT_DEFAULT));
    check(p.count == 1 && p.moments == DEM_MOMENTS_VOLUME);
    check_vec(p.balls[0].centre, v3(0.5, 0.5, 0.5), 1e-12);
    check_close(p.balls[0].radius, cbrt(3 / (4 * DEM_PI)), 1e-12);
    dem_pack_free(&p);
    dem_mesh_free(&box);
}

static void an_unknown_method_is_refused_by_name(void **state)
{
    (void)state;
    dem_mesh box = shape_box(1, 1, 1);
    dem_pack_options options = dem_pack_defaults();
    options.method = "magic";
    dem_pack p;
    dem_error error;
    check(dem_clump_pack(NULL, &box, &options, &p, &error) == DEM_USAGE);
    check(strstr(error.text, "magic") && !p.balls);
    dem_mesh_free(&box);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_packed_box_has_the_volume_centre_and_inertia_of_the_box_and_is_one_piece),
        cmocka_unit_test(one_sphere_is_the_sphere_of_equal_volume_about_the_centroid),
        cmocka_unit_test(an_unknown_method_is_refused_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
