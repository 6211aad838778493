/// `dem-study mohr-coulomb`: friction angle and cohesion of a set of tests.
#ifndef DEM_TOOLS_STUDY_MOHR_H
#define DEM_TOOLS_STUDY_MOHR_H

/// The subcommand, argv[0] its name; returns the exit status.
int study_mohr_coulomb(int argc, char **argv);

#endif
