/// What soft patches do by the laws of the scene, for soft_kernels.c. The laws are those of single contacts, with a
/// patch in each lane.
#ifndef DEM_SIM_SOFT_LAW_H
#define DEM_SIM_SOFT_LAW_H

#include "sim/soft_patch.h"

// of a disc, the mean distance of its points from the centre over their radius of gyration; a square has .94, too
static const double MEAN_ARM = 0.94;

/// The features that soft contacts can have.
DEM_INLINE dem_features soft_features(const dem_features *f)
{
    return (dem_features){.linear = f->linear,
                          .young = f->young,
                          .hertz = f->hertz,
                          .rate = f->rate,
                          .restitution = f->restitution,
                          .cut = f->cut,
                          .local_mass = f->local_mass,
                          .friction = f->friction,
                          .decay = f->decay,
                          .mindlin = f->mindlin,
                          .slide_damping = f->slide_damping,
                          .offset = true,
                          .scaled = true,
                          .periodic = f->periodic,
                          .mixed = f->mixed,
                          .ledger = f->ledger,
                          .soft = true,
                          .watch = f->watch,
                          .moving = f->moving,
                          .reaction = f->reaction};
}

/// What patches remember.
typedef struct soft_memory {
    wide3 spring, dash;
    wide twist, patch, loss;
} soft_memory;

typedef struct soft_result {
    wide net;                                          // normal force along D [N]
    wide3 force, moment;                               // on a, about its centre [N], [N m]
    wide elastic_normal, elastic_slide, elastic_turn;  // [J]
    wide lost_friction, lost_viscous;                  // since the last step [J]
    wide strain_a, strain_b;                           // h^2 k + 2 h c over the masses, see timestep.h [-]
    wide hardness;                                     // of a wall's spring and dashpot over the step [N/m] (reaction)
} soft_result;

typedef struct soft_spot {
    wide law[LAW_MORE];
    wide reduced, area;  // R* [m]; R_min^2 / (R_a + R_b) [m]
    double tau, last_step, next_step;
    wide share, stiffening;  // of the parts, where there are some
    bool wall, parted;
} soft_spot;

// what the parts of the law hand on to each other
typedef struct soft_dashpots {
    contact_mass mass;
    wide stiffness, damping, elastic;  // along the normal
    wide uneven;                // against what the speeds of the pairs differ by [N s/m]
    wide slide, slide_damping;  // tangential stiffness and damping
} soft_dashpots;

// the dashpot of a patch against what the speeds of its pairs differ by
DEM_INLINE wide uneven_damping(const soft_spot *spot, const soft_dashpots *d, wide net)
{
    wide c = d->damping, zero = wide_all(0), one = wide_all(1);
    // fades as the tail of the whole is cut, so that there is no jump
    wide fades = wide_or_zero(wide_less(zero, d->elastic), wide_min(one, wide_max(zero, net / d->elastic)));
    return fades * c / wide_fma(wide_all(0.25 * spot->last_step), c * d->mass.inverse, one);
}

// the spring and the dashpot against twisting: k_t and c_t times the square of the radius of gyration, capped by the
// points' mean arm
DEM_INLINE wide twist(const dem_features f, const soft_spot *spot, const soft_whole *p, const soft_dashpots *d,
                      wide cap, wide rate, soft_memory *m, soft_result *out)
{
    wide zero = wide_all(0), step = wide_all(spot->last_step);
    wide square = wide_or_zero(wide_less(zero, p->depth), p->gyration * p->gyration), stiffness = d->slide * square;
    wide old = m->patch, start = m->twist, most = cap * wide_all(MEAN_ARM) * p->gyration, least = zero - most;
    wide kept = wide_select(wide_less(old, stiffness), old / stiffness, wide_all(1));
    wide spring = stiffness * wide_fma(start, kept, step * rate);
    spring = wide_max(least, wide_min(most, spring));
    m->twist = wide_or_zero(wide_less(zero, stiffness), spring / stiffness);
    m->patch = stiffness;
    wide held = spring * m->twist, damping = d->slide_damping * square;
    wide moment = wide_max(least, wide_min(most, wide_fma(damping, rate, spring)));
    out->elastic_turn = wide_all(0.5) * held;
    if (f.ledger) {
        wide done = step * wide_fma(old, start, spring) * rate, gained = held - old * start * start;
        out->lost_friction = wide_fma(wide_all(0.5), done - gained, out->lost_friction);
        out->lost_viscous = wide_fma(step * (moment - spring), rate, out->lost_viscous);
    }
    return moment;
}

// friction at the mean contact point
DEM_INLINE wide3 soft_slide(const dem_features f, const soft_spot *spot, const soft_lanes *p, const soft_whole *s,
                            normal_law *normal, soft_dashpots *d, soft_memory *m, soft_result *out)
{
    wide zero = wide_all(0), half = wide_all(0.5), step = wide_all(spot->last_step);
    wide3 vb = plus3(p->b.velocity, cross3(p->b.spin, minus3(s->point, p->between)));
    wide3 v = minus3(vb, plus3(p->a.velocity, cross3(p->a.spin, s->point)));
    wide vn = dot3(v, s->n), turn = half * step * dot3(plus3(p->a.spin, p->b.spin), s->n);
    wide3 slip = along3(v, zero - vn, s->n), spring = spring_turn(m->spring, s->n, turn);
    wide_mask on = wide_less(zero, s->depth);
    // the cap is by the force along the mean normal
    normal->force = normal->force * s->along;
    friction_law t = friction(f, spot->law, normal, spot->reduced, s->depth, s->speed, &d->mass, spring, slip, step,
                              on, wide_less(zero, zero));
    d->slide = t.stiffness;
    d->slide_damping = t.damping;
    out->elastic_slide = half * t.stiffness * dot3(t.spring, t.spring);
    out->lost_friction = out->lost_friction + t.lost;
    if (f.ledger && f.slide_damping)
        out->lost_viscous = wide_fma(half * step, dot3(plus3(m->dash, t.dash), slip), out->lost_viscous);
    m->spring = t.spring;
    m->dash = t.dash;
    return t.force;
}

// what a patch takes of the room for a stable step: along D, what its pairs differ by, sliding and twisting
DEM_INLINE wide soft_strain(const soft_spot *spot, const soft_side *side, const soft_whole *s, const soft_dashpots *d,
                            wide per_tau, wide share, wide spread)
{
    wide h = wide_all(spot->next_step), two = wide_all(2);
    wide tangent = wide_fma(s->gyration * s->gyration, side->quick, two * side->brisk);
    wide taken = wide_fma(d->stiffness, share, wide_fma(per_tau, spread - share, d->slide * tangent));
    wide damping = wide_fma(d->uneven, spread, d->slide_damping * tangent);
    return wide_all(spot->wall ? 1 : 2) * h * wide_fma(h, taken, two * damping);
}

/// Parts that share what they bear, see soft_couple.c, do so with normal force and dashpot. Springs along the surface
/// stay as they are, for their energy must not come and go with the share.
///
/// Patches that touch, and those that have just parted: then there is no force, but something may be lost.
DEM_INLINE soft_result soft_act(const dem_features f, const soft_spot *spot, const soft_lanes *p, const soft_whole *s,
                                soft_memory *m)
{
    wide zero = wide_all(0);
    wide3 none = {zero, zero, zero};
    soft_result out = {zero, none, none, zero, zero, zero, zero, zero, zero, zero, zero};
    wide_mask on = wide_less(zero, s->depth);
    wide inverse = f.local_mass ? s->share_a + s->share_b : p->a.inverse_mass + p->b.inverse_mass;
    inverse = wide_select(wide_less(wide_all(DEM_SOFT_HEAVIEST), inverse), inverse, wide_all(DEM_SOFT_HEAVIEST));
    double step = spot->last_step > 0 ? spot->last_step : spot->next_step;
    soft_dashpots d = {
        .mass = contact_mass_of(f, inverse), .uneven = zero, .slide = zero, .slide_damping = zero};
    normal_law normal = normal_elastic(f, spot->law, NULL, s->depth, spot->reduced, spot->area);
    normal_damp(f, spot->law, &normal, &d.mass, s->depth, s->speed, wide_all(spot->last_step), wide_all(1 / step));
    wide shared = normal.stiffness;
    if (spot->parted) {
        shared = shared * spot->share;
        normal.elastic = normal.elastic * spot->share;
        normal.force = normal.force * spot->share;
        normal.damping = normal.damping * spot->share;
    }
    d.stiffness = normal.stiffness;
    d.damping = normal.damping;
    d.elastic = wide_or_zero(on, normal.elastic);
    out.net = wide_or_zero(on, normal.force);
    if (f.rate || f.restitution)
        d.uneven = uneven_damping(spot, &d, out.net);
    // of the linear part F = k d the half, of Hertz' F = 2/3 k d two fifths
    wide linear = normal.elastic;
    if (f.hertz)
        linear = wide_all(3) * normal.elastic - wide_all(2) * shared * s->depth;
    wide mean = wide_fma(wide_all(0.5), linear, wide_all(0.4) * (normal.elastic - linear));
    out.elastic_normal = wide_or_zero(on, mean * s->depth);
    if (f.ledger && (f.rate || f.restitution)) {
        wide now = d.elastic - out.net, by = wide_all(spot->last_step);
        out.lost_viscous = by * wide_fma(wide_all(0.5) * (m->loss + now), s->speed, d.uneven * s->uneven_power);
        m->loss = now;
    }
    wide back = zero - out.net;
    out.force = along3(scale3(s->uneven, d.uneven), back, s->normal);
    out.moment = along3(scale3(s->uneven_turn, d.uneven), back, s->turn);
    if (f.friction) {
        wide3 drag = soft_slide(f, spot, p, s, &normal, &d, m, &out);
        wide cap = spot->law[LAW_FRICTION] * wide_abs(out.net) * s->along;
        wide rate = dot3(minus3(p->b.spin, p->a.spin), s->n);
        wide turning = twist(f, spot, s, &d, cap, rate, m, &out);
        out.force = plus3(out.force, drag);
        out.moment = plus3(out.moment, along3(cross3(s->point, drag), turning, s->n));
    }
    if (spot->parted)
        d.stiffness = d.stiffness * spot->stiffening;
    if (f.watch) {
        wide per_tau = wide_max(out.net, d.elastic) * wide_all(1 / spot->tau);
        out.strain_a = soft_strain(spot, &p->a, s, &d, per_tau, s->share_a, s->spread_a);
        out.strain_b = soft_strain(spot, &p->b, s, &d, per_tau, s->share_b, s->spread_b);
    }
    if (f.reaction)
        out.hardness =
            wide_or_zero(on, wide_fma(d.damping, wide_all(1 / step), d.stiffness));
    return out;
}

#endif
