/// All cases with a known answer, in the order of their table. Each is run by `dem-study verify` and by the tests.
#ifndef DEM_STUDY_VERIFY_H
#define DEM_STUDY_VERIFY_H

#include "study/trial.h"

/// NULL behind the last.
const dem_case *dem_verify_case(size_t index);

/// The parts of the table, each of one file; a part ends with a case without a name.
extern const dem_case dem_verify_chung_ooi[], dem_verify_impacts[], dem_verify_sliding[], dem_verify_rotation[],
    dem_verify_adhesion[], dem_verify_damping[], dem_verify_gas[], dem_verify_whole[], dem_verify_integrators[],
    dem_verify_laws[], dem_verify_soft[], dem_verify_walls[], dem_verify_bonds[], dem_verify_inlets[];

#endif
