/// Raising and passing on errors, assertions, talking to the caller.
#ifndef DEM_BASE_STATUS_H
#define DEM_BASE_STATUS_H

#include "dem/base.h"

/// Fills `error` (may be NULL) without a place and returns `code`.
dem_status dem_fail(dem_error *error, dem_status code, const char *format, ...) DEM_PRINTF(3, 4);

/// The same with a file (may be NULL) and a line (0: none).
dem_status dem_fail_at(dem_error *error, dem_status code, const char *file, long line, const char *format, ...)
    DEM_PRINTF(5, 6);

dem_status dem_fail_memory(dem_error *error);

/// Passes a failure on from a function that holds nothing to release.
#define DEM_TRY(call)                            \
    do {                                         \
        dem_status dem_try_status_ = (call);     \
        if (dem_try_status_ != DEM_OK)           \
            return dem_try_status_;              \
    } while (0)

void dem_log(const dem_ctx *ctx, dem_log_level level, const char *format, ...) DEM_PRINTF(3, 4);

/// True: the caller wants to stop. `fraction` in 0..1.
bool dem_progress(const dem_ctx *ctx, const char *what, double fraction);

/// Threads to use, at least 1.
int dem_threads(const dem_ctx *ctx);

/// Our own mistakes; on unless NDEBUG.
#ifdef NDEBUG
#define DEM_ASSERT(condition) ((void)sizeof(condition))
#else
#define DEM_ASSERT(condition) ((condition) ? (void)0 : dem_assert_failed(#condition, __FILE__, __LINE__))
#endif
_Noreturn void dem_assert_failed(const char *condition, const char *file, int line);

#endif
