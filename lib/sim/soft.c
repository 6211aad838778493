#include "sim/soft.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/contacts.h"
#include "sim/impact.h"
#include "sim/timestep.h"

// An automatic tau is this part of the largest overlap of an impact that is likely here: with less the surface is
// rougher, with more flat faces are rounder.
static const double SHARE = 0.15;
static const double TAU_LEAST = 1e-7, TAU_MOST = 0.02;  // ... within these parts of the smallest grain's diameter
static const double RUNG = 1.25;  // sizes that share the weights differ by no more than the root of that

static double size_of(const dem_world *w, size_t row)
{
    return w->templates.items[w->bodies.shape[row]].equivalent_diameter * body_scale(&w->bodies, row);
}

// of two bodies like this one that meet at the speed [m]
static double impact_overlap(const double *law, double radius, double mass, double speed)
{
    if (law[LAW_HERTZ] > 0)
        return dem_hertz_overlap(mass, dem_hertz_stiffness(law[LAW_HERTZ] / 2, radius / 2), speed);
    return dem_linear_overlap(mass, law_stiffness(law, radius / 2, 0), speed);
}

// under the softest law that each one has
double dem_soft_likely_overlap(const dem_world *w)
{
    double speed = dem_step_impact_speed(w), sum = 0;
    size_t n = w->laws.material_count, count = 0;
    for (size_t row = 0; row < w->bodies.count; row++) {
        uint32_t material = w->templates.items[w->bodies.shape[row]].material;
        double mass = w->bodies.inertia[DEM_ROW * row + 5] / 2, own = 0;
        for (uint32_t other = 0; other < n; other++) {
            const double *law = laws_between(&w->laws, material, other);
            if (law)
                own = larger(own, impact_overlap(law, size_of(w, row) / 2, mass, speed));
        }
        sum += own;
        count += own > 0;
    }
    return count ? sum / (double)count : 0;
}

static double automatic_tau(const dem_world *w)
{
    double least = INFINITY;
    for (size_t row = 0; row < w->bodies.count; row++)
        least = smaller(least, size_of(w, row));
    if (!isfinite(least))
        return 1;  // there are no bodies
    return larger(TAU_LEAST * least, smaller(TAU_MOST * least, SHARE * dem_soft_likely_overlap(w)));
}

// one table of weights for each shape and rung of sizes that is in use
typedef struct rung {
    uint32_t shape;
    int step;
    uint32_t first;
} rung;

static dem_status make_weights(dem_world *w, dem_error *error)
{
    rung *rungs = NULL;
    size_t count = 0, capacity = 0, filled = 0, room = 0;
    dem_status status = DEM_OK;
    for (size_t row = 0; row < w->bodies.count && status == DEM_OK; row++) {
        uint32_t shape = w->bodies.shape[row];
        const dem_template *t = &w->templates.items[shape];
        int step = (int)lround(log(body_scale(&w->bodies, row)) / log(RUNG));
        size_t k = 0;
        while (k < count && !(rungs[k].shape == shape && rungs[k].step == step))
            k++;
        if (k == count) {
            bool good = dem_grow(&rungs, &capacity, count, sizeof *rungs);
            while (good && room < filled + t->count)
                good = dem_grow(&w->soft.weights, &room, room, sizeof *w->soft.weights);
            good =
                good && dem_soft_weigh((const double(*)[4])w->templates.spheres + t->first, t->count,
                                       w->soft.tau / pow(RUNG, step), t->equivalent_diameter, w->soft.weights + filled);
            if (!good) {
                status = dem_fail_memory(error);
                break;
            }
            rungs[count++] = (rung){shape, step, (uint32_t)filled};
            filled += t->count;
        }
        w->soft.first[row] = rungs[k].first - t->first;
    }
    w->soft.table_count = count;
    free(rungs);
    return status;
}

static dem_status check_features(const dem_world *w, dem_error *error)
{
    dem_features other = w->features, allowed = {.linear = true,
                                                 .young = true,
                                                 .hertz = true,
                                                 .rate = true,
                                                 .restitution = true,
                                                 .cut = true,
                                                 .local_mass = true,
                                                 .friction = true,
                                                 .decay = true,
                                                 .mindlin = true,
                                                 .slide_damping = true,
                                                 .offset = true,
                                                 .scaled = true,
                                                 .periodic = true,
                                                 .mixed = true,
                                                 .ledger = true,
                                                 .watch = true,
                                                 .moving = true,
                                                 .soft = true};
#define FEATURE(name, about)                                                                                           \
    if (other.name && !allowed.name)                                                                                   \
        return dem_fail(error, DEM_BAD_INPUT,                                                                          \
                        "\"contacts_between_clumps\": \"soft\" does not go with what this scene needs: " about         \
                        "; leave that out, or take \"sum\"");
    DEM_FEATURES(FEATURE)
#undef FEATURE
    return DEM_OK;
}

dem_status dem_soft_create(dem_world *w, double tau, dem_error *error)
{
    if (!w->features.soft)
        return DEM_OK;
    DEM_TRY(check_features(w, error));
    size_t n = w->bodies.padded;
    w->soft.kernels = dem_soft_kernels_choose(w->kernels->name);
    w->soft.first = dem_alloc_zero(n, sizeof *w->soft.first);
    w->soft.radius = dem_alloc_zero(n, sizeof *w->soft.radius);
    w->soft.work = dem_alloc_zero((size_t)w->threads, sizeof *w->soft.work);
    if (!w->soft.first || !w->soft.radius || !w->soft.work)
        return dem_fail_memory(error);
    for (size_t row = 0; row < w->bodies.count; row++)
        w->soft.radius[row] = size_of(w, row) / 2;
    w->soft.automatic = !(tau > 0);
    w->soft.tau = tau > 0 ? tau : automatic_tau(w);
    w->ahead = DEM_SOFT_REACH * w->soft.tau;
    return make_weights(w, error);
}

static void release_work(dem_soft_work *work)
{
    void *all[] = {work->rows, work->overlap, work->place, work->sorted, work->patches};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    *work = (dem_soft_work){0};
}

static bool reserve_work(dem_soft_work *work, size_t capacity)
{
    release_work(work);
    work->rows = aligned_alloc(64, 2 * capacity * DEM_ROW * sizeof *work->rows);
    work->overlap = dem_alloc(capacity, sizeof *work->overlap);
    work->place = dem_alloc(2 * capacity, sizeof *work->place);
    work->sorted = dem_alloc(capacity, sizeof *work->sorted);
    work->patches = dem_alloc(capacity, sizeof *work->patches);
    return work->rows && work->overlap && work->place && work->sorted && work->patches;
}

void dem_soft_release(dem_world *w)
{
    for (int t = 0; w->soft.work && t < w->threads; t++)
        release_work(&w->soft.work[t]);
    free(w->soft.work);
    free(w->soft.weights);
    free(w->soft.first);
    free(w->soft.radius);
}

void dem_soft_runs_release(dem_soft_runs *runs)
{
    free(runs->first);
    free(runs->rise);
}

static bool add_run(dem_soft_runs *runs, size_t first)
{
    if (!dem_grow(&runs->first, &runs->capacity, runs->count, sizeof *runs->first) ||
        !dem_grow(&runs->rise, &runs->rise_capacity, runs->count, sizeof *runs->rise))
        return false;
    runs->rise[runs->count] = 0;
    runs->first[runs->count++] = (uint32_t)first;
    return true;
}

static bool same_bodies(const dem_contact_columns *c, size_t i, size_t k, bool wall)
{
    if (wall)
        return c->a[i] == c->a[k] && c->sphere_b[i] == c->sphere_b[k];
    return c->a[i] == c->a[k] && c->b[i] == c->b[k] && !(c->shift && c->shift[i] != c->shift[k]);
}

static bool find_runs(const dem_world *w, dem_contacts *contacts, size_t segment, bool wall)
{
    dem_segment *s = &contacts->segments[segment];
    dem_soft_runs *runs = &contacts->runs[segment];
    const dem_contact_columns *c = &contacts->columns;
    size_t end = s->begin;
    runs->count = 0;
    // idle ones stand last
    for (size_t at = s->begin; at < s->end && c->a[at] < w->bodies.count; end = ++at) {
        if ((at == s->begin || !same_bodies(c, at - 1, at, wall)) && !add_run(runs, at - s->begin))
            return false;
        c->weight[at] = soft_weight(&w->soft, c->a[at], c->sphere_a[at]);
        if (!wall)
            c->weight[at] *= soft_weight(&w->soft, c->b[at], c->sphere_b[at]);
        runs->rise[runs->count - 1] += c->weight[at];
    }
    if (!add_run(runs, end - s->begin))
        return false;
    runs->count--;
    for (size_t r = 0; r < runs->count; r++)
        runs->rise[r] = w->soft.tau * log(runs->rise[r]);
    s->fresh = false;
    return true;
}

dem_status dem_soft_reserve(dem_world *w, dem_error *error)
{
    size_t most = 0;
    for (int form = -1; form < DEM_WALL_FORMS; form++) {
        dem_contacts *contacts = form < 0 ? &w->contacts : &w->wall_contacts[form];
        for (size_t i = 0; contacts->segments && i < w->segment_count; i++) {
            size_t size = contacts->segments[i].end - contacts->segments[i].begin;
            most = size > most ? size : most;
            if (contacts->segments[i].fresh && !find_runs(w, contacts, i, form >= 0))
                return dem_fail_memory(error);
        }
    }
    if (most + DEM_BLOCK_LANES <= w->soft.capacity)
        return DEM_OK;
    size_t capacity = most + most / 4 + 2 * DEM_BLOCK_LANES;
    for (int t = 0; t < w->threads; t++)
        if (!reserve_work(&w->soft.work[t], capacity))
            return dem_fail_memory(error);
    w->soft.capacity = capacity;
    return DEM_OK;
}

void dem_soft_pairs(dem_world *w, size_t begin, size_t end, double kick, size_t thread)
{
    for (size_t i = begin; i < end; i++)
        w->soft.kernels->segment(w, i, -1, kick, &w->soft.work[thread], NULL);
}

void dem_soft_walls(dem_world *w, size_t begin, size_t end, double kick, size_t thread)
{
    for (int form = 0; form < DEM_WALL_FORMS; form++)
        for (size_t i = begin; w->wall_contacts[form].segments && i < end; i++)
            w->soft.kernels->segment(w, i, form, kick, &w->soft.work[thread], NULL);
}

void dem_soft_records(dem_world *w, size_t segment, int form, dem_contact_record *records)
{
    const dem_contacts *contacts = form < 0 ? &w->contacts : &w->wall_contacts[form];
    const dem_segment *s = &contacts->segments[segment];
    if (s->begin == s->end)
        return;
    memset(records, 0, (s->end - s->begin) * sizeof *records);
    w->soft.kernels->segment(w, segment, form, 0, &w->soft.work[0], records);
}
