/// The mass of a clump shared out among its spheres, for programs that sum over them.
#ifndef DEM_OUT_MASS_SHARES_H
#define DEM_OUT_MASS_SHARES_H

#include "dem/clump.h"

/// What a plain sum over solid balls of these masses has in common with the clump; each includes those before it.
typedef enum dem_shares_meet {
    DEM_SHARES_MASS,
    DEM_SHARES_CENTRE,   ///< the centre of mass too
    DEM_SHARES_INERTIA,  ///< the tensor of inertia too
} dem_shares_meet;

/// Masses [kg] of the spheres, all above 0, as near to the spheres' volumes as meeting the most allows.
dem_status dem_mass_shares(const dem_clump_def *clump, double *masses, dem_shares_meet *meet, dem_error *error);

#endif
