// Whole worlds: the same bits whatever threads, instruction set, kernel or restart; what must be conserved; what must
// not be stored.
#include "base/level.h"
#include "sim/bodies.h"
#include "sim/contacts.h"
#include "worlds.h"

// a box of clumps of several shapes and sizes that falls, slides, rolls and bounces
static model *busy_model(bool moments)
{
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.6;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    if (moments) {
        m->laws[0].rolling = DEM_ROLLING_EPSD;
        m->laws[0].rolling_coefficient = 0.1;
        m->laws[0].twisting = DEM_TWISTING_MARSHALL;
        m->laws[0].cohesion = DEM_COHESION_SJKR;
        m->laws[0].energy_density = 1e4;
        m->laws[1] = m->laws[0];
        m->laws[1].materials[1] = 1;
        m->laws[1].rolling = DEM_ROLLING_BOUNDED;
        m->laws[1].twisting = DEM_TWISTING_CONSTANT;
        m->laws[1].twisting_coefficient = 0.1;
        m->scene.law_count = m->scene.material_count = 2;
        m->materials[1] = m->materials[0];
        m->materials[1].name = "wall";
    }
    model_cloud(m, 12, 0.02, 1);
    model_sphere(m, 0.008);
    model_dumbbell(m, 0.006, 0.008);
    model_lattice(m, 1100, 0.0225, 1, 1);
    for (size_t i = 0; i < m->scene.bodies.count; i += 3)
        m->bodies[i].scale = 0.9;
    model_box(m, v3(0, 0, 0), v3(0.26, 0.26, 0.26));
    m->walls[0].velocity = v3(0.2, 0, 0);
    for (size_t i = 0; moments && i < m->scene.wall_count; i++)
        m->walls[i].material = 1;
    return m;
}

static uint64_t hash_after(const model *m, int threads, uint64_t steps)
{
    dem_world *w = model_world(m, threads);
    run_steps(w, steps);
    uint64_t hash = dem_world_hash(w);
    dem_world_destroy(w);
    return hash;
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    for (int moments = 0; moments < 2; moments++) {
        model *m = busy_model(moments);
        uint64_t hash = hash_after(m, 1, 300);
        for (int threads = 2; threads <= 8; threads += 3)
            assert_int_equal(hash_after(m, threads, 300), hash);
        model_free(m);
    }
}

static void use_kernels(dem_world *w, const dem_kernels *kernels, bool any)
{
    size_t own = (size_t)(w->instance - w->kernels->instances),
           walls = (size_t)(w->wall_instance - w->kernels->instances);
    w->kernels = kernels;
    w->instance = &kernels->instances[any ? kernels->instance_count - 1 : own];
    w->wall_instance = &kernels->instances[any ? kernels->instance_count - 1 : walls];
}

static void check_instruction_sets(bool moments)
{
    model *m = busy_model(moments);
    m->scene.bodies.count = 200;
    uint64_t want = 0;
    for (int i = 0; i < DEM_LEVELS; i++) {
        const dem_kernels *kernels = dem_kernels_choose(dem_level_name(i));
        if (!kernels)
            continue;
        dem_world *w = model_world(m, 1);
        use_kernels(w, kernels, false);
        run_steps(w, 600);
        if (!want)
            want = dem_world_hash(w);
        assert_int_equal(dem_world_hash(w), want);
        dem_world_destroy(w);
    }
    model_free(m);
}

static void every_instruction_set_gives_the_same_bits(void **state)
{
    (void)state;
    check_instruction_sets(false);
    check_instruction_sets(true);
}

// each instance against the kernel that asks for every feature as it goes
static void each_kernel_made_for_a_scene_equals_the_general_one(void **state)
{
    (void)state;
    if (dem_kernels_choose(NULL)->instance_count == 1)
        skip();  // built with the general one only
    for (int variant = 0; variant < 8; variant++) {
        model *m = model_new();
        dem_pair_law *law = &m->laws[0];
        m->scene.gravity = v3(0, 0, -9.81);
        law->damping = variant & 1 ? DEM_DAMPING_RATE : DEM_DAMPING_RESTITUTION;
        law->restitution = 0.6;
        law->damping_rate = law->tangential_rate = 200;
        law->effective_mass = variant & 1 ? DEM_MASS_BODY : DEM_MASS_LOCAL;
        law->tail = variant & 1 ? DEM_TAIL_TENSION : DEM_TAIL_CUT;
        law->friction = DEM_FRICTION_LINEAR;
        law->friction_coefficient = 0.4;
        if (!(variant & 1)) {
            law->tangential_rate = NAN;
            if (variant & 2) {
                law->normal = DEM_NORMAL_HERTZ;
                law->friction = DEM_FRICTION_MINDLIN;
                m->materials[0].young = 1e7;
            }
        }
        if (variant & 4)
            model_sphere(m, 0.009);
        else
            model_cloud(m, 12, 0.02, 1);
        model_lattice(m, 100, 0.022, 1.5, 1);
        model_box(m, v3(0, 0, 0), v3(0.11, 0.11, 0.11));
        dem_world *w = model_world(m, 1), *general = model_world(m, 1);
        check(!w->instance->any);
        use_kernels(general, w->kernels, true);
        check(general->instance->any);
        run_steps(w, 500);
        run_steps(general, 500);
        check(measured(w)->contacts + measured(w)->wall_contacts > 0);
        assert_int_equal(dem_world_hash(w), dem_world_hash(general));
        dem_world_destroy(w);
        dem_world_destroy(general);
        model_free(m);
    }
}

static void check_restart(bool moments)
{
    model *m = busy_model(moments);
    dem_world *straight = model_world(m, 1);
    run_steps(straight, 217);
    dem_world *resumed = model_resumed(m, straight, 2);
    run_steps(straight, 300);
    run_steps(resumed, 300);
    assert_int_equal(dem_world_hash(straight), dem_world_hash(resumed));
    check(dem_world_time(straight) == dem_world_time(resumed));
    check(measured(straight)->energy.error == measured(resumed)->energy.error);
    dem_world_destroy(straight);
    dem_world_destroy(resumed);
    model_free(m);
}

static void a_run_taken_up_from_a_saved_state_gives_the_same_bits(void **state)
{
    (void)state;
    check_restart(false);
    check_restart(true);
}

static void looking_changes_nothing(void **state)
{
    (void)state;
    model *m = busy_model(true);
    m->scene.bodies.count = 300;
    dem_world *w = model_world(m, 1);
    for (int i = 0; i < 20; i++) {
        run_steps(w, 20);
        measured(w);
        dem_world_critical_step(w);
    }
    assert_int_equal(dem_world_hash(w), hash_after(m, 1, 400));
    dem_world_destroy(w);
    model_free(m);
}

static void damaged_or_foreign_states_are_refused(void **state)
{
    (void)state;
    model *m = busy_model(false), *other = busy_model(false);
    m->scene.bodies.count = other->scene.bodies.count = 40;
    other->laws[0].friction = DEM_FRICTION_NONE;
    dem_world *w = model_world(m, 1), *foreign = model_world(other, 1);
    dem_error error;
    void *bytes;
    size_t size;
    run_steps(w, 50);
    check_ok(dem_world_save(w, &bytes, &size, &error), error);
    for (size_t cut = 0; cut < size; cut += 1 + cut / 7)
        assert_int_equal(dem_world_restore(w, bytes, cut, &error), DEM_BAD_INPUT);
    for (size_t at = 0; at < size; at += 997) {
        ((char *)bytes)[at] ^= 16;
        assert_int_equal(dem_world_restore(w, bytes, size, &error), DEM_BAD_INPUT);
        ((char *)bytes)[at] ^= 16;
    }
    assert_int_equal(dem_world_restore(foreign, bytes, size, &error), DEM_BAD_INPUT);
    check(strstr(error.text, "another scene"));
    dem_world_destroy(w);
    dem_world_destroy(foreign);
    free(bytes);
    model_free(m);
    model_free(other);
}

// ---- one code path for spheres

static void a_clump_of_one_sphere_is_a_sphere_bit_for_bit(void **state)
{
    (void)state;
    uint64_t hash[2];
    for (int clump = 0; clump < 2; clump++) {
        model *m = model_new();
        m->scene.gravity = v3(1, 0, -9.81);
        m->laws[0].damping = DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = 0.7;
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.5;
        double r = 0.01, mass = 2500 * 4 * DEM_PI / 3 * r * r * r, i = 0.4 * mass * r * r;
        if (clump)
            model_clump(m, (dem_ball[]){{{0, 0, 0}, r}}, 1, mass, (double[]){i, i, i});
        else
            model_sphere(m, r);
        model_lattice(m, 27, 0.022, 1, 1);
        model_box(m, v3(0, 0, 0), v3(0.07, 0.07, 0.07));
        dem_world *w = model_world(m, 1);
        run_steps(w, 20000);
        hash[clump] = dem_world_hash(w);
        dem_world_destroy(w);
        model_free(m);
    }
    assert_int_equal(hash[0], hash[1]);
}

// the neighbours of a sphere in the rows do not matter
static void a_sphere_moves_alike_among_clumps_and_alone(void **state)
{
    (void)state;
    dem_vec3 end[2];
    for (int crowd = 0; crowd < 2; crowd++) {
        model *m = model_new();
        m->scene.gravity = v3(0, 0, -9.81);
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.5;
        model_sphere(m, 0.01);
        model_cloud(m, 9, 0.02, 1);
        dem_body_def *b = model_body(m, 0, v3(0, 0, 0.0102));
        b->velocity = v3(1, 0.3, 0);
        b->spin = v3(0, 50, 7);
        for (int i = 0; crowd && i < 5; i++)
            model_body(m, 1, v3(5 + i, 0, 1));
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        dem_world *w = model_world(m, 1);
        run_steps(w, 3000);
        measured(w);
        end[crowd] = dem_world_bodies(w).position[0];
        dem_world_destroy(w);
        model_free(m);
    }
    assert_memory_equal(&end[0], &end[1], sizeof end[0]);
}

// ---- what is not used is not stored

static void a_scene_without_friction_has_no_history(void **state)
{
    (void)state;
    model *m = busy_model(false);
    m->scene.bodies.count = 30;
    m->laws[0].friction = DEM_FRICTION_NONE;
    m->laws[0].damping = DEM_DAMPING_NONE;
    dem_world *w = model_world(m, 1);
    check(!w->contacts.columns.spring[0] && !w->contacts.columns.loss && !w->contacts.columns.shift);
    check(!w->contacts.columns.law && !w->contacts.columns.weight && !w->bodies.before && !w->bodies.wraps);
    assert_int_equal(dem_contact_bytes(&w->features, -1), 5 * sizeof(uint32_t));
    dem_world_destroy(w);
    model_free(m);
}

static void explain_tells_what_a_scene_pays_for(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    model_sphere(m, 0.01);
    model_lattice(m, 8, 0.03, 0, 1);
    char *text;
    dem_error error;
    dem_world *w = model_world(m, 1);
    check_ok(dem_world_explain(w, &text, &error), error);
    check(strstr(text, "columns of a contact of a pair, 20 B:"));
    check(strstr(text, "Embree is not started"));
    check(strstr(text, "isotropic rotation"));
    check(!strstr(text, "spring") && !strstr(text, "wall_limit"));
    free(text);
    dem_world_destroy(w);
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.5;
    w = model_world(m, 1);
    check_ok(dem_world_explain(w, &text, &error), error);
    check(strstr(text, "spring[2]") && strstr(text, "friction"));
    free(text);
    dem_world_destroy(w);
    model_free(m);
}

// ---- conservation

// nothing but contacts: total momenta change by rounding alone. 2e4 steps of 64 bodies: 1e-16 a contact and step
static void momentum_and_angular_momentum_are_kept_to_the_last_bits(void **state)
{
    (void)state;
    model *m = model_new();
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.8;
    model_cloud(m, 8, 0.02, 1);
    model_dumbbell(m, 0.006, 0.008);
    model_lattice(m, 64, 0.0205, 1, 1);
    for (size_t i = 0; i < 64; i++)  // towards the middle
        m->bodies[i].velocity = v3_scale(v3_sub(v3(0.041, 0.041, 0.041), m->bodies[i].position), 30);
    dem_world *w = model_world(m, 1);
    dem_vec3 p0, l0, p1, l1;
    total_momentum(w, &p0, &l0);
    double scale = 0, touched = 0;
    for (size_t i = 0; i < w->bodies.count; i++)
        scale += v3_norm(v3(w->bodies.momentum[8 * i], w->bodies.momentum[8 * i + 1], w->bodies.momentum[8 * i + 2]));
    for (int i = 0; i < 40; i++) {
        run_steps(w, 500);
        touched += (double)measured(w)->contacts;
    }
    total_momentum(w, &p1, &l1);
    check(touched > 20);
    check_vec(p1, p0, 1e-12 * scale);
    check_vec(l1, l0, 1e-12 * scale * 0.1);
    dem_world_destroy(w);
    model_free(m);
}

static void a_world_without_bodies_steps_and_is_resumed(void **state)
{
    (void)state;
    model *m = model_new();
    model_sphere(m, 0.01);
    model_box(m, v3(0, 0, 0), v3(1, 1, 1));
    dem_world *w = model_world(m, 2);
    run_steps(w, 10);
    assert_int_equal(measured(w)->bodies, 0);
    dem_world *resumed = model_resumed(m, w, 1);
    dem_world_destroy(w);
    run_steps(resumed, 10);
    assert_int_equal(measured(resumed)->bodies, 0);
    dem_world_destroy(resumed);
    model_free(m);
}

// ---- what goes wrong is said

static void a_run_that_blows_up_stops_and_names_body_and_step(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.time.step = 1e-2;  // far beyond the limit
    m->scene.gravity = v3(0, 0, -9.81);
    model_sphere(m, 0.01);
    model_lattice(m, 27, 0.0199, 0, 1);
    model_box(m, v3(0, 0, 0), v3(0.06, 0.06, 0.06));
    dem_world *w = model_world(m, 1);
    dem_error error = {0};
    assert_int_equal(dem_world_step(w, 100000, &error), DEM_FAILED);
    check(strstr(error.text, "body ") && strstr(error.text, "step ") && strstr(error.text, "smaller time step"));
    dem_world_destroy(w);
    model_free(m);
}

static void a_body_that_leaves_the_domain_stops_the_run(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.domain.high = v3(1, 1, 1);
    model_sphere(m, 0.01);
    model_body(m, 0, v3(0.5, 0.5, 0.5));
    model_body(m, 0, v3(0.9, 0.5, 0.5))->velocity = v3(20, 0, 0);
    dem_world *w = model_world(m, 1);
    dem_error error = {0};
    assert_int_equal(dem_world_step(w, 100000, &error), DEM_FAILED);
    check(strstr(error.text, "body 1 (sphere)") && strstr(error.text, "has left the domain"));
    check_near(dem_world_time(w), 0.1 / 20, 2e-4);
    dem_world_destroy(w);
    m->scene.domain.leaving = DEM_LEAVING_IGNORE;
    w = model_world(m, 1);
    run_steps(w, 2000);
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(every_instruction_set_gives_the_same_bits),
        cmocka_unit_test(each_kernel_made_for_a_scene_equals_the_general_one),
        cmocka_unit_test(a_run_taken_up_from_a_saved_state_gives_the_same_bits),
        cmocka_unit_test(looking_changes_nothing),
        cmocka_unit_test(damaged_or_foreign_states_are_refused),
        cmocka_unit_test(a_clump_of_one_sphere_is_a_sphere_bit_for_bit),
        cmocka_unit_test(a_sphere_moves_alike_among_clumps_and_alone),
        cmocka_unit_test(a_scene_without_friction_has_no_history),
        cmocka_unit_test(explain_tells_what_a_scene_pays_for),
        cmocka_unit_test(momentum_and_angular_momentum_are_kept_to_the_last_bits),
        cmocka_unit_test(a_world_without_bodies_steps_and_is_resumed),
        cmocka_unit_test(a_run_that_blows_up_stops_and_names_body_and_step),
        cmocka_unit_test(a_body_that_leaves_the_domain_stops_the_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
