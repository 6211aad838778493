#include "shapes.h"

#include "base/random.h"
#include "geom/lines.h"
#include "geom/union.h"

static const dem_vec3 along[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static dem_bundle_volumes measure(const dem_mesh *mesh, const dem_ball *balls, size_t count, dem_quat turn,
                                  double spacing, int threads)
{
    dem_line_bodies bodies = {mesh->vertices, mesh->triangles, mesh->vertex_count, mesh->triangle_count, balls, count};
    dem_line_bundle bundle = {.spacing = spacing};
    for (int k = 0; k < 3; k++)
        bundle.axis[k] = quat_rotate(turn, along[k]);
    dem_bundle_volumes groups[DEM_LINE_GROUPS], sum = {0};
    dem_error error;
    check_ok(dem_line_bundle_measure(&bodies, &bundle, threads, groups, &error), error);
    for (int g = 0; g < DEM_LINE_GROUPS; g++) {
        sum.mesh += groups[g].mesh / DEM_LINE_GROUPS;
        sum.balls += groups[g].balls / DEM_LINE_GROUPS;
        sum.both += groups[g].both / DEM_LINE_GROUPS;
        sum.lines += groups[g].lines;
        sum.broken += groups[g].broken;
    }
    return sum;
}

static dem_quat random_turn(dem_random *r)
{
    double w = random_normal(r), x = random_normal(r), y = random_normal(r), z = random_normal(r);
    return quat_unit((dem_quat){w, x, y, z});
}

static void volumes_converge_to_those_of_the_bodies(void **state)
{
    (void)state;
    dem_random r = random_stream(31, 0);
    dem_mesh box = shape_box(3, 2, 1);
    // one ball inside the box, one half in it, two that overlap outside
    dem_ball balls[4] = {{{1, 1, 0.5}, 0.4}, {{3, 1, 0.5}, 0.3}, {{5, 1, 1}, 0.5}, {{5.4, 1, 1}, 0.5}};
    dem_ball_union u;
    dem_error error;
    check_ok(dem_ball_union_compute(balls, 4, false, 1, &u, &error), error);
    double inside = 4 * DEM_PI / 3 * (0.064 + 0.027 / 2);
    for (int i = 0; i < 6; i++) {
        dem_bundle_volumes v = measure(&box, balls, 4, random_turn(&r), 0.01, 1);
        check(v.broken == 0);
        // corners of a lattice cell of 1e-4 along edges of length 24: far below a permille
        check_close(v.mesh, 6.0, 2e-4);
        check_close(v.balls, u.moments.volume, 2e-4);
        check_close(v.both, inside, 5e-4);
    }
    dem_ball_union_release(&u);
    dem_mesh_free(&box);
}

static void a_hollow_mesh_counts_without_its_hollow(void **state)
{
    (void)state;
    dem_mesh mesh = shape_sphere(20), hollow = shape_sphere(20);
    shape_scale(&hollow, 0.5, 0.5, 0.5);
    shape_flip(&hollow, 0, hollow.triangle_count);
    double whole = dem_mesh_solid(&mesh).volume;
    shape_append(&mesh, &hollow, 0, hollow.triangle_count);
    dem_ball ball = {{0, 0, 0}, 0.3};
    dem_bundle_volumes v = measure(&mesh, &ball, 1, (dem_quat){0.5, 0.5, 0.5, 0.5}, 0.01, 1);
    check_close(v.mesh, whole * 7 / 8, 1e-3);
    check_near(v.both, 0, 0);
    dem_mesh_free(&mesh);
    dem_mesh_free(&hollow);
}

static void shells_that_overlap_count_once(void **state)
{
    (void)state;
    dem_mesh mesh = shape_box(1, 1, 1), other = shape_box(1, 1, 1);
    shape_move(&other, (dem_quat){1, 0, 0, 0}, v3(0.5, 0, 0.3));
    shape_append(&mesh, &other, 0, 12);
    dem_ball ball = {{0.75, 0.5, 0.6}, 0.2};
    dem_bundle_volumes v = measure(&mesh, &ball, 1, quat_unit((dem_quat){0.7, 0.2, -0.4, 0.3}), 0.01, 1);
    check_close(v.mesh, 2 - 0.5 * 0.7, 1e-3);
    check_close(v.both, 4 * DEM_PI / 3 * 0.008, 1e-3);
    dem_mesh_free(&mesh);
    dem_mesh_free(&other);
}

static void balls_in_a_row_are_told_apart(void **state)
{
    (void)state;
    dem_mesh box = shape_box(1, 1, 1);
    dem_ball balls[7];
    for (int i = 0; i < 7; i++)
        balls[i] = (dem_ball){{0, 0, (double)((i * 3) % 7)}, i % 2 ? 0.4 : 0.6};
    dem_ball_union u;
    dem_error error;
    check_ok(dem_ball_union_compute(balls, 7, false, 1, &u, &error), error);
    dem_bundle_volumes v = measure(&box, balls, 7, (dem_quat){1, 0, 0, 0}, 0.005, 1);
    check_close(v.balls, u.moments.volume, 5e-4);
    dem_ball_union_release(&u);
    dem_mesh_free(&box);
}

static void lines_along_edges_do_not_leak(void **state)
{
    (void)state;
    // the first lines of row 8 run through the middle of a double pyramid and along the edges of its roof
    double h = 0.1, golden = 0.61803398874989485, low = -1;
    double x0 = low - 0.38196601125 * h, y0 = low - 0.27639320225 * h, shift = golden * 8;
    double y = y0 + h * 8, x = x0 + h * (shift - floor(shift)) + h * 8;
    dem_vec3 corners[6] = {{-1, y, 0}, {1, y, 0}, {x, -1, 0}, {x, 1, 0}, {x, y, 1}, {x, y, -1}};
    uint32_t faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    dem_ball ball = {{0, 0, 0}, 0.1};
    for (int trial = 0; trial < 6; trial++) {
        // other vertex numbers, other ties
        uint32_t name[6], turned[24];
        dem_vec3 moved[6];
        for (uint32_t k = 0; k < 6; k++) {
            name[k] = trial < 3 ? (k + 2 * (uint32_t)trial) % 6 : 5 - (k + 2 * (uint32_t)trial) % 6;
            moved[name[k]] = corners[k];
        }
        for (int k = 0; k < 24; k++)
            turned[k] = name[faces[k]];
        dem_mesh mesh = shape_copy(moved, 6, turned, 8);
        dem_bundle_volumes v = measure(&mesh, &ball, 1, (dem_quat){1, 0, 0, 0}, h, 1);
        check(v.broken <= 1);  // the line through both tips may be left out, none through edges only
        check_close(v.mesh, dem_mesh_solid(&mesh).volume, 0.02);
        dem_mesh_free(&mesh);
    }
}

static void an_open_mesh_is_noticed(void **state)
{
    (void)state;
    dem_mesh box = shape_box(1, 1, 1);
    box.triangle_count = 11;
    dem_ball ball = {{0.5, 0.5, 0.5}, 0.1};
    dem_bundle_volumes v = measure(&box, &ball, 1, (dem_quat){0.9, 0.1, 0.3, 0.2}, 0.02, 1);
    check(v.broken > v.lines / 10);
    check(v.broken < v.lines / 2);
    dem_mesh_free(&box);
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(12);
    dem_ball balls[2] = {{{0.2, 0, 0}, 0.5}, {{-0.3, 0.1, 0}, 0.45}};
    dem_quat turn = quat_unit((dem_quat){0.7, 0.2, -0.4, 0.3});
    dem_bundle_volumes one = measure(&mesh, balls, 2, turn, 0.03, 1);
    for (int threads = 2; threads <= 8; threads *= 2) {
        dem_bundle_volumes many = measure(&mesh, balls, 2, turn, 0.03, threads);
        check(many.mesh == one.mesh && many.balls == one.balls && many.both == one.both && many.lines == one.lines);
    }
    dem_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volumes_converge_to_those_of_the_bodies),
        cmocka_unit_test(a_hollow_mesh_counts_without_its_hollow),
        cmocka_unit_test(shells_that_overlap_count_once),
        cmocka_unit_test(balls_in_a_row_are_told_apart),
        cmocka_unit_test(lines_along_edges_do_not_leak),
        cmocka_unit_test(an_open_mesh_is_noticed),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
