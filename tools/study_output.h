/// Where the studies write to; the form follows the name.
#ifndef DEM_TOOLS_STUDY_OUTPUT_H
#define DEM_TOOLS_STUDY_OUTPUT_H

#include "cli.h"

typedef enum study_form { STUDY_HTML, STUDY_CSV, STUDY_SVG, STUDY_UNKNOWN } study_form;

study_form study_output_form(const char *path);
/// 0, or 2 having said which name tells no form; `svg`: pictures can be written too.
int study_check_outputs(const cli_tool *tool, const cli_texts *outputs, bool svg);

#endif
