// Laws of the user's: one that is built in, too; one whose restitution is known; one that reaches beyond the touch. And
// files that are no such laws.
#include "bench_contact.h"
#include "scenes.h"

#include "sim/restitution.h"

static const double R = 0.01, K = 1e5, E = 0.5;

static dem_pair_law plugin_law(const char *file, const dem_law_value *values, size_t count)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.normal = DEM_NORMAL_PLUGIN;
    law.plugin = file;
    law.parameters = values;
    law.parameter_count = count;
    return law;
}

static dem_pair_law user_linear(const char *file)
{
    static dem_law_value values[4];
    values[0] = (dem_law_value){"stiffness", K};
    values[1] = (dem_law_value){"damping_ratio", dem_damping_ratio_cut(E)};
    values[2] = (dem_law_value){"slide_stiffness", 2 * K / 7};
    values[3] = (dem_law_value){"friction", 0.3};
    return plugin_law(file, values, 4);
}

static dem_pair_law own_linear(void)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.stiffness = K;
    law.damping = DEM_DAMPING_RESTITUTION;
    law.restitution = E;
    law.friction = DEM_FRICTION_LINEAR;
    law.friction_coefficient = 0.3;
    return law;
}

static model *two_dumbbells(const dem_pair_law *law)
{
    model *m = model_new();
    m->laws[0] = *law;
    uint32_t shape = model_dumbbell(m, R, 0.016);
    dem_body_def *a = model_body(m, shape, v3(0, 0, 0)), *b = model_body(m, shape, v3(0.003, 0.006, 0.0192));
    a->spin = v3(30, -60, 50);
    b->spin = v3(-20, 40, 80);
    b->velocity = v3(-0.3, 0.2, -2);
    model_plane(m, v3(0, 0, -0.0101), v3(0, 0, 1));
    return m;
}

// both laws round in other places
static void the_built_in_law_written_as_a_plugin_gives_its_trajectory(void **state)
{
    (void)state;
    dem_pair_law laws[2] = {own_linear(), user_linear(PLUGIN_DIR "law_linear.so")};
    model *m[2];
    dem_world *w[2];
    for (int i = 0; i < 2; i++) {
        m[i] = two_dumbbells(&laws[i]);
        w[i] = model_world(m[i], 1);
    }
    double worst = 0;
    for (int i = 0; i < 60; i++) {
        for (int k = 0; k < 2; k++)
            run_steps(w[k], 10);
        check(measured(w[0])->contacts + measured(w[0])->wall_contacts ==
              measured(w[1])->contacts + measured(w[1])->wall_contacts);
        for (size_t b = 0; b < 2; b++) {
            worst = largest(worst, v3_norm(v3_sub(position_now(w[0], b), position_now(w[1], b))) / R);
            worst = largest(worst, v3_norm(v3_sub(velocity_before(w[0], b), velocity_before(w[1], b))));
        }
        const dem_energy *own = &dem_world_figures(w[0])->energy, *user = &dem_world_figures(w[1])->energy;
        check_near(own->elastic, user->elastic, 1e-12);
        check_near(own->friction, user->friction, 1e-12);
        check_near(own->viscous + own->friction, user->viscous + user->friction, 2e-2 * own->start);
        check(fabs(user->error) < 1e-3);  // of the rotation: what is lost is what is missing
    }
    check(dem_world_figures(w[0])->energy.friction > 1e-5);
    check(worst < 1e-10);
    for (int i = 0; i < 2; i++) {
        dem_world_destroy(w[i]);
        model_free(m[i]);
    }
}

static dem_pair_law user_walton_braun(double unloading)
{
    static dem_law_value values[3];
    values[0] = (dem_law_value){"loading", K};
    values[1] = (dem_law_value){"unloading", unloading};
    values[2] = (dem_law_value){"friction", 0.4};
    return plugin_law(PLUGIN_DIR "law_walton_braun.so", values, 3);
}

static void walton_and_brauns_law_has_one_restitution_for_all_speeds(void **state)
{
    (void)state;
    for (double speed = 0.05; speed < 3; speed *= 4)
        for (double ratio = 1; ratio < 10; ratio *= 2) {
            model *m = model_new();
            m->laws[0] = user_walton_braun(ratio * K);
            m->scene.time.step = 2e-6;
            model_body(m, model_sphere(m, R), v3(0, 0, R + 1e-9))->velocity = v3(0, 0, -speed);
            model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
            dem_world *w = model_world(m, 1);
            run_steps(w, 1500);
            check_close(velocity_before(w, 0).z, speed / sqrt(ratio), 2e-3);
            check(fabs(measured(w)->energy.error) < 1e-9);
            check_near(dem_world_figures(w)->energy.viscous, (1 - 1 / ratio) * dem_world_figures(w)->energy.start,
                       4e-3 * dem_world_figures(w)->energy.start);
            dem_world_destroy(w);
            model_free(m);
        }
}

// a ball that touches a wet plane hangs on to it up to the rupture
static void a_bridge_holds_beyond_the_touch_and_not_before_it(void **state)
{
    (void)state;
    static dem_law_value values[] = {{"stiffness", 1e5}, {"damping_ratio", 0.5}, {"pull", 0.5}, {"rupture", 1e-3}};
    double weight = 2500 * 4 * DEM_PI / 3 * R * R * R * 9.81;
    for (int touched = 0; touched < 2; touched++)
        for (int strong = 0; strong < 2; strong++) {
            model *m = model_new();
            values[2].value = strong ? 0.5 : 0.5 * weight;
            m->laws[0] = plugin_law(PLUGIN_DIR "law_bridge.so", values, 4);
            m->scene.gravity = v3(0, 0, -9.81);
            model_body(m, model_sphere(m, R), v3(0, 0, touched ? -R + 1e-7 : -R - 5e-4));
            model_plane(m, v3(0, 0, 0), v3(0, 0, -1));
            dem_world *w = model_world(m, 1);
            run_steps(w, 20000);
            bool hangs = position_now(w, 0).z > -R - 1e-3;
            check(hangs == (touched && strong));
            check(!hangs || fabs(R + position_now(w, 0).z - (0.5 - weight) / 1e5) < 1e-9);
            check(fabs(measured(w)->energy.error) < 1e-3);
            dem_world_destroy(w);
            model_free(m);
        }
}

// grains by the plug-in, walls by a law that is built in: as with both built in
static void a_plugin_stands_beside_built_in_laws(void **state)
{
    (void)state;
    dem_vec3 end[2][2];
    for (int user = 0; user < 2; user++) {
        dem_pair_law grains = user ? user_linear(PLUGIN_DIR "law_linear.so") : own_linear();
        model *m = two_dumbbells(&grains);
        m->materials[1] = (dem_material){"floor", 1000, 3e7, 0.4};
        m->scene.material_count = 2;
        m->walls[0].material = 1;
        m->laws[1] = own_linear();
        m->laws[1].materials[1] = 1;
        m->laws[1].normal = DEM_NORMAL_HERTZ;
        m->laws[1].friction = DEM_FRICTION_MINDLIN;
        m->scene.law_count = 2;
        dem_world *w = model_world(m, 1);
        run_steps(w, 600);
        for (size_t b = 0; b < 2; b++)
            end[user][b] = position_now(w, b);
        check(measured(w)->energy.friction > 1e-5 && fabs(dem_world_figures(w)->energy.error) < 5e-3);
        dem_world_destroy(w);
        model_free(m);
    }
    for (size_t b = 0; b < 2; b++)
        check_vec(end[0][b], end[1][b], 1e-11);
}

// twelve pairs of balls that collide: of the plug-in, of the law that is built in, or by turns
static void collide_pairs(int kinds, dem_vec3 velocity[24])
{
    model *m = model_new();
    m->scene.time.step = 1e-5;
    m->materials[1] = m->materials[0];
    m->materials[1].name = "other";
    m->scene.material_count = 2;
    // where all is built in, nothing of the plug-in is there
    m->laws[0] = kinds == 1 ? own_linear() : plugin_law(PLUGIN_DIR "law_smallest.so", NULL, 0);
    m->laws[1] = m->laws[2] = own_linear();
    m->laws[1].materials[1] = 1;
    m->laws[2].materials[0] = m->laws[2].materials[1] = 1;
    m->scene.law_count = 3;
    model_sphere(m, R);
    model_sphere(m, R);
    m->shapes[1].material = 1;
    for (int i = 0; i < 12; i++) {
        uint32_t shape = kinds == 2 ? (uint32_t)(i % 2) : (uint32_t)kinds;
        for (int side = 0; side < 2; side++) {
            dem_body_def *b = model_body(m, shape, v3(0.1 * i, 0.0015 * i * side, 0.021 * side));
            b->velocity = v3(0.1 * i, 0, side ? -1 : 1);
            b->spin = v3(10, 20 * i, 5);
        }
    }
    dem_world *w = model_world(m, 1);
    run_steps(w, 600);
    for (size_t b = 0; b < 24; b++)
        velocity[b] = velocity_before(w, b);
    dem_world_destroy(w);
    model_free(m);
}

// contacts of both laws share the lanes of one vector
static void laws_in_neighbouring_lanes_do_not_meet(void **state)
{
    (void)state;
    dem_vec3 apart[2][24], mixed[24];
    collide_pairs(0, apart[0]);
    collide_pairs(1, apart[1]);
    collide_pairs(2, mixed);
    for (size_t b = 0; b < 24; b++) {
        check_vec(mixed[b], apart[b / 2 % 2][b], 1e-12);
        check(v3_norm(v3_sub(apart[0][b], apart[1][b])) > 1e-3);
    }
}

static model *user_gas(const char *file)
{
    model *m = model_new();
    m->laws[0] = user_linear(file);
    m->scene.time.step = 2e-5;
    model_sphere(m, 2 * R);
    model_dumbbell(m, 1.5 * R, 2 * R);
    model_lattice(m, 600, 4.6 * R, 1, 1);
    return m;
}

// two threads, a restart, and loops without vectors
static void bits_do_not_depend_on_threads_restarts_and_instruction_sets(void **state)
{
    (void)state;
    uint64_t want = 0;
    for (int i = 0; i < 4; i++) {
        model *m = user_gas(i == 3 ? PLUGIN_DIR "law_linear_plain.so" : PLUGIN_DIR "law_linear.so");
        dem_world *w = model_world(m, i == 1 ? 2 : 1);
        run_steps(w, 500);
        if (i == 2) {
            void *bytes;
            size_t size;
            dem_error error;
            check_ok(dem_world_save(w, &bytes, &size, &error), error);
            dem_world_destroy(w);
            w = model_world(m, 1);
            check_ok(dem_world_restore(w, bytes, size, &error), error);
            // numbers of a law are part of what is saved
            static dem_law_value other[4];
            memcpy(other, m->laws[0].parameters, sizeof other);
            other[3].value = 0.4;
            m->laws[0].parameters = other;
            dem_world *stranger = model_world(m, 1);
            check(dem_world_restore(stranger, bytes, size, &error) == DEM_BAD_INPUT);
            dem_world_destroy(stranger);
            free(bytes);
        }
        run_steps(w, 500);
        check(measured(w)->energy.friction > 0);
        want = want ? want : dem_world_hash(w);
        assert_int_equal(dem_world_hash(w), want);
        dem_vec3 linear, angular;
        total_momentum(w, &linear, &angular);
        check(isfinite(v3_norm(linear)));
        dem_world_destroy(w);
        model_free(m);
    }
}

static void an_automatic_step_takes_the_laws_own_stiffness(void **state)
{
    (void)state;
    double step[2];
    for (int user = 0; user < 2; user++) {
        dem_pair_law law = user ? user_linear(PLUGIN_DIR "law_linear.so") : own_linear();
        model *m = two_dumbbells(&law);
        m->scene.time.step = 0;
        m->scene.time.safety = 0.8;
        dem_world *w = model_world(m, 1);
        run_steps(w, 2000);
        step[user] = dem_world_step_size(w);
        check(fabs(measured(w)->energy.error) < 1e-2);
        dem_world_destroy(w);
        model_free(m);
    }
    check(step[1] > 0.7 * step[0] && step[1] < 1.01 * step[0]);
}

typedef struct refusal {
    const char *normal, *more, *says;
} refusal;

static void what_is_no_such_law_is_refused(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"'plugin': 'nowhere.so'", "", "scene.json:3: contacts[0].normal.plugin: cannot read"},
        {"'plugin': 'not_a_law.so'", "", "has no symbol 'dem_law_plugin'"},
        {"'plugin': 'law_other.so'", "", "was compiled for another version of the library"},
        {"'plugin': 'CMakeFiles'", "", "cannot load the plug-in"},
        {"'plugin': 3", "", "needs a text"},
        {"'plugin': 'law_linear.so', 'slide_stiffness': 1", "", "the law linear needs 'stiffness'"},
        {"'plugin': 'law_linear.so', 'stifness': 1", "", "unknown parameter 'stifness'"},
        {"'plugin': 'law_linear.so', 'stiffness': '3 m', 'slide_stiffness': 1", "", "is not a unit of stiffness"},
        {"'plugin': 'law_linear.so', 'stiffness': -3, 'slide_stiffness': 1", "", "must be at least 0"},
        {"'plugin': 'law_linear.so', 'stiffness': 3, 'slide_stiffness': 1", ", 'friction': {'coefficient': 1}",
         "the law of a plug-in says all forces"},
        {"'law': 'plugin'", "", "unknown law 'plugin'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[600];
        snprintf(text, sizeof text,
                 "{'schema': 'dem-scene/1', 'materials': {'a': {}},\n 'contacts': [\n{'between': ['a', 'a'], 'normal': "
                 "{%s}%s}]}",
                 cases[i].normal, cases[i].more);
        dem_scene scene;
        dem_error error;
        char *says = quoted(cases[i].says), told[1600];
        dem_status status = scene_read(text, PLUGIN_DIR, NULL, &scene, &error);
        snprintf(told, sizeof told, "%s:%ld: %s", error.file, error.line, error.text);
        if (!strstr(told, says) || status != DEM_BAD_INPUT || error.line != 3)
            print_error("%s\n%s\nwanted: %s\n", text, told, says);
        check(status == DEM_BAD_INPUT && strstr(told, says) && error.line == 3);
        free(says);
    }
}

static void a_scene_with_a_plugin_is_written_as_it_was_read(void **state)
{
    (void)state;
    dem_scene scene;
    dem_error error;
    char *text;
    check_ok(scene_read("{'schema': 'dem-scene/1', 'materials': {'a': {}}, 'contacts': [{'between': ['a', 'a'],\n"
                        "'normal': {'plugin': 'law_linear.so', 'stiffness': '2 kN/m', 'slide_stiffness': 7}}]}",
                        PLUGIN_DIR, NULL, &scene, &error),
             error);
    check_ok(dem_scene_resolved(&scene, &text, &error), error);
    check(strstr(text, "law_linear.so\", \"stiffness\": 2000, \"slide_stiffness\": 7"));
    free(text);
    dem_scene_release(&scene);
}

int main(void)
{
#if !DEM_PLUGINS
    return 0;
#endif
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_built_in_law_written_as_a_plugin_gives_its_trajectory),
        cmocka_unit_test(walton_and_brauns_law_has_one_restitution_for_all_speeds),
        cmocka_unit_test(a_bridge_holds_beyond_the_touch_and_not_before_it),
        cmocka_unit_test(a_plugin_stands_beside_built_in_laws),
        cmocka_unit_test(laws_in_neighbouring_lanes_do_not_meet),
        cmocka_unit_test(bits_do_not_depend_on_threads_restarts_and_instruction_sets),
        cmocka_unit_test(an_automatic_step_takes_the_laws_own_stiffness),
        cmocka_unit_test(what_is_no_such_law_is_refused),
        cmocka_unit_test(a_scene_with_a_plugin_is_written_as_it_was_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
