#include "study/statistics.h"

#include <math.h>

double dem_student(size_t freedom)
{
    static const double table[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                   2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086};
    size_t known = sizeof table / sizeof *table;
    // beyond the table by the first terms of its series
    return freedom <= known ? table[freedom - 1] : 1.96 + 2.37 / (double)freedom + 2.8 / pow((double)freedom, 2);
}

dem_mean dem_mean_of(const double *values, size_t count)
{
    dem_mean m = {.mean = NAN, .deviation = NAN, .error = NAN};
    double sum = 0, squares = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i])) {
            sum += values[i];
            m.count++;
        }
    if (m.count == 0)
        return m;
    m.mean = sum / (double)m.count;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i]))
            squares += pow(values[i] - m.mean, 2);
    if (m.count > 1) {
        m.deviation = sqrt(squares / (double)(m.count - 1));
        m.error = dem_student(m.count - 1) * m.deviation / sqrt((double)m.count);
    }
    return m;
}
