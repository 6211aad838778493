#include "base/clock.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

double dem_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double dem_clock_thread(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void dem_laps_begin(dem_laps *laps)
{
    *laps = (dem_laps){.last = dem_clock()};
}

void dem_laps_end(dem_laps *laps, const char *name)
{
    double now = dem_clock(), seconds = now - laps->last;
    int at = 0;
    while (at < laps->count && strcmp(laps->names[at], name) != 0)
        at++;
    laps->last = now;
    if (at == DEM_LAPS)
        return;
    laps->count += at == laps->count;
    laps->names[at] = name;
    laps->seconds[at] += seconds;
}

void dem_laps_log(const dem_laps *laps, const dem_ctx *ctx, const char *work)
{
    char text[400] = "";
    size_t length = 0;
    if (!ctx || !ctx->log)
        return;
    for (int k = 0; k < laps->count && length < sizeof text; k++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%s%s %.3f s", k ? ", " : "", laps->names[k],
                                   laps->seconds[k]);
    dem_log(ctx, DEM_LOG_DEBUG, "%s: %s", work, text);
}
