/// Soft adhesive spheres (Johnson, Kendall & Roberts 1971), without the approximation of a contact radius that follows
/// from the overlap as without adhesion. Surfaces jump together where they touch, and hold on to each other up to an
/// overlap below 0.
///
/// In units of R*, with k = sqrt(2 pi w / (E* R*)) and s = sqrt(a / R*) of a contact of radius a:
///   overlap = s^4 - k s,  force = E* R*^2 (4/3 s^6 - 2 k s^3),  energy = E* R*^3 (8/15 s^10 - 4/3 k s^7 + k^2 / 2 s^4)
/// They part where the overlap is least, at s^3 = k / 4.
#ifndef DEM_SIM_LAW_JKR_H
#define DEM_SIM_LAW_JKR_H

#include "base/simd.h"

/// x^(1/3) of 0 <= x < 1e6: square roots come near it from above, Newton's method does the rest.
DEM_INLINE wide cube_root(wide x)
{
    wide a = wide_sqrt(wide_sqrt(x)), b = wide_sqrt(wide_sqrt(a)), c = wide_sqrt(wide_sqrt(b));
    wide root = wide_all(1.02) * (a * b) * (c * wide_sqrt(wide_sqrt(c)));
    for (int i = 0; i < 5; i++)
        root = wide_fma(root, wide_all(2), x / wide_max(root * root, wide_all(1e-300))) * wide_all(1.0 / 3);
    return root;
}

/// What a contact's surfaces make of it, whatever the overlap.
typedef struct jkr_pair {
    wide modulus, reduced;  ///< E* [Pa], R* [m]
    wide softness;          ///< k
    wide least, end;        ///< s where they part, and the overlap there [R*]
} jkr_pair;

/// `pull`: 2 pi w [N/m].
DEM_INLINE jkr_pair jkr_surfaces(wide pull, wide modulus, wide reduced)
{
    wide k = wide_sqrt(pull / wide_max(modulus * reduced, wide_all(1e-300))), s = cube_root(wide_all(0.25) * k);
    return (jkr_pair){modulus, reduced, k, s, wide_all(-0.75) * k * s};
}

/// The largest s of s^4 - k s = `overlap` by Newton's method, which falls to it from above; where they have parted, the s
/// at which they did.
DEM_INLINE wide jkr_stretch(const jkr_pair *p, wide overlap)
{
    enum { MOST = 60 };
    wide zero = wide_all(0), k = p->softness;
    // k^(1/3) and a little more
    wide s = wide_fma(wide_all(1.5874027), p->least, wide_sqrt(wide_sqrt(wide_max(overlap, zero))));
    wide_mask holds = wide_less(p->end, overlap);
    s = wide_select(holds, s, p->least);
    for (int i = 0; i < MOST; i++) {
        wide cube = s * s * s, slope = wide_fms(wide_all(4), cube, k);
        wide next = s - (s * (cube - k) - overlap) / slope;
        // a lane that has arrived stays as it is, so that it does not depend on the others
        wide_mask falls = wide_and(holds, wide_and(wide_less(zero, slope), wide_less(next, s)));
        if (!wide_bits(falls))
            break;
        s = wide_select(falls, next, s);
    }
    return s;
}

typedef struct jkr_law {
    wide force;   ///< above 0: a push [N]
    wide energy;  ///< [J]
    wide radius;  ///< a [m]
    wide spread;  ///< da / d(overlap) [-]
} jkr_law;

DEM_INLINE jkr_law jkr(const jkr_pair *p, wide s)
{
    wide k = p->softness, reduced = p->reduced;
    wide square = s * s, cube = square * s, k_cube = k * cube, fourth = square * square;
    wide scale = p->modulus * (reduced * reduced);
    wide energy =
        wide_fma(wide_all(8.0 / 15), cube * cube, wide_fma(wide_all(-4.0 / 3), k_cube, wide_all(0.5) * k * k));
    return (jkr_law){scale * wide_fma(wide_all(4.0 / 3), cube * cube, wide_all(-2) * k_cube),
                     scale * reduced * fourth * energy, reduced * square,
                     (s + s) / wide_max(wide_fms(wide_all(4), cube, k), wide_all(1e-300))};
}

#endif
