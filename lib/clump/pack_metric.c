#include "clump/pack_metric.h"

#include "base/status.h"

static const double own_damping = 0.05;     // of a block's mean eigenvalue

static double trace(const double equation[DEM_EQUATION])
{
    return equation[0] + equation[4] + equation[7] + equation[9];
}

static void set_factor(const double equation[DEM_EQUATION], double least, double a[4][4])
{
    double damping = fmax(own_damping * trace(equation) / 4, least);
    for (int i = 0, q = 0; i < 4; i++)
        for (int j = i; j < 4; j++, q++)
            a[j][i] = equation[q] + (i == j ? damping : 0);
    for (int j = 0; j < 4; j++) {
        for (int k = 0; k < j; k++)
            a[j][j] -= a[j][k] * a[j][k];
        a[j][j] = sqrt(fmax(a[j][j], damping / 4));
        for (int i = j + 1; i < 4; i++) {
            for (int k = 0; k < j; k++)
                a[i][j] -= a[i][k] * a[j][k];
            a[i][j] /= a[j][j];
        }
    }
}

void dem_pack_metric_set(dem_packing *p, size_t count, double evenness)
{
    double mean = 0;
    for (size_t i = 0; i < count; i++)
        mean += trace(p->equations[i]) / (4 * (double)count);
    for (size_t i = 0; i < count; i++)
        set_factor(p->equations[i], evenness * mean, p->factor[i]);
}

dem_status dem_pack_metric(dem_packing *p, dem_pack_state *state, dem_error *error)
{
    DEM_TRY(dem_pack_equations(p, state, error));
    dem_pack_metric_set(p, state->count, dem_metric_evenness);
    return DEM_OK;
}
