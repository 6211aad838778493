// The columns of contacts: room for them, and what one contact has in each.
#include "sim/contacts.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

static void *grown_column(const void *old, const dem_contacts *from, const dem_segment *to, size_t segments,
                          size_t capacity, size_t width)
{
    char *p = aligned_alloc(64, (capacity * width + 127) / 64 * 64);
    if (!p)
        return NULL;
    memset(p, 0, capacity * width);
    for (size_t i = 0; old && i < segments; i++) {
        const dem_segment *s = &from->segments[i];
        memcpy(p + to[i].begin * width, (const char *)old + s->begin * width, (s->end - s->begin) * width);
    }
    return p;
}

// Moves every segment to its place in larger columns, one column after the other: all twice would be most of the memory
// of a run. Without memory no contacts are left.
static bool move_columns(const dem_features *f, dem_contacts *contacts, const dem_segment *to, size_t segments,
                         size_t capacity, int form)
{
    bool walls = form >= 0, mesh = form == DEM_FORM_MESH, good = true;
#define COLUMN(type, name, unit, when, about)                                                                          \
    if ((when) && good) {                                                                                              \
        type *grown = grown_column(contacts->columns.name, contacts, to, segments, capacity, sizeof(type));            \
        good = grown;                                                                                                  \
        if (good) {                                                                                                    \
            free(contacts->columns.name);                                                                              \
            contacts->columns.name = grown;                                                                            \
        }                                                                                                              \
    }
    DEM_CONTACT_COLUMNS(COLUMN)
#undef COLUMN
    contacts->capacity = good ? capacity : 0;
    for (size_t i = 0; i < segments; i++) {
        dem_segment *s = &contacts->segments[i];
        size_t count = good ? s->end - s->begin : 0;
        s->begin = good ? to[i].begin : 0;
        s->end = s->begin + count;
        s->capacity = good ? to[i].capacity : 0;
    }
    return good;
}

dem_status dem_contacts_create(dem_world *w, dem_contacts *contacts, int form, dem_error *error)
{
    *contacts = (dem_contacts){.segments = dem_alloc_zero(w->segment_count, sizeof *contacts->segments)};
    if (w->features.soft)
        contacts->runs = dem_alloc_zero(w->segment_count, sizeof *contacts->runs);
    if (!contacts->segments || (w->features.soft && !contacts->runs) ||
        !move_columns(&w->features, contacts, contacts->segments, w->segment_count, 0, form))
        return dem_fail_memory(error);
    return DEM_OK;
}

void dem_contacts_release(dem_contacts *contacts, size_t segments)
{
    for (size_t i = 0; contacts->runs && i < segments; i++)
        dem_soft_runs_release(&contacts->runs[i]);
    free(contacts->runs);
#define COLUMN(type, name, unit, when, about) free(contacts->columns.name);
    DEM_CONTACT_COLUMNS(COLUMN)
#undef COLUMN
    free(contacts->segments);
    free(contacts->slot_body);
}

bool dem_contacts_reserve(dem_world *w, dem_contacts *contacts, int form, const size_t *needed)
{
    bool fits = true;
    for (size_t i = 0; i < w->segment_count; i++)
        fits = fits && (!contacts->segments[i].dirty || contacts_padded(needed[i]) <= contacts->segments[i].capacity);
    if (fits)
        return true;
    dem_segment *to = dem_alloc_zero(w->segment_count, sizeof *to);
    size_t capacity = 0;
    for (size_t i = 0; to && i < w->segment_count; i++) {
        const dem_segment *s = &contacts->segments[i];
        size_t most = s->dirty && needed[i] > s->end - s->begin ? needed[i] : s->end - s->begin;
        // short lists grow more in proportion
        to[i].capacity = most <= s->capacity && s->capacity < 2 * most ? s->capacity : contacts_padded(most + most / 5 + 16);
        if (most == 0)
            to[i].capacity = 0;
        to[i].begin = capacity;
        capacity += to[i].capacity;
    }
    bool good = to && move_columns(&w->features, contacts, to, w->segment_count, capacity, form);
    free(to);
    return good;
}

size_t dem_contact_bytes(const dem_features *f, int form)
{
    bool walls = form >= 0, mesh = form == DEM_FORM_MESH;
    size_t bytes = 0;
#define COLUMN(type, name, unit, when, about)                                                                          \
    if (when)                                                                                                          \
        bytes += sizeof(type);
    DEM_CONTACT_COLUMNS(COLUMN)
#undef COLUMN
    return bytes;
}

dem_contact_history dem_history_get(const dem_contact_columns *c, size_t at)
{
    dem_contact_history h = {.twist = c->twist ? c->twist[at] : 0,
                             .patch = c->patch ? c->patch[at] : 0,
                             .attached = c->attached ? c->attached[at] : 0,
                             .loss = c->loss ? c->loss[at] : 0};
    for (int k = 0; k < 3; k++) {
        h.spring[k] = c->spring[k] ? c->spring[k][at] : 0;
        h.dash[k] = c->dash[k] ? c->dash[k][at] : 0;
    }
    return h;
}

void dem_history_put(const dem_contact_columns *c, size_t at, const dem_contact_history *h)
{
    for (int k = 0; k < 3; k++) {
        if (c->spring[k])
            c->spring[k][at] = h->spring[k];
        if (c->dash[k])
            c->dash[k][at] = h->dash[k];
    }
    if (c->twist)
        c->twist[at] = h->twist;
    if (c->patch)
        c->patch[at] = h->patch;
    if (c->attached)
        c->attached[at] = h->attached;
    if (c->loss)
        c->loss[at] = h->loss;
}

dem_contact_extras dem_extras_of(const dem_contact_columns *c)
{
    dem_contact_extras extras = {.count = 0};
#define EXTRA(type, name, unit, when, about)                                                                           \
    if (c->name)                                                                                                       \
        extras.column[extras.count++] = c->name;
    DEM_CONTACT_EXTRAS(EXTRA)
#undef EXTRA
    return extras;
}

bool dem_extras_keep(const dem_contact_extras *extras, const dem_segment *s, const dem_contact_item *items,
                     size_t count, dem_extras_kept *kept)
{
    size_t needed = (size_t)extras->count * count;
    while (kept->capacity < needed)
        if (!dem_grow(&kept->numbers, &kept->capacity, kept->capacity, sizeof *kept->numbers))
            return false;
    for (int e = 0; e < extras->count; e++)
        for (size_t k = 0; k < count; k++)
            kept->numbers[(size_t)e * count + k] =
                items[k].old ? extras->column[e][s->begin + items[k].old - 1] : 0;
    return true;
}

void dem_extras_give(const dem_contact_extras *extras, const dem_segment *s, size_t count, size_t full,
                     const dem_extras_kept *kept)
{
    for (int e = 0; e < extras->count; e++)
        for (size_t k = 0; k < full; k++)
            extras->column[e][segment_place(s, k)] = k < count ? kept->numbers[(size_t)e * count + k] : 0;
}

dem_contact_item dem_contact_get(const dem_contact_columns *c, size_t at)
{
    return (dem_contact_item){.a = c->a[at],
                              .b = c->b ? c->b[at] : 0,
                              .sphere_a = c->sphere_a[at],
                              .sphere_b = c->sphere_b[at],
                              .shift = c->shift ? c->shift[at] : 0,
                              .law = c->law ? c->law[at] : 0,
                              .history = dem_history_get(c, at)};
}

void dem_contact_put(const dem_contact_columns *c, size_t at, const dem_contact_item *item)
{
    c->a[at] = item->a;
    c->sphere_a[at] = item->sphere_a;
    c->sphere_b[at] = item->sphere_b;
    if (c->b)
        c->b[at] = c->target[at] = item->b;
    if (c->shift)
        c->shift[at] = item->shift;
    if (c->law)
        c->law[at] = item->law;
    dem_history_put(c, at, &item->history);
    if (c->weight)
        c->weight[at] = 1;
    // a mesh contact that has not been measured yet does not touch
    for (int k = 0; c->geometry[0] && k < 7; k++)
        c->geometry[k][at] = k == 3 ? DEM_MESH_NO_OVERLAP : 0;
}

dem_contact_item dem_contact_idle(const dem_world *w, int form)
{
    uint32_t wall = (uint32_t)w->walls.count + (form == DEM_FORM_CYLINDER);
    return (dem_contact_item){.a = w->bodies.dummy, .b = w->bodies.dummy + 1, .sphere_b = form < 0 ? 0 : wall};
}
