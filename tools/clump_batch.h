/// What the commands of dem-clump share, and the commands beside the main one.
#ifndef DEM_TOOLS_CLUMP_BATCH_H
#define DEM_TOOLS_CLUMP_BATCH_H

#include "clump_job.h"

/// Sorts what -o names: files of one grain (into `files`, room for all), or a folder (`o->folder`), and a CSV table.
/// Says what does not go together; 0 or the exit status.
int sort_outputs(const cli_tool *tool, job_options *o, bool several, cli_texts *files, const char **table);

/// Base names of the outputs of a batch, to be freed one by one.
char **grain_names(const cli_texts *inputs);

int exit_status(const job_results *results, bool several);

/// dem-clump convert: clumps of other programs.
int clump_convert(int argc, char **argv);

#endif
