// More rows for a world that runs. Rows and segments that are there keep their numbers; only the dummies move.
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/bodies.h"
#include "sim/bonds.h"
#include "sim/broad.h"
#include "sim/measure.h"
#include "sim/population.h"

// an array of more items, the new ones 0
static bool extend(void *array, size_t old, size_t count, size_t size)
{
    void **p = array;
    char *longer = realloc(*p, count * size + 1);
    if (!longer)
        return false;
    memset(longer + old * size, 0, (count - old) * size);
    *p = longer;
    return true;
}

static bool extend_tallies(dem_world *w, size_t segments)
{
    dem_tally *all = dem_alloc_zero(segments * (1 + DEM_WALL_FORMS), sizeof *all);
    if (!all)
        return false;
    for (size_t form = 0; form < 1 + DEM_WALL_FORMS; form++)
        memcpy(all + form * segments, w->tallies + form * w->segment_count, w->segment_count * sizeof *all);
    free(w->tallies);
    w->tallies = all;
    return extend(&w->motion_tallies, w->segment_count, segments, sizeof *w->motion_tallies);
}

static bool extend_segments(dem_world *w, size_t segments)
{
    size_t old = w->segment_count;
    bool good = extend(&w->contacts.segments, old, segments, sizeof *w->contacts.segments);
    for (int form = 0; form < DEM_WALL_FORMS; form++)
        if (w->wall_contacts[form].segments)
            good = good && extend(&w->wall_contacts[form].segments, old, segments, sizeof(dem_segment));
    if (w->mesh_touches)
        good = good && extend(&w->mesh_touches, old, segments, sizeof *w->mesh_touches);
    if (w->wear_events)
        good = good && extend(&w->wear_events, old, segments, sizeof *w->wear_events);
    if (w->features.soft) {
        good = good && extend(&w->contacts.runs, old, segments, sizeof(dem_soft_runs));
        for (int form = 0; form < DEM_WALL_FORMS; form++)
            if (w->wall_contacts[form].segments)
                good = good && extend(&w->wall_contacts[form].runs, old, segments, sizeof(dem_soft_runs));
    }
    good = good && extend_tallies(w, segments);
    if (good)
        w->segment_count = segments;
    return good;
}

// what idle contacts with walls name
static void move_dummies(dem_world *w, uint32_t old)
{
    for (int form = 0; form < DEM_WALL_FORMS; form++) {
        const dem_contacts *contacts = &w->wall_contacts[form];
        for (size_t i = 0; contacts->segments && i < contacts->capacity; i++)
            if (contacts->columns.a[i] == old)
                contacts->columns.a[i] = w->bodies.dummy;
    }
}

// no new row has a pair
static bool extend_pairs(dem_world *w, size_t old, size_t rows)
{
    uint32_t **firsts[] = {&w->pairs.first, &w->pairs.adjacency_first};
    for (int k = 0; k < 2; k++) {
        if (!extend(firsts[k], old + 1, rows + 1, sizeof **firsts[k]))
            return false;
        for (size_t row = old + 1; row <= rows; row++)
            (*firsts[k])[row] = (*firsts[k])[old];
    }
    return true;
}

dem_status dem_world_grow(dem_world *w, size_t rows, dem_error *error)
{
    size_t old = w->bodies.count, padded = w->bodies.padded;
    uint32_t dummy = w->bodies.dummy;
    if (rows <= old)
        return DEM_OK;
    if (rows >= (size_t)INT32_MAX)
        return dem_fail(error, DEM_FAILED, "there would be more than 2147483647 bodies; lower the rates of the inlets");
    bool good = dem_bodies_grow(w, rows) && dem_bodies_reserve_slots(&w->bodies, w->contacts.slot_capacity) &&
                extend_segments(w, (rows + DEM_SEGMENT - 1) / DEM_SEGMENT) && extend_pairs(w, old, rows) &&
                extend(&w->asked, padded, w->bodies.padded, sizeof *w->asked) && dem_views_grow(w);
    if (w->features.watch)
        good = good && extend(&w->strained, padded, w->bodies.padded, sizeof *w->strained);
    if (w->features.soft)
        good = good && extend(&w->soft.first, padded, w->bodies.padded, sizeof *w->soft.first) &&
               extend(&w->soft.radius, padded, w->bodies.padded, sizeof *w->soft.radius);
    if (!good)
        return dem_fail_memory(error);
    if (w->bonds && !dem_bonds_grow(w, old))
        return dem_fail_memory(error);
    move_dummies(w, dummy);
    dem_search_destroy(w->search);
    w->search = NULL;
    // the slots of momenta have moved behind the new rows
    for (size_t i = 0; i < w->segment_count; i++)
        w->contacts.segments[i].dirty = true;
    w->parts[w->threads] = 0;
    return dem_search_create(w, error);
}
