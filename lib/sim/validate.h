/// The slow truth: what the lists must hold, found by comparing every sphere with every other. For tests.
#ifndef DEM_SIM_VALIDATE_H
#define DEM_SIM_VALIDATE_H

#include "sim/state.h"

typedef struct dem_truth {
    size_t contacts,
        walls;       ///< overlapping sphere pairs of different bodies (over all images), spheres in planes or cylinders
    size_t missed;   ///< of both, those that are not listed
    size_t doubled;  ///< listed more than once
    size_t unsound;  ///< rows, places or sums of the structures that contradict each other
} dem_truth;

dem_status dem_world_validate(const dem_world *world, dem_truth *truth, dem_error *error);

#endif
