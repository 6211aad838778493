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
#include "clump/shape_parts.h"
#include "dem/clump.h"
#include "mesh/cgal.h"
#include "mesh/min_box.h"

#define SHAKE 1e-7  // [d_eq]

static dem_status size_measure(const dem_shape_work *work, int threads, dem_error *error)
{
    double edges[3];
    dem_shape *shape = work->shape;
    DEM_TRY(dem_mesh_min_box(&work->unit, threads, edges, NULL, error));
    shape->longest = edges[0] * work->size;
    shape->intermediate = edges[1] * work->size;
    shape->shortest = edges[2] * work->size;
    shape->elongation = edges[1] / edges[0];
    shape->flatness = edges[2] / edges[1];
    return DEM_OK;
}

// NAN without CGAL. Its hull stumbles over points that lie in a plane but for rounding, so they are shaken a little.
static dem_status convexity_measure(dem_shape_work *work, dem_error *error)
{
    dem_mesh shaken, hull;
    dem_random r = random_stream(0, 0);
    work->shape->convexity = NAN;
    DEM_TRY(dem_mesh_copy(&work->unit, &shaken, error));
    for (size_t i = 0; i < shaken.vertex_count; i++) {
        double x = random_uniform(&r), y = random_uniform(&r), z = random_uniform(&r);
        shaken.vertices[i] = v3_along(shaken.vertices[i], SHAKE, v3(x - 0.5, y - 0.5, z - 0.5));
    }
    work->hull = dem_mesh_hull(&shaken, &hull, &work->hull_error);
    dem_mesh_free(&shaken);
    if (work->hull == DEM_OK) {
        work->shape->convexity = fmin(1, DEM_PI / 6 / dem_mesh_solid(&hull).volume);
        dem_mesh_free(&hull);
    }
    return work->hull == DEM_NO_MEMORY ? dem_fail_memory(error) : DEM_OK;
}

static dem_status corners_measure(const dem_shape_work *work, int threads, dem_error *error)
{
    const dem_mesh *unit = &work->unit;
    dem_tree tree;
    DEM_TRY(dem_tree_build(&tree, unit->vertices, unit->triangles, unit->triangle_count, error));
    dem_status status =
        dem_corners_measure(unit, &tree, threads, &work->shape->roundness, &work->shape->angularity, error);
    dem_tree_release(&tree);
    return status;
}

dem_status dem_shape_begin(const dem_mesh *mesh, dem_shape *shape, dem_shape_work *work, dem_error *error)
{
    dem_solid solid = dem_mesh_solid(mesh);
    double size = cbrt(6 / DEM_PI * solid.volume);
    *shape = (dem_shape){.equivalent_diameter = size, .sphericity = DEM_PI * size * size / solid.area};
    *work = (dem_shape_work){.size = size, .shape = shape, .hull = DEM_OK};
    if (!(size > 0) || !isfinite(size))
        return dem_fail(error, DEM_BAD_INPUT, "the mesh encloses no volume; repair it first");
    dem_vec3 *vertices = dem_alloc(mesh->vertex_count, sizeof *vertices);
    if (!vertices)
        return dem_fail_memory(error);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        vertices[i] = v3_scale(v3_sub(mesh->vertices[i], solid.centre), 1 / size);
    work->unit = *mesh;
    work->unit.vertices = vertices;
    return DEM_OK;
}

dem_status dem_shape_part(dem_shape_work *work, int part, int threads, dem_error *error)
{
    return part == DEM_SHAPE_BOX    ? size_measure(work, threads, error)
           : part == DEM_SHAPE_HULL ? convexity_measure(work, error)
                                    : corners_measure(work, threads, error);
}

void dem_shape_end(const dem_ctx *ctx, dem_shape_work *work)
{
    if (work->hull != DEM_OK && work->hull != DEM_UNAVAILABLE && work->hull != DEM_NO_MEMORY)
        dem_log(ctx, DEM_LOG_WARNING, "convexity is unknown: %s", work->hull_error.text);
    free(work->unit.vertices);
    *work = (dem_shape_work){0};
}

dem_status dem_shape_measure(const dem_ctx *ctx, const dem_mesh *mesh, dem_shape *shape, dem_error *error)
{
    dem_shape_work work;
    dem_status status = dem_shape_begin(mesh, shape, &work, error);
    for (int part = 0; part < DEM_SHAPE_PARTS && status == DEM_OK; part++)
        status = dem_shape_part(&work, part, dem_threads(ctx), error);
    dem_shape_end(ctx, &work);
    return status;
}
