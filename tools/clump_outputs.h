/// Where clumps go: what -o and --exports mean, names of files, the exit status.
#ifndef DEM_TOOLS_CLUMP_OUTPUTS_H
#define DEM_TOOLS_CLUMP_OUTPUTS_H

#include "clump_job.h"

/// Sorts `o->outputs` and `o->formats`: files of one clump (into `files`, room for all), or a folder (`o->folder`), and
/// a CSV table, and of several one picture of all (`sheet`; NULL: there is none). Says what does not go together; 0 or the exit status.
int outputs_sort(const cli_tool *tool, job_options *o, bool several, cli_texts *files, const char **table,
                 const char **sheet);

/// --exports LIST: names between commas, `engines` or `all`, become `formats` and those of the job, whose -o is then a
/// folder. Before outputs_sort; 0 or the exit status.
int outputs_exports(const cli_tool *tool, const char *list, job_options *o, cli_texts *formats);

/// The exit status of what became of the grains at worst; `failed`: one of several has failed, which is bad input.
int outputs_status(dem_status worst, bool failed);

#endif
