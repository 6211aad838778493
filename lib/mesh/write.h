/// Meshes as files.
#ifndef DEM_MESH_WRITE_H
#define DEM_MESH_WRITE_H

#include "base/text.h"
#include "dem/mesh.h"

typedef enum dem_mesh_format {
    DEM_MESH_OBJ,
    DEM_MESH_STL,  ///< binary: 32-bit coordinates, no shared vertices
    DEM_MESH_PLY,  ///< binary, 64-bit coordinates
    DEM_MESH_OFF,
} dem_mesh_format;

/// The format a file name's suffix stands for; false: none.
bool dem_mesh_format_of(const char *path, dem_mesh_format *format);

/// Appends the mesh. `comment` is one line, or NULL; `digits` are those of a coordinate in text formats (17:
/// without loss).
void dem_mesh_put(const dem_mesh *mesh, dem_mesh_format format, const char *comment, int digits, dem_buffer *out);

#endif
