/// What a move of a ball costs, to second order: the blocks that scale the variables of polishing and projecting.
#ifndef DEM_CLUMP_PACK_METRIC_H
#define DEM_CLUMP_PACK_METRIC_H

#include "clump/packing.h"

/// p->factor: lower Cholesky factor L of each ball's Gauss-Newton matrix, damped so that no direction is free; the state is
/// assigned. Scaled variables are y = L^T (x, y, z, r). The matrix has weights 1/|f| (p->charge must be linear): the
/// second derivative of the symmetric difference comes from the curves where the two surfaces cross, there f = 0.
dem_status dem_pack_metric(dem_packing *p, dem_pack_state *state, dem_error *error);
/// The same from p->equations as they are. `evenness` (the default is dem_metric_evenness) is what share of the mean
/// eigenvalue every direction has at least: the larger, the more evenly a move is spread over the balls.
void dem_pack_metric_set(dem_packing *p, size_t count, double evenness);

static const double dem_metric_evenness = 0.01;

/// y = L^-1 v: gradients into the scaled variables.
static inline void metric_gradient(double (*l)[4], const double v[4], double y[4])
{
    for (int i = 0; i < 4; i++) {
        y[i] = v[i];
        for (int k = 0; k < i; k++)
            y[i] -= l[i][k] * y[k];
        y[i] /= l[i][i];
    }
}

/// v = L^-T y: scaled variables into coordinates.
static inline void metric_leave(double (*l)[4], const double y[4], double v[4])
{
    for (int i = 3; i >= 0; i--) {
        v[i] = y[i];
        for (int k = i + 1; k < 4; k++)
            v[i] -= l[k][i] * v[k];
        v[i] /= l[i][i];
    }
}

/// y = L^T v: coordinates into scaled variables.
static inline void metric_enter(double (*l)[4], const double v[4], double y[4])
{
    for (int i = 0; i < 4; i++) {
        y[i] = 0;
        for (int k = i; k < 4; k++)
            y[i] += l[k][i] * v[k];
    }
}

#endif
