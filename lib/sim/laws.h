/// The laws of a scene as the kernels take them.
#ifndef DEM_SIM_LAWS_H
#define DEM_SIM_LAWS_H

#include <math.h>

#include "dem/scene.h"
#include "sim/features.h"
#include "sim/plugin.h"

/// Marks a pair of materials that has no law.
#define DEM_NO_LAW UINT32_MAX

typedef struct dem_laws {
    double *rows;     ///< [LAW_SLOTS a law], on 64-byte boundaries
    size_t count;     ///< different rows; equal ones are one
    double *parameters;  ///< [DEM_LAW_PARAMETERS a law] of the user's; NULL: no law is
    dem_plugin plugin;   ///< their plug-in
    uint32_t *table;  ///< [materials * materials] row, or DEM_NO_LAW
    size_t material_count;
    dem_features needs;  ///< of all laws together
    bool damped;         ///< some have dashpots
} dem_laws;

/// Takes the laws between materials that can meet. Errors: DEM_BAD_INPUT where a number is missing.
dem_status dem_laws_create(const dem_scene *scene, dem_laws *laws, dem_error *error);
void dem_laws_release(dem_laws *laws);

static inline const double *laws_between(const dem_laws *laws, uint32_t a, uint32_t b)
{
    uint32_t row = laws->table[a * laws->material_count + b];
    return row == DEM_NO_LAW ? NULL : laws->rows + (size_t)LAW_SLOTS * row;
}

/// Normal stiffness of a contact [N/m]. `area_length`: R_min^2 / (R_i + R_j); `radius`: sqrt(R* overlap) [m].
static inline double law_stiffness(const double *law, double area_length, double radius)
{
    return law[LAW_STIFFNESS] + law[LAW_YOUNG] * area_length + law[LAW_HERTZ] * radius;
}

/// How far beyond the touch it may hold, of JKR 3/4 k (k/4)^(1/3) R* [m]. `reduced`: R* [m].
static inline double law_reach(const double *law, double reduced)
{
    double k = law[LAW_JKR] > 0 ? sqrt(2 * law[LAW_JKR] / (law[LAW_HERTZ] * reduced)) : 0;
    return 0.75 * k * cbrt(k / 4) * reduced;
}

/// How far beyond the touch a bond may hold [m]. `area_length` as above, at least.
static inline double law_bond_reach(const double *law, double area_length)
{
    if (!(law[LAW_BOND_GAP] >= 0))
        return 0;
    double stretch = law[LAW_BOND_TENSION] / law_stiffness(law, area_length, 0);
    return stretch > law[LAW_BOND_GAP] ? stretch : law[LAW_BOND_GAP];
}

/// The same of a row that is a law of the user's.
static inline double law_user_reach(const dem_laws *laws, size_t row, double reduced)
{
    bool user = laws->plugin.table && laws->plugin.table->reach && laws->rows[LAW_SLOTS * row + LAW_USER] > 0;
    return user ? laws->plugin.table->reach(laws->parameters + DEM_LAW_PARAMETERS * row, reduced) : 0;
}

/// Its contact radius where it bears nothing, of JKR (9 pi w R*^2 / (2 E*))^(1/3) [m].
static inline double law_radius_at_rest(const double *law, double reduced)
{
    return law[LAW_JKR] > 0 ? cbrt(4.5 * law[LAW_JKR] * reduced * reduced / law[LAW_HERTZ]) : 0;
}

/// Stiffness of its rolling spring [N m/rad]; `reduced`: R* [m], `normal` its normal stiffness.
static inline double law_roll_stiffness(const double *law, double reduced, double normal)
{
    return law[LAW_ROLL_RATIO] * reduced * reduced * normal + law[LAW_ROLL_STIFFNESS];
}

/// Its tangential stiffness [N/m].
static inline double law_slide_stiffness(const double *law, double area_length, double radius)
{
    return law[LAW_SLIDE_STIFFNESS] + law[LAW_SLIDE_RATIO] * law_stiffness(law, area_length, radius) +
           law[LAW_SLIDE_HERTZ] * radius;
}

#endif
