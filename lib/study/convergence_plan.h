/// The runs of a convergence study: which cells there are, and what each runs.
#ifndef DEM_STUDY_CONVERGENCE_PLAN_H
#define DEM_STUDY_CONVERGENCE_PLAN_H

#include "study/convergence.h"

enum { DEM_REFERENCES = 3 };  ///< at the finest step, a half and a quarter of it

typedef struct dem_convergence_plan {
    const dem_convergence_def *def;
    dem_scene scene;
    uint64_t same;  ///< a hash of the scene and of how it starts
    size_t methods, members, references;
    size_t samples;
    uint64_t coarsest;  ///< steps at twice the scene's own step, a multiple of the samples
    dem_integrator_def reference;
    bool ensemble;
} dem_convergence_plan;

/// Runs the scene as it is and twice at its fixed step, or takes that from the folder `probe`; fills the plan and the
/// found things of the probe.
dem_status dem_convergence_probe(const dem_ctx *ctx, dem_convergence_plan *plan, dem_convergence *found,
                                 dem_error *error);

size_t dem_plan_cells(const dem_convergence_plan *plan);
/// The first cell of a point; its members follow. Points behind those of the methods are the references.
size_t dem_plan_cell(const dem_convergence_plan *plan, size_t point);
size_t dem_plan_points(const dem_convergence_plan *plan);
uint64_t dem_plan_steps(const dem_convergence_plan *plan, size_t point);

/// Runs all cells, or the one that is asked for. `results` [dem_plan_cells].
dem_status dem_plan_run(const dem_ctx *ctx, dem_convergence_plan *plan, dem_cell_result *results, dem_error *error);

#endif
