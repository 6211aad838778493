#include "folder.h"

#include <fcntl.h>
#include <sys/stat.h>

#include "base/file_queue.h"

static dem_buffer text_of(const char *text)
{
    dem_buffer b = {0};
    dem_buffer_text(&b, text);
    return b;
}

static void put(dem_file_queue *queue, const char *name, const char *text)
{
    dem_error error;
    dem_buffer b = text_of(text);
    check_ok(dem_file_queue_put(queue, in_folder(name), &b, &error), error);
    check(b.data == NULL);
}

static void check_content(const char *name, const char *text)
{
    dem_buffer b = content(in_folder(name));
    assert_string_equal(b.data, text);
    dem_buffer_release(&b);
}

static void later_files_of_one_name_replace_earlier_ones(void **state)
{
    (void)state;
    dem_file_queue *queue;
    dem_error error;
    check_ok(dem_file_queue_create(&queue, &error), error);
    put(queue, "a", "first");
    put(queue, "b", "other");
    for (int i = 0; i < 100; i++)
        put(queue, "a", i < 99 ? "again" : "last");
    check_ok(dem_file_queue_wait(queue, &error), error);
    check_content("a", "last");
    check_content("b", "other");
    put(queue, "c", "while it is destroyed");
    dem_file_queue_destroy(queue);
    check_content("c", "while it is destroyed");
}

// nobody reads the pipe until the caller has gone on
static void a_file_that_blocks_does_not_hold_up_the_caller(void **state)
{
    (void)state;
    dem_file_queue *queue;
    dem_error error;
    char seen[16] = "";
    check(mkfifo(in_folder("pipe"), 0600) == 0);
    check_ok(dem_file_queue_create(&queue, &error), error);
    put(queue, "pipe", "through");
    put(queue, "behind", "done");
    check(!exists(in_folder("behind")));
    int reader = open(in_folder("pipe"), O_RDONLY);
    check(reader >= 0);
    check(read(reader, seen, sizeof seen - 1) == 7);
    close(reader);
    check_ok(dem_file_queue_wait(queue, &error), error);
    assert_string_equal(seen, "through");
    check_content("behind", "done");
    dem_file_queue_destroy(queue);
}

static void the_first_failure_is_told_and_nothing_is_written_behind_it(void **state)
{
    (void)state;
    dem_file_queue *queue;
    dem_error error;
    check_ok(dem_file_queue_create(&queue, &error), error);
    put(queue, "no such folder/x", "lost");
    check(dem_file_queue_wait(queue, &error) == DEM_CANNOT_WRITE);
    check(strstr(error.file, "no such folder/x") != NULL);
    dem_buffer b = text_of("too late");
    check(dem_file_queue_put(queue, in_folder("late"), &b, &error) == DEM_CANNOT_WRITE);
    check(dem_file_queue_wait(queue, &error) == DEM_CANNOT_WRITE);
    check(!exists(in_folder("late")));
    dem_file_queue_destroy(queue);
}

static void without_a_queue_files_are_written_at_once(void **state)
{
    (void)state;
    dem_error error;
    put(NULL, "now", "here");
    check_content("now", "here");
    dem_buffer failed = {.failed = true};
    check(dem_file_queue_put(NULL, in_folder("never"), &failed, &error) == DEM_NO_MEMORY);
    check_ok(dem_file_queue_wait(NULL, &error), error);
    dem_file_queue_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(later_files_of_one_name_replace_earlier_ones),
        cmocka_unit_test(a_file_that_blocks_does_not_hold_up_the_caller),
        cmocka_unit_test(the_first_failure_is_told_and_nothing_is_written_behind_it),
        cmocka_unit_test(without_a_queue_files_are_written_at_once),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
