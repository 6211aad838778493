// One inlet: when bodies are due, where they have room, and how they become free.
#include <stdlib.h>

#include "base/random.h"
#include "base/status.h"
#include "sim/bodies.h"
#include "sim/fill_room.h"
#include "sim/fill_stages.h"
#include "sim/measure.h"
#include "sim/population.h"
#include "sim/schemes.h"
#include "sim/timestep.h"

enum {
    PLACES = 100,  // tried in a box at a time
    WAIT = 16,     // steps until room is looked for again
};
static const double ROUNDING = 1e-9;  // of a body: how much before its time it counts as due

// ---- how much

static double amount_of(const dem_world *w, const dem_fill_draw *draw)
{
    const dem_template *t = &w->templates.items[draw->shape];
    return t->mass * template_bulk(t, draw->scale);
}

double dem_inlet_amount(const dem_world *w, const dem_inlet *inlet)
{
    return inlet->def.by_mass ? amount_of(w, &inlet->next) : 1;
}

double dem_inlet_given(const dem_inlet *inlet)
{
    return inlet->def.by_mass ? inlet->mass : (double)inlet->made;
}

double dem_inlet_asked(const dem_inlet *inlet, double time)
{
    const dem_inlet_def *d = &inlet->def;
    double asked = d->rate * larger(smaller(time, d->stop) - d->start, 0);
    return d->count && !d->by_mass ? smaller(asked, (double)d->count) : asked;
}

bool dem_inlet_over(const dem_world *w, const dem_inlet *inlet)
{
    const dem_inlet_def *d = &inlet->def;
    // what was due at the end may still come in the step that passes it
    return (d->count && inlet->made >= d->count) || dem_world_time(w) - w->next_step * (1 + ROUNDING) > d->stop;
}

static bool is_due(const dem_world *w, const dem_inlet *inlet)
{
    double amount = dem_inlet_amount(w, inlet), asked = dem_inlet_asked(inlet, dem_world_time(w));
    double room = asked * 1e-12 + ROUNDING * amount;
    return dem_inlet_given(inlet) + amount <= asked + room && !dem_inlet_over(w, inlet);
}

// ---- the body

// all that is random of a body but its place, which does not depend on how long it had to wait
static dem_body_def draw_body(const dem_inlet *inlet, bool flat)
{
    const dem_inlet_def *d = &inlet->def;
    dem_random r = random_stream(d->seed, inlet->made);
    dem_body_def body = {.shape = inlet->next.shape, .scale = inlet->next.scale, .hold = inlet->hold};
    double angle = 2 * DEM_PI * random_uniform(&r);
    body.orientation = flat ? (dem_quat){cos(angle / 2), 0, 0, sin(angle / 2)} : fill_orientation(&r);
    body.velocity = d->velocity;
    body.spin = d->spin;
    for (int k = 0; k < 3; k++) {
        v3_set(&body.velocity, k, v3_get(d->velocity, k) + d->velocity_spread * random_normal(&r));
        v3_set(&body.spin, k, v3_get(d->spin, k) + d->spin_spread * random_normal(&r));
    }
    return body;
}

// back to the time of the momenta, so that the next kick brings the weight of its own half only
static void take_half_kick(dem_world *w, uint32_t row)
{
    double *p = w->bodies.momentum + DEM_ROW * (size_t)row, mass = w->bodies.inertia[DEM_ROW * (size_t)row + 5];
    double half = dem_translations[w->integrator.translation].half ? w->last_step / 2 : 0;
    for (int k = 0; k < 3; k++)
        p[k] -= half * mass * v3_get(w->gravity, k);
}

static dem_status let_in(dem_world *w, dem_inlet *inlet, dem_body_def *body, dem_error *error)
{
    uint32_t row;
    bool sphere = inlet->def.kind == DEM_INLET_SPHERE;
    if (sphere)
        body->hold |= DEM_HOLD_VELOCITY | DEM_HOLD_SPIN;
    DEM_TRY(dem_population_add(w, body, &row, error));
    double mass = amount_of(w, &inlet->next);
    inlet->made++;
    inlet->mass += mass;
    inlet->looks = 0;
    inlet->next = dem_fill_drawer_next(inlet->drawer);
    w->population->came++;
    w->population->came_mass += mass;
    if (sphere)
        inlet->inside = row;
    else
        take_half_kick(w, row);
    dem_population_count_energy(w, row, 1);
    dem_step_admit(w, row);
    return DEM_OK;
}

// ---- room

typedef struct room {
    dem_body_def *bodies;  // near the inlet
    size_t count, capacity;
    dem_ball *balls;
} room;

static bool add_near(room *r, const dem_body_def *body)
{
    if (!dem_grow(&r->bodies, &r->capacity, r->count, sizeof *r->bodies))
        return false;
    r->bodies[r->count++] = *body;
    return true;
}

// bodies that may reach into the box; `slack`: what those that come may reach out of it
static bool collect(const dem_world *w, dem_vec3 low, dem_vec3 high, double slack, room *r)
{
    const dem_bodies *b = &w->bodies;
    for (size_t row = 0; row < b->count; row++) {
        dem_vec3 x = body_position(b, row);
        double reach = b->radius[row] + slack;
        bool far = body_absent(b, row);
        for (int k = 0; k < 3; k++)
            far |= !w->domain.periodic[k] && (v3_get(x, k) + reach < v3_get(low, k) || v3_get(x, k) - reach > v3_get(high, k));
        if (far)
            continue;
        const dem_template *t = &w->templates.items[b->shape[row]];
        dem_body_def body = {.shape = b->shape[row], .scale = body_scale(b, row), .position = x};
        body.orientation = template_principal_orientation(t, body_orientation(b, row));
        if (!add_near(r, &body))
            return false;
    }
    return true;
}

static bool fits(dem_room *in, dem_room_trial *trial, dem_vec3 position)
{
    dem_room_sight sight = dem_room_look(in, trial, position, DEM_ROOM_NONE);
    return sight == DEM_ROOM_FREE || (sight == DEM_ROOM_NEAR && dem_room_fits(in, trial, position));
}

// a place for the body, turned as it is; false: none was found
static bool find_place(const dem_inlet *inlet, dem_room *in, dem_room_trial *trial, dem_body_def *body)
{
    dem_room_take(in, trial, body->shape, body->scale);
    dem_room_turn(in, trial, body->orientation);
    if (inlet->def.kind == DEM_INLET_SPHERE) {
        body->position = room_point(in, inlet->def.centre);
        return fits(in, trial, body->position);
    }
    dem_vec3 low, high;
    if (!dem_room_range(in, trial, &low, &high))
        return false;
    dem_random r = random_stream(random_mix(inlet->def.seed), inlet->made << 24 ^ inlet->looks);
    for (int i = 0; i < PLACES; i++) {
        body->position = room_point(in, fill_point(&r, low, high));
        if (fits(in, trial, body->position))
            return true;
    }
    return false;
}

static dem_status look_for_place(dem_world *w, dem_inlet *inlet, room *r, dem_body_def *body, bool *found,
                                 dem_error *error)
{
    const dem_inlet_def *d = &inlet->def;
    dem_placing *placing = &w->population->placing;
    dem_vec3 half = v3(d->radius, d->radius, d->radius);
    dem_fill_def box = {.gap = d->gap, .low = d->low, .high = d->high};
    if (d->kind == DEM_INLET_SPHERE) {
        box.low = v3_sub(d->centre, half);
        box.high = v3_add(d->centre, half);
    }
    double radius = w->templates.items[body->shape].radius_out * body->scale;
    dem_fill_obstacles there = {.bodies = r->bodies,
                                .body_count = r->count,
                                .domain = &w->domain,
                                .flat = w->population->flat,
                                .clearance = w->walls.count ? dem_placing_clearance : NULL,
                                .user = placing};
    dem_room in;
    dem_room_trial trial = {.balls = r->balls};
    DEM_TRY(dem_room_create(&in, &box, placing->shapes, w->shape_count, &there, &radius, 1, error));
    *found = find_place(inlet, &in, &trial, body);
    bool failed = in.failed || placing->failed;
    dem_room_release(&in);
    return failed ? dem_fail_memory(error) : DEM_OK;
}

static dem_status let_due_in(dem_world *w, dem_inlet *inlet, room *r, dem_error *error)
{
    dem_vec3 half = v3(inlet->def.radius, inlet->def.radius, inlet->def.radius);
    bool sphere = inlet->def.kind == DEM_INLET_SPHERE;
    dem_vec3 low = sphere ? v3_sub(inlet->def.centre, half) : inlet->def.low;
    dem_vec3 high = sphere ? v3_add(inlet->def.centre, half) : inlet->def.high;
    if (!r->balls || !collect(w, low, high, 2 * inlet->def.gap, r))
        return dem_fail_memory(error);
    while (is_due(w, inlet) && inlet->inside == (uint32_t)DEM_ROW_FREE) {
        dem_body_def body = draw_body(inlet, w->population->flat);
        bool found;
        DEM_TRY(look_for_place(w, inlet, r, &body, &found, error));
        inlet->looks++;
        if (!found) {
            inlet->again = w->steps + WAIT;
            return DEM_OK;
        }
        if (!add_near(r, &body))
            return dem_fail_memory(error);
        DEM_TRY(let_in(w, inlet, &body, error));
    }
    return DEM_OK;
}

// ---- out of the sphere

static bool is_out_of(const dem_world *w, uint32_t row, dem_vec3 centre, double radius)
{
    dem_vec3 d = v3_sub(body_position(&w->bodies, row), centre);
    for (int k = 0; k < 3; k++)
        if (w->domain.periodic[k]) {
            double side = v3_get(w->domain.high, k) - v3_get(w->domain.low, k);
            v3_set(&d, k, v3_get(d, k) - round(v3_get(d, k) / side) * side);
        }
    return v3_norm(d) >= radius + w->bodies.radius[row];
}

// of its own sphere, and of all others that are walls
static bool is_out(const dem_world *w, const dem_inlet *inlet)
{
    bool out = is_out_of(w, inlet->inside, inlet->def.centre, inlet->def.radius);
    for (size_t i = 0; out && i < w->walls.count; i++) {
        const dem_wall *wall = &w->walls.items[i];
        out = !wall->generator || is_out_of(w, inlet->inside, wall->surface.point, wall->surface.begin);
    }
    return out;
}

// while it was held it counted as a wall, without energy; what it has now comes in
static dem_status let_go(dem_world *w, dem_inlet *inlet, dem_error *error)
{
    const dem_bodies *b = &w->bodies;
    uint32_t row = inlet->inside;
    const dem_template *t = &w->templates.items[b->shape[row]];
    const double *kept = b->kept + 6 * (size_t)row;
    dem_body_def body = {.shape = b->shape[row],
                         .scale = body_scale(b, row),
                         .position = body_position(b, row),
                         .velocity = v3(kept[0], kept[1], kept[2]),
                         .spin = v3(kept[3], kept[4], kept[5]),
                         .hold = inlet->hold};
    body.orientation = template_principal_orientation(t, body_orientation(b, row));
    double before = 0, after = 0;
    if (w->ledger)
        DEM_TRY(dem_measure_total(w, &before, error));
    dem_body_put(w, row, &body);
    take_half_kick(w, row);
    if (w->ledger)
        DEM_TRY(dem_measure_total(w, &after, error));
    w->population->brought += after - before;
    w->population->search = true;
    inlet->inside = (uint32_t)DEM_ROW_FREE;
    return DEM_OK;
}

dem_status dem_inlet_feed(dem_world *w, dem_inlet *inlet, dem_error *error)
{
    if (inlet->inside != (uint32_t)DEM_ROW_FREE && is_out(w, inlet))
        DEM_TRY(let_go(w, inlet, error));
    if (inlet->inside != (uint32_t)DEM_ROW_FREE || w->steps < inlet->again || !is_due(w, inlet))
        return DEM_OK;
    size_t most = 1;
    for (size_t i = 0; i < w->templates.count; i++)
        most = w->templates.items[i].count > most ? w->templates.items[i].count : most;
    room r = {.balls = dem_alloc(most, sizeof *r.balls)};
    dem_status status = let_due_in(w, inlet, &r, error);
    free(r.bodies);
    free(r.balls);
    return status;
}
