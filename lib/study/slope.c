#include "study/slope.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "math/vec.h"

typedef struct grid {
    size_t columns, rows;
    double width, depth;
    dem_vec3 *tops;  // of each cell; z -INFINITY: none
} grid;

static void gather(const dem_slope_def *def, const dem_vec3 *tops, size_t count, grid *g)
{
    for (size_t i = 0; i < g->columns * g->rows; i++)
        g->tops[i] = v3(0, 0, -INFINITY);
    for (size_t i = 0; i < count; i++) {
        double x = (tops[i].x - def->from) / g->width, y = (tops[i].y - def->low) / g->depth;
        if (!(x >= 0 && x < (double)g->columns))
            continue;
        y = smaller(larger(y, 0), (double)g->rows - 1);
        dem_vec3 *top = &g->tops[(size_t)x * g->rows + (size_t)y];
        if (tops[i].z > top->z)
            *top = tops[i];
    }
}

static dem_slope fit(const grid *g)
{
    dem_slope s = {.angle = NAN, .error = NAN, .height = NAN};
    double n = 0, sx = 0, sz = 0, xx = 0, xz = 0, zz = 0;
    for (size_t i = 0; i < g->columns * g->rows; i++)
        if (isfinite(g->tops[i].z)) {
            n++;
            sx += g->tops[i].x;
            sz += g->tops[i].z;
        }
    s.cells = (size_t)n;
    if (n < 3)
        return s;
    double mx = sx / n, mz = sz / n;
    for (size_t i = 0; i < g->columns * g->rows; i++)
        if (isfinite(g->tops[i].z)) {
            double x = g->tops[i].x - mx, z = g->tops[i].z - mz;
            xx += x * x;
            xz += x * z;
            zz += z * z;
        }
    if (!(xx > 0))
        return s;
    double slope = xz / xx, left = larger(zz - slope * xz, 0);
    s.angle = -atan(slope);
    s.error = sqrt(left / (n - 2) / xx) / (1 + slope * slope);
    s.height = mz - slope * mx;
    return s;
}

dem_status dem_slope_fit(const dem_slope_def *def, const dem_vec3 *tops, size_t count, dem_slope *slope,
                         dem_error *error)
{
    double columns = larger(round((def->to - def->from) / def->cell), 1);
    double rows = larger(round((def->high - def->low) / def->cell), 1);
    grid g = {(size_t)columns, (size_t)rows, (def->to - def->from) / columns, (def->high - def->low) / rows, NULL};
    g.tops = dem_alloc(g.columns * g.rows, sizeof *g.tops);
    if (!g.tops)
        return dem_fail_memory(error);
    gather(def, tops, count, &g);
    *slope = fit(&g);
    free(g.tops);
    return DEM_OK;
}

// With h(x) = mean + slope (length / 2 - x) and a filling f: mass M = f mean length, D = sum m (length / 2 - x) =
// f slope length^3 / 12, Z = sum m z = f / 2 (mean^2 length + slope^2 length^3 / 12); f goes out of these.
double dem_slope_of_heap(const dem_vec3 *places, const double *masses, size_t count, double length)
{
    double mass = 0, along = 0, high = 0;
    for (size_t i = 0; i < count; i++) {
        mass += masses[i];
        along += masses[i] * (length / 2 - places[i].x);
        high += masses[i] * places[i].z;
    }
    double scale = mass * mass * length * length + 12 * along * along;
    return scale > 0 ? atan(24 * along * high / scale) : NAN;
}
