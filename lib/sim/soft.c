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
        if (body_absent(&w->bodies, row))
            continue;
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
        if (!body_absent(&w->bodies, row))
            least = smaller(least, size_of(w, row));
    if (!isfinite(least))
        return 1;  // there are no bodies
    return larger(TAU_LEAST * least, smaller(TAU_MOST * least, SHARE * dem_soft_likely_overlap(w)));
}

// the table of weights of a shape at a rung of sizes; NULL: no memory
static const dem_soft_table *table_of(dem_world *w, uint32_t shape, int rung)
{
    dem_soft *soft = &w->soft;
    for (size_t k = 0; k < soft->table_count; k++)
        if (soft->tables[k].shape == shape && soft->tables[k].rung == rung)
            return &soft->tables[k];
    const dem_template *t = &w->templates.items[shape];
    if (!dem_grow(&soft->tables, &soft->table_capacity, soft->table_count, sizeof *soft->tables))
        return NULL;
    while (soft->weight_capacity < soft->weight_count + t->count)
        if (!dem_grow(&soft->weights, &soft->weight_capacity, soft->weight_capacity, sizeof *soft->weights))
            return NULL;
    if (!dem_soft_weigh((const double(*)[4])w->templates.spheres + t->first, t->count, soft->tau / pow(RUNG, rung),
                        t->equivalent_diameter, soft->weights + soft->weight_count))
        return NULL;
    dem_soft_table *table = &soft->tables[soft->table_count++];
    *table = (dem_soft_table){shape, rung, (uint32_t)soft->weight_count};
    soft->weight_count += t->count;
    return table;
}

dem_status dem_soft_join(dem_world *w, size_t row, dem_error *error)
{
    if (!w->features.soft)
        return DEM_OK;
    uint32_t shape = w->bodies.shape[row];
    const dem_soft_table *table = table_of(w, shape, (int)lround(log(body_scale(&w->bodies, row)) / log(RUNG)));
    if (!table)
        return dem_fail_memory(error);
    w->soft.first[row] = table->first - w->templates.items[shape].first;
    w->soft.radius[row] = size_of(w, row) / 2;
    return DEM_OK;
}

dem_status dem_soft_join_all(dem_world *w, dem_error *error)
{
    for (size_t row = 0; w->features.soft && row < w->bodies.count; row++)
        if (!body_absent(&w->bodies, row))
            DEM_TRY(dem_soft_join(w, row, error));
    return DEM_OK;
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
                                                 .rolling = true,
                                                 .roll_constant = true,
                                                 .roll_bound = true,
                                                 .twisting = true,
                                                 .twist_constant = true,
                                                 .offset = true,
                                                 .scaled = true,
                                                 .periodic = true,
                                                 .mixed = true,
                                                 .ledger = true,
                                                 .watch = true,
                                                 .moving = true,
                                                 .reaction = true,
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

static void forget_parts(dem_soft *soft)
{
    free(soft->part);
    free(soft->parts);
    free(soft->couplings);
    soft->part = soft->parts = NULL;
    soft->couplings = NULL;
}

// the parts of every shape; nothing is kept where each is one
static dem_status split_shapes(dem_world *w, dem_error *error)
{
    dem_soft *soft = &w->soft;
    size_t most = 1;
    soft->part = dem_alloc_zero(w->templates.sphere_count, sizeof *soft->part);
    soft->parts = dem_alloc_zero(w->templates.count, sizeof *soft->parts);
    soft->couplings = dem_alloc_zero(w->templates.count, sizeof *soft->couplings);
    if (!soft->part || !soft->parts || !soft->couplings)
        return dem_fail_memory(error);
    for (size_t i = 0; i < w->templates.count; i++) {
        const dem_template *t = &w->templates.items[i];
        const double(*spheres)[4] = (const double(*)[4])w->templates.spheres + t->first;
        size_t parts = dem_soft_split(spheres, t->count, t->equivalent_diameter, soft->part + t->first);
        if (!parts)
            return dem_fail_memory(error);
        dem_soft_part_distances(spheres, t->count, t->equivalent_diameter, soft->part + t->first, parts,
                                &soft->couplings[i]);
        soft->parts[i] = (uint8_t)parts;
        most = parts > most ? parts : most;
    }
    if (most == 1)
        forget_parts(soft);
    return DEM_OK;
}

dem_status dem_soft_create(dem_world *w, double tau, dem_error *error)
{
    if (!w->features.soft)
        return DEM_OK;
    DEM_TRY(check_features(w, error));
    DEM_TRY(split_shapes(w, error));
    size_t n = w->bodies.padded;
    w->soft.kernels = dem_soft_kernels_choose(w->kernels->name);
    w->soft.first = dem_alloc_zero(n, sizeof *w->soft.first);
    w->soft.radius = dem_alloc_zero(n, sizeof *w->soft.radius);
    w->soft.work = dem_alloc_zero((size_t)w->threads, sizeof *w->soft.work);
    if (!w->soft.first || !w->soft.radius || !w->soft.work)
        return dem_fail_memory(error);
    w->soft.automatic = !(tau > 0);
    if (w->soft.automatic && w->population && !w->bodies.living)
        return dem_fail(
            error, DEM_BAD_INPUT,
            "soft.tau cannot be \"auto\" where all bodies are still to come; give it, about a fourth of the "
            "largest overlap that you expect");
    w->soft.tau = tau > 0 ? tau : automatic_tau(w);
    w->ahead = DEM_SOFT_REACH * w->soft.tau;
    return dem_soft_join_all(w, error);
}

static void release_work(dem_soft_work *work)
{
    void *all[] = {work->rows, work->overlap, work->place, work->sorted, work->patches, work->share};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    *work = (dem_soft_work){0};
}

static bool reserve_work(dem_soft_work *work, size_t capacity, bool parted)
{
    release_work(work);
    work->rows = aligned_alloc(64, 2 * capacity * DEM_ROW * sizeof *work->rows);
    work->overlap = dem_alloc(capacity, sizeof *work->overlap);
    work->place = dem_alloc(2 * capacity, sizeof *work->place);
    work->sorted = dem_alloc(capacity, sizeof *work->sorted);
    work->patches = dem_alloc(capacity, sizeof *work->patches);
    work->share = parted ? dem_alloc(2 * capacity, sizeof *work->share) : NULL;
    return work->rows && work->overlap && work->place && work->sorted && work->patches && (work->share || !parted);
}

void dem_soft_release(dem_world *w)
{
    for (int t = 0; w->soft.work && t < w->threads; t++)
        release_work(&w->soft.work[t]);
    free(w->soft.work);
    free(w->soft.weights);
    free(w->soft.tables);
    forget_parts(&w->soft);
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

bool dem_soft_same_run(const dem_world *w, const dem_contacts *contacts, size_t i, size_t k, int form)
{
    const dem_contact_columns *c = &contacts->columns;
    bool wall = form >= 0, parted = w->soft.part && form != DEM_FORM_MESH;
    if (c->a[i] != c->a[k] || (parted && w->soft.part[c->sphere_a[i]] != w->soft.part[c->sphere_a[k]]))
        return false;
    if (wall)
        return c->sphere_b[i] == c->sphere_b[k];
    return c->b[i] == c->b[k] && !(c->shift && c->shift[i] != c->shift[k]) &&
           !(parted && w->soft.part[c->sphere_b[i]] != w->soft.part[c->sphere_b[k]]);
}

static bool find_runs(const dem_world *w, dem_contacts *contacts, size_t segment, int form)
{
    dem_segment *s = &contacts->segments[segment];
    dem_soft_runs *runs = &contacts->runs[segment];
    const dem_contact_columns *c = &contacts->columns;
    size_t end = s->begin;
    runs->count = 0;
    // idle ones stand last
    for (size_t at = s->begin; at < s->end && c->a[at] < w->bodies.count; end = ++at) {
        if ((at == s->begin || !dem_soft_same_run(w, contacts, at - 1, at, form)) && !add_run(runs, at - s->begin))
            return false;
        c->weight[at] = soft_weight(&w->soft, c->a[at], c->sphere_a[at]);
        if (form < 0)
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
            if (contacts->segments[i].fresh && !find_runs(w, contacts, i, form))
                return dem_fail_memory(error);
        }
    }
    if (most + DEM_BLOCK_LANES <= w->soft.capacity)
        return DEM_OK;
    size_t capacity = most + most / 4 + 2 * DEM_BLOCK_LANES;
    for (int t = 0; t < w->threads; t++)
        if (!reserve_work(&w->soft.work[t], capacity, w->soft.part != NULL))
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
