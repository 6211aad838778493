/// Crushed grains: the polyhedron that random planes cut out, with its exact edges and corners.
#include "mesh/grain.h"
#include "mesh/polyhedron.h"

enum { FACES, SPREAD };
enum { MAX_FACES = 100, STREAM = 1 };

static const dem_grain_param params[] = {
    [FACES] = {"faces", 24, 8, MAX_FACES, "count", "planes cut; some may miss the grain"},
    [SPREAD] = {"spread", 0.3, 0, 0.6, "-", "of their distances: from 1 - spread to 1"},
};

static dem_status make(const dem_ctx *ctx, const dem_grain_request *request, dem_mesh *mesh, dem_error *error)
{
    (void)ctx;
    size_t count = (size_t)request->values[FACES];
    dem_plane planes[MAX_FACES];
    dem_vec3 normals[MAX_FACES];
    dem_random random = random_stream(request->seed, STREAM);
    dem_grain_directions(&random, normals, count);
    for (size_t i = 0; i < count; i++)
        planes[i] = (dem_plane){normals[i], 1 - request->values[SPREAD] * random_uniform(&random)};
    dem_polyhedron grain = {0};
    dem_status status = dem_polyhedron_from_planes(&grain, planes, count, error);
    if (status == DEM_BAD_INPUT)
        status = dem_fail(error, DEM_USAGE,
                          "the planes of this seed enclose no polyhedron; take more faces or another seed");
    if (status == DEM_OK)
        status = dem_polyhedron_mesh(&grain, 0, request->triangles, mesh, error);
    dem_polyhedron_release(&grain);
    return status;
}

const dem_grain_kind dem_grain_facets = {
    .name = "facets",
    .paper = "",
    .about = "Crushed rock: the convex polyhedron inside random planes, with sharp edges and corners.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .make = make,
};
