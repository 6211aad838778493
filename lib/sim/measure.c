#include "sim/measure.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/bodies.h"
#include "sim/bonds.h"
#include "sim/fluid.h"
#include "sim/motion.h"
#include "sim/population.h"
#include "sim/servo.h"

static void release_columns(dem_views *v)
{
    void *all[] = {v->shape,    v->coordination, v->id,    v->scale,  v->mass,       v->position,
                   v->velocity, v->spin,         v->force, v->moment, v->orientation};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    v->shape = v->coordination = v->id = NULL;
    v->scale = v->mass = NULL;
    v->position = v->velocity = v->spin = v->force = v->moment = NULL;
    v->orientation = NULL;
}

// arrays of the bodies, for as many as there are rows; not before something is measured
static bool make_columns(dem_views *v, size_t n)
{
    v->shape = dem_alloc(n, sizeof *v->shape);
    v->coordination = dem_alloc(n, sizeof *v->coordination);
    v->id = dem_alloc(n, sizeof *v->id);
    v->scale = dem_alloc(n, sizeof *v->scale);
    v->mass = dem_alloc(n, sizeof *v->mass);
    v->position = dem_alloc(n, sizeof *v->position);
    v->velocity = dem_alloc(n, sizeof *v->velocity);
    v->spin = dem_alloc(n, sizeof *v->spin);
    v->force = dem_alloc(n, sizeof *v->force);
    v->moment = dem_alloc(n, sizeof *v->moment);
    v->orientation = dem_alloc(n, sizeof *v->orientation);
    bool good = v->shape && v->coordination && v->id && v->scale && v->mass && v->position && v->velocity && v->spin &&
                v->force && v->moment && v->orientation;
    if (!good)
        release_columns(v);
    return good;
}

void dem_views_number(dem_world *w)
{
    for (size_t row = 0; row < w->bodies.count; row++)
        w->views.by_row[row] = UINT32_MAX;
    for (size_t i = 0; i < w->bodies.living; i++)
        w->views.by_row[w->bodies.place[i]] = (uint32_t)i;
}

dem_status dem_views_create(dem_world *w, dem_error *error)
{
    dem_views *v = &w->views;
    v->walls = dem_alloc_zero(w->walls.count, sizeof *v->walls);
    v->by_row = dem_alloc(w->bodies.count, sizeof *v->by_row);
    if (!v->by_row || !v->walls)
        return dem_fail_memory(error);
    dem_views_number(w);
    return DEM_OK;
}

bool dem_views_grow(dem_world *w)
{
    dem_views *v = &w->views;
    free(v->by_row);
    v->by_row = dem_alloc(w->bodies.count, sizeof *v->by_row);
    bool measured = v->shape;
    release_columns(v);
    if (!v->by_row || (measured && !make_columns(v, w->bodies.count)))
        return false;
    dem_views_number(w);
    return true;
}

void dem_views_release(dem_views *v)
{
    release_columns(v);
    free(v->by_row);
    free(v->contacts);
    free(v->walls);
    free(v->records);
}

// ---- evaluating

// the records of one segment, in the order of its columns
static bool evaluate(dem_world *w, const dem_contacts *contacts, size_t segment, int form)
{
    const dem_segment *s = &contacts->segments[segment];
    size_t instances;
    const dem_contact_instance *any = world_instances(w, &instances) + (instances - 1);
    dem_rows rows = world_rows(w);
    dem_tally scratch = {0};
    while (w->views.record_capacity < s->end - s->begin)
        if (!dem_grow(&w->views.records, &w->views.record_capacity, w->views.record_capacity, sizeof *w->views.records))
            return false;
    dem_contact_job job = {.columns = contacts->columns,
                           .begin = s->begin,
                           .end = s->end,
                           .last_step = w->last_step,
                           .next_step = w->next_step,
                           .tally = &scratch,
                           .records = w->views.records};
    if (w->features.soft)
        dem_soft_records(w, segment, form, w->views.records);
    else
        (form < 0 ? any->pairs : any->walls[form])(w->features, &rows, &job);
    return true;
}

double dem_contact_elastic(dem_world *w, uint32_t a, uint32_t b, uint32_t sphere_a, uint32_t sphere_b)
{
    const dem_segment *s = &w->contacts.segments[a / DEM_SEGMENT];
    const dem_contact_columns *c = &w->contacts.columns;
    double sum = 0;
    if (!evaluate(w, &w->contacts, a / DEM_SEGMENT, -1))
        return sum;
    for (size_t at = s->begin; at < s->end; at++) {
        const dem_contact_record *r = &w->views.records[at - s->begin];
        bool same = c->a[at] == a && c->b[at] == b && c->sphere_a[at] == sphere_a && c->sphere_b[at] == sphere_b;
        if (w->features.soft)
            same = c->a[at] == a && c->b[at] == b;
        if (same && r->touches)
            sum += r->elastic_normal + r->elastic_slide + r->elastic_turn;
    }
    return sum;
}

static dem_status visit_segments(dem_world *w, dem_contacts *contacts, int form, dem_contact_visit visit, void *user,
                                 dem_error *error)
{
    for (size_t i = 0; i < w->segment_count; i++) {
        const dem_segment *s = &contacts->segments[i];
        size_t size = s->end - s->begin;
        if (!evaluate(w, contacts, i, form))
            return dem_fail_memory(error);
        for (size_t k = 0; k < size; k++) {
            size_t at = segment_place(s, k);
            dem_contact_item item = dem_contact_get(&contacts->columns, at);
            if (item.a < w->bodies.count)
                visit(user, w, form, &item, &w->views.records[at - s->begin]);
        }
    }
    return DEM_OK;
}

dem_status dem_visit_contacts(dem_world *w, dem_contact_visit visit, void *user, dem_error *error)
{
    // finds the contacts of meshes as they stand; doing so again in the next step changes nothing
    DEM_TRY(dem_mesh_touch_measure_all(w, error));
    dem_weigh_contacts(w, 0, w->segment_count);
    DEM_TRY(visit_segments(w, &w->contacts, -1, visit, user, error));
    for (int form = 0; form < DEM_WALL_FORMS; form++)
        if (w->wall_contacts[form].segments)
            DEM_TRY(visit_segments(w, &w->wall_contacts[form], form, visit, user, error));
    return DEM_OK;
}

// ---- what is visited

typedef struct tour {
    uint32_t last_a, last_other;  // the pair whose contacts are passing
    bool counted;
} tour;

static void add_to_body(dem_views *v, uint32_t i, dem_vec3 force, dem_vec3 arm, dem_vec3 turning)
{
    v->force[i] = v3_add(v->force[i], force);
    v->moment[i] = v3_add(v->moment[i], v3_add(v3_cross(arm, force), turning));
}

static dem_vec3 from_array(const double a[3])
{
    return v3(a[0], a[1], a[2]);
}

// a pair counts once, however many of its spheres touch
static void count_coordination(tour *t, dem_views *v, uint32_t a, uint32_t other, uint32_t b)
{
    if (a != t->last_a || other != t->last_other)
        t->counted = false;
    t->last_a = a;
    t->last_other = other;
    if (t->counted)
        return;
    t->counted = true;
    v->coordination[a]++;
    if (b != UINT32_MAX)
        v->coordination[b]++;
}

static void note_wall(dem_world *w, uint32_t wall, dem_vec3 force, dem_vec3 point, dem_vec3 turning)
{
    dem_wall_view *view = &w->views.walls[wall];
    const dem_wall *about = &w->walls.items[wall];
    view->force = v3_sub(view->force, force);
    view->moment = v3_sub(view->moment, v3_add(v3_cross(v3_sub(point, wall_reference(about)), force), turning));
    view->contacts++;
}

static void visit_contact(void *user, dem_world *w, int form, const dem_contact_item *item, const dem_contact_record *r)
{
    tour *t = user;
    dem_views *v = &w->views;
    v->since.friction += r->lost_friction;
    v->since.viscous += r->lost_viscous;
    v->since.broken += r->broken;
    v->since.work += w->last_step / 2 * r->wall_power;
    if (!r->touches)
        return;
    dem_figures *f = &v->figures;
    bool wall = form >= 0;
    uint32_t a = v->by_row[item->a], b = wall ? UINT32_MAX : v->by_row[item->b];
    dem_vec3 force = from_array(r->force), arm = from_array(r->point_a);
    dem_vec3 point = v3_add(body_position(&w->bodies, item->a), arm);
    double radius = w->templates.spheres[item->sphere_a][3] * body_scale(&w->bodies, item->a);
    dem_vec3 turning = from_array(r->turning);
    add_to_body(v, a, force, arm, turning);
    if (wall) {
        f->wall_contacts++;
        note_wall(w, item->sphere_b, force, point, turning);
    } else {
        f->contacts++;
        radius = fmin(radius, w->templates.spheres[item->sphere_b][3] * body_scale(&w->bodies, item->b));
        add_to_body(v, b, v3_scale(force, -1), from_array(r->point_b), v3_scale(turning, -1));
    }
    count_coordination(t, v, a, wall ? ~item->sphere_b : b, b);  // walls must not look like bodies
    f->overlap_ratio = fmax(f->overlap_ratio, r->overlap / radius);
    v->elastic += r->elastic_normal + r->elastic_slide + r->elastic_turn;
    if (wall && r->overlap / radius > v->passed) {
        v->passed = r->overlap / radius;
        v->passed_body = a;
        v->passed_wall = item->sphere_b;
    }
}

// ---- the contacts, for those who ask

static void list_contact(void *user, dem_world *w, int form, const dem_contact_item *item, const dem_contact_record *r)
{
    bool *failed = user, wall = form >= 0;
    dem_views *v = &w->views;
    if (!r->touches)
        return;
    if (!dem_grow(&v->contacts, &v->contact_capacity, v->contact_count, sizeof *v->contacts)) {
        *failed = true;
        return;
    }
    dem_vec3 force = from_array(r->force), n = from_array(r->normal);
    uint32_t first_a = w->templates.items[w->bodies.shape[item->a]].first;
    uint32_t first_b = wall ? item->sphere_b : w->templates.items[w->bodies.shape[item->b]].first;
    v->contacts[v->contact_count++] =
        (dem_contact){.body = v->by_row[item->a],
                      .other = wall ? UINT32_MAX : v->by_row[item->b],
                      .sphere = item->sphere_a - first_a,
                      .other_sphere = item->sphere_b - first_b,
                      .wall = wall ? item->sphere_b : UINT32_MAX,
                      .point = v3_add(body_position(&w->bodies, item->a), from_array(r->point_a)),
                      .normal = n,
                      .overlap = r->overlap,
                      .normal_force = r->normal_force,
                      .friction_force = v3_along(force, r->normal_force, n)};
}

// 120 B each, which most runs never ask for
static dem_status list_contacts(dem_world *w, dem_error *error)
{
    dem_views *v = &w->views;
    size_t count = v->figures.contacts + v->figures.wall_contacts;
    bool failed = false;
    v->contact_count = 0;
    if (count > v->contact_capacity) {
        free(v->contacts);
        v->contacts = dem_alloc(count, sizeof *v->contacts);
        v->contact_capacity = v->contacts ? count : 0;
    }
    DEM_TRY(dem_visit_contacts(w, list_contact, &failed, error));
    v->contacts_listed = !failed;
    return failed ? dem_fail_memory(error) : DEM_OK;
}

// ---- bodies

// force and moment of local and of global damping
typedef struct damping {
    dem_vec3 local[2], drag[2];
} damping;

// as the motion pass has them
static damping damping_of(const dem_world *w, size_t row, dem_vec3 weight, const dem_vec3 load[2])
{
    const double *motion = body_pose(&w->bodies, row) + 8, *p = w->bodies.momentum + DEM_ROW * row;
    dem_vec3 v[2] = {v3(motion[0], motion[1], motion[2]), v3(motion[3], motion[4], motion[5])};
    dem_vec3 momentum[2] = {v3(p[0], p[1], p[2]), v3(p[3], p[4], p[5])};
    damping d;
    for (int k = 0; k < 2; k++) {
        dem_vec3 f = k == 0 && w->damping.exclude_gravity ? v3_sub(load[k], weight) : load[k], against = v3(0, 0, 0);
        double speed = v3_norm(v[k]);
        if (w->damping.local_frame == DEM_LOCAL_VECTOR && speed > 0)
            against = v3_scale(v[k], -v3_norm(f) / speed);
        else if (w->damping.local_frame == DEM_LOCAL_SPACE)
            for (int c = 0; c < 3; c++) {
                double x = v3_get(v[k], c);
                v3_set(&against, c, x > 0 ? -fabs(v3_get(f, c)) : x < 0 ? fabs(v3_get(f, c)) : 0);
            }
        d.local[k] = v3_scale(against, w->damping.local);
        d.drag[k] = v3_scale(momentum[k], -w->damping.viscous);
    }
    return d;
}

// nothing slows what is held
static void spare_held(uint32_t hold, damping *d)
{
    if (hold & DEM_HOLD_VELOCITY)
        d->local[0] = d->drag[0] = v3(0, 0, 0);
    if (hold & DEM_HOLD_SPIN)
        d->local[1] = d->drag[1] = v3(0, 0, 0);
}

// what damping takes in the half step to the positions' time, which is in no tally yet
static void note_damping(dem_world *w, size_t i, const damping *d)
{
    dem_views *v = &w->views;
    const double *motion = body_pose(&w->bodies, w->bodies.place[i]) + 8;
    dem_vec3 path = v3_scale(v3_add(v3(motion[0], motion[1], motion[2]), v->velocity[i]), w->last_step / 4);
    dem_vec3 turn = v3_scale(v3_add(v3(motion[3], motion[4], motion[5]), v->spin[i]), w->last_step / 4);
    v->since.local -= v3_dot(d->local[0], path) + v3_dot(d->local[1], turn);
    v->since.drag -= v3_dot(d->drag[0], path) + v3_dot(d->drag[1], turn);
}

// ... and what bodies do whose motion is given: they count as walls, without energy of their own
static void note_holding(dem_world *w, size_t i)
{
    dem_views *v = &w->views;
    uint32_t hold = body_hold(&w->bodies, w->bodies.place[i]);
    double power = hold & DEM_HOLD_VELOCITY ? v3_dot(v->force[i], v->velocity[i]) : 0;
    power += hold & DEM_HOLD_SPIN ? v3_dot(v->moment[i], v->spin[i]) : 0;
    v->since.work -= w->last_step / 2 * power;
}

// the drag of a fluid at the time of the positions, and what it takes in the half step up to there
static dem_vec3 fluid_force(dem_world *w, size_t i, dem_vec3 load)
{
    size_t row = w->bodies.place[i];
    const double *motion = body_pose(&w->bodies, row) + 8, *inertia = w->bodies.inertia + DEM_ROW * row;
    double half = w->last_step / 2;
    dem_vec3 was = v3(motion[0], motion[1], motion[2]), ahead = dem_motion_velocity(w, row, load);
    dem_vec3 impulse = dem_fluid_impulse(w, row, ahead, half);
    dem_vec3 now = unlocked_velocity(v3_along(ahead, inertia[0], impulse), body_hold(&w->bodies, row));
    w->views.since.drag -= v3_dot(impulse, v3_add(was, now)) / 2;
    return v3_scale(impulse, 1 / half);
}

static dem_vec3 unwrapped(const dem_world *w, size_t row)
{
    dem_vec3 x = body_position(&w->bodies, row);
    for (int k = 0; w->periodic && k < 3; k++)
        if (w->domain.periodic[k])
            v3_set(&x, k,
                   v3_get(x, k) +
                       w->bodies.wraps[3 * row + (size_t)k] * (v3_get(w->domain.high, k) - v3_get(w->domain.low, k)));
    return x;
}

static dem_vec3 wrapped(const dem_world *w, dem_vec3 x)
{
    for (int k = 0; k < 3; k++)
        if (w->domain.periodic[k]) {
            double low = v3_get(w->domain.low, k), side = v3_get(w->domain.high, k) - low;
            v3_set(&x, k, v3_get(x, k) - floor((v3_get(x, k) - low) / side) * side);
        }
    return x;
}

// velocities at the time of the positions: half a step of the forces from the momenta
static void view_body(dem_world *w, size_t i)
{
    dem_views *v = &w->views;
    size_t row = w->bodies.place[i];
    const double *inertia = w->bodies.inertia + DEM_ROW * row;
    const dem_template *t = &w->templates.items[w->bodies.shape[row]];
    dem_vec3 weight = v3_scale(w->gravity, inertia[5]), load[2] = {v3_add(v->force[i], weight), v->moment[i]};
    bool damped = w->damping.local > 0 || w->damping.viscous > 0;
    damping d;
    uint32_t hold = body_hold(&w->bodies, row);
    if (w->bodies.fluid && w->last_step > 0 && !(hold & DEM_HOLD_VELOCITY))
        load[0] = v3_add(load[0], fluid_force(w, i, load[0]));
    if (damped) {
        d = damping_of(w, row, weight, load);
        spare_held(hold, &d);
        for (int k = 0; k < 2; k++)
            load[k] = v3_add(load[k], v3_add(d.local[k], d.drag[k]));
    }
    v->shape[i] = w->bodies.shape[row];
    v->id[i] = w->bodies.id ? w->bodies.id[row] : (uint32_t)i;
    v->scale[i] = body_scale(&w->bodies, row);
    v->mass[i] = body_mass(w, row);
    v->position[i] = wrapped(w, body_position(&w->bodies, row));
    v->orientation[i] = template_principal_orientation(t, body_orientation(&w->bodies, row));
    v->velocity[i] = dem_motion_velocity(w, row, load[0]);
    v->spin[i] = dem_motion_spin(w, row, load[1]);
    if (damped && w->ledger)
        note_damping(w, i, &d);
    dem_energy *e = &v->figures.energy;
    if (hold & (DEM_HOLD_VELOCITY | DEM_HOLD_SPIN))
        note_holding(w, i);
    if (!(hold & DEM_HOLD_VELOCITY))
        e->kinetic += v3_norm2(v->velocity[i]) * v->mass[i] / 2;
    if (!(hold & DEM_HOLD_SPIN))
        e->rotational += dem_body_turning_energy(&w->bodies, row, v->spin[i]);
    e->potential -= v3_dot(w->gravity, unwrapped(w, row)) * inertia[5];
}

// the farthest point of a body's spheres along `up`
static double height_of(const dem_world *w, size_t row, dem_vec3 up)
{
    const dem_template *t = &w->templates.items[w->bodies.shape[row]];
    double scale = body_scale(&w->bodies, row), top = -INFINITY;
    dem_vec3 own = quat_unrotate(body_orientation(&w->bodies, row), up);
    for (size_t i = t->first; i < t->first + t->count; i++) {
        const double *s = w->templates.spheres[i];
        top = fmax(top, v3_dot(own, v3(s[0], s[1], s[2])) + s[3]);
    }
    return v3_dot(up, body_position(&w->bodies, row)) + scale * top;
}

static void gather(dem_world *w)
{
    dem_views *v = &w->views;
    dem_figures *f = &v->figures;
    dem_vec3 up = v3_norm2(w->gravity) > 0 ? v3_scale(v3_unit(w->gravity), -1) : v3(0, 0, 1), moment = v3(0, 0, 0);
    double mass = 0, touches = 0;
    f->highest = -INFINITY;
    for (size_t i = 0; i < w->bodies.living; i++) {
        size_t row = w->bodies.place[i];
        view_body(w, i);
        mass += v->mass[i];
        moment = v3_along(moment, v->mass[i], v->position[i]);
        touches += v->coordination[i];
        f->spheres += w->templates.items[v->shape[i]].count;
        f->fastest = fmax(f->fastest, v3_norm(v->velocity[i]) + w->bodies.radius[row] * v3_norm(v->spin[i]));
        f->highest = fmax(f->highest, height_of(w, row, up));
    }
    f->bodies = w->bodies.living;
    f->centre = v3_scale(moment, mass > 0 ? 1 / mass : 0);
    f->coordination = w->bodies.living ? touches / (double)w->bodies.living : 0;
    if (w->population) {
        f->came = w->population->came;
        f->left = w->population->left;
        f->came_mass = w->population->came_mass;
        f->left_mass = w->population->left_mass;
        f->energy.brought = w->population->brought;
    }
}

double dem_measure_body(dem_world *w, size_t i)
{
    dem_views *v = &w->views;
    dem_energy *e = &v->figures.energy;
    *e = v->since = (dem_energy){0};
    v->force[i] = v->moment[i] = v3(0, 0, 0);
    view_body(w, i);
    return e->kinetic + e->rotational + e->potential + v->since.local + v->since.drag - v->since.work;
}

// ---- the ledger

static double lanes(const double lane[DEM_BLOCK_LANES])
{
    double sum = 0;
    for (int i = 0; i < DEM_BLOCK_LANES; i++)
        sum += lane[i];
    return sum;
}

dem_energy dem_ledger(const dem_world *w)
{
    dem_energy e = w->views.since;
    e.work += w->push_work;
    for (size_t i = 0; i < w->segment_count * (1 + DEM_WALL_FORMS); i++) {
        e.friction += lanes(w->tallies[i].friction);
        e.viscous += lanes(w->tallies[i].viscous);
        e.broken += lanes(w->tallies[i].broken);
        e.work += lanes(w->tallies[i].work);
    }
    for (size_t i = 0; i < w->segment_count; i++) {
        e.local += lanes(w->motion_tallies[i].local);
        e.drag += lanes(w->motion_tallies[i].drag);
        e.friction += lanes(w->motion_tallies[i].rolling);
        e.work += lanes(w->motion_tallies[i].work);
    }
    if (w->bonds)
        dem_bonds_ledger(w->bonds, &e.viscous, &e.broken);
    return e;
}

// dissipated, less what was done
static double gone_by(const dem_energy *spent)
{
    return spent->friction + spent->viscous + spent->broken + spent->local + spent->drag - spent->work;
}

static void balance(dem_world *w)
{
    dem_energy *e = &w->views.figures.energy, spent = dem_ledger(w);
    e->elastic = w->views.elastic;
    double now = e->kinetic + e->rotational + e->potential + e->elastic;
    double gone = gone_by(&spent) - e->brought;
    if (w->steps == 0) {
        // a spring that the first sight of a sliding contact puts in is no energy that was there
        w->energy_start = now + gone;
        w->potential_start = e->potential;
    }
    e->start = w->energy_start;
    e->friction = spent.friction;
    e->viscous = spent.viscous;
    e->broken = spent.broken;
    e->local = spent.local;
    e->drag = spent.drag;
    e->work = spent.work;
    double most = fmax(fmax(e->kinetic + e->rotational, e->elastic), fabs(e->potential - w->potential_start));
    most = fmax(most, fmax(fmax(fabs(e->work), fabs(e->brought)), e->friction + e->viscous + e->broken + e->local + e->drag));
    w->views.most_energy = fmax(w->views.most_energy, most);
    double off = now + gone - e->start;
    e->error = NAN;
    if (w->ledger || !(w->laws.damped || w->features.jkr || w->features.friction || features_turning(w->features)))
        e->error = w->views.most_energy > 0 ? off / w->views.most_energy : 0;
}

static double largest_soft_overlap(const dem_world *w)
{
    double largest = 0;
    for (size_t i = 0; i < w->segment_count * (1 + DEM_WALL_FORMS); i++)
        largest = fmax(largest, w->tallies[i].soft_overlap);
    return w->features.soft ? largest / w->soft.tau : 0;
}

static double largest_overlap(const dem_world *w)
{
    double largest = 0;
    for (size_t i = 0; i < w->segment_count * (1 + DEM_WALL_FORMS); i++)
        largest = fmax(largest, w->tallies[i].overlap_ratio);
    return largest;
}

// what walls have of themselves
static void note_walls(dem_world *w)
{
    for (size_t i = 0; i < w->walls.count; i++) {
        const dem_wall *wall = &w->walls.items[i];
        dem_wall_view *view = &w->views.walls[i];
        double area = wall->servo.on ? dem_servo_area(&w->walls, i) : 0;
        view->pressure = area > 0 ? -v3_dot(view->force, wall->servo.direction) / area : NAN;
        view->wear = wall->worn;
        view->wear_count = wall->worn_count;
        for (size_t k = 0; k < wall->worn_count; k++)
            view->worn += wall->worn[k];
    }
}

dem_status dem_world_measure(dem_world *w, dem_error *error)
{
    double begin = dem_clock();
    dem_views *v = &w->views;
    size_t n = w->bodies.count;
    if (!v->shape && !make_columns(v, n))
        return dem_fail_memory(error);
    v->figures = (dem_figures){.time = dem_world_time(w), .step = w->steps};
    v->elastic = 0;
    v->since = (dem_energy){0};
    v->contacts_listed = false;
    v->passed = 0;
    memset(v->force, 0, n * sizeof *v->force);
    memset(v->moment, 0, n * sizeof *v->moment);
    memset(v->coordination, 0, n * sizeof *v->coordination);
    for (size_t i = 0; i < w->walls.count; i++)
        v->walls[i] =
            (dem_wall_view){.position = w->walls.items[i].position, .orientation = w->walls.items[i].orientation};
    tour t = {UINT32_MAX, UINT32_MAX, false};
    DEM_TRY(dem_visit_contacts(w, visit_contact, &t, error));
    if (w->bonds)
        DEM_TRY(dem_bonds_measure(w, error));
    note_walls(w);
    gather(w);
    balance(w);
    if (w->regions) {
        DEM_TRY(list_contacts(w, error));
        dem_region_views views = {dem_world_bodies(w), v->contacts, v->contact_count, NULL, 0};
        if (w->bonds)
            views.bonds = dem_world_bonds(w, &views.bond_count);
        dem_regions_measure(w->regions, &views);
    }
    v->figures.largest_overlap_ratio = fmax(largest_overlap(w), v->figures.overlap_ratio);
    v->figures.largest_soft_overlap = largest_soft_overlap(w);
    w->clocks[DEM_PASS_MEASURE].seconds += dem_clock() - begin;
    return DEM_OK;
}

dem_status dem_measure_total(dem_world *w, double *total, dem_error *error)
{
    DEM_TRY(dem_world_measure(w, error));
    const dem_energy *e = &w->views.figures.energy;
    *total = e->kinetic + e->rotational + e->potential + e->elastic + gone_by(e);
    return DEM_OK;
}

const dem_figures *dem_world_figures(const dem_world *w)
{
    return &w->views.figures;
}

dem_body_view dem_world_bodies(const dem_world *w)
{
    const dem_views *v = &w->views;
    return (dem_body_view){w->bodies.living, v->shape, v->scale, v->mass,   v->position,     v->orientation,
                           v->velocity,      v->spin,  v->force, v->moment, v->coordination, v->id};
}

const dem_contact *dem_world_contacts(const dem_world *w, size_t *count)
{
    // a look, which changes nothing that a step could see
    bool there = w->views.contacts_listed || list_contacts((dem_world *)w, NULL) == DEM_OK;
    *count = there ? w->views.contact_count : 0;
    return there ? w->views.contacts : NULL;
}

const dem_wall_view *dem_world_walls(const dem_world *w, size_t *count)
{
    *count = w->walls.count;
    return w->views.walls;
}

const dem_measure_view *dem_world_measures(const dem_world *w, size_t *count)
{
    return dem_regions_views(w->regions, count);
}
