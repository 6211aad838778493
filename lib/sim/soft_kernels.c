// Compiled once as it is (plain) and once per instruction set with DEM_KERNELS set to v3 or v4.
#include "base/level.h"
#include "sim/soft_law.h"
#include "sim/state.h"

// ---- rows of a segment's contacts

static void fill_rows(const dem_features f, dem_world *w, const dem_contacts *contacts, const dem_segment *s, int form,
                      double *largest, double *work)
{
    const dem_contact_columns *c = &contacts->columns;
    dem_rows rows = world_rows(w);
    contact_batch batch;
    for (size_t from = s->begin; from < s->end; from += BATCH) {
        size_t count = s->end - from < BATCH ? s->end - from : BATCH;
        for (size_t g = 0; g < count; g += DEM_WIDTH) {
            if (form < 0) {
                pair_first(f, &rows, c, from + g, g, &batch);
                pair_second(f, &rows, c, from + g, g, &batch);
                pair_geometry(f, &rows, c, from + g, g, &batch, largest);
            } else
                wall_geometry(f, &rows, c, (dem_wall_form)form, from + g, g, &batch, largest);
            wide row[8];
            double weight[DEM_WIDTH];
            for (size_t i = 0; i < DEM_WIDTH; i++) {
                size_t at = from + g + i;
                uint32_t a = c->a[at], b = form < 0 ? c->b[at] : 0;
                weight[i] = 0;
                if (a >= w->bodies.count)
                    continue;  // idle
                const dem_template *t = w->templates.items;
                weight[i] = w->soft.weights[w->soft.first[a] + c->sphere_a[at] - t[w->bodies.shape[a]].first];
                if (form < 0)
                    weight[i] *= w->soft.weights[w->soft.first[b] + c->sphere_b[at] - t[w->bodies.shape[b]].first];
            }
            row[ROW_OVERLAP] = wide_load(batch.at[AT_OVERLAP] + g);
            for (int k = 0; k < 3; k++) {
                row[ROW_NORMAL + k] = wide_load(batch.at[AT_NORMAL + k] + g);
                row[ROW_ARM + k] = wide_load(batch.at[AT_A + k] + g);
            }
            row[ROW_WEIGHT] = wide_load(weight);
            if (form == DEM_FORM_MESH) {
                // places that are not in use have no normal
                wide3 n = {row[ROW_NORMAL], row[ROW_NORMAL + 1], row[ROW_NORMAL + 2]};
                row[ROW_OVERLAP] =
                    wide_select(wide_less(wide_all(0.5), dot3(n, n)), row[ROW_OVERLAP], wide_all(DEM_SOFT_APART));
            }
            rows_store_next(work + DEM_ROW * (from + g - s->begin), DEM_ROW, row);
        }
    }
    memset(work + DEM_ROW * (s->end - s->begin), 0, DEM_ROW * sizeof *work);
    work[DEM_ROW * (s->end - s->begin) + ROW_OVERLAP] = DEM_SOFT_APART;
}

// ---- bodies

static soft_side side_of(const dem_world *w, size_t row)
{
    const double *motion = body_pose(&w->bodies, row) + 8, *inertia = w->bodies.inertia + DEM_ROW * row;
    dem_quat q = body_orientation(&w->bodies, row);
    dem_vec3 x = quat_rotate(q, v3(1, 0, 0)), y = quat_rotate(q, v3(0, 1, 0)), z = quat_rotate(q, v3(0, 0, 1));
    soft_side s = {.velocity = v3(motion[0], motion[1], motion[2]),
                   .spin = v3(motion[3], motion[4], motion[5]),
                   .inverse_mass = inertia[0],
                   .brisk = inertia[6],
                   .quick = larger(inertia[1], larger(inertia[2], inertia[3]))};
    const double *i = inertia + 1;
    s.inverse[0] = i[0] * x.x * x.x + i[1] * y.x * y.x + i[2] * z.x * z.x;
    s.inverse[1] = i[0] * x.y * x.y + i[1] * y.y * y.y + i[2] * z.y * z.y;
    s.inverse[2] = i[0] * x.z * x.z + i[1] * y.z * y.z + i[2] * z.z * z.z;
    s.inverse[3] = i[0] * x.x * x.y + i[1] * y.x * y.y + i[2] * z.x * z.y;
    s.inverse[4] = i[0] * x.x * x.z + i[1] * y.x * y.z + i[2] * z.x * z.z;
    s.inverse[5] = i[0] * x.y * x.z + i[1] * y.y * y.z + i[2] * z.y * z.z;
    return s;
}

// as a body that nothing moves, whose velocity is told where the centre of `row` is
static soft_side side_of_wall(const dem_world *w, size_t wall, size_t row)
{
    soft_side s = {0};
    if (!w->features.moving)
        return s;
    const double *v = w->walls.rows + DEM_WALL_ROW * wall + 8;
    s.spin = v3(v[3], v[4], v[5]);
    s.velocity = v3_add(v3(v[0], v[1], v[2]), v3_cross(s.spin, body_position(&w->bodies, row)));
    return s;
}

// ---- patches

// the contacts of one pair of bodies, or of a body and a wall: [start, end) of the segment's list
typedef struct patch_run {
    dem_contacts *contacts;
    const dem_segment *s;
    int form;
    size_t start, end;
    const double *work;
    const dem_soft_leaders *leaders;  // NULL: one patch for all
    int group;
} patch_run;

static dem_vec3 normal_of(const double *row)
{
    return v3(row[ROW_NORMAL], row[ROW_NORMAL + 1], row[ROW_NORMAL + 2]);
}

static bool belongs(const patch_run *run, size_t at)
{
    return !run->leaders || soft_group(run->leaders, normal_of(run->work + DEM_ROW * at)) == run->group;
}

// places of the contacts of a run, one after the other: see segment_place
typedef struct walker {
    size_t blocks, block, lane;
} walker;

static walker walk(const patch_run *run)
{
    size_t blocks = (run->s->end - run->s->begin) / DEM_BLOCK_LANES;
    return (walker){blocks, run->start % blocks, run->start / blocks};
}
static size_t step_on(walker *k)
{
    size_t at = k->block * DEM_BLOCK_LANES + k->lane;
    if (++k->block == k->blocks) {
        k->block = 0;
        k->lane++;
    }
    return at;
}

// the deepest pair of spheres, and the deepest of those that remember; -1: none
typedef struct patch_ends {
    double deepest;
    size_t place;
    double remembers;
    size_t memory;
    bool some;
} patch_ends;

static patch_ends look_over(const patch_run *run)
{
    const double *attached = run->contacts->columns.attached;
    patch_ends ends = {.deepest = DEM_SOFT_APART, .remembers = 2 * DEM_SOFT_APART};
    walker k = walk(run);
    for (size_t i = run->start; i < run->end; i++) {
        size_t at = step_on(&k);
        double d = run->work[DEM_ROW * at + ROW_OVERLAP];
        if (!belongs(run, at))
            continue;
        if (d > ends.deepest) {
            ends.deepest = d;
            ends.place = at;
        }
        if (attached[run->s->begin + at] > 0 && d > ends.remembers) {
            ends.remembers = d;
            ends.memory = at;
            ends.some = true;
        }
    }
    return ends;
}

// all that count remember the same; without a history, all forget
static void remember(const patch_run *run, const dem_contact_history *h)
{
    const dem_contact_columns *c = &run->contacts->columns;
    walker k = walk(run);
    for (size_t i = run->start; i < run->end; i++) {
        size_t at = step_on(&k);
        if (belongs(run, at))
            dem_history_put(c, run->s->begin + at, h);
    }
}

static void sum_patch(const patch_run *run, const soft_patch_data *p, soft_sums *sums)
{
    memset(sums, 0, sizeof *sums);
    walker k = walk(run);
    size_t none = run->s->end - run->s->begin;
    for (size_t from = run->start; from < run->end; from += DEM_BLOCK_LANES) {
        uint32_t row[DEM_BLOCK_LANES];
        for (size_t i = 0; i < DEM_BLOCK_LANES; i++) {
            size_t at = from + i < run->end ? step_on(&k) : none;
            row[i] = (uint32_t)(at == none || belongs(run, at) ? at : none);
        }
        for (size_t l = 0; l < DEM_BLOCK_LANES; l += DEM_WIDTH)
            sum_lanes(p, run->work, row + l, l, sums);
    }
}

static void push(double *momentum, dem_vec3 force, dem_vec3 moment, double kick, double strain)
{
    double add[7] = {kick * force.x,  kick * force.y,  kick * force.z, kick * moment.x,
                     kick * moment.y, kick * moment.z, strain};
    for (int k = 0; k < 7; k++)
        momentum[k] += add[k];
}

static void put_record(dem_contact_record *r, const soft_patch_data *p, const soft_whole *s, const soft_result *f)
{
    dem_vec3 from_b = v3_sub(s->point, p->between);
    for (int k = 0; k < 3; k++) {
        r->normal[k] = v3_get(s->n, k);
        r->point_a[k] = v3_get(s->point, k);
        r->point_b[k] = v3_get(from_b, k);
        r->force[k] = v3_get(f->force, k);
        r->turning[k] = v3_get(f->turning, k);
    }
    r->overlap = s->depth;
    r->normal_force = f->net * s->along;
    r->elastic_normal = f->elastic_normal;
    r->elastic_slide = f->elastic_slide;
    r->elastic_turn = f->elastic_turn;
    r->touches = true;
}

static dem_vec3 minus(dem_vec3 v)
{
    return v3(-v.x, -v.y, -v.z);
}

typedef struct patch_bodies {
    uint32_t a, b, target, wall;
    soft_side side[2];
} patch_bodies;

static patch_bodies bodies_of(const dem_world *w, const patch_run *run, soft_patch_data *p)
{
    const dem_contact_columns *c = &run->contacts->columns;
    size_t at = segment_place(run->s, run->start);
    patch_bodies pair = {.a = c->a[at]};
    pair.side[0] = side_of(w, pair.a);
    if (run->form < 0) {
        pair.b = c->b[at];
        pair.target = c->target[at];
        pair.side[1] = side_of(w, pair.b);
        p->between = v3_sub(body_position(&w->bodies, pair.b), body_position(&w->bodies, pair.a));
        if (c->shift) {
            const double *shift = w->shifts + 4 * (size_t)c->shift[at];
            p->between = v3_add(p->between, v3(shift[0], shift[1], shift[2]));
        }
    } else {
        pair.wall = c->sphere_b[at];
        pair.side[1] = side_of_wall(w, pair.wall, pair.a);
    }
    return pair;
}

static soft_spot spot_of(const dem_world *w, const patch_run *run, const patch_bodies *pair)
{
    const dem_contact_columns *c = &run->contacts->columns;
    uint32_t law = c->law ? c->law[segment_place(run->s, run->start)] : 0;
    double ra = w->soft.radius[pair->a], rb = run->form < 0 ? w->soft.radius[pair->b] : ra, least = smaller(ra, rb);
    bool wall = run->form >= 0;
    return (soft_spot){.law = w->laws.rows + (size_t)LAW_SLOTS * law,
                       .reduced = wall ? ra : ra * rb / (ra + rb),
                       .area = wall ? ra : least * least / (ra + rb),
                       .last_step = w->last_step,
                       .next_step = w->next_step,
                       .times = wall ? 1 : 2};
}

static void do_patch(dem_world *w, const dem_features f, patch_run *run, double kick, dem_tally *tally,
                     dem_contact_record *records)
{
    patch_ends ends = look_over(run);
    dem_contact_history h = {0};
    if (ends.some && ends.deepest > -DEM_SOFT_REACH * w->soft.tau)
        h = dem_history_get(&run->contacts->columns, run->s->begin + ends.memory);
    soft_patch_data p = {.tau = w->soft.tau, .deepest = ends.deepest, .watch = f.watch};
    if (ends.deepest <= -DEM_SOFT_REACH * p.tau) {
        if (ends.some && !records)
            remember(run, &h);  // far apart at once: the history is of none
        return;
    }
    patch_bodies pair = bodies_of(w, run, &p);
    p.a = &pair.side[0];
    p.b = &pair.side[1];
    soft_sums sums;
    sum_patch(run, &p, &sums);
    soft_whole s = soft_whole_of(&p, &sums);
    if (!(s.depth > 0) && !ends.some)
        return;
    soft_spot spot = spot_of(w, run, &pair);
    soft_result r = soft_act(f, &spot, &p, &s, &h);
    double power = run->form >= 0 && f.moving ? v3_dot(r.force, p.b->velocity) + v3_dot(r.moment, p.b->spin) : 0;
    if (records) {
        if (s.depth > 0)
            put_record(&records[ends.place], &p, &s, &r);
        records[ends.place].lost_friction = r.lost_friction;
        records[ends.place].lost_viscous = r.lost_viscous;
        records[ends.place].wall_power = power;
        return;
    }
    h.attached = s.depth > 0;
    remember(run, &h);
    tally->friction[0] += r.lost_friction;
    tally->viscous[0] += r.lost_viscous;
    tally->work[0] += kick * power;
    push(w->bodies.momentum + DEM_ROW * (size_t)pair.a, r.force, r.moment, kick, r.strain_a);
    if (run->form < 0)
        push(w->bodies.momentum + DEM_ROW * (size_t)pair.target, minus(r.force),
             v3_sub(v3_cross(p.between, r.force), r.moment), kick, r.strain_b);
}

// the next normal to group by: of the deepest contact that is in no group yet
static bool add_leader(const patch_run *run, double reach, dem_soft_leaders *leaders)
{
    double deepest = -reach;
    dem_vec3 normal = v3(0, 0, 0);
    walker k = walk(run);
    for (size_t i = run->start; i < run->end; i++) {
        const double *row = run->work + DEM_ROW * step_on(&k);
        if (row[ROW_OVERLAP] > deepest && soft_group(leaders, normal_of(row)) < 0) {
            deepest = row[ROW_OVERLAP];
            normal = normal_of(row);
        }
    }
    if (deepest > -reach)
        leaders->normal[leaders->count++] = normal;
    return deepest > -reach;
}

static void do_groups(dem_world *w, const dem_features f, patch_run *run, double kick, dem_tally *tally,
                      dem_contact_record *records)
{
    dem_soft_leaders leaders = {.count = 0};
    while (leaders.count < DEM_SOFT_LEADERS && add_leader(run, w->ahead, &leaders))
        ;
    run->leaders = &leaders;
    for (run->group = 0; run->group < leaders.count; run->group++)
        do_patch(w, f, run, kick, tally, records);
}

static void segment(dem_world *w, size_t which, int form, double kick, double *work, dem_contact_record *records)
{
    dem_contacts *contacts = form < 0 ? &w->contacts : &w->wall_contacts[form];
    const dem_segment *s = &contacts->segments[which];
    if (s->begin == s->end)
        return;
    dem_features f = soft_features(w);
    dem_tally *tally = &w->tallies[(size_t)(1 + form) * w->segment_count + which], scratch = {0};
    const dem_contact_columns *c = &contacts->columns;
    if (records)
        tally = &scratch;
    const dem_features geometry = {.offset = true, .scaled = true},
                       images = {.offset = true, .scaled = true, .periodic = true};
    if (f.periodic)
        fill_rows(images, w, contacts, s, form, &tally->overlap_ratio, work);
    else
        fill_rows(geometry, w, contacts, s, form, &tally->overlap_ratio, work);
    size_t size = s->end - s->begin;
    for (size_t start = 0, end; start < size; start = end) {
        size_t first = segment_place(s, start);
        for (end = start + 1; end < size; end++) {
            size_t at = segment_place(s, end);
            bool same =
                c->a[at] == c->a[first] && (form < 0 ? c->b[at] == c->b[first] : c->sphere_b[at] == c->sphere_b[first]);
            if (!same || (c->shift && c->shift[at] != c->shift[first]))
                break;
        }
        if (c->a[first] < w->bodies.count)
            (form == DEM_FORM_MESH ? do_groups : do_patch)(
                w, f, &(patch_run){contacts, s, form, start, end, work, NULL, 0}, kick, tally, records);
    }
}

const dem_soft_kernels DEM_LEVEL_OF(dem_soft_kernels) = {.segment = segment};
