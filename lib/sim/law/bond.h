/// Surfaces that are bonded until the bond breaks: springs along and across the normal that hold both ways, up to a
/// largest pull and a largest tangential force (contact bonds of Potyondy & Cundall 2004). Both forces are in
/// proportion to the whole displacement since the bond was made. A contact whose bond has broken is one of friction; it
/// may be bonded anew once the surfaces have parted.
#ifndef DEM_SIM_LAW_BOND_H
#define DEM_SIM_LAW_BOND_H

#include "sim/law/friction.h"

typedef struct bond_law {
    wide_mask holds;  ///< now
    wide_mask on;     ///< the surfaces hold or touch
    wide state;       ///< afterwards: 1 bonded, -1 broken and not parted yet, 0 neither
    wide released;    ///< energy of normal springs that went with their bonds [J]
} bond_law;

/// `state`: that of the step before; `spring` has been turned; `first`: the step in which bonds are made at the start.
/// What the tangential spring held is let go by friction().
DEM_INLINE bond_law bond(const wide *law, const normal_law *n, wide state, wide reduced, wide overlap, wide vn,
                         wide3 spring, wide3 slip, wide step, const bool first)
{
    wide zero = wide_all(0), one = wide_all(1), shear = law[LAW_BOND_SHEAR];
    wide_mask touches = wide_less(zero, overlap);
    // surfaces that were placed to touch may be a rounding apart
    wide gap = first ? wide_fma(wide_all(1e-9), reduced, law[LAW_BOND_GAP]) : wide_all(-INFINITY);
    wide_mask made = wide_and(touches, wide_less(wide_abs(state), law[LAW_BOND_AGAIN]));
    made = wide_either(made, wide_less(zero - gap, overlap));
    wide_mask bonded = wide_either(made, wide_less(zero, state));
    spring = along3(spring, step, slip);
    wide stiffness = wide_fma(law[LAW_SLIDE_RATIO], n->stiffness, law[LAW_SLIDE_STIFFNESS]);
    wide_mask bears = wide_less_equal(zero - n->elastic, law[LAW_BOND_TENSION]);
    bears = wide_and(bears, wide_less_equal(stiffness * stiffness * dot3(spring, spring), shear * shear));
    bond_law b = {.holds = wide_and(bonded, bears)};
    b.on = wide_either(touches, b.holds);
    wide_mask marked = wide_and(touches, wide_either(bonded, wide_less(zero, wide_abs(state))));
    b.state = wide_select(b.holds, one, wide_or_zero(marked, zero - one));
    // with the force of the step before to the middle of the two, and none from there on
    wide gone = wide_all(0.5) * n->elastic * wide_fma(vn, step, overlap);
    b.released = wide_select(b.on, zero, wide_or_zero(bonded, gone));
    return b;
}

#endif
