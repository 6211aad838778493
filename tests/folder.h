/// A folder of its own for a test program: give make_folder and remove_folder to cmocka_run_group_tests.
#ifndef DEM_TESTS_FOLDER_H
#define DEM_TESTS_FOLDER_H

#include "check.h"

#include <stdlib.h>
#include <unistd.h>

#include "base/file.h"

static char folder[] = "/tmp/dem-test-XXXXXX";

static inline int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state)
{
    (void)state;
    char command[64];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

/// One of four texts that are used in turn.
static inline char *in_folder(const char *name)
{
    static char paths[4][256];
    static int turn;
    turn = (turn + 1) % 4;
    snprintf(paths[turn], sizeof paths[turn], "%s/%s", folder, name);
    return paths[turn];
}

static inline bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

/// A whole file; release it.
static inline dem_buffer content(const char *path)
{
    dem_buffer bytes;
    dem_error error;
    check_ok(dem_file_read(path, &bytes, &error), error);
    return bytes;
}

/// Both files hold the same bytes.
static inline void check_same_file(const char *a, const char *b)
{
    dem_buffer x = content(a), y = content(b);
    check(x.size == y.size);
    assert_memory_equal(x.data, y.data, x.size);
    dem_buffer_release(&x);
    dem_buffer_release(&y);
}

#endif
