#include "check.h"
#include "shapes.h"

#include "base/level.h"
#include "base/random.h"
#include "clump/pack_lines.h"
#include "clump/packing.h"
#include "geom/union.h"

enum { BALLS = 24 };

typedef struct fixture {
    dem_mesh mesh;
    dem_pack_grain grain;
    dem_ball balls[BALLS];
    float columns[4][32];
    dem_ball_columns view;
} fixture;

static void show(fixture *f)
{
    f->view = (dem_ball_columns){.x = f->columns[0], .y = f->columns[1], .z = f->columns[2], .r = f->columns[3]};
    dem_ball_columns_set(&f->view, f->balls, BALLS);
}

static void open_fixture(fixture *f)
{
    f->mesh = shape_box(2, 1.4, 1);
    dem_error error;
    dem_random r = random_stream(11, 0);
    check_ok(dem_pack_grain_open(&f->mesh, &f->grain, &error), error);
    for (int i = 0; i < BALLS; i++) {
        double x = random_uniform(&r) - 0.5, y = random_uniform(&r) - 0.5, z = random_uniform(&r) - 0.5;
        f->balls[i] = (dem_ball){v3_scale(v3(x, y, z), 0.7), 0.08 + 0.12 * random_uniform(&r)};
    }
}

static void close_fixture(fixture *f)
{
    dem_pack_grain_close(&f->grain);
    dem_mesh_free(&f->mesh);
}

static void build(const fixture *f, const dem_pack_kernels *kernels, double step, dem_crew *crew, dem_lines *lines)
{
    dem_error error;
    check_ok(dem_lines_build(&f->grain, kernels, step, (const double[2]){0.38197, 0.2764}, BALLS, crew, lines, &error),
             error);
}

static dem_line_volumes measure(fixture *f, dem_lines *lines, double (*gradient)[4])
{
    dem_line_volumes volumes;
    dem_error error;
    show(f);
    check_ok(dem_lines_measure(lines, &f->view, gradient, &volumes, &error), error);
    return volumes;
}

static void volumes_by_lines_are_the_exact_ones(void **state)
{
    (void)state;
    fixture f;
    open_fixture(&f);
    dem_lines lines;
    build(&f, dem_pack_kernels_choose(NULL), 0.005, NULL, &lines);
    dem_line_volumes v = measure(&f, &lines, NULL);
    dem_ball_union exact;
    dem_error error;
    check_ok(dem_ball_union_compute(f.balls, BALLS, false, 1, &exact, &error), error);
    check_close(v.grain, f.grain.moments.volume, 1e-4);    // lines 1/200 of d_eq apart
    check_close(v.covered, exact.moments.volume, 1e-4);
    check_near(v.difference, v.grain + v.covered - 2 * v.common, 1e-12);
    check_near(v.gap, 1 - v.common / (v.grain + v.covered - v.common), 1e-12);
    // the common volume by another count: points of a lattice
    dem_random r = random_stream(5, 0);
    int common = 0, points = 40000;
    for (int k = 0; k < points; k++) {
        double x = random_uniform(&r) - 0.5, y = random_uniform(&r) - 0.5, z = random_uniform(&r) - 0.5;
        dem_vec3 p = v3_scale(v3(x, y, z), 2);
        bool covered = false;
        for (int i = 0; i < BALLS && !covered; i++)
            covered = v3_distance(p, f.balls[i].centre) < f.balls[i].radius;
        common += covered && dem_tree_inside(&f.grain.tree, p);
    }
    check_close(8.0 * common / points, v.common, 0.06);    // 3 sigma of some 2000 hits
    dem_ball_union_release(&exact);
    dem_lines_release(&lines);
    close_fixture(&f);
}

// the flux is not the derivative of the discrete sum, but comes to it on average over the places of the lines
static void the_gradient_is_that_of_finite_differences(void **state)
{
    (void)state;
    fixture f;
    open_fixture(&f);
    dem_lines lines;
    build(&f, dem_pack_kernels_choose(NULL), 0.004, NULL, &lines);
    double gradient[BALLS][4], error2 = 0, size2 = 0;
    for (int weighted = 0; weighted < 2; weighted++) {
        lines.protruding = weighted ? 7 : 1;
        measure(&f, &lines, gradient);
        for (int i = 0; i < BALLS; i++)
            for (int k = 0; k < 4; k++) {
                const double step = 4e-3;
                dem_ball ball = f.balls[i];
                double value[2];
                for (int side = 0; side < 2; side++) {
                    dem_ball moved = ball;
                    if (k < 3)
                        v3_set(&moved.centre, k, v3_get(ball.centre, k) + (side ? step : -step));
                    else
                        moved.radius += side ? step : -step;
                    f.balls[i] = moved;
                    value[side] = measure(&f, &lines, NULL).difference;
                }
                f.balls[i] = ball;
                double difference = (value[1] - value[0]) / (2 * step) - gradient[i][k];
                error2 += difference * difference;
                size2 += gradient[i][k] * gradient[i][k];
            }
    }
    check(sqrt(error2 / size2) < 0.03);
    dem_lines_release(&lines);
    close_fixture(&f);
}

static void lines_give_the_same_bits_on_every_instruction_set_and_for_any_number_of_threads(void **state)
{
    (void)state;
    fixture f;
    open_fixture(&f);
    dem_line_volumes first = {0};
    double first_gradient[BALLS][4];
    bool have = false;
    for (int s = 0; s < DEM_LEVELS; s++) {
        const dem_pack_kernels *kernels = dem_pack_kernels_choose(dem_level_name(s));
        for (int threads = 1; kernels && threads <= 3; threads++) {
            double gradient[BALLS][4];
            dem_lines lines;
            dem_crew *crew = dem_crew_create(threads);
            build(&f, kernels, 0.0125, crew, &lines);
            dem_line_volumes v = measure(&f, &lines, gradient);
            if (!have) {
                first = v;
                memcpy(first_gradient, gradient, sizeof gradient);
                have = true;
            }
            check(memcmp(&v, &first, sizeof v) == 0);
            check(memcmp(gradient, first_gradient, sizeof gradient) == 0);
            dem_lines_release(&lines);
            dem_crew_destroy(crew);
        }
    }
    close_fixture(&f);
}

static dem_ball moved(dem_ball ball, dem_random *r, double most)
{
    double step = most * random_uniform(r), swell = (most - step) * (2 * random_uniform(r) - 1);
    dem_vec3 d = v3_unit(v3(random_uniform(r) - 0.5, random_uniform(r) - 0.5, random_uniform(r) - 0.5));
    return (dem_ball){v3_along(ball.centre, step, d), ball.radius + swell};
}

// leaves nothing out
static void cull_nothing(const dem_ball_columns *balls, dem_line_task *task, const dem_strip_lists *from,
                         dem_strip_lists *to, float slack)
{
    (void)balls, (void)slack;
    uint32_t strips = task->field->strip[task->end] - task->field->strip[task->begin];
    memmove(to->start, from->start, (strips + 1) * sizeof *to->start);
    memmove(to->list, from->list, from->start[strips] * sizeof *to->list);
}

// hidden balls are left out of the lists only as long as they cannot come out
static void lists_that_balls_have_moved_under_give_what_all_balls_give(void **state)
{
    (void)state;
    enum { MANY = 160, PLACES = 6, FAR = 4 };  // at place FAR they have gone too far for the lists
    fixture f;
    open_fixture(&f);
    float columns[4][MANY];
    dem_ball start[MANY], balls[MANY];
    dem_ball_columns view = {.x = columns[0], .y = columns[1], .z = columns[2], .r = columns[3]};
    dem_random r = random_stream(12, 0);
    for (int i = 0; i < MANY; i++) {
        double x = random_uniform(&r) - 0.5, y = random_uniform(&r) - 0.5, z = random_uniform(&r) - 0.5;
        start[i] = (dem_ball){v3_scale(v3(x, y, z), 0.6), 0.02 + 0.18 * random_uniform(&r)};
    }
    const double offsets[2] = {0.38197, 0.2764};
    int made_close = 0;
    dem_pack_kernels full = *dem_pack_kernels_choose(NULL);
    dem_line_kernels full_lines = *full.lines;
    full_lines.cull = cull_nothing;
    full.lines = &full_lines;
    dem_lines old, fresh;
    dem_error error;
    check_ok(dem_lines_build(&f.grain, dem_pack_kernels_choose(NULL), 0.01, offsets, MANY, NULL, &old, &error), error);
    for (int place = 0; place < PLACES; place++) {
        double gradient[2][MANY][4];
        dem_line_volumes volumes[2];
        for (int i = 0; i < MANY; i++)
            balls[i] = place ? moved(start[i], &r, place < FAR ? 0.011 : 0.05) : start[i];
        dem_ball_columns_set(&view, balls, MANY);
        check_ok(dem_lines_build(&f.grain, &full, 0.01, offsets, MANY, NULL, &fresh, &error), error);
        check_ok(dem_lines_measure(&old, &view, gradient[0], &volumes[0], &error), error);
        check_ok(dem_lines_measure(&fresh, &view, gradient[1], &volumes[1], &error), error);
        check(old.make_wide == (place == 0 || place >= FAR));
        made_close += old.make_close;
        check(memcmp(&volumes[0], &volumes[1], sizeof *volumes) == 0);
        check(memcmp(gradient[0], gradient[1], sizeof *gradient) == 0);
        dem_lines_release(&fresh);
    }
    check(made_close > 3);  // more often than the wide ones
    dem_lines_release(&old);
    close_fixture(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volumes_by_lines_are_the_exact_ones),
        cmocka_unit_test(the_gradient_is_that_of_finite_differences),
        cmocka_unit_test(lines_give_the_same_bits_on_every_instruction_set_and_for_any_number_of_threads),
        cmocka_unit_test(lists_that_balls_have_moved_under_give_what_all_balls_give),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
