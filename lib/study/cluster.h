/// Clumps of a few equal spheres, for studies of how far from round a grain is.
#ifndef DEM_STUDY_CLUSTER_H
#define DEM_STUDY_CLUSTER_H

#include "dem/clump.h"

/// 1 to 4 spheres of diameter 1 m about a point, each `apart` [m] from every other (dimer, triangle, tetrahedron), of
/// unit density. The aspect ratio of a dimer is 1 + apart.
enum { DEM_CLUSTER_MOST = 4 };
dem_status dem_cluster_regular(size_t count, double apart, dem_clump **clump, dem_error *error);

#endif
