/// Work done in a child process, which may crash, hang or take all memory without harm to the caller.
#ifndef DEM_MESH_GUARD_H
#define DEM_MESH_GUARD_H

#include <sys/types.h>

#include "base/status.h"

/// 0 where the memory limit cannot be set: the shadow memory of a sanitizer takes terabytes of addresses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DEM_GUARD_MEMORY 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DEM_GUARD_MEMORY 0
#endif
#endif
#ifndef DEM_GUARD_MEMORY
#define DEM_GUARD_MEMORY 1
#endif

typedef struct dem_guard_limits {
    double memory;  ///< beyond what the caller has at the start [byte]
    double cpu;     ///< [s]
    double wall;    ///< [s]
    double file;    ///< largest file it may write [byte]; 0: it writes none (what goes to `out` is not counted)
} dem_guard_limits;

typedef struct dem_guard {
    const dem_ctx *ctx;
    dem_guard_limits limits;
    pid_t child;
    int pipe;
    double begin;  ///< on the monotonic clock [s]
    const char *doing;  ///< what the progress callback is told ["importing"]
    bool late, interrupted;
    int status;  ///< with which it left, set by dem_guard_end; -1: it did not leave by itself
    char why[80];
} dem_guard;

/// Starts `work` in a child process of its own: what it writes to `out` is read with dem_guard_read. It sees no
/// terminal, dies with the caller, and ends by _exit when `work` returns (which may also become another program by
/// execv). DEM_FAILED where the system gives no process or pipe.
dem_status dem_guard_start(dem_guard *guard, const dem_ctx *ctx, dem_guard_limits limits,
                           void (*work)(void *user, int out), void *user, dem_error *error);

/// The next `size` bytes the child writes. False where they do not come: it ended, took too long, or the caller's
/// progress callback asked to stop.
bool dem_guard_read(dem_guard *guard, void *bytes, size_t size);

/// At least one and at most `size` bytes, as soon as there are some; 0 where dem_guard_read would be false.
size_t dem_guard_read_some(dem_guard *guard, void *bytes, size_t size);

/// Ends the child whatever it does and leaves nothing of it. Returns how it ended, for a message ("crashed
/// (signal 11)"); valid as long as `guard`.
const char *dem_guard_end(dem_guard *guard);

#endif
