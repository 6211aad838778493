/// One input file of dem-clump: read, repaired, packed, measured, written.
#ifndef DEM_TOOLS_CLUMP_JOB_H
#define DEM_TOOLS_CLUMP_JOB_H

#include "dem/dem.h"

#include "cli.h"
#include "out/export.h"

/// What the command line asks of every input.
typedef struct job_options {
    dem_make_options make;
    dem_repair_options repair;
    bool moments_asked;            ///< explicitly
    bool split;
    double unit;                   ///< length of one unit of the file [m]
    const char *unit_name;
    double size;                   ///< equivalent diameter to rescale to [m]; 0: as it is
    dem_frame frame;               ///< of the formats that can be in either
    cli_texts outputs;             ///< files; empty: NAME.json in the current folder
    cli_texts formats;             ///< for outputs whose name does not tell, and for a folder
    const char *folder;            ///< where the files of several grains go; NULL: single
} job_options;

/// What came of one grain: a file, or one body of it with --split.
typedef struct job_result {
    const char *input;
    char name[256];                ///< of the grain
    dem_status status;
    dem_error error;
    dem_mesh_report report;
    dem_solid solid;               ///< of the mesh, at unit density
    dem_clump *clump;              ///< NULL where it failed
    dem_pack pack;                 ///< without its balls
    double seconds_read, seconds_repair, seconds_total;
    char **warnings;
    size_t warning_count;
    char **outputs;
    size_t output_count;
} job_result;

typedef struct job_results {
    job_result *items;
    size_t count, capacity;
} job_results;

/// Runs one input and appends its results (at least one). `name` is the base name of its output files.
void job_run(const dem_ctx *ctx, const char *input, const char *name, const job_options *options,
             job_results *results);
void job_results_release(job_results *results);

/// Reads, repairs and rescales one input, without making anything of it: `result` holds everything of the mesh. Release
/// both; job_result_release.
dem_status job_read(const dem_ctx *ctx, const char *input, const char *name, const job_options *options,
                    dem_mesh *mesh, job_result *result);
void job_result_release(job_result *result);

/// Writes a clump that is there already as `options` ask for; `mesh` (may be NULL) is for the formats that show it.
dem_status job_write(const dem_ctx *ctx, const job_options *options, job_result *result, const dem_mesh *mesh,
                     dem_error *error);

#endif
