/// The densest random state of grains without friction: a periodic box in which they slowly grow until they bear a
/// pressure.
///
/// Each stage enlarges all grains by so much solid fraction about their centres and lets them find rest, with their
/// speeds taken out by local damping. Stages go on, finer once there is a pressure, until it has reached a small part
/// of the stiffness. Then the grains shrink again, and the solid fraction at which the pressure would be gone is read
/// off the straight line (O'Hern et al. 2003 find the same point by going back and forth). Slower growth gives a
/// little more.
#ifndef DEM_STUDY_JAM_H
#define DEM_STUDY_JAM_H

#include "dem/clump.h"
#include "dem/world.h"

typedef struct dem_jam_def {
    const dem_clump *clump;
    size_t bodies;
    double begin;     ///< solid fraction of the first stage [-]
    double growth;    ///< of a stage, solid fraction before there is a pressure [-]; a tenth of it thereafter
    size_t steps;     ///< of a stage
    double pressure;  ///< at which it ends, over stiffness / diameter [-]
    double friction;  ///< coefficient; 0 for the densest state [-]
    uint64_t seed;
} dem_jam_def;
dem_jam_def dem_jam_defaults(void);

typedef struct dem_jam {
    double solid_fraction;  ///< at which the pressure begins [-]
    double last;            ///< of the last stage [-]
    double pressure;        ///< of the last stage, over stiffness / diameter [-]
    double contacts;        ///< that a grain which bears a load has with other grains, pairs of spheres [-]
    double loose;           ///< share of grains that bear none [-]
    size_t stages;
    uint64_t steps;
    double seconds;
} dem_jam;

/// Errors: those of worlds; DEM_FAILED where no pressure builds up.
dem_status dem_jam_run(const dem_ctx *ctx, const dem_jam_def *def, dem_jam *jam, dem_error *error);

#endif
