// When pairs are searched for: as seldom as the motion allows, and no later.
#include "sim/validate.h"
#include "worlds.h"

// returns how many contacts there are
static size_t check_nothing_missed(const dem_world *w)
{
    dem_truth truth;
    dem_error error;
    check_ok(dem_world_validate(w, &truth, &error), error);
    assert_int_equal(truth.missed + truth.doubled + truth.unsound, 0);
    return truth.contacts;
}

static void bodies_that_move_together_need_no_search(void **state)
{
    (void)state;
    model *m = model_new();
    model_cloud(m, 8, 0.02, 1);
    model_lattice(m, 64, 0.03, 0, 2);
    for (size_t i = 0; i < m->scene.bodies.count; i++)
        m->bodies[i].velocity = v3(1.5, -0.3, -2);
    dem_world *w = model_world(m, 1);
    uint64_t before = w->searches;
    run_steps(w, 4000);
    // 0.1 m, fifty times as far as two bodies may go that move towards each other
    check(w->searches <= before + 1);
    check_nothing_missed(w);
    dem_world_destroy(w);
    model_free(m);
}

// a lattice falls on one that lies: what meets was not near at the start
static void falling_bodies_find_those_that_lie(void **state)
{
    (void)state;
    model *m = model_new();
    model_sphere(m, 0.01);
    model_lattice(m, 128, 0.022, 0, 4);
    for (size_t i = 0; i < m->scene.bodies.count; i++)
        if (m->bodies[i].position.z > 0.06) {
            m->bodies[i].position.z += 0.01 + 0.002 * (double)(i % 7);
            m->bodies[i].velocity = v3(0.5, 0.5, -3);
        }
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    uint64_t before = w->searches;
    size_t contacts = 0;
    for (int i = 0; i < 100; i++) {
        run_steps(w, 21);
        contacts += check_nothing_missed(w);
    }
    check(contacts > 1000);
    // about one for each skin that they come nearer, and some for what flies off
    check(w->searches > before + 5 && w->searches < before + 80);
    dem_world_destroy(w);
    model_free(m);
}

// centres count: a ball that spins goes nowhere
static void spinning_bodies_need_no_search(void **state)
{
    (void)state;
    model *m = model_new();
    model_cloud(m, 8, 0.02, 5);
    model_lattice(m, 27, 0.025, 0, 6);
    for (size_t i = 0; i < m->scene.bodies.count; i++)
        m->bodies[i].spin = v3(100, -40, 60);
    dem_world *w = model_world(m, 1);
    uint64_t before = w->searches;
    run_steps(w, 3000);
    assert_int_equal(w->searches, before);
    check_nothing_missed(w);
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_that_move_together_need_no_search),
        cmocka_unit_test(falling_bodies_find_those_that_lie),
        cmocka_unit_test(spinning_bodies_need_no_search),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
