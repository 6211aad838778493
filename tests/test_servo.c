// Servo walls: they reach their force without swinging about it, whatever form they have, and are part of the state.
#include "scenes.h"
#include "sim/servo.h"
#include "walls.h"
#include "worlds.h"

enum { GRAINS = 216 };

static dem_servo_def servo(dem_vec3 direction, double force, double fastest)
{
    return (dem_servo_def){.on = true, .direction = direction, .target = force, .gain = 0.5, .max_velocity = fastest};
}

static void damp(model *m)
{
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
}

// a ball of 1 cm on the floor of a fixed plane, under one that presses
static model *press(double force)
{
    model *m = model_new();
    damp(m);
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.01));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    model_plane(m, v3(0, 0, 0.0205), v3(0, 0, -1))->servo = servo(v3(0, 0, -1), force, 0.05);
    return m;
}

// Two springs of 1e4 N/m in series under 20 N: 2 mm each.
static void a_press_comes_to_its_force_without_overshoot(void **state)
{
    (void)state;
    model *m = press(20);
    dem_world *w = model_world(m, 1);
    double most = 0, gravest = 0;
    for (int i = 0; i < 400; i++) {
        run_steps(w, 50);
        // before, next to nothing was turned over
        most = i > 60 ? largest(most, measured(w)->energy.error) : 0;
        measured(w);
        size_t count;
        double force = dem_world_walls(w, &count)[1].force.z;
        gravest = fmax(gravest, force);
        if (i > 300)
            check_near(force, 20, 0.005 * 20);
    }
    check(gravest < 1.005 * 20);
    check_close(w->walls.items[1].travel, 0.0005 + 2 * 0.002, 1e-6);
    check_vec(dem_world_bodies(w).position[0], v3(0, 0, 0.01 - 0.002), 1e-8);
    check(most < 1e-6);
    dem_world_destroy(w);
    model_free(m);
}

// a wall of 2 kg on the spring of a ball that is held, k = 1e4 N/m: 11.25 Hz; with a rate of 100/s it comes to rest
static void a_wall_with_a_mass_swings_as_that_mass(void **state)
{
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        model *m = model_new();
        model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.01))->hold = DEM_LOCK_X | DEM_LOCK_Y | DEM_LOCK_Z;
        dem_wall_def *wall = model_plane(m, v3(0, 0, 0.019), v3(0, 0, -1));
        wall->servo = servo(v3(0, 0, -1), 20, 10);
        wall->servo.mass = 2;
        wall->servo.damping_rate = damped ? 100 : 0;
        dem_world *w = model_world(m, 1);
        // starts 1 mm into a spring that holds 2 mm, at rest
        if (!damped) {
            double period = 2 * DEM_PI * sqrt(2 / 1e4);
            uint64_t steps = (uint64_t)(period / 1e-5 + 0.5);
            run_steps(w, steps / 2);
            check_close(w->walls.items[0].travel, 0.002, 1e-3);  // the far end
            run_steps(w, steps - steps / 2);
            check_near(w->walls.items[0].travel, 0, 2e-6);
        } else {
            run_steps(w, 50000);
            check_close(w->walls.items[0].travel, 0.001, 1e-6);
        }
        dem_world_destroy(w);
        model_free(m);
    }
}

// ---- a box of grains

static void add_side(model *m, int axis, double at, double side, double stress, bool mesh)
{
    dem_vec3 n = v3(axis == 0, axis == 1, axis == 2);
    dem_vec3 normal = v3_scale(n, -side);
    uint32_t index = (uint32_t)m->scene.wall_count, low = 2 * (uint32_t)((axis + 1) % 3),
             next = 2 * (uint32_t)((axis + 2) % 3);
    dem_wall_def *wall = model_plane(m, v3_scale(n, side * at), normal);
    wall->servo = servo(normal, stress, 0.1);
    wall->servo.stress = true;
    wall->servo.extent[0] = (dem_servo_extent){0, {low, low + 1}};
    wall->servo.extent[1] = (dem_servo_extent){0, {next, next + 1}};
    wall->servo.partner = (index ^ 1) + 1;
    if (!mesh)
        return;
    dem_vec3 u = v3_scale(v3_normal_to(normal), 3 * at), v = v3_cross(normal, u), c = wall->point;
    wall->kind = DEM_WALL_MESH;
    wall->mesh =
        wall_quad(v3_sub(v3_sub(c, u), v), v3_sub(v3_add(c, u), v), v3_add(v3_add(c, u), v), v3_add(v3_sub(c, u), v));
    wall->servo.extent[0] = wall->servo.extent[1] = (dem_servo_extent){2 * at, {0, 0}};
}

static model *box_of_grains(size_t count, bool mesh)
{
    model *m = model_new();
    damp(m);
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.3;
    m->laws[0].stiffness_ratio = 2.0 / 7;
    m->scene.damping.local = 0.3;
    double r = 0.002, cell = 2.3 * r;
    int side = (int)ceil(cbrt((double)count) - 1e-9);
    dem_random random = random_stream(5, 5);
    uint32_t large = model_sphere(m, r), small = model_sphere(m, 0.8 * r);
    for (int i = 0; i < (int)count; i++) {
        dem_vec3 x =
            v3(i % side - (side - 1) / 2.0, i / side % side - (side - 1) / 2.0, i / side / side - (side - 1) / 2.0);
        dem_vec3 jitter = random_in(&random, v3(-0.1, -0.1, -0.1), v3(0.1, 0.1, 0.1));
        model_body(m, i % 2 ? large : small, v3_scale(v3_add(x, jitter), cell));
    }
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < 2; k++)
            add_side(m, axis, cell * side / 2, k ? 1 : -1, (axis + 1) * 2e3, mesh && axis == 2 && k == 1);
    return m;
}

static void check_stresses(dem_world *w, double tolerance)
{
    size_t count;
    measured(w);
    const dem_wall_view *v = dem_world_walls(w, &count);
    for (int axis = 0; axis < 3; axis++) {
        double push = v3_get(v[2 * axis + 1].force, axis) - v3_get(v[2 * axis].force, axis);
        double area = dem_servo_area(&w->walls, 2 * (size_t)axis);
        check_close(push / 2 / area, (axis + 1) * 2e3, tolerance);
    }
}

// three stresses that differ: within the 0.5 % of PHYSICS 5, and they stay there
static void a_box_comes_to_its_three_stresses(void **state)
{
    (void)state;
    model *m = box_of_grains(GRAINS, false);
    dem_world *w = model_world(m, 1);
    double most = 0;
    for (int i = 0; i < 40; i++) {
        run_steps(w, 400);
        if (i > 34)
            check_stresses(w, 0.005);
        most = i > 10 ? largest(most, measured(w)->energy.error) : 0;
    }
    check(most < 2e-3);
    for (int k = 0; k < 6; k += 2)
        check(w->walls.items[k].travel > 0 && w->walls.items[k].travel == w->walls.items[k + 1].travel);
    dem_world_destroy(w);
    model_free(m);
}

static void a_mesh_plate_is_as_good_a_servo(void **state)
{
    (void)state;
    if (!DEM_EMBREE)
        skip();
    dem_world *w[2];
    model *m[2];
    for (int mesh = 0; mesh < 2; mesh++) {
        m[mesh] = press(20);
        dem_wall_def *wall = &m[mesh]->walls[1];
        if (mesh) {
            wall->kind = DEM_WALL_MESH;
            wall->mesh = wall_quad(v3(-1, -1, 0.0205), v3(-1, 1, 0.0205), v3(1, 1, 0.0205), v3(1, -1, 0.0205));
        }
        wall->servo.stress = true;
        wall->servo.target = mesh ? 20 / 4.0 : 20;
        wall->servo.area = mesh ? 0 : 1;  // its own 2 m x 2 m
        w[mesh] = model_world(m[mesh], 1);
        run_steps(w[mesh], 20000);
    }
    check_close(w[1]->walls.items[1].travel, w[0]->walls.items[1].travel, 1e-9);
    check_vec(position_now(w[1], 0), position_now(w[0], 0), 1e-12);
    for (int i = 0; i < 2; i++) {
        dem_world_destroy(w[i]);
        model_free(m[i]);
    }
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    model *m = box_of_grains(1000, false);
    uint64_t hash = 0;
    double travel = 0;
    const int threads[] = {1, 2, 8};
    for (int i = 0; i < 3; i++) {
        dem_world *w = model_world(m, threads[i]);
        run_steps(w, 600);
        check(i == 0 || (dem_world_hash(w) == hash && w->walls.items[0].travel == travel));
        hash = dem_world_hash(w);
        travel = w->walls.items[0].travel;
        check(travel > 0);
        dem_world_destroy(w);
    }
    model_free(m);
}

static void a_run_goes_on_bit_for_bit(void **state)
{
    (void)state;
    model *m = box_of_grains(GRAINS, false);
    dem_world *w = model_world(m, 1);
    run_steps(w, 2500);
    dem_world *other = model_resumed(m, w, 1);
    run_steps(w, 1000);
    check(other->walls.items[3].speed != 0);
    run_steps(other, 1000);
    check(dem_world_hash(w) == dem_world_hash(other));
    dem_world_destroy(w);
    dem_world_destroy(other);
    model_free(m);
}

// ---- scenes

#define WALLS(members) "{" SCENE_HEAD ",\n 'walls': {" members "}}"
#define PLATE "'material': 'rock', 'plane': {'point': [0, 0, 1], 'normal': [0, 0, -1]}"

static void a_servo_is_read(void **state)
{
    (void)state;
    dem_scene s = scene_of(WALLS("'a': {" PLATE ", 'servo': {'stress': '2 kPa', 'extents': [['b', 'a'], '5 mm'],"
                                 "'max_velocity': '1 cm/s', 'mass': 3, 'damping_rate': 7, 'partner': 'b'}},"
                                 "'b': {" PLATE ", 'servo': {'force': '3 kN', 'max_velocity': 2, 'gain': 0.25,"
                                 "'direction': [0, 2, 0]}}"));
    const dem_servo_def *a = &s.walls[0].servo, *b = &s.walls[1].servo;
    check(a->on && a->stress && a->target == 2000 && a->max_velocity == 0.01 && a->gain == 0.5 && a->mass == 3);
    check(a->damping_rate == 7 && a->partner == 2 && a->direction.z == -1 && a->extent[1].length == 0.005);
    check(a->extent[0].walls[0] == 1 && a->extent[0].walls[1] == 0 && a->extent[0].length == 0);
    check(b->on && !b->stress && b->target == 3000 && b->gain == 0.25 && b->direction.y == 1 && b->partner == 0);
    dem_scene_release(&s);
    s = scene_of(WALLS("'f': {" PLATE "}, 'w': {'material': 'rock', 'box': {'min': [0, 0, 0], 'max': [1, 2, 3]},"
                       "'servo': {'stress': [1, null, 3], 'max_velocity': 1}}"));
    const dem_wall_def *side = s.walls + 1;
    check(side[0].servo.target == 1 && side[0].servo.partner == 3 && side[1].servo.partner == 2);
    check(!side[2].servo.on && !side[3].servo.on && side[5].servo.target == 3 && side[5].servo.direction.z == -1);
    check(side[5].servo.extent[0].walls[0] == 1 && side[5].servo.extent[1].walls[1] == 4);
    dem_scene_release(&s);
}

static void wrong_servos_are_refused(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"{" PLATE ", 'servo': {'force': 1}}", "'max_velocity' is missing"},
        {"{" PLATE ", 'servo': {'max_velocity': 1}}", "needs 'force' or 'stress'"},
        {"{" PLATE ", 'servo': {'force': 1, 'stress': 1, 'max_velocity': 1}}", "needs 'force' or 'stress'"},
        {"{" PLATE ", 'servo': {'force': '1 m', 'max_velocity': 1}}", "N"},
        {"{" PLATE ", 'servo': {'force': -1, 'max_velocity': 1}}", "must be at least 0"},
        {"{" PLATE ", 'servo': {'force': 1, 'max_velocity': 1, 'gain': 2}}", "at most 1"},
        {"{" PLATE ", 'servo': {'force': 1, 'max_velocity': 0}}", "must be above 0"},
        {"{" PLATE ", 'servo': {'stress': [1, 2, 3], 'area': 1, 'max_velocity': 1}}", "those of a box"},
        {"{" PLATE ", 'servo': {'force': 1, 'max_velocity': 1, 'damping_rate': 1}}", "a wall with a mass"},
        {"{" PLATE ", 'servo': {'force': 1, 'max_velocity': 1, 'partner': 'v'}}", "unknown wall"},
        {"{" PLATE ", 'servo': {'stress': 1, 'max_velocity': 1, 'extents': [['w', 'v'], 1]}}", "unknown wall"},
        {"{'material': 'rock', 'cylinder': {'point': [0, 0, 0], 'axis': [0, 0, 1], 'radius': 1},"
         "'servo': {'force': 1, 'max_velocity': 1}}",
         "'direction' is missing"},
        {"{'material': 'rock', 'box': {'min': [0, 0, 0], 'max': [1, 2, 3]},"
         "'servo': {'force': 1, 'max_velocity': 1, 'area': 3}}",
         "the sides of a box"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1200];
        dem_scene s;
        dem_error error;
        snprintf(text, sizeof text, "{" SCENE_HEAD ",\n 'walls': {'w': %s}}", cases[i][0]);
        check(scene_read(text, NULL, NULL, &s, &error) == DEM_BAD_INPUT);
        char *want = quoted(cases[i][1]);
        if (!strstr(error.text, want) || error.line != 7)
            print_error("%s: %s (line %ld)\n", text, error.text, error.line);
        check(strstr(error.text, want) && error.line == 7 && strchr(error.text, ';'));
        free(want);
    }
}

// what only the world can know
static void a_servo_without_an_area_has_no_stress(void **state)
{
    (void)state;
    model *m = press(20);
    m->walls[1].servo.stress = true;
    dem_world *w;
    dem_error error;
    check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_BAD_INPUT && strstr(error.text, "no area;"));
    m->walls[1].servo = servo(v3(0, 0, -1), 20, 0.05);
    m->walls[1].servo.partner = 1;
    check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_BAD_INPUT && strstr(error.text, "no servo wall;"));
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_press_comes_to_its_force_without_overshoot),
        cmocka_unit_test(a_wall_with_a_mass_swings_as_that_mass),
        cmocka_unit_test(a_box_comes_to_its_three_stresses),
        cmocka_unit_test(a_mesh_plate_is_as_good_a_servo),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(a_run_goes_on_bit_for_bit),
        cmocka_unit_test(a_servo_is_read),
        cmocka_unit_test(wrong_servos_are_refused),
        cmocka_unit_test(a_servo_without_an_area_has_no_stress),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
