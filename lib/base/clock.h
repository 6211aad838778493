/// The clock on the wall, for telling how long things take.
#ifndef DEM_BASE_CLOCK_H
#define DEM_BASE_CLOCK_H

#include "base/status.h"

/// Seconds since some moment; never goes back.
double dem_clock(void);
/// Seconds the processor has spent on this thread.
double dem_clock_thread(void);

enum { DEM_LAPS = 12 };

/// The stages of a piece of work, each with its seconds. Zero-initialise, or begin with `dem_laps_begin`.
typedef struct dem_laps {
    const char *names[DEM_LAPS];
    double seconds[DEM_LAPS];
    int count;
    double last;
} dem_laps;

void dem_laps_begin(dem_laps *laps);
/// What was done since the last call was `name`; the same name again adds to it. Names are not copied.
void dem_laps_end(dem_laps *laps, const char *name);
/// One line for those who want to know: "packing: places 0.12 s, polish 0.05 s".
void dem_laps_log(const dem_laps *laps, const dem_ctx *ctx, const char *work);

#endif
