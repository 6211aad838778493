// Where bonds come from: the definitions of a scene, and the sphere pairs that are near when their time has come.
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/bodies.h"
#include "sim/bonds.h"
#include "sim/broad.h"
#include "sim/measure.h"
#include "sim/population.h"

static const double LEAST_LENGTH = 1e-3;    // of the smaller radius, between centres
static const double LARGEST = 1e100;        // stiffness [N/m], [N m/rad], and of dashpots
static const double OVERLAP_WARNED = 0.05;  // of the smaller radius

// ---- definitions

static const char *fault_of(const dem_bond_def *d)
{
    bool numbers = d->gap >= 0 && isfinite(d->gap) && d->at >= 0 && d->radius_multiplier > 0 &&
                   isfinite(d->radius_multiplier) && d->shear_ratio > 0 && isfinite(d->shear_ratio) &&
                   d->tensile_strength > 0 && d->shear_strength > 0 && d->moment_contribution >= 0 &&
                   d->moment_contribution <= 1 && d->damping >= 0 && isfinite(d->damping);
    if (!(d->young > 0 && isfinite(d->young)))
        return "needs \"young\"; give the Young's modulus of what it is made of";
    if (!numbers)
        return "has a number out of its range; see dem_bond_def";
    return NULL;
}

static bool copy_defs(dem_bonds *b, const dem_scene *scene)
{
    b->defs = dem_alloc_zero(scene->bond_count, sizeof *b->defs);
    b->made = dem_alloc_zero(scene->bond_count, sizeof *b->made);
    for (; b->defs && b->def_count < scene->bond_count; b->def_count++) {
        dem_bond_def *def = &b->defs[b->def_count];
        *def = scene->bonds[b->def_count];
        def->between[0] = def->between[1] = NULL;  // told by `member` from here on
        def->name = strdup(def->name ? def->name : "");
        if (!def->name)
            return false;
        b->instead |= def->contact == DEM_BOND_INSTEAD;
    }
    return b->defs && b->made;
}

static bool is_of(const dem_world *w, const char *name, const char *group, uint32_t shape)
{
    return !name || (group && strcmp(name, group) == 0) || strcmp(name, w->shape_names[shape]) == 0;
}

static void set_member(const dem_world *w, const dem_scene *scene, const char *group, uint32_t shape,
                       unsigned char *member)
{
    for (size_t d = 0; d < scene->bond_count; d++)
        for (unsigned k = 0; k < 2; k++)
            if (is_of(w, scene->bonds[d].between[k], group, shape))
                member[d] |= (unsigned char)(1u << k);
}

static bool set_members(dem_world *w, const dem_scene *scene, const dem_body_def *defs)
{
    dem_bonds *b = w->bonds;
    b->kin = dem_alloc_zero(b->def_count * w->shape_count, sizeof *b->kin);
    b->member = dem_alloc_zero(b->def_count * w->bodies.count, sizeof *b->member);
    if (!b->kin || !b->member)
        return false;
    for (uint32_t shape = 0; shape < w->shape_count; shape++)
        set_member(w, scene, NULL, shape, b->kin + shape * b->def_count);
    for (size_t i = 0; i < w->bodies.living; i++)
        set_member(w, scene, defs[i].group, defs[i].shape, b->member + w->bodies.place[i] * b->def_count);
    return true;
}

void dem_bonds_join(dem_world *w, size_t row)
{
    dem_bonds *b = w->bonds;
    memcpy(b->member + row * b->def_count, b->kin + w->bodies.shape[row] * b->def_count, b->def_count);
}

bool dem_bonds_grow(dem_world *w, size_t old)
{
    dem_bonds *b = w->bonds;
    size_t rows = w->bodies.count;
    unsigned char *member = realloc(b->member, rows * b->def_count);
    if (!member)
        return false;
    memset(member + old * b->def_count, 0, (rows - old) * b->def_count);
    b->member = member;
    return dem_bonds_list(w);
}

static void set_due(dem_bonds *b)
{
    b->due = INFINITY;
    for (size_t i = 0; i < b->def_count; i++)
        if (!b->made[i])
            b->due = smaller(b->due, b->defs[i].at);
}

dem_status dem_bonds_create(dem_world *w, const dem_scene *scene, const dem_body_def *defs, dem_error *error)
{
    if (!scene->bond_count)
        return DEM_OK;
    for (size_t i = 0; i < scene->bond_count; i++) {
        const char *fault = fault_of(&scene->bonds[i]);
        if (fault)
            return dem_fail(error, DEM_BAD_INPUT, "bonds \"%.60s\" %s",
                            scene->bonds[i].name ? scene->bonds[i].name : "", fault);
    }
    dem_bonds *b = w->bonds = dem_alloc_zero(1, sizeof *b);
    if (!b || !copy_defs(b, scene) || !set_members(w, scene, defs))
        return dem_fail_memory(error);
    b->part_broke = dem_alloc_zero((size_t)w->threads, sizeof *b->part_broke);
    set_due(b);
    double radius = w->population ? dem_population_largest(w->population) : 0;
    for (size_t row = 0; row < w->bodies.count; row++)
        radius = larger(radius, w->bodies.radius[row]);
    for (size_t i = 0; i < b->def_count; i++)
        if (b->defs[i].gap > radius)
            return dem_fail(error, DEM_BAD_INPUT,
                            "bonds \"%.60s\": the gap, %.3g m, is more than the radius of the largest body, %.3g m; "
                            "lower it",
                            b->defs[i].name, b->defs[i].gap, radius);
    return b->part_broke && dem_bonds_list(w) ? DEM_OK : dem_fail_memory(error);
}

void dem_bonds_release(dem_bonds *b)
{
    if (!b)
        return;
    for (size_t i = 0; i < b->def_count; i++)
        free((char *)b->defs[i].name);
    void *all[] = {b->defs,      b->made,   b->kin,     b->member,     b->items, b->live,  b->first, b->adjacency_first,
                   b->adjacency, b->strain, b->impulse, b->part_broke, b->freed, b->views, b};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
}

double dem_bonds_gap(const dem_world *w)
{
    double gap = 0;
    for (size_t i = 0; w->bonds && i < w->bonds->def_count; i++)
        gap = larger(gap, w->bonds->defs[i].gap);
    return gap;
}

// ---- one bond

static void put_vec(double to[3], dem_vec3 v)
{
    memcpy(to, (double[]){v.x, v.y, v.z}, 3 * sizeof *to);
}
static void put_quat(double to[4], dem_quat q)
{
    memcpy(to, (double[]){q.w, q.x, q.y, q.z}, 4 * sizeof *to);
}

// the masses that its four ways see; of two bodies that do not give way, none
static void put_damping(const dem_world *w, dem_bond *bond, double ratio)
{
    const double *a = w->bodies.inertia + DEM_ROW * (size_t)bond->a, *b = w->bodies.inertia + DEM_ROW * (size_t)bond->b;
    uint32_t hold_a = body_hold(&w->bodies, bond->a), hold_b = body_hold(&w->bodies, bond->b);
    double moves = hold_moves(hold_a) && hold_moves(hold_b) ? 0 : 1 / (a[0] + b[0]);
    double turns = hold_turns(hold_a) && hold_turns(hold_b) ? 0 : 3 / (a[1] + a[2] + a[3] + b[1] + b[2] + b[3]);
    for (int k = 0; k < BOND_WAYS; k++)
        bond->damping[k] = 2 * ratio * sqrt(bond->stiffness[k] * (k < BOND_TWIST ? moves : turns));
}

// a frame with x along the bond
static dem_quat frame_along(dem_vec3 axis)
{
    dem_vec3 across = v3_normal_to(axis);
    return dem_quat_from_axes(axis, across, v3_cross(axis, across));
}

typedef struct sphere_now {
    dem_vec3 centre;  // of b's image, from the origin of the domain
    double radius;
    uint32_t row, sphere;
} sphere_now;

static sphere_now sphere_of(const dem_world *w, uint32_t row, uint32_t sphere, dem_vec3 shift)
{
    const double *s = w->templates.spheres[sphere];
    double scale = body_scale(&w->bodies, row);
    dem_vec3 arm = quat_rotate(body_orientation(&w->bodies, row), v3_scale(v3(s[0], s[1], s[2]), scale));
    return (sphere_now){v3_add(v3_add(body_position(&w->bodies, row), shift), arm), s[3] * scale, row, sphere};
}

static uint32_t id_of(const dem_world *w, uint32_t row)
{
    return w->bodies.id ? w->bodies.id[row] : w->views.by_row[row];
}

static void put_bond(const dem_world *w, const dem_pair *pair, dem_vec3 shift, const sphere_now s[2], uint32_t which,
                     dem_bond *bond)
{
    const dem_bond_def *def = &w->bonds->defs[which];
    dem_vec3 way = v3_sub(s[1].centre, s[0].centre);
    double length = v3_norm(way), overlap = s[0].radius + s[1].radius - length;
    dem_vec3 axis = v3_scale(way, 1 / length), point = v3_along(s[0].centre, s[0].radius - overlap / 2, axis);
    dem_quat frame = frame_along(axis), qa = body_orientation(&w->bodies, pair->a),
             qb = body_orientation(&w->bodies, pair->b);
    *bond = (dem_bond){.a = pair->a,
                       .b = pair->b,
                       .sphere_a = s[0].sphere,
                       .sphere_b = s[1].sphere,
                       .def = which,
                       .id = {id_of(w, pair->a), id_of(w, pair->b)},
                       .apart = -overlap,
                       .radius = def->radius_multiplier * smaller(s[0].radius, s[1].radius)};
    int image[3];
    image_of(pair->image, image);
    for (int k = 0; w->periodic && k < 3; k++)
        bond->sides[k] = image[k] - w->bodies.wraps[3 * (size_t)pair->b + (size_t)k] +
                         w->bodies.wraps[3 * (size_t)pair->a + (size_t)k];
    put_vec(bond->anchor_a, quat_unrotate(qa, v3_sub(point, body_position(&w->bodies, pair->a))));
    put_vec(bond->anchor_b, quat_unrotate(qb, v3_sub(point, v3_add(body_position(&w->bodies, pair->b), shift))));
    put_quat(bond->frame_a, quat_multiply(quat_conjugate(qa), frame));
    put_quat(bond->frame_b, quat_multiply(quat_conjugate(qb), frame));
    double normal = def->young / length, shear = def->shear_ratio * normal;
    double area = bond_area(bond->radius), second = bond_second_moment(bond->radius);
    bond->stiffness[BOND_STRETCH] = normal * area;
    bond->stiffness[BOND_SHEAR] = shear * area;
    bond->stiffness[BOND_TWIST] = shear * 2 * second;
    bond->stiffness[BOND_BEND] = normal * second;
    put_damping(w, bond, def->damping);
}

// ---- all that are near

static int by_spheres(const void *p, const void *q)
{
    const dem_bond *x = p, *y = q;
    const int64_t a[8] = {x->a, x->b, x->sphere_a, x->sphere_b, x->sides[0], x->sides[1], x->sides[2], x->step};
    const int64_t b[8] = {y->a, y->b, y->sphere_a, y->sphere_b, y->sides[0], y->sides[1], y->sides[2], y->step};
    for (int k = 0; k < 8; k++)
        if (a[k] != b[k])
            return a[k] < b[k] ? -1 : 1;
    return (x->def > y->def) - (x->def < y->def);
}

// an intact one between the same spheres, among those that were there before
static bool is_bonded(const dem_bonds *b, size_t old, const dem_bond *bond)
{
    size_t low = 0, high = old;
    dem_bond want = *bond;
    want.step = want.def = 0;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (by_spheres(&b->items[middle], &want) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < old && b->items[low].a == bond->a && b->items[low].b == bond->b &&
           b->items[low].sphere_a == bond->sphere_a && b->items[low].sphere_b == bond->sphere_b;
         low++)
        if (memcmp(b->items[low].sides, bond->sides, sizeof bond->sides) == 0 && b->items[low].state == DEM_BOND_INTACT)
            return true;
    return false;
}

// the first definition that is due and fits; UINT32_MAX: none
static uint32_t fitting(const dem_world *w, const dem_pair *pair, double apart)
{
    const dem_bonds *b = w->bonds;
    const unsigned char *of_a = b->member + pair->a * b->def_count, *of_b = b->member + pair->b * b->def_count;
    for (size_t d = 0; d < b->def_count; d++) {
        unsigned a = of_a[d], other = of_b[d];
        bool both = ((a & 1) && (other & 2)) || ((a & 2) && (other & 1));
        if (both && !b->made[d] && b->defs[d].at <= dem_world_time(w) && apart <= b->defs[d].gap)
            return (uint32_t)d;
    }
    return UINT32_MAX;
}

static dem_status bond_spheres(dem_world *w, const dem_pair *pair, dem_vec3 shift, const sphere_now s[2], size_t old,
                               dem_error *error)
{
    dem_bonds *b = w->bonds;
    double length = v3_distance(s[0].centre, s[1].centre), apart = length - s[0].radius - s[1].radius;
    uint32_t which = fitting(w, pair, apart);
    if (which == UINT32_MAX)
        return DEM_OK;
    if (!(length > LEAST_LENGTH * smaller(s[0].radius, s[1].radius)))
        return dem_fail(error, DEM_BAD_INPUT,
                        "bonds \"%.60s\": spheres of bodies %u and %u have one centre, so that their bond has no "
                        "length; move them apart",
                        b->defs[which].name, (unsigned)w->views.by_row[pair->a], (unsigned)w->views.by_row[pair->b]);
    if (b->count >= UINT32_MAX / 2 || !dem_grow(&b->items, &b->capacity, b->count, sizeof *b->items))
        return dem_fail_memory(error);
    dem_bond *bond = &b->items[b->count];
    put_bond(w, pair, shift, s, which, bond);
    double most = 0;
    for (int k = 0; k < BOND_WAYS; k++)
        most = larger(most, larger(bond->stiffness[k], bond->damping[k]));
    if (!(most < LARGEST))
        return dem_fail(error, DEM_BAD_INPUT,
                        "bonds \"%.60s\" are too stiff to be computed; lower \"young\", \"radius_multiplier\" or "
                        "\"damping\"",
                        b->defs[which].name);
    // a contact that goes takes its energy along
    const dem_bond *before = b->count > old ? bond - 1 : NULL;
    bool told = w->features.soft && before && before->a == bond->a && before->b == bond->b;  // it is of the whole bodies
    if (w->steps && b->defs[which].contact == DEM_BOND_INSTEAD && !told)
        bond->broken = dem_contact_elastic(w, bond->a, bond->b, bond->sphere_a, bond->sphere_b);
    b->count += !is_bonded(b, old, &b->items[b->count]);
    return DEM_OK;
}

static dem_status bond_pair(dem_world *w, const dem_pair *pair, double gap, size_t old, dem_error *error)
{
    const dem_template *ta = &w->templates.items[w->bodies.shape[pair->a]];
    const dem_template *tb = &w->templates.items[w->bodies.shape[pair->b]];
    dem_vec3 shift = v3(0, 0, 0);
    if (w->periodic)
        shift = v3(w->shifts[4 * pair->image], w->shifts[4 * pair->image + 1], w->shifts[4 * pair->image + 2]);
    dem_vec3 other = v3_add(body_position(&w->bodies, pair->b), shift);
    for (uint32_t i = ta->first; i < ta->first + ta->count; i++) {
        sphere_now s[2] = {sphere_of(w, pair->a, i, v3(0, 0, 0))};
        if (v3_distance(s[0].centre, other) > s[0].radius + w->bodies.radius[pair->b] + gap)
            continue;
        for (uint32_t j = tb->first; j < tb->first + tb->count; j++) {
            s[1] = sphere_of(w, pair->b, j, shift);
            if (v3_distance(s[0].centre, s[1].centre) <= s[0].radius + s[1].radius + gap)
                DEM_TRY(bond_spheres(w, pair, shift, s, old, error));
        }
    }
    return DEM_OK;
}

// the contacts they stand for are not listed from now on
static void ask_for_masks(dem_world *w)
{
    dem_pairs *pairs = &w->pairs;
    for (size_t i = 0; i < pairs->count; i++) {
        const dem_pair *p = &pairs->items[i];
        pairs->adjacency_limit[p->adjacent_a] = pairs->adjacency_limit[p->adjacent_b] = -1;
    }
    w->asked_count = w->bodies.count;
    for (size_t row = 0; row < w->bodies.count; row++) {
        w->asked[row] = (uint32_t)row;
        w->bodies.limit[row] = -1;
    }
}

// Where such a bond breaks, the overlap of its spheres comes free at once.
static void warn_of_overlaps(const dem_world *w, size_t old)
{
    const dem_bonds *b = w->bonds;
    double worst = 0;
    size_t count = 0;
    uint32_t which = 0;
    for (size_t i = old; i < b->count; i++) {
        const dem_bond *bond = &b->items[i];
        const dem_bond_def *def = &b->defs[bond->def];
        bool breaks = isfinite(def->tensile_strength) || isfinite(def->shear_strength);
        double least = bond->radius / def->radius_multiplier, ratio = -bond->apart / least;
        if (!breaks || def->contact != DEM_BOND_INSTEAD || ratio < OVERLAP_WARNED)
            continue;
        count++;
        which = ratio > worst ? bond->def : which;
        worst = larger(worst, ratio);
    }
    if (count)
        dem_log(w->ctx, DEM_LOG_WARNING,
                "bonds \"%s\" stand for %zu contacts of spheres that overlap, by up to %.2g %% of the smaller radius; "
                "where they break, the spheres burst apart: let bodies start apart, or write \"contact\": \"parallel\"",
                b->defs[which].name, count, 100 * worst);
}

dem_status dem_bonds_make(dem_world *w, dem_error *error)
{
    dem_bonds *b = w->bonds;
    double gap = dem_bonds_gap(w);
    size_t old = b->count;
    for (size_t i = 0; i < w->pairs.count; i++)
        if (w->pairs.items[i].a != w->pairs.items[i].b)
            DEM_TRY(bond_pair(w, &w->pairs.items[i], gap, old, error));
    for (size_t d = 0; d < b->def_count; d++) {
        bool due = !b->made[d] && b->defs[d].at <= dem_world_time(w), some = false;
        for (size_t i = old; due && i < b->count; i++)
            some |= b->items[i].def == d;
        if (due && !some)
            dem_log(
                w->ctx, DEM_LOG_WARNING,
                "bonds \"%s\" join nothing: no two spheres of these bodies are nearer than %.3g m; raise \"gap\", or "
                "look at \"between\"",
                b->defs[d].name, b->defs[d].gap);
        b->made[d] |= due;
    }
    set_due(b);
    warn_of_overlaps(w, old);
    if (b->count)
        qsort(b->items, b->count, sizeof *b->items, by_spheres);
    if (!dem_bonds_list(w))
        return dem_fail_memory(error);
    if (b->instead)
        ask_for_masks(w);
    return DEM_OK;
}
