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

// every promise that holds for any number of spheres
static void check_promises(const dem_mesh *mesh, const dem_pack *p, size_t most)
{
    dem_solid want = dem_mesh_solid(mesh);
    dem_union got;
    dem_error error;
    double d = cbrt(6 * want.volume / DEM_PI);
    check_ok(dem_balls_union(p->balls, p->count, &got, &error), error);
    check(p->count >= 1 && p->count <= most);
    check(dem_ball_pieces(p->balls, p->count, 0.0079 * d, NULL) == 1);
    check(got.redundant == 0);
    if (p->moments != DEM_MOMENTS_FREE) {
        check_close(got.solid.volume, want.volume, 1e-8);
        check_vec(got.solid.centre, want.centre, 1e-8 * d);
    }
    for (int k = 0; k < 3 && p->moments == DEM_MOMENTS_EXACT; k++)
        check_close(got.solid.principal[k], want.principal[k], 1e-8);
}

static void one_to_twelve_spheres_keep_every_promise(void **state)
{
    (void)state;
    dem_mesh box = shape_box(2, 1.5, 1);
    for (size_t n = 1; n <= 12; n++) {
        dem_pack p = pack(NULL, &box, spheres(n, DEM_EFFORT_FAST));
        check_promises(&box, &p, n);
        check(p.moments != DEM_MOMENTS_FREE);
        if (n >= 8)
            check(p.moments == DEM_MOMENTS_EXACT);
        dem_pack_free(&p);
    }
    dem_mesh_free(&box);
}

static void needles_plates_tetrahedra_and_spheres_end_and_keep_every_promise(void **state)
{
    (void)state;
    dem_mesh meshes[] = {shape_box(100, 1, 1), shape_box(100, 100, 1), shape_sphere(12),
                         shape_tetrahedron(v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0), v3(0, 0, 1))};
    for (size_t m = 0; m < sizeof meshes / sizeof *meshes; m++) {
        for (size_t n = 5; n <= 40; n += 35) {
            dem_pack p = pack(NULL, &meshes[m], spheres(n, DEM_EFFORT_FAST));
            check_promises(&meshes[m], &p, n);
            dem_pack_free(&p);
        }
        dem_mesh_free(&meshes[m]);
    }
}

static void count_warning(void *user, dem_log_level level, const char *subject, const char *text)
{
    (void)subject;
    *(int *)user += level == DEM_LOG_WARNING && strstr(text, "IoU gap");
}

static void a_poor_fit_is_told(void **state)
{
    (void)state;
    int warnings = 0;
    dem_ctx ctx = {.log = count_warning, .user = &warnings};
    dem_mesh plate = shape_box(100, 100, 1);
    dem_pack p = pack(&ctx, &plate, spheres(10, DEM_EFFORT_FAST));
    check(p.gap_estimate > 0.5 && warnings > 0);
    dem_pack_free(&p);
    dem_mesh_free(&plate);
}

static void the_clump_is_the_same_for_any_number_of_threads_and_another_for_another_seed(void **state)
{
    (void)state;
    dem_mesh box = shape_box(3, 2, 1);
    dem_pack first = pack(&(dem_ctx){.threads = 1}, &box, spheres(25, DEM_EFFORT_DEFAULT));
    for (int threads = 2; threads <= 3; threads++) {
        dem_pack p = pack(&(dem_ctx){.threads = threads}, &box, spheres(25, DEM_EFFORT_DEFAULT));
        check(p.count == first.count);
        check(memcmp(p.balls, first.balls, p.count * sizeof *p.balls) == 0);
        dem_pack_free(&p);
    }
    dem_pack_options other = spheres(25, DEM_EFFORT_DEFAULT);
    other.seed = 2;
    dem_pack p = pack(NULL, &box, other);
    check(p.count != first.count || memcmp(p.balls, first.balls, p.count * sizeof *p.balls) != 0);
    dem_pack_free(&p);
    dem_pack_free(&first);
    dem_mesh_free(&box);
}

// rounding differs, and a branch taken the other way leads elsewhere: the quality is the same, not the spheres
static void scale_and_place_do_not_matter(void **state)
{
    (void)state;
    double gaps[4];
    const double scales[4] = {1, 1e-9, 1e9, 1};
    for (int k = 0; k < 4; k++) {
        dem_mesh box = shape_box(3 * scales[k], 2 * scales[k], scales[k]);
        for (size_t i = 0; i < box.vertex_count && k == 3; i++)
            box.vertices[i] = v3_add(box.vertices[i], v3(1000, -2000, 500));
        dem_pack p = pack(NULL, &box, spheres(20, DEM_EFFORT_FAST));
        dem_fidelity fidelity;
        dem_error error;
        check(p.moments == DEM_MOMENTS_EXACT && p.count == 20);
        check_ok(dem_fidelity_measure(NULL, &box, p.balls, p.count, 0, &fidelity, &error), error);
        gaps[k] = fidelity.iou_gap;
        check(fidelity.pieces == 1);
        check_close(p.gap_estimate, fidelity.iou_gap, 0.02);
        check_close(gaps[k], gaps[0], 0.03);
        dem_pack_free(&p);
        dem_mesh_free(&box);
    }
}

// figures of PACKING quality, with 2 % for the machine's rounding to lead elsewhere
static void a_cube_and_an_octahedron_are_packed_as_closely_as_promised(void **state)
{
    (void)state;
    dem_mesh cube = shape_box(1, 1, 1);
    const double gap[2] = {0.117, 0.069};
    const size_t count[2] = {20, 50};
    for (int k = 0; k < 2; k++) {
        dem_pack p = pack(NULL, &cube, spheres(count[k], DEM_EFFORT_DEFAULT));
        check(p.moments == DEM_MOMENTS_EXACT && p.gap_estimate <= gap[k]);
        dem_pack_free(&p);
    }
    dem_mesh_free(&cube);
    dem_mesh octahedron = shape_sphere(1);
    dem_pack p = pack(NULL, &octahedron, spheres(50, DEM_EFFORT_DEFAULT));
    check(p.moments == DEM_MOMENTS_EXACT && p.gap_estimate <= 0.053);
    dem_pack_free(&p);
    dem_mesh_free(&octahedron);
}

static void a_mesh_too_large_for_a_tree_is_packed_by_a_stand_in(void **state)
{
    (void)state;
    dem_mesh sphere = shape_sphere(120);  // 115200 triangles
    // with valleys: there the mean points of the stand-in lie outside the grain
    for (size_t i = 0; i < sphere.vertex_count; i++) {
        dem_vec3 *v = &sphere.vertices[i];
        *v = v3_scale(v3(1.6 * v->x, v->y, v->z), 1 - 0.1 * (1 - cos(9 * v->x)) - 0.08 * (1 - cos(7 * v->y)));
    }
    for (dem_side side = DEM_SIDE_BOTH; side <= DEM_SIDE_INSCRIBED; side++) {
        dem_pack_options options = spheres(12, DEM_EFFORT_FAST);
        options.side = side;
        dem_pack p = pack(NULL, &sphere, options);
        dem_fidelity fidelity;
        dem_error error;
        check_promises(&sphere, &p, 12);
        check_ok(dem_fidelity_measure(NULL, &sphere, p.balls, p.count, 2000, &fidelity, &error), error);
        check(fidelity.iou_gap < (side == DEM_SIDE_BOTH ? 0.15 : 0.3));
        if (side == DEM_SIDE_INSCRIBED)
            check(fidelity.protrusion <= 0);
        dem_pack_free(&p);
    }
    dem_mesh_free(&sphere);
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
        cmocka_unit_test(one_to_twelve_spheres_keep_every_promise),
        cmocka_unit_test(needles_plates_tetrahedra_and_spheres_end_and_keep_every_promise),
        cmocka_unit_test(a_poor_fit_is_told),
        cmocka_unit_test(the_clump_is_the_same_for_any_number_of_threads_and_another_for_another_seed),
        cmocka_unit_test(scale_and_place_do_not_matter),
        cmocka_unit_test(a_cube_and_an_octahedron_are_packed_as_closely_as_promised),
        cmocka_unit_test(a_mesh_too_large_for_a_tree_is_packed_by_a_stand_in),
        cmocka_unit_test(an_unknown_method_is_refused_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
