// Lists of the contacts of pairs.
#include "sim/contacts.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/bodies.h"

enum { SEGMENTS_TO_SHARE = 8 };  // dirty ones that are worth more than one thread
enum { IDLE_MOST = 12 };         // idle places beyond the spare ones that a step may come by
enum { SPARE_MOST = 24 };        // places a list may spare
enum { REBUILT_SELDOM = 60 };    // steps: where a list is rebuilt less often, spare places cost more than they save
enum { SPARED_LONG = 400 };      // steps: after these it has to show again that it needs them

enum { HISTORY = 10 };

typedef struct entry {
    uint32_t a, b, sphere_a, sphere_b, shift, law;
    uint32_t old;  // 1 + its place in the old list, from the begin of its segment; 0: it is new
} entry;

// A list in the making. What its contacts remember is copied column by column, a third of the time of contact by
// contact: each column is one row of memory, and most of them are absent.
typedef struct list {
    entry *items;
    size_t count, capacity;
    double *columns[HISTORY + DEM_EXTRAS_MOST];  // that remember
    size_t column_count;
    double *kept;  // [columns * count]
    size_t kept_capacity;
} list;

static list list_of(const dem_contact_columns *c)
{
    double *const history[HISTORY] = {c->spring[0], c->spring[1], c->spring[2], c->dash[0],  c->dash[1],
                                      c->dash[2],   c->twist,     c->patch,     c->attached, c->loss};
    const dem_contact_extras extras = dem_extras_of(c);
    list l = {.count = 0};
    for (int k = 0; k < HISTORY; k++)
        if (history[k])
            l.columns[l.column_count++] = history[k];
    for (int k = 0; k < extras.count; k++)
        l.columns[l.column_count++] = extras.column[k];
    return l;
}

// whether the k-th old contact of a pair comes before this one; both lists are sorted by their spheres
static bool comes_before(const dem_contact_columns *c, size_t at, const entry *item)
{
    return c->sphere_a[at] != item->sphere_a ? c->sphere_a[at] < item->sphere_a : c->sphere_b[at] < item->sphere_b;
}

// the spring of the old contact of these spheres; `k` goes through the old list of the pair beside the new one
static void take_history(const dem_world *w, const dem_segment *s, const dem_pair *p, entry *item, size_t *k)
{
    const dem_contact_columns *c = &w->contacts.columns;
    while (*k < p->count && comes_before(c, segment_place(s, p->start + *k), item))
        ++*k;
    if (*k == p->count)
        return;
    size_t at = segment_place(s, p->start + *k);
    if (c->sphere_a[at] != item->sphere_a || c->sphere_b[at] != item->sphere_b)
        return;
    item->old = (uint32_t)(at - s->begin) + 1;
}

static bool same_parts(const dem_soft *soft, uint32_t a, uint32_t b, uint32_t other_a, uint32_t other_b)
{
    return soft_part(soft, a) == soft_part(soft, other_a) && soft_part(soft, b) == soft_part(soft, other_b);
}

// what the first one of a pair of parts remembers stands for all
static void take_soft_history(const dem_world *w, const dem_segment *s, const dem_pair *p, entry *item)
{
    const dem_contact_columns *c = &w->contacts.columns;
    for (size_t k = 0; k < p->count; k++) {
        size_t at = segment_place(s, p->start + k);
        if (same_parts(&w->soft, item->sphere_a, item->sphere_b, c->sphere_a[at], c->sphere_b[at])) {
            item->old = (uint32_t)(at - s->begin) + 1;
            return;
        }
    }
}

static bool make_room(list *l, size_t more)
{
    if (l->count + more <= l->capacity)
        return true;
    size_t capacity = (l->count + more) * 3 / 2 + 64;
    entry *items = realloc(l->items, capacity * sizeof *items);
    if (!items)
        return false;
    l->items = items;
    l->capacity = capacity;
    return true;
}

// the contacts of a pair that stays as it is
static void list_again(const dem_contact_columns *c, const dem_segment *s, const dem_pair *p, list *l)
{
    if (!p->count)
        return;
    size_t block = p->start % s->across, lane = p->start / s->across;
    for (size_t i = 0; i < p->count; i++) {
        uint32_t place = (uint32_t)(block * DEM_BLOCK_LANES + lane);  // as segment_place has it
        size_t at = s->begin + place;
        l->items[l->count++] =
            (entry){p->a, p->b, c->sphere_a[at], c->sphere_b[at], p->image, c->law ? c->law[at] : 0, place + 1};
        if (++block == s->across) {
            block = 0;
            lane++;
        }
    }
}

static bool list_pair(const dem_world *w, const dem_segment *s, dem_pair *p, const dem_fresh *fresh, list *l)
{
    size_t start = l->count, old = 0;
    if (!make_room(l, fresh ? fresh->count : p->count))
        return false;
    if (!fresh)
        list_again(&w->contacts.columns, s, p, l);
    else {
        const dem_template *a = &w->templates.items[w->bodies.shape[p->a]];
        const dem_template *b = &w->templates.items[w->bodies.shape[p->b]];
        const uint32_t *pairs = fresh->count ? w->candidates[fresh->thread].pairs + 2 * fresh->begin : NULL;
        for (size_t i = 0; i < fresh->count; i++) {
            entry item = {.a = p->a,
                          .b = p->b,
                          .sphere_a = a->first + pairs[2 * i],
                          .sphere_b = b->first + pairs[2 * i + 1],
                          .shift = p->image,
                          .law = w->laws.table[a->material * w->laws.material_count + b->material]};
            if (!w->features.soft)
                take_history(w, s, p, &item, &old);
            else if (i == 0 || !same_parts(&w->soft, item.sphere_a, item.sphere_b, l->items[l->count - 1].sphere_a,
                                           l->items[l->count - 1].sphere_b))
                take_soft_history(w, s, p, &item);
            l->items[l->count++] = item;
        }
    }
    p->start = (uint32_t)start;
    p->count = (uint32_t)(l->count - start);
    return true;
}

static size_t segment_end(const dem_world *w, size_t segment)
{
    size_t end = (segment + 1) * DEM_SEGMENT;
    return end < w->bodies.count ? end : w->bodies.count;
}

// bodies of another domain get a slot each, one for all neighbouring contacts of a pair
static void set_targets(dem_world *w, size_t segment, const list *l)
{
    dem_contacts *contacts = &w->contacts;
    dem_segment *s = &contacts->segments[segment];
    size_t domain = segment * DEM_SEGMENT / w->domain_bodies;
    uint32_t last = UINT32_MAX;
    s->slot_count = 0;
    for (size_t k = 0; k < l->count; k++) {
        uint32_t b = l->items[k].b;
        if (b >= w->bodies.count || b / w->domain_bodies == domain)
            continue;
        if (b != last || k == 0 || l->items[k - 1].a != l->items[k].a)
            contacts->slot_body[s->slot_begin + s->slot_count++] = b;
        last = b;
        contacts->columns.target[segment_place(s, k)] =
            (uint32_t)(w->bodies.padded + s->slot_begin + s->slot_count - 1);
    }
}

static bool keep_memory(const dem_segment *s, list *l)
{
    size_t needed = l->column_count * l->count;
    if (needed > l->kept_capacity) {
        free(l->kept);
        l->kept_capacity = needed + needed / 2;
        l->kept = dem_alloc(l->kept_capacity, sizeof *l->kept);
        if (!l->kept)
            return false;
    }
    double *to = l->kept;
    for (size_t e = 0; e < l->column_count; e++)
        for (size_t k = 0; k < l->count; k++)
            *to++ = l->items[k].old ? l->columns[e][s->begin + l->items[k].old - 1] : 0;
    return true;
}

static void put_entry(dem_contact_columns *c, size_t at, const entry *item)
{
    c->a[at] = item->a;
    c->b[at] = c->target[at] = item->b;
    c->sphere_a[at] = item->sphere_a;
    c->sphere_b[at] = item->sphere_b;
    if (c->shift)
        c->shift[at] = item->shift;
    if (c->law)
        c->law[at] = item->law;
    if (c->weight)
        c->weight[at] = 1;
}

// the whole list to its places, which are those of segment_place
static void put_list(dem_contact_columns *c, const dem_segment *s, const list *l)
{
    size_t k = 0;
    for (size_t lane = 0; k < l->count; lane++)
        for (size_t block = 0; block < s->across; block++, k++)
            put_entry(c, s->begin + block * DEM_BLOCK_LANES + lane, &l->items[k]);
    const double *from = l->kept;
    for (size_t e = 0; e < l->column_count; e++) {
        k = 0;
        for (size_t lane = 0; k < l->count; lane++)
            for (size_t block = 0; block < s->across; block++, k++)
                l->columns[e][s->begin + block * DEM_BLOCK_LANES + lane] = *from++;
    }
}

static entry idle_entry(const dem_world *w)
{
    dem_contact_item idle = dem_contact_idle(w, -1);
    return (entry){.a = idle.a, .b = idle.b, .sphere_a = idle.sphere_a, .sphere_b = idle.sphere_b};
}

static bool rebuild_segment(dem_world *w, size_t segment, list *l)
{
    dem_segment *s = &w->contacts.segments[segment];
    const dem_segment old = *s;
    l->count = 0;
    for (size_t i = w->pairs.first[segment * DEM_SEGMENT]; i < w->pairs.first[segment_end(w, segment)]; i++) {
        uint32_t fresh = w->pairs.fresh[i];
        dem_pair *p = &w->pairs.items[i];
        if ((fresh || p->count) && !list_pair(w, &old, p, fresh ? &w->fresh[fresh - 1] : NULL, l))
            return false;
        w->pairs.fresh[i] = 0;
    }
    size_t full = contacts_padded(l->count + s->spare);
    s->idle = (uint32_t)(full - l->count);
    if (!make_room(l, s->idle))
        return false;
    entry idle = idle_entry(w);
    while (l->count < full)
        l->items[l->count++] = idle;
    if (!keep_memory(s, l))
        return false;
    segment_set_end(s, l->count, w->features.soft);
    put_list(&w->contacts.columns, s, l);
    set_targets(w, segment, l);
    s->dirty = false;
    s->built = w->steps;
    return true;
}

// ---- lists of which little changes
//
// The contacts of a pair move to the first idle places that follow each other and are enough; a list is rebuilt where
// there are none. Where that happens often, rebuilding leaves more places idle.

// the first of `count` places that are idle, or of the pair itself; the size of the list: there are none
static size_t find_places(const dem_world *w, const dem_segment *s, const dem_pair *p, size_t count)
{
    const uint32_t *a = w->contacts.columns.a + s->begin;
    size_t size = s->end - s->begin, block = 0, lane = 0, run = 0;
    for (size_t k = 0; k < size; k++) {
        bool free = a[block * DEM_BLOCK_LANES + lane] == w->bodies.dummy || (k >= p->start && k < p->start + p->count);
        run = free ? run + 1 : 0;
        if (run == count)
            return k + 1 - count;
        if (++block == s->across) {
            block = 0;
            lane++;
        }
    }
    return size;
}

// where the momentum of b goes; DEM_ROW_FREE: there is no slot left
static uint32_t patch_target(dem_world *w, dem_segment *s, const dem_pair *p)
{
    if (p->b / w->domain_bodies == p->a / w->domain_bodies)
        return p->b;
    if (p->count)
        return w->contacts.columns.target[segment_place(s, p->start)];
    if (s->slot_count == s->slot_capacity)
        return (uint32_t)DEM_ROW_FREE;
    size_t slot = s->slot_begin + s->slot_count++;
    w->contacts.slot_body[slot] = p->b;
    return (uint32_t)(w->bodies.padded + slot);
}

static void put_idle(dem_world *w, const dem_segment *s, const dem_pair *p, const list *l)
{
    entry idle = idle_entry(w);
    for (size_t k = p->start; k < p->start + p->count; k++) {
        size_t at = segment_place(s, k);
        put_entry(&w->contacts.columns, at, &idle);
        for (size_t e = 0; e < l->column_count; e++)
            l->columns[e][at] = 0;
    }
}

typedef enum patched { PATCHED, PATCH_NO_ROOM, PATCH_NO_MEMORY } patched;

static patched patch_pair(dem_world *w, dem_segment *s, const dem_fresh *fresh, list *l)
{
    dem_pair *p = &w->pairs.items[fresh->pair];
    const dem_pair old = *p;
    size_t start = 0;
    uint32_t target = p->b;
    if (fresh->count) {
        start = find_places(w, s, p, fresh->count);
        if (start == s->end - s->begin || (target = patch_target(w, s, p)) == (uint32_t)DEM_ROW_FREE)
            return PATCH_NO_ROOM;
    }
    l->count = 0;
    if (!list_pair(w, s, p, fresh, l) || !keep_memory(s, l))
        return PATCH_NO_MEMORY;
    put_idle(w, s, &old, l);
    for (size_t k = 0; k < l->count; k++) {
        size_t at = segment_place(s, start + k);
        put_entry(&w->contacts.columns, at, &l->items[k]);
        w->contacts.columns.target[at] = target;
        for (size_t e = 0; e < l->column_count; e++)
            l->columns[e][at] = l->kept[e * l->count + k];
    }
    p->start = (uint32_t)start;
    s->idle += old.count;
    s->idle -= p->count;
    w->pairs.fresh[fresh->pair] = 0;
    return PATCHED;
}

// what changes in a list of pairs, where the rest can stay; the list is dirty where it cannot
static bool patch_segment(dem_world *w, size_t segment, list *l)
{
    dem_segment *s = &w->contacts.segments[segment];
    patched done = w->features.soft ? PATCH_NO_ROOM : PATCHED;
    for (uint32_t k = s->changed; k && done == PATCHED; k = w->fresh[k - 1].next)
        done = patch_pair(w, s, &w->fresh[k - 1], l);
    s->changed = 0;
    s->dirty = done != PATCHED || s->idle > s->spare + IDLE_MOST;
    if (done != PATCHED) {
        bool often = !w->features.soft && w->steps - s->built <= REBUILT_SELDOM;
        s->spare = !often ? 0 : s->spare < SPARE_MOST ? s->spare + DEM_BLOCK_LANES : SPARE_MOST;
    }
    return done != PATCH_NO_MEMORY;
}

// ---- room for lists

// what each dirty segment will need of contacts and of slots
static void count_needs(const dem_world *w, size_t *contacts, size_t *slots)
{
    for (size_t i = 0; i < w->segment_count; i++) {
        contacts[i] = slots[i] = 0;
        const dem_segment *s = &w->contacts.segments[i];
        if (!s->dirty)
            continue;
        size_t domain = i * DEM_SEGMENT / w->domain_bodies;
        for (size_t k = w->pairs.first[i * DEM_SEGMENT]; k < w->pairs.first[segment_end(w, i)]; k++) {
            const dem_pair *p = &w->pairs.items[k];
            size_t count = w->pairs.fresh[k] ? w->fresh[w->pairs.fresh[k] - 1].count : p->count;
            contacts[i] += count;
            slots[i] += count && p->b / w->domain_bodies != domain;
        }
        contacts[i] += s->spare;
        slots[i] += s->spare / 4;
    }
}

static bool reserve_slots(dem_world *w, const size_t *needed, bool *moved)
{
    dem_contacts *contacts = &w->contacts;
    bool fits = true;
    for (size_t i = 0; i < w->segment_count; i++)
        fits = fits && (!contacts->segments[i].dirty || needed[i] <= contacts->segments[i].slot_capacity);
    if (fits)
        return true;
    size_t total = 0;
    for (size_t i = 0; i < w->segment_count; i++) {
        dem_segment *s = &contacts->segments[i];
        size_t most = s->dirty ? needed[i] : s->slot_count;
        if (most > s->slot_capacity)
            s->slot_capacity = most + most / 4 + 4;
        total += s->slot_capacity;
        s->dirty = true;  // all slots move
    }
    *moved = true;
    free(contacts->slot_body);
    contacts->slot_body = dem_alloc_zero(total, sizeof *contacts->slot_body);
    contacts->slot_capacity = total;
    size_t begin = 0;
    for (size_t i = 0; i < w->segment_count; i++) {
        contacts->segments[i].slot_begin = begin;
        begin += contacts->segments[i].slot_capacity;
    }
    return contacts->slot_body && dem_bodies_reserve_slots(&w->bodies, total);
}

typedef struct rebuilding {
    dem_world *w;
    const size_t *segments;
    size_t count;
    bool (*work)(dem_world *w, size_t segment, list *l);
    int parts;
    atomic_bool failed;
} rebuilding;

static void rebuild_part(void *user, int part)
{
    rebuilding *r = user;
    list l = list_of(&r->w->contacts.columns);
    size_t parts = (size_t)r->parts, from = r->count * (size_t)part / parts, to = r->count * ((size_t)part + 1) / parts;
    for (size_t i = from; i < to; i++)
        if (!r->work(r->w, r->segments[i], &l)) {
            r->failed = true;
            break;
        }
    free(l.items);
    free(l.kept);
}

// does the work for some segments, which is nothing for other ones
static bool for_segments(dem_world *w, const size_t *segments, size_t count,
                         bool (*work)(dem_world *w, size_t segment, list *l))
{
    rebuilding r = {.w = w, .segments = segments, .count = count, .work = work};
    r.parts = count > SEGMENTS_TO_SHARE ? w->threads : 1;
    if (count)
        dem_team_share(w->team, r.parts, rebuild_part, &r);
    return !r.failed;
}

static bool rebuild_dirty(dem_world *w, size_t *needed, size_t *slots)
{
    count_needs(w, needed, slots);
    bool moved = false, good = reserve_slots(w, slots, &moved);
    if (moved)
        count_needs(w, needed, slots);
    if (!good || !dem_contacts_reserve(w, &w->contacts, -1, needed))
        return false;
    size_t count = 0;
    for (size_t i = 0; i < w->segment_count; i++)
        if (w->contacts.segments[i].dirty)
            needed[count++] = i;
    return for_segments(w, needed, count, rebuild_segment);
}

dem_status dem_contacts_rebuild(dem_world *w, dem_error *error)
{
    size_t *needed = dem_alloc(2 * w->segment_count, sizeof *needed),
           *slots = needed ? needed + w->segment_count : NULL;
    if (!needed)
        return dem_fail_memory(error);
    size_t count = 0;
    bool dirty = false;
    for (size_t i = 0; i < w->segment_count; i++) {
        dem_segment *s = &w->contacts.segments[i];
        if (s->dirty)
            s->changed = 0;
        else if (s->changed)
            needed[count++] = i;
    }
    bool good = for_segments(w, needed, count, patch_segment);
    for (size_t i = 0; i < w->segment_count; i++)
        dirty |= w->contacts.segments[i].dirty;
    good = good && (!dirty || rebuild_dirty(w, needed, slots));
    free(needed);
    return good ? DEM_OK : dem_fail_memory(error);
}

void dem_contacts_tighten(dem_world *w)
{
    for (size_t i = 0; i < w->segment_count; i++) {
        dem_segment *s = &w->contacts.segments[i];
        if (w->steps - s->built <= SPARED_LONG || (!s->spare && s->idle < DEM_BLOCK_LANES))
            continue;
        s->spare = 0;
        s->dirty = true;
    }
}

void dem_contacts_add_slots(dem_world *w, size_t begin, size_t end)
{
    const dem_contacts *contacts = &w->contacts;
    double *momentum = w->bodies.momentum;
    for (size_t i = 0; i < w->segment_count; i++) {
        const dem_segment *s = &contacts->segments[i];
        for (size_t k = s->slot_begin; k < s->slot_begin + s->slot_count; k++) {
            uint32_t row = contacts->slot_body[k];
            if (row < begin || row >= end)
                continue;
            double *to = momentum + DEM_ROW * (size_t)row, *from = momentum + DEM_ROW * (w->bodies.padded + k);
            for (int j = 0; j < DEM_ROW; j++) {
                to[j] += from[j];
                from[j] = 0;
            }
        }
    }
}
