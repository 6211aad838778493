#include "folder.h"

#include "base/hash.h"
#include "base/random.h"
#include "out/checkpoint.h"

static const char SCENE[] = "00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff";
static const char OTHER[] = "00112233445566778899aabbccddeeff00112233445566778899aabbccddeef0";
static const char STATE[] = "a state\0with a 0, \xff and a\nline";

static dem_checkpoint sample(uint64_t step, const char *scene)
{
    dem_checkpoint c = {.title = "sand \"7\"",
                        .time = 0.1 + 0.2,
                        .step = step,
                        .frames = 12,
                        .rows = 1234567890123,
                        .state = STATE,
                        .state_size = sizeof STATE};
    memcpy(c.scene, scene, sizeof c.scene);
    return c;
}

static char *path_of(const char *directory, uint64_t step)
{
    char name[64];
    snprintf(name, sizeof name, "%s/checkpoint-%llu.dem", directory, (unsigned long long)step);
    return in_folder(name);
}

static void write_at(const char *directory, uint64_t step, const char *scene)
{
    dem_error error;
    dem_checkpoint c = sample(step, scene);
    check_ok(dem_checkpoint_write(in_folder(directory), &c, &error), error);
}

static void everything_comes_back(void **state)
{
    (void)state;
    dem_error error;
    dem_checkpoint c;
    write_at("deep/run", 5000, SCENE);
    char *path = dem_checkpoint_path(in_folder("deep/run"), 5000);
    assert_string_equal(path, path_of("deep/run", 5000));
    check_ok(dem_checkpoint_read(path, SCENE, &c, &error), error);
    assert_string_equal(c.title, "sand \"7\"");
    assert_string_equal(c.scene, SCENE);
    check(c.time == 0.1 + 0.2 && c.step == 5000 && c.frames == 12 && c.rows == 1234567890123);
    check(c.state_size == sizeof STATE);
    assert_memory_equal(c.state, STATE, sizeof STATE);
    dem_checkpoint_release(&c);
    check_ok(dem_checkpoint_read(path, NULL, &c, &error), error);
    dem_checkpoint_release(&c);
    dem_checkpoint_release(&c);  // twice is once
    free(path);
    // nothing in it, and no title
    c = (dem_checkpoint){.step = 1};
    memcpy(c.scene, SCENE, sizeof c.scene);
    check_ok(dem_checkpoint_write(folder, &c, &error), error);
    check_ok(dem_checkpoint_read(in_folder("checkpoint-1.dem"), SCENE, &c, &error), error);
    check(c.state_size == 0 && c.title[0] == 0);
    dem_checkpoint_release(&c);
}

static void a_large_state_is_the_same_bit_for_bit(void **state)
{
    (void)state;
    size_t size = (1 << 22) + 3;
    unsigned char *block = malloc(size);
    check(block != NULL);
    dem_random r = random_stream(1, 1);
    for (size_t i = 0; i < size; i++)
        block[i] = (unsigned char)random_bits(&r);
    dem_checkpoint c = sample(3, SCENE), back;
    c.state = block;
    c.state_size = size;
    dem_error error;
    check_ok(dem_checkpoint_write(in_folder("large"), &c, &error), error);
    check_ok(dem_checkpoint_read(path_of("large", 3), SCENE, &back, &error), error);
    check(back.state_size == size && memcmp(back.state, block, size) == 0);
    dem_checkpoint_release(&back);
    free(block);
}

// decodes a copy of some bytes; true: accepted
static bool accepted(const char *bytes, size_t size, const char *scene, dem_error *error)
{
    dem_buffer file = {0};
    dem_checkpoint c;
    *error = (dem_error){0};
    dem_buffer_bytes(&file, bytes, size);
    dem_status status = dem_checkpoint_decode(&file, "file", scene, &c, error);
    dem_buffer_release(&file);
    dem_checkpoint_release(&c);
    if (status != DEM_OK)
        check(status == DEM_BAD_INPUT && error->code == status && strcmp(error->file, "file") == 0 &&
              strchr(error->text, ';') && !c.state && !c.title);
    return status == DEM_OK;
}

static dem_buffer sample_file(void)
{
    write_at("sample", 7, SCENE);
    return content(path_of("sample", 7));
}

static void cut_short_anywhere_it_is_refused(void **state)
{
    (void)state;
    dem_buffer file = sample_file();
    dem_error error;
    check(accepted(file.data, file.size, SCENE, &error));
    for (size_t size = 0; size < file.size; size++) {
        check(!accepted(file.data, size, SCENE, &error));
        check(strstr(error.text, "cut short") != NULL);
    }
    dem_buffer_text(&file, "x");
    check(!accepted(file.data, file.size, SCENE, &error));
    check(strstr(error.text, "altered") != NULL);
    dem_buffer_release(&file);
}

static void altered_anywhere_it_is_refused(void **state)
{
    (void)state;
    dem_buffer file = sample_file();
    dem_error error;
    for (size_t i = 0; i < file.size; i++)
        for (int bit = 0; bit < 8; bit++) {
            file.data[i] = (char)(file.data[i] ^ (1 << bit));
            check(!accepted(file.data, file.size, SCENE, &error));
            // in the first two lines it may look like something else
            check(strstr(error.text, i < 15            ? "is no checkpoint"
                                     : i < 17          ? "version"
                                     : i < 17 + 2 * 21 ? ";"
                                                       : "altered"));
            file.data[i] = (char)(file.data[i] ^ (1 << bit));
        }
    check(accepted(file.data, file.size, SCENE, &error));
    dem_buffer_release(&file);
}

static void other_scenes_and_versions_are_told_apart(void **state)
{
    (void)state;
    dem_buffer file = sample_file();
    dem_error error;
    check(!accepted(file.data, file.size, OTHER, &error));
    check(strstr(error.text, "another scene (sand \"7\")") != NULL);
    file.data[15] = '2';
    check(!accepted(file.data, file.size, SCENE, &error));
    check(strstr(error.text, "of version 2, only 1") != NULL);
    check(!accepted("{\"schema\": 1}", 13, SCENE, &error));
    check(strstr(error.text, "is no checkpoint") != NULL);
    dem_buffer_release(&file);
}

// a file whose lengths and sum are right, whatever its header says
static bool header_accepted(const char *header, dem_error *error)
{
    dem_buffer file = {0};
    char sum[65];
    dem_buffer_print(&file, "dem-checkpoint/1\n%020zu %020d\n%sstate", strlen(header), 5, header);
    dem_sha256(file.data, file.size, sum);
    dem_buffer_print(&file, "%s\n", sum);
    bool ok = accepted(file.data, file.size, NULL, error);
    dem_buffer_release(&file);
    return ok;
}

static void headers_that_lack_something_are_refused(void **state)
{
    (void)state;
    dem_error error;
    const uint16_t probe = 1;
    const char *order = *(const char *)&probe ? "little" : "big", *wrong = *order == 'l' ? "big" : "little";
    const struct {
        const char *title, *scene, *time, *step, *frames, *order, *text;
    } cases[] = {
        {"\"t\"", SCENE, "1", "2", "3", order, NULL},     {"7", SCENE, "1", "2", "3", order, "lacks"},
        {"\"t\"", "00", "1", "2", "3", order, "lacks"},   {"\"t\"", SCENE, "null", "2", "3", order, "lacks"},
        {"\"t\"", SCENE, "1", "-2", "3", order, "lacks"}, {"\"t\"", SCENE, "1", "2.5", "3", order, "lacks"},
        {"\"t\"", SCENE, "1", "2", "[]", order, "lacks"}, {"\"t\"", SCENE, "1", "2", "3", wrong, "byte order"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char header[500];
        snprintf(header, sizeof header,
                 "{\"title\": %s, \"scene\": \"%s\", \"time\": %s, \"step\": %s, \"frames\": %s, \"rows\": 0, "
                 "\"byte_order\": \"%s\"}",
                 cases[i].title, cases[i].scene, cases[i].time, cases[i].step, cases[i].frames, cases[i].order);
        check(header_accepted(header, &error) == !cases[i].text);
        check(!cases[i].text || strstr(error.text, cases[i].text));
    }
    check(!header_accepted("[]", &error));
}

static void the_newest_two_stay(void **state)
{
    (void)state;
    dem_error error;
    write_at("keep", 3, OTHER);                                                           // another run's
    check_ok(dem_file_write(in_folder("keep/checkpoint-4.dem"), "x", 1, &error), error);  // somebody's
    dem_buffer copy = sample_file();
    check_ok(dem_file_write_buffer(in_folder("keep/checkpoint-0115.dem"), &copy, &error), error);  // not so named by us
    for (uint64_t step = 90; step <= 120; step += 10)  // 90 sorts behind 100 as text
        write_at("keep", step, SCENE);
    check(!exists(path_of("keep", 90)) && !exists(path_of("keep", 100)));
    check(exists(path_of("keep", 110)) && exists(path_of("keep", 120)));
    check(exists(path_of("keep", 3)) && exists(path_of("keep", 4)) && exists(in_folder("keep/checkpoint-0115.dem")));
    // a run that went back to step 50 leaves what is ahead of it
    write_at("keep", 50, SCENE);
    write_at("keep", 60, SCENE);
    write_at("keep", 70, SCENE);
    check(!exists(path_of("keep", 50)) && exists(path_of("keep", 60)) && exists(path_of("keep", 70)));
    check(exists(path_of("keep", 110)) && exists(path_of("keep", 120)));
}

static void what_cannot_be_written_leaves_the_older_ones(void **state)
{
    (void)state;
    dem_error error;
    dem_checkpoint c = sample(30, SCENE);
    write_at("fails", 10, SCENE);
    write_at("fails", 20, SCENE);
    char name[300];
    snprintf(name, sizeof name, "%s/x", path_of("fails", 30));
    check_ok(dem_folder_create(name, &error), error);  // a folder where the file should be
    check(dem_checkpoint_write(in_folder("fails"), &c, &error) == DEM_CANNOT_WRITE);
    check(exists(path_of("fails", 10)) && exists(path_of("fails", 20)));
    check(dem_checkpoint_read(in_folder("fails/none.dem"), SCENE, &c, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "no such file") != NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_comes_back),
        cmocka_unit_test(a_large_state_is_the_same_bit_for_bit),
        cmocka_unit_test(cut_short_anywhere_it_is_refused),
        cmocka_unit_test(altered_anywhere_it_is_refused),
        cmocka_unit_test(other_scenes_and_versions_are_told_apart),
        cmocka_unit_test(headers_that_lack_something_are_refused),
        cmocka_unit_test(the_newest_two_stay),
        cmocka_unit_test(what_cannot_be_written_leaves_the_older_ones),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
