/// Status, errors, context and the plain values every other header builds on.
///
/// SI units everywhere; a number whose unit is not SI says so in its name. [-] marks a pure number.
#ifndef DEM_BASE_H
#define DEM_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define DEM_API __attribute__((visibility("default")))
#define DEM_PRINTF(format_at, first_at) __attribute__((format(printf, format_at, first_at)))
#else
#define DEM_API
#define DEM_PRINTF(format_at, first_at)
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define DEM_VERSION "0.1.0"

/// What a call came to; the values up to 130 are the exit status of the tools.
typedef enum dem_status {
    DEM_OK = 0,
    DEM_FAILED = 1,         ///< the computation itself failed
    DEM_USAGE = 2,          ///< a parameter outside its range
    DEM_BAD_INPUT = 3,      ///< a file that cannot be used
    DEM_CANNOT_WRITE = 4,   ///< an output that could not be written
    DEM_INTERRUPTED = 130,  ///< the progress callback asked to stop
    DEM_NO_MEMORY = 131,
    DEM_UNAVAILABLE = 132,  ///< built without the library this needs
} dem_status;

/// Why a call failed. `text` says what is wrong and what to do; `file` and `line` where, if anywhere.
typedef struct dem_error {
    dem_status code;
    long line;        ///< 1-based line of `file`; 0: none
    char file[512];   ///< empty: none
    char text[1024];
} dem_error;

typedef enum dem_log_level { DEM_LOG_WARNING, DEM_LOG_INFO, DEM_LOG_DEBUG } dem_log_level;

/// How the library talks to its caller. Zero-initialised (or NULL) means: silent, all cores.
typedef struct dem_ctx {
    /// Receives one line without its newline. `subject` is the file or grain it is about, or NULL.
    void (*log)(void *user, dem_log_level level, const char *subject, const char *text);
    /// Called from time to time by long work, from the calling thread; fraction in 0..1. True: stop.
    bool (*progress)(void *user, const char *what, double fraction);
    void *user;
    const char *subject;  ///< handed to `log`
    int threads;          ///< 0: as many as there are cores
} dem_ctx;

typedef struct dem_vec3 {
    double x, y, z;
} dem_vec3;

/// Unit quaternion, scalar first; maps body vectors to space: v_space = R(q) v_body.
typedef struct dem_quat {
    double w, x, y, z;
} dem_quat;

/// Symmetric 3x3 tensor.
typedef struct dem_sym3 {
    double xx, yy, zz, xy, xz, yz;
} dem_sym3;

/// One sphere of a clump.
typedef struct dem_ball {
    dem_vec3 centre;  ///< [m]
    double radius;    ///< [m]
} dem_ball;

/// Moments of a solid's volume about the origin of its frame, at unit density.
typedef struct dem_moments {
    double volume;    ///< [m^3]
    dem_vec3 first;   ///< int x dV [m^4]
    dem_sym3 second;  ///< int x x^T dV [m^5]
} dem_moments;

/// Mass properties of a solid at unit density.
typedef struct dem_solid {
    double volume;       ///< [m^3]
    double area;         ///< [m^2]
    dem_vec3 centre;     ///< [m]
    dem_sym3 inertia;    ///< about the centre, axes of the input frame [m^5]
    double principal[3]; ///< ascending [m^5]
    dem_quat axes;       ///< principal frame -> input frame, right-handed
} dem_solid;

DEM_API const char *dem_version(void);

/// A structure of these headers as the library was compiled with it, or one field of it: for bindings of other
/// languages, which cannot read the headers.
typedef struct dem_abi_row {
    const char *type;   ///< "dem_mesh"
    const char *field;  ///< "vertices"; "": the whole structure
    const char *kind;   ///< bool, i32, u32, i64, u64, f64, char, pointer or a structure; as many as fit in `size`
    size_t offset;      ///< in the structure [B]
    size_t size;        ///< [B]
} dem_abi_row;
/// All rows, a structure behind those it holds.
DEM_API const dem_abi_row *dem_abi(size_t *count);

#ifdef __cplusplus
}
#endif
#endif
