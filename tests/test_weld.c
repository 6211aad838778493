#include "shapes.h"

#include "base/random.h"
#include "mesh/edges.h"
#include "mesh/weld.h"

// every triangle with three vertices of its own, moved by up to `noise`
static dem_mesh soup_of(const dem_mesh *mesh, double noise)
{
    dem_random r = random_stream(2, 0);
    size_t count = 3 * mesh->triangle_count;
    dem_mesh soup = {.vertices = malloc(count * sizeof *soup.vertices), .triangles = malloc(count * sizeof *soup.triangles),
                     .vertex_count = count, .triangle_count = mesh->triangle_count};
    check(soup.vertices && soup.triangles);
    for (size_t i = 0; i < count; i++) {
        double x = random_uniform(&r) - 0.5, y = random_uniform(&r) - 0.5, z = random_uniform(&r) - 0.5;
        soup.vertices[i] = v3_along(mesh->vertices[mesh->triangles[i]], 2 * noise, v3(x, y, z));
        soup.triangles[i] = (uint32_t)i;
    }
    return soup;
}

static void loose_triangles_become_the_mesh_they_were(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(7), soup = soup_of(&grain, 0);
    size_t unused;
    dem_error error;
    check_ok(dem_mesh_weld_equal(&soup, &unused, &error), error);
    check(soup.vertex_count == grain.vertex_count && unused == 0);
    for (size_t i = 0; i < 3 * grain.triangle_count; i++)
        check_vec(soup.vertices[soup.triangles[i]], grain.vertices[grain.triangles[i]], 0);
    dem_mesh_free(&grain);
    dem_mesh_free(&soup);
}

static void minus_zero_welds_to_zero_and_unused_vertices_go(void **state)
{
    (void)state;
    dem_vec3 vertices[] = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, -0.0}, {1, -0.0, 0}, {0, 0, 1}, {7, 7, 7}};
    dem_mesh mesh = shape_copy(vertices, 8, (uint32_t[]){1, 2, 3, 4, 6, 5}, 2);
    size_t unused;
    dem_error error;
    check_ok(dem_mesh_weld_equal(&mesh, &unused, &error), error);
    check(unused == 2 && mesh.vertex_count == 4);
    check(mesh.triangles[0] == mesh.triangles[3] && mesh.triangles[1] == mesh.triangles[5]);
    dem_mesh_free(&mesh);
}

static void noise_below_the_tolerance_is_welded_and_noise_above_is_not(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(7);
    for (int wide = 0; wide < 2; wide++) {
        dem_mesh soup = soup_of(&grain, 1e-7);
        unsigned char *all = malloc(soup.vertex_count);
        check(all != NULL);
        memset(all, 1, soup.vertex_count);
        size_t merged;
        dem_error error;
        check_ok(dem_mesh_weld_near(&soup, all, wide ? 1e-6 : 1e-9, &merged, &error), error);
        check(merged == (wide ? 3 * grain.triangle_count - grain.vertex_count : 0));
        if (wide)
            check_close(dem_mesh_solid(&soup).volume, dem_mesh_solid(&grain).volume, 1e-6);
        free(all);
        dem_mesh_free(&soup);
    }
    dem_mesh_free(&grain);
}

static void only_marked_vertices_are_welded_by_tolerance(void **state)
{
    (void)state;
    dem_vec3 vertices[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1e-4, 0, 0}, {1, 1e-4, 0}, {0, 0, 1}};
    dem_mesh mesh = shape_copy(vertices, 6, (uint32_t[]){0, 1, 2, 3, 4, 5}, 2);
    size_t merged;
    dem_error error;
    check_ok(dem_mesh_weld_near(&mesh, (unsigned char[]){1, 0, 1, 1, 1, 1}, 1e-3, &merged, &error), error);
    check(merged == 1 && mesh.vertex_count == 5 && mesh.triangles[3] == mesh.triangles[0]);
    dem_mesh_free(&mesh);
}

static void a_closed_mesh_has_a_twin_for_every_half_edge(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    dem_edges edges = {0};
    dem_error error;
    check_ok(dem_edges_build(&edges, &grain, &error), error);
    check(edges.border == 0 && edges.many == 0 && edges.duplicates == 0);
    for (uint32_t h = 0; h < 3 * grain.triangle_count; h++) {
        uint32_t twin = edges.twin[h];
        check(edges.twin[twin] == h && half_start(&grain, twin) == half_end(&grain, h));
        check(half_end(&grain, twin) == half_start(&grain, h) && half_next(half_before(h)) == h);
    }
    // without one triangle its three neighbours have a border
    grain.triangle_count--;
    check_ok(dem_edges_build(&edges, &grain, &error), error);
    check(edges.border == 3 && edges.many == 0);
    dem_edges_release(&edges);
    dem_mesh_free(&grain);
}

static void edges_of_many_triangles_and_duplicates_are_found(void **state)
{
    (void)state;
    dem_mesh box = shape_box(1, 1, 1);
    dem_mesh three = shape_copy(box.vertices, 8, box.triangles, 12);
    three.triangles = realloc(three.triangles, 45 * sizeof *three.triangles);
    check(three.triangles != NULL);
    // a fin on the edge 0-1, a copy of the first triangle turned on, and one of the second turned round
    memcpy(three.triangles + 36, (uint32_t[]){0, 1, 7, 2, 1, 0, 3, 2, 1}, 9 * sizeof *three.triangles);
    three.triangle_count = 15;
    dem_edges edges = {0};
    dem_error error;
    check_ok(dem_edges_build(&edges, &three, &error), error);
    check(edges.duplicates == 2 && edges.duplicate[13] && edges.duplicate[14] && !edges.duplicate[0]);
    // the five edges of the first face, one of them also the fin's
    check(edges.many == 5 && edges.border == 2);
    size_t sizes = 0;
    for (size_t i = 0; i < edges.many; i++)
        for (size_t k = edges.fan_start[i]; k < edges.fan_start[i + 1]; k++, sizes++) {
            uint32_t a = edges.fan[edges.fan_start[i]], b = edges.fan[k];
            check(edges.twin[b] == DEM_EDGE_MANY);
            check(half_start(&three, a) + half_end(&three, a) == half_start(&three, b) + half_end(&three, b));
        }
    check(sizes == 4 + 4 + 3 + 3 + 3);
    dem_edges_release(&edges);
    dem_mesh_free(&box);
    dem_mesh_free(&three);
}

// quadratic work at one edge or vertex would take minutes here
static void a_hundred_thousand_triangles_at_one_edge_take_no_time(void **state)
{
    (void)state;
    enum { COUNT = 100000 };
    dem_mesh fan = {.vertices = malloc((COUNT + 2) * sizeof *fan.vertices), .triangles = malloc(3 * COUNT * sizeof *fan.triangles),
                    .vertex_count = COUNT + 2, .triangle_count = COUNT};
    check(fan.vertices && fan.triangles);
    for (uint32_t i = 0; i < COUNT + 2; i++)
        fan.vertices[i] = v3(i, (double)i * i, 1);
    for (uint32_t i = 0; i < COUNT; i++)
        memcpy(fan.triangles + 3 * i, (uint32_t[]){0, 1, 2 + i % (COUNT / 2)}, 3 * sizeof *fan.triangles);
    dem_edges edges = {0};
    dem_error error;
    check_ok(dem_edges_build(&edges, &fan, &error), error);
    check(edges.many == 1 && edges.duplicates == COUNT / 2 && edges.border == 0);
    dem_edges_release(&edges);
    dem_mesh_free(&fan);
}

static void triangles_that_name_a_vertex_twice_are_dropped(void **state)
{
    (void)state;
    dem_mesh mesh = shape_copy((dem_vec3[]){{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 3, (uint32_t[]){0, 0, 1, 0, 1, 2, 2, 1, 2}, 3);
    check(dem_mesh_drop_collapsed(&mesh) == 2 && mesh.triangle_count == 1 && mesh.triangles[2] == 2);
    dem_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loose_triangles_become_the_mesh_they_were),
        cmocka_unit_test(minus_zero_welds_to_zero_and_unused_vertices_go),
        cmocka_unit_test(noise_below_the_tolerance_is_welded_and_noise_above_is_not),
        cmocka_unit_test(only_marked_vertices_are_welded_by_tolerance),
        cmocka_unit_test(a_closed_mesh_has_a_twin_for_every_half_edge),
        cmocka_unit_test(edges_of_many_triangles_and_duplicates_are_found),
        cmocka_unit_test(a_hundred_thousand_triangles_at_one_edge_take_no_time),
        cmocka_unit_test(triangles_that_name_a_vertex_twice_are_dropped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
