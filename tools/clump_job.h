/// One input file of dem-clump: read, repaired, packed, measured, written.
#ifndef DEM_TOOLS_CLUMP_JOB_H
#define DEM_TOOLS_CLUMP_JOB_H

#include "dem/dem.h"

#include "cli.h"
#include "mesh/labels.h"
#include "out/export.h"
#include "out/png.h"

/// What the command line asks of every input.
typedef struct job_options {
    dem_make_options make;
    dem_repair_options repair;
    bool moments_asked;            ///< explicitly
    bool split;
    double unit;                   ///< length of one unit of the file [m]
    const char *unit_name;
    bool unit_given;               ///< by --unit
    double size;                   ///< equivalent diameter to rescale to [m]; 0: as it is
    dem_frame frame;               ///< of the formats that can be in either
    cli_texts outputs;             ///< files; empty: NAME.json in the current folder
    cli_texts formats;             ///< for outputs whose name does not tell, and for a folder
    bool into_folder;              ///< --exports: -o names a folder, also one that is not there yet
    bool every_format;             ///< `formats` are all there are: leave out what this build cannot write
    const char *folder;            ///< where the files of several grains go; NULL: single
    bool picture;                  ///< also a small picture of each grain beside its clump
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
    bool kept;                     ///< not made but found; then `report` and `solid` are not known
    dem_label label;               ///< of a label volume; voxels 0: a mesh
    double voxel_volume;           ///< of all voxels of the label [m^3]
    dem_image picture;
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
/// The same of one label of a volume, whose file is `input`.
void job_run_label(const dem_ctx *ctx, const dem_volume *volume, const dem_label *label, const char *input,
                   const char *name, const job_options *options, job_results *results);

/// Whether all files of a grain of a batch are there.
bool job_is_done(const char *name, const job_options *options);
/// A result for one that is, read from its clump file if there is one; `volume` NULL: of a mesh.
void job_keep(const char *input, const char *name, const dem_volume *volume, const dem_label *label,
              const job_options *options, job_results *results);
/// A result for an input that did not even come to a grain.
void job_fail(const char *input, const char *name, const dem_error *error, job_results *results);

/// Drops the surfaces kept in the clumps, and the pictures.
void job_results_slim(job_results *results);
/// Moves what `from` holds behind what `to` holds.
void job_results_move(job_results *to, job_results *from);
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
