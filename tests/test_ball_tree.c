#include "check.h"

#include "base/random.h"
#include "geom/ball_tree.h"

enum { COUNT = 300 };

static void make_balls(dem_ball *balls, size_t count)
{
    dem_random r = random_stream(21, 0);
    for (size_t i = 0; i < count; i++) {
        double x = random_uniform(&r), y = random_uniform(&r), z = random_uniform(&r);
        balls[i] = (dem_ball){v3(x, y, z), i % 40 == 0 ? 0.3 * random_uniform(&r) : 0.05 * random_uniform(&r)};
    }
    balls[7] = balls[8] = balls[9];
}

static void every_item_stands_in_one_leaf_inside_the_boxes_above_it(void **state)
{
    (void)state;
    dem_ball balls[COUNT];
    make_balls(balls, COUNT);
    for (size_t count = 1; count <= COUNT; count += count < 20 ? 1 : 93) {
        dem_ball_tree tree;
        dem_error error;
        int seen[COUNT] = {0};
        check_ok(dem_ball_tree_build(&tree, balls, count, &error), error);
        for (uint32_t n = 0; n < tree.boxes.node_count; n++) {
            const dem_box_node *node = &tree.boxes.nodes[n];
            for (uint32_t i = node->begin; i < node->end; i++) {
                dem_ball ball = balls[tree.boxes.order[i]];
                seen[tree.boxes.order[i]] += node->right == 0;
                for (int k = 0; k < 3; k++) {
                    check(v3_get(ball.centre, k) - ball.radius >= v3_get(node->box.low, k));
                    check(v3_get(ball.centre, k) + ball.radius <= v3_get(node->box.high, k));
                }
            }
        }
        for (size_t i = 0; i < count; i++)
            check(seen[i] == 1);
        dem_ball_tree_release(&tree);
    }
}

static void the_balls_near_a_ball_are_those_all_pairs_find(void **state)
{
    (void)state;
    dem_ball balls[COUNT];
    make_balls(balls, COUNT);
    dem_ball_tree tree;
    dem_error error;
    check_ok(dem_ball_tree_build(&tree, balls, COUNT, &error), error);
    for (size_t i = 0; i < COUNT; i++)
        for (int k = -1; k <= 1; k++) {
            double gap = 0.02 * k;
            uint32_t found[COUNT];
            int near[COUNT] = {0};
            size_t count = dem_ball_tree_near(&tree, balls[i], gap, found);
            for (size_t n = 0; n < count; n++)
                near[found[n]]++;
            for (size_t j = 0; j < COUNT; j++) {
                double sum = balls[i].radius + balls[j].radius + gap;
                bool want = v3_distance(balls[i].centre, balls[j].centre) < sum;
                check(near[j] == want);
            }
        }
    dem_ball_tree_release(&tree);
}

static void the_level_of_a_point_is_that_of_its_nearest_ball(void **state)
{
    (void)state;
    dem_ball balls[COUNT];
    make_balls(balls, COUNT);
    dem_ball_tree tree;
    dem_error error;
    check_ok(dem_ball_tree_build(&tree, balls, COUNT, &error), error);
    dem_random r = random_stream(22, 0);
    for (int i = 0; i < 2000; i++) {
        double x = random_uniform(&r), y = random_uniform(&r), z = random_uniform(&r), want = INFINITY;
        dem_vec3 p = v3(2 * x - 0.5, 2 * y - 0.5, 2 * z - 0.5);
        for (size_t j = 0; j < COUNT; j++)
            want = fmin(want, v3_distance(p, balls[j].centre) - balls[j].radius);
        uint32_t nearest = COUNT;
        check((dem_ball_tree_level(&tree, p, INFINITY, 0, NULL) < 0) == (want < 0));
        check_near(dem_ball_tree_level(&tree, p, INFINITY, -INFINITY, &nearest), want, 1e-15);
        check_near(v3_distance(p, balls[nearest].centre) - balls[nearest].radius, want, 1e-15);
        check_near(dem_ball_tree_level(&tree, p, want - 0.01, -INFINITY, NULL), want - 0.01, 0);
        check_near(dem_ball_tree_level(&tree, p, want + 0.01, -INFINITY, NULL), want, 1e-15);
    }
    dem_ball_tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_item_stands_in_one_leaf_inside_the_boxes_above_it),
        cmocka_unit_test(the_balls_near_a_ball_are_those_all_pairs_find),
        cmocka_unit_test(the_level_of_a_point_is_that_of_its_nearest_ball),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
