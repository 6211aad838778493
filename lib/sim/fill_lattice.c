// A face-centred cubic lattice, stretched along the axes to fill the box: sites (i, j, k) with i + j + k even, every
// one with room for the largest bounding sphere. Bodies take sites at random and are moved off them by half of what is
// left.
#include <stdlib.h>

#include "base/memory.h"
#include "sim/fill_stages.h"

enum { TRIALS = 8 };  // at one site

typedef struct lattice {
    int64_t count[3];
    dem_vec3 origin, pitch;  // of half the cubic cell [m]
    double slack;            // least distance between neighbours, less what they need [m]
} lattice;

static double nearest(dem_vec3 pitch)
{
    double x = pitch.x, y = pitch.y, z = pitch.z;
    double twice = 2 * fmin(x, fmin(y, z));
    return fmin(twice, fmin(hypot(x, y), fmin(hypot(y, z), hypot(z, x))));
}

// the lattice whose half cells are as near to `pitch` as whole numbers allow, but not below
static lattice lattice_of(const dem_room *room, double margin, double pitch)
{
    lattice l = {.origin = room->low};
    for (int k = 0; k < 3; k++) {
        double length = v3_get(room->high, k) - v3_get(room->low, k);
        if (room->spans[k]) {
            // an even number, so that the two ends agree
            l.count[k] = 2 * (int64_t)floor(length / (2 * pitch));
            v3_set(&l.pitch, k, l.count[k] ? length / (double)l.count[k] : INFINITY);
            continue;
        }
        length = room->flat && k == 2 ? 0 : length - 2 * margin;
        l.count[k] = length >= 0 ? (int64_t)floor(length / pitch) + 1 : 0;
        v3_set(&l.origin, k, v3_get(room->low, k) + (l.count[k] > 1 ? margin : margin + length / 2));
        if (room->flat && k == 2)
            l.origin.z = room_point(room, l.origin).z;
        // layers that are alone have no neighbours along this axis; any large number will do
        v3_set(&l.pitch, k, l.count[k] > 1 ? length / (double)(l.count[k] - 1) : 4 * pitch);
    }
    return l;
}

static double sites(const lattice *l)
{
    return ceil((double)l->count[0] * (double)l->count[1] * (double)l->count[2] / 2);
}

// the widest lattice with enough sites; false: there is none
static bool find(const dem_filling *f, double radius, lattice *l)
{
    const dem_room *room = f->room;
    double need = (2 * radius + room->gap) * (1 + 1e-12), least = need * 0.70710678118654757, most = 64 * least;
    double margin = radius + 2 * room->rounding;
    *l = lattice_of(room, margin, least);
    if (sites(l) < (double)f->count)
        return false;
    for (int i = 0; i < 60; i++) {
        double pitch = (least + most) / 2;
        lattice wider = lattice_of(room, margin, pitch);
        if (sites(&wider) >= (double)f->count) {
            least = pitch;
            *l = wider;
        } else
            most = pitch;
    }
    l->slack = fmax(nearest(l->pitch) - need, 0);
    return true;
}

static dem_vec3 site(const lattice *l, uint64_t at)
{
    // of each pair of neighbours along x the one with an even sum
    int64_t half = (l->count[0] + 1) / 2, i = (int64_t)at % half, j = (int64_t)at / half % l->count[1];
    int64_t k = (int64_t)at / half / l->count[1];
    i = 2 * i + (j + k) % 2;
    return v3(l->origin.x + (double)i * l->pitch.x, l->origin.y + (double)j * l->pitch.y,
              l->origin.z + (double)k * l->pitch.z);
}

static bool exists(const lattice *l, uint64_t at)
{
    int64_t half = (l->count[0] + 1) / 2, i = (int64_t)at % half, j = (int64_t)at / half % l->count[1];
    int64_t k = (int64_t)at / half / l->count[1];
    return 2 * i + (j + k) % 2 < l->count[0];
}

static dem_vec3 in_ball(dem_random *r)
{
    for (;;) {
        dem_vec3 p = fill_point(r, v3(-1, -1, -1), v3(1, 1, 1));
        if (v3_norm2(p) <= 1)
            return p;
    }
}

static bool place_at(dem_filling *f, const lattice *l, dem_random *r, dem_vec3 at, dem_vec3 *position)
{
    dem_room_sight sight;
    for (int i = 0; i < TRIALS; i++) {
        dem_room_turn(f->room, &f->trial, fill_orientation(r));
        *position = v3_along(at, l->slack / 2 * (1 - 1e-9), in_ball(r));
        if (dem_room_inside(f->room, &f->trial, *position) && dem_fill_try(f, r, *position, &sight))
            return true;
    }
    return false;
}

static dem_filled place_all(dem_filling *f, const lattice *l, uint64_t *order, size_t count)
{
    dem_random r = random_stream(f->fill->seed, UINT64_MAX / 3);
    for (size_t i = 0; i < count && f->placed < f->count; i++) {
        // what is left of the sites, in random order
        size_t other = i + random_below(&r, count - i);
        uint64_t at = order[other];
        order[other] = order[i];
        dem_vec3 position;
        if (dem_fill_stop(f))
            return DEM_FILL_STOPPED;
        dem_fill_take(f, f->placed);
        if (place_at(f, l, &r, site(l, at), &position) && !dem_fill_put(f, position))
            return DEM_FILL_NO_MEMORY;
        if (f->room->failed)
            return DEM_FILL_NO_MEMORY;
    }
    return f->placed == f->count ? DEM_FILLED : DEM_FILL_FULL;
}

dem_filled dem_fill_lattice(dem_filling *f)
{
    lattice l;
    dem_fill_take(f, 0);
    if (!find(f, f->trial.radius, &l))
        return DEM_FILL_FULL;
    size_t all = (size_t)((l.count[0] + 1) / 2 * l.count[1] * l.count[2]), count = 0;
    uint64_t *order = dem_alloc(all, sizeof *order);
    if (!order)
        return DEM_FILL_NO_MEMORY;
    for (size_t i = 0; i < all; i++)
        if (exists(&l, i))
            order[count++] = i;
    dem_filled result = place_all(f, &l, order, count);
    free(order);
    return result;
}
