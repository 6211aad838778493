/// Where the clumps of a command go that has them already: what -o means, names of files, the exit status.
#ifndef DEM_TOOLS_CLUMP_OUTPUTS_H
#define DEM_TOOLS_CLUMP_OUTPUTS_H

#include "clump_job.h"

/// Sorts `o->outputs` and `o->formats`: files of one clump (into `files`, room for all), or a folder (`o->folder`), and
/// a CSV table. Says what does not go together; 0 or the exit status.
int outputs_sort(const cli_tool *tool, job_options *o, bool several, cli_texts *files, const char **table);

/// Base name of the outputs of an input: its own without folder and suffix, numbered where others before it have the
/// same.
void outputs_name(const cli_texts *inputs, size_t at, char name[static 256]);

/// Of all results; of several, a failure of one is bad input.
int outputs_status(const job_results *results, bool several);

#endif
