/// Friction: a tangential spring that follows the contact, with a dashpot and Coulomb's cap. The spring's length is the
/// history of the contact; linear (Cundall & Strack 1979) or Mindlin's no-slip stiffness with the unloading correction
/// (Thornton, Cummins & Cleary 2013).
#ifndef DEM_SIM_LAW_FRICTION_H
#define DEM_SIM_LAW_FRICTION_H

#include "sim/law/normal.h"

typedef struct wide3 {
    wide x, y, z;
} wide3;

DEM_INLINE wide dot3(wide3 a, wide3 b)
{
    return wide_fma(a.z, b.z, wide_fma(a.y, b.y, a.x * b.x));
}
/// a + s b
DEM_INLINE wide3 along3(wide3 a, wide s, wide3 b)
{
    return (wide3){wide_fma(s, b.x, a.x), wide_fma(s, b.y, a.y), wide_fma(s, b.z, a.z)};
}
/// a - s b
DEM_INLINE wide3 against3(wide3 a, wide s, wide3 b)
{
    return (wide3){wide_fnma(s, b.x, a.x), wide_fnma(s, b.y, a.y), wide_fnma(s, b.z, a.z)};
}
/// |a|^2 + 1e-300, which has a root that can be divided by.
DEM_INLINE wide square3(wide3 a)
{
    return wide_fma(a.z, a.z, wide_fma(a.y, a.y, wide_fma(a.x, a.x, wide_all(1e-300))));
}
DEM_INLINE wide3 scale3(wide3 a, wide s)
{
    return (wide3){a.x * s, a.y * s, a.z * s};
}
DEM_INLINE wide3 cross3(wide3 a, wide3 b)
{
    return (wide3){wide_fms(a.y, b.z, a.z * b.y), wide_fms(a.z, b.x, a.x * b.z), wide_fms(a.x, b.y, a.y * b.x)};
}
DEM_INLINE wide3 select3(wide_mask m, wide3 a, wide3 b)
{
    return (wide3){wide_select(m, a.x, b.x), wide_select(m, a.y, b.y), wide_select(m, a.z, b.z)};
}
DEM_INLINE wide3 or_zero3(wide_mask m, wide3 a)
{
    return (wide3){wide_or_zero(m, a.x), wide_or_zero(m, a.y), wide_or_zero(m, a.z)};
}

/// Turns the spring with the contact: into the plane normal to n at its old length, then by `turn` [rad] about n.
DEM_INLINE wide3 spring_turn(wide3 spring, wide3 n, wide turn)
{
    wide before = dot3(spring, spring);
    spring = against3(spring, dot3(spring, n), n);
    wide after = dot3(spring, spring);
    // |before| / |after|; nothing is left of a spring that stood along n
    wide stretch = before * wide_rsqrt(wide_fma(before, after, wide_all(1e-300)));
    spring = scale3(spring, wide_or_zero(wide_less(wide_all(0), after), stretch));
    return along3(spring, turn, cross3(n, spring));
}

/// Friction coefficient at a tangential velocity.
DEM_INLINE wide friction_coefficient(const dem_features f, const wide *law, wide3 slip)
{
    if (!f.decay)
        return law[LAW_FRICTION];
    wide falls = wide_all(0) - law[LAW_FRICTION_DECAY] * wide_sqrt(dot3(slip, slip));
    return wide_fma(law[LAW_FRICTION_MORE], wide_exp(falls), law[LAW_FRICTION]);
}

/// What friction would be without its cap, and what the cap leaves of it.
typedef struct friction_trial {
    wide3 slip;       ///< tangential velocity of the second surface over the first [m/s]
    wide3 start;      ///< spring, turned with the contact [m]
    wide3 stretched;  ///< the same with the slip of the step [m]
    wide3 force;      ///< on the first body, without the cap [N]
    wide part;        ///< that the cap leaves of the force; below 1 the contact slides [-]
    wide cap2;        ///< square of the cap [N^2]
    wide stiffness, old_stiffness, damping;  ///< of the spring, now and a step ago, and of the dashpot [N/m, N s/m]
} friction_trial;

/// `spring` has been turned; `vn` is the velocity of separation [m/s]. Where surfaces are `bonded`, there is no cap.
DEM_INLINE friction_trial friction_try(const dem_features f, const wide *law, const law_step *s, const normal_law *n,
                                       wide reduced, wide overlap, wide vn, const contact_mass *mass, wide3 spring,
                                       wide3 slip, wide_mask bonded)
{
    friction_trial t = {.slip = slip, .start = spring, .damping = wide_all(0)};
    t.stiffness = t.old_stiffness = law[LAW_SLIDE_STIFFNESS] + law[LAW_SLIDE_RATIO] * n->stiffness;
    if (f.mindlin) {
        wide old_radius = radius_before(f, n, reduced, overlap, overlap + vn * s->step);
        wide kept = old_radius * n->per_radius;
        if (f.jkr)
            kept = old_radius / wide_max(n->radius, wide_all(1e-300));
        t.stiffness = t.stiffness + law[LAW_SLIDE_HERTZ] * n->radius;
        t.old_stiffness = t.old_stiffness + law[LAW_SLIDE_HERTZ] * old_radius;
        spring = scale3(spring, wide_max(law[LAW_KEEP_LEAST], wide_min(law[LAW_KEEP_MOST], kept)));
    }
    t.stretched = along3(spring, s->step, slip);
    // of the spring as it will be, which need not be waited for
    wide more = t.stiffness * s->step;
    if (f.slide_damping) {
        if (f.rate)
            t.damping = law[LAW_SLIDE_RATE] * mass->mass;
        wide zeta = s->slide_zeta, inverse;
        if (f.restitution && !alike(f))
            zeta = law[LAW_SLIDE_ZETA] * wide_root(t.stiffness, &inverse);
        if (f.restitution)
            t.damping = wide_fma(zeta, mass->root, t.damping);
        more = more + t.damping;
    }
    t.force = along3(scale3(spring, t.stiffness), more, slip);
    wide size2 = square3(t.force), cap = friction_coefficient(f, law, slip) * normal_grip(f, n);
    if (f.bonded)
        cap = wide_select(bonded, wide_all(1e150), cap);
    // as much more as the size has, so that nothing does not slide
    t.cap2 = wide_fma(cap, cap, wide_all(1e-300));
    t.part = wide_select(wide_less(t.cap2, size2), cap * wide_rsqrt(size2), wide_all(1));
    return t;
}

typedef struct friction_law {
    wide3 force;   ///< on the first body [N]
    wide3 spring;  ///< its length afterwards [m]
    wide3 dash;    ///< what of the force is not the spring's [N] (ledger)
    wide lost;     ///< dissipated by sliding since the last step [J] (ledger)
} friction_law;

DEM_INLINE friction_law friction(const dem_features f, const wide *law, const law_step *s, const friction_trial *t,
                                 wide_mask on)
{
    wide zero = wide_all(0), stiffness = t->stiffness, per_stiffness = s->per_slide;
    if (!alike(f))
        per_stiffness = wide_all(1) / stiffness;
    wide3 force = scale3(t->force, t->part), left = force;
    if (f.slide_damping) {
        // What the spring keeps. With a restitution all it has: a dashpot behind a slider sees no slip. With a rate
        // what the dashpot leaves of the cap (as LAMMPS does). Beyond the cap, the capped force.
        wide3 own = scale3(t->stretched, stiffness), rest = against3(force, t->damping, t->slip);
        left = !f.rate ? own : !f.restitution ? rest : select3(wide_less(zero, law[LAW_SLIDE_RATE]), rest, own);
        left = select3(wide_less(t->cap2, dot3(left, left)), force, left);
    }
    wide3 spring = select3(wide_less(t->part, wide_all(1)), scale3(left, per_stiffness), t->stretched);
    wide3 none = {zero, zero, zero};
    friction_law result = {or_zero3(on, force), or_zero3(on, spring), none, zero};
    if (f.ledger) {
        // work of the mean force over the slip, less what the spring holds more than before
        if (f.mindlin) {
            wide3 both = along3(scale3(result.spring, stiffness), t->old_stiffness, t->start);
            wide held = stiffness * dot3(result.spring, result.spring) - t->old_stiffness * dot3(t->start, t->start);
            result.lost = wide_all(0.5) * (s->step * dot3(both, t->slip) - held);
        } else {
            // the same for one stiffness: nothing where the spring has kept all
            wide3 both = along3(result.spring, wide_all(1), t->start);
            wide3 gone = against3(t->stretched, wide_all(1), result.spring);
            result.lost = wide_all(0.5) * stiffness * dot3(both, gone);
        }
        // while sliding, the dashpot has only what the cap leaves to it
        if (f.slide_damping)
            result.dash = or_zero3(on, against3(force, stiffness, spring));
    }
    return result;
}

#endif
