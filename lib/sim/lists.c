#include "sim/lists.h"

#include <stdatomic.h>
#include <stdlib.h>

#include "base/status.h"
#include "sim/broad.h"
#include "sim/contacts.h"
#include "sim/population.h"
#include "sim/refresh.h"
#include "sim/servo.h"
#include "sim/wall_lists.h"

enum { BODIES_TO_SHARE = 256 };  // that ask: worth more than one thread

static bool finite_body(const dem_bodies *b, size_t row)
{
    const double *p = body_pose(b, row);
    double sum = 0;
    for (int k = 0; k < DEM_BODY_ROW; k++)
        sum += fabs(p[k]);
    return isfinite(sum) && isfinite(b->path[row]);
}

static dem_status fail_body(const dem_world *w, size_t row, dem_error *error, const char *what)
{
    dem_vec3 x = body_position(&w->bodies, row);
    return dem_fail(error, DEM_FAILED, "step %llu, t = %.6g s: body %u (%s) at (%.4g, %.4g, %.4g) m %s",
                    (unsigned long long)w->steps, dem_world_time(w), (unsigned)w->views.by_row[row],
                    w->shape_names[w->bodies.shape[row]], x.x, x.y, x.z, what);
}

bool dem_lists_outside(const dem_world *w, size_t row)
{
    dem_vec3 x = body_position(&w->bodies, row);
    for (int k = 0; k < 3; k++)
        if (!w->domain.periodic[k] &&
            (v3_get(x, k) < v3_get(w->domain.low, k) || v3_get(x, k) > v3_get(w->domain.high, k)))
            return true;
    return false;
}

// what is wrong with a body; NULL: nothing
static const char *fault_of(const dem_world *w, size_t row)
{
    const dem_bodies *b = &w->bodies;
    if (body_absent(b, row))
        return NULL;
    if (!finite_body(b, row))
        return "is not finite; the run is unstable: take a smaller time step, or look at the contacts there";
    double size = larger(b->radius[row], w->skin);
    if (body_stride(b, row, w->next_step) > 2 * size)
        return "runs away: it moves by more than its own size in a step; take a smaller time step";
    if (w->domain.leaving == DEM_LEAVING_ERROR && dem_lists_outside(w, row))
        return "has left the domain; make the domain or the walls larger, or set "
               "\"leaving\" to \"ignore\" or \"delete\"";
    return NULL;
}

typedef struct checking {
    const dem_world *w;
    size_t parts;
    atomic_size_t first;  // among those that ask, with a fault
} checking;

static void check_part(void *user, int part)
{
    checking *c = user;
    size_t count = c->w->asked_count, k = count * (size_t)part / c->parts, end = count * ((size_t)part + 1) / c->parts;
    while (k < end && !fault_of(c->w, c->w->asked[k]))
        k++;
    size_t first = atomic_load(&c->first);
    while (k < end && k < first && !atomic_compare_exchange_weak(&c->first, &first, k))
        continue;
}

static dem_status check_bodies(dem_world *w, dem_error *error)
{
    checking c = {.w = w, .parts = w->asked_count > BODIES_TO_SHARE ? (size_t)w->threads : 1};
    atomic_init(&c.first, w->asked_count);
    dem_team_share(w->team, (int)c.parts, check_part, &c);
    size_t first = atomic_load(&c.first);
    if (first == w->asked_count)
        return DEM_OK;
    return fail_body(w, w->asked[first], error, fault_of(w, w->asked[first]));
}

// one sweep of the bodies' bounds, for the speed of sweeping walls about them
static void bound_walls(dem_world *w)
{
    dem_box box = box_empty();
    double radius = 0;
    for (size_t i = 0; i < w->bodies.count; i++) {
        if (body_absent(&w->bodies, i))
            continue;
        box = box_with(box, body_position(&w->bodies, i));
        radius = larger(radius, w->bodies.radius[i]);
    }
    dem_vec3 centre = v3_scale(v3_add(box.low, box.high), 0.5);
    w->sweep_least = dem_walls_speed(&w->walls, centre, box_diagonal(box) / 2 + radius + w->skin);
    w->sweep_speed = w->sweep_least + dem_servo_most(&w->walls);
}

static bool search_due(dem_world *w)
{
    bool never = !w->pairs.first;  // nobody asks in a world without bodies
    if (never || (w->population && w->population->search))
        return true;
    bool beyond = false;
    for (size_t k = 0; k < w->asked_count; k++) {
        size_t row = w->asked[k];
        if (!(w->bodies.path[row] <= w->bodies.search_limit[row])) {
            beyond = true;
            if (w->bodies.search_limit[row] == -INFINITY)
                return true;  // it has come, or was put elsewhere
        }
    }
    return beyond && !dem_broad_extend(w);
}

// also the rows that bodies have left, for what lists still have of them
static void ask_all(dem_world *w)
{
    w->asked_count = 0;
    for (size_t i = 0; i < w->bodies.count; i++)
        if (!w->bodies.id || w->bodies.id[i] != (uint32_t)DEM_ROW_FREE)
            w->asked[w->asked_count++] = (uint32_t)i;
}

static dem_status search(dem_world *w, dem_error *error)
{
    DEM_TRY(dem_broad_search(w, error));
    w->searches++;
    dem_contacts_tighten(w);
    if (w->walls.sweep)
        bound_walls(w);
    ask_all(w);
    if (w->population)
        w->population->search = false;
    return DEM_OK;
}

// the lists of the bodies that ask
static dem_status look(dem_world *w, dem_error *error)
{
    double t1 = dem_clock();
    if (w->walls.count)
        DEM_TRY(dem_wall_refresh(w, error));
    DEM_TRY(dem_refresh(w, error));
    double t2 = dem_clock();
    DEM_TRY(dem_contacts_rebuild(w, error));
    if (w->fresh_count > w->bodies.count)
        dem_refresh_forget(w);
    if (w->features.soft)
        DEM_TRY(dem_soft_reserve(w, error));
    double t3 = dem_clock();
    w->clocks[DEM_PASS_REFRESH].seconds += t2 - t1;
    w->clocks[DEM_PASS_LISTS].seconds += t3 - t2;
    return DEM_OK;
}

dem_status dem_lists_renew(dem_world *w, dem_error *error)
{
    double begin = dem_clock();
    DEM_TRY(search(w, error));
    w->clocks[DEM_PASS_SEARCH].seconds += dem_clock() - begin;
    return look(w, error);
}

dem_status dem_lists_update(dem_world *w, dem_error *error)
{
    double begin = dem_clock();
    DEM_TRY(check_bodies(w, error));
    bool searched = search_due(w);
    if (searched)
        DEM_TRY(search(w, error));
    w->clocks[DEM_PASS_SEARCH].seconds += dem_clock() - begin;
    DEM_TRY(look(w, error));
    return searched && w->population ? dem_population_leave(w, error) : DEM_OK;
}
