/// Laws of contact of your own, at full speed.
///
/// A law is one C function: it is told of a contact, its numbers from the scene and what it remembered, and says which
/// forces act. Write it in a file of its own, end that file with DEM_LAW_PLUGIN, and compile it into a plug-in:
///
///   cc -shared -fPIC -O3 -march=native -mprefer-vector-width=512 -fopenmp-simd -ffp-contract=off -fno-math-errno
///      -fno-trapping-math $(pkg-config --cflags dem-law) -o mylaw.so mylaw.c
///
/// (in a source tree -I lib/include -I lib stand for pkg-config's). A scene names it in place of a law, with its
/// numbers by their names, and its path relative to the scene: "normal": { "plugin": "mylaw.so", "stiffness": 1e5 }.
///
/// The plug-in is the loop over contacts with your function inside, made into vector code by the compiler. It stays so
/// if the function is plain arithmetic with sqrt and `a ? b : c`; loops of a fixed small count and short `if`s are
/// fine. -ffp-contract=off makes all instruction sets give the same bits; -march says which machines can run the file.
/// tests/examples/law_*.c are examples.
#ifndef DEM_LAW_H
#define DEM_LAW_H

#include <math.h>

#include "dem/base.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    DEM_LAW_ABI = 1,
    DEM_LAW_PARAMETERS = 32,  ///< numbers that a law can have
    DEM_LAW_VECTORS = 4,      ///< and remember of each contact: vectors
    DEM_LAW_NUMBERS = 8,      ///< and numbers
};

/// What the law is told.
typedef struct dem_law_contact {
    double overlap;             ///< below 0: a gap [m]
    double overlap_before;      ///< a step ago [m]
    dem_vec3 normal;            ///< unit, out of the first surface
    double vn;                  ///< velocity of separation, half a step ago [m/s]
    dem_vec3 slip;              ///< tangential velocity of the second surface over the first [m/s]
    dem_vec3 spin;              ///< angular velocity of the second body over the first [rad/s] (with .turns)
    double radius_a, radius_b;  ///< of the spheres; INFINITY: a wall [m]
    double reduced;             ///< R* = R_a R_b / (R_a + R_b), of a wall R_a [m]
    double mass;                ///< effective mass, by the scene's effective_mass [kg]
    double step, next_step;     ///< time since the last step, 0 at the start; time to the next [s]
    double inverse_mass;        ///< 1 / mass [1/kg]
} dem_law_contact;

/// What it remembers from step to step: all 0 where a contact begins. Vectors are turned with the contact: into the
/// plane normal to the normal at their length, then with the two bodies about it.
typedef struct dem_law_memory {
    dem_vec3 vector[DEM_LAW_VECTORS];
    double number[DEM_LAW_NUMBERS];
} dem_law_memory;

/// What it says.
typedef struct dem_law_forces {
    double push;             ///< normal force, above 0: apart [N]
    dem_vec3 slide;          ///< tangential force on the first body [N]
    dem_vec3 moment;         ///< on the first body, beside those of the forces [N m] (with .turns)
    bool holds;              ///< surfaces that do not touch hold on to each other (laws that reach)
    double stored;           ///< elastic energy that the contact holds now [J]
    double slid;             ///< dissipated by sliding since the last step; all else that is lost is called viscous [J]
    double stiffness;        ///< dF_n / d(overlap), for the automatic step [N/m]
    double damping;          ///< -dF_n / d(vn) [N s/m]
    double slide_stiffness;  ///< of the tangential spring [N/m]
    double slide_damping;    ///< [N s/m]
    double turn_stiffness;   ///< of moments, the largest [N m/rad]
    double turn_damping;     ///< [N m s]
} dem_law_forces;

/// A number of the law.
typedef struct dem_law_parameter {
    const char *name;    ///< key of the scene
    const char *unit;    ///< SI unit, as "N/m"; NULL: a pure number
    double fallback;     ///< value where the scene has none; NAN: the scene must have it
    double least, most;  ///< bounds; 0 and 0: any
} dem_law_parameter;

/// What a plug-in says of itself.
typedef struct dem_law_spec {
    const char *name;
    uint32_t version;  ///< checkpoints of another version are refused
    const dem_law_parameter *parameters;
    uint32_t parameter_count;
    uint8_t vectors, numbers;  ///< that it remembers
    bool turns;                ///< it has moments, or asks for the spin
} dem_law_spec;

typedef dem_law_forces dem_law_function(const dem_law_contact *contact, const double *parameters,
                                        dem_law_memory *memory);
/// How far beyond the touch contacts may hold [m].
typedef double dem_law_reach_function(const double *parameters, double reduced);

/// What a plug-in exports, as `dem_law_plugin`.
typedef struct dem_law_table {
    uint32_t abi, sizes;   ///< DEM_LAW_ABI; of what loops and engine share
    const char *made_for;  ///< DEM_VERSION
    const char *level;     ///< instruction set: "plain", "v3" or "v4" of x86-64
    const dem_law_spec *spec;
    dem_law_function *law;
    dem_law_reach_function *reach;  ///< NULL: contacts end where surfaces part
    const void *instances;
    size_t instance_count;
} dem_law_table;

// ---- small things for laws

static inline double dem_law_least(double a, double b)
{
    return a < b ? a : b;
}
static inline double dem_law_most(double a, double b)
{
    return a > b ? a : b;
}
static inline double dem_law_dot(dem_vec3 a, dem_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline dem_vec3 dem_law_scaled(dem_vec3 a, double s)
{
    dem_vec3 r = {a.x * s, a.y * s, a.z * s};
    return r;
}
/// a + s b
static inline dem_vec3 dem_law_along(dem_vec3 a, double s, dem_vec3 b)
{
    dem_vec3 r = {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
    return r;
}
/// The part of a that is normal to the unit vector n.
static inline dem_vec3 dem_law_across(dem_vec3 a, dem_vec3 n)
{
    return dem_law_along(a, -dem_law_dot(a, n), n);
}
/// Whether a vector is longer than `most`.
static inline bool dem_law_longer(dem_vec3 a, double most)
{
    return most * most < dem_law_dot(a, a);
}
/// By how much to shorten a vector so that it is no longer than `most`: 1 or less.
static inline double dem_law_cap(dem_vec3 a, double most)
{
    // nothing costly stands behind a question: that would keep the loop from being made into vector code
    double part = most / sqrt(dem_law_dot(a, a) + 1e-300);
    return part < 1 ? part : 1;
}

/// What a normal dashpot adds to the push, of second order in the step as those of the built-in laws are. `cut`: the
/// law cuts the push at 0.
static inline double dem_law_dashpot(const dem_law_contact *c, double damping, bool cut)
{
    double per_step = 1 / (c->step > 0 ? c->step : c->next_step), gone = c->overlap * per_step, speed = fabs(c->vn);
    double acts = dem_law_least(1.5 * gone, dem_law_most(speed, 2 * speed - 0.5 * gone));
    double leaves = cut ? c->vn : acts;
    acts = c->vn < 0 ? -acts : leaves;
    return -damping / (1 + 0.25 * c->step * (damping * c->inverse_mass)) * acts;
}

#ifdef __cplusplus
}
#endif

// ---- the end of a plug-in's file

// the engine itself needs no loops, nor does who only looks at the types
#if !defined(DEM_LAW_TYPES) && !defined(__cplusplus)
#if __has_include("sim/law/user.h")
#include "sim/law/user.h"
#else
#define DEM_LAW_PLUGIN(law, ...) _Static_assert(0, "sim/law/user.h is not found; see dem/law.h for the flags")
#define DEM_LAW_PLUGIN_REACHING(law, reach, ...) DEM_LAW_PLUGIN(law, )
#endif
#endif

#endif
