/// What dem-grain was asked for.
#ifndef DEM_TOOLS_GRAIN_SETTINGS_H
#define DEM_TOOLS_GRAIN_SETTINGS_H

#include "cli_registry.h"
#include "mesh/grain.h"
#include "mesh/write.h"

enum { MAX_OPTIONS = 48 + CLI_REGISTRY_OPTIONS };

typedef struct settings {
    cli_common common;
    const char *kind, *output, *fit, *unit, *block;
    bool list, same_volume;
    long triangles, dents, count, cells, siblings, kept;
    int format;  // of the files in a folder
    int repair;  // of the scan, a dem_repair
    dem_grain_options grain;
    cli_registry kinds;
    // resolved
    const double *own_values;  // those of the chosen kind
    bool folder;               // the output is one
    double block_edges[3];     // [m]
    double length_unit;        // of the scan [m]
} settings;

/// Seeds seed, seed + 1, ... of a kind; one file or a folder. Returns the exit status.
int grain_make_kinds(const cli_tool *tool, const settings *s, dem_mesh_format format);
/// All cells of one block, into a folder.
int grain_make_cells(const cli_tool *tool, const settings *s, dem_mesh_format format);
/// The highest degree of harmonics.
double grain_degree(const settings *s);
/// The twin of a scan, or siblings of it.
int grain_make_fit(const cli_tool *tool, const settings *s, dem_mesh_format format);

#endif
