/// The loops of a plug-in: those of contact.h with a law of the user's (dem/law.h) in plain C, which the compiler makes
/// into vector code. Rows come in and go out as with built-in laws, so it costs what those cost.
#ifndef DEM_SIM_LAW_USER_H
#define DEM_SIM_LAW_USER_H

#include "dem/law.h"

// said by DEM_LAW_PLUGIN at the end of the file
static inline dem_law_forces dem_user_law(const dem_law_contact *contact, const double *parameters,
                                          dem_law_memory *memory);
static inline double dem_user_reach(const double *parameters, double reduced);

#define DEM_USER_LAW
#include "sim/contact.h"

static inline double dem_user_no_reach(const double *parameters, double reduced)
{
    (void)parameters;
    (void)reduced;
    return 0;
}

#define USER_KERNELS_OF(name, ...)                                                                                     \
    static __attribute__((flatten)) void name##_pairs(dem_features given, const dem_rows *rows,                        \
                                                      const dem_contact_job *job)                                      \
    {                                                                                                                  \
        (void)given;                                                                                                   \
        contact_batches(USER_FEATURES(__VA_ARGS__), rows, job, false, DEM_FORM_PLANE, false);                          \
    }                                                                                                                  \
    static __attribute__((flatten)) void name##_planes(dem_features given, const dem_rows *rows,                       \
                                                       const dem_contact_job *job)                                     \
    {                                                                                                                  \
        (void)given;                                                                                                   \
        contact_batches(USER_FEATURES(__VA_ARGS__), rows, job, true, DEM_FORM_PLANE, false);                           \
    }
#define USER_FEATURES(...)                                                                                             \
    ((dem_features){.user = true,                                                                                      \
                    .user_reaches = dem_user_reaches,                                                                  \
                    .user_turns = dem_user_spec.turns,                                                                 \
                    .user_vectors = dem_user_spec.vectors,                                                             \
                    .user_numbers = dem_user_spec.numbers,                                                             \
                    __VA_ARGS__})
#define USER_ENTRY(name, ...)                                                                                          \
    {#name, {.user = true, __VA_ARGS__}, false, name##_pairs, {name##_planes, user_cylinders, user_meshes}},

// what people run, as of the built-in laws
#ifdef DEM_FEW_KERNELS
#define USER_INSTANCES(X)
#else
#define USER_INSTANCES(X)                                                                                              \
    X(user_spheres, .local_mass = true, .ledger = true)                                                                \
    X(user_clumps, .local_mass = true, .ledger = true, .offset = true)                                                 \
    X(user_spheres_auto, .local_mass = true, .ledger = true, .watch = true)                                            \
    X(user_sizes, .local_mass = true, .ledger = true, .offset = true, .scaled = true)                                  \
    X(user_clumps_auto, .local_mass = true, .ledger = true, .offset = true, .watch = true)                             \
    X(user_sizes_auto, .local_mass = true, .ledger = true, .offset = true, .scaled = true, .watch = true)
#endif

#define USER_ANY(name, wall, form)                                                                                     \
    static __attribute__((flatten)) void name(dem_features given, const dem_rows *rows, const dem_contact_job *job)    \
    {                                                                                                                  \
        dem_features f = given;                                                                                        \
        f.user = true;                                                                                                 \
        f.user_reaches = dem_user_reaches;                                                                             \
        f.user_turns = dem_user_spec.turns;                                                                            \
        f.user_vectors = dem_user_spec.vectors;                                                                        \
        f.user_numbers = dem_user_spec.numbers;                                                                        \
        contact_batches(f, rows, job, wall, form, job->records);                                                       \
    }

#define DEM_LAW_PLUGIN_OF(function, reach_function, reaches, ...)                                                      \
    static const dem_law_spec dem_user_spec = {__VA_ARGS__};                                                           \
    enum { dem_user_reaches = reaches };                                                                               \
    /* or it would be called, lane by lane */                                                                          \
    static inline __attribute__((always_inline)) dem_law_function function;                                            \
    static inline dem_law_forces dem_user_law(const dem_law_contact *c, const double *parameters, dem_law_memory *m)   \
    {                                                                                                                  \
        return function(c, parameters, m);                                                                             \
    }                                                                                                                  \
    static inline double dem_user_reach(const double *parameters, double reduced)                                      \
    {                                                                                                                  \
        return reach_function(parameters, reduced);                                                                    \
    }                                                                                                                  \
    USER_ANY(user_pairs, false, DEM_FORM_PLANE)                                                                        \
    USER_ANY(user_planes, true, DEM_FORM_PLANE)                                                                        \
    USER_ANY(user_cylinders, true, DEM_FORM_CYLINDER)                                                                  \
    USER_ANY(user_meshes, true, DEM_FORM_MESH)                                                                         \
    USER_INSTANCES(USER_KERNELS_OF)                                                                                    \
    static const dem_contact_instance dem_user_instances[] = {USER_INSTANCES(USER_ENTRY){                              \
        "user_any", {.user = true}, true, user_pairs, {user_planes, user_cylinders, user_meshes}}};                    \
    extern const dem_law_table dem_law_plugin;                                                                         \
    DEM_API const dem_law_table dem_law_plugin = {                                                                     \
        .abi = DEM_LAW_ABI,                                                                                            \
        .sizes = DEM_USER_SIZES,                                                                                       \
        .made_for = DEM_LAW_MADE_FOR,                                                                                  \
        .level = DEM_WIDTH == 8   ? "v4"                                                                               \
                 : DEM_WIDTH == 4 ? "v3"                                                                               \
                                  : "plain",                                                                           \
        .spec = &dem_user_spec,                                                                                        \
        .law = function,                                                                                               \
        .reach = reaches ? reach_function : NULL,                                                                      \
        .instances = dem_user_instances,                                                                               \
        .instance_count = sizeof dem_user_instances / sizeof *dem_user_instances,                                      \
    }

#ifndef DEM_LAW_MADE_FOR
#define DEM_LAW_MADE_FOR DEM_VERSION
#endif

/// `law`: a dem_law_function; then the members of dem_law_spec.
#define DEM_LAW_PLUGIN(law, ...) DEM_LAW_PLUGIN_OF(law, dem_user_no_reach, false, __VA_ARGS__)
/// The same of a law that may hold surfaces beyond the touch; `reach`: a dem_law_reach_function.
#define DEM_LAW_PLUGIN_REACHING(law, reach, ...) DEM_LAW_PLUGIN_OF(law, reach, true, __VA_ARGS__)

#endif
