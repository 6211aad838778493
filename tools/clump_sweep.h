/// dem-clump --sweep: error against number of spheres and against packing time, as table, plots and page.
#ifndef DEM_TOOLS_CLUMP_SWEEP_H
#define DEM_TOOLS_CLUMP_SWEEP_H

#include "clump/sweep.h"
#include "clump_inputs.h"
#include "clump_job.h"

/// What the command line asks of every grain.
typedef struct sweep_options {
    const job_options *job;  ///< its outputs: csv, svg, html of one grain; its folder: all three of every grain
    dem_sweep plan;          ///< without cells
    const char *command;     ///< for the page, without folders
    bool json, quiet;
    int threads;  ///< of a packing
} sweep_options;

/// One grain and its packings.
typedef struct sweep_grain {
    job_result base;  ///< of the mesh
    dem_mesh mesh;
    dem_shape shape;
    dem_sweep sweep;
} sweep_grain;

/// Runs all, writes and prints; returns the exit status.
int sweep_run(const cli_tool *tool, const cli_common *common, const clump_inputs *inputs, const sweep_options *options);

// the reports: clump_sweep_table.c
void sweep_text(dem_buffer *out, const sweep_grain *grain, const sweep_options *options);
void sweep_csv(dem_buffer *out, const sweep_grain *grain);
void sweep_json(dem_json_writer *w, const sweep_grain *grain, const sweep_options *options);

// clump_sweep_page.c
/// Small multiples of the errors against spheres and against seconds.
dem_status sweep_svg(dem_buffer *out, const sweep_grain *grain, dem_error *error);
/// Everything about a grain on one page. `ctx` is asked to stop between pictures, which are then left out.
dem_status sweep_page(const dem_ctx *ctx, dem_buffer *out, const sweep_grain *grain, const sweep_options *options,
                      dem_error *error);

#endif
