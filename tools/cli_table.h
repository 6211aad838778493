/// What help, man page and completions read out of the table of a tool.
#ifndef DEM_TOOLS_CLI_TABLE_H
#define DEM_TOOLS_CLI_TABLE_H

#include "cli.h"

/// One line of an epilogue, split where two blanks or more stand behind its beginning:
/// "  dem-clump a.stl    50 spheres".
typedef struct cli_line {
    size_t indent;  ///< blanks before `left`
    const char *left, *right;
    size_t left_length, right_length;
    size_t right_at;  ///< column of `right`; right_length 0: there is none
} cli_line;

/// Reads the line at `text`; returns the next one, NULL behind the last.
const char *cli_next_line(const char *text, cli_line *line);

/// What a value may be, for a shell that completes it.
typedef enum cli_values { CLI_VALUES_ANY, CLI_VALUES_CHOICE, CLI_VALUES_FILES, CLI_VALUES_FOLDERS } cli_values;
cli_values cli_values_of(const cli_option *option);
/// The option may also stand without its value: "[A,B]".
bool cli_value_optional(const cli_option *option);
/// Of the operands, by the first word of the usage in capitals, which is put in `name`, "" where there is none.
cli_values cli_operands(const cli_tool *tool, char *name, size_t size);

/// The rows with a name, each name once, then help and version; NULL behind the last.
const cli_option *cli_option_at(const cli_tool *tool, size_t index);

/// " from 1 to 5 mm"; empty where any value will do.
void cli_range_text(const cli_option *option, char *text, size_t size);

/// The tool's name with `blank` for blanks and `hyphen` for hyphens: dem-clump verify -> dem_clump_verify.
void cli_name_as(const cli_tool *tool, char blank, char hyphen, char *text, size_t size);

/// The other forms of help: `--help=man` and completions of bash, zsh and fish. False: there is no such form.
bool cli_help_form(const cli_tool *tool, const char *form, dem_buffer *text);
void cli_man(const cli_tool *tool, dem_buffer *text);
void cli_complete_bash(const cli_tool *tool, dem_buffer *text);
void cli_complete_zsh(const cli_tool *tool, dem_buffer *text);
void cli_complete_fish(const cli_tool *tool, dem_buffer *text);

#endif
