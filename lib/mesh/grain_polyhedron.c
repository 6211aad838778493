/// Polyhedra with rounded edges: a core grown by a ball, so that faces stay flat, edges become parts of cylinders and
/// corners parts of spheres. Their volume and area are those of Steiner's formula.
#include "mesh/grain.h"
#include "mesh/icosphere.h"
#include "mesh/polyhedron.h"

enum { SOLID, POINTS, SCATTER, ROUNDING };
enum { MAX_POINTS = 100, STREAM = 3 };

static const double LEAST = 1e-3;  // less rounding cannot be seen, and more than 1 - this leaves no flat faces

static const dem_grain_param params[] = {
    [SOLID] = {"solid", 0, 0, 20, "count", "4, 6, 8, 12 or 20: the regular one of so many faces; 0: a random hull"},
    [POINTS] = {"points", 20, 6, MAX_POINTS, "count", "of the random hull"},
    [SCATTER] = {"scatter", 0.2, 0, 0.6, "-", "of their distances: from 1 - scatter to 1"},
    [ROUNDING] = {"rounding", 0.2, 0, 1, "-", "radius of the edges over that of the ball inside: 0 sharp, 1 a sphere"},
};

// 4, 6 or 12 planes at distance 1, three at each corner; the solids of 8 and 20 are duals
static size_t regular_planes(int solid, dem_plane *planes)
{
    static const double s = 0.57735026918962576, a = 0.52573111211913361, b = 0.85065080835203993;
    static const dem_vec3 four[] = {{s, s, s}, {s, -s, -s}, {-s, s, -s}, {-s, -s, s}};
    static const dem_vec3 six[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    static const dem_vec3 twelve[] = {{0, a, b},  {0, -a, b},  {0, a, -b}, {0, -a, -b}, {a, b, 0},  {-a, b, 0},
                                      {a, -b, 0}, {-a, -b, 0}, {b, 0, a},  {-b, 0, a},  {b, 0, -a}, {-b, 0, -a}};
    const dem_vec3 *normals = solid == 4 ? four : solid == 6 || solid == 8 ? six : twelve;
    size_t count = solid == 4 ? 4 : solid == 6 || solid == 8 ? 6 : 12;
    for (size_t i = 0; i < count; i++)
        planes[i] = (dem_plane){normals[i], 1};
    return count;
}

// the hull of points is the dual of the polyhedron whose planes are the points' own
static size_t random_planes(const dem_grain_request *request, dem_plane *planes)
{
    size_t count = (size_t)request->values[POINTS];
    dem_vec3 directions[MAX_POINTS];
    dem_random random = random_stream(request->seed, STREAM);
    dem_grain_directions(&random, directions, count);
    for (size_t i = 0; i < count; i++)
        planes[i] = (dem_plane){directions[i], 1 / (1 - request->values[SCATTER] * random_uniform(&random))};
    return count;
}

static dem_status make_core(const dem_grain_request *request, dem_polyhedron *core, dem_error *error)
{
    int solid = (int)request->values[SOLID];
    dem_plane planes[MAX_POINTS];
    size_t count = solid ? regular_planes(solid, planes) : random_planes(request, planes);
    if (solid == 4 || solid == 6 || solid == 12)
        return dem_polyhedron_from_planes(core, planes, count, error);
    dem_polyhedron inverse = {0};
    dem_status status = dem_polyhedron_from_planes(&inverse, planes, count, error);
    if (status == DEM_OK)
        status = dem_polyhedron_dual(core, &inverse, error);
    dem_polyhedron_release(&inverse);
    if (status == DEM_BAD_INPUT)
        return dem_fail(error, DEM_USAGE,
                        "the points of this seed lie all on one side; take more points or another seed");
    return status;
}

static dem_status make(const dem_ctx *ctx, const dem_grain_request *request, dem_mesh *mesh, dem_error *error)
{
    (void)ctx;
    int solid = (int)request->values[SOLID];
    if (solid && solid != 4 && solid != 6 && solid != 8 && solid != 12 && solid != 20)
        return dem_fail(error, DEM_USAGE,
                        "there is no regular solid of %d faces; give 4, 6, 8, 12, 20, or 0 for a random hull", solid);
    double rounding = request->values[ROUNDING];
    if (rounding > 1 - LEAST)
        return dem_icosphere(dem_icosphere_frequency(request->triangles), mesh, error);
    rounding = rounding < LEAST ? 0 : rounding;
    dem_polyhedron core = {0};
    dem_ball ball;
    dem_status status = make_core(request, &core, error);
    if (status == DEM_OK)
        status = dem_polyhedron_inball(&core, &ball, error);
    if (status == DEM_OK) {
        dem_polyhedron_move(&core, v3_scale(ball.centre, -1));
        dem_polyhedron_scale(&core, 1 - rounding);
        status = dem_polyhedron_mesh(&core, rounding * ball.radius, request->triangles, mesh, error);
    }
    dem_polyhedron_release(&core);
    return status;
}

const dem_grain_kind dem_grain_polyhedron = {
    .name = "polyhedron",
    .paper = "Steiner 1840; Alonso-Marroquin & Wang 2009, doi:10.1007/s10035-009-0139-1",
    .about = "Rounded polyhedra: a regular solid or the hull of random points, grown by a ball.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .make = make,
};
