/// Means of what was found several times, and how well they are known.
#ifndef DEM_STUDY_STATISTICS_H
#define DEM_STUDY_STATISTICS_H

#include <stddef.h>

/// How many standard errors to either side of a mean hold it with 95 %, by degrees of freedom, one or more (Student
/// 1908).
double dem_student(size_t freedom);

typedef struct dem_mean {
    size_t count;
    double mean;
    double deviation;  ///< standard, of one value; NAN with fewer than two
    double error;      ///< half of the interval that holds the mean with 95 %; NAN with fewer than two
} dem_mean;
/// Of the values that are finite.
dem_mean dem_mean_of(const double *values, size_t count);

#endif
