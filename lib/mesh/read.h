/// The mesh formats read here: recognised by content, each read from the bytes of a whole file.
#ifndef DEM_MESH_READ_H
#define DEM_MESH_READ_H

#include "base/text.h"
#include "dem/mesh.h"

typedef enum dem_mesh_format {
    DEM_FORMAT_UNKNOWN,
    DEM_FORMAT_STL_BINARY,
    DEM_FORMAT_STL_TEXT,
    DEM_FORMAT_OBJ,
    DEM_FORMAT_PLY,
    DEM_FORMAT_OFF,
} dem_mesh_format;

/// What the bytes are, whatever the name; the name decides only about what looks like none of them (a damaged
/// binary STL).
dem_mesh_format dem_mesh_sniff(const char *name, const char *bytes, size_t size);

/// Reads and releases the bytes of a file of a known format.
dem_status dem_mesh_read_bytes(const dem_ctx *ctx, const char *name, dem_mesh_format format, dem_buffer *bytes,
                               dem_mesh *mesh, dem_error *error);

/// DEM_BAD_INPUT for bytes of unknown format, saying what they seem to be and what is `supported`.
dem_status dem_mesh_refuse(const char *name, const char *bytes, size_t size, const char *supported, dem_error *error);

/// Warns where 32-bit coordinates far from the origin cannot resolve the grain.
void dem_mesh_warn_precision(const dem_ctx *ctx, const dem_mesh *mesh);

/// Each leaves an empty mesh on failure. `name` stands in messages.
dem_status dem_read_stl_binary(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                               dem_error *error);
dem_status dem_read_stl_text(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                             dem_error *error);
dem_status dem_read_obj(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                        dem_error *error);
dem_status dem_read_ply(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                        dem_error *error);
dem_status dem_read_off(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                        dem_error *error);

#endif
