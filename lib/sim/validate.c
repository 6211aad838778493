#include "sim/validate.h"

#include <stdlib.h>

#include "base/status.h"
#include "sim/broad.h"
#include "sim/contacts.h"

typedef struct key {
    uint32_t a, b, sphere_a, sphere_b, image;
} key;

static int by_key(const void *p, const void *q)
{
    const uint32_t *x = p, *y = q;
    for (int k = 0; k < 5; k++)
        if (x[k] != y[k])
            return x[k] < y[k] ? -1 : 1;
    return 0;
}

static key key_of(const dem_world *w, const dem_contacts *contacts, size_t place, bool wall)
{
    dem_contact_item i = dem_contact_get(&contacts->columns, place);
    return (key){i.a, wall ? UINT32_MAX : i.b, i.sphere_a, i.sphere_b, wall || !w->periodic ? 0 : i.shift};
}

static dem_status gather(const dem_world *w, const dem_contacts *contacts, bool wall, key **keys, size_t *count,
                         dem_error *error)
{
    size_t capacity = 0;
    *keys = NULL;
    *count = 0;
    for (size_t i = 0; contacts->segments && i < w->segment_count; i++)
        for (size_t at = contacts->segments[i].begin; at < contacts->segments[i].end; at++) {
            if (contacts->columns.a[at] >= w->bodies.count)
                continue;
            if (!dem_grow(keys, &capacity, *count, sizeof **keys))
                return dem_fail_memory(error);
            (*keys)[(*count)++] = key_of(w, contacts, at, wall);
        }
    if (*count)
        qsort(*keys, *count, sizeof **keys, by_key);
    return DEM_OK;
}

static void judge(const key *listed, size_t count, key wanted, dem_truth *truth)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (by_key(&listed[middle], &wanted) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    truth->missed += low == count || by_key(&listed[low], &wanted) != 0;
}

static dem_ball space_ball(const dem_world *w, size_t row, size_t sphere)
{
    const double *s = w->templates.spheres[sphere];
    double scale = body_scale(&w->bodies, row);
    dem_vec3 arm = quat_rotate(body_orientation(&w->bodies, row), v3_scale(v3(s[0], s[1], s[2]), scale));
    return (dem_ball){v3_add(body_position(&w->bodies, row), arm), s[3] * scale};
}

static void compare(const dem_world *w, uint32_t a, uint32_t b, uint32_t image, const key *listed, size_t count,
                    dem_truth *truth)
{
    if (body_absent(&w->bodies, a) || body_absent(&w->bodies, b))
        return;
    if (hold_whole(body_hold(&w->bodies, a)) && hold_whole(body_hold(&w->bodies, b)))
        return;
    const dem_template *ta = &w->templates.items[w->bodies.shape[a]], *tb = &w->templates.items[w->bodies.shape[b]];
    dem_vec3 shift = v3(0, 0, 0);
    if (w->periodic)
        shift = v3(w->shifts[4 * image], w->shifts[4 * image + 1], w->shifts[4 * image + 2]);
    dem_vec3 d = v3_sub(v3_add(body_position(&w->bodies, b), shift), body_position(&w->bodies, a));
    if (v3_norm(d) > w->bodies.radius[a] + w->bodies.radius[b])
        return;
    for (uint32_t i = ta->first; i < ta->first + ta->count; i++)
        for (uint32_t j = tb->first; j < tb->first + tb->count; j++) {
            dem_ball p = space_ball(w, a, i), q = space_ball(w, b, j);
            if (v3_distance(p.centre, v3_add(q.centre, shift)) >= p.radius + q.radius)
                continue;
            truth->contacts++;
            judge(listed, count, (key){a, b, i, j, w->periodic ? image : 0}, truth);
        }
}

// how many images of a side may matter
static void images_aside(const dem_world *w, int most[3])
{
    double radius = 0;
    for (size_t row = 0; row < w->bodies.count; row++)
        radius = fmax(radius, w->bodies.radius[row]);
    for (int k = 0; k < 3; k++) {
        double side = v3_get(w->domain.high, k) - v3_get(w->domain.low, k);
        int n = w->domain.periodic[k] ? (int)ceil(2 * radius / side) + 1 : 0;
        most[k] = n < DEM_IMAGES_ASIDE ? n : DEM_IMAGES_ASIDE;
    }
}

static dem_status check_pairs(const dem_world *w, dem_truth *truth, dem_error *error)
{
    key *listed;
    size_t count;
    int most[3];
    images_aside(w, most);
    dem_status status = gather(w, &w->contacts, false, &listed, &count, error);
    for (size_t i = 1; status == DEM_OK && i < count; i++)
        truth->doubled += by_key(&listed[i - 1], &listed[i]) == 0;
    for (uint32_t a = 0; status == DEM_OK && a < w->bodies.count; a++)
        for (uint32_t b = a; b < w->bodies.count; b++)
            for (int x = -most[0]; x <= most[0]; x++)
                for (int y = -most[1]; y <= most[1]; y++)
                    for (int z = -most[2]; z <= most[2]; z++) {
                        // a body meets its own images, each pair of them once: as the search counts them
                        bool half = x != 0 ? x < 0 : y != 0 ? y < 0 : z < 0;
                        if (a != b || half)
                            compare(w, a, b, image_row(x, y, z), listed, count, truth);
                    }
    free(listed);
    return status;
}

static dem_status check_walls(const dem_world *w, dem_truth *truth, dem_error *error)
{
    for (int form = 0; form < DEM_FORM_MESH; form++) {
        key *listed;
        size_t count;
        dem_status status = gather(w, &w->wall_contacts[form], true, &listed, &count, error);
        for (size_t i = 1; status == DEM_OK && i < count; i++)
            truth->doubled += by_key(&listed[i - 1], &listed[i]) == 0;
        for (uint32_t row = 0; status == DEM_OK && row < w->bodies.count; row++) {
            const dem_template *t = &w->templates.items[w->bodies.shape[row]];
            bool held = body_absent(&w->bodies, row) || hold_whole(body_hold(&w->bodies, row));
            for (uint32_t i = t->first; !held && i < t->first + t->count; i++) {
                dem_ball ball = space_ball(w, row, i);
                for (uint32_t k = 0; k < w->walls.count; k++)
                    if ((int)w->walls.items[k].form == form &&
                        dem_wall_distance(&w->walls, k, ball.centre) < ball.radius) {
                        truth->walls++;
                        judge(listed, count, (key){row, UINT32_MAX, i, k, 0}, truth);
                    }
            }
        }
        free(listed);
        DEM_TRY(status);
    }
    return DEM_OK;
}

// what the structures say of each other
static void check_structures(const dem_world *w, dem_truth *truth)
{
    const dem_pairs *pairs = &w->pairs;
    for (size_t i = 0; i < pairs->count; i++) {
        const dem_pair *p = &pairs->items[i];
        truth->unsound += p->a > p->b || pairs->adjacency[p->adjacent_a] != i || pairs->adjacency[p->adjacent_b] != i ||
                          i < pairs->first[p->a] || i >= pairs->first[p->a + 1] || pairs->fresh[i] != 0;
        const dem_segment *s = &w->contacts.segments[p->a / DEM_SEGMENT];
        for (size_t k = 0; k < p->count; k++) {
            dem_contact_item item = dem_contact_get(&w->contacts.columns, segment_place(s, p->start + k));
            truth->unsound += item.a != p->a || item.b != p->b;
        }
    }
    for (size_t k = 0; k < (w->bodies.momentum_rows - w->bodies.padded) * DEM_ROW; k++)
        truth->unsound += w->bodies.momentum[w->bodies.padded * DEM_ROW + k] != 0;
    for (size_t row = 0; row < w->bodies.padded; row++)
        for (int k = 0; k < 6 && (row >= w->bodies.count || body_absent(&w->bodies, row)); k++)
            truth->unsound += w->bodies.momentum[DEM_ROW * row + (size_t)k] != 0;
}

dem_status dem_world_validate(const dem_world *w, dem_truth *truth, dem_error *error)
{
    *truth = (dem_truth){0};
    check_structures(w, truth);
    DEM_TRY(check_pairs(w, truth, error));
    return check_walls(w, truth, error);
}
