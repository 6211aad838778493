/// The grains of a label volume: where each one is, and its surface.
#ifndef DEM_MESH_LABELS_H
#define DEM_MESH_LABELS_H

#include "dem/mesh.h"
#include "mesh/volume.h"

typedef struct dem_label {
    uint32_t value;
    size_t voxels;
    size_t low[3], high[3];  ///< first and last voxel along x, y, z
    bool border;             ///< touches the border of the image
} dem_label;

/// All labels but 0, ascending, in one pass; `labels` is to be freed. Errors: DEM_BAD_INPUT where there is none, or far
/// too many for labels; DEM_INTERRUPTED, DEM_NO_MEMORY.
dem_status dem_labels_find(const dem_ctx *ctx, const dem_volume *volume, dem_label **labels, size_t *count,
                           dem_error *error);

/// One smooth closed surface about the voxels of a label, two-manifold whatever touches whatever: voxels that share
/// only an edge or a corner stay apart. It encloses the volume of the voxels and lies within a voxel of them. Pieces
/// that share no face with the largest one are dropped with a warning where they are crumbs, else `keep` decides.
/// Errors: DEM_BAD_INPUT with DEM_KEEP_ONE and several pieces; DEM_NO_MEMORY.
dem_status dem_label_surface(const dem_ctx *ctx, const dem_volume *volume, dem_label *label, dem_keep keep,
                             dem_mesh *mesh, dem_error *error);

#endif
