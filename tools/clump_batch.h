/// Many grains: in parallel, each told as soon as it and those before it are done, whatever becomes of the others.
#ifndef DEM_TOOLS_CLUMP_BATCH_H
#define DEM_TOOLS_CLUMP_BATCH_H

#include "clump_inputs.h"
#include "clump_job.h"
#include "mesh/volume.h"

typedef struct batch_options {
    const char *table;   ///< CSV, a row per grain; "-": standard output; NULL: none
    const char *sheet;   ///< picture of all grains beside their clumps; NULL: none
    bool resume;         ///< leave out the grains whose files are there
    bool keep_results;   ///< for a report at the end: without surfaces in a batch
    dem_volume_raw raw;  ///< of volumes without a header
    dem_vec3 spacing;    ///< of the voxels, whatever the header says [m]; 0: as it says
    const char *labels;  ///< "3,7,10-20"; NULL: all
    long min_voxels;     ///< smaller labels are left out
    bool drop_border;    ///< also those that the border of the image cuts
} batch_options;

/// Runs all inputs; `results` receives them with keep_results. Returns the exit status.
int batch_run(const cli_tool *tool, const cli_common *common, const clump_inputs *inputs, const job_options *options,
              const batch_options *batch, job_results *results);

#endif
