#define _GNU_SOURCE  // MAP_ANONYMOUS
#include "check.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "mesh/guard.h"

static const dem_guard_limits plenty = {.memory = 1e9, .cpu = 10, .wall = 20};

static void put(int out, const void *bytes, size_t size)
{
    while (size) {
        ssize_t done = write(out, bytes, size);
        if (done <= 0)
            return;
        bytes = (const char *)bytes + done;
        size -= (size_t)done;
    }
}

static void say_hello(void *user, int out)
{
    (void)user;
    put(out, "hello", 5);
}
static void write_megabytes(void *user, int out)
{
    (void)user;
    static char block[1 << 20];
    for (int i = 0; i < 20; i++) {
        memset(block, i, sizeof block);
        put(out, block, sizeof block);
    }
}
static void give_up(void *user, int out)
{
    (void)user, (void)out;
    abort();
}
static void crash(void *user, int out)
{
    (void)user, (void)out;
    raise(SIGSEGV);
}
static void end_silently(void *user, int out)
{
    (void)user, (void)out;
}
static void spin(void *user, int out)
{
    (void)user, (void)out;
    for (volatile unsigned i = 0;; i++)
        ;
}
static void sleep_long(void *user, int out)
{
    (void)user, (void)out;
    for (;;)
        pause();
}
static void sleep_with_closed_pipe(void *user, int out)
{
    close(out);
    sleep_long(user, out);
}
static void take_memory(void *user, int out)
{
    (void)user;
    for (char *more; (more = malloc(1 << 20));)
        memset(more, 1, 1 << 20);
    put(out, "none left", 9);
}
static void look_at_terminal(void *user, int out)
{
    (void)user;
    struct stat nothing, standard;
    bool same = stat("/dev/null", &nothing) == 0;
    for (int i = STDIN_FILENO; i <= STDERR_FILENO; i++)
        same = same && fstat(i, &standard) == 0 && standard.st_rdev == nothing.st_rdev;
    put(out, same ? "quiet" : "noise", 5);
}
static void write_a_file(void *user, int out)
{
    FILE *file = fopen(user, "wb");
    if (file) {
        signal(SIGXFSZ, SIG_IGN);
        fputs("left behind", file);
        put(out, fflush(file) == 0 ? "file!" : "empty", 5);
    }
}
static void count_files(void *user, int out)
{
    (void)user;
    int open_files = 0;
    for (int i = 0; i < 1024; i++)
        open_files += fcntl(i, F_GETFD) != -1;
    put(out, &open_files, sizeof open_files);
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int open_files(void)
{
    int count = 0;
    for (int i = 0; i < 1024; i++)
        count += fcntl(i, F_GETFD) != -1;
    return count;
}

// runs `work` and reads `size` bytes of it: all there or not, what was said of the end, nothing left of it
static bool run(void (*work)(void *, int), void *user, dem_guard_limits limits, void *bytes, size_t size, char *end)
{
    int files = open_files();
    dem_guard guard;
    dem_error error;
    check_ok(dem_guard_start(&guard, NULL, limits, work, user, &error), error);
    bool all = dem_guard_read(&guard, bytes, size);
    strcpy(end, dem_guard_end(&guard));
    check(waitpid(-1, NULL, WNOHANG) == -1 && errno == ECHILD);
    check(open_files() == files);
    return all;
}

static void what_the_child_writes_is_read(void **state)
{
    (void)state;
    char hello[6] = {0}, end[80];
    check(run(say_hello, NULL, plenty, hello, 5, end));
    assert_string_equal(hello, "hello");
    check(!run(say_hello, NULL, plenty, hello, 6, end));
    assert_string_equal(end, "ended without a result");
    char *much = malloc(20 << 20);
    assert_non_null(much);
    check(run(write_megabytes, NULL, plenty, much, 20 << 20, end));
    for (size_t i = 0; i < 20 << 20; i++)
        if (much[i] != (char)(i >> 20))
            fail_msg("byte %zu is %d", i, much[i]);
    check(run(write_megabytes, NULL, plenty, much, 100, end));  // it is not waited for
    free(much);
}

// writes a file longer than its limit, or a short one
static void write_file(void *user, int out)
{
    const size_t *size = user;
    FILE *file = tmpfile();
    for (size_t i = 0; file && i < *size; i++)
        fputc('x', file);
    if (file && fflush(file) == 0)
        (void)!write(out, "written", 7);
}

// becomes another program
static void become_echo(void *user, int out)
{
    (void)user;
    dup2(out, STDOUT_FILENO);
    execl("/bin/sh", "sh", "-c", "echo said; exit 7", (char *)NULL);
}

static void a_child_writes_only_files_it_may(void **state)
{
    (void)state;
    char text[8] = {0}, end[80];
    size_t little = 1000, much = 5000;
    dem_guard_limits limits = plenty;
    check(!run(write_file, &little, limits, text, 7, end));
    limits.file = 2000;
    check(run(write_file, &little, limits, text, 7, end));
    check(!run(write_file, &much, limits, text, 7, end));
}

static void a_child_can_become_a_program_and_its_status_is_known(void **state)
{
    (void)state;
    dem_guard guard;
    dem_error error;
    char text[64];
    size_t size = 0, got;
    check_ok(dem_guard_start(&guard, NULL, plenty, become_echo, NULL, &error), error);
    while (size < sizeof text && (got = dem_guard_read_some(&guard, text + size, sizeof text - size)) > 0)
        size += got;
    check(size == 5 && memcmp(text, "said\n", 5) == 0);
    dem_guard_end(&guard);
    check(guard.status == 7);
    check_ok(dem_guard_start(&guard, NULL, plenty, crash, NULL, &error), error);
    dem_guard_end(&guard);
    check(guard.status == -1);
}

static void a_child_that_dies_is_named_by_how(void **state)
{
    (void)state;
    char byte, end[80];
    check(!run(give_up, NULL, plenty, &byte, 1, end));
    assert_non_null(strstr(end, "gave up"));
    check(!run(crash, NULL, plenty, &byte, 1, end));
    assert_string_equal(end, "crashed (signal 11)");
    check(!run(end_silently, NULL, plenty, &byte, 1, end));
    assert_string_equal(end, "ended without a result");
}

static void a_child_that_hangs_is_stopped(void **state)
{
    (void)state;
    char byte, end[80];
    double begin = seconds();
    check(!run(spin, NULL, (dem_guard_limits){.memory = 1e9, .cpu = 1, .wall = 20}, &byte, 1, end));
    assert_string_equal(end, "took more than 1 s");
    dem_guard_limits brief = {.memory = 1e9, .cpu = 10, .wall = 0.2};
    check(!run(sleep_long, NULL, brief, &byte, 1, end));
    assert_string_equal(end, "took more than 0 s");
    check(!run(sleep_with_closed_pipe, NULL, brief, &byte, 1, end));
    check(seconds() - begin < 15);
}

static void a_child_that_wants_all_memory_gets_its_share(void **state)
{
    (void)state;
    if (!DEM_GUARD_MEMORY)
        skip();
    char text[9], end[80];
    check(run(take_memory, NULL, (dem_guard_limits){.memory = 1e8, .cpu = 10, .wall = 20}, text, 9, end));
    assert_memory_equal(text, "none left", 9);
}

static void a_child_sees_no_terminal_and_no_files(void **state)
{
    (void)state;
    char text[5], end[80], path[] = "/tmp/test_guard.XXXXXX";
    check(run(look_at_terminal, NULL, plenty, text, 5, end));
    assert_memory_equal(text, "quiet", 5);
    int beside = open("/dev/null", O_RDONLY), files = 0;
    check(run(count_files, NULL, plenty, &files, sizeof files, end));
    close(beside);
    check(files == 4);  // the three standard ones and the pipe
    close(mkstemp(path));
    check(run(write_a_file, path, plenty, text, 5, end));
    unlink(path);
    assert_memory_equal(text, "empty", 5);
}

static bool stop(void *user, const char *what, double fraction)
{
    (void)what, (void)fraction;
    return ++*(int *)user > 2;
}

static void the_caller_can_interrupt_a_child(void **state)
{
    (void)state;
    int calls = 0;
    dem_ctx ctx = {.progress = stop, .user = &calls};
    dem_guard guard;
    dem_error error;
    char byte;
    check_ok(dem_guard_start(&guard, &ctx, plenty, sleep_long, NULL, &error), error);
    check(!dem_guard_read(&guard, &byte, 1));
    assert_string_equal(dem_guard_end(&guard), "was interrupted");
    check(guard.interrupted);
    check(waitpid(-1, NULL, WNOHANG) == -1 && errno == ECHILD);
}

static struct {
    pid_t test;
    int *elsewhere;  // shared with the children
} handler;

static void note_exit(void)
{
    *handler.elsewhere |= getpid() != handler.test;
}

static void no_exit_handler_runs_in_the_child(void **state)
{
    (void)state;
    handler.test = getpid();
    handler.elsewhere = mmap(NULL, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    check(handler.elsewhere != MAP_FAILED);
    atexit(note_exit);
    char hello[6], end[80];
    check(!run(say_hello, NULL, plenty, hello, 6, end));  // one byte more than it writes: its end is waited for
    check(*handler.elsewhere == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_the_child_writes_is_read),
        cmocka_unit_test(a_child_writes_only_files_it_may),
        cmocka_unit_test(a_child_can_become_a_program_and_its_status_is_known),
        cmocka_unit_test(a_child_that_dies_is_named_by_how),
        cmocka_unit_test(a_child_that_hangs_is_stopped),
        cmocka_unit_test(a_child_that_wants_all_memory_gets_its_share),
        cmocka_unit_test(a_child_sees_no_terminal_and_no_files),
        cmocka_unit_test(the_caller_can_interrupt_a_child),
        cmocka_unit_test(no_exit_handler_runs_in_the_child),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
