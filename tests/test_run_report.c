#include "folder.h"

#include "base/json.h"
#include "out/run_report.h"

static const dem_pass_time PASSES[] = {{"narrow", 1.5}, {"contacts", 2}, {"integrate", 0.25}};
static const char *const WARNINGS[] = {"overlap of 12 %; take a stiffer contact", "\"quoted\""};

static dem_run_report sample(void)
{
    return (dem_run_report){.title = "sand",
                            .scene = "{\n  \"schema\": \"dem-scene/1\",\n  \"gravity\": [0, 0, -9.81]\n}\n",
                            .ended = "done",
                            .figures = {.time = 0.5,
                                        .step = 60000,
                                        .bodies = 2000,
                                        .spheres = 42000,
                                        .contacts = 5432,
                                        .wall_contacts = 321,
                                        .coordination = 4.5,
                                        .overlap_ratio = 0.001,
                                        .largest_overlap_ratio = 0.0125,
                                        .fastest = 3,
                                        .centre = {1, 2, 3},
                                        .highest = 4,
                                        .energy = {.kinetic = 1e-5,
                                                   .rotational = 2e-5,
                                                   .potential = -3e-2,
                                                   .elastic = 4e-4,
                                                   .friction = 5e-3,
                                                   .viscous = 6e-3,
                                                   .start = 7,
                                                   .error = 2e-4}},
                            .steps = 50000,
                            .warmup = 10000,
                            .step = 1e-5,
                            .critical_step = 1.25e-5,
                            .loop_seconds = 4,
                            .setup_seconds = 0.25,
                            .bytes_per_clump = 970,
                            .threads = 2,
                            .passes = PASSES,
                            .pass_count = 3,
                            .warnings = WARNINGS,
                            .warning_count = 2};
}

static double number_at(const dem_json *object, const char *key)
{
    double value = NAN;
    if (!dem_json_number(dem_json_member(object, key), &value))
        print_error("no number %s\n", key);
    return value;
}

static dem_json *parsed(const dem_buffer *text)
{
    dem_json *root;
    dem_error error;
    check_ok(dem_json_parse(text->data, text->size, "report", &root, &error), error);
    return root;
}

static void programs_find_every_figure(void **state)
{
    (void)state;
    dem_run_report r = sample();
    dem_buffer out = {0};
    dem_run_report_json(&out, &r);
    dem_json *root = parsed(&out);
    check(number_at(root, "steps") == 50000 && number_at(root, "time") == 0.5 && number_at(root, "step") == 1e-5);
    check(number_at(root, "loop_seconds") == 4 && number_at(root, "setup_seconds") == 0.25);
    check(number_at(root, "clumps") == 2000 && number_at(root, "spheres") == 42000);
    check(number_at(root, "contacts") == 5432 && number_at(root, "wall_contacts") == 321);
    check(number_at(root, "kinetic_energy") == 1e-5 + 2e-5 && number_at(root, "potential_energy") == -3e-2);
    check(number_at(root, "energy_error") == 2e-4 && number_at(root, "max_overlap_ratio") == 0.0125);
    check(number_at(root, "critical_step") == 1.25e-5 && number_at(root, "bytes_per_clump") == 970);
    check(number_at(dem_json_member(root, "energy"), "viscous") == 6e-3);
    const dem_json *passes = dem_json_member(root, "passes"), *warnings = dem_json_member(root, "warnings");
    for (int i = 0; i < 3; i++)
        check(number_at(passes, PASSES[i].name) == PASSES[i].seconds);
    check(dem_json_length(warnings) == 2);
    assert_string_equal(dem_json_string(dem_json_item(warnings, 1)), "\"quoted\"");
    check(!dem_json_member(root, "scene"));
    dem_json_release(root);
    dem_buffer_release(&out);
}

static void what_is_not_known_is_null(void **state)
{
    (void)state;
    dem_run_report r = sample();
    r.figures.energy.error = NAN;
    r.critical_step = INFINITY;
    r.pass_count = r.warning_count = 0;
    dem_buffer out = {0};
    dem_run_report_json(&out, &r);
    dem_json *root = parsed(&out);
    check(dem_json_is_null(dem_json_member(root, "energy_error")));
    check(dem_json_is_null(dem_json_member(root, "critical_step")));
    check(dem_json_is_object(dem_json_member(root, "passes")) && dem_json_is_array(dem_json_member(root, "warnings")));
    dem_json_release(root);
    dem_buffer_release(&out);
}

static void the_file_holds_the_scene_too(void **state)
{
    (void)state;
    dem_run_report r = sample();
    dem_error error;
    check_ok(dem_run_report_write(in_folder("a/b"), &r, &error), error);
    dem_buffer text = content(in_folder("a/b/run.json"));
    dem_json *root = parsed(&text);
    assert_string_equal(dem_json_string(dem_json_member(root, "schema")), "dem-run/1");
    assert_string_equal(dem_json_string(dem_json_member(root, "title")), "sand");
    assert_string_equal(dem_json_string(dem_json_member(root, "program")), "dem-clump " DEM_VERSION);
    assert_string_equal(dem_json_string(dem_json_member(dem_json_member(root, "scene"), "schema")), "dem-scene/1");
    check(number_at(root, "last_step") == 60000 && number_at(root, "steps") == 50000);
    dem_json_release(root);
    dem_buffer_release(&text);
    r.scene = "{ // no JSON\n}";  // kept all the same, and the file is JSON
    check_ok(dem_run_report_write(in_folder("a/b"), &r, &error), error);
    text = content(in_folder("a/b/run.json"));
    root = parsed(&text);
    assert_string_equal(dem_json_string(dem_json_member(root, "scene")), r.scene);
    dem_json_release(root);
    dem_buffer_release(&text);
    check(dem_run_report_write(in_folder("a/b/run.json"), &r, &error) == DEM_CANNOT_WRITE);
}

static void people_read_a_screenful(void **state)
{
    (void)state;
    dem_run_report r = sample();
    dem_buffer out = {0};
    dem_run_report_text(&out, &r);
    // 50000 steps in 4 s; 4e6 us / (50000 steps 2000 clumps); the rest of the 4 s is in no pass
    assert_string_equal(out.data,
                        "sand: 2000 clumps of 42000 spheres, 50000 steps to 0.5 s\n"
                        "  speed      12500 steps/s, 0.04 us per clump and step; 4 s with 2 threads, setup 0.25 s\n"
                        "  step       1e-05 s, the critical one is 1.25e-05 s\n"
                        "  contacts   5432 between clumps, 321 with walls, coordination 4.5\n"
                        "  overlap    0.1 % of the smaller radius, 1.25 % at most in the run\n"
                        "  memory     970 bytes per clump\n"
                        "\n"
                        "  energy                               J\n"
                        "  at the start                         7\n"
                        "  translation                      1e-05\n"
                        "  rotation                         2e-05\n"
                        "  gravity                          -0.03\n"
                        "  in the contacts                 0.0004\n"
                        "  lost to friction                 0.005\n"
                        "  lost in contact dashpots         0.006\n"
                        "  not accounted for                 0.02 % of what was turned over\n"
                        "\n"
                        "  pass                           seconds\n"
                        "  narrow                           1.500     37.5 %\n"
                        "  contacts                         2.000     50.0 %\n"
                        "  integrate                        0.250      6.3 %\n"
                        "  other                            0.250      6.3 %\n"
                        "\n"
                        "warning: overlap of 12 %; take a stiffer contact\n"
                        "warning: \"quoted\"\n");
    dem_buffer_release(&out);
}

static void an_empty_run_has_no_speed(void **state)
{
    (void)state;
    dem_run_report r = {.ended = "interrupted", .threads = 1, .critical_step = INFINITY};
    r.figures.energy.error = NAN;
    dem_buffer out = {0};
    dem_run_report_text(&out, &r);
    check(strstr(out.data, "0 clumps of 0 spheres, 0 steps to 0 s, stopped early\n") == out.data);
    check(strstr(out.data, "speed      - steps/s, - us") && strstr(out.data, "critical one is any s"));
    check(!strstr(out.data, "nan") && !strstr(out.data, "inf") && !strstr(out.data, "accounted"));
    check(strstr(out.data, "gravity") && !strstr(out.data, "friction"));
    dem_buffer_release(&out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(programs_find_every_figure),   cmocka_unit_test(what_is_not_known_is_null),
        cmocka_unit_test(the_file_holds_the_scene_too), cmocka_unit_test(people_read_a_screenful),
        cmocka_unit_test(an_empty_run_has_no_speed),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
