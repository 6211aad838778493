#include "check.h"

#include "out/names.h"

static void names_become_safe_for_files(void **state)
{
    (void)state;
    static const char *const cases[][2] = {{"grain42", "grain42"},
                                           {"a/b\\c", "a_b_c"},
                                           {"../up", "_._up"},
                                           {"-rf", "_rf"},
                                           {"", "shape"},
                                           {NULL, "shape"},
                                           {"two words", "two_words"},
                                           {"\xc2\xb5m", "__m"},
                                           {"x,y\"\n", "x_y__"},
                                           {"Grain_1.5-b", "Grain_1.5-b"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_string_equal(dem_name_plain(cases[i][0], "shape", NULL, 0).text, cases[i][1]);
}

static void names_that_look_the_same_are_numbered(void **state)
{
    (void)state;
    static const char *const given[] = {"a b", "a/b", "A_b", "a_b-2", "a.b"},
                             *want[] = {"a_b", "a_b-2", "A_b-3", "a_b-2-2", "a.b"};
    dem_plain_name names[5];
    for (size_t i = 0; i < 5; i++) {
        names[i] = dem_name_plain(given[i], "x", names, i);
        assert_string_equal(names[i].text, want[i]);
    }
}

static void long_names_are_cut_and_stay_different(void **state)
{
    (void)state;
    char name[300];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = 0;
    dem_plain_name names[2];
    names[0] = dem_name_plain(name, "x", NULL, 0);
    names[1] = dem_name_plain(name, "x", names, 1);
    check(strlen(names[0].text) == 48 && strncmp(names[0].text, name, 48) == 0);
    check(strcmp(names[1].text + 48, "-2") == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_become_safe_for_files),
        cmocka_unit_test(names_that_look_the_same_are_numbered),
        cmocka_unit_test(long_names_are_cut_and_stay_different),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
