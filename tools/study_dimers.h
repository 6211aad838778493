/// `dem-study dimers`: the random packing of dimers against their aspect ratio.
#ifndef DEM_TOOLS_STUDY_DIMERS_H
#define DEM_TOOLS_STUDY_DIMERS_H

/// The subcommand, argv[0] its name; returns the exit status.
int study_dimers(int argc, char **argv);

#endif
