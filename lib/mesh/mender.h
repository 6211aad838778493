/// What the steps of dem_mesh_repair share.
#ifndef DEM_MESH_MENDER_H
#define DEM_MESH_MENDER_H

#include "math/vec.h"
#include "mesh/bodies.h"

typedef struct dem_mender {
    const dem_ctx *ctx;
    dem_mesh *mesh;
    dem_repair_options options;
    dem_mesh_report *report;
    dem_error *error;
    dem_surface surface;
    dem_shells shells;
    dem_mesh_bodies bodies;
    dem_box box;
    double size;        ///< diagonal of `box` [m]
    double reference;   ///< signed volume of the oriented surface without what was filled in [m^3]
    unsigned char *flipped;  ///< [triangle_count] 1: turned against the file; DEM_MENDER_NEW and up: not in it
} dem_mender;

enum { DEM_MENDER_NEW = 2 };

/// One warning about a repair; a refusal instead in the strict mode.
dem_status dem_mender_note(dem_mender *mender, const char *format, ...) DEM_PRINTF(2, 3);

/// A warning that is not a repair.
void dem_mender_warn(dem_mender *mender, const char *format, ...) DEM_PRINTF(2, 3);

/// The plural's s.
static inline const char *plural(size_t count)
{
    return count == 1 ? "" : "s";
}

/// Drops the triangles marked and builds the surface again.
dem_status dem_mender_drop(dem_mender *mender, const unsigned char *drop);

/// Fins, strays, inner walls; then neighbours agree. Fills report and `flipped`.
dem_status dem_mender_clean(dem_mender *mender);

/// Closes small holes, or all where `any_size`; refuses large ones.
dem_status dem_mender_close(dem_mender *mender, bool any_size);

/// Outward orientation, nesting, crossings: afterwards the mesh bounds its solid.
dem_status dem_mender_solidify(dem_mender *mender);

/// What the options keep of several bodies.
dem_status dem_mender_keep(dem_mender *mender);

/// Replaces the mesh by a wrap around it.
dem_status dem_mender_wrap(dem_mender *mender);

#endif
