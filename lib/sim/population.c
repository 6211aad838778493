#include "sim/population.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/status.h"
#include "sim/bodies.h"
#include "sim/bonds.h"
#include "sim/hold.h"
#include "sim/lists.h"
#include "sim/measure.h"

enum { ROWS_MORE = 64, ROWS_AT_FIRST = 4096 };

// ---- making

static dem_status refuse(const dem_inlet_def *def, dem_error *error, const char *what)
{
    return dem_fail(error, DEM_BAD_INPUT, "inlet \"%.60s\": %s", def->name ? def->name : "", what);
}

static bool finite_def(const dem_inlet_def *d)
{
    double sum = d->velocity_spread + d->spin_spread + d->gap + d->start + d->rate;
    dem_vec3 vectors = v3_add(d->velocity, d->spin);
    bool place = d->kind == DEM_INLET_BOX
                     ? isfinite(v3_norm2(d->low) + v3_norm2(d->high)) && d->low.x < d->high.x &&
                           d->low.y < d->high.y && d->low.z < d->high.z
                     : isfinite(v3_norm2(d->centre)) && d->radius > 0 && isfinite(d->radius);
    return isfinite(sum + v3_norm2(vectors)) && place && !isnan(d->stop) && d->velocity_spread >= 0 &&
           d->spin_spread >= 0 && d->gap >= 0;
}

// the corners of what holds a body as it comes
static void corners(const dem_inlet_def *d, dem_vec3 *low, dem_vec3 *high)
{
    dem_vec3 r = v3(d->radius, d->radius, d->radius);
    *low = d->kind == DEM_INLET_BOX ? d->low : v3_sub(d->centre, r);
    *high = d->kind == DEM_INLET_BOX ? d->high : v3_add(d->centre, r);
}

static dem_status check_place(const dem_world *w, const dem_inlet *inlet, dem_error *error)
{
    const dem_inlet_def *d = &inlet->def;
    dem_vec3 low, high;
    corners(d, &low, &high);
    for (int k = 0; k < 3; k++) {
        double slack = 1e-9 * (v3_get(high, k) - v3_get(low, k));
        if (v3_get(low, k) < v3_get(w->domain.low, k) - slack || v3_get(high, k) > v3_get(w->domain.high, k) + slack)
            return refuse(d, error, "reaches out of the domain; make the domain larger, or move the inlet");
    }
    dem_vec3 e = v3_sub(high, low);
    if (d->kind == DEM_INLET_BOX && smaller(e.x, smaller(e.y, e.z)) < 2 * inlet->largest)
        return dem_fail(error, DEM_BAD_INPUT,
                        "inlet \"%.60s\": the box is narrower than the largest body, %.4g m across; make it wider, or "
                        "limit the sizes",
                        inlet->name, 2 * inlet->largest);
    if (d->kind == DEM_INLET_SPHERE && d->radius < inlet->largest * (1 - 1e-9))
        return dem_fail(error, DEM_BAD_INPUT,
                        "inlet \"%.60s\": the sphere does not hold the largest body, whose radius is %.4g m; make it "
                        "larger, or limit the sizes",
                        inlet->name, inlet->largest);
    return DEM_OK;
}

// of the sizes in the middle, and of the largest
static void set_sizes(const dem_world *w, dem_inlet *inlet)
{
    dem_fill_draw draw;
    for (size_t i = 0; dem_fill_drawer_quantile(inlet->drawer, i, 1, &draw); i++)
        inlet->largest = larger(inlet->largest, w->templates.items[draw.shape].radius_out * draw.scale);
    for (size_t i = 0; dem_fill_drawer_quantile(inlet->drawer, i, 0.5, &draw); i++)
        inlet->radius = larger(inlet->radius, w->templates.items[draw.shape].radius_out * draw.scale);
}

static dem_status make_inlet(dem_world *w, const dem_scene *scene, size_t index, dem_error *error)
{
    dem_inlet *inlet = &w->population->inlets[index];
    const dem_inlet_def *def = &scene->inlets[index];
    *inlet = (dem_inlet){.def = *def, .inside = (uint32_t)DEM_ROW_FREE};
    inlet->def.mix = NULL;
    inlet->hold = scene->dimension == 2 ? DEM_LOCK_PLANE : 0;
    inlet->name = strdup(def->name ? def->name : "");
    inlet->def.name = inlet->name;
    if (!inlet->name)
        return dem_fail_memory(error);
    if (!finite_def(def))
        return refuse(def, error, "has a number or a place that cannot be; correct it");
    if (!(def->rate > 0))
        return refuse(def, error, "the rate must be above 0; leave the inlet out if nothing is to come");
    if (def->kind == DEM_INLET_SPHERE && !(v3_norm2(def->velocity) > 0))
        return refuse(def, error, "bodies never get out of the sphere; give it a \"velocity\"");
    // inlets that are alike but for their place give other bodies all the same
    dem_fill_def fill = {.mix = def->mix,
                         .mix_count = def->mix_count,
                         .share_by_mass = def->share_by_mass,
                         .seed = random_mix(def->seed + index)};
    dem_error why;
    if (dem_fill_drawer_create(&fill, w->population->placing.shapes, w->shape_count, &inlet->drawer, &why) != DEM_OK) {
        const char *text = strncmp(why.text, "fill: ", 6) == 0 ? why.text + 6 : why.text;
        return dem_fail(error, why.code == DEM_USAGE ? DEM_BAD_INPUT : why.code, "inlet \"%.60s\": %s", inlet->name,
                        text);
    }
    inlet->def.seed = fill.seed;
    set_sizes(w, inlet);
    inlet->next = dem_fill_drawer_next(inlet->drawer);
    return check_place(w, inlet, error);
}

dem_status dem_population_create(dem_world *w, const dem_scene *scene, dem_error *error)
{
    if (!scene->inlet_count && w->domain.leaving != DEM_LEAVING_DELETE)
        return DEM_OK;
    dem_population *p = w->population = dem_alloc_zero(1, sizeof *p);
    if (!p)
        return dem_fail_memory(error);
    p->inlets = dem_alloc_zero(scene->inlet_count, sizeof *p->inlets);
    p->views = dem_alloc_zero(scene->inlet_count, sizeof *p->views);
    if (!p->inlets || !p->views || !dem_placing_create(w, &p->placing))
        return dem_fail_memory(error);
    p->placing.smooth = true;
    p->flat = scene->dimension == 2;
    for (size_t i = 0; p->flat && i < w->shape_count; i++)
        p->placing.shapes[i].flat = true;
    for (size_t i = 0; i < scene->inlet_count; i++) {
        p->inlet_count++;
        DEM_TRY(make_inlet(w, scene, i, error));
    }
    return DEM_OK;
}

void dem_population_release(dem_population *p)
{
    for (size_t i = 0; p && i < p->inlet_count; i++) {
        dem_fill_drawer_destroy(p->inlets[i].drawer);
        free(p->inlets[i].name);
    }
    if (p) {
        dem_placing_release(&p->placing);
        free(p->inlets);
        free(p->views);
    }
    free(p);
}

// ---- how many and how large

// bodies that inlets give by the end of the scene; INFINITY: not known
static double to_come(const dem_world *w)
{
    double sum = 0;
    for (size_t i = 0; i < w->population->inlet_count; i++) {
        const dem_inlet *inlet = &w->population->inlets[i];
        const dem_inlet_def *d = &inlet->def;
        double end = isnan(w->time_def.end) ? INFINITY : w->time_def.end, most = d->count ? (double)d->count : INFINITY;
        double time = larger(smaller(d->stop, end) - d->start, 0);
        sum += smaller(most, d->rate / (d->by_mass ? dem_inlet_amount(w, inlet) : 1) * time);
    }
    return sum;
}

size_t dem_population_rows(const dem_world *w, size_t bodies)
{
    if (!w->population || !w->population->inlet_count)
        return bodies;
    return bodies + (size_t)ceil(larger(1, smaller(to_come(w), ROWS_AT_FIRST)));
}

bool dem_population_reaches(const dem_world *w, size_t bodies)
{
    return w->population && (double)w->bodies.living + to_come(w) >= (double)bodies;
}

double dem_population_radius(const dem_population *p)
{
    double radius = 0;
    for (size_t i = 0; i < p->inlet_count; i++)
        radius = larger(radius, p->inlets[i].radius);
    return radius;
}

double dem_population_largest(const dem_population *p)
{
    double largest = 0;
    for (size_t i = 0; i < p->inlet_count; i++)
        largest = larger(largest, p->inlets[i].largest);
    return largest;
}

void dem_population_spheres(const dem_world *w, double *least, double *most)
{
    for (size_t i = 0; i < w->population->inlet_count; i++) {
        dem_fill_draw small, large;
        const dem_fill_drawer *drawer = w->population->inlets[i].drawer;
        for (size_t k = 0; dem_fill_drawer_quantile(drawer, k, 0, &small); k++) {
            dem_fill_drawer_quantile(drawer, k, 1, &large);
            *least = smaller(*least, w->templates.items[small.shape].radius_min * small.scale);
            *most = larger(*most, w->templates.items[large.shape].radius_max * large.scale);
        }
    }
}

// ---- coming

static uint32_t free_row(const dem_bodies *b)
{
    for (size_t row = 0; row < b->count; row++)
        if (b->id[row] == (uint32_t)DEM_ROW_FREE)
            return (uint32_t)row;
    return (uint32_t)DEM_ROW_FREE;
}

dem_status dem_population_add(dem_world *w, const dem_body_def *def, uint32_t *row, dem_error *error)
{
    dem_bodies *b = &w->bodies;
    dem_population *p = w->population;
    *row = free_row(b);
    if (*row == (uint32_t)DEM_ROW_FREE) {
        size_t more = b->count / 2 > ROWS_MORE ? b->count / 2 : ROWS_MORE;
        DEM_TRY(dem_world_grow(w, (b->count + more + DEM_SEGMENT - 1) / DEM_SEGMENT * DEM_SEGMENT, error));
        *row = free_row(b);
    }
    dem_body_put(w, *row, def);
    DEM_TRY(dem_soft_join(w, *row, error));
    b->id[*row] = (uint32_t)p->next_id++;
    if (w->bonds)
        dem_bonds_join(w, *row);
    w->views.by_row[*row] = (uint32_t)b->living;
    b->place[b->living++] = *row;
    p->search = true;
    return DEM_OK;
}

void dem_population_count_energy(dem_world *w, uint32_t row, double sign)
{
    if (w->ledger)
        w->population->brought += sign * dem_measure_body(w, w->views.by_row[row]);
}

dem_status dem_population_feed(dem_world *w, dem_error *error)
{
    dem_population *p = w->population;
    for (size_t i = 0; i < p->inlet_count; i++)
        DEM_TRY(dem_inlet_feed(w, &p->inlets[i], error));
    // somebody has to ask for the search
    if (p->search && !w->asked_count)
        w->asked[w->asked_count++] = w->bodies.place[w->bodies.living - 1];
    return DEM_OK;
}

// ---- going

// whether lists name contacts or bonds of the body
static bool is_listed(const dem_world *w, size_t row)
{
    const dem_pairs *pairs = &w->pairs;
    if (w->bonds && dem_bonds_hold(w->bonds, row))
        return true;
    for (size_t i = pairs->adjacency_first[row]; i < pairs->adjacency_first[row + 1]; i++)
        if (pairs->items[pairs->adjacency[i]].count)
            return true;
    for (int form = 0; form < DEM_WALL_FORMS; form++) {
        const dem_contacts *contacts = &w->wall_contacts[form];
        const dem_segment *s = contacts->segments ? &contacts->segments[row / DEM_SEGMENT] : NULL;
        for (size_t at = s ? s->begin : 0; s && at < s->end; at++)
            if (contacts->columns.a[at] == row)
                return true;
    }
    return false;
}

static void remove_body(dem_world *w, size_t row)
{
    dem_population *p = w->population;
    if (w->bonds)
        dem_bonds_lose(w, row);
    p->left++;
    p->left_mass += body_mass(w, row);
    for (size_t i = 0; i < p->inlet_count; i++)
        if (p->inlets[i].inside == row)
            p->inlets[i].inside = (uint32_t)DEM_ROW_FREE;
    dem_body_clear(w, row);
    w->bodies.id[row] = (uint32_t)DEM_ROW_LEFT;
    if (w->bodies.wall_limit)
        w->bodies.wall_limit[row] = -1;  // its wall contacts are to be dropped
}

static void close_ranks(dem_world *w)
{
    dem_bodies *b = &w->bodies;
    size_t stay = 0;
    for (size_t i = 0; i < b->living; i++)
        if (!body_absent(b, b->place[i])) {
            w->views.by_row[b->place[i]] = (uint32_t)stay;
            b->place[stay++] = b->place[i];
        }
    b->living = stay;
}

static void free_rows(dem_bodies *b)
{
    for (size_t row = 0; row < b->count; row++)
        if (b->id[row] == (uint32_t)DEM_ROW_LEFT)
            b->id[row] = (uint32_t)DEM_ROW_FREE;
}

static void tell(dem_world *w)
{
    if (!w->population->told)
        dem_log(w->ctx, DEM_LOG_WARNING,
                "step %llu, t = %.6g s: bodies have left the domain and are deleted (\"leaving\": \"delete\"); how "
                "many is in the figures",
                (unsigned long long)w->steps, dem_world_time(w));
    w->population->told = true;
}

dem_status dem_population_leave(dem_world *w, dem_error *error)
{
    dem_bodies *b = &w->bodies;
    size_t count = 0;
    bool listed = false;
    free_rows(b);
    if (w->domain.leaving != DEM_LEAVING_DELETE || w->steps == 0)
        return DEM_OK;
    for (size_t row = 0; row < b->count; row++)
        if (!body_absent(b, row) && dem_lists_outside(w, row)) {
            count++;
            listed = listed || is_listed(w, row);
        }
    if (!count)
        return DEM_OK;
    double before = 0, after = 0;
    if (listed && w->ledger)
        DEM_TRY(dem_measure_total(w, &before, error));
    for (size_t row = 0; row < b->count; row++)
        if (!body_absent(b, row) && dem_lists_outside(w, row)) {
            if (!listed)
                dem_population_count_energy(w, (uint32_t)row, -1);
            remove_body(w, row);
        }
    if (w->bonds)
        dem_bonds_forget(w);
    close_ranks(w);
    tell(w);
    if (!listed)
        return DEM_OK;  // the next search is early enough
    DEM_TRY(dem_lists_renew(w, error));
    free_rows(b);
    if (w->ledger)
        DEM_TRY(dem_measure_total(w, &after, error));
    w->population->brought += after - before;
    return DEM_OK;
}

// ---- what is told

const dem_inlet_view *dem_world_inlets(const dem_world *w, size_t *count)
{
    const dem_population *p = w->population;
    *count = p ? p->inlet_count : 0;
    for (size_t i = 0; i < *count; i++) {
        const dem_inlet *inlet = &p->inlets[i];
        double asked = dem_inlet_asked(inlet, dem_world_time(w)), behind = asked - dem_inlet_given(inlet);
        // the body that is to come is not late before there is all of it
        p->views[i] = (dem_inlet_view){.name = inlet->name,
                                       .bodies = inlet->made,
                                       .mass = inlet->mass,
                                       .asked = asked,
                                       .behind = behind < dem_inlet_amount(w, inlet) ? 0 : behind,
                                       .by_mass = inlet->def.by_mass,
                                       .over = dem_inlet_over(w, inlet)};
    }
    return p ? p->views : NULL;
}
