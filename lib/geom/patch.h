/// One ball's part of the boundary of a union of balls (geom/union.h).
#ifndef DEM_GEOM_PATCH_H
#define DEM_GEOM_PATCH_H

#include "geom/ball_tree.h"
#include "geom/union.h"

/// Work space for the patches of one union; one per thread. The tree is borrowed. NULL: no memory.
typedef struct dem_patch_work dem_patch_work;
dem_patch_work *dem_patch_work_create(const dem_ball_tree *tree);
void dem_patch_work_destroy(dem_patch_work *work);

/// Patch of ball i. False: no memory.
bool dem_patch_compute(dem_patch_work *work, uint32_t i, dem_patch *patch);

/// Of the patch computed last: how far its arcs are from closing (a pure number), its arcs and its caps.
double dem_patch_doubt(const dem_patch_work *work);
size_t dem_patch_arc_count(const dem_patch_work *work);
dem_arc dem_patch_arc(const dem_patch_work *work, uint32_t i, size_t k);
size_t dem_patch_cap_count(const dem_patch_work *work);
dem_cap dem_patch_cap(const dem_patch_work *work, size_t k);

#endif
