/// Regions of a scene in which stress, fabric and packing are measured, from the views of one instant. Nothing of it is
/// made or run where the scene measures nothing.
///
/// The stress of a contact or bond, F l / V, is spread evenly over the line between the two centres (centre and contact
/// point at a wall), and a region gets the share of the line that lies in it: the stress of neighbouring regions adds
/// up to that of both, and each is in balance with what acts on its border (Noll 1955). The solid volume is that of
/// every grain that lies inside, and of one across the border the share of points spread evenly over it. Among discs of
/// two dimensions a region is its area in their plane, as high as they are thick.
#ifndef DEM_SIM_REGION_H
#define DEM_SIM_REGION_H

#include "base/status.h"
#include "dem/scene.h"
#include "dem/world.h"

typedef struct dem_regions dem_regions;

/// What is wrong with a region, advice behind a ';'; NULL: nothing.
const char *dem_measure_fault(const dem_scene *scene, const dem_measure_def *measure);

/// NULL in *regions where the scene measures nothing. Errors: DEM_USAGE, DEM_NO_MEMORY.
dem_status dem_regions_create(const dem_scene *scene, dem_clump *const *clumps, dem_regions **regions,
                              dem_error *error);
void dem_regions_release(dem_regions *regions);

/// What is measured from: the views of one instant.
typedef struct dem_region_views {
    dem_body_view bodies;
    const dem_contact *contacts;
    size_t contact_count;
    const dem_bond_view *bonds;
    size_t bond_count;
} dem_region_views;

void dem_regions_measure(dem_regions *regions, const dem_region_views *views);
const dem_measure_view *dem_regions_views(const dem_regions *regions, size_t *count);

#endif
