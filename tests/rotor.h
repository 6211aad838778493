/// A free body by Runge and Kutta's fourth order: Euler's equations and the turning of the body.
#ifndef DEM_TESTS_ROTOR_H
#define DEM_TESTS_ROTOR_H

#include "worlds.h"

typedef struct rotor_state {
    double y[7];  // q, spin in the body
} rotor_state;

static inline rotor_state rotor_rate(const double i[3], const rotor_state *s)
{
    const double *y = s->y;
    dem_quat q = {y[0], y[1], y[2], y[3]}, d = quat_multiply(q, (dem_quat){0, y[4], y[5], y[6]});
    return (rotor_state){{d.w / 2, d.x / 2, d.y / 2, d.z / 2, (i[1] - i[2]) * y[5] * y[6] / i[0],
                          (i[2] - i[0]) * y[6] * y[4] / i[1], (i[0] - i[1]) * y[4] * y[5] / i[2]}};
}
static inline rotor_state rotor_add(rotor_state a, double h, rotor_state b)
{
    for (int k = 0; k < 7; k++)
        a.y[k] += h * b.y[k];
    return a;
}
static inline rotor_state rotor_step(const double i[3], rotor_state s, double h)
{
    rotor_state a = rotor_rate(i, &s), t = rotor_add(s, h / 2, a), b = rotor_rate(i, &t);
    t = rotor_add(s, h / 2, b);
    rotor_state c = rotor_rate(i, &t);
    t = rotor_add(s, h, c);
    rotor_state d = rotor_rate(i, &t);
    return rotor_add(rotor_add(rotor_add(rotor_add(s, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
}

/// The largest angle between the first body of a world, which was not turned at the start, and that solution in `steps`
/// of `h` [rad].
static inline double rotor_error(dem_world *w, const double inertia[3], dem_vec3 spin, double h, uint64_t steps)
{
    enum { PARTS = 20 };  // of a step
    rotor_state s = {{1, 0, 0, 0, spin.x, spin.y, spin.z}};
    double most = 0;
    for (uint64_t k = 0; k < steps; k++) {
        run_steps(w, 1);
        for (int i = 0; i < PARTS; i++)
            s = rotor_step(inertia, s, h / PARTS);
        dem_quat exact = quat_unit((dem_quat){s.y[0], s.y[1], s.y[2], s.y[3]});
        most = largest(most, angle_between(orientation_now(w, 0), exact));
    }
    return most;
}

#endif
