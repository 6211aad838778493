#include "study/cluster.h"

#include <math.h>
#include <stdio.h>

#include "base/status.h"
#include "clump/union.h"
#include "math/vec.h"

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
    return dem_clump_of_union(name, balls, count, 1, clump, error);
}
