/// What cmocka lacks: relative tolerances, vectors, and files for tests.
#ifndef DEM_TESTS_CHECK_H
#define DEM_TESTS_CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "dem/dem.h"

static inline void check_near_(double got, double want, double tolerance, const char *what, const char *file, int line)
{
    if (!(fabs(got - want) <= tolerance)) {
        print_error("%s = %.17g, want %.17g within %g\n", what, got, want, tolerance);
        _fail(file, line);
    }
}
/// |got - want| <= tolerance
#define check_near(got, want, tolerance) check_near_((got), (want), (tolerance), #got, __FILE__, __LINE__)
/// |got - want| <= tolerance |want|
#define check_close(got, want, tolerance) \
    check_near_((got), (want), (tolerance)*fabs((double)(want)), #got, __FILE__, __LINE__)

static inline void check_vec_(dem_vec3 got, dem_vec3 want, double tolerance, const char *what, const char *file,
                              int line)
{
    double d = fmax(fabs(got.x - want.x), fmax(fabs(got.y - want.y), fabs(got.z - want.z)));
    if (!(d <= tolerance)) {
        print_error("%s = (%.17g, %.17g, %.17g), want (%.17g, %.17g, %.17g) within %g\n", what, got.x, got.y, got.z,
                    want.x, want.y, want.z, tolerance);
        _fail(file, line);
    }
}
#define check_vec(got, want, tolerance) check_vec_((got), (want), (tolerance), #got, __FILE__, __LINE__)

static inline void check_true_(int condition, const char *what, const char *file, int line)
{
    if (!condition) {
        print_error("not so: %s\n", what);
        _fail(file, line);
    }
}
#define check(condition) check_true_((condition) != 0, #condition, __FILE__, __LINE__)

/// The call succeeds; otherwise its error is shown.
#define check_ok(call, error)                                                   \
    do {                                                                        \
        if ((call) != DEM_OK) {                                                 \
            print_error("%s:%ld: %s\n", (error).file, (error).line, (error).text); \
            _fail(__FILE__, __LINE__);                                          \
        }                                                                       \
    } while (0)

/// Whether the build is slow, so that long tests are to be shortened.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SLOW_BUILD 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SLOW_BUILD 1
#endif
#endif
#ifndef SLOW_BUILD
#define SLOW_BUILD 0
#endif

/// Path of a file among the real grains that may lie beside the project; the test is skipped where they do not.
#define check_shared(path)                          \
    do {                                            \
        FILE *shared_ = fopen((path), "rb");        \
        if (!shared_)                               \
            skip();                                 \
        fclose(shared_);                            \
    } while (0)
#define SHARED_DATA(name) DEM_SOURCE_DIR "/../shared/refdata/" name
#define SHARED_MESH(name) DEM_SOURCE_DIR "/../shared/meshes/" name

#endif
