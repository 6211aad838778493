// What the CGAL shim answers in a build without CGAL.
#include "mesh/cgal.h"

#include "base/status.h"

#if !DEM_CGAL

static dem_status absent(const char *what, dem_mesh *out, dem_error *error)
{
    *out = (dem_mesh){0};
    return dem_fail(error, DEM_UNAVAILABLE, "%s needs CGAL, and this build has none; build with -DDEM_CGAL=ON", what);
}

dem_status dem_mesh_hull(const dem_mesh *mesh, dem_mesh *hull, dem_error *error)
{
    (void)mesh;
    return absent("the convex hull", hull, error);
}

dem_status dem_mesh_refine(const dem_mesh *mesh, const uint32_t (*pairs)[2], size_t pair_count, dem_mesh *out,
                           dem_error *error)
{
    (void)mesh, (void)pairs, (void)pair_count;
    return absent("mending a surface that crosses itself", out, error);
}

dem_status dem_mesh_alpha_wrap(const dem_mesh *mesh, double alpha, double offset, dem_mesh *out, dem_error *error)
{
    (void)mesh, (void)alpha, (void)offset;
    return absent("wrapping", out, error);
}

#endif
