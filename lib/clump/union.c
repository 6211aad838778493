#include "clump/union.h"

#include <stdlib.h>

#include "geom/union.h"
#include "math/quat.h"

dem_status dem_balls_union(const dem_ball *balls, size_t count, dem_union *result, dem_error *error)
{
    *result = (dem_union){0};
    DEM_TRY(dem_balls_check(balls, count, error));
    // about a ball of the clump, so that a clump far from the origin keeps its centre and inertia
    dem_ball *local = dem_alloc(count, sizeof *local);
    if (!local)
        return dem_fail_memory(error);
    dem_vec3 origin = count ? balls[0].centre : v3(0, 0, 0);
    for (size_t i = 0; i < count; i++)
        local[i] = (dem_ball){v3_sub(balls[i].centre, origin), balls[i].radius};
    dem_ball_union u;
    dem_status status = dem_ball_union_compute(local, count, false, 1, &u, error);
    if (status == DEM_OK) {
        result->solid = dem_solid_from_moments(u.moments, origin, u.area);
        result->pieces = dem_ball_pieces(local, count, 0, NULL);
        result->redundant = u.redundant;
        dem_ball_union_release(&u);
        if (result->pieces == 0)
            status = dem_fail_memory(error);
    }
    free(local);
    return status;
}

dem_clump_def dem_clump_def_of_balls(const char *name, const dem_ball *balls, size_t count, const dem_union *whole,
                                     double density)
{
    dem_clump_def def = {.name = name,
                         .density = density,
                         .orientation = {1, 0, 0, 0},
                         .union_volume = whole->solid.volume,
                         .union_centre = whole->solid.centre,
                         .balls = balls,
                         .ball_count = count,
                         .seconds = NAN};
    double *unknown[] = {&def.fidelity.iou_gap, &def.shape.equivalent_diameter};
    size_t figures[] = {offsetof(dem_fidelity, pieces) / sizeof(double), sizeof(dem_shape) / sizeof(double)};
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < figures[k]; i++)
            unknown[k][i] = NAN;
    def.fidelity.pieces = whole->pieces;
    for (int k = 0; k < 3; k++)
        def.union_inertia[k] = density * whole->solid.principal[k];
    return def;
}

dem_status dem_clump_of_union(const char *name, const dem_ball *balls, size_t count, double density, dem_clump **clump,
                              dem_error *error)
{
    dem_union whole;
    DEM_TRY(dem_balls_union(balls, count, &whole, error));
    dem_ball *own = dem_alloc(count, sizeof *own);
    if (!own)
        return dem_fail_memory(error);
    const dem_solid *s = &whole.solid;
    for (size_t i = 0; i < count; i++)
        own[i] = (dem_ball){quat_unrotate(s->axes, v3_sub(balls[i].centre, s->centre)), balls[i].radius};
    // the union once more, as the balls now stand: as whoever reads them back will have it
    dem_union turned;
    dem_status status = dem_balls_union(own, count, &turned, error);
    if (status == DEM_OK) {
        dem_clump_def def = dem_clump_def_of_balls(name, own, count, &turned, density);
        def.mass = density * s->volume;
        def.volume = def.mass / density;
        def.mass_from = DEM_MASS_FROM_UNION;
        for (int k = 0; k < 3; k++)
            def.inertia[k] = density * s->principal[k];
        status = dem_clump_create(&def, clump, error);
    }
    free(own);
    return status;
}
