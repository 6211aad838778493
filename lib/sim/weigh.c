// Several contacts of one pair of bodies: `mean` gives each one over their number (Kruggel-Emden et al. 2008; Hoehner
// et al. 2011); `merge` lets those that nearly coincide share one force by their overlaps, so that spheres which
// overlap each other do not count twice, while the support of a flat face stays what it is.
#include "sim/contacts.h"

#include <string.h>

static const double MERGE_POINT = 0.5;     // of R*: distance of contact points that count as one [-]
static const double MERGE_ANGLE = 0.96593; // cosine of 15 degrees between their normals

enum { TOGETHER = 64 }; // contacts of a pair that are looked at together

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

// the weights of the contacts of one pair that touch
static void weigh(dem_multiple multiple, const touch *touches, size_t count, double *weight)
{
    for (size_t i = 0; i < count; i++) {
        if (multiple == DEM_MULTIPLE_MEAN) {
            weight[touches[i].place] = 1 / (double)count;
            continue;
        }
        double sum = 0;
        for (size_t j = 0; j < count; j++)
            if (j == i || coincide(&touches[i], &touches[j]))
                sum += touches[j].overlap;
        weight[touches[i].place] = touches[i].overlap / sum;
    }
}

typedef struct weigher {
    dem_world *w;
    dem_contacts *contacts;
    int form;
} weigher;

static void weigh_segment(const weigher *g, const dem_segment *s)
{
    const dem_contact_columns *c = &g->contacts->columns;
    touch touches[TOGETHER];
    size_t size = s->end - s->begin, count = 0;
    for (size_t k = 0; k < size; k++) {
        size_t at = segment_place(s, k), before = k ? segment_place(s, k - 1) : at;
        const uint32_t *other = g->form < 0 ? c->b : c->sphere_b;
        bool same = k > 0 && c->a[at] == c->a[before] && other[at] == other[before] &&
                    (!c->shift || c->shift[at] == c->shift[before]);
        if (!same || count == TOGETHER) {
            weigh(g->w->multiple, touches, count, c->weight);
            count = 0;
        }
        c->weight[at] = 1;
        if (c->a[at] >= g->w->bodies.count)
            continue;
        touch t = g->form < 0 ? touch_pair(g->w, at) : touch_wall(g->w, g->contacts, (dem_wall_form)g->form, at);
        if (t.overlap > 0)
            touches[count++] = t;
    }
    weigh(g->w->multiple, touches, count, c->weight);
}

void dem_weigh_contacts(dem_world *w, size_t begin, size_t end)
{
    if (!w->features.weighted)
        return;
    for (size_t i = begin; i < end; i++)
        weigh_segment(&(weigher){w, &w->contacts, -1}, &w->contacts.segments[i]);
    for (int form = 0; form < DEM_WALL_FORMS; form++)
        for (size_t i = begin; w->wall_contacts[form].segments && i < end; i++)
            weigh_segment(&(weigher){w, &w->wall_contacts[form], form}, &w->wall_contacts[form].segments[i]);
}
