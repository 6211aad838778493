/// What a scene's contacts need, and the numbers of their laws. Each feature is a constant of the kernel that was made
/// for it, so what is not needed is neither stored nor computed nor branched on.
#ifndef DEM_SIM_FEATURES_H
#define DEM_SIM_FEATURES_H

#include <stdbool.h>

#define DEM_FEATURES(X)                                                                                                \
    X(linear, "a normal stiffness that does not depend on the overlap")                                                \
    X(young, "that stiffness follows from the radii")                                                                  \
    X(hertz, "a normal stiffness that grows with the contact radius")                                                  \
    X(rate, "dashpots by a damping rate")                                                                              \
    X(restitution, "dashpots by a restitution")                                                                        \
    X(cut, "forces that do not pull")                                                                                  \
    X(local_mass, "the mass that the contact sees, not that of the bodies")                                            \
    X(friction, "a tangential spring with a cap, remembered by each contact")                                          \
    X(decay, "friction that falls with the speed")                                                                     \
    X(mindlin, "a tangential stiffness that grows with the contact radius")                                            \
    X(slide_damping, "tangential dashpots")                                                                            \
    X(rolling, "a rolling spring with a cap, remembered by each contact")                                              \
    X(roll_constant, "a constant moment against rolling")                                                              \
    X(roll_bound, "a bound that contacts set to the spin of a body")                                                   \
    X(twisting, "a twisting spring with a cap, remembered by each contact")                                            \
    X(twist_constant, "a constant moment against twisting")                                                            \
    X(sjkr, "cohesion by the area of the overlap")                                                                     \
    X(jkr, "adhesion that deforms the surfaces, remembered by each contact")                                           \
    X(bonded, "surfaces that hold until they break, remembered by each contact")                                       \
    X(dmt, "a constant adhesion")                                                                                      \
    X(user, "a law of the user's")                                                                                     \
    X(user_reaches, "that may hold surfaces beyond the touch")                                                         \
    X(user_turns, "that has moments")                                                                                  \
    X(offset, "spheres away from the centre of their body")                                                            \
    X(scaled, "bodies that scale their shape")                                                                         \
    X(periodic, "images across periodic sides")                                                                        \
    X(mixed, "more than one law")                                                                                      \
    X(weighted, "several contacts of one pair share its force")                                                        \
    X(ledger, "energy that contacts dissipate is summed")                                                              \
    X(soft, "one soft contact for all spheres of a pair of bodies")                                                    \
    X(watch, "contacts tell how near an automatic step is to its limit")                                               \
    X(moving, "walls that move")                                                                                       \
    X(reaction, "forces on walls are kept, for those that follow them")

typedef struct dem_features {
#define FIELD(name, about) bool name;
    DEM_FEATURES(FIELD)
#undef FIELD
    unsigned char user_vectors, user_numbers;  // that it remembers
} dem_features;

enum { DEM_USER_COLUMNS = 20 };  // of what it remembers, at most

/// Whether contacts have moments of their own.
static inline bool features_turning(dem_features f)
{
    return f.rolling || f.roll_constant || f.twisting || f.twist_constant || f.user_turns;
}

/// Those by which a plug-in's kernels are chosen: the others are the plug-in's own.
static inline dem_features features_for_plugin(dem_features f)
{
    f.user_reaches = f.user_turns = false;
    f.user_vectors = f.user_numbers = 0;
    return f;
}

/// The numbers of one law, a row of 32.
typedef enum dem_law_slot {
    LAW_STIFFNESS,        ///< k_n [N/m]
    LAW_YOUNG,            ///< pi E: k_n = pi E R_min^2 / (R_i + R_j) [Pa]
    LAW_HERTZ,            ///< 2 E*: dF/d(overlap) = 2 E* sqrt(R* overlap) [Pa]
    LAW_RATE,             ///< G_n: c_n = m_eff G_n [1/s]
    LAW_ZETA,             ///< z: c_n = z sqrt(stiffness m_eff); 2 zeta, with Hertz 2 sqrt(5/6) zeta [-]
    LAW_FLOOR,            ///< least normal force: 0 where the tail is cut, else -INFINITY [N]
    LAW_SLIDE_STIFFNESS,  ///< k_t [N/m]
    LAW_SLIDE_RATIO,      ///< k_t / k_n, where k_n does not depend on the overlap [-]
    LAW_SLIDE_HERTZ,      ///< 8 G*, or k_t / k_n 2 E*: k_t = this sqrt(R* overlap) [Pa]
    LAW_SLIDE_RATE,       ///< G_t: c_t = m_eff G_t [1/s]
    LAW_SLIDE_ZETA,       ///< z: c_t = z sqrt(k_t m_eff) [-]
    LAW_FRICTION,         ///< coefficient [-]
    LAW_KEEP_LEAST,       ///< bounds of what happens to the spring's length when k_t changes, so that the force stays
    LAW_KEEP_MOST,        ///< (0 to INFINITY), at most stays (0 to 1), or k_t does not change (1 to 1) [-]
    LAW_FRICTION_MORE,    ///< coefficient at rest above that [-]
    LAW_FRICTION_DECAY,   ///< which falls by exp(-this speed) [s/m]
    LAW_MORE = 16,  ///< from here on only with some of the features above
    LAW_ROLL_RATIO = LAW_MORE,  ///< k_r = this k_n R*^2 [-]
    LAW_ROLL_STIFFNESS,         ///< k_r that is given [N m/rad]
    LAW_ROLL_CAP,               ///< coefficient: the spring holds this R* F_n [-]
    LAW_ROLL_ZETA,              ///< z: c_r = z sqrt(k_r I_r), 2 damping ratios [-]
    LAW_ROLL_CONSTANT,          ///< coefficient of the constant moment: this R* F_n [-]
    LAW_ROLL_BOUND,             ///< coefficient of the bound: this R_min F_n [-]
    LAW_TWIST_RATIO,            ///< k_tw = this k_t a^2, c_tw = this c_t a^2 [-]
    LAW_TWIST_CAP,              ///< the spring holds this a F_n [-]
    LAW_TWIST_CONSTANT,         ///< coefficient of the constant moment: this R* F_n [-]
    LAW_ENERGY_DENSITY,         ///< of the overlap's area: pull by this A [Pa]
    LAW_ADHESION,               ///< 2 pi w: pull by this R* [N/m]
    LAW_JKR,                    ///< 2 pi w [N/m]; with E* of LAW_HERTZ
    LAW_BOND_TENSION,           ///< largest pull [N]
    LAW_BOND_SHEAR,             ///< largest tangential force [N]
    LAW_BOND_GAP,               ///< surfaces nearer than this are bonded at the start; -INFINITY: none [m]
    LAW_BOND_AGAIN,             ///< 1: whenever they touch [-]
    LAW_USER,                   ///< 1: a law of the user's, whose numbers stand apart [-]
    LAW_SLOTS = 40
} dem_law_slot;

#endif
