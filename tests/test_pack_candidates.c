#include "check.h"
#include "shapes.h"

#include "clump/pack_candidates.h"

static void medial_balls_touch_where_they_were_sent_from_and_hold_no_surface(void **state)
{
    (void)state;
    dem_mesh meshes[2] = {shape_box(3, 2, 1), shape_sphere(5)};
    for (int m = 0; m < 2; m++) {
        dem_pack_grain grain;
        dem_error error;
        check_ok(dem_pack_grain_open(&meshes[m], &grain, &error), error);
        for (size_t t = 0; t < meshes[m].triangle_count; t++) {
            dem_vec3 c[3];
            dem_pack_grain_corners(&grain, t, c);
            dem_vec3 n = v3_unit(v3_cross(v3_sub(c[1], c[0]), v3_sub(c[2], c[0])));
            dem_vec3 p = v3_along(v3_scale(v3_add(c[0], v3_add(c[1], c[2])), 0.29), 0.13, c[0]);
            double r = dem_medial_radius(&grain.tree, p, n);
            double d = dem_tree_closest(&grain.tree, v3_along(p, -r, n), INFINITY, NULL, NULL);
            check(d <= r * (1 + 1e-12));      // it touches p
            check(d >= r * (1 - 3e-3));       // and holds nothing deeper than the tolerance of 2/1000
        }
        dem_pack_grain_close(&grain);
        dem_mesh_free(&meshes[m]);
    }
}

static void the_medial_ball_of_a_slab_spans_it(void **state)
{
    (void)state;
    dem_mesh box = shape_box(10, 10, 1);
    dem_pack_grain grain;
    dem_error error;
    check_ok(dem_pack_grain_open(&box, &grain, &error), error);
    dem_vec3 p = dem_pack_grain_enter(&grain, v3(5.2, 4.9, 1)), q = dem_pack_grain_enter(&grain, v3(5.2, 4.9, 0));
    double r = dem_medial_radius(&grain.tree, p, v3_unit(v3_sub(p, q)));
    check_close(r, 0.5 / grain.size, 2e-3);
    dem_pack_grain_close(&grain);
    dem_mesh_free(&box);
}

// the same choice as by computing every gain again each time
static void greedy_takes_the_ball_of_the_largest_gain_each_time(void **state)
{
    (void)state;
    dem_mesh box = shape_box(2, 1.5, 1);
    dem_pack_grain grain;
    dem_lattice lattice;
    dem_samples samples;
    dem_candidates candidates;
    dem_error error;
    check_ok(dem_pack_grain_open(&box, &grain, &error), error);
    check_ok(dem_lattice_build(&grain, 1500, &lattice, &error), error);
    check_ok(dem_samples_build(&grain, &lattice, 1024, 512, &samples, &error), error);
    const dem_pack_kernels *kernels = dem_pack_kernels_choose(NULL);
    check_ok(dem_candidates_build(&grain, &samples, kernels, 200, 1, &candidates, &error), error);
    const double inflations[2] = {0, 0.02};
    dem_ball chosen[40], again[40];
    size_t count;
    for (int threads = 1; threads <= 3; threads++) {
        dem_crew *crew = dem_crew_create(threads);
        dem_ball *to = threads > 1 ? again : chosen;
        check_ok(dem_candidates_greedy(&candidates, &lattice, kernels, inflations, 2, 40, crew, to, &count, &error),
                 error);
        dem_crew_destroy(crew);
        check(count == 40);
        check(memcmp(to, chosen, sizeof chosen) == 0);
    }
    dem_lattice_clear(&lattice);
    for (size_t k = 0; k < count; k++) {
        int64_t most = 0, taken = kernels->lattice_gain(&lattice, chosen[k], NULL);
        for (size_t i = 0; i < 2 * candidates.count; i++) {
            dem_ball ball = candidates.balls[i / 2];
            ball.radius += inflations[i % 2];
            int64_t gain = kernels->lattice_gain(&lattice, ball, NULL);
            most = gain > most ? gain : most;
        }
        // lazy: a gain may have risen unseen where what sticks out was covered by another ball
        check(taken >= most - most / 50);
        kernels->lattice_gain(&lattice, chosen[k], lattice.covered);
    }
    check(candidates.at_block[samples.surface_blocks] == candidates.count);
    dem_candidates_release(&candidates);
    dem_samples_release(&samples);
    dem_lattice_release(&lattice);
    dem_pack_grain_close(&grain);
    dem_mesh_free(&box);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(medial_balls_touch_where_they_were_sent_from_and_hold_no_surface),
        cmocka_unit_test(the_medial_ball_of_a_slab_spans_it),
        cmocka_unit_test(greedy_takes_the_ball_of_the_largest_gain_each_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
