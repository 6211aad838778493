#include "sim/bonds.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/bodies.h"
#include "sim/broad.h"
#include "sim/measure.h"

// ---- one bond

static dem_vec3 from_array(const double a[3])
{
    return v3(a[0], a[1], a[2]);
}
static dem_quat quat_from(const double q[4])
{
    return (dem_quat){q[0], q[1], q[2], q[3]};
}

// of b's image, that bodies' own crossings of periodic sides have taken along
static dem_vec3 shift_of(const dem_world *w, const dem_bond *bond)
{
    dem_vec3 shift = v3(0, 0, 0);
    for (int k = 0; w->periodic && k < 3; k++)
        if (w->domain.periodic[k]) {
            const int32_t *wraps = w->bodies.wraps;
            int32_t n =
                bond->sides[k] + wraps[3 * (size_t)bond->b + (size_t)k] - wraps[3 * (size_t)bond->a + (size_t)k];
            v3_set(&shift, k, n * (v3_get(w->domain.high, k) - v3_get(w->domain.low, k)));
        }
    return shift;
}

// velocities are half a step old, as those of contacts
static void set_drag(const dem_world *w, const dem_bond *bond, const bond_strain *s, dem_bond_load *load)
{
    const double *a = body_pose(&w->bodies, bond->a) + 8, *b = body_pose(&w->bodies, bond->b) + 8;
    dem_vec3 spin_a = from_array(a + 3), spin_b = from_array(b + 3);
    dem_vec3 end_a = v3_add(from_array(a), v3_cross(spin_a, load->arm_a));
    dem_vec3 end_b = v3_add(from_array(b), v3_cross(spin_b, load->arm_b));
    dem_vec3 middle = v3_scale(v3_add(spin_a, spin_b), 0.5);
    load->rate = v3_sub(v3_sub(end_b, end_a), v3_cross(middle, load->way));
    load->turn_rate = v3_sub(spin_b, spin_a);
    const double *c = bond->damping;
    dem_vec3 force = bond_scaled(quat_unrotate(s->middle, load->rate), c[BOND_STRETCH], c[BOND_SHEAR]);
    dem_vec3 turning = bond_scaled(quat_unrotate(s->middle, load->turn_rate), c[BOND_TWIST], c[BOND_BEND]);
    load->drag_force = quat_rotate(s->middle, force);
    load->drag_turning = quat_rotate(s->middle, turning);
}

dem_bond_load dem_bond_now(const dem_world *w, const dem_bond *bond)
{
    const dem_bodies *bodies = &w->bodies;
    const dem_bond_def *def = &w->bonds->defs[bond->def];
    dem_quat qa = body_orientation(bodies, bond->a), qb = body_orientation(bodies, bond->b);
    dem_bond_load load = {.arm_a = quat_rotate(qa, from_array(bond->anchor_a)),
                          .arm_b = quat_rotate(qb, from_array(bond->anchor_b)),
                          .shift = shift_of(w, bond)};
    dem_vec3 centres = v3_sub(body_position(bodies, bond->b), body_position(bodies, bond->a));
    load.way = v3_add(v3_add(centres, load.shift), v3_sub(load.arm_b, load.arm_a));
    bond_strain s = bond_strain_of(quat_multiply(qa, quat_from(bond->frame_a)),
                                   quat_multiply(qb, quat_from(bond->frame_b)), load.way);
    dem_vec3 force = bond_force(&s, bond->stiffness), moment = bond_moment(&s, bond->stiffness);
    load.elastic = bond_energy(&s, force, moment);
    bond_stress(force, moment, bond->radius, def->moment_contribution, load.stress);
    load.breaks = load.stress[0] > def->tensile_strength ? DEM_BOND_BROKEN_TENSION
                  : load.stress[1] > def->shear_strength ? DEM_BOND_BROKEN_SHEAR
                                                         : DEM_BOND_INTACT;
    load.axis = quat_rotate(s.middle, v3(1, 0, 0));
    load.force = quat_rotate(s.middle, force);
    load.turning = quat_rotate(s.middle, bond_turning(&s, force, moment));
    if (def->damping > 0)
        set_drag(w, bond, &s, &load);
    return load;
}

// force on a, moments on a and on b about their centres
static void resolve(const dem_bond_load *load, dem_vec3 *force, dem_vec3 *on_a, dem_vec3 *on_b)
{
    *force = v3_add(load->force, load->drag_force);
    dem_vec3 turning = v3_add(load->turning, load->drag_turning);
    dem_vec3 half = v3_scale(v3_cross(load->way, *force), 0.5);
    *on_a = v3_add(v3_add(v3_cross(load->arm_a, *force), half), turning);
    *on_b = v3_sub(v3_sub(half, v3_cross(load->arm_b, *force)), turning);
}

static double drag_power(const double drag[6], const dem_bond_load *load)
{
    return v3_dot(from_array(drag), load->rate) + v3_dot(from_array(drag + 3), load->turn_rate);
}

// half way between the ends
static dem_vec3 middle_of(const dem_world *w, const dem_bond *bond, const dem_bond_load *load)
{
    return v3_along(v3_add(body_position(&w->bodies, bond->a), load->arm_a), 0.5, load->way);
}

// ---- the pass

static void put_impulse(double *to, double kick, dem_vec3 force, dem_vec3 on_a, dem_vec3 on_b)
{
    memcpy(to,
           (double[]){kick * force.x, kick * force.y, kick * force.z, kick * on_a.x, kick * on_a.y, kick * on_a.z,
                      kick * on_b.x, kick * on_b.y, kick * on_b.z},
           9 * sizeof *to);
}

static void end_bond(const dem_world *w, dem_bond *bond, const dem_bond_load *load, dem_bond_state state)
{
    dem_vec3 point = middle_of(w, bond, load);
    bond->state = state;
    bond->time = dem_world_time(w);
    bond->step = w->steps;
    memcpy(bond->point, (double[]){point.x, point.y, point.z}, sizeof bond->point);
    memcpy(bond->stress, load->stress, sizeof bond->stress);
    memset(bond->drag, 0, sizeof bond->drag);
}

// Half of the work of a kick is done by the velocity before it, half by the one after.
static void note_drag(dem_bond *bond, const dem_bond_load *load, double kick)
{
    dem_vec3 f = v3_scale(load->drag_force, kick), m = v3_scale(load->drag_turning, kick);
    memcpy(bond->drag, (double[]){f.x, f.y, f.z, m.x, m.y, m.z}, sizeof bond->drag);
    bond->viscous += drag_power(bond->drag, load) / 2;
}

void dem_bonds_compute(dem_world *w, size_t begin, size_t end, double kick, size_t part)
{
    dem_bonds *b = w->bonds;
    size_t last = end < w->bodies.count ? end : w->bodies.count;
    b->part_broke[part] = false;
    if (begin >= last)
        return;
    for (size_t i = b->first[begin]; i < b->first[last]; i++) {
        dem_bond *bond = &b->items[b->live[i]];
        dem_bond_load load = dem_bond_now(w, bond);
        bond->viscous += drag_power(bond->drag, &load) / 2;
        // one that breaks now has still borne in the half step that led here
        double acts = load.breaks ? smaller(w->last_step / 2, kick) : kick;
        dem_vec3 force, on_a, on_b;
        resolve(&load, &force, &on_a, &on_b);
        put_impulse(b->impulse + 9 * i, acts, force, on_a, on_b);
        if (b->defs[bond->def].damping > 0)
            note_drag(bond, &load, load.breaks ? 2 * acts : kick);
        if (load.breaks) {
            end_bond(w, bond, &load, load.breaks);
            bond->broken += load.elastic;
            b->part_broke[part] = true;
        }
    }
}

void dem_bonds_add(dem_world *w, size_t begin, size_t end)
{
    const dem_bonds *b = w->bonds;
    double h = w->next_step;
    bool watch = w->features.watch;
    for (size_t row = begin; row < end && row < w->bodies.count; row++) {
        double *p = w->bodies.momentum + DEM_ROW * row;
        for (size_t i = b->adjacency_first[row]; i < b->adjacency_first[row + 1]; i++) {
            bool second = b->adjacency[i] & 1;
            const double *from = b->impulse + 9 * (size_t)(b->adjacency[i] >> 1);
            for (int k = 0; k < 3; k++) {
                p[k] += second ? -from[k] : from[k];
                p[3 + k] += from[(second ? 6 : 3) + k];
            }
        }
        if (watch)
            p[6] += h * (h * b->strain[2 * row] + 2 * b->strain[2 * row + 1]);
    }
}

// ---- those that live

// what a bond takes of the room of one of its bodies for a stable step, at most
static void add_strain(dem_world *w, const dem_bond *bond, size_t row, uint32_t other)
{
    const double *inertia = w->bodies.inertia + DEM_ROW * row;
    double times = hold_whole(body_hold(&w->bodies, other)) ? 1 : 2;
    double brisk = larger(inertia[1], larger(inertia[2], inertia[3]));
    const double *of[2] = {bond->stiffness, bond->damping};
    for (int k = 0; k < 2; k++)
        w->bonds->strain[2 * row + (size_t)k] += times * (larger(of[k][BOND_STRETCH], of[k][BOND_SHEAR]) * inertia[6] +
                                                          larger(of[k][BOND_TWIST], of[k][BOND_BEND]) * brisk);
}

static bool reserve_lists(dem_world *w)
{
    dem_bonds *b = w->bonds;
    size_t n = w->bodies.count;
    void *old[] = {b->live, b->first, b->adjacency_first, b->adjacency, b->strain, b->impulse};
    for (size_t i = 0; i < sizeof old / sizeof *old; i++)
        free(old[i]);
    b->live = dem_alloc(b->count, sizeof *b->live);
    b->first = dem_alloc_zero(n + 2, sizeof *b->first);
    b->adjacency_first = dem_alloc_zero(n + 2, sizeof *b->adjacency_first);
    b->adjacency = dem_alloc(2 * b->count, sizeof *b->adjacency);
    b->strain = dem_alloc_zero(2 * n, sizeof *b->strain);
    b->impulse = dem_alloc_zero(9 * b->count, sizeof *b->impulse);
    return b->live && b->first && b->adjacency_first && b->adjacency && b->strain && b->impulse;
}

// `first` and `adjacency_first` stand one place ahead while they are filled
static void list_live(dem_world *w)
{
    dem_bonds *b = w->bonds;
    size_t n = w->bodies.count;
    b->live_count = 0;
    memset(b->first, 0, (n + 2) * sizeof *b->first);
    memset(b->adjacency_first, 0, (n + 2) * sizeof *b->adjacency_first);
    memset(b->strain, 0, 2 * n * sizeof *b->strain);
    for (size_t i = 0; i < b->count; i++) {
        const dem_bond *bond = &b->items[i];
        if (bond->state != DEM_BOND_INTACT)
            continue;
        b->live[b->live_count++] = (uint32_t)i;
        b->first[bond->a + 1]++;
        b->adjacency_first[bond->a + 2]++;
        b->adjacency_first[bond->b + 2]++;
        add_strain(w, bond, bond->a, bond->b);
        add_strain(w, bond, bond->b, bond->a);
    }
    for (size_t row = 0; row < n; row++) {
        b->first[row + 1] += b->first[row];
        b->adjacency_first[row + 2] += b->adjacency_first[row + 1];
    }
    for (size_t i = 0; i < b->live_count; i++) {
        const dem_bond *bond = &b->items[b->live[i]];
        b->adjacency[b->adjacency_first[bond->a + 1]++] = (uint32_t)(2 * i);
        b->adjacency[b->adjacency_first[bond->b + 1]++] = (uint32_t)(2 * i + 1);
    }
}

bool dem_bonds_list(dem_world *w)
{
    if (!reserve_lists(w))
        return false;
    list_live(w);
    return true;
}

// ---- contacts that a bond stands for

static int compare_spheres(const dem_bond *bond, uint32_t a, uint32_t b, uint32_t sphere_a, uint32_t sphere_b)
{
    const uint32_t have[4] = {bond->a, bond->b, bond->sphere_a, bond->sphere_b}, want[4] = {a, b, sphere_a, sphere_b};
    for (int k = 0; k < 4; k++)
        if (have[k] != want[k])
            return have[k] < want[k] ? -1 : 1;
    return 0;
}

static bool is_instead(const dem_world *w, const dem_pair *pair, const dem_bond *bond)
{
    dem_vec3 shift = w->periodic ? v3_sub(from_array(w->shifts + 4 * pair->image), shift_of(w, bond)) : v3(0, 0, 0);
    bool same = v3_norm2(shift) < w->skin * w->skin * 1e-6;
    return same && bond->state == DEM_BOND_INTACT && w->bonds->defs[bond->def].contact == DEM_BOND_INSTEAD;
}

static bool stands_for(const dem_world *w, const dem_pair *pair, uint32_t sphere_a, uint32_t sphere_b)
{
    const dem_bonds *b = w->bonds;
    size_t low = b->first[pair->a], high = b->first[pair->a + 1];
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (compare_spheres(&b->items[b->live[middle]], pair->a, pair->b, sphere_a, sphere_b) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < b->first[pair->a + 1]; low++) {
        const dem_bond *bond = &b->items[b->live[low]];
        if (compare_spheres(bond, pair->a, pair->b, sphere_a, sphere_b) != 0)
            return false;
        if (is_instead(w, pair, bond))
            return true;
    }
    return false;
}

// soft contacts are of whole bodies, so one bond stands for all
static bool stands_for_all(const dem_world *w, const dem_pair *pair)
{
    const dem_bonds *b = w->bonds;
    for (size_t i = b->first[pair->a]; i < b->first[pair->a + 1]; i++) {
        const dem_bond *bond = &b->items[b->live[i]];
        if (bond->a == pair->a && bond->b == pair->b && is_instead(w, pair, bond))
            return true;
    }
    return false;
}

size_t dem_bonds_mask(const dem_world *w, const dem_pair *pair, uint32_t *spheres, size_t count)
{
    uint32_t first_a = w->templates.items[w->bodies.shape[pair->a]].first;
    uint32_t first_b = w->templates.items[w->bodies.shape[pair->b]].first;
    if (w->bonds->first[pair->a] == w->bonds->first[pair->a + 1])
        return count;
    if (w->features.soft)
        return stands_for_all(w, pair) ? 0 : count;
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (!stands_for(w, pair, first_a + spheres[2 * i], first_b + spheres[2 * i + 1])) {
            spheres[2 * kept] = spheres[2 * i];
            spheres[2 * kept + 1] = spheres[2 * i + 1];
            kept++;
        }
    return kept;
}

static void ask_row(dem_world *w, uint32_t row)
{
    w->bodies.limit[row] = -1;
    for (size_t k = 0; k < w->asked_count; k++)
        if (w->asked[k] == row)
            return;
    w->asked[w->asked_count++] = row;
}

// the contacts of the bond's two bodies are looked at again
static void ask_for_contacts(dem_world *w, const dem_bond *bond)
{
    dem_pairs *pairs = &w->pairs;
    for (size_t i = pairs->first[bond->a]; i < pairs->first[bond->a + 1]; i++) {
        dem_pair *pair = &pairs->items[i];
        if (pair->b != bond->b)
            continue;
        pairs->adjacency_limit[pair->adjacent_a] = pairs->adjacency_limit[pair->adjacent_b] = -1;
        ask_row(w, bond->a);
        ask_row(w, bond->b);
    }
}

static bool add_freed(dem_bonds *b, size_t bond)
{
    if (!dem_grow(&b->freed, &b->freed_capacity, b->freed_count, sizeof *b->freed))
        return false;
    b->freed[b->freed_count++] = (uint32_t)bond;
    return true;
}

dem_status dem_bonds_settle(dem_world *w, dem_error *error)
{
    dem_bonds *b = w->bonds;
    bool some = false;
    for (int part = 0; part < w->threads; part++)
        some |= b->part_broke[part];
    b->freed_count = 0;
    if (!some)
        return DEM_OK;
    for (size_t i = 0; i < b->live_count; i++) {
        const dem_bond *bond = &b->items[b->live[i]];
        if (bond->state == DEM_BOND_INTACT || b->defs[bond->def].contact != DEM_BOND_INSTEAD)
            continue;
        ask_for_contacts(w, bond);
        if (!add_freed(b, b->live[i]))
            return dem_fail_memory(error);
    }
    list_live(w);
    return DEM_OK;
}

// a contact that was not there before comes with its overlap: that much less was let go
void dem_bonds_account(dem_world *w)
{
    dem_bonds *b = w->bonds;
    for (size_t i = 0; i < b->freed_count; i++) {
        dem_bond *bond = &b->items[b->freed[i]];
        bond->broken -= dem_contact_elastic(w, bond->a, bond->b, bond->sphere_a, bond->sphere_b);
    }
    b->freed_count = 0;
}

// ---- bodies that leave

bool dem_bonds_hold(const dem_bonds *b, size_t row)
{
    return b->adjacency_first[row + 1] > b->adjacency_first[row];
}

// what is stored in it goes with the body
void dem_bonds_lose(dem_world *w, size_t row)
{
    dem_bonds *b = w->bonds;
    for (size_t i = b->adjacency_first[row]; i < b->adjacency_first[row + 1]; i++) {
        dem_bond *bond = &b->items[b->live[b->adjacency[i] >> 1]];
        if (bond->state != DEM_BOND_INTACT)
            continue;
        dem_bond_load load = dem_bond_now(w, bond);
        bond->viscous += drag_power(bond->drag, &load) / 2;
        end_bond(w, bond, &load, DEM_BOND_LOST);
    }
}

void dem_bonds_forget(dem_world *w)
{
    dem_bonds *b = w->bonds;
    for (size_t i = 0; i < b->count; i++) {
        dem_bond *bond = &b->items[i];
        bond->gone |= body_absent(&w->bodies, bond->a) ? 1u : 0;
        bond->gone |= body_absent(&w->bodies, bond->b) ? 2u : 0;
    }
    list_live(w);
}

// ---- views

// its number in the shape, whose body may have left
static uint32_t sphere_within(const dem_world *w, uint32_t sphere)
{
    uint32_t first = 0;
    for (size_t i = 0; i < w->shape_count; i++)
        if (w->templates.items[i].first <= sphere && w->templates.items[i].first > first)
            first = w->templates.items[i].first;
    return sphere - first;
}

static void view_bond(dem_world *w, const dem_bond *bond, const dem_bond_load *load, dem_bond_view *view)
{
    const dem_bond_def *def = &w->bonds->defs[bond->def];
    bool broken = bond->state != DEM_BOND_INTACT;
    *view = (dem_bond_view){
        .def = bond->def,
        .body = bond->gone & 1 ? UINT32_MAX : w->views.by_row[bond->a],
        .other = bond->gone & 2 ? UINT32_MAX : w->views.by_row[bond->b],
        .id = bond->id[0],
        .other_id = bond->id[1],
        .sphere = sphere_within(w, bond->sphere_a),
        .other_sphere = sphere_within(w, bond->sphere_b),
        .state = (dem_bond_state)bond->state,
        .point = broken ? from_array(bond->point) : middle_of(w, bond, load),
        .axis = load->axis,
        .tensile_stress = broken ? bond->stress[0] : load->stress[0],
        .shear_stress = broken ? bond->stress[1] : load->stress[1],
        .radius = bond->radius,
        .broken = broken ? bond->time : NAN,
        .broken_step = bond->step,
    };
    view->stress_ratio = larger(view->tensile_stress / def->tensile_strength, view->shear_stress / def->shear_strength);
    if (broken)
        return;
    view->force = v3_add(load->force, load->drag_force);
    view->moment = v3_add(load->turning, load->drag_turning);
}

static void measure_live(dem_world *w, const dem_bond *bond, const dem_bond_load *load)
{
    dem_views *v = &w->views;
    v->since.viscous += drag_power(bond->drag, load) / 2;
    v->elastic += load->elastic;
    double power = v3_dot(load->drag_force, load->rate) + v3_dot(load->drag_turning, load->turn_rate);
    v->since.viscous += w->last_step / 2 * power;
    dem_vec3 force, on_a, on_b;
    resolve(load, &force, &on_a, &on_b);
    uint32_t a = v->by_row[bond->a], b = v->by_row[bond->b];
    v->force[a] = v3_add(v->force[a], force);
    v->force[b] = v3_sub(v->force[b], force);
    v->moment[a] = v3_add(v->moment[a], on_a);
    v->moment[b] = v3_add(v->moment[b], on_b);
}

dem_status dem_bonds_measure(dem_world *w, dem_error *error)
{
    dem_bonds *b = w->bonds;
    dem_figures *f = &w->views.figures;
    if (b->view_count != b->count) {
        free(b->views);
        b->views = dem_alloc(b->count, sizeof *b->views);
        b->view_count = 0;
        if (!b->views)
            return dem_fail_memory(error);
        b->view_count = b->count;
    }
    for (size_t i = 0; i < b->count; i++) {
        const dem_bond *bond = &b->items[i];
        dem_bond_load load = {0};
        if (bond->state == DEM_BOND_INTACT) {
            load = dem_bond_now(w, bond);
            measure_live(w, bond, &load);
        }
        view_bond(w, bond, &load, &b->views[i]);
        f->bonds += bond->state == DEM_BOND_INTACT;
        f->bonds_tension += bond->state == DEM_BOND_BROKEN_TENSION;
        f->bonds_shear += bond->state == DEM_BOND_BROKEN_SHEAR;
        f->bonds_lost += bond->state == DEM_BOND_LOST;
    }
    return DEM_OK;
}

const dem_bond_view *dem_world_bonds(const dem_world *w, size_t *count)
{
    *count = w->bonds ? w->bonds->view_count : 0;
    return w->bonds ? w->bonds->views : NULL;
}

void dem_bonds_ledger(const dem_bonds *b, double *viscous, double *broken)
{
    for (size_t i = 0; i < b->count; i++) {
        *viscous += b->items[i].viscous;
        *broken += b->items[i].broken;
    }
}

double dem_bonds_bytes(const dem_bonds *b)
{
    return (double)b->count * (sizeof *b->items + 3 * sizeof(uint32_t)) +
           (double)b->live_count * 9 * sizeof *b->impulse;
}
