// Bodies that come through inlets and go out of the domain: how many, where, and that nothing else notices.
#include "dem/scene.h"
#include "same_bits.h"
#include "sim/lists.h"
#include "sim/population.h"
#include "sim/validate.h"
#include "worlds.h"

static const double RADIUS = 0.01;

typedef struct feed {
    model *m;
    dem_mix_def mix[2];
    dem_inlet_def inlets[2];
} feed;

// spheres and dumbbells that fall out of a box through empty space
static feed *feed_new(void)
{
    feed *f = calloc(1, sizeof *f);
    check(f);
    model *m = f->m = model_new();
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    m->scene.gravity = v3(0, 0, -9.81);
    m->scene.time.step = 1e-4;
    m->scene.time.end = 1;
    f->mix[0] = (dem_mix_def){model_sphere(m, RADIUS), 1, {.largest = INFINITY}};
    f->mix[1] = (dem_mix_def){model_dumbbell(m, RADIUS / 2, RADIUS), 1, {.largest = INFINITY}};
    f->inlets[0] = (dem_inlet_def){.name = "top",
                                   .low = {0, 0, 0.4},
                                   .high = {0.2, 0.2, 0.5},
                                   .mix = f->mix,
                                   .mix_count = 2,
                                   .rate = 200,
                                   .velocity = {0, 0, -1},
                                   .velocity_spread = 0.1,
                                   .spin_spread = 5,
                                   .stop = INFINITY,
                                   .seed = 3};
    m->scene.inlets = f->inlets;
    m->scene.inlet_count = 1;
    return f;
}

static void feed_free(feed *f)
{
    model_free(f->m);
    free(f);
}

// the same with a floor that fills up and a side that bodies leave through
static feed *hopper_new(void)
{
    feed *f = feed_new();
    model_plane(f->m, v3(0, 0, 0), v3(0.6, 0, 0.8));
    model_plane(f->m, v3(0, 0, 0), v3(0, 1, 0));
    model_plane(f->m, v3(0, 0.2, 0), v3(0, -1, 0));
    f->m->scene.domain.low = v3(-1, -1, -0.3);
    f->m->scene.domain.high = v3(0.25, 1, 1);
    f->m->scene.domain.leaving = DEM_LEAVING_DELETE;
    f->inlets[0].rate = 400;
    return f;
}

static bool ledger_holds(dem_world *w, double tolerance)
{
    return fabs(measured(w)->energy.error) < tolerance;
}

static void lists_are_true(dem_world *w)
{
    dem_truth truth;
    dem_error error;
    check_ok(dem_world_validate(w, &truth, &error), error);
    assert_int_equal(truth.missed + truth.doubled + truth.unsound, 0);
}

// ---- how much

static void as_many_come_as_the_rate_asks_for(void **state)
{
    (void)state;
    feed *f = feed_new();
    f->inlets[0].start = 0.1;
    f->inlets[0].stop = 0.6;
    dem_world *w = model_world(f->m, 1);
    for (int i = 0; i < 8; i++) {
        run_steps(w, 1000);
        double due = 200 * (fmin(dem_world_time(w), 0.6) - 0.1);
        const dem_figures *figures = measured(w);
        assert_in_range(figures->came, (uint64_t)fmax(due - 1 + 1e-6, 0), (uint64_t)fmax(due + 1e-6, 0));
        assert_int_equal(figures->bodies, figures->came);
    }
    // 200 a second for half a second
    assert_int_equal(dem_world_figures(w)->came, 100);
    dem_world_destroy(w);
    feed_free(f);
}

static void as_much_mass_comes_as_the_rate_asks_for(void **state)
{
    (void)state;
    feed *f = feed_new();
    f->inlets[0].by_mass = true;
    f->inlets[0].rate = 2.5;
    f->mix[0].size = (dem_size_def){.law = DEM_SIZE_UNIFORM, .a = RADIUS, .b = 2 * RADIUS, .largest = INFINITY};
    f->m->scene.output.energy = false;
    dem_world *w = model_world(f->m, 1);
    double heaviest = 2500 * DEM_PI / 6 * pow(2 * RADIUS, 3);
    for (int i = 0; i < 10; i++) {
        run_steps(w, 1000);
        double due = 2.5 * dem_world_time(w), mass = 0;
        const dem_figures *figures = measured(w);
        dem_body_view bodies = dem_world_bodies(w);
        for (size_t k = 0; k < bodies.count; k++)
            mass += bodies.mass[k];
        check_near(mass, figures->came_mass, 1e-12);
        check(mass <= due * (1 + 1e-9) && mass > due - heaviest);
    }
    dem_world_destroy(w);
    feed_free(f);
}

static void a_count_is_an_end(void **state)
{
    (void)state;
    feed *f = feed_new();
    f->inlets[0].count = 7;
    dem_world *w = model_world(f->m, 1);
    run_steps(w, 2000);
    size_t count;
    const dem_inlet_view *views = dem_world_inlets(w, &count);
    assert_int_equal(count, 1);
    assert_int_equal(views[0].bodies, 7);
    check(views[0].over);
    dem_world_destroy(w);
    feed_free(f);
}

// ---- where and how

// looks at every body in the step it comes
static void bodies_come_into_no_overlap_and_all_the_same_way(void **state)
{
    (void)state;
    feed *f = hopper_new();
    f->inlets[0].velocity_spread = f->inlets[0].spin_spread = 0;
    f->inlets[0].spin = v3(1, 2, 3);
    dem_world *w = model_world(f->m, 1);
    size_t seen = 0;
    while (seen < 150) {
        run_steps(w, 1);
        if (dem_world_steps(w) % 8 && w->population->came == seen)
            continue;
        const dem_figures *figures = measured(w);
        dem_body_view bodies = dem_world_bodies(w);
        for (size_t i = 0; i < bodies.count; i++) {
            if (bodies.id[i] < seen)
                continue;
            check(v3_norm(v3_sub(bodies.velocity[i], v3(0, 0, -1))) < 1e-12);
            check(v3_norm(v3_sub(bodies.spin[i], v3(1, 2, 3))) < 1e-11);
            assert_int_equal(bodies.coordination[i], 0);
            dem_vec3 x = bodies.position[i];
            check(x.x > 0 && x.x < 0.2 && x.y > 0 && x.y < 0.2 && x.z > 0.4 && x.z < 0.5);
        }
        seen = figures->came;
    }
    check(measured(w)->left > 0);
    lists_are_true(w);
    dem_world_destroy(w);
    feed_free(f);
}

// the mean of R is 0 and that of each component squared 1/3 over all turns
static void orientations_are_uniform(void **state)
{
    (void)state;
    feed *f = feed_new();
    f->mix[0] = f->mix[1];
    f->inlets[0].rate = 1000;
    f->inlets[0].velocity = v3(0, 0, -4);
    f->m->scene.output.energy = false;
    dem_world *w = model_world(f->m, 1);
    double sum[9] = {0}, squares[9] = {0};
    size_t seen = 0;
    for (int i = 0; i < 5000; i++) {
        run_steps(w, 1);
        if (w->population->came == seen)
            continue;
        size_t row = w->bodies.place[w->bodies.living - 1];
        dem_quat q = orientation_now(w, w->bodies.living - 1);
        for (int k = 0; k < 9; k++) {
            double r = v3_get(quat_rotate(q, v3(k / 3 == 0, k / 3 == 1, k / 3 == 2)), k % 3);
            sum[k] += r;
            squares[k] += r * r;
        }
        assert_int_equal(w->bodies.id[row], seen);
        seen = w->population->came;
    }
    check(seen >= 495);
    // 4 standard deviations of a mean: sqrt(1/3 / n), sqrt((1/5 - 1/9) / n)
    for (int k = 0; k < 9; k++) {
        check(fabs(sum[k] / (double)seen) < 4 * sqrt(1.0 / 3 / (double)seen));
        check(fabs(squares[k] / (double)seen - 1.0 / 3) < 4 * sqrt(4.0 / 45 / (double)seen));
    }
    dem_world_destroy(w);
    feed_free(f);
}

static void a_full_box_waits(void **state)
{
    (void)state;
    feed *f = feed_new();
    model_box(f->m, v3(0, 0, 0.4), v3(0.1, 0.1, 0.5));
    f->inlets[0].high = v3(0.1, 0.1, 0.5);
    f->inlets[0].rate = 2000;
    f->inlets[0].velocity = v3(0, 0, 0);
    dem_world *w = model_world(f->m, 1);
    size_t count;
    run_steps(w, 3000);
    const dem_inlet_view *views = dem_world_inlets(w, &count);
    check(views[0].behind > 300 && views[0].bodies > 50);
    check_near(views[0].behind + (double)views[0].bodies, 600, 1e-9);
    lists_are_true(w);
    dem_world_destroy(w);
    feed_free(f);
}

// ---- a generator sphere

static feed *jet_new(void)
{
    feed *f = feed_new();
    f->inlets[0] = (dem_inlet_def){.name = "jet",
                                   .kind = DEM_INLET_SPHERE,
                                   .centre = {0.1, 0.1, 0.4},
                                   .radius = 1.5 * RADIUS,
                                   .mix = f->mix,
                                   .mix_count = 2,
                                   .rate = 20,
                                   .velocity = {0.5, 0, -0.5},
                                   .spin_spread = 3,
                                   .stop = INFINITY,
                                   .seed = 5};
    return f;
}

static void a_body_keeps_its_velocity_until_it_is_out_of_its_sphere(void **state)
{
    (void)state;
    feed *f = jet_new();
    f->inlets[0].count = 1;
    dem_world *w = model_world(f->m, 1);
    dem_vec3 v = f->inlets[0].velocity, spin = v3(0, 0, 0);
    double freed = 0;
    for (int i = 0; i < 1500; i++) {
        run_steps(w, 1);
        if (!measured(w)->came)
            continue;
        dem_body_view bodies = dem_world_bodies(w);
        double gone = v3_distance(bodies.position[0], f->inlets[0].centre), r = w->bodies.radius[w->bodies.place[0]];
        if (gone < f->inlets[0].radius + r) {
            check(v3_norm(v3_sub(bodies.velocity[0], v)) < 1e-15);
            check(v3_norm2(spin) == 0 || v3_norm(v3_sub(bodies.spin[0], spin)) < 1e-15);
            spin = bodies.spin[0];
            freed = dem_world_time(w) + w->next_step;
        } else
            check(fabs(bodies.velocity[0].z - v.z + 9.81 * (dem_world_time(w) - freed)) < 1e-10);
        check(ledger_holds(w, 1e-9));
    }
    check(freed > 0.05 && freed < 0.15);
    dem_world_destroy(w);
    feed_free(f);
}

// faster than the sphere lets them: one after the other, and none into another
static void a_generator_is_blocked_while_a_body_is_in_it(void **state)
{
    (void)state;
    feed *f = jet_new();
    f->inlets[0].rate = 1000;
    f->mix[1] = f->mix[0];
    dem_world *w = model_world(f->m, 1);
    run_steps(w, 5000);
    // the way is 2.5 radii at 0.707 m/s; steps are whole, and room is looked for again in the next one
    double each = 2.5 * RADIUS / sqrt(0.5), most = 0.5 / each;
    check((double)w->population->came <= most + 1 && (double)w->population->came > 0.97 * most - 1);
    check(measured(w)->largest_overlap_ratio == 0);
    check(ledger_holds(w, 1e-9));
    dem_world_destroy(w);
    feed_free(f);
}

// thrown up, it comes down on the sphere it came from, which lets the next one pass
static void what_has_come_collides_with_generators(void **state)
{
    (void)state;
    feed *f = jet_new();
    dem_inlet_def *jet = &f->inlets[0];
    jet->velocity = v3(0.02, 0, 0.5);
    jet->count = 2;
    jet->rate = 2.5;
    jet->mix_count = 1;
    jet->spin_spread = 0;
    jet->solid = true;
    dem_wall_def wall = {.name = jet->name,
                         .kind = DEM_WALL_SPHERE,
                         .point = jet->centre,
                         .normal = {0, 0, 1},
                         .radius = jet->radius,
                         .outside = true,
                         .generator = true};
    f->m->scene.walls = &wall;
    f->m->scene.wall_count = 1;
    dem_world *w = model_world(f->m, 1);
    bool touched = false;
    double least = INFINITY, speed = 0;
    for (int i = 0; i < 8000; i++) {
        run_steps(w, 1);
        const dem_figures *figures = measured(w);
        dem_body_view bodies = dem_world_bodies(w);
        touched |= figures->wall_contacts > 0;
        if (touched && figures->bodies == 1)
            speed = larger(speed, bodies.velocity[0].z);
        for (size_t k = 0; k < bodies.count; k++)
            if (w->population->inlets[0].inside != w->bodies.place[k])
                least = smaller(least, v3_distance(bodies.position[k], jet->centre) - jet->radius - RADIUS);
        check(fabs(figures->energy.error) < 1e-4);  // by the steps: 50 to a contact
    }
    // it fell .5 m/s fast and leaves with half of that
    check(touched && least < 0 && least > -0.1 * RADIUS);
    check(speed > 0.2 && speed < 0.27);
    assert_int_equal(dem_world_figures(w)->came, 2);
    dem_world_destroy(w);
    feed_free(f);
}

// ---- leaving

static void what_leaves_is_deleted_and_counted(void **state)
{
    (void)state;
    model *m = model_new();
    model_sphere(m, RADIUS);
    m->scene.gravity = v3(0, 0, -9.81);
    m->scene.time.step = 1e-4;
    m->scene.domain.low = v3(-1, -1, 0);
    m->scene.domain.leaving = DEM_LEAVING_DELETE;
    for (int i = 0; i < 20; i++)
        model_body(m, 0, v3(0.05 * i, 0, 0.05 + 0.02 * i));
    model_body(m, 0, v3(0, 0.5, 10));
    dem_world *w = model_world(m, 1);
    uint32_t last = 0;
    double mass = 2500 * 4 * DEM_PI / 3 * RADIUS * RADIUS * RADIUS;
    while (dem_world_time(w) < 0.5) {
        run_steps(w, 100);
        const dem_figures *figures = measured(w);
        dem_body_view bodies = dem_world_bodies(w);
        assert_int_equal(figures->bodies + figures->left, 21);
        assert_int_equal(bodies.count, figures->bodies);
        check_near(figures->left_mass + 1, (double)figures->left * mass + 1, 1e-12);
        check(figures->energy.error < 1e-9);
        // from the lowest on, each within half a skin of the side
        assert_int_equal(bodies.id[0], figures->left);
        for (size_t i = 1; i < bodies.count; i++)
            check(bodies.id[i] > bodies.id[i - 1]);
        for (size_t i = 0; i < bodies.count; i++)
            check(bodies.position[i].z > -0.2 * RADIUS);
        last = bodies.id[bodies.count - 1];
    }
    assert_int_equal(dem_world_figures(w)->bodies, 1);
    assert_int_equal(last, 20);
    dem_world_destroy(w);
    model_free(m);
}

// a pile on the edge of the domain: what goes takes contacts along
static void the_ledger_closes_and_lists_stay_true(void **state)
{
    (void)state;
    feed *f = hopper_new();
    f->m->scene.time.step = 5e-5;
    dem_world *w = model_world(f->m, 1);
    for (int i = 0; i < 8; i++) {
        run_steps(w, 2000);
        // impacts of 20 steps and more each
        check(ledger_holds(w, 1e-3));
        lists_are_true(w);
    }
    const dem_figures *figures = measured(w);
    check(figures->left > 50 && figures->bodies > 50 && figures->contacts + figures->wall_contacts > 2);
    assert_int_equal(figures->came, figures->bodies + figures->left);
    check(fabs(figures->energy.brought) > 0.01);
    dem_world_destroy(w);
    feed_free(f);
}

// contacts across domains go on when all rows move: momentum is that at the start and what has come
static void a_world_that_grows_keeps_its_momentum(void **state)
{
    (void)state;
    feed *f = feed_new();
    model *m = f->m;
    m->scene.gravity = v3(0, 0, 0);
    m->scene.time.end = 0.01;
    m->scene.shape_count = 1;
    model_lattice(m, 700, 1.9 * RADIUS, 0.1, 1);
    m->scene.shape_count = 2;
    f->inlets[0].low.z += 0.5;
    f->inlets[0].high.z += 0.5;
    f->inlets[0].velocity_spread = 0;
    dem_world *w = model_world(m, 1);
    dem_vec3 at_first, now, turning;
    total_momentum(w, &at_first, &turning);
    size_t rows = w->bodies.count, slots = 0;
    while (w->bodies.count == rows) {
        slots = 0;
        for (size_t i = 0; i < w->segment_count; i++)
            slots += w->contacts.segments[i].slot_count;
        run_steps(w, 1);
    }
    check(slots > 50);
    run_steps(w, 50);
    total_momentum(w, &now, &turning);
    now.z += w->population->came_mass;  // at 1 m/s
    // sums of so many impulses
    check(v3_distance(now, at_first) < 1e-11);
    lists_are_true(w);
    dem_world_destroy(w);
    feed_free(f);
}

// ---- the same bits

static uint64_t run_hash(feed *f, int threads, uint64_t steps)
{
    dem_world *w = model_world(f->m, threads);
    run_steps(w, steps);
    uint64_t hash = dem_world_hash(w);
    lists_are_true(w);
    dem_world_destroy(w);
    return hash;
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    feed *f = hopper_new();
    f->inlets[0].rate = 3000;
    f->m->scene.output.energy = false;
    f->m->scene.domain.leaving = DEM_LEAVING_IGNORE;
    f->m->scene.time.end = 0.01;  // rows for few at first: the world grows to several domains
    uint64_t one = run_hash(f, 1, 3000);
    check(one == run_hash(f, 2, 3000));
    check(one == run_hash(f, 8, 3000));
    f->inlets[0].seed++;
    check(one != run_hash(f, 1, 3000));
    feed_free(f);
}

// bodies that wait for room look for it elsewhere every time
static void what_waits_goes_on_bit_for_bit(void **state)
{
    (void)state;
    feed *f = feed_new();
    model_box(f->m, v3(0, 0, 0.4), v3(0.1, 0.1, 0.5));
    f->inlets[0].high = v3(0.1, 0.1, 0.5);
    f->inlets[0].rate = 2000;
    f->inlets[0].velocity = v3(0, 0, 0);
    dem_world *w = model_world(f->m, 1);
    while (w->population->inlets[0].looks < 3)
        run_steps(w, 5);
    dem_world *again = model_resumed(f->m, w, 1);
    uint64_t before = w->population->came;
    while (w->population->came < before + 2) {
        run_steps(w, 10);
        run_steps(again, 10);
    }
    check(dem_world_hash(w) == dem_world_hash(again));
    dem_world_destroy(w);
    dem_world_destroy(again);
    feed_free(f);
}

// two inlets of both kinds, a world that has grown, a body inside of a generator
static void a_restored_world_goes_on_bit_for_bit(void **state)
{
    (void)state;
    feed *f = hopper_new(), *jet = jet_new();
    f->inlets[1] = jet->inlets[0];
    f->inlets[1].mix = f->mix;
    f->inlets[1].centre = v3(0.1, 0.1, 0.6);
    f->m->scene.inlet_count = 2;
    // rows for few at first, as far as the scene tells
    f->m->scene.time.end = 0.05;
    dem_world *w = model_world(f->m, 1);
    size_t rows = w->bodies.count;
    while (w->bodies.count == rows || w->population->inlets[1].inside == (uint32_t)DEM_ROW_FREE)
        run_steps(w, 7);
    run_steps(w, 600);
    while (w->population->inlets[1].inside == (uint32_t)DEM_ROW_FREE)
        run_steps(w, 1);
    dem_world *again = model_resumed(f->m, w, 2);
    check(dem_world_hash(w) == dem_world_hash(again));
    for (int i = 0; i < 5; i++) {
        run_steps(w, 500);
        run_steps(again, 500);
        check(dem_world_hash(w) == dem_world_hash(again));
    }
    const dem_figures *a = measured(w), *b = measured(again);
    assert_int_equal(a->came, b->came);
    assert_int_equal(a->left, b->left);
    check(a->came > 100 && a->left > 10 && a->energy.brought == b->energy.brought);
    assert_memory_equal(dem_world_bodies(w).id, dem_world_bodies(again).id, a->bodies * sizeof(uint32_t));
    lists_are_true(again);
    dem_world_destroy(w);
    dem_world_destroy(again);
    feed_free(f);
    feed_free(jet);
}

// ---- the step

static void small_stiff_bodies_lower_an_automatic_step(void **state)
{
    (void)state;
    feed *f = feed_new();
    f->m->scene.time.step = 0;
    f->mix[0].size = (dem_size_def){.law = DEM_SIZE_TABLE,
                                    .sizes = (double[]){0.1 * RADIUS, 0.11 * RADIUS, RADIUS},
                                    .passing = (double[]){0, 0.1, 1},
                                    .table_count = 3,
                                    .largest = INFINITY};
    f->inlets[0].mix_count = 1;
    dem_world *w = model_world(f->m, 1);
    double at_first = w->next_step, least = INFINITY;
    // ten steps in a contact of two of the lightest, pi sqrt(m / 2 k), from the step on in which it comes
    while (w->population->came < 60) {
        uint64_t before = w->population->came;
        run_steps(w, 1);
        if (w->population->came > before)
            least = fmin(least, body_mass(w, w->bodies.place[w->bodies.living - 1]));
        check(w->next_step <= DEM_PI * sqrt(least / 2 / 1e4) / 10 * (1 + 1e-6));
    }
    check(w->next_step < 0.5 * at_first);
    check_near(w->next_step, DEM_PI * sqrt(least / 2 / 1e4) / 10, 1e-6);
    dem_world_destroy(w);
    feed_free(f);
}

// ---- what cannot be

static void inlets_that_cannot_be_are_refused(void **state)
{
    (void)state;
    feed *f = feed_new();
    dem_inlet_def good = f->inlets[0], bad[6] = {good, good, good, good, good, good};
    bad[0].high.z = good.low.z + RADIUS;
    bad[1].rate = 0;
    bad[2].kind = DEM_INLET_SPHERE;
    bad[2].radius = RADIUS / 2;
    bad[3].velocity.x = NAN;
    bad[4].low.x = 0.3;
    bad[5].mix_count = 0;
    for (int i = 0; i < 6; i++) {
        dem_world *w = NULL;
        dem_error error;
        f->inlets[0] = bad[i];
        assert_int_equal(dem_world_create(NULL, &f->m->scene, &w, &error), DEM_BAD_INPUT);
        assert_non_null(strstr(error.text, "\"top\""));
        assert_non_null(strchr(error.text, ';'));
        assert_null(w);
    }
    f->inlets[0] = good;
    f->m->scene.domain.high = v3(1, 1, 0.45);
    dem_world *w = NULL;
    dem_error error;
    assert_int_equal(dem_world_create(NULL, &f->m->scene, &w, &error), DEM_BAD_INPUT);
    assert_non_null(strstr(error.text, "domain"));
    feed_free(f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_many_come_as_the_rate_asks_for),
        cmocka_unit_test(as_much_mass_comes_as_the_rate_asks_for),
        cmocka_unit_test(a_count_is_an_end),
        cmocka_unit_test(bodies_come_into_no_overlap_and_all_the_same_way),
        cmocka_unit_test(orientations_are_uniform),
        cmocka_unit_test(a_full_box_waits),
        cmocka_unit_test(a_body_keeps_its_velocity_until_it_is_out_of_its_sphere),
        cmocka_unit_test(a_generator_is_blocked_while_a_body_is_in_it),
        cmocka_unit_test(what_has_come_collides_with_generators),
        cmocka_unit_test(what_leaves_is_deleted_and_counted),
        cmocka_unit_test(the_ledger_closes_and_lists_stay_true),
        cmocka_unit_test(a_world_that_grows_keeps_its_momentum),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(what_waits_goes_on_bit_for_bit),
        cmocka_unit_test(a_restored_world_goes_on_bit_for_bit),
        cmocka_unit_test(small_stiff_bodies_lower_an_automatic_step),
        cmocka_unit_test(inlets_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
