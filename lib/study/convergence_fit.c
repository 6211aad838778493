// The figures of a convergence study: orders, confidence, the cheapest way.
#include <math.h>
#include <stdio.h>

#include "sim/schemes.h"
#include "study/convergence.h"
#include "study/statistics.h"

// log2 of the error: 12 % off the line
static const double OFF_LINE = 0.17;
static const double DOUBTFUL = 4;
static const double CHEAPER = 0.9;  // what less is saved is noise of the clock

typedef struct line {
    double slope, off;
} line;

static line fit(const double *x, const double *y, size_t count)
{
    double mx = 0, my = 0, xx = 0, xy = 0;
    for (size_t i = 0; i < count; i++) {
        mx += x[i] / (double)count;
        my += y[i] / (double)count;
    }
    for (size_t i = 0; i < count; i++) {
        xx += (x[i] - mx) * (x[i] - mx);
        xy += (x[i] - mx) * (y[i] - my);
    }
    line l = {xy / xx, 0};
    for (size_t i = 0; i < count; i++)
        l.off = fmax(l.off, fabs(y[i] - my - l.slope * (x[i] - mx)));
    return l;
}

dem_order dem_order_fit(const double *steps, const dem_error_found *errors, size_t count)
{
    double x[DEM_CONVERGENCE_LEVELS], y[DEM_CONVERGENCE_LEVELS];
    size_t good = 0;
    for (size_t i = 0; i < count; i++) {
        const dem_error_found *e = &errors[i];
        if (!(e->error > 0 && isfinite(e->error)) || !(e->error > DOUBTFUL * e->doubt))
            continue;
        x[good] = log2(steps[i]);
        y[good++] = log2(e->error);
    }
    // the longest one, of these the finest; two points are always on a line
    for (size_t length = good; length >= 2; length--)
        for (size_t from = good - length + 1; from-- > 0;) {
            line l = fit(x + from, y + from, length);
            if (l.slope > 0 && (l.off <= OFF_LINE || length == 2))
                return (dem_order){l.slope, exp2(x[from]), exp2(x[from + length - 1]), length};
        }
    return (dem_order){.order = NAN, .coarse = NAN, .fine = NAN};
}

double dem_confidence(double a, double b, size_t count)
{
    return count > 1 ? dem_student(2 * (count - 1)) * sqrt((a * a + b * b) / (double)count) : INFINITY;
}

// of one method: the coarsest step that is good enough; one that is good by chance is not
static size_t coarsest_good(const dem_convergence *c, size_t method, size_t quantity, double asked)
{
    size_t best = SIZE_MAX;
    for (size_t l = c->levels; l-- > 0;) {
        size_t at = method * c->levels + l;
        const dem_error_found *e = &c->points[at].errors[quantity];
        if (*c->points[at].failed || !(e->error + e->doubt <= asked))
            break;
        best = at;
    }
    return best;
}

size_t dem_convergence_cheapest(const dem_convergence *c, size_t quantity, double asked)
{
    size_t best = SIZE_MAX;
    for (size_t m = 0; m < c->method_count; m++) {
        size_t at = coarsest_good(c, m, quantity, asked);
        if (at != SIZE_MAX && (best == SIZE_MAX || c->points[at].seconds < CHEAPER * c->points[best].seconds))
            best = at;
    }
    return best;
}

void dem_method_name(dem_integrator_def method, char *name, size_t size)
{
    snprintf(name, size, "%s+%s", dem_translations[method.translation].name, dem_rotations[method.rotation].name);
}

void dem_convergence_override(const dem_convergence *c, size_t point, dem_buffer *out)
{
    dem_integrator_def m = c->methods[point / c->levels], own = c->methods[0];
    dem_buffer_text(out, "-D time.step=");
    dem_buffer_shortest(out, c->points[point].step);
    if (m.translation != own.translation)
        dem_buffer_print(out, " -D integrator.translation=%s", dem_translations[m.translation].name);
    if (m.rotation != own.rotation)
        dem_buffer_print(out, " -D integrator.rotation=%s", dem_rotations[m.rotation].name);
}
