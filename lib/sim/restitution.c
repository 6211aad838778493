// With zeta = sin(f) the oscillator started at d = 0 first has no force at the phase pi - 2 f, and its speed there is
// exactly exp(-zeta t): e = exp(-tan(f) (pi - 2 f)). With a = pi/2 - f this is ln(1/e) = 2 zeta a / sin(a),
// cos(a) = zeta, which goes on through zeta = 1 with hyperbolic functions.
#include "sim/restitution.h"

#include <math.h>
#include <stdbool.h>

#include "math/vec.h"

double dem_damping_ratio(double restitution)
{
    if (restitution <= 0)
        return 1;
    double l = -log(restitution);
    return l / hypot(DEM_PI, l);
}

double dem_restitution(double damping_ratio)
{
    if (damping_ratio >= 1)
        return 0;
    return exp(-DEM_PI * damping_ratio / sqrt((1 - damping_ratio) * (1 + damping_ratio)));
}

// ln(1/e) with the tail cut, and its derivative: increasing, concave
static double loss(double zeta, double *slope)
{
    // 1 - zeta is exact near 1, so the ratio a / sin(a) is good to the last digits there too
    bool over = zeta > 1;
    double s = over ? sqrt(zeta - 1) * sqrt(zeta + 1) : sqrt((1 - zeta) * (1 + zeta));
    double ratio = s == 0 ? 1 : over ? asinh(s) / s : atan2(s, zeta) / s;
    double value = 2 * zeta * ratio;
    // d ratio / d zeta; the difference loses its digits near 1, where the limit is as good
    double bend = s < 1e-4 ? -1.0 / 3 : (over ? 1 - zeta * ratio : zeta * ratio - 1) / s / s;
    *slope = 2 * (ratio + zeta * bend);
    return value;
}

double dem_restitution_cut(double damping_ratio)
{
    double slope;
    return exp(-loss(damping_ratio, &slope));
}

double dem_damping_ratio_cut(double restitution)
{
    if (restitution <= 0)
        return INFINITY;
    double want = -log(restitution);
    // both starts lie below the root (x coth(x) <= 1 + x), from where Newton's steps rise to it
    double zeta = want > 2 ? cosh(want / 2 - 1) : dem_damping_ratio(restitution);
    for (int i = 0; i < 100; i++) {
        double slope, value = loss(zeta, &slope), next = zeta + (want - value) / slope;
        if (!(next > zeta))
            break;
        zeta = next;
    }
    return zeta;
}
