/// One patch of a soft contact, for soft_kernels.c: sums over its pairs of spheres in lanes, then the law of the whole.
///
/// The rows of the pairs hold: overlap, normal (out of a), point from the centre of a, weight.
#ifndef DEM_SIM_SOFT_PATCH_H
#define DEM_SIM_SOFT_PATCH_H

#include "sim/contact_geometry.h"
#include "sim/soft.h"

enum { ROW_OVERLAP, ROW_NORMAL, ROW_ARM = 4, ROW_WEIGHT = 7 };

/// Farther apart than anything: the row of no pair.
#define DEM_SOFT_APART (-1e30)

/// A body or wall, as its patches see it.
typedef struct soft_side {
    dem_vec3 velocity, spin;  // velocity: of what stands at the centre of a body, and of a wall at the centre of a
    double inverse_mass;      // [1/kg]
    double inverse[6];        // inverse inertia in space: xx yy zz xy xz yz [1/(kg m^2)]
    double brisk;             // 1 / its least mass [1/kg]
    double quick;             // 1 / its least moment [1/(kg m^2)]
} soft_side;

// what is summed over the pairs, e being the weight times the slope of s, s that times s
enum {
    SUM_S,
    SUM_E,
    SUM_N,        // e n
    SUM_T = 5,    // e r x n
    SUM_V = 8,    // e v, v: speed of separation
    SUM_VV,       // e v^2
    SUM_NV,       // e v n
    SUM_TV = 13,  // e v r x n
    SUM_X = 16,   // e r
    SUM_XX = 19,  // e r^2
    SUM_A,        // e J M^-1 J of a, and of b
    SUM_B,
    SUMS
};

typedef struct soft_sums {
    double lane[SUMS][DEM_BLOCK_LANES] __attribute__((aligned(64)));
} soft_sums;

DEM_INLINE wide3 all3(dem_vec3 v)
{
    return (wide3){wide_all(v.x), wide_all(v.y), wide_all(v.z)};
}

// t^T I^-1 t
DEM_INLINE wide turning_share(const soft_side *side, wide3 t)
{
    const double *i = side->inverse;
    wide x = wide_all(i[0]) * t.x + wide_all(i[3]) * t.y + wide_all(i[4]) * t.z;
    wide y = wide_all(i[3]) * t.x + wide_all(i[1]) * t.y + wide_all(i[5]) * t.z;
    wide z = wide_all(i[4]) * t.x + wide_all(i[5]) * t.y + wide_all(i[2]) * t.z;
    return x * t.x + y * t.y + z * t.z;
}

DEM_INLINE void sum_add(soft_sums *s, int which, size_t l, wide x)
{
    double *lane = s->lane[which] + l;
    wide_store(lane, wide_load(lane) + x);
}
DEM_INLINE void sum_add3(soft_sums *s, int which, size_t l, wide e, wide3 v)
{
    sum_add(s, which, l, e * v.x);
    sum_add(s, which + 1, l, e * v.y);
    sum_add(s, which + 2, l, e * v.z);
}

// what the window makes of s at u = d / tau, as factors of the exponential: s and its slope
DEM_INLINE void soft_window(wide u, wide *value, wide *slope)
{
    const double width = DEM_SOFT_REACH / 2;
    wide one = wide_all(1);
    wide t = wide_max(wide_all(0), wide_min(one, (u + wide_all(DEM_SOFT_REACH)) * wide_all(1 / width)));
    *value = t * t * (wide_all(3) - t - t);
    *slope = *value + wide_all(6 / width) * t * (one - t);
}

typedef struct soft_patch_data {
    const soft_side *a, *b;
    dem_vec3 between;  // from the centre of a to that of b; of walls 0
    double tau, deepest;
    bool watch;
} soft_patch_data;

// the pairs of DEM_WIDTH lanes from l on
DEM_INLINE void sum_lanes(const soft_patch_data *p, const double *rows, const uint32_t *row, size_t l, soft_sums *s)
{
    wide m[8], per_tau = wide_all(1 / p->tau), value, slope;
    rows_load(rows, DEM_ROW, row, m);
    soft_window(m[ROW_OVERLAP] * per_tau, &value, &slope);
    wide e = m[ROW_WEIGHT] * wide_exp((m[ROW_OVERLAP] - wide_all(p->deepest)) * per_tau);
    sum_add(s, SUM_S, l, e * value);
    e = e * slope;
    wide3 n = {m[ROW_NORMAL], m[ROW_NORMAL + 1], m[ROW_NORMAL + 2]};
    wide3 r = {m[ROW_ARM], m[ROW_ARM + 1], m[ROW_ARM + 2]}, t = cross3(r, n), between = all3(p->between);
    wide3 tb = cross3(between, n);
    tb = (wide3){t.x - tb.x, t.y - tb.y, t.z - tb.z};
    wide3 over = all3(v3_sub(p->b->velocity, p->a->velocity));
    wide v = dot3(n, over) + (dot3(all3(p->b->spin), tb) - dot3(all3(p->a->spin), t));
    sum_add(s, SUM_E, l, e);
    sum_add3(s, SUM_N, l, e, n);
    sum_add3(s, SUM_T, l, e, t);
    wide ev = e * v;
    sum_add(s, SUM_V, l, ev);
    sum_add(s, SUM_VV, l, ev * v);
    sum_add3(s, SUM_NV, l, ev, n);
    sum_add3(s, SUM_TV, l, ev, t);
    sum_add3(s, SUM_X, l, e, r);
    sum_add(s, SUM_XX, l, e * dot3(r, r));
    if (p->watch) {
        sum_add(s, SUM_A, l, e * (wide_all(p->a->inverse_mass) + turning_share(p->a, t)));
        sum_add(s, SUM_B, l, e * (wide_all(p->b->inverse_mass) + turning_share(p->b, tb)));
    }
}

// a patch as a whole
typedef struct soft_whole {
    double depth;                   // D [m]
    dem_vec3 n;                     // unit, out of a
    double along;                   // |sum omega n|: how much of the force goes along n
    dem_vec3 normal, turn, turn_b;  // sum omega n, r x n for a and b
    double speed;                   // of separation, - dD/dt [m/s]
    dem_vec3 uneven, uneven_turn;   // sum omega (v - mean) n, r x n
    double uneven_power;            // sum omega (v - mean)^2 [m^2/s^2]
    dem_vec3 point;                 // mean contact point from the centre of a [m]
    double gyration;                // radius of gyration of the points [m]
    double share_a, share_b;        // 1 / mass along D, of each [1/kg]
    double spread_a, spread_b;      // mean over the pairs of their own 1 / mass [1/kg] (watch)
} soft_whole;

DEM_INLINE double whole_sum(const soft_sums *s, int which)
{
    const double *x = s->lane[which];
    return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
}
DEM_INLINE dem_vec3 whole_sum3(const soft_sums *s, int which)
{
    return v3(whole_sum(s, which), whole_sum(s, which + 1), whole_sum(s, which + 2));
}

static inline double turning_of(const soft_side *side, dem_vec3 t)
{
    const double *i = side->inverse;
    return i[0] * t.x * t.x + i[1] * t.y * t.y + i[2] * t.z * t.z +
           2 * (i[3] * t.x * t.y + i[4] * t.x * t.z + i[5] * t.y * t.z);
}

static inline soft_whole soft_whole_of(const soft_patch_data *p, const soft_sums *s)
{
    double sum = whole_sum(s, SUM_S), e = whole_sum(s, SUM_E);
    soft_whole w = {.depth = sum > 0 ? p->deepest + p->tau * log(sum) : DEM_SOFT_APART};
    if (!(sum > 0 && e > 0))
        return w;
    double per = 1 / sum, mean = whole_sum(s, SUM_V) / e;
    dem_vec3 n = whole_sum3(s, SUM_N), t = whole_sum3(s, SUM_T);
    w.normal = v3_scale(n, per);
    w.turn = v3_scale(t, per);
    w.turn_b = v3_sub(w.turn, v3_cross(p->between, w.normal));
    w.along = v3_norm(w.normal);
    w.n = w.along > 0 ? v3_scale(w.normal, 1 / w.along) : v3(0, 0, 1);
    w.speed = whole_sum(s, SUM_V) * per;
    w.uneven = v3_scale(v3_along(whole_sum3(s, SUM_NV), -mean, n), per);
    w.uneven_turn = v3_scale(v3_along(whole_sum3(s, SUM_TV), -mean, t), per);
    w.uneven_power = larger(whole_sum(s, SUM_VV) - mean * mean * e, 0) * per;
    w.point = v3_scale(whole_sum3(s, SUM_X), 1 / e);
    w.gyration = sqrt(larger(whole_sum(s, SUM_XX) / e - v3_norm2(w.point), 0));
    w.share_a = p->a->inverse_mass * v3_norm2(w.normal) + turning_of(p->a, w.turn);
    w.share_b = p->b->inverse_mass * v3_norm2(w.normal) + turning_of(p->b, w.turn_b);
    if (p->watch) {
        w.spread_a = larger(whole_sum(s, SUM_A) * per, w.share_a);
        w.spread_b = larger(whole_sum(s, SUM_B) * per, w.share_b);
    }
    return w;
}

#endif
