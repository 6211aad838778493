// What a wall of triangles is made of, and which of them are near.
#include "walls.h"

#include "base/level.h"

typedef struct heard {
    int warnings;
    char text[512];
} heard;

static void listen(void *user, dem_log_level level, const char *subject, const char *text)
{
    heard *h = user;
    (void)subject;
    h->warnings += level == DEM_LOG_WARNING;
    snprintf(h->text, sizeof h->text, "%s", text);
}

static void without_embree_there_are_no_mesh_walls(void **state)
{
    (void)state;
    if (DEM_EMBREE)
        skip();
    dem_mesh_wall *wall;
    dem_error error = {0};
    dem_mesh box = shape_box(1, 1, 1);
    check(dem_mesh_wall_create(NULL, &box, "hopper", &wall, &error) == DEM_UNAVAILABLE);
    check(!wall && strstr(error.text, "Embree"));
    dem_mesh_free(&box);
}

static void a_wall_welds_its_corners_and_keeps_the_order_of_its_triangles(void **state)
{
    (void)state;
    dem_mesh box = shape_box(3, 2, 1), loose = {.vertex_count = 37, .triangle_count = 12};
    loose.vertices = malloc(37 * sizeof *loose.vertices);
    loose.triangles = malloc(36 * sizeof *loose.triangles);
    check(loose.vertices && loose.triangles);
    for (uint32_t i = 0; i < 36; i++) {
        loose.vertices[i] = box.vertices[box.triangles[i]];
        loose.triangles[i] = i;
    }
    loose.vertices[36] = v3(100, 100, 100);  // no triangle uses it
    dem_mesh_wall *wall = wall_of(loose);
    check(wall->mesh.vertex_count == 8 && wall->mesh.triangle_count == 12);
    for (uint32_t i = 0; i < 12; i++) {
        const dem_triangle *t = &wall->triangles[i];
        check_vec(t->a, box.vertices[box.triangles[3 * i]], 0);
        check_vec(t->b, box.vertices[box.triangles[3 * i + 1]], 0);
        check_vec(t->c, box.vertices[box.triangles[3 * i + 2]], 0);
        check_vec(t->normal, v3_unit(v3_cross(v3_sub(t->b, t->a), v3_sub(t->c, t->a))), 1e-15);
    }
    check_vec(wall->box.low, v3(0, 0, 0), 0);
    check_vec(wall->box.high, v3(3, 2, 1), 0);
    dem_mesh_wall_destroy(wall);
    dem_mesh_free(&box);
}

static void triangles_without_area_are_dropped_with_one_warning(void **state)
{
    (void)state;
    const dem_vec3 vertices[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 1e-13, 0}, {0, 0, 0}};
    const uint32_t triangles[] = {0, 1, 1, 0, 1, 3, 0, 1, 2, 0, 4, 2, 2, 2, 2};
    dem_mesh mesh = shape_copy(vertices, 5, triangles, 5);
    heard h = {0};
    dem_ctx ctx = {.log = listen, .user = &h};
    dem_mesh_wall *wall;
    dem_error error;
    if (!DEM_EMBREE)
        skip();
    check_ok(dem_mesh_wall_create(&ctx, &mesh, "hopper", &wall, &error), error);
    check(wall->mesh.triangle_count == 1 && wall->mesh.vertex_count == 3 && mesh.triangle_count == 5);
    assert_int_equal(h.warnings, 1);
    check(strstr(h.text, "hopper") && strstr(h.text, "4 of 5"));
    dem_mesh_wall_destroy(wall);
    // nothing to warn of
    mesh.triangle_count = 1;
    memcpy(mesh.triangles, &triangles[6], 3 * sizeof *triangles);
    check_ok(dem_mesh_wall_create(&ctx, &mesh, "hopper", &wall, &error), error);
    assert_int_equal(h.warnings, 1);
    dem_mesh_wall_destroy(wall);
    dem_mesh_free(&mesh);
}

static void meshes_that_are_no_walls_are_refused_by_name(void **state)
{
    (void)state;
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e200};
    dem_mesh_wall *wall;
    dem_error error;
    dem_mesh mesh = shape_box(1, 1, 1);
    if (!DEM_EMBREE)
        skip();
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < 4; i++) {
            dem_vec3 was = mesh.vertices[5];
            v3_set(&mesh.vertices[5], axis, bad[i]);
            check(dem_mesh_wall_create(NULL, &mesh, "chute", &wall, &error) == DEM_BAD_INPUT && !wall);
            check(strstr(error.text, "chute") && strstr(error.text, "vertex 5") && strchr(error.text, ';'));
            mesh.vertices[5] = was;
        }
    mesh.triangles[7] = 8;
    check(dem_mesh_wall_create(NULL, &mesh, "chute", &wall, &error) == DEM_BAD_INPUT && !wall);
    check(strstr(error.text, "chute") && strstr(error.text, "triangle 2") && strchr(error.text, ';'));
    for (int i = 0; i < 36; i++)
        mesh.triangles[i] = (uint32_t)(i / 9);
    check(dem_mesh_wall_create(NULL, &mesh, "chute", &wall, &error) == DEM_BAD_INPUT && !wall);
    check(strstr(error.text, "chute") && strstr(error.text, "area") && strchr(error.text, ';'));
    mesh.triangle_count = 0;
    check(dem_mesh_wall_create(NULL, &mesh, "chute", &wall, NULL) == DEM_BAD_INPUT && !wall);
    dem_mesh_free(&mesh);
    dem_mesh_wall_destroy(NULL);
}

// brute force over all triangles; what lies at the very reach may be there or not
static void check_near_list(const dem_mesh_wall *wall, dem_vec3 p, double reach, dem_ray_list *list)
{
    check(dem_mesh_wall_near(wall, p, reach, list));
    size_t at = 0;
    for (uint32_t i = 0; i < wall->mesh.triangle_count; i++) {
        double d = sqrt(triangle_closest(&wall->triangles[i], p).distance2);
        bool listed = at < list->count && list->items[at] == i;
        check(listed || d > reach);
        check(!listed || d <= reach * (1 + 2e-12) + 2e-14 * wall->triangles[i].length);
        at += listed;
    }
    assert_int_equal(at, list->count);  // ascending, and none twice
}

static void the_near_triangles_are_those_of_brute_force(void **state)
{
    (void)state;
    dem_random r = random_stream(1, 0);
    dem_ray_list list = {0};
    size_t longest = 0;
    for (int round = 0; round < 6; round++) {
        double size = round < 2 ? 1 : round < 4 ? 1e-6 : 1e3;
        dem_vec3 place = round % 2 ? v3(1e6 * size, -3e5 * size, 7e5 * size) : v3(0, 0, 0);
        dem_mesh mesh = shape_grain(12);
        shape_scale(&mesh, size, size, size);
        shape_move(&mesh, random_turn(&r), place);
        dem_mesh_wall *wall = wall_of(mesh);
        for (int i = 0; i < 300; i++) {
            double reach = size * pow(10, -3 * random_uniform(&r));
            check_near_list(wall, v3_along(place, 1.2 * size, random_point(&r)), reach, &list);
            longest = list.count > longest ? list.count : longest;
        }
        dem_mesh_wall_destroy(wall);
    }
    check(longest > 200);
    free(list.items);
}

// a ball that has moved by the skin since its candidates were gathered misses nothing
static void a_skin_covers_motion(void **state)
{
    (void)state;
    dem_random r = random_stream(2, 0);
    dem_mesh_wall *wall = wall_of(shape_grain(12));
    dem_ray_list list = {0};
    for (int i = 0; i < 2000; i++) {
        dem_vec3 centre = random_point(&r), moved = v3_along(centre, 0.02, v3_unit(random_point(&r)));
        dem_mesh_contact want[DEM_MESH_CONTACTS], got[DEM_MESH_CONTACTS];
        int count = wall_touch(wall, moved, 0.1, want);
        check(dem_mesh_wall_near(wall, centre, 0.12, &list));
        check(dem_mesh_wall_contacts(wall, list.items, list.count, moved, 0.1, got, DEM_MESH_CONTACTS) == count);
        check(memcmp(got, want, (size_t)count * sizeof *got) == 0);
    }
    free(list.items);
    dem_mesh_wall_destroy(wall);
}

static void many_pairs_at_once_have_the_bits_of_one(void **state)
{
    (void)state;
    enum { PAIRS = 1000 };
    dem_random r = random_stream(3, 0);
    dem_mesh_wall *wall = wall_of(shape_grain(8));
    static uint32_t ids[PAIRS];
    static dem_vec3 centres[PAIRS];
    static dem_closest spots[PAIRS + 1];
    for (int i = 0; i < PAIRS; i++) {
        ids[i] = (uint32_t)random_below(&r, wall->mesh.triangle_count);
        const dem_triangle *t = &wall->triangles[ids[i]];
        centres[i] = i % 4 ? v3_along(t->a, 0.2, random_point(&r)) : v3_scale(v3_add(t->b, t->c), 0.5);
    }
    for (int k = 0; k < DEM_LEVELS; k++) {
        wall->spots = dem_mesh_spots_choose(dem_level_name(k));
        for (size_t count = 0; wall->spots && count <= PAIRS; count += count < 20 ? 1 : 490) {
            memset(spots, 7, sizeof spots);
            dem_mesh_wall_spots(wall, ids, centres, count, spots);
            for (size_t i = 0; i < count; i++) {
                dem_closest one = triangle_closest(&wall->triangles[ids[i]], centres[i]);
                check(memcmp(&one, &spots[i], sizeof one) == 0);
                one = triangle_closest_lane(&wall->triangles[ids[i]], centres[i]);
                check(memcmp(&one, &spots[i], sizeof one) == 0);
            }
            check(((unsigned char *)&spots[count])[0] == 7);
        }
    }
    check(dem_mesh_spots_choose("plain") && dem_mesh_spots_choose(NULL) && !dem_mesh_spots_choose("v9"));
    dem_mesh_wall_destroy(wall);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_embree_there_are_no_mesh_walls),
        cmocka_unit_test(a_wall_welds_its_corners_and_keeps_the_order_of_its_triangles),
        cmocka_unit_test(triangles_without_area_are_dropped_with_one_warning),
        cmocka_unit_test(meshes_that_are_no_walls_are_refused_by_name),
        cmocka_unit_test(the_near_triangles_are_those_of_brute_force),
        cmocka_unit_test(a_skin_covers_motion),
        cmocka_unit_test(many_pairs_at_once_have_the_bits_of_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
