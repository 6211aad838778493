// Near pairs, candidates and lists against every sphere compared with every other, while bodies fly about and collide.
#include "sim/validate.h"
#include "worlds.h"

typedef struct tally {
    size_t contacts, walls;
} tally;

// runs and looks several times; something must have touched
static tally run_and_compare(const model *m, int looks, uint64_t steps)
{
    tally t = {0};
    dem_world *w = model_world(m, 1);
    for (int i = 0; i < looks; i++) {
        dem_truth truth;
        dem_error error;
        check_ok(dem_world_validate(w, &truth, &error), error);
        assert_int_equal(truth.missed, 0);
        assert_int_equal(truth.doubled, 0);
        assert_int_equal(truth.unsound, 0);
        t.contacts += truth.contacts;
        t.walls += truth.walls;
        run_steps(w, steps);
    }
    dem_world_destroy(w);
    return t;
}

static void nothing_is_missed_among_single_spheres(void **state)
{
    (void)state;
    model *m = model_new();
    model_sphere(m, 0.01);
    model_lattice(m, 200, 0.024, 3, 1);
    model_box(m, v3(0, 0, 0), v3(0.144, 0.144, 0.144));
    tally t = run_and_compare(m, 20, 61);
    check(t.contacts > 20 && t.walls > 20);
    model_free(m);
}

static void nothing_is_missed_among_clumps(void **state)
{
    (void)state;
    model *m = model_new();
    model_cloud(m, 12, 0.02, 1);
    model_cloud(m, 33, 0.02, 2);
    model_sphere(m, 0.007);
    model_lattice(m, 125, 0.026, 3, 2);
    model_box(m, v3(0, 0, 0), v3(0.13, 0.13, 0.13));
    tally t = run_and_compare(m, 20, 61);
    check(t.contacts > 20 && t.walls > 20);
    model_free(m);
}

static void nothing_is_missed_when_sizes_span_a_factor_of_a_hundred(void **state)
{
    (void)state;
    model *m = model_new();
    m->laws[0].stiffness = 10;
    model_sphere(m, 0.001);
    model_cloud(m, 20, 0.002, 3);
    dem_body_def *big = model_body(m, 0, v3(0.15, 0.15, 0.15));
    big->scale = 100;
    big = model_body(m, 1, v3(0.38, 0.15, 0.15));
    big->scale = 80;
    dem_random r = random_stream(5, 5);
    for (int i = 0; i < 300; i++) {
        dem_body_def *b = model_body(m, (uint32_t)(i % 2), random_in(&r, v3(0.24, 0.05, 0.05), v3(0.30, 0.25, 0.25)));
        b->scale = 1 + 3 * random_uniform(&r);
        b->velocity = v3_scale(random_in(&r, v3(-1, -1, -1), v3(1, 1, 1)), 5);
    }
    model_box(m, v3(0, 0, 0), v3(0.6, 0.3, 0.3));
    tally t = run_and_compare(m, 12, 41);
    check(t.contacts > 50);
    model_free(m);
}

static void nothing_is_missed_between_clumps_of_a_thousand_spheres(void **state)
{
    (void)state;
    model *m = model_new();
    model_cloud(m, 1000, 0.02, 4);
    model_lattice(m, 8, 0.0215, 2, 3);
    model_box(m, v3(0, 0, 0), v3(0.043, 0.043, 0.043));
    tally t = run_and_compare(m, 5, 150);
    check(t.contacts > 100 && t.walls > 20);
    model_free(m);
}

// thinner than a body: it meets its own images
static void nothing_is_missed_in_thin_periodic_boxes(void **state)
{
    (void)state;
    for (int thin = 0; thin < 3; thin++) {
        model *m = model_new();
        model_cloud(m, 15, 0.02, 6);
        model_sphere(m, 0.009);
        model_lattice(m, 24, 0.024, 3, 4);
        m->scene.domain.low = v3(0, 0, 0);
        m->scene.domain.high = v3(0.075, 0.07, 0.072);
        v3_set(&m->scene.domain.high, thin, thin == 2 ? 0.019 : 0.03);
        for (int k = 0; k < 3; k++)
            m->scene.domain.periodic[k] = true;
        tally t = run_and_compare(m, 12, 31);
        check(t.contacts > 20);
        model_free(m);
    }
}

static void nothing_is_missed_in_a_slit_with_walls_and_periodic_sides(void **state)
{
    (void)state;
    model *m = model_new();
    model_cloud(m, 9, 0.02, 7);
    model_lattice(m, 64, 0.026, 3, 5);
    m->scene.domain.low = v3(0, 0, -1);
    m->scene.domain.high = v3(0.104, 0.104, 1);
    m->scene.domain.periodic[0] = m->scene.domain.periodic[1] = true;
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    model_plane(m, v3(0, 0, 0.104), v3(0, 0, -1));
    tally t = run_and_compare(m, 15, 61);
    check(t.contacts > 10 && t.walls > 10);
    model_free(m);
}

// 10 : 1 and 5 : 5 : 1, off their centres of mass
static void add_rod_and_plate(model *m)
{
    dem_ball rod[12], plate[25];
    for (int i = 0; i < 12; i++)
        rod[i] = (dem_ball){v3((i - 5) * 1.6e-3, 0, 0), 1e-3};
    for (int i = 0; i < 25; i++)
        plate[i] = (dem_ball){v3((i % 5 - 1.8) * 2e-3, (i / 5 - 2) * 2e-3, 0), 1e-3};
    model_clump(m, rod, 12, 1.4e-4, (double[]){1e-10, 4e-9, 4e-9});
    model_clump(m, plate, 25, 2e-4, (double[]){1.7e-9, 1.7e-9, 3.4e-9});
}

static void nothing_is_missed_among_rods_and_plates(void **state)
{
    (void)state;
    for (int periodic = 0; periodic < 2; periodic++) {
        model *m = model_new();
        add_rod_and_plate(m);
        model_lattice(m, 125, 0.014, 2, 8);
        model_box(m, v3(-0.01, -0.01, -0.01), v3(0.08, 0.08, 0.08));
        if (periodic) {
            m->scene.wall_count = 0;
            m->scene.domain.low = v3(0, 0, 0);
            m->scene.domain.high = v3(0.07, 0.07, 0.07);
            for (int k = 0; k < 3; k++)
                m->scene.domain.periodic[k] = true;
        }
        tally t = run_and_compare(m, 20, 61);
        check(t.contacts > 40);
        model_free(m);
    }
}

// centres stay where they are: only their turning brings rods to each other
static void nothing_is_missed_among_rods_that_spin_in_place(void **state)
{
    (void)state;
    model *m = model_new();
    add_rod_and_plate(m);
    m->scene.shape_count = 1;
    model_lattice(m, 125, 0.0135, 0, 9);
    for (size_t i = 0; i < m->scene.bodies.count; i++) {
        dem_body_def *b = &m->bodies[i];
        b->orientation = (dem_quat){1, 0, 0, 0};
        b->spin = v3(0, i % 2 ? 300 : -200, i % 3 ? 150 : 250);
    }
    tally t = run_and_compare(m, 40, 7);
    check(t.contacts > 50);
    model_free(m);
}

// pairs whose boxes are far from each other are not kept
static void parallel_rods_have_few_near_pairs(void **state)
{
    (void)state;
    model *m = model_new();
    add_rod_and_plate(m);
    for (int i = 0; i < 64; i++)
        model_body(m, 0, v3(0, i % 8 * 4e-3, i / 8 * 4e-3));
    dem_world *w = model_world(m, 1);
    // beside, above and across; their balls are all near to each other
    check(w->skin > 2e-3 && w->skin < 6e-3);
    assert_int_equal(w->pairs.count, 2 * 7 * 8 + 2 * 7 * 7);
    dem_world_destroy(w);
    model_free(m);
}

// a far outlier does not cost the grid its cells, nor the others their pairs
static void nothing_is_missed_with_bodies_far_away(void **state)
{
    (void)state;
    model *m = model_new();
    model_sphere(m, 0.01);
    model_lattice(m, 64, 0.0202, 1, 6);
    model_body(m, 0, v3(1e5, -3e4, 2e4));
    model_body(m, 0, v3(1e5 + 0.019, -3e4, 2e4));
    model_body(m, 0, v3(-40, 0, 0));
    tally t = run_and_compare(m, 10, 53);
    check(t.contacts > 20);
    model_free(m);
}

static void nothing_is_missed_inside_and_outside_of_cylinders(void **state)
{
    (void)state;
    model *m = model_new();
    model_cloud(m, 10, 0.02, 8);
    model_lattice(m, 27, 0.026, 3, 7);
    dem_wall_def *drum = model_plane(m, v3(0.039, 0.039, 0), v3(0, 0, 1));
    drum->kind = DEM_WALL_CYLINDER;
    drum->radius = 0.06;
    dem_wall_def *pin = model_plane(m, v3(0.039, 0.1, 0.039), v3(1, 0, 0));
    pin->kind = DEM_WALL_CYLINDER;
    pin->radius = 0.02;
    pin->outside = true;
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    model_plane(m, v3(0, 0, 0.1), v3(0, 0, -1));
    tally t = run_and_compare(m, 15, 61);
    check(t.walls > 20);
    model_free(m);
}

// moving walls come to bodies that do not move themselves
static void nothing_is_missed_when_walls_move(void **state)
{
    (void)state;
    model *m = model_new();
    model_cloud(m, 10, 0.02, 9);
    model_lattice(m, 27, 0.026, 0, 8);
    model_plane(m, v3(0, 0, -0.02), v3(0, 0, 1))->velocity = v3(0, 0, 2);
    dem_wall_def *door = model_plane(m, v3(-0.02, 0, 0), v3(1, 0, 0));
    door->spin = v3(0, 0, -20);
    door->through = v3(-0.02, -0.3, 0);
    tally t = run_and_compare(m, 20, 61);
    check(t.walls > 20);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_missed_among_single_spheres),
        cmocka_unit_test(nothing_is_missed_among_clumps),
        cmocka_unit_test(nothing_is_missed_when_sizes_span_a_factor_of_a_hundred),
        cmocka_unit_test(nothing_is_missed_between_clumps_of_a_thousand_spheres),
        cmocka_unit_test(nothing_is_missed_in_thin_periodic_boxes),
        cmocka_unit_test(nothing_is_missed_in_a_slit_with_walls_and_periodic_sides),
        cmocka_unit_test(nothing_is_missed_with_bodies_far_away),
        cmocka_unit_test(nothing_is_missed_inside_and_outside_of_cylinders),
        cmocka_unit_test(nothing_is_missed_when_walls_move),
        cmocka_unit_test(nothing_is_missed_among_rods_and_plates),
        cmocka_unit_test(nothing_is_missed_among_rods_that_spin_in_place),
        cmocka_unit_test(parallel_rods_have_few_near_pairs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
