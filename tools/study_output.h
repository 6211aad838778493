/// Where the studies write to; the form follows the name.
#ifndef DEM_TOOLS_STUDY_OUTPUT_H
#define DEM_TOOLS_STUDY_OUTPUT_H

#include "cli.h"

typedef enum study_form { STUDY_HTML, STUDY_CSV, STUDY_SVG, STUDY_UNKNOWN } study_form;

study_form study_output_form(const char *path);
/// 0, or 2 having said which name tells no form; `svg`: pictures can be written too.
int study_check_outputs(const cli_tool *tool, const cli_texts *outputs, bool svg);

/// The numbers of "1,1.5,2", at most `most`, each from `low` to `high`; 0, or 2 having said what is wrong with them.
int study_read_numbers(const cli_tool *tool, const char *option, const char *text, double low, double high,
                       double *numbers, size_t most, size_t *count);

/// Writes a file of a study's folder; releases the text. 0, or the exit status having said why not.
int study_write(cli_session *session, const char *folder, const char *name, dem_buffer *text);

/// What every study of cells can be asked; `study` has `only`, `seeds` and `folder`.
#define STUDY_CELL_OPTIONS(study)                                                                               \
    {.help = "Cells"},                                                                                          \
    {"output", 'o', CLI_TEXT, "DIR", "folder of page, tables and what each cell found (default: the study's name)", \
     &(study).folder, 0, 0},                                                                                    \
    {"cell", 0, CLI_WHOLE, "N", "run one cell only, from 0, as a job of an array does", &(study).only, 0, 1e9}, \
    {"cells", 0, CLI_FLAG, NULL, "tell how many cells there are, and leave", &(study).count_cells, 0, 0}

#endif
