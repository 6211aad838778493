/// The exact union of spheres that come from anywhere, and what is odd about them.
#ifndef DEM_CLUMP_IMPORT_WEIGH_H
#define DEM_CLUMP_IMPORT_WEIGH_H

#include "dem/clump.h"

/// Volume, centre and inertia of the union; `duplicates` receives how many spheres stand there more than once. Refuses
/// spheres that overlap so often that it would take hours.
dem_status dem_import_weigh(const dem_ball *balls, size_t count, dem_union *result, size_t *duplicates,
                            dem_error *error);

#endif
