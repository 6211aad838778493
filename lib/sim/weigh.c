// Several contacts of one pair of bodies: `mean` gives each one over their number (Kruggel-Emden et al. 2008; Hoehner
// et al. 2011); `merge` lets those that nearly coincide share one force by their overlaps, so that spheres which
// overlap each other do not count twice, while the support of a flat face stays what it is.
#include "sim/touch.h"

#include <string.h>

static const double MERGE_POINT = 0.5;      // of R*: distance of contact points that count as one [-]
static const double MERGE_ANGLE = 0.96593;  // cosine of 15 degrees between their normals

enum { TOGETHER = 64 };  // contacts of a pair that are held at a time

static bool coincide(const dem_touch *a, const dem_touch *b)
{
    double reduced = a->reduced < b->reduced ? a->reduced : b->reduced;
    return v3_distance(a->point, b->point) < MERGE_POINT * reduced && v3_dot(a->normal, b->normal) > MERGE_ANGLE;
}

typedef struct weigher {
    const dem_world *w;
    const dem_contacts *contacts;
    const dem_segment *segment;
    int form;
} weigher;

// the touching ones among the contacts [*from, end) of a pair, as many as can be held; *from: where to go on
static size_t gather(const weigher *g, size_t *from, size_t end, dem_touch touches[TOGETHER])
{
    size_t count = 0;
    for (; *from < end && count < TOGETHER; ++*from) {
        size_t at = segment_place(g->segment, *from);
        dem_touch t = g->form < 0 ? dem_touch_of_pair(g->w, at) : dem_touch_of_wall(g->w, (dem_wall_form)g->form, at);
        if (t.overlap > 0)
            touches[count++] = t;
    }
    return count;
}

// every touching contact [begin, end) of a pair gets one over their number
static void weigh_mean(const weigher *g, size_t begin, size_t end)
{
    dem_touch touches[TOGETHER];
    double count = 0;
    for (size_t from = begin; from < end;)
        count += (double)gather(g, &from, end, touches);
    for (size_t k = begin; k < end; k++)
        g->contacts->columns.weight[segment_place(g->segment, k)] = count > 1 ? 1 / count : 1;
}

// ... or its overlap over those of all that it coincides with
static void weigh_merged(const weigher *g, size_t begin, size_t end)
{
    dem_touch own[TOGETHER], others[TOGETHER];
    for (size_t from = begin; from < end;) {
        double sum[TOGETHER] = {0};
        size_t count = gather(g, &from, end, own);
        for (size_t more = begin; more < end;) {
            size_t other_count = gather(g, &more, end, others);
            for (size_t i = 0; i < count; i++)
                for (size_t j = 0; j < other_count; j++)
                    if (own[i].place == others[j].place || coincide(&own[i], &others[j]))
                        sum[i] += others[j].overlap;
        }
        for (size_t i = 0; i < count; i++)
            g->contacts->columns.weight[own[i].place] = own[i].overlap / sum[i];
    }
}

static bool same_pair(const weigher *g, size_t at, size_t before)
{
    const dem_contact_columns *c = &g->contacts->columns;
    const uint32_t *other = g->form < 0 ? c->b : c->sphere_b;
    return c->a[at] == c->a[before] && other[at] == other[before] && (!c->shift || c->shift[at] == c->shift[before]);
}

static void weigh_segment(const weigher *g)
{
    const dem_contact_columns *c = &g->contacts->columns;
    const dem_segment *s = g->segment;
    size_t size = s->end - s->begin;
    for (size_t begin = 0, end; begin < size; begin = end) {
        size_t first = segment_place(s, begin);
        for (end = begin; end < size && same_pair(g, segment_place(s, end), first); end++)
            c->weight[segment_place(s, end)] = 1;
        if (c->a[first] >= g->w->bodies.count || end - begin < 2)
            continue;  // idle, or alone
        if (g->w->multiple == DEM_MULTIPLE_MEAN)
            weigh_mean(g, begin, end);
        else
            weigh_merged(g, begin, end);
    }
}

void dem_weigh_contacts(dem_world *w, size_t begin, size_t end)
{
    if (!w->features.weighted)
        return;
    for (size_t i = begin; i < end; i++)
        weigh_segment(&(weigher){w, &w->contacts, &w->contacts.segments[i], -1});
    for (int form = 0; form < DEM_WALL_FORMS; form++)
        for (size_t i = begin; w->wall_contacts[form].segments && i < end; i++)
            weigh_segment(&(weigher){w, &w->wall_contacts[form], &w->wall_contacts[form].segments[i], form});
}
