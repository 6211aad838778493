/// Schemes of rotation for comparison with the default, one body at a time, for motion.c (PHYSICS 2.2 and 2.3).
///
/// All go by the axes of the run frame. A body comes with the orientation of now, its angular momentum in space before
/// the moments of now, and their impulse; it leaves with the next orientation and the angular momentum that belongs to
/// it. Schemes that carry the angular velocity in the body find it as I^-1 R^T L, to the last bits.
#ifndef DEM_SIM_ROTATE_H
#define DEM_SIM_ROTATE_H

#include "math/quat.h"

typedef struct rotor_body {
    dem_quat q;
    dem_vec3 momentum, impulse;  // in space: before, and of the moments [N m s]
    double inverse[3];           // 1/I [1/(kg m^2)]
    double step, kick, last;     // to come; of the impulse; gone by [s]
    double *turning;             // [3] rate of the spin a step before [rad/s^2] (walton-braun)
} rotor_body;

static inline dem_vec3 by_axes(dem_vec3 v, const double s[3])
{
    return v3(v.x * s[0], v.y * s[1], v.z * s[2]);
}
static inline dem_vec3 over_axes(dem_vec3 v, const double s[3])
{
    return v3(v.x / s[0], v.y / s[1], v.z / s[2]);
}

/// Euler's equations in the body: I^-1 (M - w x I w).
static inline dem_vec3 euler_rate(const double inverse[3], dem_vec3 moment, dem_vec3 spin)
{
    return by_axes(v3_sub(moment, v3_cross(spin, over_axes(spin, inverse))), inverse);
}

/// The turn by the vector.
static inline dem_quat turn_by(dem_vec3 angle)
{
    double a = v3_norm(angle), s = a > 1e-4 ? sin(a / 2) / a : 0.5 - a * a / 48;
    return (dem_quat){cos(a / 2), s * angle.x, s * angle.y, s * angle.z};
}

/// q + h q' with q' = 1/2 q (0, w)
static inline dem_quat quat_moved(dem_quat q, dem_vec3 spin, double h, dem_quat at)
{
    dem_quat d = quat_multiply(at, (dem_quat){0, spin.x, spin.y, spin.z});
    return (dem_quat){q.w + h / 2 * d.w, q.x + h / 2 * d.x, q.y + h / 2 * d.y, q.z + h / 2 * d.z};
}

/// Cayley's turn by spin h in the body: as the exponential to the second order, and of norm 1.
static inline dem_quat turned_cayley(dem_quat q, dem_vec3 spin, double h)
{
    double u = h * h * v3_norm2(spin) / 16, s = 1 / (1 + u), w = (1 - u) * s;
    dem_quat d = quat_multiply(q, (dem_quat){0, spin.x, spin.y, spin.z});
    double k = h / 2 * s;
    return (dem_quat){w * q.w + k * d.w, w * q.x + k * d.x, w * q.y + k * d.y, w * q.z + k * d.z};
}

/// The spin in the body behind the kick, by Runge and Kutta's third order that keeps bounds (SSPRK3).
static inline dem_vec3 spiral_spin(const double inverse[3], dem_vec3 spin, dem_vec3 moment, double h)
{
    dem_vec3 k1 = v3_scale(euler_rate(inverse, moment, spin), h);
    dem_vec3 k2 = v3_scale(euler_rate(inverse, moment, v3_add(spin, k1)), h);
    dem_vec3 k3 = v3_scale(euler_rate(inverse, moment, v3_along(spin, 0.25, v3_add(k1, k2))), h);
    return v3_along(spin, 1.0 / 6, v3_add(v3_add(k1, k2), v3_scale(k3, 4)));
}

/// ... by the mean of the products before and behind, found in four rounds.
static inline dem_vec3 omelyan_spin(const double inverse[3], dem_vec3 spin, dem_vec3 moment, double h)
{
    dem_vec3 rate = by_axes(moment, inverse), old = v3_sub(euler_rate(inverse, moment, spin), rate), next = spin;
    for (int i = 0; i < 4; i++) {
        dem_vec3 now = v3_sub(euler_rate(inverse, moment, next), rate);
        next = v3_along(v3_along(spin, h, rate), h / 2, v3_add(old, now));
    }
    return next;
}

/// ... with the gyroscopic term at the middle, where the rate of the last step leads.
static inline dem_vec3 walton_braun_spin(const double inverse[3], dem_vec3 spin, dem_vec3 moment, double h, double last,
                                         double turning[3])
{
    dem_vec3 before = v3(turning[0], turning[1], turning[2]);
    dem_vec3 rate = euler_rate(inverse, moment, v3_along(spin, last / 2, before));
    turning[0] = rate.x;
    turning[1] = rate.y;
    turning[2] = rate.z;
    return v3_along(spin, h, rate);
}

static inline dem_vec3 spin_in_body(const rotor_body *b, dem_quat q, dem_vec3 momentum)
{
    return by_axes(quat_unrotate(q, momentum), b->inverse);
}

/// Fincham's leapfrog: L is kept, the orientation takes a half step for the spin of the middle.
static inline void rotate_fincham(rotor_body *b)
{
    dem_vec3 now = v3_along(b->momentum, b->kick > 0 ? b->last / 2 / b->kick : 0, b->impulse);
    dem_vec3 next = v3_add(b->momentum, b->impulse);
    dem_quat middle = quat_unit(quat_moved(b->q, spin_in_body(b, b->q, now), b->step / 2, b->q));
    b->q = quat_unit(quat_moved(b->q, spin_in_body(b, middle, next), b->step, middle));
    b->momentum = next;
}

/// The body as a turn about one of its axes for a time h: a part of no-squish.
static inline void turn_axis(rotor_body *b, dem_vec3 *own, int axis, double h)
{
    dem_vec3 angle = v3(0, 0, 0);
    v3_set(&angle, axis, h * v3_get(*own, axis) * b->inverse[axis]);
    dem_quat turn = turn_by(angle);
    b->q = quat_multiply(b->q, turn);
    *own = quat_unrotate(turn, *own);
}

/// Miller's splitting, which in whole numbers keeps L: axes of ascending moments in the order 3, 2, 1, 2, 3. The run
/// frame may have renamed them in a circle.
static inline void rotate_no_squish(rotor_body *b)
{
    b->momentum = v3_add(b->momentum, b->impulse);
    dem_vec3 own = quat_unrotate(b->q, b->momentum);
    int first = b->inverse[2] > b->inverse[0] ? 2 : 0;
    for (int i = 0; i < 5; i++) {
        static const int order[5] = {2, 1, 0, 1, 2};
        turn_axis(b, &own, (first + order[i]) % 3, i == 2 ? b->step : b->step / 2);
    }
}

/// Predicts the orientation and the spin of the middle, and goes on from the start by what holds there.
static inline void rotate_pcdm(rotor_body *b)
{
    dem_vec3 moment = v3_scale(b->impulse, 1 / b->kick), spin = spin_in_body(b, b->q, b->momentum);
    double h = b->step;
    dem_vec3 rate = euler_rate(b->inverse, quat_unrotate(b->q, moment), spin);
    dem_vec3 quarter = v3_along(spin, h / 4, rate), half = v3_along(spin, h / 2, rate);
    dem_quat middle = quat_multiply(turn_by(v3_scale(quat_rotate(b->q, quarter), h / 2)), b->q);
    rate = euler_rate(b->inverse, quat_unrotate(middle, moment), half);
    b->q = quat_multiply(turn_by(v3_scale(quat_rotate(middle, half), h)), b->q);
    spin = v3_along(spin, h, rate);
    b->momentum = quat_rotate(b->q, over_axes(spin, b->inverse));
}

/// The spin in the body behind a kick, for the schemes that carry it.
static inline dem_vec3 kicked_spin(dem_rotation scheme, const double inverse[3], dem_vec3 spin, dem_vec3 moment,
                                   double kick, double last, double turning[3])
{
    if (scheme == DEM_ROTATION_SPIRAL)
        return spiral_spin(inverse, spin, moment, kick);
    if (scheme == DEM_ROTATION_OMELYAN)
        return omelyan_spin(inverse, spin, moment, kick);
    return walton_braun_spin(inverse, spin, moment, kick, last, turning);
}

static inline bool carries_spin(dem_rotation scheme)
{
    return scheme == DEM_ROTATION_SPIRAL || scheme == DEM_ROTATION_OMELYAN || scheme == DEM_ROTATION_WALTON_BRAUN;
}

static inline void rotate_by_spin(rotor_body *b, dem_rotation scheme)
{
    dem_vec3 moment = quat_unrotate(b->q, v3_scale(b->impulse, 1 / b->kick));
    dem_vec3 spin =
        kicked_spin(scheme, b->inverse, spin_in_body(b, b->q, b->momentum), moment, b->kick, b->last, b->turning);
    if (scheme == DEM_ROTATION_SPIRAL)
        b->q = quat_multiply(b->q, turn_by(v3_scale(spin, b->step)));
    else
        b->q = turned_cayley(b->q, spin, b->step);
    b->momentum = quat_rotate(b->q, over_axes(spin, b->inverse));
}

#endif
