/// How the outcome of a scene depends on the step and on the schemes of integration, and what that costs.
///
/// The scene is run at a ladder of steps (twice the scene's own, once, 1/2, 1/4, ...) with each scheme and compared
/// with a reference at a quarter of the finest step. What the reference itself is worth is told by the same scheme at
/// the finest step and half of it.
///
/// Where two runs that are the same but for 1e-12 in the places and orientations of their bodies part (many bodies that
/// collide do so, whatever the step), no trajectory is right or wrong. Then each step is run several times from starts
/// that differ by a millionth of a body, and the means of the series' columns are compared, within what they scatter.
#ifndef DEM_STUDY_CONVERGENCE_H
#define DEM_STUDY_CONVERGENCE_H

#include "study/course.h"

enum {
    DEM_CONVERGENCE_METHODS = 16,
    DEM_CONVERGENCE_LEVELS = 12,
    DEM_CONVERGENCE_MEMBERS = 64,
    DEM_CONVERGENCE_SAMPLES = 128,
    DEM_CONVERGENCE_NAME = 100,
};

typedef struct dem_convergence_def {
    const char *name;                ///< of the scene, for what is kept
    const dem_scene *scene;          ///< with an end; its step is the ladder's (0: what an automatic one comes down to)
    void (*push)(dem_world *world);  ///< see dem_course_def
    const dem_integrator_def *methods;  ///< that are compared; the first is the scene's own
    size_t method_count;
    size_t levels;          ///< of the ladder, at least 2
    size_t members;         ///< of an ensemble
    bool each_method;       ///< of an ensemble, too; else its own alone
    const char *of;         ///< the quantity to be good; NULL: "state", of an ensemble the potential or kinetic energy
    double asked;           ///< largest error of it [-]; NAN: not asked
    const char *directory;  ///< see dem_cells_def
    size_t only;
} dem_convergence_def;

/// Quantities whose errors are told, then the columns of the series by name.
typedef enum dem_quantity {
    DEM_QUANTITY_STATE,   ///< the larger of the next two
    DEM_QUANTITY_PLACE,   ///< of any body, in sizes of it (diameter of the bounding ball)
    DEM_QUANTITY_TURN,    ///< of any body [rad]
    DEM_QUANTITY_ENERGY,  ///< the ledger's imbalance: of the run alone, no reference; none with a push, whose half kick
                          ///< to come no view knows
    DEM_QUANTITIES,
} dem_quantity;

/// What was measured of one quantity at one step: the largest error of any time over the range of the reference; of an
/// ensemble that of the mean over the last quarter.
typedef struct dem_error_found {
    double error;  ///< [-]; NAN: none
    double doubt;  ///< how much of it may be due to the reference, or half the interval of 95 % confidence [-]
} dem_error_found;

typedef struct dem_convergence_point {
    double step;  ///< [s]
    uint64_t steps;
    double seconds;  ///< of one processor for a run, mean of the members
    char failed[200];
    dem_error_found *errors;  ///< [quantity_count]
} dem_convergence_point;

/// error = c step^order, where that holds
typedef struct dem_order {
    double order;         ///< NAN: no two points are good for it
    double coarse, fine;  ///< the steps between which it holds [s]
    size_t points;
} dem_order;

typedef struct dem_convergence {
    size_t method_count, levels, members;
    dem_integrator_def methods[DEM_CONVERGENCE_METHODS], reference;
    char names[DEM_CONVERGENCE_METHODS][48], reference_name[48];
    char (*quantities)[DEM_CONVERGENCE_NAME];  ///< [quantity_count]
    size_t quantity_count, of;
    dem_convergence_point *points;  ///< [method_count * levels], from the coarsest on
    dem_convergence_point finest;   ///< the reference
    dem_order *orders;              ///< [method_count * quantity_count]

    // the probe
    double step;     ///< the scene's own [s]
    double contact;  ///< see dem_course
    bool chaotic, flows;
    double growth;  ///< of the distance of two runs, largest [-]
    double rate;    ///< of its logarithm, where it grows [1/s]
    size_t samples;
    double end;
    double apart[DEM_CONVERGENCE_SAMPLES + 1];  ///< places in sizes or angles, the larger one

    size_t best;  ///< point that is cheapest below the asked error; SIZE_MAX: none, or not asked
    double asked;
    size_t cells;
    size_t undone;  ///< cells without a result; where there are any, nothing of the above but the probe is filled
} dem_convergence;

/// Errors: DEM_USAGE (no end, no such quantity), DEM_FAILED (the scene itself does not run), those of dem_cells_run.
dem_status dem_convergence_run(const dem_ctx *ctx, const dem_convergence_def *def, dem_convergence *found,
                               dem_error *error);
void dem_convergence_release(dem_convergence *found);

/// "central+lsym"
void dem_method_name(dem_integrator_def method, char *name, size_t size);

/// Appends what makes a scene run as a point does: "-D time.step=1e-05 -D integrator.rotation=lsym".
void dem_convergence_override(const dem_convergence *found, size_t point, dem_buffer *out);

// ---- figures

/// The order of errors at steps that fall, by least squares of the logarithms over the longest range in which all
/// points are within 12 % of the line, and fall. Errors not above four times their doubt are left out.
dem_order dem_order_fit(const double *steps, const dem_error_found *errors, size_t count);

/// Half the 95 % interval of the difference of two means of `count` each, with standard deviations a and b.
double dem_confidence(double a, double b, size_t count);

/// The cheapest point whose error with its doubt is at most `asked`, as are those of all finer steps of its method; of
/// methods that cost about the same the first.
size_t dem_convergence_cheapest(const dem_convergence *found, size_t quantity, double asked);

// ---- scenes of its own

struct model;
typedef struct dem_convergence_scene {
    const char *name, *about;
    void (*make)(struct model *model);
    void (*push)(dem_world *world);
    const char *of;  ///< NULL: "state"
} dem_convergence_scene;
/// The index-th, NULL behind the last.
const dem_convergence_scene *dem_convergence_scene_at(size_t index);

#endif
