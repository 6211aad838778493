/// Normal forces: linear spring (Cundall & Strack 1979) and Hertz (1882), with a dashpot.
#ifndef DEM_SIM_LAW_NORMAL_H
#define DEM_SIM_LAW_NORMAL_H

#include "base/simd.h"
#include "sim/features.h"
#include "sim/law/jkr.h"

typedef struct normal_law {
    wide elastic;    ///< force of the spring [N]
    wide force;      ///< with the dashpot [N]
    wide stiffness;  ///< tangent of the spring [N/m]
    wide damping;    ///< of the dashpot [N s/m]
    wide radius;     ///< sqrt(R* overlap), of the contact [m] (Hertz only)
    wide per_radius; ///< [1/m] (Hertz, not JKR)
    wide spread;     ///< d radius / d overlap [-] (JKR only)
    wide grip;       ///< force by which friction is measured: what JKR pulls counts twice at most [N] (JKR only)
    wide energy;     ///< of the spring [J] (JKR only)
} normal_law;

/// What laws take of the step: `step` since the last one [s].
typedef struct law_step {
    wide step, per_step;  ///< [s], [1/s]; at the start nothing has passed, and 1 / step is that of the step to come
    wide rate;            ///< of the dashpot, for this step: see normal_damp [1/s] (rate)
    // where stiffnesses are the law's alone: see alike
    wide per_slide;               ///< 1 / tangential stiffness [m/N]
    wide push_zeta, slide_zeta;   ///< z sqrt(stiffness), along the normal and tangential [sqrt(N/m)] (restitution)
} law_step;

/// Whether stiffnesses are the same for all contacts of a law.
DEM_INLINE bool alike(const dem_features f)
{
    return f.linear && !f.young && !f.hertz && !f.jkr && !f.mindlin;
}

DEM_INLINE law_step law_step_of(const dem_features f, const wide *law, double last_step, double next_step)
{
    wide step = wide_all(last_step), one = wide_all(1);
    law_step s = {.step = step, .per_step = wide_all(1 / (last_step > 0 ? last_step : next_step))};
    if (f.rate)
        s.rate = law[LAW_RATE] / wide_fma(wide_all(0.25) * step, law[LAW_RATE], one);
    if (!alike(f))
        return s;
    wide slide = law[LAW_SLIDE_STIFFNESS] + law[LAW_SLIDE_RATIO] * law[LAW_STIFFNESS];
    if (f.friction)
        s.per_slide = one / slide;
    if (f.restitution)
        s.push_zeta = law[LAW_ZETA] * wide_sqrt(law[LAW_STIFFNESS]);
    if (f.restitution && f.friction)
        s.slide_zeta = law[LAW_SLIDE_ZETA] * wide_sqrt(slide);
    return s;
}

/// The mass that a contact sees.
typedef struct contact_mass {
    wide inverse, mass, root;  ///< 1 / m [1/kg], m [kg], sqrt(m) [sqrt(kg)] (restitution only)
} contact_mass;

DEM_INLINE contact_mass contact_mass_of(const dem_features f, wide inverse)
{
    contact_mass m = {inverse, wide_all(0), wide_all(0)};
    if (f.restitution) {
        m.root = wide_rsqrt(inverse + wide_all(1e-300));
        m.mass = m.root * m.root;
    }
    if (f.rate)
        m.mass = wide_all(1) / inverse;
    return m;
}

/// R* = R_i R_j / (R_i + R_j)
DEM_INLINE wide reduced_radius(wide a, wide b)
{
    return a * b / (a + b);
}

/// Elastic part. `reduced` R* [m] (Hertz), `area_length` A / (pi L) = R_min^2 / (R_i + R_j) [m] (young).
DEM_INLINE normal_law normal_elastic(const dem_features f, const wide *law, const jkr_pair *surfaces, wide overlap,
                                     wide reduced, wide area_length)
{
    wide zero = wide_all(0);
    normal_law n = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
    if (f.linear) {
        n.stiffness = law[LAW_STIFFNESS];
        if (f.young)
            n.stiffness = n.stiffness + law[LAW_YOUNG] * area_length;
        n.elastic = n.stiffness * overlap;
    }
    if (f.jkr) {
        jkr_law j = jkr(surfaces, jkr_stretch(surfaces, overlap / reduced));
        n.energy = wide_fma(wide_all(0.5) * overlap, n.elastic, j.energy);
        n.elastic = n.elastic + j.force;
        // an upper bound of the tangent
        n.stiffness = n.stiffness + law[LAW_HERTZ] * j.radius;
        n.radius = j.radius;
        n.spread = j.spread;
        // pull-off 3/2 pi w R*
        n.grip = wide_all(1.5) * law[LAW_JKR] * reduced;
    } else if (f.hertz) {
        n.radius = wide_root(reduced * wide_max(overlap, zero), &n.per_radius);
        wide tangent = law[LAW_HERTZ] * n.radius;
        n.elastic = n.elastic + wide_all(2.0 / 3) * (tangent * overlap);
        n.stiffness = n.stiffness + tangent;
    }
    n.force = n.elastic;
    return n;
}

/// What friction and rolling are measured by [N].
DEM_INLINE wide normal_grip(const dem_features f, const normal_law *n)
{
    return f.jkr ? n->grip : wide_abs(n->force);
}

/// The contact radius of a step ago [m]; `before`: the overlap then.
DEM_INLINE wide radius_before(const dem_features f, const normal_law *n, wide reduced, wide overlap, wide before)
{
    if (f.jkr)
        // by its slope, which has no bound where surfaces part
        return wide_max(wide_min(wide_fma(n->spread, before - overlap, n->radius), n->radius + n->radius), wide_all(0));
    wide inverse;
    return wide_root(reduced * wide_max(before, wide_all(0)), &inverse);
}

/// Dashpot on the velocity `vn` of separation half a step ago [m/s].
///
/// Of second order, so that few steps give the asked restitution. The old velocity makes an oscillator of m - c h / 2
/// of one of m, whose damping ratio is larger by 1 + c h / 4 m: c is smaller by that. And the first force counts for a
/// whole step, wherever in the step the contact has begun: with s = overlap / (h |vn|), the steps since then, it is
/// weighed by 3/2 s up to s = 1 and then by 2 - s / 2 down to 1, which has no jumps and sums up to the time that has
/// passed. Likewise at the end of a contact that may pull.
DEM_INLINE void normal_damp(const dem_features f, const wide *law, const law_step *s, normal_law *n,
                            const contact_mass *m, wide overlap, wide vn)
{
    // by a rate, c / m is a number of the law; in a scene that has both, each contact has one of them
    wide c = wide_all(0), quarter = wide_all(0.25) * s->step;
    if (f.rate) {
        n->damping = law[LAW_RATE] * m->mass;
        c = s->rate * m->mass;
    }
    if (f.restitution) {
        wide zeta = s->push_zeta, inverse;
        if (!alike(f))
            zeta = law[LAW_ZETA] * wide_root(n->stiffness, &inverse);
        wide own = zeta * m->root;
        n->damping = n->damping + own;
        c = c + own / wide_fma(quarter, own * m->inverse, wide_all(1));
    }
    if (f.rate || f.restitution) {
        wide speed = wide_abs(vn), gone = overlap * s->per_step;
        wide acts = wide_max(speed, wide_fma(wide_all(-0.5), gone, speed + speed));
        acts = wide_min(wide_all(1.5) * gone, acts);
        wide leaves = f.cut ? wide_select(wide_less(law[LAW_FLOOR], wide_all(0)), acts, vn) : acts;
        acts = wide_select(wide_less(vn, wide_all(0)), wide_all(0) - acts, leaves);
        n->force = wide_fnma(c, acts, n->force);
    }
    if (f.cut)
        n->force = wide_max(n->force, law[LAW_FLOOR]);
    if (f.jkr)
        n->grip = wide_max(n->force + n->grip, wide_all(0));
}

#endif
