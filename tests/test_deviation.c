#include "shapes.h"

#include "base/random.h"
#include "clump/deviation.h"

enum { BALLS = 150 };

static dem_deviation measure(const dem_mesh *mesh, const dem_ball *balls, size_t count, size_t samples)
{
    dem_tree tree;
    dem_boundary boundary;
    dem_deviation d;
    dem_error error;
    check_ok(dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, &error), error);
    check_ok(dem_boundary_build(&boundary, balls, count, &error), error);
    check_ok(dem_deviation_measure(&tree, &boundary, samples, 1, &d, &error), error);
    dem_boundary_release(&boundary);
    dem_tree_release(&tree);
    return d;
}

// balls of many sizes along the surface from inside
static void lining(const dem_mesh *mesh, uint64_t seed, dem_ball *balls, size_t count)
{
    dem_random r = random_stream(seed, 0);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *t = mesh->triangles + 3 * random_below(&r, mesh->triangle_count);
        dem_vec3 a = mesh->vertices[t[0]],
                 n = v3_cross(v3_sub(mesh->vertices[t[1]], a), v3_sub(mesh->vertices[t[2]], a));
        double radius = 0.12 + 0.2 * random_uniform(&r);
        balls[i] = (dem_ball){v3_along(a, -0.95 * radius, v3_unit(n)), radius};
    }
    balls[0] = (dem_ball){{0, 0, 0}, 0.45};
}

static void few_samples_lead_to_the_largest_distances_many_find(void **state)
{
    (void)state;
    dem_mesh meshes[2] = {shape_grain(9), shape_box(1.6, 1.2, 0.9)};
    shape_move(&meshes[1], (dem_quat){1, 0, 0, 0}, v3(-0.8, -0.6, -0.45));
    for (int m = 0; m < 2; m++)
        for (uint64_t seed = 1; seed < 5; seed++) {
            dem_ball balls[BALLS];
            lining(&meshes[m], seed, balls, BALLS);
            dem_deviation few = measure(&meshes[m], balls, BALLS, 2500),
                          many = measure(&meshes[m], balls, BALLS, 60000);
            check_close(few.largest, many.largest, 0.01);
            check_close(few.protrusion, many.protrusion, 0.01);
            check_close(few.mesh_mean, many.mesh_mean, 0.06);  // 2500 points
            check_close(few.union_mean, many.union_mean, 0.06);
        }
    dem_mesh_free(&meshes[0]);
    dem_mesh_free(&meshes[1]);
}

static void surfaces_that_face_away_are_half_a_turn_apart(void **state)
{
    (void)state;
    // a hollow sphere, and a ball without the hollow: the inner wall looks the wrong way
    dem_mesh mesh = shape_sphere(30), hollow = shape_sphere(30);
    shape_scale(&hollow, 0.6, 0.6, 0.6);
    shape_flip(&hollow, 0, hollow.triangle_count);
    shape_append(&mesh, &hollow, 0, hollow.triangle_count);
    dem_ball ball = {{0, 0, 0}, 1};
    dem_deviation d = measure(&mesh, &ball, 1, 20000);
    check_close(d.normal_deg, 180 * 0.36 / 1.36, 0.02);
    check_close(d.mesh_mean, 0.4 * 0.36 / 1.36, 0.01);
    check_close(d.largest, 0.4, 0.002);
    dem_mesh_free(&mesh);
    dem_mesh_free(&hollow);
}

static void a_tip_no_sample_hits_is_found(void **state)
{
    (void)state;
    // a thin spike of 1e-4 of the area
    dem_mesh mesh = shape_sphere(40);
    size_t tip = 0;
    for (size_t i = 0; i < mesh.vertex_count; i++)
        if (mesh.vertices[i].z > mesh.vertices[tip].z)
            tip = i;
    mesh.vertices[tip] = v3(0, 0, 1.3);
    dem_ball ball = {{0, 0, 0}, 1};
    check_close(measure(&mesh, &ball, 1, 3000).largest, 0.3, 1e-9);
    dem_mesh_free(&mesh);
}

static void the_middle_of_a_large_face_is_found(void **state)
{
    (void)state;
    dem_mesh mesh = shape_box(2, 2, 2);
    dem_ball balls[8];
    for (int i = 0; i < 8; i++)
        balls[i] = (dem_ball){{i & 1 ? 1.65 : 0.35, i & 2 ? 1.65 : 0.35, i & 4 ? 1.65 : 0.35}, 0.35};
    check_close(measure(&mesh, balls, 8, 300).largest, sqrt(2 * 0.65 * 0.65 + 0.35 * 0.35) - 0.35, 0.003);
    dem_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_samples_lead_to_the_largest_distances_many_find),
        cmocka_unit_test(surfaces_that_face_away_are_half_a_turn_apart),
        cmocka_unit_test(a_tip_no_sample_hits_is_found),
        cmocka_unit_test(the_middle_of_a_large_face_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
