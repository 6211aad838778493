/// What soft patches do by the laws of the scene, for soft_kernels.c. The laws are those of single contacts, with a
/// patch in each lane.
#ifndef DEM_SIM_SOFT_LAW_H
#define DEM_SIM_SOFT_LAW_H

#include "sim/law/turning.h"
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
                          .rolling = f->rolling,
                          .roll_constant = f->roll_constant,
                          .roll_bound = f->roll_bound,
                          .twisting = f->twisting,
                          .twist_constant = f->twist_constant,
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
    wide3 spring, dash, roll, drag;
    wide twist, patch, loss;
} soft_memory;

typedef struct soft_result {
    wide net;                                          // normal force along D [N]
    wide3 force, moment;                               // on a, about its centre [N], [N m]
    wide elastic_normal, elastic_slide, elastic_turn;  // [J]
    wide lost_friction, lost_viscous;                  // since the last step [J]
    wide strain_a, strain_b;                           // h^2 k + 2 h c over the masses, see timestep.h [-]
    wide bound;                                        // for the spins of both [N m] (roll_bound)
    wide hardness;                                     // of a wall's spring and dashpot over the step [N/m] (reaction)
} soft_result;

enum { SOFT_LAW = LAW_MORE + 16 };  // numbers of a law, of which the last are those of moments

typedef struct soft_spot {
    wide law[SOFT_LAW];
    law_step step;
    wide reduced, area;  // R* [m]; R_min^2 / (R_a + R_b) [m]
    wide radius_a, radius_b;  // [m]
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
    wide arm2;                  // their square arm against twisting [m^2]
} soft_dashpots;

// the dashpot of a patch against what the speeds of its pairs differ by
DEM_INLINE wide uneven_damping(const soft_spot *spot, const soft_dashpots *d, wide net)
{
    wide c = d->damping, zero = wide_all(0), one = wide_all(1);
    // fades as the tail of the whole is cut, so that there is no jump
    wide fades = wide_or_zero(wide_less(zero, d->elastic), wide_min(one, wide_max(zero, net / d->elastic)));
    return fades * c / wide_fma(wide_all(0.25 * spot->last_step), c * d->mass.inverse, one);
}

// The spring and the dashpot against twisting: k_t and c_t times the square of the radius of gyration, capped by
// friction at the points' mean arm; and what a twisting law adds within one contact of the radius sqrt(R* D).
DEM_INLINE wide twist(const dem_features f, const soft_spot *spot, const soft_whole *p, soft_dashpots *d,
                      wide grip, wide rate, soft_memory *m, soft_result *out)
{
    wide zero = wide_all(0), step = wide_all(spot->last_step), square = p->gyration * p->gyration;
    wide most = spot->law[LAW_FRICTION] * grip * wide_all(MEAN_ARM) * p->gyration;
    if (f.twisting) {
        wide inner = spot->reduced * wide_max(p->depth, zero);
        square = wide_fma(spot->law[LAW_TWIST_RATIO], inner, square);
        most = wide_fma(spot->law[LAW_TWIST_CAP] * grip, wide_sqrt(inner), most);
    }
    square = wide_or_zero(wide_less(zero, p->depth), square);
    d->arm2 = square;
    wide stiffness = d->slide * square, old = m->patch, start = m->twist, least = zero - most;
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
    friction_trial trial = friction_try(f, spot->law, &spot->step, normal, spot->reduced, s->depth, s->speed, &d->mass,
                                        spring, slip, wide_less(zero, zero));
    friction_law t = friction(f, spot->law, &spot->step, &trial, on);
    d->slide = trial.stiffness;
    d->slide_damping = trial.damping;
    out->elastic_slide = half * trial.stiffness * dot3(t.spring, t.spring);
    out->lost_friction = out->lost_friction + t.lost;
    if (f.ledger && f.slide_damping)
        out->lost_viscous = wide_fma(half * step, dot3(plus3(m->dash, t.dash), slip), out->lost_viscous);
    m->spring = t.spring;
    m->dash = t.dash;
    return t.force;
}

// 1 / (I + m r^2), as for single contacts
DEM_INLINE wide soft_rolling(const soft_side *side, wide radius)
{
    return side->inverse_mass * side->mean / wide_fma(radius * radius, side->mean, side->inverse_mass);
}

// the moments against rolling and constant ones, about the mean normal; returns their strain
DEM_INLINE wide soft_turning(const dem_features given, const soft_spot *spot, const soft_lanes *p, const soft_whole *s,
                             const normal_law *normal, soft_memory *m, soft_result *out)
{
    dem_features f = given;
    f.twisting = false;  // it is with the spring of the whole patch
    wide zero = wide_all(0), step = wide_all(spot->last_step), half = wide_all(0.5);
    normal_law n = *normal;
    n.force = out->net * s->along;
    wide before = wide_max(wide_fma(s->speed, step, s->depth), zero);
    turning_state state = {.n = s->n,
                           .spin = minus3(p->b.spin, p->a.spin),
                           .roll = spring_turn(m->roll, s->n, half * step * dot3(plus3(p->a.spin, p->b.spin), s->n)),
                           .twist = zero,
                           .reduced = spot->reduced,
                           .patch = zero,
                           .patch_before = wide_sqrt(spot->reduced * before),
                           .inverse = soft_rolling(&p->a, spot->radius_a),
                           .step = step,
                           .slide = zero,
                           .slide_before = zero,
                           .slide_damping = zero};
    if (!spot->wall)
        state.inverse = state.inverse + soft_rolling(&p->b, spot->radius_b);
    wide_mask heavy = wide_less(state.inverse, wide_all(DEM_SOFT_HEAVIEST));
    state.inverse = wide_select(heavy, wide_all(DEM_SOFT_HEAVIEST), state.inverse);
    turning_law t = turning(f, spot->law, &n, &state, wide_all(spot->next_step), wide_less(zero, s->depth));
    out->moment = plus3(out->moment, t.moment);
    out->elastic_turn = wide_fma(half, t.held, out->elastic_turn);
    if (f.ledger) {
        wide dragged = half * step * dot3(plus3(m->drag, t.drag), state.spin);
        out->lost_friction = out->lost_friction + (t.lost + dragged);
    }
    m->roll = t.roll;
    m->drag = t.drag;
    return t.strain;
}

// what a patch takes of the room for a stable step: along D, what its pairs differ by, sliding and twisting
DEM_INLINE wide soft_strain(const soft_spot *spot, const soft_side *side, const soft_dashpots *d, wide per_tau,
                            wide share, wide spread)
{
    wide h = wide_all(spot->next_step), two = wide_all(2);
    wide tangent = wide_fma(d->arm2, side->quick, two * side->brisk);
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
    soft_result out = {zero, none, none, zero, zero, zero, zero, zero, zero, zero, zero, zero};
    wide_mask on = wide_less(zero, s->depth);
    wide inverse = f.local_mass ? s->share_a + s->share_b : p->a.inverse_mass + p->b.inverse_mass;
    inverse = wide_select(wide_less(wide_all(DEM_SOFT_HEAVIEST), inverse), inverse, wide_all(DEM_SOFT_HEAVIEST));
    double step = spot->last_step > 0 ? spot->last_step : spot->next_step;
    soft_dashpots d = {
        .mass = contact_mass_of(f, inverse), .uneven = zero, .slide = zero, .slide_damping = zero, .arm2 = zero};
    normal_law normal = normal_elastic(f, spot->law, NULL, s->depth, spot->reduced, spot->area);
    normal_damp(f, spot->law, &spot->step, &normal, &d.mass, s->depth, s->speed);
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
        wide grip = wide_abs(out.net) * s->along, rate = dot3(minus3(p->b.spin, p->a.spin), s->n);
        wide turning = twist(f, spot, s, &d, grip, rate, m, &out);
        out.force = plus3(out.force, drag);
        out.moment = plus3(out.moment, along3(cross3(s->point, drag), turning, s->n));
    }
    wide turn_strain = zero;
    if (f.rolling || f.roll_constant || f.twist_constant)
        turn_strain = soft_turning(f, spot, p, s, &normal, m, &out);
    if (f.roll_bound)
        out.bound = spot->law[LAW_ROLL_BOUND] * wide_min(spot->radius_a, spot->radius_b) * wide_abs(out.net) * s->along;
    if (spot->parted)
        d.stiffness = d.stiffness * spot->stiffening;
    if (f.watch) {
        wide per_tau = wide_max(out.net, d.elastic) * wide_all(1 / spot->tau);
        out.strain_a = soft_strain(spot, &p->a, &d, per_tau, s->share_a, s->spread_a);
        out.strain_b = soft_strain(spot, &p->b, &d, per_tau, s->share_b, s->spread_b);
        wide times = wide_all(spot->wall ? 1 : 2) * turn_strain;
        out.strain_a = wide_fma(times, p->a.quick, out.strain_a);
        out.strain_b = wide_fma(times, p->b.quick, out.strain_b);
    }
    if (f.reaction)
        out.hardness =
            wide_or_zero(on, wide_fma(d.damping, wide_all(1 / step), d.stiffness));
    return out;
}

#endif
