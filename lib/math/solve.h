/// Small dense systems of linear equations.
#ifndef DEM_MATH_SOLVE_H
#define DEM_MATH_SOLVE_H

#include <stdbool.h>
#include <stddef.h>

/// Solves n equations by elimination with row pivots. Row i stands at rows + i stride: n coefficients, then the right
/// side, which becomes the solution; the coefficients are lost. False: there is a pivot of at most `least`.
bool dem_solve(double *rows, size_t stride, size_t n, double least);

#endif
