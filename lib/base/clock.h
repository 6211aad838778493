/// The clock on the wall, for telling how long things take.
#ifndef DEM_BASE_CLOCK_H
#define DEM_BASE_CLOCK_H

/// Seconds since some moment; never goes back.
double dem_clock(void);

#endif
