/// Images of labels in three dimensions, as segmented CT scans are: every voxel holds the number of its grain.
#ifndef DEM_MESH_VOLUME_H
#define DEM_MESH_VOLUME_H

#include <string.h>

#include "base/text.h"
#include "math/vec.h"

typedef enum dem_voxel_type {
    DEM_VOXEL_UINT8,
    DEM_VOXEL_INT8,
    DEM_VOXEL_UINT16,
    DEM_VOXEL_INT16,
    DEM_VOXEL_UINT32,
    DEM_VOXEL_INT32,
    DEM_VOXEL_UINT64,
    DEM_VOXEL_INT64,
    DEM_VOXEL_FLOAT,  ///< of whole numbers
    DEM_VOXEL_DOUBLE,
} dem_voxel_type;

/// What a volume without a header is; size[0] 0: every file has one.
typedef struct dem_volume_raw {
    size_t size[3];  ///< voxels along x (the fastest), y, z
    dem_voxel_type type;
    bool big_endian;
    size_t skip;  ///< bytes before the first voxel
} dem_volume_raw;

/// Reads "512x512x300 uint16" and, behind it, "big" or "little" and "skip 512".
dem_status dem_volume_raw_parse(const char *text, dem_volume_raw *raw, dem_error *error);

/// A volume in memory. The point of voxel (i, j, k) is origin + i axes[0] + j axes[1] + k axes[2].
typedef struct dem_volume {
    size_t size[3];
    int width;         ///< bytes of a label: 1, 2 or 4
    void *labels;      ///< [size[0] size[1] size[2]] unsigned, 0: background; from malloc
    dem_vec3 axes[3];  ///< from a voxel to the next [units of the file]
    dem_vec3 origin;   ///< centre of the first voxel [units of the file]
    double unit;       ///< length of one unit as the header names it [m]; 0: it does not
    char unit_name[32];
    bool spaced;      ///< the header says how large a voxel is
    char sha256[65];  ///< of the file (with the data apart: of the header)
} dem_volume;

/// Reads NRRD (attached or detached; raw, gzip, text), MetaImage (mhd, mha) or, with `raw`, voxels without a header.
/// Voxels below 0 become background, with a warning. Errors: DEM_BAD_INPUT with file and line; DEM_NO_MEMORY.
dem_status dem_volume_read(const dem_ctx *ctx, const char *path, const dem_volume_raw *raw, dem_volume *volume,
                           dem_error *error);
void dem_volume_free(dem_volume *volume);

/// The same from the bytes of a header file, which are released; data in another file are refused where `folder` is
/// NULL. `name` stands in messages.
dem_status dem_volume_read_bytes(const dem_ctx *ctx, const char *name, const char *folder, dem_buffer *bytes,
                                 const dem_volume_raw *raw, dem_volume *volume, dem_error *error);

/// Sizes of a voxel or a length: what `axes` are multiplied with.
void dem_volume_scale(dem_volume *volume, double factor);
/// Gives a volume along x, y, z this spacing and leaves the origin where it is.
void dem_volume_space(dem_volume *volume, dem_vec3 spacing);

/// Whether the name (or the content too) tells that a file is a volume.
bool dem_volume_is_name(const char *path);
bool dem_volume_is_file(const char *path);

static inline size_t dem_volume_count(const dem_volume *v)
{
    return v->size[0] * v->size[1] * v->size[2];
}

static inline uint32_t dem_volume_label(const dem_volume *v, size_t at)
{
    if (v->width == 1)
        return ((const uint8_t *)v->labels)[at];
    if (v->width == 2)
        return ((const uint16_t *)v->labels)[at];
    return ((const uint32_t *)v->labels)[at];
}

/// Volume of one voxel.
static inline double dem_volume_voxel(const dem_volume *v)
{
    return fabs(v3_dot(v->axes[0], v3_cross(v->axes[1], v->axes[2])));
}

#endif
