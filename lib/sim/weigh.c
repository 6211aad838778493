// Several contacts of one pair of bodies: `mean` gives each one over their number (Kruggel-Emden et al. 2008; Hoehner
// et al. 2011); `merge` lets those that nearly coincide share one force by their overlaps, so that spheres which
// overlap each other do not count twice, while the support of a flat face stays what it is.
#include "sim/contacts.h"

#include <string.h>

static const double MERGE_POINT = 0.5;     // of R*: distance of contact points that count as one [-]
static const double MERGE_ANGLE = 0.96593; // cosine of 15 degrees between their normals

enum { TOGETHER = 64 }; // contacts of a pair that are held at a time

typedef struct touch {
    size_t place;
    dem_vec3 point, normal;
    double overlap, reduced;
} touch;

static dem_vec3 centre_of(const dem_world *w, uint32_t row, uint32_t sphere, double *radius)
{
    const double *s = w->templates.spheres[sphere];
    double scale = body_scale(&w->bodies, row);
    *radius = s[3] * scale;
    return v3_add(body_position(&w->bodies, row),
                  quat_rotate(body_orientation(&w->bodies, row), v3_scale(v3(s[0], s[1], s[2]), scale)));
}

static touch touch_pair(const dem_world *w, size_t at)
{
    const dem_contact_columns *c = &w->contacts.columns;
    double ra, rb;
    dem_vec3 a = centre_of(w, c->a[at], c->sphere_a[at], &ra), b = centre_of(w, c->b[at], c->sphere_b[at], &rb);
    if (c->shift) {
        const double *shift = w->shifts + 4 * (size_t)c->shift[at];
        b = v3_add(b, v3(shift[0], shift[1], shift[2]));
    }
    dem_vec3 d = v3_sub(b, a), n = v3_unit(d);
    double overlap = ra + rb - v3_norm(d);
    return (touch){at, v3_along(a, ra - overlap / 2, n), n, overlap, ra * rb / (ra + rb)};
}

static touch touch_wall(const dem_world *w, const dem_contacts *contacts, dem_wall_form form, size_t at)
{
    const dem_contact_columns *c = &contacts->columns;
    double r;
    dem_vec3 x = centre_of(w, c->a[at], c->sphere_a[at], &r);
    if (form == DEM_FORM_MESH) {
        dem_vec3 n = v3(c->geometry[0][at], c->geometry[1][at], c->geometry[2][at]);
        dem_vec3 arm = v3(c->geometry[4][at], c->geometry[5][at], c->geometry[6][at]);
        return (touch){at, v3_add(body_position(&w->bodies, c->a[at]), arm), n, c->geometry[3][at], r};
    }
    double distance = dem_wall_distance(&w->walls, c->sphere_b[at], x);
    const double *row = w->walls.rows + DEM_WALL_ROW * c->sphere_b[at];
    dem_vec3 n = v3(-row[0], -row[1], -row[2]);
    if (form == DEM_FORM_CYLINDER) {
        dem_vec3 axis = v3(row[0], row[1], row[2]), from = v3_sub(x, v3(row[4], row[5], row[6]));
        n = v3_scale(v3_unit(v3_along(from, -v3_dot(from, axis), axis)), row[3] < 0 ? -1 : 1);
    }
    return (touch){at, v3_along(x, distance, n), n, r - distance, r};
}

static bool coincide(const touch *a, const touch *b)
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
static size_t gather(const weigher *g, size_t *from, size_t end, touch touches[TOGETHER])
{
    size_t count = 0;
    for (; *from < end && count < TOGETHER; ++*from) {
        size_t at = segment_place(g->segment, *from);
        touch t = g->form < 0 ? touch_pair(g->w, at) : touch_wall(g->w, g->contacts, (dem_wall_form)g->form, at);
        if (t.overlap > 0)
            touches[count++] = t;
    }
    return count;
}

// every touching contact [begin, end) of a pair gets one over their number
static void weigh_mean(const weigher *g, size_t begin, size_t end)
{
    touch touches[TOGETHER];
    double count = 0;
    for (size_t from = begin; from < end;)
        count += (double)gather(g, &from, end, touches);
    for (size_t k = begin; k < end; k++)
        g->contacts->columns.weight[segment_place(g->segment, k)] = count > 1 ? 1 / count : 1;
}

// ... or its overlap over those of all that it coincides with
static void weigh_merged(const weigher *g, size_t begin, size_t end)
{
    touch own[TOGETHER], others[TOGETHER];
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
            continue; // idle, or alone
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
