// Values laid over a scene: -D path.to.key=value.
#include "scenes.h"

static const char text[] = "{" SCENE_HEAD ",\n'bodies': [{'shape': 'ball', 'position': [0, 0, 0]},\n"
                           "{'shape': 'ball', 'position': [5, 0, 0]}]}";

static dem_status with(const char *override, dem_scene *scene, dem_error *error)
{
    const char *const overrides[] = {override, NULL};
    return scene_read(text, NULL, overrides, scene, error);
}

static dem_scene scene_with(const char *override)
{
    dem_scene scene;
    dem_error error;
    check_ok(with(override, &scene, &error), error);
    return scene;
}

static void values_replace_those_of_the_file(void **state)
{
    (void)state;
    dem_scene s = scene_with("materials.rock.young=2 GPa");
    check(s.materials[0].young == 2e9);
    dem_scene_release(&s);
    s = scene_with("bodies.1.scale=3");
    check(s.bodies.bodies[1].scale == 3);
    dem_scene_release(&s);
    s = scene_with("bodies[0].position[2]=-1 cm");
    check_vec(s.bodies.bodies[0].position, v3(0, 0, -0.01), 0);
    dem_scene_release(&s);
    s = scene_with("bodies=[]");
    check(s.bodies.count == 0);
    dem_scene_release(&s);
    s = scene_with("title=a = b");
    assert_string_equal(s.title, "a = b");
    dem_scene_release(&s);
    s = scene_with("title=");
    assert_string_equal(s.title, "");
    dem_scene_release(&s);
}

static void objects_on_the_way_are_made(void **state)
{
    (void)state;
    dem_scene s = scene_with("time.end=2");
    check(s.time.end == 2);
    dem_scene_release(&s);
    s = scene_with("contacts[1].friction={\"coefficient\": 0.3}");
    check(s.laws[1].friction_coefficient == 0.3 && s.laws[0].friction == DEM_FRICTION_NONE);
    dem_scene_release(&s);
    s = scene_with("contacts.0.friction.coefficient=0.4");
    check(s.laws[0].friction_coefficient == 0.4);
    dem_scene_release(&s);
    const char *const several[] = {"time.end=1", "time.end=2", "time.step=auto", "gravity=[0, 0, \"-1 m/s2\"]", NULL};
    dem_error error;
    check_ok(scene_read(text, NULL, several, &s, &error), error);
    check(s.time.end == 2 && s.gravity.z == -1);
    dem_scene_release(&s);
}

static void a_wrong_value_is_told_by_its_override(void **state)
{
    (void)state;
    static const char *const cases[][3] = {
        {"time.safety=2", "-D time.safety", "time.safety: must be above 0 and at most 1, not 2; correct it"},
        {"gravity=[0,0]", "-D gravity", "gravity: needs a list of 3: [x, y, z]; separate them by commas"},
        {"gravity=[0,0,\"1 kg\"]", "-D gravity", "gravity[2]: 'kg' is not a unit of acceleration"},
        {"tyme.end=2", "-D tyme.end", "unknown key \"tyme\"; did you mean \"time\"?"},
        {"time.and=2", "-D time.and", "unknown key \"and\"; did you mean \"end\"?"},
        {"time=3", "-D time", "time: needs an object"},
        {"contacts[0].normal.law=hertz", "scene.json", "contacts[0].normal: the law hertz has no \"stiffness\""},
        {"contacts[0].friction.law=linear", "-D contacts[0].friction.law", "\"coefficient\" is missing"},
        {"bodies.0.shape=bal", "-D bodies.0.shape", "did you mean \"ball\"?"},
        {"bodies=5", "-D bodies", "bodies: needs a list"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_scene scene;
        dem_error error;
        dem_status status = with(cases[i][0], &scene, &error);
        if (status != DEM_BAD_INPUT || strcmp(error.file, cases[i][1]) != 0 || !strstr(error.text, cases[i][2]))
            print_error("%s: %d %s:%ld: %s\n", cases[i][0], status, error.file, error.line, error.text);
        check(status == DEM_BAD_INPUT && strcmp(error.file, cases[i][1]) == 0 && strstr(error.text, cases[i][2]));
        check((error.line == 0) == (error.file[0] == '-'));
    }
}

static void a_value_of_the_file_is_told_by_the_file(void **state)
{
    (void)state;
    dem_scene scene;
    dem_error error;
    const char *const overrides[] = {"time.safety=0.5", "bodies[0].scale=2", NULL};
    check(scene_read("{'schema': 'dem-scene/1',\n'time': {'end': -1}, 'bodies': [{}]}", NULL, overrides, &scene,
                     &error) == DEM_BAD_INPUT);
    check(error.line == 2 && strstr(error.text, "time.end") && strcmp(error.file, "scene.json") == 0);
}

static void a_wrong_path_is_wrong_usage(void **state)
{
    (void)state;
    static const char *const cases[] = {"time.end",
                                        "=5",
                                        "time..end=1",
                                        "time.=1",
                                        ".time=1",
                                        "bodies[2]=1",
                                        "bodies.x=1",
                                        "bodies[0=1",
                                        "bodies[]=1",
                                        "[0]=1",
                                        "time[0].end=1",
                                        "bodies[-1].scale=1",
                                        "schema.x=1",
                                        "",
                                        "bodies.0.position.0.x=1",
                                        "bodies[9999999999999999999999].scale=1",
                                        "title=\xff"};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_scene scene;
        dem_error error;
        dem_status status = with(cases[i], &scene, &error);
        if (status != DEM_USAGE)
            print_error("%s: %d %s\n", cases[i], status, error.text);
        check(status == DEM_USAGE && strncmp(error.text, "-D ", 3) == 0 && strchr(error.text, ';'));
        check(!scene.owner);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_replace_those_of_the_file),
        cmocka_unit_test(objects_on_the_way_are_made),
        cmocka_unit_test(a_wrong_value_is_told_by_its_override),
        cmocka_unit_test(a_value_of_the_file_is_told_by_the_file),
        cmocka_unit_test(a_wrong_path_is_wrong_usage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
