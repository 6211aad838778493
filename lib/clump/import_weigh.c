#include "clump/import_weigh.h"

#include <stdlib.h>
#include <string.h>

#include "geom/ball_tree.h"

// the union's work grows with the square of the neighbours of each sphere; so many take minutes
static const double MOST_WORK = 2e9;

static int by_value(const void *a, const void *b)
{
    const double *x = a, *y = b;  // a ball is four numbers
    for (int i = 0; i < 4; i++)
        if (x[i] != y[i])
            return x[i] < y[i] ? -1 : 1;
    return 0;
}
_Static_assert(sizeof(dem_ball) == 4 * sizeof(double), "a ball is four numbers");

// sorted, each once
static size_t unite_equal(dem_ball *balls, size_t count)
{
    size_t kept = 0;
    qsort(balls, count, sizeof *balls, by_value);
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || by_value(&balls[i], &balls[kept - 1]) != 0)
            balls[kept++] = balls[i];
    return kept;
}

static dem_status check_work(const dem_ball *balls, size_t count, dem_error *error)
{
    dem_ball_tree tree = {0};
    double work = 0;
    uint32_t *found = dem_alloc(count, sizeof *found);
    if (!found)
        return dem_fail_memory(error);
    dem_status status = dem_ball_tree_build(&tree, balls, count, error);
    for (size_t i = 0; status == DEM_OK && i < count && work <= MOST_WORK; i++) {
        double near = (double)dem_ball_tree_near(&tree, balls[i], 0, found);
        work += near * near;
    }
    if (status == DEM_OK && work > MOST_WORK)
        status =
            dem_fail(error, DEM_BAD_INPUT,
                     "its spheres overlap too often for their union to be computed; thin them out, or make a clump "
                     "of the grain's mesh");
    dem_ball_tree_release(&tree);
    free(found);
    return status;
}

dem_status dem_import_weigh(const dem_ball *balls, size_t count, dem_union *result, size_t *duplicates,
                            dem_error *error)
{
    dem_ball *unique = dem_alloc(count, sizeof *unique);
    if (!unique)
        return dem_fail_memory(error);
    memcpy(unique, balls, count * sizeof *unique);
    size_t kept = unite_equal(unique, count);
    *duplicates = count - kept;
    dem_status status = check_work(unique, kept, error);
    if (status == DEM_OK)
        status = dem_balls_union(unique, kept, result, error);
    free(unique);
    return status;
}
