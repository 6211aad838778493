// Ferellec & McDowell (2010): at a random point of the surface a sphere is grown along the inward normal, tangent to
// the surface, until it meets the surface elsewhere. Points near the surface of a sphere that is there start none;
// spheres that stay too small are dropped.
//
// The radius at which growing in steps ends is the largest one of the steps below that of the medial ball, so that is
// what is computed.
#include <stdlib.h>

#include "base/random.h"
#include "clump/pack_classic.h"

enum { DMIN, RMIN, RSTEP, PMAX };
enum { SEEDS = 16000 };

static const double smallest_step = 1e-6;  // no step at all is meant below

static const dem_parameter parameters[] = {
    [DMIN] = {"dmin", NAN, 0, 100, "d_eq", "a point of the surface nearer to a sphere starts no other one"},
    [RMIN] = {"rmin", NAN, 0, 0.5, "d_eq", "smallest radius"},
    [RSTEP] = {"rstep", 0, 0, 0.25, "d_eq", "step in which a sphere grows from rmin; 0 until it touches"},
    [PMAX] = {"pmax", 1, 0.001, 1, "-", "share of the surface points that may start a sphere"},
};

typedef struct seeds {
    dem_tangent *items;  // in random order
    size_t count, used;
    double step;
} seeds;

static double grown(double radius, double smallest, double step)
{
    return step < smallest_step ? radius : smallest + floor((radius - smallest) / step) * step;
}

static bool near_a_ball(dem_vec3 p, const dem_ball *balls, size_t count, double dmin)
{
    for (size_t k = 0; k < count; k++) {
        double reach = balls[k].radius + dmin;
        if (v3_norm2(v3_sub(p, balls[k].centre)) < reach * reach)
            return true;
    }
    return false;
}

static size_t choose(const void *user, double rmin, double dmin, size_t most, dem_ball *balls)
{
    const seeds *all = user;
    size_t taken = 0;
    for (size_t i = 0; i < all->used && taken < most; i++) {
        dem_tangent at = all->items[i];
        if (at.ball.radius < rmin || near_a_ball(at.point, balls, taken, dmin))
            continue;
        double radius = grown(at.ball.radius, rmin, all->step);
        if (!(radius > 0))
            continue;
        // smaller, still tangent
        dem_vec3 centre = v3_along(at.point, radius / at.ball.radius, v3_sub(at.ball.centre, at.point));
        balls[taken++] = (dem_ball){centre, radius};
    }
    return taken;
}

static void shuffle(seeds *all, uint64_t seed)
{
    dem_random random = random_stream(seed, 1);
    for (size_t i = all->count; i > 1; i--) {
        size_t k = random_below(&random, i);
        dem_tangent swap = all->items[k];
        all->items[k] = all->items[i - 1];
        all->items[i - 1] = swap;
    }
}

static dem_status place(dem_classic *c, dem_error *error)
{
    enum { RADII = 28 };
    double radii[RADII], largest = 0;
    seeds all = {.step = c->value[RSTEP]};
    DEM_TRY(dem_classic_tangents(c, SEEDS, &all.items, &all.count, error));
    shuffle(&all, c->options->seed);
    for (size_t i = 0; i < all.count; i++)
        largest = fmax(largest, all.items[i].ball.radius);
    for (int k = 0; k < RADII; k++)  // closer to each other where they are small, up to nearly the largest
        radii[k] = 0.98 * largest * k / (RADII - 1) * (k + RADII) / (2 * RADII - 1);
    all.used = (size_t)ceil(c->value[PMAX] * (double)all.count);
    dem_status status = dem_classic_thin(c,
                                         &(dem_thinning){.choose = choose,
                                                         .user = &all,
                                                         .size_parameter = RMIN,
                                                         .spacing_parameter = DMIN,
                                                         .sizes = radii,
                                                         .size_count = RADII,
                                                         .fewest = fmin(box_diagonal(c->grain->box), 100),
                                                         .most = 0,
                                                         .limit = all.count},
                                         error);
    free(all.items);
    return status;
}

const dem_packer dem_packer_ferellec = {
    .name = "ferellec",
    .paper = "Ferellec & McDowell 2010, Granular Matter 12, 459-467, doi:10.1007/s10035-010-0205-8",
    .about = "Spheres grown inwards from random points of the surface until they touch it elsewhere. dmin and rmin not "
             "given are those of least gap with at most -n spheres.",
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .count_parameters = 2,
    .order = "in the random order of their points",
    .run = dem_classic_run,
    .place = place,
};
