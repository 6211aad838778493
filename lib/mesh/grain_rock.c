/// Fractured rock: a block breaks into the Voronoi cells of random points. A single grain is the cell in the middle of
/// a block of its own; dem_grain_break keeps all cells of one block. Wear rolls a ball around the inside of a cell, so
/// that faces stay where they are and edges become round.
#include "mesh/fracture.h"
#include "mesh/grain.h"

enum { EVEN, WEAR };
enum { CELLS = 64, MAX_EVEN = 20 };

static const double MOST_WEAR = 0.9, LEAST_WEAR = 1e-3;

static const dem_grain_param params[] = {
    [EVEN] = {"even", 1, 0, MAX_EVEN, "count",
              "how often the cells are evened out: 0 shards of any size, 20 all alike"},
    [WEAR] = {"wear", 0, 0, MOST_WEAR, "-", "radius of the worn edges over that of the largest ball inside: 0 sharp"},
};

static dem_status mesh_cell(dem_polyhedron *cell, double wear, size_t triangles, dem_mesh *mesh, dem_error *error)
{
    dem_ball ball = {.radius = 0};
    if (wear >= LEAST_WEAR) {
        DEM_TRY(dem_polyhedron_inball(cell, &ball, error));
        DEM_TRY(dem_polyhedron_erode(cell, wear * ball.radius, error));
    }
    return dem_polyhedron_mesh(cell, wear >= LEAST_WEAR ? wear * ball.radius : 0, triangles, mesh, error);
}

static dem_status make(const dem_ctx *ctx, const dem_grain_request *request, dem_mesh *mesh, dem_error *error)
{
    dem_fracture block;
    DEM_TRY(dem_fracture_block(ctx, (dem_box){{-2, -2, -2}, {2, 2, 2}}, CELLS, (size_t)request->values[EVEN],
                               request->seed, &block, error));
    size_t inner = 0;
    for (size_t i = 1; i < CELLS; i++)
        if (v3_norm2(block.points[i]) < v3_norm2(block.points[inner]))
            inner = i;
    dem_polyhedron *cell = &block.cells[inner];
    dem_polyhedron_measures m;
    dem_status status = dem_polyhedron_measure(cell, &m, error);
    if (status == DEM_OK) {
        dem_polyhedron_move(cell, v3_scale(m.centre, -1));
        status = mesh_cell(cell, request->values[WEAR], request->triangles, mesh, error);
    }
    dem_fracture_release(&block);
    return status;
}

dem_status dem_grain_break(const dem_ctx *ctx, const dem_grain_request *request, dem_vec3 block, size_t count,
                           dem_fracture *fracture, dem_error *error)
{
    return dem_fracture_block(ctx, (dem_box){{0, 0, 0}, block}, count, (size_t)request->values[EVEN], request->seed,
                              fracture, error);
}

dem_status dem_grain_cell(const dem_grain_request *request, dem_fracture *fracture, size_t cell, dem_mesh *mesh,
                          dem_error *error)
{
    return mesh_cell(&fracture->cells[cell], request->values[WEAR], request->triangles, mesh, error);
}

const dem_grain_kind dem_grain_rock = {
    .name = "rock",
    .paper = "Lloyd 1982, doi:10.1109/TIT.1982.1056489, for evening out",
    .about = "Fractured rock: a cell of a block broken up by random points (Voronoi), its edges sharp or worn.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .make = make,
};
