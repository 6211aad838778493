#include "sim/refresh.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/bonds.h"
#include "sim/broad.h"

enum { LOOKS_TO_SHARE = 256 };  // that are worth more than one thread
enum { AHEAD = 6 };             // looks that memory is asked for ahead

static const double HORIZON = 80;                             // steps that a margin should last
static const double MARGIN_LEAST = 0.01, MARGIN_MOST = 0.15;  // of the length that suits the shape
static const double REACH_SHARE = 0.4;                        // of the bounding radius, that length at least
static const double SOFT_SHARE = 0.5;                         // of what soft contacts look ahead, at least: found by trial
static const float HEIGHT_ERROR = 4e-6f;                      // of the bounding radii: what 32 bits may be off by

static double margin_length(const dem_world *w, size_t row)
{
    const dem_template *t = &w->templates.items[w->bodies.shape[row]];
    return larger(t->radius_min, REACH_SHARE * t->radius_out) * body_scale(&w->bodies, row);
}

double dem_refresh_margin(const dem_world *w, size_t a, size_t b, double strides)
{
    double length = smaller(margin_length(w, a), margin_length(w, b));
    double margin = larger(MARGIN_LEAST * length, smaller(MARGIN_MOST * length, HORIZON * strides));
    // surfaces that hold on to each other stay in sight
    return larger(margin, larger(1.1 * w->reach, SOFT_SHARE * w->ahead));
}

// the path limit of a body but for its pairs
static double own_limit(const dem_world *w, size_t row)
{
    if (body_absent(&w->bodies, row))
        return INFINITY;
    double limit = w->bodies.search_limit[row];
    return w->bodies.wall_limit && !w->walls.sweep ? smaller(limit, w->bodies.wall_limit[row]) : limit;
}

static void set_side(const dem_world *w, size_t row, dem_cull_side *side)
{
    const dem_template *t = &w->templates.items[w->bodies.shape[row]];
    double scale = body_scale(&w->bodies, row), two = 2 * scale;
    dem_quat q = body_orientation(&w->bodies, row);
    dem_vec3 x = v3(scale - two * (q.y * q.y + q.z * q.z), two * (q.x * q.y + q.w * q.z), two * (q.x * q.z - q.w * q.y));
    dem_vec3 y = v3(two * (q.x * q.y - q.w * q.z), scale - two * (q.x * q.x + q.z * q.z), two * (q.y * q.z + q.w * q.x));
    dem_vec3 z = v3(two * (q.x * q.z + q.w * q.y), two * (q.y * q.z - q.w * q.x), scale - two * (q.x * q.x + q.y * q.y));
    size_t at = t->float_first;
    *side = (dem_cull_side){.x = w->templates.x + at,
                            .y = w->templates.y + at,
                            .z = w->templates.z + at,
                            .r = w->templates.r + at,
                            .padded = t->float_padded,
                            .axes = {(float)x.x, (float)y.x, (float)z.x, (float)x.y, (float)y.y, (float)z.y, (float)x.z,
                                     (float)y.z, (float)z.z},
                            .scale = (float)scale};
}

static bool reserve(dem_candidates *c, size_t more)
{
    if (c->count + more <= c->capacity)
        return true;
    if (c->count + more > UINT32_MAX)
        return false;  // 32 GB of them
    size_t capacity = (c->count + more) * 3 / 2 + 256;
    uint32_t *pairs = realloc(c->pairs, 2 * capacity * sizeof *pairs);
    if (!pairs)
        return false;
    c->pairs = pairs;
    c->capacity = capacity;
    return true;
}

static dem_vec3 offset_of(const dem_world *w, const dem_pair *p)
{
    dem_vec3 d = v3_sub(body_position(&w->bodies, p->b), body_position(&w->bodies, p->a));
    if (w->periodic) {
        const double *shift = w->shifts + 4 * p->image;
        d = v3_add(d, v3(shift[0], shift[1], shift[2]));
    }
    return d;
}

// the sphere pairs of two bodies by slabs
static bool cull(const dem_world *w, dem_pair *p, dem_vec3 d, double margin, dem_candidates *c, dem_fresh *out,
                 double *slack)
{
    dem_cull_job job = {.offset = {(float)d.x, (float)d.y, (float)d.z}, .margin = (float)margin, .work = c->work};
    set_side(w, p->a, &job.a);
    set_side(w, p->b, &job.b);
    job.error = HEIGHT_ERROR * (float)(w->bodies.radius[p->a] + w->bodies.radius[p->b]);
    dem_vec3 straight = v3_unit(d);
    bool known = p->normal[0] <= 1;
    float normal[3] = {known ? p->normal[0] : (float)straight.x, known ? p->normal[1] : (float)straight.y,
                       known ? p->normal[2] : (float)straight.z};
    for (size_t room = 64;; room = job.count) {
        if (!reserve(c, room))
            return false;
        memcpy(job.normal, normal, sizeof normal);
        job.pairs = c->pairs + 2 * c->count;
        job.capacity = c->capacity - c->count;
        w->kernels->cull(&job);
        if (job.count <= job.capacity)
            break;
    }
    memcpy(p->normal, job.normal, sizeof normal);
    out->count = (uint32_t)job.count;
    c->count += job.count;
    *slack = job.count == 0 && job.gap > margin ? job.gap : margin;
    return true;
}

static bool same_candidates(const dem_world *w, const dem_pair *p, const dem_fresh *fresh)
{
    if (fresh->count != p->count)
        return false;
    const dem_contacts *contacts = &w->contacts;
    const dem_segment *s = &contacts->segments[p->a / DEM_SEGMENT];
    const uint32_t *pairs = fresh->count ? w->candidates[fresh->thread].pairs + 2 * fresh->begin : NULL;
    uint32_t first_a = w->templates.items[w->bodies.shape[p->a]].first;
    uint32_t first_b = w->templates.items[w->bodies.shape[p->b]].first;
    for (size_t i = 0; i < fresh->count; i++) {
        size_t at = segment_place(s, p->start + i);
        if (contacts->columns.sphere_a[at] != first_a + pairs[2 * i] ||
            contacts->columns.sphere_b[at] != first_b + pairs[2 * i + 1])
            return false;
    }
    return true;
}

// soft contacts of the same parts follow each other, in the order they have
static bool sort_by_parts(const dem_world *w, const dem_pair *p, dem_candidates *c, const dem_fresh *fresh)
{
    uint32_t shape_a = w->bodies.shape[p->a], shape_b = w->bodies.shape[p->b];
    size_t count = fresh->count, begin[DEM_SOFT_PARTS * DEM_SOFT_PARTS + 1] = {0};
    if (count < 2 || w->soft.parts[shape_a] * w->soft.parts[shape_b] == 1)
        return true;
    if (!reserve(c, count))
        return false;
    const uint8_t *a = w->soft.part + w->templates.items[shape_a].first;
    const uint8_t *b = w->soft.part + w->templates.items[shape_b].first;
    uint32_t *pairs = c->pairs + 2 * fresh->begin, *was = c->pairs + 2 * c->count;
    memcpy(was, pairs, 2 * count * sizeof *was);
    for (size_t i = 0; i < count; i++)
        begin[DEM_SOFT_PARTS * a[was[2 * i]] + b[was[2 * i + 1]] + 1]++;
    for (size_t k = 1; k < DEM_SOFT_PARTS * DEM_SOFT_PARTS; k++)
        begin[k] += begin[k - 1];
    for (size_t i = 0; i < count; i++) {
        size_t to = begin[DEM_SOFT_PARTS * a[was[2 * i]] + b[was[2 * i + 1]]]++;
        memcpy(pairs + 2 * to, was + 2 * i, 2 * sizeof *was);
    }
    return true;
}

// in whatever order threads come
static void lower_limit(dem_world *w, uint32_t row, double limit)
{
    double *at = &w->bodies.limit[row], seen;
    __atomic_load(at, &seen, __ATOMIC_RELAXED);
    while (limit < seen && !__atomic_compare_exchange(at, &seen, &limit, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
        continue;
}

// each body's share of the slack in proportion to its stride
static void share_slack(dem_world *w, const dem_pair *p, double slack, double stride_a, double stride_b)
{
    double even = 0.05 * (stride_a + stride_b) + 1e-30, share = (stride_a + even) / (stride_a + stride_b + 2 * even);
    double limit_a = w->bodies.path[p->a] + slack * share, limit_b = w->bodies.path[p->b] + slack * (1 - share);
    w->pairs.adjacency_limit[p->adjacent_a] = limit_a;
    w->pairs.adjacency_limit[p->adjacent_b] = limit_b;
    lower_limit(w, p->a, limit_a);
    lower_limit(w, p->b, limit_b);
}

// writes of the pair and its limits, which no other thread has
static bool look_at_pair(dem_world *w, dem_fresh *fresh)
{
    dem_pair *p = &w->pairs.items[fresh->pair];
    const dem_bodies *b = &w->bodies;
    dem_candidates *c = &w->candidates[fresh->thread];
    dem_vec3 d = offset_of(w, p);
    double stride_a = body_stride(b, p->a, w->next_step), stride_b = body_stride(b, p->b, w->next_step);
    double margin = dem_refresh_margin(w, p->a, p->b, stride_a + stride_b) + w->ahead;
    double apart = v3_norm(d) * (1 - 1e-14) - b->radius[p->a] - b->radius[p->b], slack = apart;
    fresh->begin = (uint32_t)c->count;
    fresh->count = 0;
    if (apart < margin) {
        bool both_centred = w->templates.items[b->shape[p->a]].centred && w->templates.items[b->shape[p->b]].centred;
        if (!both_centred) {
            if (!cull(w, p, d, margin, c, fresh, &slack))
                return false;
        } else {
            if (!reserve(c, 1))
                return false;
            c->pairs[2 * c->count] = c->pairs[2 * c->count + 1] = 0;
            c->count++;
            fresh->count = 1;
            slack = margin;
        }
    }
    if (w->bonds && w->bonds->instead && fresh->count) {
        fresh->count = dem_bonds_mask(w, p, c->pairs + 2 * fresh->begin, fresh->count);
        c->count = fresh->begin + fresh->count;
    }
    if (w->soft.part && !sort_by_parts(w, p, c, fresh))
        return false;
    share_slack(w, p, slack - w->ahead, stride_a, stride_b);
    fresh->changed = !same_candidates(w, p, fresh);
    if (!fresh->changed) {
        c->count = fresh->begin;
        w->pairs.fresh[fresh->pair] = 0;
    }
    return true;
}

// the expired pairs of a share of the bodies that ask, and limits as those say that have not expired
static void expire_part(void *user, int part)
{
    dem_world *w = user;
    double *const limits = w->bodies.limit;
    const dem_pairs *pairs = &w->pairs;
    const double *pair_limits = pairs->adjacency_limit;
    const uint32_t *first = pairs->adjacency_first;
    size_t parts = (size_t)w->fresh_parts, count = w->asked_count;
    dem_candidates *c = &w->candidates[part];
    c->expired_count = 0;
    c->failed = false;
    size_t end = count * ((size_t)part + 1) / parts;
    for (size_t k = count * (size_t)part / parts; k < end; k++) {
        uint32_t row = w->asked[k];
        if (k + AHEAD < end)
            __builtin_prefetch(&pair_limits[first[w->asked[k + AHEAD]]]);
        double limit = own_limit(w, row), path = w->bodies.path[row];
        for (size_t i = first[row], last = first[row + 1]; i < last; i++) {
            if (path <= pair_limits[i]) {
                limit = smaller(limit, pair_limits[i]);
                continue;
            }
            if (!dem_grow(&c->expired, &c->expired_capacity, c->expired_count, sizeof *c->expired)) {
                c->failed = true;
                return;
            }
            c->expired[c->expired_count++] = pairs->adjacency[i];
        }
        limits[row] = limit;
    }
}

static int parts_for(const dem_world *w, size_t count)
{
    return count > LOOKS_TO_SHARE ? w->threads : 1;
}

// a pair that both bodies ask for is taken once, by the one that comes first
static bool collect_expired(dem_world *w)
{
    w->fresh_parts = parts_for(w, w->asked_count);
    dem_team_share(w->team, w->fresh_parts, expire_part, w);
    w->fresh_count = 0;
    for (int part = 0; part < w->fresh_parts; part++) {
        const dem_candidates *c = &w->candidates[part];
        if (c->failed)
            return false;
        for (size_t i = 0; i < c->expired_count; i++) {
            uint32_t pair = c->expired[i];
            if (w->pairs.fresh[pair])
                continue;
            if (!dem_grow(&w->fresh, &w->fresh_capacity, w->fresh_count, sizeof *w->fresh))
                return false;
            w->fresh[w->fresh_count++] = (dem_fresh){.pair = pair};
            w->pairs.fresh[pair] = (uint32_t)w->fresh_count;
            __builtin_prefetch(&w->pairs.items[pair]);
        }
    }
    return true;
}

// what the looks to come will wait for: first the pair, then its bodies and its contacts' segment
static void fetch(const dem_world *w, size_t k, size_t end)
{
    if (k + 2 * AHEAD < end)
        __builtin_prefetch(&w->pairs.items[w->fresh[k + 2 * AHEAD].pair]);
    if (k + AHEAD >= end)
        return;
    const dem_pair *p = &w->pairs.items[w->fresh[k + AHEAD].pair];
    for (int side = 0; side < 2; side++) {
        uint32_t row = side ? p->b : p->a;
        __builtin_prefetch(body_pose(&w->bodies, row));
        __builtin_prefetch(body_pose(&w->bodies, row) + 8);
        __builtin_prefetch(w->bodies.inertia + DEM_ROW * row);
        __builtin_prefetch(&w->bodies.radius[row]);
    }
}

// a share of the expired pairs
static void look_at_part(void *user, int part)
{
    dem_world *w = user;
    size_t parts = (size_t)w->fresh_parts, count = w->fresh_count;
    dem_candidates *c = &w->candidates[part];
    c->count = 0;
    c->failed = false;
    size_t end = count * ((size_t)part + 1) / parts;
    for (size_t i = count * (size_t)part / parts; i < end && !c->failed; i++) {
        fetch(w, i, end);
        w->fresh[i].thread = (uint16_t)part;
        c->failed = !look_at_pair(w, &w->fresh[i]);
    }
}

dem_status dem_refresh(dem_world *w, dem_error *error)
{
    if (!collect_expired(w))
        return dem_fail_memory(error);
    w->fresh_parts = parts_for(w, w->fresh_count);
    dem_team_share(w->team, w->fresh_parts, look_at_part, w);
    for (int part = 0; part < w->fresh_parts; part++)
        if (w->candidates[part].failed)
            return dem_fail_memory(error);
    for (size_t i = 0; i < w->fresh_count; i++)
        if (w->fresh[i].changed) {
            dem_segment *s = &w->contacts.segments[w->pairs.items[w->fresh[i].pair].a / DEM_SEGMENT];
            w->fresh[i].next = s->changed;
            s->changed = (uint32_t)i + 1;
        }
    return DEM_OK;
}

void dem_refresh_forget(dem_world *w)
{
    for (int t = 0; w->candidates && t < w->threads; t++) {
        free(w->candidates[t].pairs);
        free(w->candidates[t].expired);
        w->candidates[t] = (dem_candidates){.work = w->candidates[t].work};
    }
    free(w->fresh);
    w->fresh = NULL;
    w->fresh_capacity = w->fresh_count = 0;
}
