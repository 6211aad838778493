#include "shapes.h"

static void bodies_come_largest_first_with_their_cavities(void **state)
{
    (void)state;
    // boxes of side 1, 4 (with a cavity of side 2 that holds a box of side 1.5) and 2
    dem_mesh mesh = {0};
    const struct {
        double side, at;
        bool cavity;
    } boxes[] = {{1, 10, false}, {4, 0, false}, {2, 1, true}, {1.5, 1.2, false}, {2, 20, false}};
    for (int i = 0; i < 5; i++) {
        dem_mesh box = shape_box(boxes[i].side, boxes[i].side, boxes[i].side);
        shape_move(&box, (dem_quat){1, 0, 0, 0}, v3(boxes[i].at, boxes[i].at, boxes[i].at));
        if (boxes[i].cavity)
            shape_flip(&box, 0, 12);
        shape_append(&mesh, &box, 0, 12);
        dem_mesh_free(&box);
    }
    dem_mesh *bodies;
    size_t count;
    dem_error error;
    check_ok(dem_mesh_split(&mesh, &bodies, &count, &error), error);
    check(count == 4);
    const double volumes[] = {56, 8, 3.375, 1};
    for (size_t i = 0; i < 4; i++) {
        check(bodies[i].triangle_count == (i == 0 ? 24 : 12) && bodies[i].vertex_count == (i == 0 ? 16 : 8));
        check_close(dem_mesh_solid(&bodies[i]).volume, volumes[i], 1e-14);
        dem_mesh_free(&bodies[i]);
    }
    free(bodies);
    dem_mesh_free(&mesh);
}

static void one_body_is_a_copy(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(5), *bodies;
    size_t count;
    dem_error error;
    check_ok(dem_mesh_split(&grain, &bodies, &count, &error), error);
    check(count == 1 && bodies[0].triangle_count == grain.triangle_count && bodies[0].vertices != grain.vertices);
    check_close(dem_mesh_solid(&bodies[0]).volume, dem_mesh_solid(&grain).volume, 1e-15);
    dem_mesh_free(&bodies[0]);
    free(bodies);
    dem_mesh_free(&grain);
}

static void bodies_that_share_a_vertex_stay_together(void **state)
{
    (void)state;
    dem_mesh mesh = shape_box(1, 1, 1), other = shape_box(1, 1, 1), *bodies;
    shape_move(&other, (dem_quat){1, 0, 0, 0}, v3(1, 1, 1));
    shape_append(&mesh, &other, 0, 12);
    dem_error error;
    check_ok(dem_mesh_repair(NULL, &mesh, NULL, NULL, &error), error);
    size_t count;
    check_ok(dem_mesh_split(&mesh, &bodies, &count, &error), error);
    check(count == 1 && bodies[0].vertex_count == 15);
    dem_mesh_free(&bodies[0]);
    free(bodies);
    dem_mesh_free(&mesh);
    dem_mesh_free(&other);
}

// quadratic work would take minutes
static void thousands_of_bodies_take_no_time(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    dem_mesh mesh = {.vertices = malloc(8 * COUNT * sizeof(dem_vec3)), .triangles = malloc(36 * COUNT * sizeof(uint32_t)),
                     .vertex_count = 8 * COUNT, .triangle_count = 12 * COUNT}, *bodies;
    check(mesh.vertices && mesh.triangles);
    dem_mesh box = shape_box(1, 1, 1);
    for (uint32_t i = 0; i < COUNT; i++) {
        for (uint32_t k = 0; k < 8; k++)
            mesh.vertices[8 * i + k] = v3_add(box.vertices[k], v3(2.0 * (i % 60), 2.0 * (i / 60), 0));
        for (uint32_t k = 0; k < 36; k++)
            mesh.triangles[36 * i + k] = box.triangles[k] + 8 * i;
    }
    dem_error error;
    dem_mesh_report report;
    check_ok(dem_mesh_repair(NULL, &mesh, &(dem_repair_options){.keep = DEM_KEEP_ALL}, &report, &error), error);
    size_t count;
    check_ok(dem_mesh_split(&mesh, &bodies, &count, &error), error);
    check(count == COUNT && report.bodies == COUNT);
    check_close(report.volume, (double)COUNT, 1e-12);
    for (size_t i = 0; i < count; i++)
        dem_mesh_free(&bodies[i]);
    free(bodies);
    dem_mesh_free(&mesh);
    dem_mesh_free(&box);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_come_largest_first_with_their_cavities),
        cmocka_unit_test(one_body_is_a_copy),
        cmocka_unit_test(bodies_that_share_a_vertex_stay_together),
        cmocka_unit_test(thousands_of_bodies_take_no_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
