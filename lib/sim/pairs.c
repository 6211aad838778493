#include "sim/pairs.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/broad.h"

enum { SLACK = 16 };  // one in so many places is left for pairs of later searches

typedef struct pairs_to_come {
    dem_world *w;
    const dem_near *near;  // sorted
    size_t count;
    uint32_t *first;       // [bodies + 1] of each a
    const int32_t *moved;  // [3 a body] sides by which it was put back (periodic)
} pairs_to_come;

static int by_partner(const void *a, const void *b)
{
    const dem_near *p = a, *q = b;
    if (p->b != q->b)
        return p->b < q->b ? -1 : 1;
    return p->image < q->image ? -1 : p->image > q->image;
}

static void sort_partners(dem_near *near, size_t count)
{
    if (count > 64) {
        qsort(near, count, sizeof *near, by_partner);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        dem_near v = near[i];
        size_t j = i;
        for (; j > 0 && by_partner(&near[j - 1], &v) > 0; j--)
            near[j] = near[j - 1];
        near[j] = v;
    }
}

// by a, b and image, in the memory of `room` unless they are by a already
static dem_near *sort_near(const pairs_to_come *come, dem_near *near, dem_near *room)
{
    size_t n = come->w->bodies.count;
    uint32_t *first = come->first;
    memset(first, 0, (n + 1) * sizeof *first);
    for (size_t i = 0; i < come->count; i++)
        first[near[i].a + 1]++;
    for (size_t i = 0; i < n; i++)
        first[i + 1] += first[i];
    if (room) {
        for (size_t i = 0; i < come->count; i++)
            room[first[near[i].a]++] = near[i];
        memmove(first + 1, first, n * sizeof *first);
        first[0] = 0;
        near = room;
    }
    for (size_t i = 0; near && i < n; i++)
        sort_partners(near + first[i], first[i + 1] - first[i]);
    return near;
}

// the image of an old pair after its bodies have been moved back; DEM_IMAGES: beyond all
static uint32_t moved_image(const pairs_to_come *come, const dem_pair *p)
{
    if (!come->w->periodic)
        return p->image;
    int image[3];
    image_of(p->image, image);
    for (int k = 0; k < 3; k++) {
        image[k] += come->moved[3 * p->b + (uint32_t)k] - come->moved[3 * p->a + (uint32_t)k];
        if (abs(image[k]) > DEM_IMAGES_ASIDE)
            return DEM_IMAGES;
    }
    return image_row(image[0], image[1], image[2]);
}

static bool make_links(dem_pairs *pairs, size_t bodies, size_t capacity)
{
    *pairs = (dem_pairs){.capacity = capacity,
                         .items = dem_alloc(capacity, sizeof *pairs->items),
                         .first = dem_alloc(bodies + 1, sizeof *pairs->first),
                         .adjacency_first = dem_alloc(bodies + 1, sizeof *pairs->adjacency_first),
                         .adjacency = dem_alloc(2 * capacity, sizeof *pairs->adjacency),
                         .adjacency_limit = dem_alloc(2 * capacity, sizeof *pairs->adjacency_limit),
                         .fresh = dem_alloc(capacity, sizeof *pairs->fresh)};
    return pairs->items && pairs->first && pairs->adjacency_first && pairs->adjacency && pairs->adjacency_limit &&
           pairs->fresh;
}

// Whether the new list may grow from the begin of the memory while the old one is read, which is moved to its end: no
// new pair comes to stand where an old one has not been read.
static bool in_place(const pairs_to_come *come, const dem_pairs *pairs)
{
    if (come->count > pairs->capacity || !pairs->first)
        return false;
    size_t gap = pairs->capacity - pairs->count;
    for (size_t a = 0; a < come->w->bodies.count; a++)
        if (come->first[a + 1] > gap + pairs->first[a])
            return false;
    return true;
}

void dem_pairs_release(dem_pairs *pairs)
{
    free(pairs->items);
    free(pairs->first);
    free(pairs->adjacency_first);
    free(pairs->adjacency);
    free(pairs->adjacency_limit);
    free(pairs->fresh);
}

// Limits of the i-th pair until its links are made: in memory of the links.
static void park(dem_pairs *pairs, size_t i, const double limits[2])
{
    memcpy(&pairs->adjacency[2 * i], &limits[0], sizeof *limits);
    memcpy(&pairs->items[i].adjacent_a, &limits[1], sizeof *limits);
}
static void unpark(const dem_pairs *pairs, size_t i, double limits[2])
{
    memcpy(&limits[0], &pairs->adjacency[2 * i], sizeof *limits);
    memcpy(&limits[1], &pairs->items[i].adjacent_a, sizeof *limits);
}
_Static_assert(offsetof(dem_pair, adjacent_b) == offsetof(dem_pair, adjacent_a) + sizeof(uint32_t),
               "a limit is parked in both");

// what is known of the pairs that stay; the segments of those that go with contacts, or are seen elsewhere, are dirty
static void merge_pairs(const pairs_to_come *come, const dem_pair *items, const double *old_limits, dem_pairs *pairs)
{
    const uint32_t *old = come->w->pairs.count ? come->w->pairs.first : NULL;
    for (size_t a = 0; a < come->w->bodies.count; a++) {
        size_t o = old ? old[a] : 0, o_end = old ? old[a + 1] : 0;
        bool *dirty = &come->w->contacts.segments[a / DEM_SEGMENT].dirty;
        for (size_t i = come->first[a]; i < come->first[a + 1]; i++) {
            const dem_near *n = &come->near[i];
            dem_pair pair = {.a = n->a, .b = n->b, .normal = {9}, .image = n->image};
            double limits[2] = {-1, -1};
            for (; o < o_end; o++) {
                const dem_pair *p = &items[o];
                uint32_t image = moved_image(come, p);
                if (p->b > n->b || (p->b == n->b && image > n->image))
                    break;
                if (p->b == n->b && image == n->image) {
                    pair = *p;
                    pair.image = image;
                    *dirty |= p->count && image != p->image;
                    limits[0] = old_limits[p->adjacent_a];
                    limits[1] = old_limits[p->adjacent_b];
                    o++;
                    break;
                }
                *dirty |= p->count > 0;
            }
            pairs->items[i] = pair;
            park(pairs, i, limits);
        }
        for (; o < o_end; o++)
            *dirty |= items[o].count > 0;
    }
}

static void link_adjacency(const pairs_to_come *come, dem_pairs *pairs)
{
    size_t n = come->w->bodies.count;
    uint32_t *first = pairs->adjacency_first;
    memset(first, 0, (n + 1) * sizeof *first);
    memset(pairs->fresh, 0, pairs->count * sizeof *pairs->fresh);
    for (size_t i = 0; i < pairs->count; i++) {
        first[pairs->items[i].a + 1]++;
        first[pairs->items[i].b + 1]++;
    }
    for (size_t i = 0; i < n; i++)
        first[i + 1] += first[i];
    for (size_t i = 0; i < pairs->count; i++) {
        dem_pair *p = &pairs->items[i];
        double limits[2];
        unpark(pairs, i, limits);
        p->adjacent_a = first[p->a]++;
        p->adjacent_b = first[p->b]++;
        pairs->adjacency_limit[p->adjacent_a] = limits[0];
        pairs->adjacency_limit[p->adjacent_b] = limits[1];
    }
    for (size_t i = 0; i < pairs->count; i++)
        pairs->adjacency[pairs->items[i].adjacent_a] = pairs->adjacency[pairs->items[i].adjacent_b] = (uint32_t)i;
    memmove(first + 1, first, n * sizeof *first);
    first[0] = 0;
}

// in the memory of the old list where it will do
static dem_status replace(const pairs_to_come *come, dem_error *error)
{
    dem_world *w = come->w;
    dem_pairs old = w->pairs, pairs = old;
    size_t n = w->bodies.count, at = 0;
    bool same = in_place(come, &old);
    if (!same && !make_links(&pairs, n, come->count + come->count / SLACK + 1)) {
        dem_pairs_release(&pairs);
        return dem_fail_memory(error);
    }
    if (same) {
        at = old.capacity - old.count;
        memmove(old.items + at, old.items, old.count * sizeof *old.items);
    }
    pairs.count = come->count;
    merge_pairs(come, old.items ? old.items + at : NULL, old.adjacency_limit, &pairs);
    link_adjacency(come, &pairs);
    memcpy(pairs.first, come->first, (n + 1) * sizeof *pairs.first);
    if (!same)
        dem_pairs_release(&old);
    w->pairs = pairs;
    return DEM_OK;
}

dem_status dem_pairs_replace(dem_world *w, dem_near *near, size_t count, bool by_a, const int32_t *moved,
                             dem_error *error)
{
    bool sorted = by_a && !w->periodic;
    dem_near *room = sorted ? NULL : dem_alloc(count, sizeof *room);
    pairs_to_come come = {.w = w, .near = near, .count = count, .moved = moved};
    come.first = dem_alloc(w->bodies.count + 1, sizeof *come.first);
    dem_status status = DEM_OK;
    if (!come.first || !(sorted || room))
        status = dem_fail_memory(error);
    else {
        come.near = sort_near(&come, near, room);
        status = replace(&come, error);
    }
    free(come.first);
    free(room);
    return status;
}
