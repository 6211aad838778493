/// `dem-study scene` and `dem-study test`: measured tests as scene files, and done at once.
#ifndef DEM_TOOLS_STUDY_LAB_H
#define DEM_TOOLS_STUDY_LAB_H

#include "cli.h"
#include "study/lab.h"

/// The subcommands, argv[0] the name; they return the exit status.
int study_scene(int argc, char **argv);
int study_test(int argc, char **argv);

/// Sets the values that "name=value" texts give of a test, others NAN; unknown names are an error unless
/// `of_any_test` has them. 0, or 2 having said what is wrong.
int lab_read_values(const cli_tool *tool, const dem_lab_test *test, const cli_texts *texts, bool of_any_test,
                    double *values);

#endif
