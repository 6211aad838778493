/// `dem-clump convert`: clumps of other programs into ours, and clumps of any kind into the formats of the engines.
#ifndef DEM_TOOLS_CLUMP_CONVERT_H
#define DEM_TOOLS_CLUMP_CONVERT_H

/// The subcommand, argv[0] its name; returns the exit status.
int clump_convert(int argc, char **argv);

#endif
