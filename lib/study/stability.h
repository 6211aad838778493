/// Stiff and extreme cases, in the order of their table: where runs become unstable against what is predicted, and what
/// they keep to elsewhere. Each is run by `dem-study stability`, those that are not slow by the tests.
#ifndef DEM_STUDY_STABILITY_H
#define DEM_STUDY_STABILITY_H

#include "study/trial.h"

/// NULL behind the last.
const dem_case *dem_stability_case(size_t index);

/// The parts of the table, each of one file; a part ends with a case without a name.
extern const dem_case dem_stability_limits[], dem_stability_packings[], dem_stability_impacts[],
    dem_stability_extremes[], dem_stability_rest[], dem_stability_places[], dem_stability_walls[];

// ---- the limit of the step

/// A scene in equilibrium whose motion grows from step to step beyond some step.
typedef struct dem_limit_def {
    void (*make)(dem_trial *trial, const void *user);  ///< fills dem_trial_model(trial), bodies at rest
    const void *user;
    double speed;       ///< that bodies are given at random, so small that no contact opens or slides [m/s]
    double size;        ///< spins are speed / size [m]
    uint64_t steps;     ///< in which growth is to show
    const char *curve;  ///< of growth against step / predicted in the plot; NULL: none
} dem_limit_def;

typedef struct dem_limit {
    double predicted;  ///< dem_world_critical_step [s]
    double measured;   ///< beyond which it blows up [s]
} dem_limit;

/// Finds both; the measured one by bisection between .26 and 4 times the predicted one.
dem_limit dem_limit_find(dem_trial *trial, const dem_limit_def *def);
/// The axes of its plot.
void dem_limit_plot(dem_trial *trial);

#endif
