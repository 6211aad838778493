/// The clump file `dem-clump/1` in memory; its JSON Schema is dem-clump-1.schema.json.
#ifndef DEM_CLUMP_FILE_H
#define DEM_CLUMP_FILE_H

#include "base/json.h"
#include "dem/clump.h"

/// Appends the file's text. Errors: DEM_NO_MEMORY.
dem_status dem_clump_encode(const dem_clump *clump, dem_buffer *out, dem_error *error);

/// `file` is for messages and, without its folder and suffix, the name of a clump that has none.
/// Needed are schema, density, mass, inertia and spheres; the rest has defaults, unknown keys are passed over.
dem_status dem_clump_decode(const char *text, size_t size, const char *file, dem_clump **clump, dem_error *error);

/// Members of an open object: everything of the clump file but schema, spheres and surface.
void dem_clump_put_figures(dem_json_writer *w, const dem_clump_def *def);

#endif
