// Bodies are sorted by cell, x fastest, so that three neighbouring cells are one run of memory. The grid is closed on
// itself: far cells may share a place, which costs a comparison, but memory stays in proportion to the bodies however
// far they are apart. A body looks for partners in the grid of its own size, behind it in order, and in those of larger
// ones.
#include "sim/broad.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/bodies.h"
#include "sim/pairs.h"
#include "sim/population.h"
#include "sim/slim.h"

enum { LEVELS = 24, CELLS_LEAST = 4 };
enum { BODIES_TO_SHARE = 512 };  // that are worth more than one thread

static const double SKIN = 0.2;       // of the mean bounding radius; flat from 0.1 to 0.4
static const double SKIN_STEPS = 40;  // that the skin should last where bodies are fast, as long as
static const double SKIN_MOST = 2;    // ... it is not so many times as wide
static const double SKIN_LEFT = 0.1;  // of the skin, that looking once more at how far bodies have moved is worth

typedef struct level {
    double cell, radius;  // edge of a cell, largest radius [m]
    uint32_t dims[3];     // powers of two
    size_t begin, end;    // in the sorted columns
    uint32_t *start;      // [cells + 2]
    size_t start_capacity;
} level;

// what a thread finds
typedef struct finding {
    uint32_t *found;  // about one body
    dem_near *near;
    size_t count, capacity;
    bool failed;
} finding;

/// Little is kept from one search to the next, as columns and lists of pairs would be a sixth of all memory.
struct dem_search {
    dem_world *w;
    level levels[LEVELS];
    int level_count;
    dem_box box;
    double pad;            // of distances in 32 bits [m]
    float *x, *y, *z, *r;  // sorted by level and cell
    uint32_t *id, *cell;
    uint8_t *level_of;
    bool slim;  // some shapes are
    int32_t *moved;
    finding *findings;  // [parts]
    int parts;
    dem_near *near;  // of all parts: the only one's, or joined
    dem_near *joined;
    size_t near_count;
};
typedef struct dem_search search;

double dem_broad_skin(const dem_world *w)
{
    double sum = 0;
    for (size_t i = 0; i < w->bodies.count; i++)
        sum += w->bodies.radius[i];
    if (w->population && !w->bodies.living)
        return SKIN * dem_population_radius(w->population);
    return w->bodies.living ? SKIN * sum / (double)w->bodies.living : 0;
}

dem_status dem_broad_images(dem_world *w, dem_error *error)
{
    double side[3], largest = w->population ? dem_population_largest(w->population) : 0;
    for (size_t i = 0; i < w->bodies.count; i++)
        largest = larger(largest, w->bodies.radius[i]);
    for (int k = 0; k < 3; k++) {
        side[k] = w->domain.periodic[k] ? v3_get(w->domain.high, k) - v3_get(w->domain.low, k) : 0;
        if (w->domain.periodic[k] && side[k] * (DEM_IMAGES_ASIDE - 1) < 2 * largest + w->skin + w->ahead)
            return dem_fail(error, DEM_BAD_INPUT,
                            "the domain is periodic over %g m, too short for a body of %g m; make that side longer",
                            side[k], 2 * largest);
    }
    w->shifts = aligned_alloc(64, (DEM_IMAGES * 4 * sizeof *w->shifts + 63) / 64 * 64);
    if (!w->shifts)
        return dem_fail_memory(error);
    for (uint32_t i = 0; i < DEM_IMAGES; i++) {
        int image[3];
        image_of(i, image);
        for (int k = 0; k < 3; k++)
            w->shifts[4 * i + (uint32_t)k] = image[k] * side[k];
        w->shifts[4 * i + 3] = 0;
    }
    return DEM_OK;
}

// ---- grids

static uint32_t power_of_two(double at_least)
{
    uint32_t n = CELLS_LEAST;
    while (n < at_least && n < 1u << 20)
        n *= 2;
    return n;
}

static bool make_level(search *s, level *l, size_t bodies)
{
    for (int k = 0; k < 3; k++)
        l->dims[k] = power_of_two((v3_get(s->box.high, k) - v3_get(s->box.low, k)) / l->cell + 2);
    while ((double)l->dims[0] * l->dims[1] * l->dims[2] > 4.0 * (double)bodies + 64) {
        int longest = l->dims[1] > l->dims[0] ? 1 : 0;
        longest = l->dims[2] > l->dims[longest] ? 2 : longest;
        if (l->dims[longest] == CELLS_LEAST)
            break;
        l->dims[longest] /= 2;
    }
    size_t cells = (size_t)l->dims[0] * l->dims[1] * l->dims[2] + 2;
    if (cells > l->start_capacity) {
        free(l->start);
        l->start = dem_alloc(cells, sizeof *l->start);
        l->start_capacity = l->start ? cells : 0;
    }
    if (l->start)
        memset(l->start, 0, cells * sizeof *l->start);
    return l->start;
}

static void cell_of(const search *s, const level *l, dem_vec3 x, int32_t cell[3])
{
    for (int k = 0; k < 3; k++) {
        // whole numbers, however far it is
        double at = larger(smaller((v3_get(x, k) - v3_get(s->box.low, k)) / l->cell, 9e15), -9e15);
        int64_t whole = (int64_t)at;
        whole -= at < (double)whole;
        cell[k] = (int32_t)(whole & (int64_t)(l->dims[k] - 1));
    }
}

static size_t cell_index(const level *l, int32_t x, int32_t y, int32_t z)
{
    uint32_t cx = (uint32_t)x & (l->dims[0] - 1), cy = (uint32_t)y & (l->dims[1] - 1),
             cz = (uint32_t)z & (l->dims[2] - 1);
    return ((size_t)cz * l->dims[1] + cy) * l->dims[0] + cx;
}

dem_status dem_search_create(dem_world *w, dem_error *error)
{
    search *s = w->search = dem_alloc_zero(1, sizeof *s);
    if (!s)
        return dem_fail_memory(error);
    size_t n = w->bodies.count;
    s->w = w;
    for (size_t i = 0; i < w->templates.count; i++)
        s->slim |= w->templates.items[i].slim;
    s->parts = n > BODIES_TO_SHARE ? w->threads : 1;
    s->findings = dem_alloc_zero((size_t)s->parts, sizeof *s->findings);
    s->moved = dem_alloc_zero(w->periodic ? 3 * n + 3 : 0, sizeof *s->moved);
    return s->findings && s->moved ? DEM_OK : dem_fail_memory(error);
}

static bool make_columns(search *s)
{
    size_t n = s->w->bodies.count, room = n + 2 * DEM_WIDTH_FLOAT + 32;
    s->x = dem_alloc_zero(room, sizeof *s->x);
    s->y = dem_alloc_zero(room, sizeof *s->y);
    s->z = dem_alloc_zero(room, sizeof *s->z);
    s->r = dem_alloc_zero(room, sizeof *s->r);
    s->id = dem_alloc_zero(room, sizeof *s->id);
    s->cell = dem_alloc(n + 1, sizeof *s->cell);
    s->level_of = dem_alloc(n + 1, sizeof *s->level_of);
    bool good = s->x && s->y && s->z && s->r && s->id && s->cell && s->level_of;
    for (int i = 0; good && i < s->parts; i++)
        good = (s->findings[i].found = dem_alloc(2 * room, sizeof *s->findings[i].found)) != NULL;
    return good;
}

static void release_columns(search *s)
{
    for (int i = 0; s->findings && i < s->parts; i++) {
        free(s->findings[i].found);
        free(s->findings[i].near);
        s->findings[i] = (finding){0};
    }
    void *all[] = {s->x, s->y, s->z, s->r, s->id, s->cell, s->level_of, s->joined};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    s->x = s->y = s->z = s->r = NULL;
    s->id = s->cell = NULL;
    s->level_of = NULL;
    s->near = s->joined = NULL;
}

void dem_search_destroy(dem_search *s)
{
    if (!s)
        return;
    release_columns(s);
    free(s->findings);
    free(s->moved);
    for (int i = 0; i < LEVELS; i++)
        free(s->levels[i].start);
    free(s);
}

// sizes within a factor of two share a grid
static void sort_by_size(search *s, size_t counts[LEVELS])
{
    const dem_bodies *b = &s->w->bodies;
    double smallest = INFINITY, largest[LEVELS] = {0};
    size_t sizes[LEVELS] = {0};
    int rank[LEVELS];
    for (size_t i = 0; i < b->count; i++)
        if (!body_absent(b, i))
            smallest = smaller(smallest, b->radius[i]);
    for (size_t i = 0; i < b->count; i++) {
        if (body_absent(b, i))
            continue;
        int octave = (int)smaller(log2(b->radius[i] / smallest) + 1e-9, LEVELS - 1);
        s->level_of[i] = (uint8_t)octave;
        sizes[octave]++;
        largest[octave] = larger(largest[octave], b->radius[i]);
    }
    for (int k = 0; k < LEVELS; k++)
        if (sizes[k]) {
            rank[k] = s->level_count;
            counts[s->level_count] = sizes[k];
            level *l = &s->levels[s->level_count++];
            l->cell = 2 * largest[k] + s->w->skin + s->w->ahead + s->pad;
            l->radius = largest[k];
        }
    for (size_t i = 0; i < b->count; i++)
        if (!body_absent(b, i))
            s->level_of[i] = (uint8_t)rank[s->level_of[i]];
}

static dem_status build_grids(search *s, dem_error *error)
{
    const dem_bodies *b = &s->w->bodies;
    size_t counts[LEVELS];
    s->box = box_empty();
    double largest = 0;
    for (size_t i = 0; i < b->count; i++) {
        if (body_absent(b, i))
            continue;
        s->box = box_with(s->box, body_position(b, i));
        largest = larger(largest, b->radius[i]);
    }
    // positions are rounded to 32 bits with respect to the corner of the box
    s->pad = 4e-7 * (box_diagonal(s->box) + 4 * largest);
    sort_by_size(s, counts);
    size_t begin = 0;
    for (int k = 0; k < s->level_count; k++) {
        if (!make_level(s, &s->levels[k], counts[k]))
            return dem_fail_memory(error);
        s->levels[k].begin = begin;
        s->levels[k].end = begin += counts[k];
    }
    for (size_t i = 0; i < b->count; i++) {
        if (body_absent(b, i))
            continue;
        level *l = &s->levels[s->level_of[i]];
        int32_t c[3];
        cell_of(s, l, body_position(b, i), c);
        s->cell[i] = (uint32_t)cell_index(l, c[0], c[1], c[2]);
        l->start[s->cell[i] + 2]++;
    }
    for (int k = 0; k < s->level_count; k++) {
        level *l = &s->levels[k];
        size_t cells = (size_t)l->dims[0] * l->dims[1] * l->dims[2];
        l->start[0] = l->start[1] = (uint32_t)l->begin;
        for (size_t c = 2; c < cells + 2; c++)
            l->start[c] += l->start[c - 1];
    }
    for (size_t i = 0; i < b->count; i++) {
        if (body_absent(b, i))
            continue;
        uint32_t at = s->levels[s->level_of[i]].start[s->cell[i] + 1]++;
        dem_vec3 x = v3_sub(body_position(b, i), s->box.low);
        s->id[at] = (uint32_t)i;
        s->x[at] = (float)x.x;
        s->y[at] = (float)x.y;
        s->z[at] = (float)x.z;
        s->r[at] = (float)b->radius[i];
    }
    return DEM_OK;
}

// ---- queries

// candidates of a ball in one grid
static size_t look_around(const search *s, const level *l, dem_vec3 x, double reach, uint32_t *found)
{
    dem_vec3 from = v3_sub(x, s->box.low);
    dem_scan_job job = {.x = s->x,
                        .y = s->y,
                        .z = s->z,
                        .r = s->r,
                        .id = s->id,
                        .centre = {(float)from.x, (float)from.y, (float)from.z},
                        .reach = (float)((reach + s->pad) * (1 + 1e-6)),
                        .found = found};
    int32_t c[3];
    cell_of(s, l, x, c);
    bool row = c[0] > 0 && (uint32_t)c[0] + 1 < l->dims[0];
    for (int dz = -1; dz <= 1; dz++)
        for (int dy = -1; dy <= 1; dy++)
            for (int dx = row ? 0 : -1; dx <= (row ? 0 : 1); dx++) {
                size_t at = cell_index(l, c[0] + dx, c[1] + dy, c[2] + dz);
                job.begin = l->start[row ? at - 1 : at];
                job.end = l->start[(row ? at + 1 : at) + 1];
                if (job.begin < job.end)
                    s->w->kernels->scan(&job);
            }
    return job.count;
}

static bool boxes_apart(const search *s, uint32_t a, uint32_t b, uint32_t image)
{
    const dem_world *w = s->w;
    const dem_template *items = w->templates.items;
    if (!items[w->bodies.shape[a]].slim && !items[w->bodies.shape[b]].slim)
        return false;
    dem_vec3 offset = v3_sub(body_position(&w->bodies, b), body_position(&w->bodies, a));
    if (w->periodic)
        offset = v3_add(offset, v3(w->shifts[4 * image], w->shifts[4 * image + 1], w->shifts[4 * image + 2]));
    return dem_slim_apart(w, a, b, offset, w->skin + w->ahead);
}

static bool add_near(const search *s, finding *f, uint32_t a, uint32_t b, uint32_t image)
{
    if (hold_whole(body_hold(&s->w->bodies, a)) && hold_whole(body_hold(&s->w->bodies, b)))
        return true;  // contacts can do nothing to either
    if (s->slim && boxes_apart(s, a, b, image))
        return true;
    if (!dem_grow(&f->near, &f->capacity, f->count, sizeof *f->near))
        return false;
    f->near[f->count++] = (dem_near){a, b, image};
    return true;
}

// partners of body i seen from where its image stands
static bool look_from_image(const search *s, finding *f, uint32_t i, const int image[3])
{
    const dem_bodies *b = &s->w->bodies;
    bool own = image[0] == 0 && image[1] == 0 && image[2] == 0;
    bool first_half = image[0] != 0 ? image[0] > 0 : image[1] != 0 ? image[1] > 0 : image[2] > 0;
    uint32_t away = image_row(image[0], image[1], image[2]), back = image_row(-image[0], -image[1], -image[2]);
    dem_vec3 x = body_position(b, i);
    if (!own)
        x = v3_add(x, v3(s->w->shifts[4 * away], s->w->shifts[4 * away + 1], s->w->shifts[4 * away + 2]));
    for (int k = s->level_of[i]; k < s->level_count; k++) {
        size_t count = look_around(s, &s->levels[k], x, b->radius[i] + s->w->skin + s->w->ahead, f->found);
        for (size_t j = 0; j < count; j++) {
            uint32_t other = f->found[j];
            if (k == s->level_of[i] && (other < i || (other == i && !first_half)))
                continue;
            // i at x + S sees the other at its place: the other is at -S from i
            bool good = other >= i ? add_near(s, f, i, other, back) : add_near(s, f, other, i, away);
            if (!good)
                return false;
        }
    }
    return true;
}

static bool look_from(const search *s, finding *f, uint32_t i)
{
    const dem_domain_def *domain = &s->w->domain;
    double reach = s->w->bodies.radius[i] + s->levels[s->level_count - 1].radius + s->w->skin + s->w->ahead;
    int low[3] = {0}, high[3] = {0};
    for (int k = 0; k < 3; k++)
        if (domain->periodic[k]) {
            double from = v3_get(domain->low, k), side = v3_get(domain->high, k) - from;
            double at = v3_get(body_position(&s->w->bodies, i), k) - from;
            // images whose reach touches the domain
            low[k] = -(int)floor((at + reach) / side);
            high[k] = (int)floor((side - at + reach) / side);
        }
    for (int x = low[0]; x <= high[0]; x++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int z = low[2]; z <= high[2]; z++)
                if (!look_from_image(s, f, i, (int[]){x, y, z}))
                    return false;
    return true;
}

// whole segments of bodies for a part
static size_t part_begin(const search *s, int part)
{
    size_t row = s->w->segment_count * (size_t)part / (size_t)s->parts * DEM_SEGMENT;
    return row < s->w->bodies.count ? row : s->w->bodies.count;
}

static void look_part(void *user, int part)
{
    const search *s = user;
    finding *f = &s->findings[part];
    for (size_t i = part_begin(s, part); i < part_begin(s, part + 1) && !f->failed; i++)
        f->failed = !body_absent(&s->w->bodies, i) && !look_from(s, f, (uint32_t)i);
}

// what all parts have found, in the order of bodies
static dem_status look_from_all(search *s, dem_error *error)
{
    dem_team_share(s->w->team, s->parts, look_part, s);
    s->near_count = 0;
    for (int i = 0; i < s->parts; i++) {
        if (s->findings[i].failed)
            return dem_fail_memory(error);
        s->near_count += s->findings[i].count;
    }
    s->near = s->findings[0].near;
    if (s->parts == 1)
        return DEM_OK;
    s->near = s->joined = dem_alloc(s->near_count, sizeof *s->joined);
    if (!s->joined)
        return dem_fail_memory(error);
    size_t at = 0;
    for (int i = 0; i < s->parts; i++) {
        if (s->findings[i].count)
            memcpy(s->near + at, s->findings[i].near, s->findings[i].count * sizeof *s->near);
        at += s->findings[i].count;
    }
    return DEM_OK;
}

// ---- when a search is due

static dem_vec3 then_of(const dem_bodies *b, size_t row)
{
    const double *then = b->then + 3 * row;
    return v3(then[0], then[1], then[2]);
}

// by the speed of the fastest body; bodies that leave are looked for by the skin, so there it stays
static double skin_now(const dem_world *w)
{
    const dem_bodies *b = &w->bodies;
    double fastest = 0, largest = 0, most = SKIN_MOST * w->skin_least;
    if (w->population)
        return w->skin_least;
    for (size_t i = 0; i < b->count; i++) {
        const double *v = body_pose(b, i) + 8;
        fastest = larger(fastest, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        largest = larger(largest, b->radius[i]);
    }
    // images that see each other have to be among those that there are
    for (int k = 0; w->periodic && k < 3; k++)
        if (w->domain.periodic[k])
            most = smaller(most, (DEM_IMAGES_ASIDE - 1) * (v3_get(w->domain.high, k) - v3_get(w->domain.low, k)) -
                                     2 * largest - w->ahead);
    return larger(w->skin_least, smaller(most, 2 * SKIN_STEPS * sqrt(fastest) * w->next_step));
}

// how far bodies have moved since the search: the middle of all, and the most about it. Where a search also puts bodies
// back into a periodic domain, takes those out that have left, or bounds what walls sweep, there is no middle.
static double moved_most(const dem_world *w, dem_vec3 *middle)
{
    const dem_bodies *b = &w->bodies;
    dem_box box = box_empty();
    double most = 0;
    bool together = !w->periodic && !w->population && !w->walls.sweep && b->count;
    *middle = v3(0, 0, 0);
    for (size_t i = 0; together && i < b->count; i++)
        box = box_with(box, v3_sub(body_position(b, i), then_of(b, i)));
    if (together)
        *middle = v3_scale(v3_add(box.low, box.high), 0.5);
    for (size_t i = 0; i < b->count; i++)
        if (!body_absent(b, i))
            most = larger(most, v3_norm2(v3_sub(v3_sub(body_position(b, i), then_of(b, i)), *middle)));
    return sqrt(most);
}

// Two bodies that were not near have come nearer by no more than both have moved about the middle; rods and plates come
// near by turning, too.
bool dem_broad_extend(dem_world *w)
{
    dem_bodies *b = &w->bodies;
    dem_vec3 middle;
    if (w->search->slim || !(moved_most(w, &middle) <= (1 - SKIN_LEFT) * w->skin / 2))
        return false;
    for (size_t i = 0; i < b->count; i++)
        if (!body_absent(b, i)) {
            dem_vec3 moved = v3_sub(v3_sub(body_position(b, i), then_of(b, i)), middle);
            b->search_limit[i] = b->path[i] + w->skin / 2 - v3_norm(moved);
        }
    return true;
}

dem_status dem_broad_search(dem_world *w, dem_error *error)
{
    search *s = w->search;
    s->level_count = 0;
    if (w->periodic)
        dem_bodies_wrap(w, s->moved);
    w->skin = skin_now(w);
    dem_status status = make_columns(s) ? build_grids(s, error) : dem_fail_memory(error);
    if (status == DEM_OK)
        status = look_from_all(s, error);
    if (status == DEM_OK)
        status = dem_pairs_replace(w, s->near, s->near_count, s->level_count == 1, s->moved, error);
    release_columns(s);
    DEM_TRY(status);
    for (size_t i = 0; i < w->bodies.count; i++) {
        memcpy(w->bodies.then + 3 * i, body_pose(&w->bodies, i), 3 * sizeof *w->bodies.then);
        w->bodies.search_limit[i] = w->bodies.path[i] + w->skin / 2;
    }
    return DEM_OK;
}
