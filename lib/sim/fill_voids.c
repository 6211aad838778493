// What is left of space, as a list of cells that may hold the centre of a body. Trials are drawn from these cells only;
// cells found covered are dropped, and where trials fail too often all are split. A list made for a core serves all
// bodies with that core or a larger one (compare Zhang & Torquato 2013, doi:10.1103/PhysRevE.88.053312).
#include <stdlib.h>

#include "base/memory.h"
#include "sim/fill_stages.h"

enum {
    MOST_CELLS = 4000000,
    MOST_TRIALS = 20000,  // for one body
};

typedef struct cell {
    int32_t at[3];
} cell;

typedef struct voids {
    cell *cells;
    size_t count, capacity;
    dem_vec3 origin;
    double size;      // edge of a cell [m]
    double smallest;  // that cells are split to [m]
    double core;      // of the bodies it is for [m]
    size_t missed;    // trials since the cells were last gone through
} voids;

static dem_vec3 corner(const voids *v, cell c)
{
    return v3(v->origin.x + c.at[0] * v->size, v->origin.y + c.at[1] * v->size, v->origin.z + c.at[2] * v->size);
}

static bool covered(dem_room *room, const voids *v, cell c)
{
    double half = v->size / 2;
    dem_vec3 centre = v3_add(corner(v, c), v3(half, half, half));
    return dem_room_covered(room, centre, half * 1.7320508075688774, v->core);
}

static bool keep(dem_filling *f, voids *v, cell c)
{
    if (covered(f->room, v, c))
        return true;
    if (!dem_grow(&v->cells, &v->capacity, v->count, sizeof *v->cells))
        return false;
    v->cells[v->count++] = c;
    return true;
}

// the least core of the bodies about as large as the one to be placed, so that the list serves all of them
static double least_core(dem_filling *f)
{
    dem_fill_take(f, f->placed);
    double radius = f->trial.radius, core = f->trial.core;
    for (size_t i = f->placed; i < f->count; i++) {
        dem_fill_take(f, i);
        if (f->trial.radius < 0.9 * radius)
            break;
        core = fmin(core, f->trial.core);
    }
    dem_fill_take(f, f->placed);
    return core;
}

// sets the edge of the cells that cover this, and how many there are along each axis
static void set_cells(dem_filling *f, voids *v, const double extent[3], int32_t n[3])
{
    double all;
    v->size = 0.6 * fmax(v->core, 0.3 * f->trial.radius);
    do {
        all = 1;
        for (int k = 0; k < 3; k++) {
            double along = floor(extent[k] / v->size) + 1;
            n[k] = (int32_t)fmin(along, MOST_CELLS);
            all *= along;
        }
        v->size *= all > MOST_CELLS ? 1.1 : 1;
    } while (all > MOST_CELLS);
}

// cells over everything where the centre of such a body may be
static dem_filled make_voids(dem_filling *f, voids *v)
{
    const dem_room *room = f->room;
    v->core = least_core(f);
    double extent[3];
    int32_t n[3];
    v->origin = room->low;
    for (int k = 0; k < 3; k++) {
        double margin = room->spans[k] ? 0 : v->core;
        v3_set(&v->origin, k, v3_get(room->low, k) + margin);
        bool alone = room->flat && k == 2;
        extent[k] = alone ? 0 : fmax(v3_get(room->high, k) - v3_get(room->low, k) - 2 * margin, 0);
    }
    set_cells(f, v, extent, n);
    v->smallest = 0.01 * f->trial.radius;
    v->count = v->missed = 0;
    for (int32_t z = 0; z < n[2]; z++)
        for (int32_t y = 0; y < n[1]; y++)
            for (int32_t x = 0; x < n[0]; x++) {
                if (dem_fill_stop(f))
                    return DEM_FILL_STOPPED;
                if (!keep(f, v, (cell){{x, y, z}}))
                    return DEM_FILL_NO_MEMORY;
            }
    return DEM_FILLED;
}

// drops what is covered by now, and cuts each cell in eight where that is worth it
static dem_filled refine(dem_filling *f, voids *v)
{
    cell *old = v->cells;
    size_t count = v->count;
    bool split = count <= MOST_CELLS / 8 && v->size > v->smallest;
    v->cells = NULL;
    v->count = v->capacity = v->missed = 0;
    if (split)
        v->size /= 2;
    dem_filled result = DEM_FILLED;
    for (size_t i = 0; i < count && result == DEM_FILLED; i++)
        for (int part = 0; part < (split ? 8 : 1) && result == DEM_FILLED; part++) {
            const int32_t *a = old[i].at;
            cell c =
                split ? (cell){{2 * a[0] + (part & 1), 2 * a[1] + (part >> 1 & 1), 2 * a[2] + (part >> 2)}} : old[i];
            if (dem_fill_stop(f))
                result = DEM_FILL_STOPPED;
            else if (!keep(f, v, c))
                result = DEM_FILL_NO_MEMORY;
        }
    free(old);
    return result;
}

// one trial in a cell; its position
static bool try_cell(dem_filling *f, voids *v, dem_random *r, dem_vec3 *position)
{
    size_t at = random_below(r, v->count);
    dem_vec3 low = corner(v, v->cells[at]);
    dem_room_sight sight = DEM_ROOM_NEAR;
    *position = fill_point(r, low, v3_add(low, v3(v->size, v->size, v->size)));
    dem_room_turn(f->room, &f->trial, fill_orientation(r));
    if (dem_room_inside(f->room, &f->trial, *position) && dem_fill_try(f, r, *position, &sight))
        return true;
    v->missed++;
    if (sight == DEM_ROOM_BLOCKED && covered(f->room, v, v->cells[at]))
        v->cells[at] = v->cells[--v->count];
    return false;
}

static dem_filled place_one(dem_filling *f, voids *v)
{
    // the streams of the first stage, counted on
    dem_random r = random_stream(f->fill->seed, f->order[f->placed]);
    r.counter = UINT64_C(1) << 32;
    dem_fill_take(f, f->placed);
    for (size_t i = 0; i < MOST_TRIALS && v->count > 0; i++) {
        dem_vec3 position;
        if (dem_fill_stop(f))
            return DEM_FILL_STOPPED;
        if (try_cell(f, v, &r, &position))
            return dem_fill_put(f, position) ? DEM_FILLED : DEM_FILL_NO_MEMORY;
        if (f->room->failed)
            return DEM_FILL_NO_MEMORY;
        if (v->missed > 2 * v->count + 1000) {
            dem_filled result = refine(f, v);
            if (result != DEM_FILLED)
                return result;
        }
    }
    return DEM_FILL_FULL;
}

dem_filled dem_fill_voids(dem_filling *f)
{
    voids v = {.core = INFINITY};
    dem_filled result = DEM_FILLED;
    while (f->placed < f->count && result == DEM_FILLED) {
        dem_fill_take(f, f->placed);
        if (f->trial.core < v.core)
            result = make_voids(f, &v);
        if (result == DEM_FILLED)
            result = place_one(f, &v);
    }
    free(v.cells);
    return result;
}
