/// What assimp is asked for, inside the child process of the guard.
#ifndef DEM_MESH_IMPORT_H
#define DEM_MESH_IMPORT_H

#include "dem/mesh.h"

typedef enum dem_import_outcome {
    DEM_IMPORT_UNKNOWN,  ///< a format assimp does not know
    DEM_IMPORT_REFUSED,  ///< `why` says what is wrong
    DEM_IMPORT_DONE,
} dem_import_outcome;

/// A file by its path, or with `bytes` from memory as a file ending in `suffix`.
typedef struct dem_import_source {
    const char *path;
    const char *bytes;
    size_t size;
    const char *suffix;  ///< without its dot
} dem_import_source;

/// Joins all triangles of the scene, placed by their nodes. May crash, abort, hang or print.
dem_import_outcome dem_assimp_load(const dem_import_source *source, dem_mesh *mesh, char *why, size_t why_size);

#endif
