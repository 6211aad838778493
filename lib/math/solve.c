#include "math/solve.h"

#include <math.h>

static void swap_rows(double *a, double *b, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        double kept = a[k];
        a[k] = b[k];
        b[k] = kept;
    }
}

bool dem_solve(double *rows, size_t stride, size_t n, double least)
{
    for (size_t q = 0; q < n; q++) {
        size_t pivot = q;
        for (size_t i = q + 1; i < n; i++)
            if (fabs(rows[i * stride + q]) > fabs(rows[pivot * stride + q]))
                pivot = i;
        if (!(fabs(rows[pivot * stride + q]) > least))
            return false;
        swap_rows(rows + q * stride, rows + pivot * stride, n + 1);
        for (size_t i = 0; i < n; i++) {
            double factor = i == q ? 0 : rows[i * stride + q] / rows[q * stride + q];
            for (size_t k = q; k <= n && i != q; k++)
                rows[i * stride + k] -= factor * rows[q * stride + k];
        }
    }
    for (size_t q = 0; q < n; q++)
        rows[q * stride + n] /= rows[q * stride + q];
    return true;
}
