#include "check.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/json.h"
#include "base/random.h"
#include "base/units.h"

static char folder[] = "/tmp/dem-base-XXXXXX";

static char *in_folder(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    char command[300];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

// FIPS 180-2, appendix B
static void the_hash_of_abc_is_the_standards(void **state)
{
    (void)state;
    char text[65], same[65];
    dem_error error;
    dem_sha256("abc", 3, text);
    assert_string_equal(text, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    dem_sha256_pieces((dem_piece[]){{"a", 1}, {NULL, 0}, {"bc", 2}}, 3, same);
    assert_string_equal(same, text);
    check_ok(dem_file_write(in_folder("abc"), "abc", 3, &error), error);
    check_ok(dem_sha256_file(in_folder("abc"), same, &error), error);
    assert_string_equal(same, text);
}

static void a_file_comes_back_as_it_was_written(void **state)
{
    (void)state;
    dem_error error;
    dem_buffer bytes;
    check_ok(dem_file_write(in_folder("a"), "a\0b", 3, &error), error);
    check_ok(dem_file_read(in_folder("a"), &bytes, &error), error);
    check(bytes.size == 3);
    assert_memory_equal(bytes.data, "a\0b", 4);
    dem_buffer_release(&bytes);
    const dem_piece pieces[] = {{"abc", 2}, {NULL, 0}, {"xyz", 3}};
    check_ok(dem_file_write_pieces(in_folder("a"), pieces, 3, &error), error);
    check_ok(dem_file_read(in_folder("a"), &bytes, &error), error);
    assert_string_equal(bytes.data, "abxyz");
    dem_buffer_release(&bytes);
}

static void folders_are_made_with_those_they_lie_in(void **state)
{
    (void)state;
    dem_error error;
    char *path = dem_path_join(folder, "new/%d", 7), *file = dem_path_join(path, "%s", "x");
    check(path && file);
    for (int twice = 0; twice < 2; twice++)
        check_ok(dem_folder_create(path, &error), error);
    check_ok(dem_file_write(file, "x", 1, &error), error);
    check(dem_folder_create(file, &error) == DEM_CANNOT_WRITE);
    check(strstr(error.text, "is a file") && strcmp(error.file, file) == 0);
    char *below = dem_path_join(file, "below");
    check(below && dem_folder_create(below, &error) == DEM_CANNOT_WRITE);
    free(below);
    free(path);
    free(file);
}

static void a_failed_write_leaves_the_old_file_and_nothing_beside_it(void **state)
{
    (void)state;
    dem_error error;
    dem_buffer kept;
    char big[4096] = {0};
    struct rlimit old, small = {1000, 1000};
    check_ok(dem_file_write(in_folder("kept"), "old", 3, &error), error);
    check(getrlimit(RLIMIT_FSIZE, &old) == 0);
    small.rlim_max = old.rlim_max;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);  // as a full disk would
    dem_status status = dem_file_write(in_folder("kept"), big, sizeof big, &error);
    setrlimit(RLIMIT_FSIZE, &old);
    check(status == DEM_CANNOT_WRITE);
    check_ok(dem_file_read(in_folder("kept"), &kept, &error), error);
    assert_string_equal(kept.data, "old");
    dem_buffer_release(&kept);
    char command[300];
    snprintf(command, sizeof command, "ls '%s' | grep -q 'kept.'", folder);
    check(system(command) != 0);
    check(dem_file_write("/dev/full", "x", 1, &error) == DEM_CANNOT_WRITE);
    check(dem_file_write(in_folder("no/such/folder"), "x", 1, &error) == DEM_CANNOT_WRITE);
    check(strstr(error.text, "cannot write") != NULL);
    check(dem_file_write(folder, "x", 1, &error) == DEM_CANNOT_WRITE);  // a folder
}

static void what_cannot_be_read_is_named(void **state)
{
    (void)state;
    dem_error error;
    dem_buffer bytes;
    check(dem_file_read(in_folder("missing"), &bytes, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "no such file") != NULL);
    check(dem_file_read(folder, &bytes, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "directory") != NULL);
    check_ok(dem_file_write(in_folder("empty"), "", 0, &error), error);
    check(dem_file_read(in_folder("empty"), &bytes, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "empty") != NULL);
    check(symlink("nowhere", in_folder("link")) == 0);
    check(dem_file_read(in_folder("link"), &bytes, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "link") != NULL);
}

static void quantities_with_units_become_si(void **state)
{
    (void)state;
    dem_error error;
    double value;
    check_ok(dem_quantity("2 mm", DEM_DIMENSION_LENGTH, &value, &error), error);
    check_close(value, 2e-3, 1e-15);
    check_ok(dem_quantity("2.65g/cm3", DEM_DIMENSION_DENSITY, &value, &error), error);
    check_close(value, 2650, 1e-15);
    check_ok(dem_quantity("1e-3", DEM_DIMENSION_LENGTH, &value, &error), error);
    check_near(value, 1e-3, 0);
    check(dem_quantity("2 kg/m3", DEM_DIMENSION_LENGTH, &value, &error) == DEM_USAGE);
    check(strstr(error.text, "mm") != NULL);
    check(dem_quantity("nan", DEM_DIMENSION_LENGTH, &value, &error) == DEM_USAGE);
    check(dem_quantity("", DEM_DIMENSION_LENGTH, &value, &error) == DEM_USAGE);
}

static void json_is_read_back_as_it_was_written(void **state)
{
    (void)state;
    dem_buffer out = {0};
    dem_json_writer w = dem_json_begin(&out);
    double third = 1.0 / 3, got;
    int64_t whole;
    bool flag;
    dem_error error;
    dem_json *root;
    dem_json_open_object(&w, NULL);
    dem_json_put_number(&w, "third", third);
    dem_json_put_number(&w, "missing", NAN);
    dem_json_put_whole(&w, "whole", -42);
    dem_json_put_bool(&w, "flag", true);
    dem_json_put_string(&w, "text", "tab\t \"quoted\" ü");
    dem_json_put_string(&w, "bytes", "no utf-8: \xff");
    dem_json_open_array(&w, "rows", true);
    for (int i = 0; i < 3; i++)
        dem_json_put_numbers(&w, NULL, (double[]){i, third}, 2);
    dem_json_close(&w, ']');
    dem_json_open_object(&w, "inner");
    dem_json_put_raw(&w, "raw", "[1, 2]");
    dem_json_close(&w, '}');
    dem_json_close(&w, '}');
    check_ok(dem_json_parse(out.data, out.size, "x.json", &root, &error), error);
    check(dem_json_number(dem_json_member(root, "third"), &got));
    check_near(got, third, 0);
    check(!dem_json_number(dem_json_member(root, "missing"), &got));
    check(dem_json_whole(dem_json_member(root, "whole"), &whole) && whole == -42);
    check(dem_json_bool(dem_json_member(root, "flag"), &flag) && flag);
    assert_string_equal(dem_json_string(dem_json_member(root, "text")), "tab\t \"quoted\" ü");
    assert_string_equal(dem_json_string(dem_json_member(root, "bytes")), "no utf-8: ?");
    const dem_json *rows = dem_json_member(root, "rows");
    check(dem_json_length(rows) == 3);
    check(dem_json_number(dem_json_item(dem_json_item(rows, 2), 0), &got) && got == 2);
    check(dem_json_length(dem_json_member(dem_json_member(root, "inner"), "raw")) == 2);
    dem_json_release(root);
    dem_buffer_release(&out);
}

static void json_errors_name_the_line(void **state)
{
    (void)state;
    dem_error error;
    dem_json *root;
    const char *text = "{\n\"a\": 1,\n\"b\" 2\n}";
    check(dem_json_parse(text, strlen(text), "x.json", &root, &error) == DEM_BAD_INPUT);
    check(error.line == 3);
    assert_string_equal(error.file, "x.json");
    check(dem_json_parse("", 0, "x.json", &root, &error) == DEM_BAD_INPUT);
}

static void random_streams_are_uniform_and_differ(void **state)
{
    (void)state;
    enum { COUNT = 100000 };
    dem_random a = random_stream(1, 0), b = random_stream(1, 1), c = random_stream(2, 0);
    double mean = 0, correlation = 0, normal2 = 0;
    int same = 0;
    for (int i = 0; i < COUNT; i++) {
        double x = random_uniform(&a), y = random_uniform(&b);
        check(x >= 0 && x < 1);
        mean += x / COUNT;
        correlation += (x - 0.5) * (y - 0.5) / COUNT;
        same += x == y || x == random_uniform(&c);
        double g = random_normal(&b);
        normal2 += g * g / COUNT;
    }
    check_near(mean, 0.5, 5 * 0.2887 / sqrt(COUNT));          // five standard errors
    check_near(correlation, 0, 5.0 / 12 / sqrt(COUNT));
    check_near(normal2, 1, 5 * sqrt(2.0 / COUNT));
    check(same == 0);
    for (int i = 0; i < 1000; i++)
        check(random_below(&a, 7) < 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hash_of_abc_is_the_standards),
        cmocka_unit_test(a_file_comes_back_as_it_was_written),
        cmocka_unit_test(folders_are_made_with_those_they_lie_in),
        cmocka_unit_test(a_failed_write_leaves_the_old_file_and_nothing_beside_it),
        cmocka_unit_test(what_cannot_be_read_is_named),
        cmocka_unit_test(quantities_with_units_become_si),
        cmocka_unit_test(json_is_read_back_as_it_was_written),
        cmocka_unit_test(json_errors_name_the_line),
        cmocka_unit_test(random_streams_are_uniform_and_differ),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
