#include "check.h"
#include "shapes.h"

#include "base/random.h"
#include "geom/tree.h"
#include "geom/union.h"

static const dem_ctx single = {.threads = 1};

static dem_pack pack_side(const dem_mesh *mesh, dem_side side, size_t spheres)
{
    dem_pack_options options = dem_pack_defaults();
    options.effort = DEM_EFFORT_FAST;
    options.side = side;
    options.spheres = spheres;
    dem_pack pack;
    dem_error error;
    check_ok(dem_clump_pack(&single, mesh, &options, &pack, &error), error);
    check(pack.count > 0 && pack.count <= spheres && pack.moments == DEM_MOMENTS_FREE);
    check(dem_ball_pieces(pack.balls, pack.count, 0, NULL) == 1);
    return pack;
}

static double equivalent_diameter(const dem_mesh *mesh)
{
    return cbrt(6 * dem_mesh_solid(mesh).volume / DEM_PI);
}

// how far the point lies outside the union
static double outside(dem_vec3 point, const dem_pack *pack)
{
    double least = INFINITY;
    for (size_t i = 0; i < pack->count; i++)
        least = fmin(least, v3_distance(point, pack->balls[i].centre) - pack->balls[i].radius);
    return least;
}

static void check_inscribed(const dem_mesh *mesh, const dem_pack *pack)
{
    dem_tree tree;
    dem_error error;
    check_ok(dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, &error), error);
    for (size_t i = 0; i < pack->count; i++) {
        check(dem_tree_inside(&tree, pack->balls[i].centre));
        check(pack->balls[i].radius <= dem_tree_closest(&tree, pack->balls[i].centre, INFINITY, NULL, NULL));
    }
    dem_tree_release(&tree);
}

// vertices, and random points of all triangles
static void check_covered(const dem_mesh *mesh, const dem_pack *pack)
{
    dem_random random = random_stream(5, 0);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        check(outside(mesh->vertices[i], pack) <= 0);
    for (int k = 0; k < 20000; k++) {
        const uint32_t *t = mesh->triangles + 3 * random_below(&random, mesh->triangle_count);
        double u = random_uniform(&random), v = (1 - u) * random_uniform(&random);
        dem_vec3 a = v3_scale(mesh->vertices[t[0]], 1 - u - v);
        dem_vec3 point = v3_along(v3_along(a, u, mesh->vertices[t[1]]), v, mesh->vertices[t[2]]);
        check(outside(point, pack) <= 0);
    }
}

static void no_point_of_an_inscribed_clump_lies_outside_the_grain(void **state)
{
    (void)state;
    // the last has more triangles than the packer keeps for itself
    dem_mesh shapes[] = {shape_grain(8), shape_box(20, 1, 1), shape_grain(112)};
    for (size_t k = 0; k < 3; k++) {
        dem_pack pack = pack_side(&shapes[k], DEM_SIDE_INSCRIBED, 8);
        check_inscribed(&shapes[k], &pack);
        dem_pack_free(&pack);
        dem_mesh_free(&shapes[k]);
    }
}

static void no_point_of_the_grain_lies_outside_an_outer_clump(void **state)
{
    (void)state;
    dem_mesh shapes[] = {shape_grain(8), shape_box(20, 1, 1)};
    for (size_t k = 0; k < 2; k++) {
        dem_pack pack = pack_side(&shapes[k], DEM_SIDE_OUTER, 10);
        check_covered(&shapes[k], &pack);
        dem_pack_free(&pack);
        dem_mesh_free(&shapes[k]);
    }
}

static void more_spheres_come_closer_from_either_side(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    for (dem_side side = DEM_SIDE_INSCRIBED; side <= DEM_SIDE_OUTER; side++) {
        dem_pack few = pack_side(&grain, side, 8), many = pack_side(&grain, side, 32);
        // the gap falls about as the number to the power -0.8, and is up to four times that without a side
        check(many.gap_estimate < few.gap_estimate / 2);
        check(many.gap_estimate < 0.12);
        dem_pack_free(&few);
        dem_pack_free(&many);
    }
    dem_mesh_free(&grain);
}

static void one_sphere_of_either_side_is_inside_or_around(void **state)
{
    (void)state;
    dem_mesh cube = shape_box(1, 1, 1);
    dem_pack in = pack_side(&cube, DEM_SIDE_INSCRIBED, 1), out = pack_side(&cube, DEM_SIDE_OUTER, 1);
    // the best are 0.5 and sqrt(3)/2; the descent ends near them
    check_close(in.balls[0].radius, 0.5, 0.02);
    check_close(out.balls[0].radius, sqrt(3) / 2, 0.05);
    check_inscribed(&cube, &in);
    check_covered(&cube, &out);
    dem_pack_free(&in);
    dem_pack_free(&out);
    dem_mesh_free(&cube);
}

static void scale_does_not_matter(void **state)
{
    (void)state;
    static const double scales[] = {1e-9, 1e9};
    for (size_t k = 0; k < 2; k++) {
        dem_mesh grain = shape_grain(8);
        shape_scale(&grain, scales[k], scales[k], scales[k]);
        dem_pack in = pack_side(&grain, DEM_SIDE_INSCRIBED, 8), out = pack_side(&grain, DEM_SIDE_OUTER, 8);
        check_inscribed(&grain, &in);
        check_covered(&grain, &out);
        check(in.balls[0].radius < equivalent_diameter(&grain));
        dem_pack_free(&in);
        dem_pack_free(&out);
        dem_mesh_free(&grain);
    }
}

static bool stop_late(void *user, const char *what, double fraction)
{
    (void)what;
    return fraction > *(double *)user;
}

static void a_side_can_be_interrupted(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    for (dem_side side = DEM_SIDE_INSCRIBED; side <= DEM_SIDE_OUTER; side++) {
        double stop_at = 0.9;
        dem_ctx ctx = {.progress = stop_late, .user = &stop_at, .threads = 1};
        dem_pack_options options = dem_pack_defaults();
        options.side = side;
        options.spheres = 10;
        dem_pack pack;
        dem_error error;
        check(dem_clump_pack(&ctx, &grain, &options, &pack, &error) == DEM_INTERRUPTED);
        check(!pack.balls);
    }
    dem_mesh_free(&grain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_point_of_an_inscribed_clump_lies_outside_the_grain),
        cmocka_unit_test(no_point_of_the_grain_lies_outside_an_outer_clump),
        cmocka_unit_test(more_spheres_come_closer_from_either_side),
        cmocka_unit_test(one_sphere_of_either_side_is_inside_or_around),
        cmocka_unit_test(scale_does_not_matter),
        cmocka_unit_test(a_side_can_be_interrupted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
