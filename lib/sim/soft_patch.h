/// Patches of soft contacts, one in each lane, for soft_kernels.c: sums over their pairs of spheres, and what the patch
/// is as a whole.
///
/// The rows of the pairs hold: overlap, normal (out of a), point from the centre of a, weight.
#ifndef DEM_SIM_SOFT_PATCH_H
#define DEM_SIM_SOFT_PATCH_H

#include "sim/contact_geometry.h"
#include "sim/soft.h"

enum { ROW_OVERLAP, ROW_NORMAL, ROW_ARM = 4, ROW_WEIGHT = 7 };

/// Farther apart than anything: the row of no pair.
#define DEM_SOFT_APART (-1e30)

DEM_INLINE wide3 plus3(wide3 a, wide3 b)
{
    return (wide3){a.x + b.x, a.y + b.y, a.z + b.z};
}
DEM_INLINE wide3 minus3(wide3 a, wide3 b)
{
    return (wide3){a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Bodies or walls, as their patches see them.
typedef struct soft_side {
    wide3 velocity, spin;  // velocity: of what stands at the centre of a body, and of a wall at the centre of a
    wide inverse_mass;     // [1/kg]
    wide inverse[6];       // inverse inertia in space: xx yy zz xy xz yz [1/(kg m^2)]
    wide brisk;            // 1 / its least mass [1/kg]
    wide quick;            // 1 / its least moment [1/(kg m^2)]
    wide mean;             // of the inverse moments [1/(kg m^2)]
} soft_side;

/// A body's motion and inertia; `pose`: its row.
DEM_INLINE soft_side side_of(const dem_rows *rows, const uint32_t *body, const wide pose[8])
{
    wide motion[8], i[8], one = wide_all(1), zero = wide_all(0);
    rows_load(rows->bodies + 8, DEM_BODY_ROW, body, motion);
    rows_load(rows->inertia, DEM_ROW, body, i);
    soft_side s = {.velocity = {motion[0], motion[1], motion[2]},
                   .spin = {motion[3], motion[4], motion[5]},
                   .inverse_mass = i[0],
                   .brisk = i[6],
                   .quick = wide_max(i[1], wide_max(i[2], i[3])),
                   .mean = (i[1] + i[2] + i[3]) * wide_all(1.0 / 3)};
    wide3 x = turned(pose + 3, (wide3){one, zero, zero}), y = turned(pose + 3, (wide3){zero, one, zero});
    wide3 z = cross3(x, y), ix = scale3(x, i[1]), iy = scale3(y, i[2]), iz = scale3(z, i[3]);
    s.inverse[0] = wide_fma(ix.x, x.x, wide_fma(iy.x, y.x, iz.x * z.x));
    s.inverse[1] = wide_fma(ix.y, x.y, wide_fma(iy.y, y.y, iz.y * z.y));
    s.inverse[2] = wide_fma(ix.z, x.z, wide_fma(iy.z, y.z, iz.z * z.z));
    s.inverse[3] = wide_fma(ix.x, x.y, wide_fma(iy.x, y.y, iz.x * z.y));
    s.inverse[4] = wide_fma(ix.x, x.z, wide_fma(iy.x, y.z, iz.x * z.z));
    s.inverse[5] = wide_fma(ix.y, x.z, wide_fma(iy.y, y.z, iz.y * z.z));
    return s;
}

/// t^T I^-1 t
DEM_INLINE wide turning_share(const soft_side *side, wide3 t)
{
    const wide *i = side->inverse;
    wide x = wide_fma(i[0], t.x, wide_fma(i[3], t.y, i[4] * t.z));
    wide y = wide_fma(i[3], t.x, wide_fma(i[1], t.y, i[5] * t.z));
    wide z = wide_fma(i[4], t.x, wide_fma(i[5], t.y, i[2] * t.z));
    return wide_fma(x, t.x, wide_fma(y, t.y, z * t.z));
}

/// What the window makes of s at u = d / tau, as factors of the exponential: s and its slope.
DEM_INLINE void soft_window(wide u, wide *value, wide *slope)
{
    const double width = DEM_SOFT_REACH / 2;
    wide one = wide_all(1);
    wide t = wide_max(wide_all(0), wide_min(one, (u + wide_all(DEM_SOFT_REACH)) * wide_all(1 / width)));
    *value = t * t * (wide_all(3) - t - t);
    *slope = *value + wide_all(6 / width) * t * (one - t);
}

/// DEM_WIDTH patches that are summed up side by side.
typedef struct soft_lanes {
    soft_side a, b;
    wide3 between;                  // from the centre of a to that of b; of walls 0
    const uint32_t *first, *count;  // their rows
    wide deepest;                   // overlap [m]
    double tau;                     // [m]
} soft_lanes;

/// What is summed over the pairs, e being the weight times the slope of s.
typedef struct soft_sums {
    wide s;                   // S over e^(deepest / tau)
    wide e, v, vv, xx;        // e, e v, e v^2, e r^2; v: speed of separation
    wide3 n, t, nv, tv, x;    // e n, e r x n, e v n, e v r x n, e r
    wide spread_a, spread_b;  // e J M^-1 J of a, and of b
} soft_sums;

DEM_INLINE soft_sums soft_sum(const dem_features f, const soft_lanes *p, const double *rows, uint32_t none)
{
    wide zero = wide_all(0), per_tau = wide_all(1 / p->tau);
    wide3 none3 = {zero, zero, zero}, over = minus3(p->b.velocity, p->a.velocity);
    soft_sums s = {zero, zero, zero, zero, zero, none3, none3, none3, none3, none3, zero, zero};
    uint32_t most = 0, row[DEM_WIDTH];
    for (size_t l = 0; l < DEM_WIDTH; l++)
        most = p->count[l] > most ? p->count[l] : most;
    for (uint32_t k = 0; k < most; k++) {
        for (size_t l = 0; l < DEM_WIDTH; l++)
            row[l] = k < p->count[l] ? p->first[l] + k : none;
        wide m[8], value, slope;
        rows_load(rows, DEM_ROW, row, m);
        soft_window(m[ROW_OVERLAP] * per_tau, &value, &slope);
        wide e = m[ROW_WEIGHT] * wide_exp((m[ROW_OVERLAP] - p->deepest) * per_tau);
        s.s = wide_fma(e, value, s.s);
        e = e * slope;
        wide3 n = {m[ROW_NORMAL], m[ROW_NORMAL + 1], m[ROW_NORMAL + 2]};
        wide3 r = {m[ROW_ARM], m[ROW_ARM + 1], m[ROW_ARM + 2]}, t = cross3(r, n);
        wide3 tb = minus3(t, cross3(p->between, n));
        wide v = dot3(n, over) + (dot3(p->b.spin, tb) - dot3(p->a.spin, t)), ev = e * v;
        s.e = s.e + e;
        s.n = along3(s.n, e, n);
        s.t = along3(s.t, e, t);
        s.v = s.v + ev;
        s.nv = along3(s.nv, ev, n);
        s.tv = along3(s.tv, ev, t);
        s.x = along3(s.x, e, r);
        s.xx = wide_fma(e, dot3(r, r), s.xx);
        if (f.ledger)
            s.vv = wide_fma(ev, v, s.vv);
        if (f.watch) {
            s.spread_a = wide_fma(e, p->a.inverse_mass + turning_share(&p->a, t), s.spread_a);
            s.spread_b = wide_fma(e, p->b.inverse_mass + turning_share(&p->b, tb), s.spread_b);
        }
    }
    return s;
}

/// Patches as a whole.
typedef struct soft_whole {
    wide depth;                 // D [m]
    wide3 n;                    // unit, out of a
    wide along;                 // |sum omega n|: how much of the force goes along n
    wide3 normal, turn;         // sum omega n, r x n for a
    wide speed;                 // of separation, - dD/dt [m/s]
    wide3 uneven, uneven_turn;  // sum omega (v - mean) n, r x n
    wide uneven_power;          // sum omega (v - mean)^2 [m^2/s^2] (ledger)
    wide3 point;                // mean contact point from the centre of a [m]
    wide gyration;              // radius of gyration of the points [m]
    wide share_a, share_b;      // 1 / mass along D, of each [1/kg]
    wide spread_a, spread_b;    // mean over the pairs of their own 1 / mass [1/kg] (watch)
} soft_whole;

DEM_INLINE soft_whole soft_whole_of(const soft_lanes *p, const soft_sums *s, wide depth)
{
    wide zero = wide_all(0), one = wide_all(1);
    wide per = wide_or_zero(wide_less(zero, s->s), one / s->s), per_e = wide_or_zero(wide_less(zero, s->e), one / s->e);
    wide mean = s->v * per_e, back = zero - mean;
    soft_whole w = {.depth = depth, .normal = scale3(s->n, per), .turn = scale3(s->t, per)};
    wide3 turn_b = minus3(w.turn, cross3(p->between, w.normal));
    wide square = dot3(w.normal, w.normal);
    w.along = wide_sqrt(square);
    wide_mask some = wide_less(zero, square);
    w.n = scale3(w.normal, one / w.along);
    w.n = (wide3){wide_or_zero(some, w.n.x), wide_or_zero(some, w.n.y), wide_select(some, w.n.z, one)};
    w.speed = s->v * per;
    w.uneven = scale3(along3(s->nv, back, s->n), per);
    w.uneven_turn = scale3(along3(s->tv, back, s->t), per);
    w.uneven_power = wide_max(wide_fnma(mean * mean, s->e, s->vv), zero) * per;
    w.point = scale3(s->x, per_e);
    w.gyration = wide_sqrt(wide_max(s->xx * per_e - dot3(w.point, w.point), zero));
    w.share_a = wide_fma(p->a.inverse_mass, square, turning_share(&p->a, w.turn));
    w.share_b = wide_fma(p->b.inverse_mass, square, turning_share(&p->b, turn_b));
    w.spread_a = wide_max(s->spread_a * per, w.share_a);
    w.spread_b = wide_max(s->spread_b * per, w.share_b);
    return w;
}

#endif
