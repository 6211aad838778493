// Bubble pack (Taghavi 2011, the method of PFC): the medial axis as a set of bubbles, balls that touch the surface from
// inside in two places or more. The largest is taken, then again and again the largest that is left whose distance to
// all taken before is large enough, until they fall below a part of the first one's radius.
//
// Distance is measured by the angle at which two spheres meet: 180 degrees less the angle between their radii at a
// point of both surfaces. It is 0 where they touch from outside and 180 where one touches the other from inside, so
// with 180 all bubbles but the swallowed ones are taken.
#include <stdlib.h>

#include "clump/pack_classic.h"

enum { RATIO, DISTANCE };
enum { BUBBLES = 16000 };

static const dem_parameter parameters[] = {
    [RATIO] = {"ratio", NAN, 0.001, 0.999, "-", "radius of the smallest sphere over that of the largest"},
    [DISTANCE] = {"distance", NAN, 0, 180, "deg",
                  "most that two spheres may overlap, as the angle they meet at: 0 touching, more gives more spheres"},
};

typedef struct bubbles {
    const dem_tangent *items;  // largest first
    size_t count;
} bubbles;

static int larger_first(const void *pa, const void *pb)
{
    const dem_ball *a = &((const dem_tangent *)pa)->ball, *b = &((const dem_tangent *)pb)->ball;
    if (a->radius != b->radius)
        return a->radius > b->radius ? -1 : 1;
    if (a->centre.x != b->centre.x)
        return a->centre.x < b->centre.x ? -1 : 1;
    return (a->centre.y > b->centre.y) - (a->centre.y < b->centre.y);
}

// By the law of cosines; the small part more than the limit keeps a bubble from being taken twice at 180 degrees.
static bool far_enough(dem_ball a, dem_ball b, double cosine)
{
    double least = a.radius * a.radius + b.radius * b.radius + 2 * a.radius * b.radius * cosine;
    return v3_norm2(v3_sub(a.centre, b.centre)) > least + 1e-9 * a.radius * a.radius;
}

static size_t choose(const void *user, double ratio, double distance_deg, size_t most, dem_ball *balls)
{
    const bubbles *all = user;
    double cosine = cos(distance_deg * (DEM_PI / 180));
    size_t taken = 0;
    for (size_t i = 0; i < all->count && taken < most; i++) {
        dem_ball ball = all->items[i].ball;
        if (ball.radius < ratio * all->items[0].ball.radius)
            break;
        size_t k = 0;
        while (k < taken && far_enough(balls[k], ball, cosine))
            k++;
        if (k == taken)
            balls[taken++] = ball;
    }
    return taken;
}

static dem_status place(dem_classic *c, dem_error *error)
{
    static const double ratios[] = {0.02, 0.03, 0.04, 0.055, 0.07, 0.085, 0.1, 0.12, 0.14, 0.17, 0.2,
                                    0.23, 0.27, 0.31, 0.36,  0.42, 0.5,   0.6, 0.7,  0.8,  0.9};
    dem_tangent *items;
    size_t count;
    DEM_TRY(dem_classic_tangents(c, BUBBLES, &items, &count, error));
    qsort(items, count, sizeof *items, larger_first);
    bubbles all = {items, count};
    dem_status status = dem_classic_thin(c,
                                         &(dem_thinning){.choose = choose,
                                                         .user = &all,
                                                         .size_parameter = RATIO,
                                                         .spacing_parameter = DISTANCE,
                                                         .sizes = ratios,
                                                         .size_count = sizeof ratios / sizeof *ratios,
                                                         .fewest = 0,
                                                         .most = 180,
                                                         .limit = count},
                                         error);
    free(items);
    return status;
}

const dem_packer dem_packer_bubble = {
    .name = "bubble",
    .paper =
        "Taghavi 2011, Automatic clump generation based on mid-surface, 2nd FLAC/DEM Symposium; the bubble pack of PFC",
    .about =
        "Balls of the medial axis, largest first, that do not overlap those before by more than an angle. Parameters "
        "not given are those of least gap with at most -n spheres.",
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .count_parameters = 2,
    .order = "largest first",
    .run = dem_classic_run,
    .place = place,
};
