// The state as one block, from which a run goes on bit for bit. The order of sums depends on what is listed, so lists
// and their limits are part of the state. What follows from the scene is made anew.
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "base/text.h"
#include "sim/bodies.h"
#include "sim/bonds.h"
#include "sim/broad.h"
#include "sim/contacts.h"
#include "sim/measure.h"
#include "sim/population.h"

enum { LAYOUT = 5 };

static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    // FNV-1a over whole words: fast, and any altered bit shows
    const unsigned char *p = bytes;
    for (; size >= 8; size -= 8, p += 8) {
        uint64_t word;
        memcpy(&word, p, 8);
        hash = (hash ^ word) * 0x100000001b3;
        hash ^= hash >> 29;
    }
    for (; size; size--)
        hash = (hash ^ *p++) * 0x100000001b3;
    return hash;
}
#define HASH_START 0xcbf29ce484222325

/// What must be alike in the saved world and the one that takes it up, then what is taken.
typedef struct block_head {
    uint64_t layout, constants, bodies, shapes, walls, laws, segments;
    dem_features features;
    unsigned char unused[8 - sizeof(dem_features) % 8];
    uint64_t steps, epoch_steps, step_reviewed;
    double epoch_time, last_step, next_step, wall_path, sweep_speed, sweep_least, push_work;
    double energy_start, potential_start, most_energy, skin;
    uint64_t pairs, living;
} block_head;

static uint64_t hash_wall(uint64_t h, const dem_wall *wall)
{
    const dem_wall_motion *m = &wall->motion;
    const dem_servo_def *s = &wall->servo;
    dem_vec3 numbers[6] = {wall->point, wall->normal, m->velocity,
                           m->through,  m->spin,      {wall->radius, wall->form, wall->material}};
    h = hash_bytes(h, numbers, sizeof numbers);
    dem_vec3 more[7] = {m->axis,
                        {m->start, m->stop, m->table.cubic},
                        s->direction,
                        {s->on, s->stress, s->target},
                        {s->area, s->gain, s->max_velocity},
                        {s->mass, s->damping_rate, s->partner},
                        {s->extent[0].length, s->extent[1].length, 0}};
    h = hash_bytes(h, more, sizeof more);
    const dem_wear_def *wear = &wall->wear;
    double law[] = {wear->law,       wear->constant,    wear->pressure, wear->psi,
                    wear->roughness, wear->coefficient, wear->hardness, (double)wall->worn_count};
    h = hash_bytes(h, law, sizeof law);
    const dem_surface *f = &wall->surface;
    double form[] = {f->kind, f->begin,   f->run[0],  f->run[1],  f->endless,
                     f->side, f->half[0], f->half[1], f->along.x, f->along.y,
                     f->along.z};
    h = hash_bytes(h, form, sizeof form);
    h = hash_bytes(h, m->oscillations, m->oscillation_count * sizeof *m->oscillations);
    h = hash_bytes(h, m->table.time, m->table.count * sizeof *m->table.time);
    h = hash_bytes(h, m->table.shift, m->table.count * sizeof *m->table.shift);
    return m->table.turn ? hash_bytes(h, m->table.turn, m->table.count * sizeof *m->table.turn) : h;
}

// what the scene fixes: shapes, laws, walls, loads
static uint64_t hash_constants(const dem_world *w)
{
    uint64_t h = hash_bytes(HASH_START, w->templates.spheres, w->templates.sphere_count * sizeof *w->templates.spheres);
    for (size_t i = 0; i < w->templates.count; i++) {
        const dem_template *t = &w->templates.items[i];
        double numbers[5] = {t->mass, t->inertia[0], t->inertia[1], t->inertia[2], t->material};
        h = hash_bytes(h, numbers, sizeof numbers);
    }
    h = hash_bytes(h, w->laws.rows, w->laws.count * LAW_SLOTS * sizeof(double));
    if (w->laws.plugin.table) {
        const dem_law_spec *spec = w->laws.plugin.table->spec;
        h = hash_bytes(h, spec->name, strlen(spec->name));
        h = hash_bytes(h, &spec->version, sizeof spec->version);
        h = hash_bytes(h, w->laws.parameters, w->laws.count * DEM_LAW_PARAMETERS * sizeof(double));
    }
    h = hash_bytes(h, w->laws.table, w->laws.material_count * w->laws.material_count * sizeof *w->laws.table);
    for (size_t i = 0; i < w->walls.count; i++) {
        const dem_wall *wall = &w->walls.items[i];
        h = hash_wall(h, wall);
        if (wall->mesh)
            h = hash_bytes(h, wall->mesh->mesh.vertices, wall->mesh->mesh.vertex_count * sizeof(dem_vec3));
    }
    dem_vec3 loads[4] = {
        w->gravity,
        w->domain.low,
        w->domain.high,
        {w->damping.local, w->damping.viscous, w->damping.local_frame + 2 * w->damping.exclude_gravity}};
    h = hash_bytes(h, loads, sizeof loads);
    const dem_drag_def *drag = &w->damping.drag;
    double motion[] = {
        w->integrator.translation, w->integrator.rotation, w->held,          w->kept,          drag->density,
        drag->viscosity,           drag->velocity.x,       drag->velocity.y, drag->velocity.z, drag->buoyancy};
    h = hash_bytes(h, motion, sizeof motion);
    for (size_t i = 0; w->population && i < w->population->inlet_count; i++) {
        const dem_inlet_def *d = &w->population->inlets[i].def;
        double given[] = {d->kind,       d->low.x,      d->low.y,      d->low.z,           d->high.x, d->high.y,
                          d->high.z,     d->centre.x,   d->centre.y,   d->centre.z,        d->radius, d->rate,
                          d->by_mass,    d->velocity.x, d->velocity.y, d->velocity.z,      d->start,  d->stop,
                          d->spin.x,     d->spin.y,     d->spin.z,     d->velocity_spread, d->gap,    (double)d->count,
                          d->spin_spread};
        h = hash_bytes(h, given, sizeof given);
        h = hash_bytes(h, &d->seed, sizeof d->seed);
    }
    double numbers[] = {w->time_def.step,      w->multiple,           w->domain.periodic[0],
                        w->domain.periodic[1], w->domain.periodic[2], w->soft.tau,
                        w->domain.leaving == DEM_LEAVING_DELETE};
    h = hash_bytes(h, numbers, sizeof numbers);
    for (size_t i = 0; w->bonds && i < w->bonds->def_count; i++) {
        const dem_bond_def *d = &w->bonds->defs[i];
        double of[10] = {d->gap,         d->at,
                         d->radius_multiplier,
                         d->young,       d->shear_ratio,
                         d->tensile_strength,
                         d->shear_strength,
                         d->moment_contribution,
                         d->damping,     d->contact};
        h = hash_bytes(h, of, sizeof of);
    }
    return h;
}

static block_head head_of(const dem_world *w)
{
    block_head h;
    memset(&h, 0, sizeof h);
    h.layout = LAYOUT;
    h.constants = hash_constants(w);
    h.bodies = w->bodies.count;
    h.shapes = w->shape_count;
    h.walls = w->walls.count;
    h.laws = w->laws.count;
    h.segments = w->segment_count;
    h.features = w->features;
    h.steps = w->steps;
    h.epoch_steps = w->epoch_steps;
    h.step_reviewed = w->step_reviewed;
    h.epoch_time = w->epoch_time;
    h.last_step = w->last_step;
    h.next_step = w->next_step;
    h.wall_path = w->wall_path;
    h.sweep_speed = w->sweep_speed;
    h.sweep_least = w->sweep_least;
    h.push_work = w->push_work;
    h.energy_start = w->energy_start;
    h.potential_start = w->potential_start;
    h.most_energy = w->views.most_energy;
    h.skin = w->skin;
    h.pairs = w->pairs.count;
    h.living = w->bodies.living;
    return h;
}

static void take_head(dem_world *w, const block_head *h)
{
    w->steps = h->steps;
    w->epoch_steps = h->epoch_steps;
    w->step_reviewed = h->step_reviewed;
    w->epoch_time = h->epoch_time;
    w->last_step = h->last_step;
    w->next_step = h->next_step;
    w->wall_path = h->wall_path;
    w->sweep_speed = h->sweep_speed;
    w->sweep_least = h->sweep_least;
    w->push_work = h->push_work;
    w->energy_start = h->energy_start;
    w->potential_start = h->potential_start;
    w->views.most_energy = h->most_energy;
    w->skin = h->skin;
}

// ---- one walk over the state writes and reads it

typedef struct cursor {
    dem_buffer *out;  // writing
    const char *in;   // reading
    size_t left;
    bool failed;
} cursor;

static void pass(cursor *c, void *bytes, size_t size)
{
    if (c->out)
        dem_buffer_bytes(c->out, bytes, size);
    else if (c->failed || size > c->left)
        c->failed = true;
    else {
        if (size)
            memcpy(bytes, c->in, size);
        c->in += size;
        c->left -= size;
    }
}

static uint64_t pass_count(cursor *c, uint64_t count)
{
    pass(c, &count, sizeof count);
    return c->failed ? 0 : count;
}

// an array that is allocated anew when it is read
static void pass_array(cursor *c, void *array, size_t *count, size_t width)
{
    void *p = *(void **)array;
    uint64_t n = pass_count(c, *count);
    if (!c->out) {
        if (c->failed || n > c->left / (width ? width : 1)) {
            c->failed = true;
            return;
        }
        free(p);
        p = *(void **)array = dem_alloc(n, width);
        *count = n;
        if (!p) {
            c->failed = true;
            return;
        }
    }
    pass(c, p, n * width);
}

static void pass_bodies(cursor *c, dem_world *w)
{
    dem_bodies *b = &w->bodies;
#define COLUMN(type, name, width, unit, when, about)                                                                   \
    if (b->name)                                                                                                       \
        pass(c, b->name, b->padded *(width) * sizeof(type));
    DEM_BODY_COLUMNS(COLUMN)
#undef COLUMN
    pass(c, b->place, b->living * sizeof *b->place);
}

static void pass_pairs(cursor *c, dem_world *w)
{
    dem_pairs *p = &w->pairs;
    size_t n = w->bodies.count, ends = n + 1, adjacency = 2 * p->count, limits = adjacency, firsts = ends;
    pass_array(c, &p->items, &p->count, sizeof *p->items);
    if (!c->out)
        p->capacity = p->count;
    pass_array(c, &p->first, &firsts, sizeof *p->first);
    pass_array(c, &p->adjacency_first, &ends, sizeof *p->adjacency_first);
    pass_array(c, &p->adjacency, &adjacency, sizeof *p->adjacency);
    pass_array(c, &p->adjacency_limit, &limits, sizeof *p->adjacency_limit);
    if (!c->out && !c->failed) {
        free(p->fresh);
        p->fresh = dem_alloc_zero(p->count, sizeof *p->fresh);
        c->failed = !p->fresh || firsts != n + 1 || ends != n + 1 || adjacency != 2 * p->count || limits != adjacency;
    }
}

// the place of a segment and its contacts; room in between is not kept
static void pass_contacts(cursor *c, dem_world *w, dem_contacts *contacts, int form)
{
    size_t *needed = dem_alloc_zero(w->segment_count, sizeof *needed);
    if (!needed) {
        c->failed = true;
        return;
    }
    for (size_t i = 0; i < w->segment_count; i++) {
        dem_segment *s = &contacts->segments[i];
        needed[i] = pass_count(c, s->end - s->begin);
        if (!c->out) {
            c->failed |= needed[i] % DEM_BLOCK_LANES != 0 || needed[i] > c->left;
            s->dirty = true;
            s->end = s->begin;
        }
    }
    if (!c->out && !c->failed)
        c->failed = !dem_contacts_reserve(w, contacts, form, needed);
    for (size_t i = 0; i < w->segment_count && !c->failed; i++) {
        dem_segment *s = &contacts->segments[i];
        segment_set_end(s, needed[i], w->features.soft);
        if (!c->out)
            s->dirty = false;
#define COLUMN(type, name, unit, when, about)                                                                          \
    if (contacts->columns.name)                                                                                        \
        pass(c, (type *)contacts->columns.name + s->begin, (s->end - s->begin) * sizeof(type));
        DEM_CONTACT_COLUMNS(COLUMN)
#undef COLUMN
    }
    free(needed);
}

// what is idle in the lists of pairs, and where momenta of other domains go
static void pass_slots(cursor *c, dem_world *w)
{
    dem_contacts *contacts = &w->contacts;
    for (size_t i = 0; i < w->segment_count; i++) {
        dem_segment *s = &contacts->segments[i];
        s->slot_begin = pass_count(c, s->slot_begin);
        s->slot_count = pass_count(c, s->slot_count);
        s->slot_capacity = pass_count(c, s->slot_capacity);
        s->built = pass_count(c, s->built);
        pass(c, &s->idle, sizeof s->idle);
        pass(c, &s->spare, sizeof s->spare);
    }
    pass_array(c, &contacts->slot_body, &contacts->slot_capacity, sizeof *contacts->slot_body);
    if (!c->out && !c->failed)
        c->failed = !dem_bodies_reserve_slots(&w->bodies, contacts->slot_capacity);
}

static void pass_touches(cursor *c, dem_world *w)
{
    for (size_t i = 0; w->mesh_touches && i < w->segment_count; i++) {
        dem_mesh_touches *t = &w->mesh_touches[i];
        pass_array(c, &t->items, &t->count, sizeof *t->items);
        pass_array(c, &t->triangles, &t->triangle_count, sizeof *t->triangles);
        pass_array(c, &t->last, &t->last_capacity, sizeof *t->last);
        if (!c->out) {
            t->capacity = t->count;
            t->triangle_capacity = t->triangle_count;
            c->failed |= !dem_mesh_touches_forget(t);
        }
    }
}

static void pass_bonds(cursor *c, dem_world *w)
{
    dem_bonds *b = w->bonds;
    pass(c, b->made, b->def_count * sizeof *b->made);
    if (w->population)
        pass(c, b->member, b->def_count * w->bodies.count * sizeof *b->member);
    pass(c, &b->due, sizeof b->due);
    pass_array(c, &b->items, &b->count, sizeof *b->items);
    b->capacity = b->count;
}

static void pass_walls(cursor *c, dem_world *w)
{
    for (size_t i = 0; w->walls.servo && i < w->walls.count; i++) {
        pass(c, &w->walls.items[i].travel, sizeof(double));
        pass(c, &w->walls.items[i].speed, sizeof(double));
    }
    for (size_t i = 0; w->walls.wear && i < w->walls.count; i++)
        pass(c, w->walls.items[i].worn, w->walls.items[i].worn_count * sizeof(double));
}

// what inlets have done; the mix is drawn anew up to there
static void pass_population(cursor *c, dem_world *w)
{
    dem_population *p = w->population;
    pass(c, &p->next_id, sizeof p->next_id);
    pass(c, &p->came, sizeof p->came);
    pass(c, &p->left, sizeof p->left);
    pass(c, &p->came_mass, sizeof p->came_mass);
    pass(c, &p->left_mass, sizeof p->left_mass);
    pass(c, &p->brought, sizeof p->brought);
    for (size_t i = 0; i < p->inlet_count; i++) {
        dem_inlet *inlet = &p->inlets[i];
        uint64_t drawn = inlet->made;
        pass(c, &inlet->made, sizeof inlet->made);
        pass(c, &inlet->mass, sizeof inlet->mass);
        pass(c, &inlet->again, sizeof inlet->again);
        pass(c, &inlet->looks, sizeof inlet->looks);
        pass(c, &inlet->inside, sizeof inlet->inside);
        if (c->out)
            continue;
        c->failed |= inlet->made < drawn || inlet->made > p->next_id ||
                     (inlet->inside != (uint32_t)DEM_ROW_FREE && inlet->inside >= w->bodies.count);
        for (; !c->failed && drawn < inlet->made; drawn++)
            inlet->next = dem_fill_drawer_next(inlet->drawer);
    }
}

static void pass_state(cursor *c, dem_world *w)
{
    pass_walls(c, w);
    if (w->population)
        pass_population(c, w);
    pass_bodies(c, w);
    pass_pairs(c, w);
    pass_contacts(c, w, &w->contacts, -1);
    pass_slots(c, w);
    for (int form = 0; form < DEM_WALL_FORMS; form++)
        if (w->wall_contacts[form].segments)
            pass_contacts(c, w, &w->wall_contacts[form], form);
    pass_touches(c, w);
    pass(c, w->tallies, w->segment_count * (1 + DEM_WALL_FORMS) * sizeof *w->tallies);
    pass(c, w->motion_tallies, w->segment_count * sizeof *w->motion_tallies);
    if (w->bonds)
        pass_bonds(c, w);
}

dem_status dem_world_save(const dem_world *world, void **bytes, size_t *size, dem_error *error)
{
    dem_world *w = (dem_world *)world;  // the walk only reads when it writes
    dem_buffer out = {0};
    cursor c = {.out = &out};
    block_head head = head_of(w);
    pass(&c, &head, sizeof head);
    pass_state(&c, w);
    uint64_t hash = hash_bytes(HASH_START, out.data, out.size);
    dem_buffer_bytes(&out, &hash, sizeof hash);
    if (out.failed || c.failed) {
        dem_buffer_release(&out);
        return dem_fail_memory(error);
    }
    *bytes = out.data;
    *size = out.size;
    return DEM_OK;
}

static dem_status refuse(dem_error *error, const char *what)
{
    return dem_fail(error, DEM_BAD_INPUT, "the saved state %s", what);
}

// rows and places that the kernels will follow without asking
static bool sound(const dem_world *w)
{
    size_t n = w->bodies.count;
    for (size_t i = 0; i < w->bodies.living; i++)
        if (w->bodies.place[i] >= n || body_absent(&w->bodies, w->bodies.place[i]))
            return false;
    for (size_t i = 0; i < n; i++)
        if (w->bodies.shape[i] >= w->shape_count)
            return false;
    for (size_t i = 0; i < w->pairs.count; i++) {
        const dem_pair *p = &w->pairs.items[i];
        if (p->a >= n || p->b >= n || p->image >= DEM_IMAGES || p->adjacent_a >= 2 * w->pairs.count ||
            p->adjacent_b >= 2 * w->pairs.count)
            return false;
    }
    for (size_t i = 0; i < w->segment_count; i++) {
        const dem_segment *s = &w->contacts.segments[i];
        if (s->slot_begin > w->contacts.slot_capacity || s->slot_capacity > w->contacts.slot_capacity - s->slot_begin ||
            s->slot_count > s->slot_capacity)
            return false;
        for (size_t at = s->begin; at < s->end; at++)
            if (w->contacts.columns.target[at] >= w->bodies.padded + w->contacts.slot_capacity)
                return false;
    }
    for (size_t k = 0; k < w->contacts.slot_capacity; k++)
        if (w->contacts.slot_body[k] >= w->bodies.padded)
            return false;
    for (size_t i = 0; w->bonds && i < w->bonds->count; i++) {
        const dem_bond *bond = &w->bonds->items[i];
        if (bond->a >= n || bond->b >= n || bond->def >= w->bonds->def_count ||
            bond->sphere_a >= w->templates.sphere_count || bond->sphere_b >= w->templates.sphere_count)
            return false;
    }
    return true;
}

dem_status dem_world_restore(dem_world *w, const void *bytes, size_t size, dem_error *error)
{
    block_head head, own = head_of(w);
    uint64_t hash;
    if (size < sizeof head + sizeof hash)
        return refuse(error, "is cut short; take an older checkpoint");
    memcpy(&hash, (const char *)bytes + size - sizeof hash, sizeof hash);
    if (hash != hash_bytes(HASH_START, bytes, size - sizeof hash))
        return refuse(error, "is damaged; take an older checkpoint");
    memcpy(&head, bytes, sizeof head);
    if (head.layout != LAYOUT)
        return refuse(error, "is of another version; run it with the program that wrote it");
    // a world that bodies come to has grown since
    if (w->population && head.bodies > own.bodies && head.bodies < INT32_MAX &&
        head.segments == (head.bodies + DEM_SEGMENT - 1) / DEM_SEGMENT && head.bodies <= size) {
        DEM_TRY(dem_world_grow(w, head.bodies, error));
        own = head_of(w);
    }
    bool same = head.constants == own.constants && head.bodies == own.bodies && head.shapes == own.shapes &&
                head.walls == own.walls && head.laws == own.laws && head.segments == own.segments && head.living <= head.bodies &&
                (w->population || head.living == own.living) &&
                memcmp(&head.features, &own.features, sizeof own.features) == 0;
    if (!same)
        return refuse(error, "belongs to another scene; resume with the scene it was made from");
    cursor c = {.in = (const char *)bytes + sizeof head, .left = size - sizeof head - sizeof hash};
    take_head(w, &head);
    w->bodies.living = head.living;
    pass_state(&c, w);
    if (c.failed || c.left || !sound(w))
        return refuse(error, "does not fit the scene; resume with the scene it was made from");
    dem_views_number(w);
    DEM_TRY(dem_soft_join_all(w, error));
    if (w->bonds && !dem_bonds_list(w))
        return dem_fail_memory(error);
    dem_walls_place(&w->walls, dem_world_time(w));
    return w->features.soft ? dem_soft_reserve(w, error) : DEM_OK;
}

uint64_t dem_world_hash(const dem_world *w)
{
    const dem_bodies *b = &w->bodies;
    uint64_t hash = hash_bytes(HASH_START, &w->steps, sizeof w->steps);
    hash = hash_bytes(hash, b->bodies, b->count * DEM_BODY_ROW * sizeof *b->bodies);
    hash = hash_bytes(hash, b->momentum, b->count * DEM_ROW * sizeof *b->momentum);
    hash = hash_bytes(hash, b->path, b->count * sizeof *b->path);
    for (size_t i = 0; w->walls.servo && i < w->walls.count; i++)
        hash = hash_bytes(hash, (double[]){w->walls.items[i].travel, w->walls.items[i].speed}, 2 * sizeof(double));
    for (size_t i = 0; w->walls.wear && i < w->walls.count; i++)
        hash = hash_bytes(hash, w->walls.items[i].worn, w->walls.items[i].worn_count * sizeof(double));
    for (int form = -1; form < DEM_WALL_FORMS; form++) {
        const dem_contacts *contacts = form < 0 ? &w->contacts : &w->wall_contacts[form];
        for (size_t i = 0; contacts->segments && i < w->segment_count; i++) {
            const dem_segment *s = &contacts->segments[i];
            const dem_contact_columns *c = &contacts->columns;
            for (int k = 0; c->spring[0] && k < 3; k++)
                hash = hash_bytes(hash, c->spring[k] + s->begin, (s->end - s->begin) * sizeof(double));
            dem_contact_extras extras = dem_extras_of(c);
            for (int k = 0; k < extras.count; k++)
                hash = hash_bytes(hash, extras.column[k] + s->begin, (s->end - s->begin) * sizeof(double));
        }
    }
    for (size_t i = 0; w->bonds && i < w->bonds->count; i++) {
        const dem_bond *bond = &w->bonds->items[i];
        uint32_t who[4] = {bond->a, bond->b, bond->def, bond->state};
        hash = hash_bytes(hash, who, sizeof who);
        hash = hash_bytes(hash, bond->drag, sizeof bond->drag);
    }
    return hash;
}
