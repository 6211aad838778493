/// The voxels of one grain, cut out of its image.
#ifndef DEM_MESH_VOXELS_H
#define DEM_MESH_VOXELS_H

#include "mesh/labels.h"

/// A box of voxels about a label with a layer of background all around. Voxel (i, j, k) of it is voxel
/// (i, j, k) + `low` - 1 of the image.
typedef struct dem_voxels {
    size_t size[3];
    size_t low[3];
    uint8_t *inside;  ///< [size[0] size[1] size[2]] 1 or 0
    size_t count;     ///< of those inside
} dem_voxels;

dem_status dem_voxels_cut(const dem_volume *volume, const dem_label *label, dem_voxels *voxels, dem_error *error);
void dem_voxels_release(dem_voxels *voxels);

/// Drops the pieces that are not to be kept: voxels are of one piece where they share a face.
dem_status dem_voxels_keep(const dem_ctx *ctx, dem_voxels *voxels, dem_keep keep, dem_error *error);

#endif
