#include <stdlib.h>

#include "dem/clump.h"
#include "geom/union.h"

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
    free(local);
    if (status != DEM_OK)
        return status;
    result->solid = dem_solid_from_moments(u.moments, origin, u.area);
    result->pieces = u.pieces;
    result->redundant = u.redundant;
    dem_ball_union_release(&u);
    return DEM_OK;
}
