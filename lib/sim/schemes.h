/// The schemes of integration by name, and what each of them keeps.
///
/// *Half*: velocities stand half a step before the positions, and the first kick is one half; else both are of one time
/// and every kick is whole. *Share*: how much of a step goes by the velocity behind the kick, the rest by the one
/// before.
#ifndef DEM_SIM_SCHEMES_H
#define DEM_SIM_SCHEMES_H

#include "dem/scene.h"

#define DEM_TRANSLATIONS(X)                                                                                            \
    X(CENTRAL, "central", true, 1, "central differences, order 2")                                                     \
    X(SYMPLECTIC_EULER, "symplectic-euler", false, 1, "symplectic Euler, order 1")                                     \
    X(VELOCITY_VERLET, "velocity-verlet", true, 1, "velocity Verlet, order 2, which steps as central differences do")  \
    X(TAYLOR, "taylor", false, 0.5, "Taylor, order 1 in the velocity, which feeds energy in")                          \
    X(FORWARD_EULER, "forward-euler", false, 0, "forward Euler, order 1, which feeds energy in")                       \
    X(NEWMARK, "newmark", true, 1, "explicit Newmark, order 2, which steps as central differences do")

/// The number is how much longer than in the kernels' own loop the motion of a body takes, measured with AVX-512.
#define DEM_ROTATIONS(X)                                                                                               \
    X(LSYM, "lsym", true, 18, "order 2, keeps L")                                                                      \
    X(LSYM4, "lsym4", true, 80, "order 4 where no moment acts, else 2, keeps L")                                       \
    X(SPIRAL, "spiral", true, 9, "order 2, energy drifts")                                                             \
    X(NO_SQUISH, "no-squish", true, 16, "order 2, keeps L")                                                            \
    X(OMELYAN, "omelyan", true, 9, "order 2, energy drifts slowly")                                                    \
    X(FINCHAM, "fincham", true, 7, "order 2, energy drifts")                                                           \
    X(WALTON_BRAUN, "walton-braun", true, 6, "order 2, energy drifts")                                                 \
    X(PCDM, "pcdm", false, 10, "order 2, with moments 1, energy drifts")

typedef struct dem_scheme {
    const char *name;
    bool half;
    double number;  ///< share of a translation, cost of a rotation
    const char *about;
} dem_scheme;

#define SCHEME(id, name, half, number, about) {name, half, number, about},
static const dem_scheme dem_translations[] = {DEM_TRANSLATIONS(SCHEME)};
static const dem_scheme dem_rotations[] = {DEM_ROTATIONS(SCHEME)};
#undef SCHEME

enum {
    DEM_TRANSLATION_SCHEMES = sizeof dem_translations / sizeof *dem_translations,
    DEM_ROTATION_SCHEMES = sizeof dem_rotations / sizeof *dem_rotations
};

/// Whether the kernels' own loop does it.
static inline bool dem_schemes_default(dem_integrator_def s)
{
    const dem_scheme *t = &dem_translations[s.translation];
    return t->half && !(t->number < 1) && s.rotation == DEM_ROTATION_LSYM;
}

#endif
