// Size and form. L >= I >= S are the edges of the bounding box of least volume, V the volume, A the area,
// d_eq = cbrt(6 V / pi).
//
// elongation I / L and flatness S / I (Zingg 1935), sphericity pi d_eq^2 / A (Wadell 1932), convexity V / V_hull.
//
// Roundness is Wadell's (1932): the mean radius of the corners over the radius R of the largest inscribed ball. The
// radius at a place is that of the largest ball inside the grain that touches it there (the calypter of Pirard 1994,
// in 3-D), R at most. The mean is taken over the turning of the surface, int H dA of its convex parts (normal cycle,
// Cohen-Steiner & Morvan 2003): flat parts do not count, an edge or a corner counts by how far it turns, however fine
// its triangles. A ball may come .4 % of d_eq through the surface and touch from as far, and turning is summed over
// cells of 5 % of d_eq, so that the noise of a scan is not taken for corners. A sphere has 1, a cube rounded with the
// radius r about r / R, a sharp one .04.
//
// Angularity is the factor of Sukumaran & Ashmawy (2001) in 3-D: how unevenly the surface turns, against a sphere. At
// each place the spread s = 1 - |mean normal| is taken over the surface within .1 d_eq (without the other side of a
// thin grain; normals smoothed over .03 d_eq before), and angularity is (mean s - s_sphere) / (s_cube - s_sphere): 0
// for the sphere, 1 for the cube, more for sharper bodies.
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "clump/corners.h"
#include "dem/clump.h"
#include "mesh/cgal.h"
#include "mesh/min_box.h"

#define SHAKE 1e-7  // [d_eq]

static dem_status size_measure(const dem_mesh *mesh, double size, int threads, dem_shape *shape, dem_error *error)
{
    double edges[3];
    DEM_TRY(dem_mesh_min_box(mesh, threads, edges, NULL, error));
    shape->longest = edges[0] * size;
    shape->intermediate = edges[1] * size;
    shape->shortest = edges[2] * size;
    shape->elongation = edges[1] / edges[0];
    shape->flatness = edges[2] / edges[1];
    return DEM_OK;
}

// NAN without CGAL. Its hull stumbles over points that lie in a plane but for rounding, so they are shaken a little.
static dem_status convexity_measure(const dem_ctx *ctx, const dem_mesh *mesh, dem_shape *shape, dem_error *error)
{
    dem_mesh shaken, hull;
    dem_error reason;
    dem_random r = random_stream(0, 0);
    shape->convexity = NAN;
    DEM_TRY(dem_mesh_copy(mesh, &shaken, error));
    for (size_t i = 0; i < shaken.vertex_count; i++) {
        double x = random_uniform(&r), y = random_uniform(&r), z = random_uniform(&r);
        shaken.vertices[i] = v3_along(shaken.vertices[i], SHAKE, v3(x - 0.5, y - 0.5, z - 0.5));
    }
    dem_status status = dem_mesh_hull(&shaken, &hull, &reason);
    dem_mesh_free(&shaken);
    if (status == DEM_OK) {
        shape->convexity = fmin(1, DEM_PI / 6 / dem_mesh_solid(&hull).volume);
        dem_mesh_free(&hull);
    } else if (status != DEM_UNAVAILABLE) {
        dem_log(ctx, DEM_LOG_WARNING, "convexity is unknown: %s", reason.text);
    }
    return status == DEM_NO_MEMORY ? dem_fail_memory(error) : DEM_OK;
}

dem_status dem_shape_measure(const dem_ctx *ctx, const dem_mesh *mesh, dem_shape *shape, dem_error *error)
{
    dem_solid solid = dem_mesh_solid(mesh);
    double size = cbrt(6 / DEM_PI * solid.volume);
    *shape = (dem_shape){.equivalent_diameter = size, .sphericity = DEM_PI * size * size / solid.area};
    if (!(size > 0) || !isfinite(size))
        return dem_fail(error, DEM_BAD_INPUT, "the mesh encloses no volume; repair it first");
    // all lengths in d_eq, the centre of mass at 0
    dem_mesh unit = *mesh;
    dem_tree tree = {0};
    unit.vertices = dem_alloc(mesh->vertex_count, sizeof *unit.vertices);
    if (!unit.vertices)
        return dem_fail_memory(error);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        unit.vertices[i] = v3_scale(v3_sub(mesh->vertices[i], solid.centre), 1 / size);
    dem_status status = size_measure(&unit, size, dem_threads(ctx), shape, error);
    if (status == DEM_OK)
        status = convexity_measure(ctx, &unit, shape, error);
    if (status == DEM_OK)
        status = dem_tree_build(&tree, unit.vertices, unit.triangles, unit.triangle_count, error);
    if (status == DEM_OK)
        status = dem_corners_measure(&unit, &tree, dem_threads(ctx), &shape->roundness, &shape->angularity, error);
    dem_tree_release(&tree);
    free(unit.vertices);
    return status;
}
