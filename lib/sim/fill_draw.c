#include "sim/fill_draw.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "math/vec.h"
#include "sim/sizes.h"

// one entry of the mix as it is drawn from
typedef struct entry {
    dem_sizes sizes;
    const dem_fill_shape *shape;
    uint32_t shape_index;
    double share;   // of 1
    double given;   // bodies or kilograms so far
    size_t most;    // bodies
    double offset;  // of the sequence of its sizes
    size_t drawn;
} entry;

double dem_fill_box_volume(const dem_fill_def *fill)
{
    dem_vec3 e = v3_sub(fill->high, fill->low);
    return e.x * e.y * e.z;
}

static dem_status check_entry(const dem_mix_def *mix, size_t at, const dem_fill_shape *shapes, size_t shape_count,
                              dem_error *error)
{
    if (mix->shape >= shape_count)
        return dem_fail(error, DEM_USAGE, "fill: mix[%zu] has shape %lu, there are %zu (counted from 0)", at,
                        (unsigned long)mix->shape, shape_count);
    if (!(mix->share >= 0 && isfinite(mix->share)))
        return dem_fail(error, DEM_USAGE, "fill: the share of mix[%zu] must be positive", at);
    const dem_fill_shape *shape = &shapes[mix->shape];
    DEM_ASSERT(shape->ball_count > 0 && shape->equivalent_diameter > 0 && shape->volume > 0 && shape->mass > 0);
    return DEM_OK;
}

struct dem_fill_drawer {
    entry *entries;
    size_t count;
    bool by_mass;
    double given;  // bodies or kilograms
};

static dem_status make_entries(const dem_fill_def *fill, const dem_fill_shape *shapes, size_t shape_count,
                               entry *entries, dem_error *error)
{
    double total = 0;
    for (size_t i = 0; i < fill->mix_count; i++) {
        DEM_TRY(check_entry(&fill->mix[i], i, shapes, shape_count, error));
        total += fill->mix[i].share;
    }
    if (!(total > 0 && isfinite(total)))
        return dem_fail(error, DEM_USAGE, "fill: the mix is empty; give at least one shape a share");
    for (size_t i = 0; i < fill->mix_count; i++) {
        const dem_mix_def *mix = &fill->mix[i];
        const dem_fill_shape *shape = &shapes[mix->shape];
        dem_random r = random_stream(fill->seed, UINT64_MAX - i);
        entries[i].shape = shape;
        entries[i].shape_index = mix->shape;
        entries[i].share = mix->share / total;
        entries[i].most = mix->share > 0 ? SIZE_MAX : 0;
        entries[i].offset = random_uniform(&r);
        DEM_TRY(dem_sizes_create(&mix->size, shape->equivalent_diameter, &entries[i].sizes, error));
    }
    return DEM_OK;
}

// whole numbers nearest to the shares of `count`: what is left after rounding down goes to the largest remainders
static void apportion(entry *entries, size_t n, size_t count)
{
    size_t given = 0;
    for (size_t i = 0; i < n; i++) {
        entries[i].most = (size_t)floor(entries[i].share * (double)count);
        given += entries[i].most;
    }
    for (; given < count; given++) {
        size_t best = n;
        double most = -INFINITY;
        for (size_t i = 0; i < n; i++) {
            double left = entries[i].share * (double)count - (double)entries[i].most;
            if (entries[i].share > 0 && left > most)
                most = left, best = i;
        }
        entries[best].most++;
    }
}

// the entry that is farthest behind when `total` has been given
static entry *next_entry(entry *entries, size_t n, double total)
{
    entry *best = NULL;
    double most = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        double behind = entries[i].share * total - entries[i].given;
        if (entries[i].drawn < entries[i].most && behind > most)
            most = behind, best = &entries[i];
    }
    return best;
}

static dem_fill_draw draw(entry *e)
{
    const double golden = 0.61803398874989485;
    double u = e->offset + golden * (double)e->drawn++;
    double diameter = dem_sizes_draw(&e->sizes, u - floor(u));
    return (dem_fill_draw){e->shape_index, diameter / e->shape->equivalent_diameter};
}

dem_status dem_fill_drawer_create(const dem_fill_def *fill, const dem_fill_shape *shapes, size_t shape_count,
                                  dem_fill_drawer **drawer, dem_error *error)
{
    dem_fill_drawer *d = *drawer = dem_alloc_zero(1, sizeof *d);
    if (!d)
        return dem_fail_memory(error);
    d->count = fill->mix_count;
    d->by_mass = fill->share_by_mass;
    d->entries = dem_alloc_zero(fill->mix_count, sizeof *d->entries);
    return d->entries ? make_entries(fill, shapes, shape_count, d->entries, error) : dem_fail_memory(error);
}

void dem_fill_drawer_destroy(dem_fill_drawer *d)
{
    for (size_t i = 0; d && d->entries && i < d->count; i++)
        dem_sizes_release(&d->entries[i].sizes);
    if (d)
        free(d->entries);
    free(d);
}

dem_fill_draw dem_fill_drawer_next(dem_fill_drawer *d)
{
    // by number one body more is to be given, so the shares of that
    entry *e = next_entry(d->entries, d->count, d->by_mass ? d->given : d->given + 1);
    dem_fill_draw next = draw(e);
    double amount = d->by_mass ? e->shape->mass * fill_bulk(e->shape, next.scale) : 1;
    e->given += amount;
    d->given += amount;
    return next;
}

bool dem_fill_drawer_quantile(const dem_fill_drawer *d, size_t of, double u, dem_fill_draw *out)
{
    if (of >= d->count)
        return false;
    const entry *e = &d->entries[of];
    *out = (dem_fill_draw){e->shape_index, dem_sizes_draw(&e->sizes, u) / e->shape->equivalent_diameter};
    return true;
}

// `target`: volume of solids to come near to [m^3]; INFINITY: fill->count tells
static dem_status draw_all(const dem_fill_def *fill, dem_fill_drawer *drawer, const dem_fill_shape *shapes,
                           double target, dem_fill_draw **draws, size_t *count, dem_error *error)
{
    double volume = 0;
    size_t capacity = 0;
    while (isfinite(target) ? volume < target : *count < fill->count) {
        if (!dem_grow(draws, &capacity, *count, sizeof **draws))
            return dem_fail_memory(error);
        if (*count >= INT32_MAX)
            return dem_fail(error, DEM_USAGE, "fill: more than 2147483647 bodies; use a smaller box or larger bodies");
        dem_fill_draw d = dem_fill_drawer_next(drawer);
        double part = shapes[d.shape].volume * fill_bulk(&shapes[d.shape], d.scale);
        (*draws)[(*count)++] = d;
        volume += part;
        // the last one only where it comes nearer
        if (isfinite(target) && volume > target && volume - target > target - (volume - part) && *count > 1)
            --*count;
    }
    return DEM_OK;
}

static dem_status check(const dem_fill_def *fill, dem_error *error)
{
    dem_vec3 e = v3_sub(fill->high, fill->low);
    if (!(e.x > 0 && e.y > 0 && e.z > 0 && isfinite(e.x + e.y + e.z)))
        return dem_fail(error, DEM_USAGE, "fill: the box needs a lower and an upper corner with room between them");
    if (!(fill->gap >= 0 && isfinite(fill->gap)))
        return dem_fail(error, DEM_USAGE, "fill: the gap must not be negative");
    if (fill->count == 0 && !(fill->void_ratio > 0 && isfinite(fill->void_ratio)))
        return dem_fail(error, DEM_USAGE, "fill: give a count or a void ratio, either of them above 0");
    return DEM_OK;
}

dem_status dem_fill_draws(const dem_fill_def *fill, const dem_fill_shape *shapes, size_t shape_count,
                          dem_fill_draw **draws, size_t *count, dem_error *error)
{
    *draws = NULL;
    *count = 0;
    DEM_TRY(check(fill, error));
    dem_fill_drawer *drawer;
    dem_status status = dem_fill_drawer_create(fill, shapes, shape_count, &drawer, error);
    if (status == DEM_OK) {
        if (fill->count > 0 && !fill->share_by_mass)
            apportion(drawer->entries, fill->mix_count, fill->count);
        double target = fill->count > 0 ? INFINITY : dem_fill_box_volume(fill) / (1 + fill->void_ratio);
        status = draw_all(fill, drawer, shapes, target, draws, count, error);
    }
    dem_fill_drawer_destroy(drawer);
    if (status != DEM_OK) {
        free(*draws);
        *draws = NULL;
    }
    return status;
}
