// What must not matter: where and how a scene stands and moves, in which order it was told, its units, and which way
// time runs.
#include "worlds.h"

// ---- two or more bodies and what becomes of them

enum { MOST = 8 };

typedef struct outcome {
    size_t count;
    dem_vec3 position[MOST], velocity[MOST], spin[MOST];
    dem_quat orientation[MOST];
    size_t touched;
} outcome;

static outcome run(const model *m, uint64_t steps)
{
    dem_world *w = model_world(m, 1);
    outcome o = {0};
    for (uint64_t done = 0; done < steps; done += steps / 250) {
        run_steps(w, steps / 250);
        o.touched += measured(w)->contacts + measured(w)->wall_contacts;
    }
    dem_body_view v = dem_world_bodies(w);
    o.count = v.count;
    memcpy(o.position, v.position, v.count * sizeof *v.position);
    memcpy(o.velocity, v.velocity, v.count * sizeof *v.velocity);
    memcpy(o.spin, v.spin, v.count * sizeof *v.spin);
    memcpy(o.orientation, v.orientation, v.count * sizeof *v.orientation);
    dem_world_destroy(w);
    check(o.touched > 10);
    return o;
}

typedef enum law_kind {
    ELASTIC,
    LINEAR_ALL,
    HERTZ_ALL,
    LINEAR_MOMENTS,
    HERTZ_MOMENTS,
    STATIC,
    BREAKABLE,
    JKR_BOUNDED,
    BUILT_IN,
    PLUGIN = BUILT_IN,  // a law of the user's, where such can be loaded
    LAW_KINDS = BUILT_IN + DEM_PLUGINS
} law_kind;

// stiffness in loading and unloading, of tangential over normal stiffness, friction
static const dem_law_value PLUGIN_VALUES[] = {{"loading", 1e4}, {"unloading", 1.6e4}, {"friction", 0.4}};
enum { PLUGIN_VALUE_COUNT = 3 };

static dem_pair_law law_of(law_kind kind)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.stiffness = 1e4;
    if (kind == ELASTIC)
        return law;
    if (kind == PLUGIN) {
        law.normal = DEM_NORMAL_PLUGIN;
        law.plugin = PLUGIN_DIR "law_walton_braun.so";
        law.parameters = PLUGIN_VALUES;
        law.parameter_count = PLUGIN_VALUE_COUNT;
        return law;
    }
    law.damping = DEM_DAMPING_RESTITUTION;
    law.restitution = 0.6;
    law.friction = DEM_FRICTION_LINEAR;
    law.friction_coefficient = 0.4;
    if (kind == HERTZ_ALL || kind == HERTZ_MOMENTS) {
        law.normal = DEM_NORMAL_HERTZ;
        law.friction = DEM_FRICTION_MINDLIN;
    }
    if (kind == LINEAR_MOMENTS || kind == HERTZ_MOMENTS) {
        law.rolling = DEM_ROLLING_EPSD;
        law.rolling_coefficient = 0.2;
        law.twisting = DEM_TWISTING_MARSHALL;
        law.cohesion = DEM_COHESION_SJKR;
        law.energy_density = 1e4;
    }
    if (kind == HERTZ_MOMENTS) {
        law.normal = DEM_NORMAL_DMT;
        law.work_of_adhesion = 0.5;
    }
    if (kind == STATIC) {
        law.static_coefficient = 0.7;
        law.friction_decay = 10;
    }
    if (kind == BREAKABLE) {
        law.cohesion = DEM_COHESION_BREAKABLE;
        law.bonded = DEM_BONDED_AT_TOUCH;
        law.bond_tension = 0.5;
        law.bond_shear = 0.5;
    }
    if (kind == JKR_BOUNDED) {
        law.normal = DEM_NORMAL_JKR;
        law.friction = DEM_FRICTION_MINDLIN;
        law.work_of_adhesion = 0.5;
        law.rolling = DEM_ROLLING_BOUNDED;
        law.rolling_coefficient = 0.05;
        law.twisting = DEM_TWISTING_CONSTANT;
        law.twisting_coefficient = 0.05;
    }
    return law;
}

// three different clumps and a sphere that meet in the middle; some touch more than once
static model *meeting(law_kind kind)
{
    model *m = model_new();
    m->materials[0].young = 1e7;
    m->laws[0] = law_of(kind);
    model_cloud(m, 9, 0.02, 1);
    model_dumbbell(m, 0.006, 0.008);
    model_sphere(m, 0.007);
    dem_random r = random_stream(7, 1);
    static const dem_vec3 at[4] = {{0.02, 0, 0}, {-0.015, 0.003, 0}, {0, 0.02, 0.005}, {0, -0.004, -0.022}};
    for (uint32_t i = 0; i < 4; i++) {
        dem_body_def *b = model_body(m, i % 3, at[i]);
        b->velocity = v3_scale(at[i], -60);
        b->spin = random_in(&r, v3(-60, -60, -60), v3(60, 60, 60));
        b->orientation = random_quat(&r);
    }
    return m;
}

static const uint64_t STEPS = 3000;  // 1e-5 s each: the bodies have met and parted

// every one of them, undone by `back`, is where it was without; lengths are 0.02 m, speeds 1 m/s, spins 100 rad/s
static void check_same(const outcome *got, const outcome *want, double tolerance)
{
    assert_int_equal(got->count, want->count);
    for (size_t i = 0; i < got->count; i++) {
        check_vec(got->position[i], want->position[i], 0.02 * tolerance);
        check_vec(got->velocity[i], want->velocity[i], tolerance);
        check_vec(got->spin[i], want->spin[i], 100 * tolerance);
        dem_quat q = got->orientation[i], o = want->orientation[i];
        double off = fabs(q.w * o.w + q.x * o.x + q.y * o.y + q.z * o.z) - 1;
        check_near(off, 0, tolerance * tolerance + 1e-14);
    }
}

// ---- where and how it moves

// no walls and no gravity: a boost adds itself to all velocities, and nothing else
static void a_boost_changes_nothing_but_the_velocity(void **state)
{
    (void)state;
    for (law_kind kind = 0; kind < LAW_KINDS; kind++) {
        model *m = meeting(kind), *boosted = meeting(kind);
        dem_vec3 boost = v3(0.5, -1.25, 0.25);
        for (size_t i = 0; i < m->scene.bodies.count; i++)
            boosted->bodies[i].velocity = v3_add(boosted->bodies[i].velocity, boost);
        outcome plain = run(m, STEPS), o = run(boosted, STEPS);
        for (size_t i = 0; i < o.count; i++) {
            o.position[i] = v3_along(o.position[i], -1e-5 * (double)STEPS, boost);
            o.velocity[i] = v3_sub(o.velocity[i], boost);
        }
        // positions of 0.04 m round by 7e-18, overlaps of 1e-4 m so by 1e-13, and impacts make it some times more
        check_same(&o, &plain, 1e-10);
        model_free(m);
        model_free(boosted);
    }
}

static model *turned_model(law_kind kind, dem_quat q)
{
    model *m = meeting(kind);
    m->scene.gravity = quat_rotate(q, v3(1, 2, -9.81));
    for (size_t i = 0; i < m->scene.bodies.count; i++) {
        dem_body_def *b = &m->bodies[i];
        b->position = quat_rotate(q, b->position);
        b->velocity = quat_rotate(q, b->velocity);
        b->spin = quat_rotate(q, b->spin);
        b->orientation = quat_multiply(q, b->orientation);
    }
    model_plane(m, quat_rotate(q, v3(0, 0, -0.04)), quat_rotate(q, v3(0, 0, 1)))->velocity =
        quat_rotate(q, v3(0.3, 0, 0));
    dem_wall_def *pipe = model_plane(m, v3(0, 0, 0), quat_rotate(q, v3(0, 0, 1)));
    pipe->kind = DEM_WALL_CYLINDER;
    pipe->radius = 0.04;
    pipe->spin = quat_rotate(q, v3(0, 0, 5));
    return m;
}

static void turn_back(outcome *o, dem_quat q)
{
    for (size_t i = 0; i < o->count; i++) {
        o->position[i] = quat_unrotate(q, o->position[i]);
        o->velocity[i] = quat_unrotate(q, o->velocity[i]);
        o->spin[i] = quat_unrotate(q, o->spin[i]);
        o->orientation[i] = quat_multiply(quat_conjugate(q), o->orientation[i]);
    }
}

static void a_problem_that_is_turned_turns_its_outcome(void **state)
{
    (void)state;
    dem_random r = random_stream(7, 2);
    for (law_kind kind = 0; kind < LAW_KINDS; kind++)
        for (int i = 0; i < 3; i++) {
            // the last one by half a turn, where bodies change their order along each axis
            dem_quat q = i == 2 ? (dem_quat){0, 0, 0, 1} : random_quat(&r);
            model *m = turned_model(kind, (dem_quat){1, 0, 0, 0}), *turned = turned_model(kind, q);
            outcome plain = run(m, 2 * STEPS), o = run(turned, 2 * STEPS);
            turn_back(&o, q);
            // as above, and twice as many impacts
            check_same(&o, &plain, 1e-9);
            model_free(m);
            model_free(turned);
        }
}

// coordinates of 1024 m end with 1.1e-13 m: of an overlap of 1e-4 m that is 1e-9
static void a_scene_far_from_the_origin_is_exact_to_the_rounding_there(void **state)
{
    (void)state;
    for (law_kind kind = 0; kind < LAW_KINDS; kind++) {
        model *m = meeting(kind), *far = meeting(kind);
        dem_vec3 shift = v3(1024, -1024, 512);
        for (size_t i = 0; i < m->scene.bodies.count; i++) {
            // starts that both places can hold
            dem_vec3 x = v3_sub(v3_add(m->bodies[i].position, shift), shift);
            m->bodies[i].position = x;
            far->bodies[i].position = v3_add(x, shift);
        }
        outcome plain = run(m, STEPS), o = run(far, STEPS);
        for (size_t i = 0; i < o.count; i++)
            o.position[i] = v3_sub(o.position[i], shift);
        // 3000 roundings of 6e-14 m add up as a random walk to 3e-12 m
        check_same(&o, &plain, kind == PLUGIN ? 3e-7 : 1e-7);  // slips without a dashpot pass more of it on
        model_free(m);
        model_free(far);
    }
}

// ---- units

// lengths times `s` at the same times: masses s^3, stiffnesses and energies of a surface s^3, moduli s^2, forces s^4
static model *scaled_model(law_kind kind, double s)
{
    model *m = meeting(kind);
    m->materials[0].young *= s * s;
    m->laws[0].stiffness *= s * s * s;
    m->laws[0].work_of_adhesion *= s * s * s;
    m->laws[0].energy_density *= s * s;
    m->laws[0].friction_decay /= s;
    m->laws[0].bond_tension *= s * s * s * s;
    m->laws[0].bond_shear *= s * s * s * s;
    if (kind == PLUGIN) {
        static dem_law_value scaled[PLUGIN_VALUE_COUNT];
        memcpy(scaled, PLUGIN_VALUES, sizeof scaled);
        for (int i = 0; i < 2; i++)
            scaled[i].value *= s * s * s;
        m->laws[0].parameters = s == 1 ? PLUGIN_VALUES : scaled;
    }
    m->scene.gravity = v3(0, 0, -9.81 * s);
    for (size_t i = 0; i < m->scene.shape_count; i++) {
        m->shapes[i].sphere_radius *= s;
        if (!m->clumps[i])
            continue;
        dem_clump_def def = dem_clump_view(m->clumps[i]);
        dem_ball balls[16];
        for (size_t k = 0; k < def.ball_count; k++)
            balls[k] = (dem_ball){v3_scale(def.balls[k].centre, s), def.balls[k].radius * s};
        double cube = s * s * s, moments[3];
        for (int k = 0; k < 3; k++)
            moments[k] = def.inertia[k] * cube * s * s;
        size_t shapes = m->scene.shape_count;
        m->scene.shape_count = MODEL_SHAPES - 1;
        uint32_t made = model_clump(m, balls, def.ball_count, def.mass * cube, moments);
        m->scene.shape_count = shapes;
        dem_clump_destroy(m->clumps[i]);
        m->clumps[i] = m->clumps[made];
        m->shapes[i] = m->shapes[made];
        m->clumps[made] = NULL;
    }
    for (size_t i = 0; i < m->scene.bodies.count; i++) {
        m->bodies[i].position = v3_scale(m->bodies[i].position, s);
        m->bodies[i].velocity = v3_scale(m->bodies[i].velocity, s);
    }
    model_plane(m, v3(0, 0, -0.04 * s), v3(0, 0, 1));
    return m;
}

static void check_scaled(law_kind kind, double s, double tolerance)
{
    model *m = scaled_model(kind, 1), *small = scaled_model(kind, s);
    outcome plain = run(m, 2 * STEPS), o = run(small, 2 * STEPS);
    for (size_t i = 0; i < o.count; i++) {
        o.position[i] = v3_scale(o.position[i], 1 / s);
        o.velocity[i] = v3_scale(o.velocity[i], 1 / s);
        if (tolerance == 0) {
            check_vec(o.position[i], plain.position[i], 0);
            check_vec(o.velocity[i], plain.velocity[i], 0);
            check_vec(o.spin[i], plain.spin[i], 0);
        }
    }
    check_same(&o, &plain, tolerance);
    model_free(m);
    model_free(small);
}

static void grains_of_micrometres_move_like_grains_of_metres(void **state)
{
    (void)state;
    for (law_kind kind = 0; kind < LAW_KINDS; kind++) {
        check_scaled(kind, 1e-6, 1e-9);
        check_scaled(kind, 1e3, 1e-9);
        // a power of two rounds nothing: no length is hidden anywhere
        check_scaled(kind, 0x1p-20, 0);
    }
}

// ---- order

static void bodies_told_in_another_order_move_the_same_to_the_last_bit(void **state)
{
    (void)state;
    for (law_kind kind = 0; kind < LAW_KINDS; kind++) {
        model *m = meeting(kind), *other = meeting(kind);
        for (size_t i = 0; i < 4; i++)
            other->bodies[3 - i] = m->bodies[i];
        outcome plain = run(m, STEPS), o = run(other, STEPS);
        for (size_t i = 0; i < 4; i++) {
            check_vec(o.position[3 - i], plain.position[i], 0);
            check_vec(o.velocity[3 - i], plain.velocity[i], 0);
            check_vec(o.spin[3 - i], plain.spin[i], 0);
        }
        model_free(m);
        model_free(other);
    }
}

// shapes and materials under other numbers, the materials of laws in the other order
static void numbers_of_shapes_and_materials_do_not_matter(void **state)
{
    (void)state;
    outcome o[2];
    for (int swapped = 0; swapped < 2; swapped++) {
        model *m = meeting(HERTZ_ALL);
        dem_material kinds[2] = {{"stone", 2500, 1e7, 0.25}, {"wood", 700, 3e6, 0.4}};
        m->materials[swapped] = kinds[0];
        m->materials[1 - swapped] = kinds[1];
        m->scene.material_count = 2;
        m->scene.law_count = 3;
        for (int i = 0; i < 3; i++) {
            m->laws[i] = law_of(i == 1 ? LINEAR_ALL : HERTZ_ALL);
            uint32_t a = (uint32_t)(i / 2), b = (uint32_t)((i + 1) / 2);
            m->laws[i].materials[0] = swapped ? 1 - a : a;
            m->laws[i].materials[1] = swapped ? 1 - b : b;
        }
        for (uint32_t i = 0; i < 3; i++)
            m->shapes[i].material = (i == 1) != swapped;
        if (swapped) {
            dem_shape_def first = m->shapes[0];
            m->shapes[0] = m->shapes[2];
            m->shapes[2] = first;
            for (size_t i = 0; i < 4; i++)
                m->bodies[i].shape = 2 - m->bodies[i].shape;
        }
        o[swapped] = run(m, STEPS);
        model_free(m);
    }
    check_same(&o[1], &o[0], 0);
    for (size_t i = 0; i < 4; i++)
        check_vec(o[1].position[i], o[0].position[i], 0);
}

// ---- time

static void an_elastic_collision_of_clumps_runs_backwards(void **state)
{
    (void)state;
    for (int hertz = 0; hertz < 2; hertz++) {
        model *m = meeting(ELASTIC);
        if (hertz)
            m->laws[0].normal = DEM_NORMAL_HERTZ;
        m->scene.bodies.count = 2;  // a cloud and a dumbbell
        m->scene.gravity = v3(0, 1, 0);
        outcome there = run(m, STEPS);
        model *back = meeting(ELASTIC);
        back->laws[0] = m->laws[0];
        back->scene.gravity = m->scene.gravity;
        back->scene.bodies.count = 2;
        for (size_t i = 0; i < 2; i++) {
            dem_body_def *b = &back->bodies[i];
            b->position = there.position[i];
            b->orientation = there.orientation[i];
            b->velocity = v3_scale(there.velocity[i], -1);
            b->spin = v3_scale(there.spin[i], -1);
        }
        outcome o = run(back, STEPS), start = {.count = 2};
        for (size_t i = 0; i < 2; i++) {
            start.position[i] = m->bodies[i].position;
            start.orientation[i] = m->bodies[i].orientation;
            start.velocity[i] = v3_scale(m->bodies[i].velocity, -1);
            start.spin[i] = v3_scale(m->bodies[i].spin, -1);
        }
        // the steps are the same backwards: rounding alone, through some impacts there and back
        check_same(&o, &start, 1e-9);
        model_free(m);
        model_free(back);
    }
}

// ---- momentum

static void momentum_stays_whatever_the_law_and_wherever_bodies_are_kept(void **state)
{
    (void)state;
    for (law_kind kind = 0; kind < LAW_KINDS; kind++)
        for (int periodic = 0; periodic < 2; periodic++) {
            model *m = model_new();
            m->materials[0].young = 1e7;
            m->laws[0] = law_of(kind);
            model_cloud(m, 8, 0.02, 1);
            model_sphere(m, 0.008);
            // more bodies than a domain holds: momenta go by way of slots
            model_lattice(m, 700, 0.02, 2, 1);
            if (periodic) {
                double side = ceil(cbrt((double)m->scene.bodies.count)) * 0.02;
                m->scene.domain.low = v3(0, 0, 0);
                m->scene.domain.high = v3(side, side, side);
                for (int k = 0; k < 3; k++)
                    m->scene.domain.periodic[k] = true;
            }
            dem_world *w = model_world(m, 1);
            dem_vec3 p0, l0, p1, l1;
            total_momentum(w, &p0, &l0);
            run_steps(w, 1000);
            total_momentum(w, &p1, &l1);
            check(measured(w)->contacts > 4);
            double scale = 0;
            dem_body_view v = dem_world_bodies(w);
            for (size_t i = 0; i < v.count; i++)
                scale += v.mass[i] * 2;
            check_vec(p1, p0, 1e-12 * scale);
            // a body that crosses a side takes its angular momentum along; bounded rolling slows each body by itself
            if (!periodic && kind != JKR_BOUNDED)
                check_vec(l1, l0, 1e-12 * scale * 0.1);
            dem_world_destroy(w);
            model_free(m);
        }
}

// ---- symmetry

// a sphere that two others hit from both sides at once stays where it is
static void a_sphere_between_two_that_come_together_does_not_move(void **state)
{
    (void)state;
    for (law_kind kind = 0; kind < LAW_KINDS; kind++) {
        model *m = model_new();
        m->materials[0].young = 1e7;
        m->laws[0] = law_of(kind);
        model_sphere(m, 0.01);
        model_body(m, 0, v3(0, 0, 0));
        for (int side = -1; side < 2; side += 2) {
            dem_body_def *b = model_body(m, 0, v3(side * 0.021, 0, 0));
            b->velocity = v3(-side, 0, 0);
            b->spin = v3(0, 0, 50);
        }
        outcome o = run(m, 1000);
        check_vec(o.position[0], v3(0, 0, 0), 1e-15);
        check_vec(o.velocity[0], v3(0, 0, 0), 1e-13);
        check_near(o.velocity[2].x, -o.velocity[1].x, 1e-13);
        check_near(o.velocity[2].y, -o.velocity[1].y, 1e-13);
        model_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_boost_changes_nothing_but_the_velocity),
        cmocka_unit_test(a_problem_that_is_turned_turns_its_outcome),
        cmocka_unit_test(a_scene_far_from_the_origin_is_exact_to_the_rounding_there),
        cmocka_unit_test(grains_of_micrometres_move_like_grains_of_metres),
        cmocka_unit_test(bodies_told_in_another_order_move_the_same_to_the_last_bit),
        cmocka_unit_test(numbers_of_shapes_and_materials_do_not_matter),
        cmocka_unit_test(an_elastic_collision_of_clumps_runs_backwards),
        cmocka_unit_test(momentum_stays_whatever_the_law_and_wherever_bodies_are_kept),
        cmocka_unit_test(a_sphere_between_two_that_come_together_does_not_move),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
