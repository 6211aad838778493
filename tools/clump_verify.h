/// `dem-clump verify`: what mass and inertia other programs really use for a clump exported to them.
#ifndef DEM_TOOLS_CLUMP_VERIFY_H
#define DEM_TOOLS_CLUMP_VERIFY_H

/// The subcommand, argv[0] its name; returns the exit status.
int clump_verify(int argc, char **argv);

#endif
