/// A registry whose entries have parameters (kinds of grains, packing methods) on the command line: one option per
/// parameter, lists for people and programs, and what does not belong together.
#ifndef DEM_TOOLS_CLI_REGISTRY_H
#define DEM_TOOLS_CLI_REGISTRY_H

#include "base/parameter.h"
#include "cli.h"

enum { CLI_ENTRIES = 16, CLI_PARAMETERS = 16, CLI_REGISTRY_OPTIONS = CLI_ENTRIES * (CLI_PARAMETERS + 1) };

typedef struct cli_entry {
    const char *name, *about, *paper;  ///< paper: "" or NULL without
    const dem_parameter *parameters;
    size_t parameter_count;
} cli_entry;

/// Its option rows point into it: not to be copied or moved after cli_registry_options.
typedef struct cli_registry {
    const char *what;   ///< "kind"
    const char *unset;  ///< who finds a parameter whose standard is NAN: "by the seed"
    cli_entry entries[CLI_ENTRIES];
    size_t count;
    double values[CLI_ENTRIES][CLI_PARAMETERS];  ///< NAN: not given
    char help[CLI_ENTRIES][CLI_PARAMETERS][200], headings[CLI_ENTRIES][64];
} cli_registry;

/// Appends the parameters as rows of the option table, under a heading per entry that has any; returns the new count.
size_t cli_registry_options(cli_registry *registry, cli_option *options, size_t count);

/// Index of an entry; `count` where there is none of that name.
size_t cli_registry_find(const cli_registry *registry, const char *name);

/// 0, or 2 having said that there is no such entry (`list`: the option that shows all) or that a parameter was given
/// that it does not have.
int cli_registry_check(const cli_tool *tool, const cli_registry *registry, const char *name, const char *list);

/// Entries and parameters for people; as one JSON object whose key is `what` in the plural.
void cli_registry_list(const cli_registry *registry, dem_buffer *out);
void cli_registry_list_json(const cli_registry *registry, dem_buffer *out);

#endif
