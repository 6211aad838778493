// Compiled once as it is (plain) and once per instruction set with DEM_KERNELS set to v3 or v4.
//
// Two loops over the contacts of a segment. The first measures all pairs of spheres, which stand in runs of the same
// bodies. Each run that is within the reach, or remembers, is a patch. The second goes through DEM_WIDTH patches side
// by side, those with about as many pairs: sums, and then the laws.
#include "base/level.h"
#include "sim/contacts.h"
#include "sim/soft_law.h"

enum { KEPT = 9, KEPT_MOST = 15 };  // numbers that a patch remembers, and with moments against rolling

// what a segment's loops work on
typedef struct soft_job {
    dem_world *w;
    dem_contacts *contacts;
    const dem_segment *s;
    int form;
    double kick;
    dem_soft_work *work;
    dem_tally *tally;
    dem_contact_record *records;  // NULL: forces
    int kept_count;
    double *kept[KEPT_MOST];      // columns of what contacts remember, from the segment's first; NULL: there is none
    double *attached;
    size_t size, rows, patches;
} soft_job;

static void list_kept(soft_job *job)
{
    const dem_contact_columns *c = &job->contacts->columns;
    double *const kept[KEPT_MOST] = {c->spring[0], c->spring[1], c->spring[2], c->dash[0], c->dash[1],
                                     c->dash[2],   c->twist,     c->patch,     c->loss,    c->roll[0],
                                     c->roll[1],   c->roll[2],   c->drag[0],   c->drag[1], c->drag[2]};
    job->kept_count = c->roll[0] || c->drag[0] ? KEPT_MOST : KEPT;
    for (int k = 0; k < job->kept_count; k++)
        job->kept[k] = kept[k] ? kept[k] + job->s->begin : NULL;
    job->attached = c->attached + job->s->begin;
}

// ---- pairs

DEM_INLINE void put_rows(soft_job *job, size_t at, const contact_batch *batch, size_t g)
{
    wide overlap = wide_load(batch->at[AT_OVERLAP] + g), row[8];
    wide3 n = get3(batch, AT_NORMAL, g), arm = get3(batch, AT_A, g);
    if (job->form == DEM_FORM_MESH) {  // places that are not in use say so, or have no normal yet
        wide none = wide_all(DEM_MESH_NO_OVERLAP);
        wide_mask used = wide_either(wide_less(none, overlap), wide_less(overlap, none));
        overlap = wide_select(wide_and(used, wide_less(wide_all(0.5), dot3(n, n))), overlap, wide_all(DEM_SOFT_APART));
    }
    wide_store(job->work->overlap + at, overlap);
    row[ROW_OVERLAP] = overlap;
    row[ROW_NORMAL] = n.x;
    row[ROW_NORMAL + 1] = n.y;
    row[ROW_NORMAL + 2] = n.z;
    row[ROW_ARM] = arm.x;
    row[ROW_ARM + 1] = arm.y;
    row[ROW_ARM + 2] = arm.z;
    row[ROW_WEIGHT] = wide_load(job->contacts->columns.weight + job->s->begin + at);
    rows_store_next(job->work->rows + DEM_ROW * at, DEM_ROW, row);
}

DEM_INLINE void measure(const dem_features f, soft_job *job)
{
    const dem_contact_columns *c = &job->contacts->columns;
    dem_rows rows = world_rows(job->w);
    contact_batch batch;
    size_t begin = job->s->begin;
    double largest = job->tally->overlap_ratio;
    for (size_t from = 0; from < job->size; from += BATCH) {
        size_t count = job->size - from < BATCH ? job->size - from : BATCH;
        for (size_t g = 0; g < count; g += DEM_WIDTH)
            if (job->form < 0) {
                pair_first(f, &rows, c, begin + from + g, g, &batch);
                pair_second(f, &rows, c, begin + from + g, g, &batch);
                pair_geometry(f, &rows, c, begin + from + g, g, &batch, &largest);
            } else
                wall_geometry(f, &rows, c, (dem_wall_form)job->form, begin + from + g, g, &batch, &largest);
        for (size_t g = 0; g < count; g += DEM_WIDTH)
            put_rows(job, from + g, &batch, g);
    }
    job->tally->overlap_ratio = largest;
    // a row of none
    memset(job->work->rows + DEM_ROW * job->size, 0, DEM_ROW * sizeof *job->work->rows);
    job->rows = job->size + 1;
}

// ---- patches

static void find_patches(soft_job *job)
{
    const dem_soft_runs *runs = &job->contacts->runs[job->s - job->contacts->segments];
    const double *overlap = job->work->overlap, *attached = job->attached;
    dem_soft_patch *patch = job->work->patches;
    for (size_t r = 0; r < runs->count; r++) {
        uint32_t first = runs->first[r], end = runs->first[r + 1];
        double deepest = overlap[first];
        for (uint32_t k = first + 1; k < end; k++)
            deepest = larger(deepest, overlap[k]);
        if (deepest + runs->rise[r] > 0 || attached[first] > 0)
            *patch++ = (dem_soft_patch){first, end - first, first, first, deepest};
    }
    job->patches = (size_t)(patch - job->work->patches);
}

static dem_vec3 normal_of(const soft_job *job, size_t k)
{
    const double *row = job->work->rows + DEM_ROW * k;
    return v3(row[ROW_NORMAL], row[ROW_NORMAL + 1], row[ROW_NORMAL + 2]);
}

static uint32_t part_of(const soft_job *job, size_t k)
{
    return soft_part(&job->w->soft, job->contacts->columns.sphere_a[job->s->begin + k]);
}

// makes a patch of those of the contacts [begin, end) of a mesh that belong to a group: copies of their rows
static void make_group(soft_job *job, size_t begin, size_t end, const dem_soft_leaders *leaders, int group)
{
    dem_soft_work *work = job->work;
    dem_soft_patch p = {.row = (uint32_t)job->rows, .deepest = 2 * DEM_SOFT_APART};
    double remembers = 2 * DEM_SOFT_APART;
    bool some = false;
    for (size_t k = begin; k < end; k++) {
        double d = work->overlap[k];
        if (!(d > DEM_SOFT_APART) || soft_group(leaders, normal_of(job, k), part_of(job, k)) != group)
            continue;
        memcpy(work->rows + DEM_ROW * job->rows, work->rows + DEM_ROW * k, DEM_ROW * sizeof *work->rows);
        work->place[job->rows++] = (uint32_t)k;
        p.count++;
        if (d > p.deepest) {
            p.deepest = d;
            p.place = (uint32_t)k;
        }
        if (job->attached[k] > 0 && d > remembers) {
            remembers = d;
            p.memory = (uint32_t)k;
            some = true;
        }
    }
    if (!some)
        p.memory = p.place;
    if (p.count && (some || p.deepest > -DEM_SOFT_REACH * job->w->soft.tau))
        work->patches[job->patches++] = p;
}

// a place that is not in use
static void forget(const soft_job *job, size_t k)
{
    job->attached[k] = 0;
    for (int i = 0; i < job->kept_count; i++)
        if (job->kept[i])
            job->kept[i][k] = 0;
}

// the normals to group by: of the deepest contact that is in no group yet, and so on
static void make_groups(soft_job *job, size_t begin, size_t end)
{
    dem_soft_leaders leaders = {.count = 0};
    for (bool some = true; some && leaders.count < DEM_SOFT_LEADERS;) {
        double deepest = -DEM_SOFT_REACH * job->w->soft.tau;
        size_t leader = end;
        for (size_t k = begin; k < end; k++)
            if (job->work->overlap[k] > deepest && soft_group(&leaders, normal_of(job, k), part_of(job, k)) < 0) {
                deepest = job->work->overlap[k];
                leader = k;
            }
        some = leader < end;
        if (some) {
            leaders.normal[leaders.count] = normal_of(job, leader);
            leaders.part[leaders.count++] = part_of(job, leader);
        }
    }
    for (int group = -1; group < leaders.count; group++)
        make_group(job, begin, end, &leaders, group);
    for (size_t k = begin; k < end && !job->records; k++)
        if (!(job->work->overlap[k] > DEM_SOFT_APART))
            forget(job, k);
}

static void find_groups(soft_job *job)
{
    const dem_soft_runs *runs = &job->contacts->runs[job->s - job->contacts->segments];
    for (size_t r = 0; r < runs->count; r++)
        make_groups(job, runs->first[r], runs->first[r + 1]);
}

// by their number of pairs
static void sort_patches(const soft_job *job)
{
    enum { BINS = 64 };
    uint32_t start[BINS + 1] = {0};
    const dem_soft_patch *p = job->work->patches;
    for (size_t i = 0; i < job->patches; i++)
        start[p[i].count < BINS ? p[i].count : BINS]++;
    for (uint32_t i = 0, sum = 0; i <= BINS; i++) {
        uint32_t here = start[i];
        start[i] = sum;
        sum += here;
    }
    for (size_t i = 0; i < job->patches; i++)
        job->work->sorted[start[p[i].count < BINS ? p[i].count : BINS]++] = (uint32_t)i;
}

// ---- eight patches

// columns by lane
typedef struct soft_eight {
    const dem_soft_patch *p[DEM_BLOCK_LANES];
    size_t count;
    uint32_t a[DEM_BLOCK_LANES], b[DEM_BLOCK_LANES], law[DEM_BLOCK_LANES], shift[DEM_BLOCK_LANES];
    uint32_t first[DEM_BLOCK_LANES], members[DEM_BLOCK_LANES];
    bool remembers[DEM_BLOCK_LANES];
    double share[DEM_BLOCK_LANES], stiffening[DEM_BLOCK_LANES];
    double sum[DEM_BLOCK_LANES], deepest[DEM_BLOCK_LANES], depth[DEM_BLOCK_LANES], radius[2][DEM_BLOCK_LANES];
    double kept[KEPT_MOST][DEM_BLOCK_LANES];
    double momentum[2][DEM_BLOCK_LANES][DEM_ROW] __attribute__((aligned(64)));
    double force[3][DEM_BLOCK_LANES], hardness[DEM_BLOCK_LANES];
} soft_eight;

static void fill_lane(const soft_job *job, soft_eight *e, size_t i)
{
    const dem_contact_columns *c = &job->contacts->columns;
    const dem_soft_patch *p = e->p[i];
    size_t at = job->s->begin + p->place;
    bool wall = job->form >= 0;
    e->a[i] = c->a[at];
    e->b[i] = wall ? c->sphere_b[at] : c->b[at];
    e->law[i] = c->law ? c->law[at] : 0;
    e->shift[i] = c->shift ? c->shift[at] : 0;
    e->first[i] = p->row;
    e->members[i] = p->count;
    e->deepest[i] = p->deepest;
    e->remembers[i] = job->attached[p->memory] > 0;
    if (job->work->share) {
        e->share[i] = job->work->share[2 * (p - job->work->patches)];
        e->stiffening[i] = job->work->share[2 * (p - job->work->patches) + 1];
    }
    e->radius[0][i] = job->w->soft.radius[e->a[i]];
    e->radius[1][i] = wall ? e->radius[0][i] : job->w->soft.radius[e->b[i]];
}

// a lane without a patch: dummies, or the wall behind the last
static void fill_idle(const soft_job *job, soft_eight *e, size_t i)
{
    e->a[i] = job->w->bodies.dummy;
    e->b[i] = job->form < 0 ? e->a[i] + 1 : (uint32_t)job->w->walls.count;
    e->law[i] = e->shift[i] = e->first[i] = e->members[i] = 0;
    e->remembers[i] = false;
    e->deepest[i] = -DEM_SOFT_REACH * job->w->soft.tau;
    e->share[i] = e->stiffening[i] = e->radius[0][i] = e->radius[1][i] = 1;
}

// what contacts remember that do not touch is 0
static void fill_kept(const soft_job *job, soft_eight *e)
{
    for (int k = 0; k < job->kept_count; k++) {
        const double *from = job->kept[k];
        for (size_t i = 0; i < DEM_BLOCK_LANES; i++)
            e->kept[k][i] = from && i < e->count ? from[e->p[i]->memory] : 0;
    }
}

// all of a group remember the same at a mesh, whose contacts may change places
static void remember(const soft_job *job, const soft_eight *e, size_t i)
{
    const dem_soft_patch *p = e->p[i];
    bool mesh = job->form == DEM_FORM_MESH;
    for (uint32_t m = 0; m < (mesh ? p->count : 1); m++) {
        size_t place = mesh ? job->work->place[p->row + m] : p->place;
        job->attached[place] = e->depth[i] > 0;
        for (int k = 0; k < job->kept_count; k++)
            if (job->kept[k])
                job->kept[k][place] = e->kept[k][i];
    }
}

DEM_INLINE soft_lanes load_lanes(const dem_features f, const soft_job *job, const soft_eight *e, size_t l)
{
    dem_rows rows = world_rows(job->w);
    wide pose[8], other[8], zero = wide_all(0);
    rows_load(rows.bodies, DEM_BODY_ROW, e->a + l, pose);
    soft_lanes p = {.first = e->first + l,
                    .count = e->members + l,
                    .deepest = wide_load(e->deepest + l),
                    .tau = job->w->soft.tau,
                    .between = {zero, zero, zero}};
    p.a = side_of(&rows, e->a + l, pose);
    if (job->form < 0) {
        rows_load(rows.bodies, DEM_BODY_ROW, e->b + l, other);
        p.between = (wide3){other[0] - pose[0], other[1] - pose[1], other[2] - pose[2]};
        if (f.periodic) {
            wide shift[4];
            rows_load4(rows.shifts, 4, e->shift + l, shift);
            p.between = plus3(p.between, (wide3){shift[0], shift[1], shift[2]});
        }
        p.b = side_of(&rows, e->b + l, other);
        return p;
    }
    // as a body that nothing moves, whose velocity is told where the centre of a is
    p.b = (soft_side){.velocity = {zero, zero, zero},
                      .spin = {zero, zero, zero},
                      .inverse_mass = zero,
                      .inverse = {zero, zero, zero, zero, zero, zero},
                      .brisk = zero,
                      .quick = zero};
    if (f.moving) {
        rows_load(rows.walls + 8, DEM_WALL_ROW, e->b + l, other);
        p.b.spin = (wide3){other[3], other[4], other[5]};
        p.b.velocity =
            plus3((wide3){other[0], other[1], other[2]}, cross3(p.b.spin, (wide3){pose[0], pose[1], pose[2]}));
    }
    return p;
}

DEM_INLINE soft_spot load_spot(const dem_features f, const soft_job *job, const soft_eight *e, size_t l)
{
    const dem_world *w = job->w;
    bool wall = job->form >= 0;
    wide a = wide_load(e->radius[0] + l), b = wide_load(e->radius[1] + l), least = wide_min(a, b);
    soft_spot spot = {.reduced = reduced_radius(a, b),
                      .area = least * least / (a + b),
                      .radius_a = a,
                      .radius_b = b,
                      .tau = w->soft.tau,
                      .last_step = w->last_step,
                      .next_step = w->next_step,
                      .parted = job->work->share != NULL,
                      .wall = wall};
    if (spot.parted) {
        spot.share = wide_load(e->share + l);
        spot.stiffening = wide_load(e->stiffening + l);
    }
    if (wall)
        spot.reduced = spot.area = a;
    int slots = features_turning(f) || f.roll_bound ? SOFT_LAW : LAW_MORE;
    for (int k = 0; f.mixed && k < slots; k += 8)
        rows_load(w->laws.rows + k, LAW_SLOTS, e->law + l, spot.law + k);
    for (int k = 0; !f.mixed && k < slots; k++)
        spot.law[k] = wide_all(w->laws.rows[k]);
    spot.step = law_step_of(f, spot.law, w->last_step, w->next_step);
    return spot;
}

DEM_INLINE wide3 kept3(const soft_eight *e, int k, size_t l)
{
    return (wide3){wide_load(e->kept[k] + l), wide_load(e->kept[k + 1] + l), wide_load(e->kept[k + 2] + l)};
}

DEM_INLINE void keep_memory(soft_eight *e, size_t l, const soft_memory *m, bool turning)
{
    const wide kept[KEPT] = {m->spring.x, m->spring.y, m->spring.z, m->dash.x, m->dash.y,
                             m->dash.z,   m->twist,    m->patch,    m->loss};
    for (int k = 0; k < KEPT; k++)
        wide_store(e->kept[k] + l, kept[k]);
    if (!turning)
        return;
    const wide3 more[] = {m->roll, m->drag};
    for (int k = 0; k < 2; k++) {
        wide_store(e->kept[KEPT + 3 * k] + l, more[k].x);
        wide_store(e->kept[KEPT + 3 * k + 1] + l, more[k].y);
        wide_store(e->kept[KEPT + 3 * k + 2] + l, more[k].z);
    }
}

DEM_INLINE void put_momentum(soft_eight *e, size_t l, int side, wide3 force, wide3 moment, double kick, wide strain,
                             wide bound)
{
    wide by = wide_all(kick);
    wide row[8] = {force.x * by,  force.y * by,  force.z * by, moment.x * by,
                   moment.y * by, moment.z * by, strain,       bound * by};
    rows_store_next(e->momentum[side][l], DEM_ROW, row);
}

// lanes that are written down
enum {
    TOLD_NORMAL,
    TOLD_A = 3,
    TOLD_B = 6,
    TOLD_FORCE = 9,
    TOLD_TURNING = 12,
    TOLD_OVERLAP = 15,
    TOLD_NET,
    TOLD_ELASTIC,
    TOLD_SLIDE,
    TOLD_TURN,
    TOLD_FRICTION,
    TOLD_VISCOUS,
    TOLD_POWER,
    TOLD
};

static void put_records(const soft_job *job, const soft_eight *e, size_t l, const soft_lanes *p, const soft_whole *s,
                        const soft_result *r, wide power)
{
    double told[TOLD][DEM_WIDTH];
    wide3 from_b = minus3(s->point, p->between), turning = minus3(r->moment, cross3(s->point, r->force));
    const wide3 vectors[] = {s->n, s->point, from_b, r->force, turning};
    const wide numbers[] = {s->depth,        r->net * s->along, r->elastic_normal, r->elastic_slide,
                            r->elastic_turn, r->lost_friction,  r->lost_viscous,   power};
    for (int k = 0; k < 5; k++) {
        wide_store(told[3 * k], vectors[k].x);
        wide_store(told[3 * k + 1], vectors[k].y);
        wide_store(told[3 * k + 2], vectors[k].z);
    }
    for (int k = TOLD_OVERLAP; k < TOLD; k++)
        wide_store(told[k], numbers[k - TOLD_OVERLAP]);
    for (size_t i = 0; i < DEM_WIDTH && l + i < e->count; i++) {
        dem_contact_record *to = &job->records[e->p[l + i]->place];
        to->lost_friction = told[TOLD_FRICTION][i];
        to->lost_viscous = told[TOLD_VISCOUS][i];
        to->wall_power = told[TOLD_POWER][i];
        if (!(told[TOLD_OVERLAP][i] > 0))
            continue;
        for (int k = 0; k < 3; k++) {
            to->normal[k] = told[TOLD_NORMAL + k][i];
            to->point_a[k] = told[TOLD_A + k][i];
            to->point_b[k] = told[TOLD_B + k][i];
            to->force[k] = told[TOLD_FORCE + k][i];
            to->turning[k] = told[TOLD_TURNING + k][i];
        }
        to->overlap = told[TOLD_OVERLAP][i];
        to->normal_force = told[TOLD_NET][i];
        to->elastic_normal = told[TOLD_ELASTIC][i];
        to->elastic_slide = told[TOLD_SLIDE][i];
        to->elastic_turn = told[TOLD_TURN][i];
        to->touches = true;
    }
}

// D of the patches; false: none of them touches or remembers
static bool find_depths(const soft_job *job, soft_eight *e, size_t l)
{
    double tau = job->w->soft.tau;
    double largest = job->tally->soft_overlap;
    bool some = false;
    for (size_t i = l; i < l + DEM_WIDTH; i++) {
        double sum = e->sum[i], deepest = e->deepest[i];
        e->depth[i] = -DEM_SOFT_REACH * tau;
        // log S <= S - 1
        if (sum > 0 && (e->remembers[i] || deepest / tau + sum > 1))
            e->depth[i] = larger(e->depth[i], deepest + tau * log(sum));
        largest = larger(largest, e->depth[i]);
        some |= e->depth[i] > 0 || e->remembers[i];
    }
    job->tally->soft_overlap = largest;
    return some;
}

DEM_INLINE void act_lanes(const dem_features f, soft_job *job, soft_eight *e, size_t l)
{
    soft_lanes p = load_lanes(f, job, e, l);
    soft_sums sums = soft_sum(f, &p, job->work->rows, (uint32_t)job->size);
    wide_store(e->sum + l, sums.s);
    if (!find_depths(job, e, l))
        return;
    soft_spot spot = load_spot(f, job, e, l);
    soft_whole s = soft_whole_of(&p, &sums, wide_load(e->depth + l));
    bool turning = job->kept_count > KEPT;
    wide3 none = {wide_all(0), wide_all(0), wide_all(0)};
    soft_memory m = {.spring = kept3(e, 0, l),
                     .dash = kept3(e, 3, l),
                     .roll = turning ? kept3(e, KEPT, l) : none,
                     .drag = turning ? kept3(e, KEPT + 3, l) : none,
                     .twist = wide_load(e->kept[6] + l),
                     .patch = wide_load(e->kept[7] + l),
                     .loss = wide_load(e->kept[8] + l)};
    soft_result r = soft_act(f, &spot, &p, &s, &m);
    wide power = wide_all(0), zero = power;
    if (f.moving && spot.wall)
        power = dot3(r.force, p.b.velocity) + dot3(r.moment, p.b.spin);
    if (job->records) {
        put_records(job, e, l, &p, &s, &r, power);
        return;
    }
    keep_memory(e, l, &m, turning);
    if (f.ledger) {
        tally_add(job->tally->friction, l, r.lost_friction);
        tally_add(job->tally->viscous, l, r.lost_viscous);
        tally_add(job->tally->work, l, wide_all(job->kick) * power);
    }
    put_momentum(e, l, 0, r.force, r.moment, job->kick, r.strain_a, r.bound);
    if (job->form < 0) {
        wide3 force = {zero - r.force.x, zero - r.force.y, zero - r.force.z};
        put_momentum(e, l, 1, force, minus3(cross3(p.between, r.force), r.moment), job->kick, r.strain_b,
                     r.bound);
    }
    if (f.reaction && spot.wall) {
        wide_store(e->force[0] + l, r.force.x);
        wide_store(e->force[1] + l, r.force.y);
        wide_store(e->force[2] + l, r.force.z);
        wide_store(e->hardness + l, r.hardness);
    }
}

static void push(double *to, const double *add)
{
    for (int k = 0; k < DEM_ROW; k++)
        to[k] += add[k];
}

DEM_INLINE void act_eight(const dem_features f, soft_job *job, size_t from)
{
    const dem_contact_columns *c = &job->contacts->columns;
    double *momentum = job->w->bodies.momentum;
    soft_eight e;
    e.count = job->patches - from < DEM_BLOCK_LANES ? job->patches - from : DEM_BLOCK_LANES;
    for (size_t i = 0; i < e.count; i++) {
        e.p[i] = &job->work->patches[job->work->sorted[from + i]];
        fill_lane(job, &e, i);
    }
    for (size_t i = e.count; i < DEM_BLOCK_LANES; i++)
        fill_idle(job, &e, i);
    fill_kept(job, &e);
    for (size_t l = 0; l < e.count; l += DEM_WIDTH)
        act_lanes(f, job, &e, l);
    for (size_t i = 0; i < e.count && !job->records; i++) {
        size_t at = job->s->begin + e.p[i]->place;
        if (!(e.depth[i] > 0 || e.remembers[i]))
            continue;
        remember(job, &e, i);
        push(momentum + DEM_ROW * (size_t)e.a[i], e.momentum[0][i]);
        if (job->form < 0)
            push(momentum + DEM_ROW * (size_t)c->target[at], e.momentum[1][i]);
        else if (f.reaction) {
            for (int k = 0; k < 3; k++)
                c->reaction[k][at] = e.force[k][i];
            c->hardness[at] = e.hardness[i];
        }
    }
}

// ---- a segment

static void clear_reactions(const soft_job *job)
{
    const dem_contact_columns *c = &job->contacts->columns;
    size_t begin = job->s->begin, bytes = (job->s->end - begin) * sizeof(double);
    for (int k = 0; k < 3; k++)
        memset(c->reaction[k] + begin, 0, bytes);
    memset(c->hardness + begin, 0, bytes);
}

static void segment(dem_world *w, size_t which, int form, double kick, dem_soft_work *work, dem_contact_record *records)
{
    dem_contacts *contacts = form < 0 ? &w->contacts : &w->wall_contacts[form];
    const dem_segment *s = &contacts->segments[which];
    if (s->begin == s->end)
        return;
    dem_features f = soft_features(&w->features);
    dem_tally *tally = &w->tallies[(size_t)(1 + form) * w->segment_count + which], scratch = {.overlap_ratio = 0};
    soft_job job = {.w = w,
                    .contacts = contacts,
                    .s = s,
                    .form = form,
                    .kick = kick,
                    .work = work,
                    .tally = records ? &scratch : tally,
                    .records = records};
    list_kept(&job);
    job.size = s->end - s->begin;
    const dem_features geometry = {.offset = true, .scaled = true},
                       images = {.offset = true, .scaled = true, .periodic = true};
    if (f.periodic)
        measure(images, &job);
    else
        measure(geometry, &job);
    if (form == DEM_FORM_MESH)
        find_groups(&job);
    else
        find_patches(&job);
    sort_patches(&job);
    if (w->soft.part)
        dem_soft_couple(w, contacts, which, form, work, job.patches);
    if (f.reaction && form >= 0 && !records)
        clear_reactions(&job);
    for (size_t from = 0; from < job.patches; from += DEM_BLOCK_LANES)
        act_eight(f, &job, from);
}

const dem_soft_kernels DEM_LEVEL_OF(dem_soft_kernels) = {.segment = segment};
