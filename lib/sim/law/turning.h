/// Moments against rolling and twisting of one surface over another: springs with dashpots and caps (rolling: Ai, Chen,
/// Rotter & Ooi 2011, type C; twisting: Marshall 2009), or constant moments (Ai et al., type A). The springs' angles
/// are the history of the contact.
#ifndef DEM_SIM_LAW_TURNING_H
#define DEM_SIM_LAW_TURNING_H

#include "sim/law/friction.h"

/// What the moments depend on.
typedef struct turning_state {
    wide3 n;                                  ///< normal
    wide3 spin;                               ///< of the second body over the first [rad/s]
    wide3 roll;                               ///< angle of the rolling spring, turned with the contact [rad]
    wide twist;                               ///< angle of the twisting spring [rad]
    wide reduced;                             ///< R* [m]
    wide patch, patch_before;                 ///< contact radius, now and a step ago [m]
    wide inverse;                             ///< 1/I_r, of rolling [1/(kg m^2)]
    wide step;                                ///< time since the last step [s]
    wide slide, slide_before, slide_damping;  ///< of friction: stiffness now and a step ago, dashpot [N/m, N s/m]
} turning_state;

typedef struct turning_law {
    wide3 moment;  ///< on the first body [N m]
    wide3 roll;    ///< angles afterwards [rad]
    wide twist;
    wide3 drag;   ///< what of the moment is not the springs' [N m] (ledger)
    wide lost;    ///< dissipated by the caps since the last step [J] (ledger)
    wide held;    ///< twice the energy of the springs [J]
    wide strain;  ///< h^2 k + 2 h c of all directions, see timestep.h [N m s^2]
} turning_law;

DEM_INLINE wide sign_of(wide x)
{
    wide zero = wide_all(0), one = wide_all(1);
    return wide_or_zero(wide_less(zero, x), one) - wide_or_zero(wide_less(x, zero), one);
}

/// A spring whose stiffness follows the overlap takes no energy from an overlap that grows: its moment stays then.
DEM_INLINE wide angle_kept(wide old_stiffness, wide stiffness)
{
    return wide_min(wide_all(1), old_stiffness / wide_max(stiffness, wide_all(1e-300)));
}

DEM_INLINE void roll_spring(const dem_features f, const wide *law, const normal_law *n, const turning_state *s,
                            wide3 rate, wide step, wide_mask on, turning_law *t)
{
    wide ratio = law[LAW_ROLL_RATIO] * (s->reduced * s->reduced), zero = wide_all(0);
    wide stiffness = wide_fma(ratio, n->stiffness, law[LAW_ROLL_STIFFNESS]), old = stiffness;
    wide3 start = s->roll, angle = start;
    if (f.hertz) {
        old = wide_fnma(ratio * law[LAW_HERTZ], n->radius - s->patch_before, stiffness);
        angle = scale3(angle, angle_kept(old, stiffness));
    }
    angle = along3(angle, s->step, rate);
    wide3 moment = scale3(angle, stiffness);
    wide size2 = dot3(moment, moment), cap = law[LAW_ROLL_CAP] * (s->reduced * normal_grip(f, n));
    wide_mask slides = wide_less(cap * cap, size2);
    wide part = wide_select(slides, cap * wide_rsqrt(size2 + wide_all(1e-300)), wide_all(1));
    // a contact that ends lets go of what its springs hold
    moment = or_zero3(on, scale3(moment, part));
    t->roll = or_zero3(on, scale3(angle, part));
    t->held = stiffness * dot3(t->roll, t->roll);
    if (f.ledger) {
        wide3 both = along3(moment, old, start);
        t->lost = wide_all(0.5) * (s->step * dot3(both, rate) - (t->held - old * dot3(start, start)));
    }
    wide damping = law[LAW_ROLL_ZETA] * wide_sqrt(stiffness / s->inverse);
    t->strain = wide_all(2) * (step * wide_fma(step, stiffness, damping + damping));
    // a dashpot behind a slider sees no motion
    t->drag = scale3(rate, wide_select(slides, zero, damping));
    t->moment = moment;
}

DEM_INLINE void twist_spring(const dem_features f, const wide *law, const normal_law *n, const turning_state *s,
                             wide rate, wide step, wide_mask on, turning_law *t)
{
    wide zero = wide_all(0), radius2 = s->patch * s->patch;
    wide stiffness = law[LAW_TWIST_RATIO] * s->slide * radius2;
    wide old = law[LAW_TWIST_RATIO] * s->slide_before * (s->patch_before * s->patch_before);
    wide start = s->twist, angle = wide_fma(s->step, rate, start * angle_kept(old, stiffness));
    wide cap = law[LAW_TWIST_CAP] * (s->patch * normal_grip(f, n));
    wide spring = wide_or_zero(on, wide_max(zero - cap, wide_min(cap, stiffness * angle)));
    wide damping = law[LAW_TWIST_RATIO] * s->slide_damping * radius2;
    wide moment = wide_max(zero - cap, wide_min(cap, wide_fma(damping, rate, spring)));
    t->twist = wide_or_zero(wide_less(zero, stiffness), spring / stiffness);
    wide held = spring * t->twist;
    t->held = t->held + held;
    if (f.ledger)
        t->lost = t->lost + wide_all(0.5) * (s->step * ((spring + old * start) * rate) - (held - old * start * start));
    t->strain = t->strain + step * wide_fma(step, stiffness, damping + damping);
    t->drag = along3(t->drag, moment - spring, s->n);
    t->moment = along3(t->moment, spring, s->n);
}

/// `step`: the one to come [s].
DEM_INLINE turning_law turning(const dem_features f, const wide *law, const normal_law *n, const turning_state *s,
                               wide step, wide_mask on)
{
    wide zero = wide_all(0), twist = dot3(s->spin, s->n);
    wide3 none = {zero, zero, zero}, roll = against3(s->spin, twist, s->n);
    turning_law t = {
        .moment = none, .roll = none, .twist = zero, .drag = none, .lost = zero, .held = zero, .strain = zero};
    if (f.rolling)
        roll_spring(f, law, n, s, roll, step, on, &t);
    if (f.twisting)
        twist_spring(f, law, n, s, twist, step, on, &t);
    wide hold = s->reduced * normal_grip(f, n);
    if (f.roll_constant) {
        wide moment = law[LAW_ROLL_CONSTANT] * hold * wide_rsqrt(square3(roll));
        t.drag = along3(t.drag, wide_or_zero(wide_less(zero, dot3(roll, roll)), moment), roll);
    }
    if (f.twist_constant)
        t.drag = along3(t.drag, law[LAW_TWIST_CONSTANT] * hold * sign_of(twist), s->n);
    t.moment = or_zero3(on, (wide3){t.moment.x + t.drag.x, t.moment.y + t.drag.y, t.moment.z + t.drag.z});
    t.drag = or_zero3(on, t.drag);
    t.strain = wide_or_zero(on, t.strain);
    return t;
}

#endif
