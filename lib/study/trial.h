/// Cases with a known answer: what one of them expects and gets. Each builds a small scene, takes it through time by
/// the public functions and notes what comes of it.
///
/// The first failure of a call is kept in the trial; all calls after it do nothing and give NAN, so that a case has no
/// branches for errors and is found failed at the end.
#ifndef DEM_STUDY_TRIAL_H
#define DEM_STUDY_TRIAL_H

#include "dem/world.h"
#include "out/plot.h"
#include "study/model.h"

typedef enum dem_bound { DEM_BOUND_NEAR, DEM_BOUND_MOST, DEM_BOUND_LEAST } dem_bound;

/// One number that was measured.
typedef struct dem_finding {
    char what[80];
    const char *unit;  ///< "" without one
    dem_bound bound;
    double expected, got;
    double tolerance;  ///< |got - expected| at most; of the other bounds 0
    bool passed;
} dem_finding;

/// Points of a plot that goes with the findings.
typedef struct dem_curve {
    char name[40];
    double *x, *y;
    size_t count, capacity[2];
} dem_curve;

enum { DEM_CURVES = 8 };

typedef struct dem_trial {
    const dem_ctx *ctx;
    model *model;      ///< of dem_trial_model
    dem_world *world;  ///< of dem_trial_start; NULL: none yet
    bool looked;       ///< the views are those of this time
    uint64_t unasked;  ///< steps since the caller was asked whether to go on
    dem_finding *findings;
    size_t count, capacity;
    dem_plot_axis axes[2];  ///< of the plot; titles NULL: none
    dem_curve curves[DEM_CURVES];
    size_t curve_count;
    const char *skipped;  ///< why the case cannot be tried in this build; NULL: it was
    dem_status status;
    dem_error error;
    double seconds;
} dem_trial;

/// A case. `run` notes its findings in the trial.
typedef struct dem_case {
    const char *name;    ///< words with '-' between
    const char *about;   ///< one line
    const char *source;  ///< where the expected numbers come from
    bool slow;           ///< more than some seconds
    void (*run)(dem_trial *trial);
} dem_case;

/// Runs a case; `trial` is then to be released. `ctx` may be NULL.
void dem_trial_run(const dem_ctx *ctx, const dem_case *c, dem_trial *trial);
/// Whether it ran to its end and all it found is as expected.
bool dem_trial_passed(const dem_trial *trial);
/// Whether a case is meant by a word: its name, or what comes before a '-' or '*' of it ("jkr", "chung-ooi-4").
bool dem_case_meant(const dem_case *c, const char *word);
void dem_trial_release(dem_trial *trial);

// ---- for cases

/// An empty model (see model_begin), the one before is ended. Never NULL.
model *dem_trial_model(dem_trial *trial);
/// A further wall of the model with a mesh of so many, all zero yet; NULL after a failure.
dem_mesh *dem_trial_mesh(dem_trial *trial, size_t vertices, size_t triangles);
/// The world of the model as it is now; the one before is destroyed.
bool dem_trial_start(dem_trial *trial);
/// Steps forward; false: it cannot.
bool dem_trial_step(dem_trial *trial, uint64_t steps);

/// One body at the time of the positions.
typedef struct dem_motion {
    dem_vec3 position, velocity, spin;
    dem_quat orientation;
} dem_motion;
dem_motion dem_trial_body(dem_trial *trial, size_t body);
/// Its spin along its principal axes.
dem_vec3 dem_motion_own_spin(const dem_motion *motion);
/// All of zero after a failure.
const dem_figures *dem_trial_figures(dem_trial *trial);
/// Sphere and sphere or wall that touch; NULL and 0 where none does.
const dem_contact *dem_trial_contacts(dem_trial *trial, size_t *count);
double dem_trial_time(const dem_trial *trial);
/// Forces and wear of NAN after a failure.
dem_wall_view dem_trial_wall(dem_trial *trial, size_t wall);

/// Notes a number that is to be `want` within `tolerance`; `format` tells what it is.
void dem_expect(dem_trial *trial, double got, double want, double tolerance, const char *unit, const char *format, ...)
    DEM_PRINTF(6, 7);
/// One that is to be at most or at least `bound`.
void dem_expect_most(dem_trial *trial, double got, double bound, const char *unit, const char *format, ...)
    DEM_PRINTF(5, 6);
void dem_expect_least(dem_trial *trial, double got, double bound, const char *unit, const char *format, ...)
    DEM_PRINTF(5, 6);

/// Says what the plot of the case shows.
void dem_trial_plot(dem_trial *trial, dem_plot_axis x, dem_plot_axis y);
/// A point of one of its curves, the last or a new one; they are put in order of x.
void dem_trial_point(dem_trial *trial, const char *curve, double x, double y);

#endif
