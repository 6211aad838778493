#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef _OPENMP
#include <omp.h>
#endif

const char *dem_version(void)
{
    return DEM_VERSION;
}

static void fill(dem_error *error, dem_status code, const char *file, long line, const char *format, va_list args)
{
    if (!error)
        return;
    error->code = code;
    error->line = line;
    snprintf(error->file, sizeof error->file, "%s", file ? file : "");
    vsnprintf(error->text, sizeof error->text, format, args);
}

dem_status dem_fail(dem_error *error, dem_status code, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fill(error, code, NULL, 0, format, args);
    va_end(args);
    return code;
}

dem_status dem_fail_at(dem_error *error, dem_status code, const char *file, long line, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fill(error, code, file, line, format, args);
    va_end(args);
    return code;
}

dem_status dem_fail_memory(dem_error *error)
{
    return dem_fail(error, DEM_NO_MEMORY, "out of memory; use a smaller input or a larger machine");
}

void dem_log(const dem_ctx *ctx, dem_log_level level, const char *format, ...)
{
    if (!ctx || !ctx->log)
        return;
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    ctx->log(ctx->user, level, ctx->subject, text);
}

bool dem_progress(const dem_ctx *ctx, const char *what, double fraction)
{
    return ctx && ctx->progress && ctx->progress(ctx->user, what, fraction);
}

int dem_threads(const dem_ctx *ctx)
{
    if (ctx && ctx->threads > 0)
        return ctx->threads;
#ifdef _OPENMP
    return omp_get_max_threads();
#else
    return 1;
#endif
}

void dem_assert_failed(const char *condition, const char *file, int line)
{
    fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, condition);
    abort();
}
