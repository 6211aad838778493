/// Compensated sums (Neumaier 1974): the rounding error does not grow with the number of terms.
#ifndef DEM_MATH_SUM_H
#define DEM_MATH_SUM_H

#include <math.h>

typedef struct dem_sum {
    double total, lost;
} dem_sum;

static inline void sum_add(dem_sum *s, double x)
{
    double t = s->total + x;
    s->lost += fabs(s->total) >= fabs(x) ? (s->total - t) + x : (x - t) + s->total;
    s->total = t;
}
static inline double sum_value(dem_sum s)
{
    return s.total + s.lost;
}

#endif
