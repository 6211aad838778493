// Lists of which little changes stay where they are: the rest of them, what contacts remember, and the way on from a
// saved state.
#include "sim/validate.h"
#include "worlds.h"

// more bodies than one domain has, so that some of the pairs are across
static model *colliding(void)
{
    model *m = model_new();
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.5;
    model_cloud(m, 9, 0.02, 1);
    model_lattice(m, 640, 0.0215, 2, 2);
    model_box(m, v3(0, 0, 0), v3(0.1935, 0.1935, 0.1935));
    return m;
}

static size_t idle_places(const dem_world *w)
{
    size_t idle = 0;
    for (size_t i = 0; i < w->segment_count; i++)
        idle += w->contacts.segments[i].idle;
    return idle;
}

static void most_changes_leave_the_list_in_place(void **state)
{
    (void)state;
    model *m = colliding();
    dem_world *w = model_world(m, 1);
    run_steps(w, 400);
    size_t rebuilt = 0, across = 0;
    for (int i = 0; i < 200; i++) {
        run_steps(w, 1);
        for (size_t k = 0; k < w->segment_count; k++)
            rebuilt += w->contacts.segments[k].built == w->steps;
    }
    // each would be rebuilt in nearly every step otherwise
    check(rebuilt > 0 && rebuilt < 200 * w->segment_count / 5);
    dem_truth truth;
    dem_error error;
    check_ok(dem_world_validate(w, &truth, &error), error);
    assert_int_equal(truth.missed + truth.doubled + truth.unsound, 0);
    for (size_t k = 0; k < w->segment_count; k++) {
        const dem_segment *s = &w->contacts.segments[k];
        size_t idle = 0;
        for (size_t at = s->begin; at < s->end; at++)
            idle += w->contacts.columns.a[at] == w->bodies.dummy;
        assert_int_equal(idle, s->idle);
        across += s->slot_count;
    }
    check(across > 0);
    dem_world_destroy(w);
    model_free(m);
}

typedef struct remembered {
    uint32_t key[4];
    double spring[3];
} remembered;

static int by_key(const void *a, const void *b)
{
    return memcmp(((const remembered *)a)->key, ((const remembered *)b)->key, sizeof((const remembered *)a)->key);
}

// the springs that are stretched, sorted by their spheres
static size_t remembered_by(const dem_world *w, remembered *out, size_t most)
{
    const dem_contact_columns *c = &w->contacts.columns;
    size_t count = 0;
    for (size_t k = 0; k < w->segment_count; k++)
        for (size_t at = w->contacts.segments[k].begin; at < w->contacts.segments[k].end; at++) {
            remembered r = {.key = {c->a[at], c->b[at], c->sphere_a[at], c->sphere_b[at]},
                            .spring = {c->spring[0][at], c->spring[1][at], c->spring[2][at]}};
            if (r.spring[0] == 0 && r.spring[1] == 0 && r.spring[2] == 0)
                continue;
            check(count < most && c->a[at] < w->bodies.count);
            out[count++] = r;
        }
    qsort(out, count, sizeof *out, by_key);
    return count;
}

// the twin rebuilds every list in every step in which bodies ask
static void springs_are_those_of_lists_that_are_rebuilt(void **state)
{
    (void)state;
    enum { MOST = 4096 };
    model *m = colliding();
    dem_world *w = model_world(m, 1), *twin = model_world(m, 1);
    for (int i = 0; i < 600; i++) {
        run_steps(w, 1);
        for (size_t k = 0; k < twin->segment_count; k++)
            twin->contacts.segments[k].dirty = true;
        run_steps(twin, 1);
    }
    static remembered own[MOST], other[MOST];
    size_t count = remembered_by(w, own, MOST);
    check(count > 100 && idle_places(w) > idle_places(twin));
    assert_int_equal(remembered_by(twin, other, MOST), count);
    double largest = 0, off = 0;
    for (size_t i = 0; i < count; i++) {
        assert_memory_equal(own[i].key, other[i].key, sizeof own[i].key);
        for (int k = 0; k < 3; k++) {
            largest = fmax(largest, fabs(own[i].spring[k]));
            off = fmax(off, fabs(own[i].spring[k] - other[i].spring[k]));
        }
    }
    // sums in another order, and some collisions since
    check(off < 1e-8 * largest);
    dem_world_destroy(w);
    dem_world_destroy(twin);
    model_free(m);
}

static void a_run_goes_on_from_patched_lists_bit_for_bit(void **state)
{
    (void)state;
    model *m = colliding();
    dem_world *w = model_world(m, 2);
    run_steps(w, 500);
    check(idle_places(w) > 4 * w->segment_count);
    dem_world *resumed[2] = {model_resumed(m, w, 1), model_resumed(m, w, 2)};
    run_steps(w, 300);
    for (int i = 0; i < 2; i++) {
        run_steps(resumed[i], 300);
        check(dem_world_hash(resumed[i]) == dem_world_hash(w));
        assert_int_equal(idle_places(resumed[i]), idle_places(w));
        dem_world_destroy(resumed[i]);
    }
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(most_changes_leave_the_list_in_place),
        cmocka_unit_test(springs_are_those_of_lists_that_are_rebuilt),
        cmocka_unit_test(a_run_goes_on_from_patched_lists_bit_for_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
