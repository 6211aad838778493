#include "study/cluster.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/status.h"
#include "math/quat.h"
#include "math/vec.h"

// a clump with mass, centre and moments of the union of its balls, of unit density
static dem_status make(const char *name, const dem_ball *balls, size_t count, dem_clump **clump, dem_error *error)
{
    dem_union whole;
    dem_ball *own = dem_alloc(count, sizeof *own);
    if (!own)
        return dem_fail_memory(error);
    dem_status status = dem_balls_union(balls, count, &whole, error);
    if (status == DEM_OK) {
        const dem_solid *s = &whole.solid;
        for (size_t i = 0; i < count; i++)
            own[i] = (dem_ball){quat_unrotate(s->axes, v3_sub(balls[i].centre, s->centre)), balls[i].radius};
        dem_clump_def def = {.name = name,
                             .density = 1,
                             .mass = s->volume,
                             .volume = s->volume,
                             .mass_from = DEM_MASS_FROM_UNION,
                             .position = s->centre,
                             .orientation = s->axes,
                             .union_volume = s->volume,
                             .balls = own,
                             .ball_count = count,
                             .parameters = "{}",
                             .seconds = NAN};
        for (int k = 0; k < 3; k++)
            def.inertia[k] = def.union_inertia[k] = s->principal[k];
        status = dem_clump_create(&def, clump, error);
    }
    free(own);
    return status;
}

dem_status dem_cluster_regular(size_t count, double apart, dem_clump **clump, dem_error *error)
{
    // corners of a regular tetrahedron of edge sqrt(8); the first of them are in line, and in a plane
    static const dem_vec3 corners[DEM_CLUSTER_MOST] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    dem_ball balls[DEM_CLUSTER_MOST];
    char name[40];
    if (count < 1 || count > DEM_CLUSTER_MOST || !(apart >= 0 && apart <= 1))
        return dem_fail(error, DEM_USAGE, "a cluster has 1 to 4 spheres that are 0 to 1 of a diameter apart");
    // of no distance they are one and the same sphere
    count = apart > 0 ? count : 1;
    for (size_t i = 0; i < count; i++)
        balls[i] = (dem_ball){v3_scale(corners[i], apart / sqrt(8)), 0.5};
    snprintf(name, sizeof name, "cluster of %zu", count);
    return make(name, balls, count, clump, error);
}
