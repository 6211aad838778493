#include "shapes.h"

#include "out/wall_mesh.h"

static const dem_domain_def ENDLESS = {.low = {-INFINITY, -INFINITY, -INFINITY},
                                       .high = {INFINITY, INFINITY, INFINITY}};
static const dem_box BOX = {{-1, -2, 0}, {3, 2, 5}};

static dem_mesh made(const dem_wall_def *wall, const dem_wall_view *pose, dem_box box)
{
    dem_mesh mesh;
    dem_error error;
    check_ok(dem_wall_mesh(wall, pose, box, &mesh, &error), error);
    for (size_t i = 0; i < 3 * mesh.triangle_count; i++)
        check(mesh.triangles[i] < mesh.vertex_count);
    return mesh;
}

// area of the triangles as vectors: it points where they face
static dem_vec3 faced_area(const dem_mesh *mesh)
{
    dem_vec3 sum = {0};
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *c = &mesh->triangles[3 * t];
        dem_vec3 a = mesh->vertices[c[0]];
        sum = v3_along(sum, 0.5, v3_cross(v3_sub(mesh->vertices[c[1]], a), v3_sub(mesh->vertices[c[2]], a)));
    }
    return sum;
}

static void a_plane_is_cut_at_the_box_and_faces_the_bodies(void **state)
{
    (void)state;
    const double s = sqrt(0.5);
    const struct {
        dem_vec3 point, normal, area;  // area: exact section of the box
    } cases[] = {{{7, 7, 1}, {0, 0, 1}, {0, 0, 16}},   {{7, 7, 1}, {0, 0, -1}, {0, 0, -16}},
                 {{0, 0, 0}, {0, 0, 1}, {0, 0, 16}},    // on the side of the box
                 {{3, 9, 9}, {-1, 0, 0}, {-20, 0, 0}},  // and on the opposite one
                 {{1, 0, 9}, {s, s, 0}, {20, 20, 0}},   // a diagonal, sqrt(32) wide and 5 high
                 {{0, 0, 5.1}, {0, 0, 1}, {0, 0, 0}},   // misses the box
                 {{3, 2, 5}, {s, s, 0}, {0, 0, 0}}};    // touches an edge
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_wall_def wall = {.kind = DEM_WALL_PLANE, .point = cases[i].point, .normal = cases[i].normal};
        dem_mesh mesh = made(&wall, NULL, BOX);
        check_vec(faced_area(&mesh), cases[i].area, 1e-6);  // the sides have a tolerance of 1e-9 diagonals
        for (size_t k = 0; k < mesh.vertex_count; k++)
            check_near(v3_dot(v3_sub(mesh.vertices[k], cases[i].point), cases[i].normal), 0, 1e-13);
        dem_mesh_free(&mesh);
    }
}

static void a_plane_through_six_edges_is_a_hexagon(void **state)
{
    (void)state;
    const double s = sqrt(1.0 / 3);
    dem_wall_def wall = {.kind = DEM_WALL_PLANE, .point = {0.5, 0.5, 0.5}, .normal = {s, s, s}};
    dem_mesh mesh = made(&wall, NULL, (dem_box){{0, 0, 0}, {1, 1, 1}});
    check(mesh.vertex_count == 6 && mesh.triangle_count == 4);
    check_near(v3_dot(faced_area(&mesh), wall.normal), 3 * sqrt(3.0) / 4, 1e-7);
    dem_mesh_free(&mesh);
}

static void a_cylinder_is_as_long_as_the_box(void **state)
{
    (void)state;
    for (int outside = 0; outside < 2; outside++) {
        dem_wall_def wall = {
            .kind = DEM_WALL_CYLINDER, .point = {1, 0, 77}, .normal = {0, 0, 1}, .radius = 0.5, .outside = outside};
        dem_mesh mesh = made(&wall, NULL, BOX);
        double low = INFINITY, high = -INFINITY, area = 0, inward = 0;
        for (size_t i = 0; i < mesh.vertex_count; i++) {
            check_near(hypot(mesh.vertices[i].x - 1, mesh.vertices[i].y), 0.5, 1e-13);
            low = fmin(low, mesh.vertices[i].z);
            high = fmax(high, mesh.vertices[i].z);
        }
        for (size_t t = 0; t < mesh.triangle_count; t++) {
            dem_mesh one = {mesh.vertices, mesh.triangles + 3 * t, mesh.vertex_count, 1, false};
            dem_vec3 a = faced_area(&one), at = mesh.vertices[one.triangles[0]];
            area += v3_norm(a);
            inward -= v3_dot(a, v3_unit(v3(at.x - 1, at.y, 0)));
        }
        check_near(low, 0, 1e-12);
        check_near(high, 5, 1e-12);
        check_close(area, 2 * DEM_PI * 0.5 * 5, 1e-3);  // 64 segments: pi^2 / (6 64^2)
        check_close(inward, outside ? -area : area, 2e-3);
        dem_mesh_free(&mesh);
    }
}

static void walls_are_where_they_have_moved_to(void **state)
{
    (void)state;
    // a quarter turn about z, then (10, 0, 1)
    const dem_wall_view pose = {.position = {10, 0, 1}, .orientation = {sqrt(0.5), 0, 0, sqrt(0.5)}};
    dem_wall_def wall = {.kind = DEM_WALL_MESH, .mesh = shape_box(1, 2, 3)};
    dem_mesh mesh = made(&wall, &pose, BOX);
    check(mesh.triangle_count == 12 && mesh.vertex_count == 8);
    for (size_t i = 0; i < 8; i++) {
        dem_vec3 x = wall.mesh.vertices[i];
        check_vec(mesh.vertices[i], v3(10 - x.y, x.x, 1 + x.z), 1e-14);
    }
    dem_mesh_free(&mesh);
    dem_mesh_free(&wall.mesh);
    wall = (dem_wall_def){.kind = DEM_WALL_PLANE, .point = {0.5, 0, 0}, .normal = {1, 0, 0}};  // becomes y = .5
    mesh = made(&wall, &pose, BOX);
    check_vec(faced_area(&mesh), v3(0, 20, 0), 1e-6);
    for (size_t i = 0; i < mesh.vertex_count; i++)
        check_near(mesh.vertices[i].y, 0.5, 1e-14);
    dem_mesh_free(&mesh);
}

static void the_box_holds_domain_bodies_and_walls(void **state)
{
    (void)state;
    const dem_box bodies = {{0, 0, 1}, {1, 1, 2}};
    dem_wall_def walls[] = {{.kind = DEM_WALL_PLANE, .point = {0, 0, -3}, .normal = {0, 0, 1}},
                            {.kind = DEM_WALL_CYLINDER, .point = {0, 0, 0}, .normal = {1, 0, 0}, .radius = 4},
                            {.kind = DEM_WALL_MESH, .mesh = shape_box(9, 1, 1)}};
    dem_box box = dem_walls_box(&ENDLESS, bodies, walls, NULL, 3);
    double margin = 0.05 * v3_norm(v3(9, 8, 8));
    check_vec(box.low, v3(-margin, -4 - margin, -3), 1e-12);
    check_vec(box.high, v3(9 + margin, 4 + margin, 4 + margin), 1e-12);
    dem_domain_def domain = ENDLESS;
    domain.low.z = 0.5;
    domain.high.x = 2;
    box = dem_walls_box(&domain, bodies, walls, NULL, 3);
    check(box.low.z == 0.5 && box.high.x == 2);
    // a floor far below what falls is in the box, hence drawn
    dem_mesh floor = made(&walls[0], NULL, dem_walls_box(&ENDLESS, bodies, walls, NULL, 1));
    check(floor.triangle_count == 2);
    dem_mesh_free(&floor);
    // planes across the axes end one another: a box has closed edges
    const dem_wall_def corner[] = {{.kind = DEM_WALL_PLANE, .point = {0, 0, -3}, .normal = {0, 0, 1}},
                                   {.kind = DEM_WALL_PLANE, .point = {1.5, 0, 0}, .normal = {-1, 0, 0}},
                                   {.kind = DEM_WALL_PLANE, .point = {0, 9, 0}, .normal = {0, -1, 0}}};
    box = dem_walls_box(&ENDLESS, bodies, corner, NULL, 3);
    check(box.low.z == -3 && box.high.x == 1.5 && box.high.y == 9 && box.low.x < 0);
    // moved ones count where they are
    const dem_wall_view pose = {.position = {0, 0, -100}, .orientation = {1, 0, 0, 0}};
    check(dem_walls_box(&ENDLESS, bodies, walls, &pose, 1).low.z == -103);
    dem_mesh_free(&walls[2].mesh);
    // nothing at all is still a box
    box = dem_walls_box(&ENDLESS, box_empty(), walls, NULL, 0);
    check(box_diagonal(box) > 0 && isfinite(box_diagonal(box)));
}

static void walls_move_by_velocity_or_spin(void **state)
{
    (void)state;
    check(!dem_wall_moves(&(dem_wall_def){0}));
    check(dem_wall_moves(&(dem_wall_def){.velocity = {0, 0, 1e-9}}));
    check(dem_wall_moves(&(dem_wall_def){.spin = {0, 1, 0}}));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plane_is_cut_at_the_box_and_faces_the_bodies),
        cmocka_unit_test(a_plane_through_six_edges_is_a_hexagon),
        cmocka_unit_test(a_cylinder_is_as_long_as_the_box),
        cmocka_unit_test(walls_are_where_they_have_moved_to),
        cmocka_unit_test(the_box_holds_domain_bodies_and_walls),
        cmocka_unit_test(walls_move_by_velocity_or_spin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
