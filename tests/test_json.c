#include "check.h"

#include "base/json.h"
#include "base/json_text.h"

static dem_json *lenient(const char *text)
{
    dem_json *root;
    dem_error error;
    check_ok(dem_json_parse_lenient(text, strlen(text), "x.json", &root, &error), error);
    return root;
}

static void comments_and_trailing_commas_are_passed_over(void **state)
{
    (void)state;
    dem_json *root = lenient("\xef\xbb\xbf// first\n"
                             "/* a \"comment\" { */ { \"a\": [1, 2, /* , */ ], // ]\n"
                             "\"b//c\": \"/* kept */ // kept, ]\", \"d\\\"//\": {\"e\": 1 , }, /**/ } // last");
    check(dem_json_length(dem_json_member(root, "a")) == 2);
    assert_string_equal(dem_json_string(dem_json_member(root, "b//c")), "/* kept */ // kept, ]");
    check(dem_json_member(dem_json_member(root, "d\"//"), "e") != NULL);
    dem_json_release(root);
}

static void what_is_not_json_stays_an_error(void **state)
{
    (void)state;
    static const char *const cases[] = {"[,]",
                                        "{,}",
                                        "[1,,]",
                                        "[1,,2]",
                                        "{\"a\":,}",
                                        "[1 /* never closed",
                                        "/",
                                        "[1 / 2]",
                                        "'a'",
                                        "{a: 1}",
                                        "{\"a\": 1, \"a\": 2}",
                                        "[1] 2",
                                        "",
                                        "// only",
                                        "[1",
                                        "\"open",
                                        "[NaN]",
                                        ","};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_json *root;
        dem_error error;
        dem_status status = dem_json_parse_lenient(cases[i], strlen(cases[i]), "x.json", &root, &error);
        if (status != DEM_BAD_INPUT)
            print_error("%s\n", cases[i]);
        check(status == DEM_BAD_INPUT && !root);
    }
    dem_json *root;
    dem_error error;
    const char *text = "{ // one\n/* two\nthree */ \"a\" 1}";
    check(dem_json_parse_lenient(text, strlen(text), "x.json", &root, &error) == DEM_BAD_INPUT);
    check(error.line == 3);
}

static void blanking_keeps_length_and_lines(void **state)
{
    (void)state;
    const char before[] = "{ // ü, \n \"a\": 1, /* x,\ny */ }\n// \"";
    char after[sizeof before];
    memcpy(after, before, sizeof before);
    dem_json_blank(after, strlen(after));
    check(strlen(after) == strlen(before));
    for (size_t i = 0; before[i]; i++) {
        check((after[i] == '\n') == (before[i] == '\n'));
        check(after[i] == before[i] || after[i] == ' ');
    }
    check(strspn(after + 1, " \n") == strcspn(after, "\"") - 1);
    check(!strchr(after, ',') && strstr(after, "\n \"a\": 1 ") && strchr(after, '}'));
}

typedef struct spot {
    const char *path;  // keys and items, each ended by '.'
    dem_json_part part;
    long line, column;
} spot;

static bool located(const char *text, char *path, const dem_json_place *in, dem_json_part part, long *line,
                    long *column)
{
    if (!*path)
        return dem_json_locate(text, strlen(text), in, part, line, column);
    char *dot = strchr(path, '.');
    *dot = 0;
    bool item = *path >= '0' && *path <= '9';
    dem_json_place place = {in, item ? NULL : path, item ? (size_t)atoi(path) : 0};
    return located(text, dot + 1, &place, part, line, column);
}

static void values_and_keys_are_found_by_their_way(void **state)
{
    (void)state;
    static const char text[] = "// \"b\": 5\n"
                               "{ \"a\": [10, /* 11, */ 20, [ ], {\"x\": \"]\"},\n"
                               "        30],\n"
                               "  \"b\": {\"\\u0063\": true, \"ü\": /* here: */ -1.5e3, \"\": null,},\n"
                               "\t\"a b\": {\"a\": {}} }";
    static const spot spots[] = {
        {"", DEM_JSON_VALUE, 2, 1},        {"a.", DEM_JSON_KEY, 2, 3},      {"a.", DEM_JSON_VALUE, 2, 8},
        {"a.0.", DEM_JSON_VALUE, 2, 9},    {"a.0.", DEM_JSON_KEY, 2, 9},    {"a.1.", DEM_JSON_VALUE, 2, 23},
        {"a.2.", DEM_JSON_VALUE, 2, 27},   {"a.3.x.", DEM_JSON_KEY, 2, 33}, {"a.3.x.", DEM_JSON_VALUE, 2, 38},
        {"a.4.", DEM_JSON_VALUE, 3, 9},    {"b.c.", DEM_JSON_KEY, 4, 9},    {"b.c.", DEM_JSON_VALUE, 4, 19},
        {"b.ü.", DEM_JSON_KEY, 4, 25},     {"b.ü.", DEM_JSON_VALUE, 4, 42}, {"b..", DEM_JSON_VALUE, 4, 54},
        {"a b.a.", DEM_JSON_VALUE, 5, 15},
    };
    static const char *const missing[] = {"c.", "a.5.", "a.2.0.", "a.x.", "b.0.", "b.c.d.", "a.0.0."};
    const dem_json_place root = {NULL, NULL, 0};
    long line = 0, column = 0;
    char path[32];
    dem_json_release(lenient(text));
    for (size_t i = 0; i < sizeof spots / sizeof *spots; i++) {
        bool found = located(text, strcpy(path, spots[i].path), &root, spots[i].part, &line, &column);
        if (!found || line != spots[i].line || column != spots[i].column)
            print_error("%s: %d %ld:%ld\n", spots[i].path, found, line, column);
        check(found && line == spots[i].line && column == spots[i].column);
    }
    for (size_t i = 0; i < sizeof missing / sizeof *missing; i++)
        check(!located(text, strcpy(path, missing[i]), &root, DEM_JSON_VALUE, &line, &column));
}

static void keys_come_in_the_order_of_the_file(void **state)
{
    (void)state;
    dem_json *root = lenient("{\"z\": 1, \"a\": 2, \"m\": 3}");
    const char *key = NULL, *want[] = {"z", "a", "m"};
    for (int i = 0; i < 3; i++) {
        key = dem_json_next(root, key);
        assert_string_equal(key, want[i]);
    }
    check(!dem_json_next(root, key) && !dem_json_next(NULL, NULL));
    check(dem_json_set_member(root, "a", dem_json_new_string("new")));
    assert_string_equal(dem_json_string(dem_json_member(root, "a")), "new");
    dem_json_release(root);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(comments_and_trailing_commas_are_passed_over),
        cmocka_unit_test(what_is_not_json_stays_an_error),
        cmocka_unit_test(blanking_keeps_length_and_lines),
        cmocka_unit_test(values_and_keys_are_found_by_their_way),
        cmocka_unit_test(keys_come_in_the_order_of_the_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
