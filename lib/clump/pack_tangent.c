// Balls tangent to the surface, and choices among them that two parameters steer.
#include <stdlib.h>

#include "clump/pack_candidates.h"
#include "clump/pack_classic.h"
#include "geom/spread.h"

enum { AT_ONCE = 2048, BISECTIONS = 16 };

static const double nearly = 1.004;  // a ball may be so much larger than the distance of its centre to the surface

// the medial radius is found to a tolerance and, in the middle of round grains, not always: the depth has the last word
static dem_tangent tangent_at(const dem_classic *c, dem_surface_point at)
{
    double radius = dem_medial_radius(&c->grain->tree, at.point, at.normal);
    dem_vec3 centre = v3_along(at.point, -radius, at.normal);
    return (dem_tangent){at.point, {centre, fmin(radius, nearly * dem_classic_depth(c, centre))}};
}

dem_status dem_classic_tangents(const dem_classic *c, size_t count, dem_tangent **tangents, size_t *tangent_count,
                                dem_error *error)
{
    dem_status status = DEM_OK;
    dem_surface_point *points = dem_alloc(count, sizeof *points);
    dem_tangent *all = dem_alloc(count, sizeof *all);
    size_t kept = 0;
    if (!points || !all) {
        status = dem_fail_memory(error);
        goto done;
    }
    dem_tree_spread(&c->grain->tree, points, &count);
    for (size_t begin = 0; begin < count && status == DEM_OK; begin += AT_ONCE) {
        size_t end = begin + AT_ONCE < count ? begin + AT_ONCE : count;
#pragma omp parallel for num_threads(c->threads) schedule(dynamic, 32)
        for (size_t i = begin; i < end; i++)
            all[i] = tangent_at(c, points[i]);
        status = dem_classic_go_on(c, 0.5 * (double)end / (double)count, error);
    }
    for (size_t i = 0; i < count; i++)
        if (all[i].ball.radius > 0)
            all[kept++] = all[i];
done:
    free(points);
    if (status != DEM_OK) {
        free(all);
        all = NULL;
    }
    *tangents = all;
    *tangent_count = kept;
    return status;
}

typedef struct choice {
    const dem_thinning *thinning;
    double given_size, given_spacing;  // NAN: not
    size_t most;
    dem_ball *balls;
} choice;

// spacings crowd where many balls are
static double spacing_at(const dem_thinning *t, double part)
{
    return t->most + (t->fewest - t->most) * part * part;
}

static size_t choose(const choice *s, double size, double spacing)
{
    return s->thinning->choose(s->thinning->user, size, spacing, s->most, s->balls);
}

// the spacing with as many balls as are allowed, or just fewer; the fewest where there are always more
static double find_spacing(const choice *s, double size)
{
    double low = 0, high = 1;
    if (choose(s, size, spacing_at(s->thinning, low)) < s->most)
        return spacing_at(s->thinning, low);
    for (int k = 0; k < BISECTIONS; k++) {
        double middle = (low + high) / 2;
        if (choose(s, size, spacing_at(s->thinning, middle)) < s->most)
            high = middle;
        else
            low = middle;
    }
    return spacing_at(s->thinning, high);
}

// the spacing given or found for a size, and the balls of that choice; false: there are too many of them
static bool choose_at(const dem_classic *c, choice *s, double size, double *spacing, size_t *count)
{
    size_t allowed = c->options->spheres;
    s->most = allowed + 1 < s->thinning->limit ? allowed + 1 : s->thinning->limit + 1;
    *spacing = isnan(s->given_spacing) ? find_spacing(s, size) : s->given_spacing;
    *count = choose(s, size, *spacing);
    return *count <= allowed;
}

static dem_status take(dem_classic *c, const choice *s, double size, double spacing, size_t count, double *least,
                       dem_error *error)
{
    bool kept;
    DEM_TRY(dem_classic_offer(c, s->balls, count, least, &kept, error));
    if (kept) {
        c->value[s->thinning->size_parameter] = size;
        c->value[s->thinning->spacing_parameter] = spacing;
    }
    return DEM_OK;
}

static dem_status thin(dem_classic *c, choice *s, dem_error *error)
{
    const dem_thinning *t = s->thinning;
    size_t sizes = isnan(s->given_size) ? t->size_count : 1, count;
    double least = INFINITY, spacing, crowded_size = 0, crowded_spacing = 0;
    for (size_t k = 0; k < sizes; k++) {
        double size = isnan(s->given_size) ? t->sizes[k] : s->given_size;
        if (choose_at(c, s, size, &spacing, &count)) {
            DEM_TRY(take(c, s, size, spacing, count, &least, error));
        } else {
            crowded_size = size;  // of larger ones there will be fewer
            crowded_spacing = spacing;
        }
        DEM_TRY(dem_classic_go_on(c, 0.5 + 0.5 * (double)(k + 1) / (double)sizes, error));
    }
    if (c->balls)
        return DEM_OK;
    // always too many: the first of them, told to the caller where it is he who gave the spacing
    s->most = isnan(s->given_spacing) ? c->options->spheres : t->limit;
    count = choose(s, crowded_size, crowded_spacing);
    return take(c, s, crowded_size, crowded_spacing, count, &least, error);
}

dem_status dem_classic_thin(dem_classic *c, const dem_thinning *thinning, dem_error *error)
{
    choice s = {thinning, c->value[thinning->size_parameter], c->value[thinning->spacing_parameter], 0,
                dem_alloc(thinning->limit + 1, sizeof *s.balls)};
    if (!s.balls)
        return dem_fail_memory(error);
    dem_status status = thin(c, &s, error);
    free(s.balls);
    return status;
}
