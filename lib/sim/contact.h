/// The loop over contacts, for kernels.c: rows in, transpose, a law without branches, transpose, rows out.
///
/// A batch of contacts goes through four short loops by way of a buffer that stays in the first cache. Impulses are
/// added to the momenta directly, in blocks of 8: first all of the a side, then all of the b side, whatever the width.
#ifndef DEM_SIM_CONTACT_H
#define DEM_SIM_CONTACT_H

#include "sim/contact_geometry.h"
#include "sim/law/bond.h"
#include "sim/law/turning.h"
#ifdef DEM_USER_LAW
#include "sim/user_forces.h"
#endif

typedef struct contact_numbers {
    wide law[LAW_SLOTS];
    law_step step;
} contact_numbers;

/// `row`: of the laws of a mixed scene.
DEM_INLINE contact_numbers load_law(const dem_features f, const dem_rows *rows, const dem_contact_job *job,
                                    const uint32_t *row)
{
    const bool more = turns(f) || adheres(f) || f.roll_bound || f.jkr || f.bonded;
    contact_numbers n;
    for (int k = 0; f.mixed && k < (more ? LAW_SLOTS : LAW_MORE); k += 8)
        rows_load(rows->laws + k, LAW_SLOTS, row, n.law + k);
    // in two short loops, which compilers unroll, so that what is not needed is not even loaded
    for (int k = 0; !f.mixed && k < LAW_MORE; k++)
        n.law[k] = wide_all(rows->laws[k]);
    for (int k = LAW_MORE; !f.mixed && more && k < LAW_SLOTS; k++)
        n.law[k] = wide_all(rows->laws[k]);
    n.step = law_step_of(f, n.law, job->last_step, job->next_step);
    return n;
}

// energy dissipated since the last step [J]
typedef struct contact_loss {
    wide friction, viscous, broken;
} contact_loss;

// power of a moving wall [W], for measuring
DEM_INLINE void put_losses(const contact_loss *loss, wide power, size_t g, dem_contact_record *records)
{
    double friction[DEM_WIDTH], viscous[DEM_WIDTH], broken[DEM_WIDTH], work[DEM_WIDTH];
    wide_store(broken, loss->broken);
    wide_store(friction, loss->friction);
    wide_store(viscous, loss->viscous);
    wide_store(work, power);
    for (size_t i = 0; i < DEM_WIDTH; i++) {
        records[g + i].lost_friction = friction[i];
        records[g + i].lost_viscous = viscous[i];
        records[g + i].broken = broken[i];
        records[g + i].wall_power = work[i];
    }
}

DEM_INLINE void put_records(const dem_features f, const contact_batch *batch, size_t g, const normal_law *n, wide net,
                            wide pulled, const wide3 *force, const wide3 *spring, wide slide, wide mass, wide weight,
                            wide_mask on, dem_contact_record *records)
{
    double elastic[DEM_WIDTH], stiffness[DEM_WIDTH], normal[DEM_WIDTH], held[DEM_WIDTH], slip[DEM_WIDTH], m[DEM_WIDTH];
    double x[3][DEM_WIDTH], energy[DEM_WIDTH];
    wide_store(elastic, n->elastic * weight);
    wide_store(stiffness, n->stiffness * weight);
    wide_store(normal, net * weight);
    if (f.jkr)
        pulled = pulled + n->energy;
    wide_store(energy, pulled * weight);
    wide_store(held, wide_all(0.5) * slide * dot3(*spring, *spring) * weight);
    wide_store(slip, slide);
    wide_store(m, mass);
    wide_store(x[0], force->x);
    wide_store(x[1], force->y);
    wide_store(x[2], force->z);
    unsigned bits = wide_bits(on);
    for (size_t i = 0; i < DEM_WIDTH; i++) {
        dem_contact_record *r = &records[g + i];
        *r = (dem_contact_record){.touches = bits >> i & 1, .overlap = batch->at[AT_OVERLAP][g + i]};
        for (int k = 0; k < 3; k++) {
            r->normal[k] = batch->at[AT_NORMAL + k][g + i];
            r->point_a[k] = batch->at[AT_A + k][g + i];
            r->point_b[k] = batch->at[AT_B + k][g + i];
            r->force[k] = x[k][i];
        }
        r->normal_force = r->touches ? normal[i] : 0;
        r->stiffness = stiffness[i];
        r->slide_stiffness = slip[i];
        r->reduced_mass = m[i];
        if (r->touches) {
            // of the linear part F = k d the half, of Hertz' F = 2/3 k d two fifths
            double linear = f.hertz ? 3 * elastic[i] - 2 * stiffness[i] * r->overlap : elastic[i];
            double simple = (linear / 2 + (elastic[i] - linear) * 2 / 5) * r->overlap;
            r->elastic_normal = (f.jkr ? 0 : simple) + energy[i];
            r->elastic_slide = held[i];
        }
    }
}

DEM_INLINE void put_turning_records(size_t g, wide3 moment, wide held, dem_contact_record *records)
{
    double x[3][DEM_WIDTH], energy[DEM_WIDTH];
    wide_store(x[0], moment.x);
    wide_store(x[1], moment.y);
    wide_store(x[2], moment.z);
    wide_store(energy, held);
    for (size_t i = 0; i < DEM_WIDTH; i++) {
        for (int k = 0; k < 3; k++)
            records[g + i].turning[k] = x[k][i];
        records[g + i].elastic_turn = energy[i];
    }
}

/// What a contact takes of the room for a stable step, times the mass (timestep.h): h^2 k + 2 h c, all directions.
/// `slide`, `slide_damping`: of the tangential spring and dashpot.
DEM_INLINE wide contact_strain(const dem_features f, const normal_law *n, wide slide, wide slide_damping, wide step,
                               const bool wall)
{
    wide k = n->stiffness, c = n->damping;
    if (f.friction)
        k = wide_fma(wide_all(2), slide, k);
    if (f.friction && f.slide_damping)
        c = wide_fma(wide_all(2), slide_damping, c);
    return wide_all(wall ? 1 : 2) * (step * wide_fma(step, k, c + c));
}

typedef struct contact_moment {
    wide lost;   // dissipated since the last step [J]
    wide power;  // of a turning wall [W]
} contact_moment;

/// The moments of a contact, which it hands on or, for measuring, writes down.
DEM_INLINE contact_moment contact_turning(const dem_features f, const dem_contact_job *job, size_t at, size_t g,
                                          contact_batch *batch, const wide *law, const normal_law *n, turning_state *s,
                                          wide weight, wide_mask on, const bool wall, const bool record)
{
    const dem_contact_columns *c = &job->columns;
    s->spin = get3(batch, AT_SPIN, g);
    s->inverse = wide_load(batch->at[AT_ROLL_INERTIA] + g);
    if (f.rolling)
        s->roll = spring_turn(load3(c->roll, at), s->n, s->step * wide_load(batch->at[AT_TURN] + g));
    if (f.twisting)
        s->twist = wide_load(c->twist + at);
    turning_law t = turning(f, law, n, s, wide_all(job->next_step), on);
    contact_moment result = {t.lost * weight, wide_all(0)};
    if (f.ledger) {
        wide3 was = load3(c->drag, at), both = {was.x + t.drag.x, was.y + t.drag.y, was.z + t.drag.z};
        result.lost = wide_fma(wide_all(0.5) * s->step * weight, dot3(both, s->spin), result.lost);
    }
    wide3 moment = scale3(t.moment, weight);
    if (wall && f.moving)
        result.power = dot3(moment, get3(batch, AT_WALL_SPIN, g));
    if (record) {
        put_turning_records(g, moment, wide_all(0.5) * weight * t.held, job->records + (at - g - job->begin));
        return result;
    }
    put3(batch, AT_MOMENT, g, scale3(moment, wide_all(job->kick)));
    wide_store(batch->at[AT_TURN_STRAIN] + g, wide_all(wall ? 1 : 2) * t.strain);
    if (f.ledger)
        store3(c->drag, at, t.drag);
    if (f.rolling)
        store3(c->roll, at, t.roll);
    if (f.twisting)
        wide_store(c->twist + at, t.twist);
    return result;
}

/// Which contacts of JKR hold: those that overlap, and those that have done so and not yet parted. `gone`: how far they
/// are from parting [m]; `held`: the energy that is left there [J].
DEM_INLINE wide_mask jkr_holds(const jkr_pair *surfaces, wide overlap, wide attached, wide *gone, wide *held)
{
    wide end = surfaces->end, reduced = surfaces->reduced;
    *held = jkr(surfaces, surfaces->least).energy;
    *gone = wide_fnma(end, reduced, overlap);
    return wide_less(wide_or_zero(wide_less(wide_all(0), attached), end * reduced), overlap);
}

/// The spring of a step ago, turned with the contact.
DEM_INLINE void contact_spring(const dem_contact_job *job, size_t at, size_t g, contact_batch *batch)
{
    wide turn = wide_all(job->last_step) * wide_load(batch->at[AT_TURN] + g);
    put3(batch, AT_SPRING, g, spring_turn(load3(job->columns.spring, at), get3(batch, AT_NORMAL, g), turn));
}

/// A contact between the two halves of its law.
typedef struct contact_state {
    contact_numbers numbers;
    normal_law normal;
    contact_mass mass;
    friction_trial trial;
    wide3 n;
    wide overlap, reduced, vn, weight;
    wide lost, broken;  // beside what friction dissipates [J]
    wide_mask on;       // the surfaces act on each other
} contact_state;

/// What the normal force and the surfaces of JKR have dissipated since the last step [J].
DEM_INLINE wide normal_loss(const dem_features f, const dem_contact_columns *c, size_t at, const contact_state *s,
                            wide held, const bool record)
{
    wide lost = wide_all(0);
    if (f.ledger && damped(f)) {
        wide now = wide_or_zero(s->on, s->normal.elastic - s->normal.force), was = wide_load(c->loss + at);
        lost = wide_all(0.5) * (was + now) * (s->vn * s->numbers.step.step);
        if (!record)
            wide_store(c->loss + at, now);
    }
    if (f.jkr) {
        // what the jump together sets free, and what is held where they part, is lost
        wide was = wide_load(c->attached + at), now = wide_or_zero(s->on, wide_all(1));
        wide jumps = wide_or_zero(wide_less(was, now), wide_all(0) - s->normal.energy);
        lost = lost + (jumps + wide_or_zero(wide_less(now, was), held));
        if (!record)
            wide_store(c->attached + at, now);
    }
    return lost;
}

/// The first half: the normal force, and friction without its cap. `given`: of a scene with one law.
DEM_INLINE contact_state contact_press(const dem_features f, const dem_rows *rows, const dem_contact_job *job,
                                       const contact_numbers *given, size_t at, size_t g, contact_batch *batch,
                                       const bool wall, const bool record)
{
    const dem_contact_columns *c = &job->columns;
    contact_state s = {.numbers = f.mixed ? load_law(f, rows, job, c->law + at) : *given};
    wide *const law = s.numbers.law, zero = wide_all(0), step = s.numbers.step.step;
    wide overlap = s.overlap = wide_load(batch->at[AT_OVERLAP] + g);
    wide held = zero, gone = overlap, area = zero;
    s.on = wide_less(zero, overlap);
    s.weight = f.weighted ? wide_load(c->weight + at) : wide_all(1);
    s.reduced = s.broken = zero;
    if (needs_reduced(f))
        s.reduced = wide_load(batch->at[AT_REDUCED] + g);
    jkr_pair surfaces = {zero, zero, zero, zero, zero};
    if (f.jkr) {
        surfaces = jkr_surfaces(law[LAW_JKR], wide_all(0.5) * law[LAW_HERTZ], s.reduced);
        s.on = jkr_holds(&surfaces, overlap, wide_load(c->attached + at), &gone, &held);
    }
    wide3 v = get3(batch, AT_VELOCITY, g);
    s.n = get3(batch, AT_NORMAL, g);
    s.vn = dot3(v, s.n);
    s.mass = (contact_mass){zero, zero, zero};
    if (damped(f))
        s.mass = get_mass(f, batch, g);
    if (f.young)
        area = wide_load(batch->at[AT_AREA] + g);
    s.normal = normal_elastic(f, law, &surfaces, overlap, s.reduced, area);
    wide_mask holds = s.on;
    if (f.bonded) {
        bond_law bonds = bond(law, &s.normal, wide_load(c->bond + at), s.reduced, overlap, s.vn,
                              get3(batch, AT_SPRING, g), against3(v, s.vn, s.n), step, !(job->last_step > 0));
        holds = bonds.holds;
        s.on = wide_either(s.on, bonds.on);
        s.broken = bonds.released;
        // neither a tail nor a beginning
        law[LAW_FLOOR] = wide_select(holds, wide_all(-INFINITY), law[LAW_FLOOR]);
        gone = wide_select(holds, wide_all(1e100), gone);
        if (!record)
            wide_store(c->bond + at, bonds.state);
    }
    normal_damp(f, law, &s.numbers.step, &s.normal, &s.mass, gone, s.vn);
    s.lost = normal_loss(f, c, at, &s, held, record);
    s.trial.stiffness = s.trial.old_stiffness = s.trial.damping = zero;
    if (f.friction)
        s.trial = friction_try(f, law, &s.numbers.step, &s.normal, s.reduced, overlap, s.vn, &s.mass,
                               get3(batch, AT_SPRING, g), against3(v, s.vn, s.n), holds);
    if (record)
        return s;
    if (f.roll_bound) {
        wide bound = law[LAW_ROLL_BOUND] * wide_load(batch->at[AT_RADIUS] + g) * normal_grip(f, &s.normal) * s.weight;
        wide_store(batch->at[AT_BOUND] + g, wide_or_zero(s.on, bound * wide_all(job->kick)));
    }
    if (f.watch) {
        wide strain = contact_strain(f, &s.normal, s.trial.stiffness, s.trial.damping, wide_all(job->next_step), wall);
        wide_store(batch->at[AT_STRAIN] + g, wide_or_zero(s.on, strain));
    }
    if (wall && f.reaction) {
        // what a wall that moves by d in a step meets, over d: the spring and the dashpot
        wide hardness = wide_fma(s.normal.damping, s.numbers.step.per_step, s.normal.stiffness);
        wide_store(c->hardness + at, wide_or_zero(s.on, hardness * s.weight));
    }
    return s;
}

/// Whether the halves of the law are loops of their own, with little to hand on: a loop of both is so long that the
/// processor, waiting for results of one turn, does not reach the next.
DEM_INLINE bool in_halves(const dem_features f, const bool record)
{
    const bool more = f.weighted || f.bonded || f.jkr || adheres(f) || turns(f) || f.user;
    return !record && f.friction && !f.mixed && !more;
}

DEM_INLINE void put_state(const dem_features f, contact_batch *batch, size_t g, const contact_state *s)
{
    put3(batch, AT_VELOCITY, g, s->trial.slip);
    put3(batch, AT_TRIAL, g, s->trial.force);
    wide_store(batch->at[AT_PART] + g, s->trial.part);
    wide_store(batch->at[AT_NET] + g, s->normal.force);
    if (f.slide_damping)
        wide_store(batch->at[AT_CAP] + g, s->trial.cap2);
    if (f.slide_damping && f.rate)
        wide_store(batch->at[AT_DAMPING] + g, s->trial.damping);
    if (f.ledger)
        wide_store(batch->at[AT_LOST] + g, s->lost);
    if (f.mindlin)
        put3(batch, AT_STRETCHED, g, s->trial.stretched);
    if (f.mindlin)
        wide_store(batch->at[AT_OLD_SLIDE] + g, s->trial.old_stiffness);
    if (!alike(f))
        wide_store(batch->at[AT_SLIDE] + g, s->trial.stiffness);
}

DEM_INLINE contact_state get_state(const dem_features f, const contact_numbers *given, const contact_batch *batch,
                                   size_t g)
{
    wide zero = wide_all(0);
    const wide *law = given->law;
    contact_state s = {.numbers = *given, .n = get3(batch, AT_NORMAL, g), .weight = wide_all(1)};
    s.on = wide_less(zero, wide_load(batch->at[AT_OVERLAP] + g));
    s.normal.force = wide_load(batch->at[AT_NET] + g);
    friction_trial *t = &s.trial;
    t->slip = get3(batch, AT_VELOCITY, g);
    t->start = get3(batch, AT_SPRING, g);
    t->force = get3(batch, AT_TRIAL, g);
    t->part = wide_load(batch->at[AT_PART] + g);
    if (f.slide_damping)
        t->cap2 = wide_load(batch->at[AT_CAP] + g);
    if (f.slide_damping && f.rate)
        t->damping = wide_load(batch->at[AT_DAMPING] + g);
    if (f.ledger)
        s.lost = wide_load(batch->at[AT_LOST] + g);
    t->stretched = f.mindlin ? get3(batch, AT_STRETCHED, g) : along3(t->start, given->step.step, t->slip);
    if (f.mindlin)
        t->old_stiffness = wide_load(batch->at[AT_OLD_SLIDE] + g);
    if (alike(f))
        t->stiffness = law[LAW_SLIDE_STIFFNESS] + law[LAW_SLIDE_RATIO] * law[LAW_STIFFNESS];
    else
        t->stiffness = wide_load(batch->at[AT_SLIDE] + g);
    return s;
}

/// The second half: what the cap of friction leaves, all that is measured by it, and the impulse.
DEM_INLINE void contact_hold(const dem_features f, const dem_contact_job *job, const contact_state *s, size_t at,
                             size_t g, contact_batch *batch, const bool wall, const bool record)
{
    const dem_contact_columns *c = &job->columns;
    const wide *law = s->numbers.law, zero = wide_all(0), step = s->numbers.step.step;
    wide3 force = {zero, zero, zero}, spring = force;
    contact_loss loss = {zero, zero, s->broken};
    if (f.friction) {
        friction_law t = friction(f, law, &s->numbers.step, &s->trial, s->on);
        force = t.force;
        spring = t.spring;
        if (!record)
            store3(c->spring, at, spring);
        loss.friction = t.lost;
        if (f.ledger && f.slide_damping) {
            wide3 was = load3(c->dash, at);
            wide3 both = {was.x + t.dash.x, was.y + t.dash.y, was.z + t.dash.z};
            loss.viscous = wide_all(0.5) * step * dot3(both, s->trial.slip);
            if (!record)
                store3(c->dash, at, t.dash);
        }
    }
    wide net = s->normal.force, pulled = zero;
    if (adheres(f)) {
        lens shared = {zero, zero};
        if (f.sjkr)
            shared = (lens){wide_load(batch->at[AT_AREA_SHARED] + g), wide_load(batch->at[AT_VOLUME_SHARED] + g)};
        adhesion_law pull = adhesion(f, law, shared, s->reduced, s->overlap);
        net = net - pull.force;
        pulled = pull.energy;
    }
    force = or_zero3(s->on, against3(force, net, s->n));
    if (f.ledger && (damped(f) || f.jkr))
        loss.viscous = loss.viscous + s->lost;
    if (f.weighted) {
        force = scale3(force, s->weight);
        loss = (contact_loss){loss.friction * s->weight, loss.viscous * s->weight, loss.broken * s->weight};
    }
    dem_contact_record *records = record ? job->records + (at - g - job->begin) : NULL;
    if (record)
        put_records(f, batch, g, &s->normal, net, pulled, &force, &spring, s->trial.stiffness, s->mass.mass, s->weight,
                    s->on, records);
    wide power = zero;  // of a moving wall
    if (turns(f)) {
        wide before = wide_fma(s->vn, step, s->overlap), patch = s->normal.radius;
        if (!f.hertz)
            patch = wide_sqrt(s->reduced * wide_max(s->overlap, zero));
        turning_state turning = {.n = s->n,
                                 .reduced = s->reduced,
                                 .patch = patch,
                                 .patch_before = radius_before(f, &s->normal, s->reduced, s->overlap, before),
                                 .step = step,
                                 .slide = s->trial.stiffness,
                                 .slide_before = s->trial.old_stiffness,
                                 .slide_damping = s->trial.damping};
        contact_moment m =
            contact_turning(f, job, at, g, batch, law, &s->normal, &turning, s->weight, s->on, wall, record);
        loss.friction = loss.friction + m.lost;
        power = m.power;
    }
    if (record) {
        if (wall && f.moving)
            power = power + dot3(force, get3(batch, AT_WALL, g));
        put_losses(&loss, power, g, records);
        return;
    }
    if (f.ledger && (f.friction || turns(f)))
        tally_add(job->tally->friction, g, loss.friction);
    if (f.ledger && (damped(f) || f.jkr))
        tally_add(job->tally->viscous, g, loss.viscous);
    if (f.ledger && f.bonded)
        tally_add(job->tally->broken, g, loss.broken);
    if (wall && f.reaction)
        store3(c->reaction, at, force);
    force = scale3(force, wide_all(job->kick));
    put3(batch, AT_FORCE, g, force);
    if (wall && f.moving && f.ledger) {
        wide work = dot3(force, get3(batch, AT_WALL, g));
        if (turns(f))
            work = wide_fma(wide_all(job->kick), power, work);
        tally_add(job->tally->work, g, work);
    }
}

/// The law of `count` contacts from the place `from`.
DEM_INLINE void contact_laws(const dem_features f, const dem_rows *rows, const dem_contact_job *job,
                             const contact_numbers *numbers, size_t from, size_t count, contact_batch *batch,
                             const bool wall, const bool record)
{
    for (size_t g = 0; g < count; g += DEM_WIDTH) {
        contact_state s = contact_press(f, rows, job, numbers, from + g, g, batch, wall, record);
        if (in_halves(f, record))
            put_state(f, batch, g, &s);
        else
            contact_hold(f, job, &s, from + g, g, batch, wall, record);
    }
    for (size_t g = 0; g < count && in_halves(f, record); g += DEM_WIDTH) {
        contact_state s = get_state(f, numbers, batch, g);
        contact_hold(f, job, &s, from + g, g, batch, wall, record);
    }
}

/// Adds the impulse to the momenta of the first bodies, or takes it from those of the second.
DEM_INLINE void scatter(const dem_features f, const dem_rows *rows, const contact_batch *batch, size_t g,
                        const uint32_t *row, const bool second)
{
    wide3 impulse = get3(batch, AT_FORCE, g), moment = cross3(get3(batch, second ? AT_B : AT_A, g), impulse);
    wide strain = wide_all(0), bound = strain;
    if (turns(f))
        moment = along3(moment, wide_all(1), get3(batch, AT_MOMENT, g));
    if (f.watch)
        strain = wide_load(batch->at[AT_STRAIN] + g) * wide_load(batch->at[second ? AT_LEAST_B : AT_LEAST_A] + g);
    if (f.watch && turns(f))
        strain = wide_fma(wide_load(batch->at[AT_TURN_STRAIN] + g),
                          wide_load(batch->at[second ? AT_BRISK_B : AT_BRISK_A] + g), strain);
    if (f.roll_bound)
        bound = wide_load(batch->at[AT_BOUND] + g);
    if (second) {
        strain = wide_all(0) - strain;
        bound = wide_all(0) - bound;
    }
    wide columns[8] = {impulse.x, impulse.y, impulse.z, moment.x, moment.y, moment.z, strain, bound};
    rows_add(rows->momentum, row, columns, second);
}

DEM_INLINE void wall_side(const dem_features f, const dem_rows *rows, const dem_contact_columns *c,
                          const dem_wall_form form, size_t from, size_t count, contact_batch *batch, double *largest)
{
    for (size_t g = 0; g < count; g += DEM_WIDTH)
        wall_geometry(f, rows, c, form, from + g, g, batch, largest);
    for (size_t g = 0; g < count; g += DEM_WIDTH)
        wall_velocity(f, rows, c, from + g, g, batch);
}

DEM_INLINE void pair_sides(const dem_features f, const dem_rows *rows, const dem_contact_columns *c, size_t from,
                           size_t count, contact_batch *batch, double *largest)
{
    for (size_t g = 0; g < count; g += DEM_WIDTH)
        pair_first(f, rows, c, from + g, g, batch);
    for (size_t g = 0; g < count; g += DEM_WIDTH)
        pair_second(f, rows, c, from + g, g, batch);
    for (size_t g = 0; g < count; g += DEM_WIDTH)
        pair_geometry(f, rows, c, from + g, g, batch, largest);
    for (size_t g = 0; g < count; g += DEM_WIDTH)
        pair_velocity(f, rows, c, from + g, g, batch);
    for (size_t g = 0; g < count && needs_mass(f) && f.local_mass; g += DEM_WIDTH)
        pair_mass(f, rows, c, from + g, g, batch);
}

DEM_INLINE void fetch_body(const dem_rows *rows, size_t row, size_t target)
{
    const double *body = rows->bodies + 16 * row;
    __builtin_prefetch(body);
    __builtin_prefetch(body + 8);
    __builtin_prefetch(rows->momentum + 8 * target, 1);
}

// The bodies of the batch to come, while this one is at work. A batch has nearly all bodies a of a list: these are new
// in the next list alone. All contacts of 16000 bodies take 20 % less, of 260000 25 %, of 1000 the same.
DEM_INLINE void fetch_ahead(const dem_rows *rows, const dem_contact_job *job, size_t from)
{
    const dem_contact_columns *c = &job->columns;
    bool beyond = from >= job->end;
    size_t begin = beyond ? job->next : from, end = beyond ? job->next_end : job->end;
    end = end - begin < BATCH ? end : begin + BATCH;
    for (size_t k = begin; k < end; k++)
        fetch_body(rows, c->b[k], c->target[k]);
    for (size_t k = begin; k < end && beyond; k++)
        fetch_body(rows, c->a[k], c->a[k]);
}

DEM_INLINE void contact_batches(const dem_features f, const dem_rows *given_rows, const dem_contact_job *given,
                                const bool wall, const dem_wall_form form, const bool record)
{
    // copies, which no column can lie over, so that they and what follows from them are not read again at each turn
    const dem_rows own_rows = *given_rows, *rows = &own_rows;
    dem_tally tally = *given->tally;
    dem_contact_job own = *given;
    own.tally = &tally;
    const dem_contact_job *job = &own;
    const dem_contact_columns *c = &job->columns;
    contact_numbers numbers;
    if (!f.mixed)
        numbers = load_law(f, rows, job, NULL);
    contact_batch batch;
    double largest = tally.overlap_ratio;
    for (size_t from = job->begin; from < job->end; from += BATCH) {
        size_t count = job->end - from < BATCH ? job->end - from : BATCH;
        if (wall)
            wall_side(f, rows, c, form, from, count, &batch, &largest);
        else
            pair_sides(f, rows, c, from, count, &batch, &largest);
        if (!wall && !record && job->next < job->next_end)
            fetch_ahead(rows, job, from + BATCH);
        for (size_t g = 0; g < count && (f.friction || f.bonded); g += DEM_WIDTH)
            contact_spring(job, from + g, g, &batch);
        // asked outside of the loop: as a part of its condition it costs every kernel one in a hundred instructions
        if (!f.user || f.linear || f.hertz)
            contact_laws(f, rows, job, &numbers, from, count, &batch, wall, record);
#ifdef DEM_USER_LAW
        user_forces(f, rows, job, from, count, &batch, wall, record);
#endif
        if (record)
            continue;
        for (size_t block = 0; block < count; block += DEM_BLOCK_LANES) {
            for (size_t g = block; g < block + DEM_BLOCK_LANES; g += DEM_WIDTH)
                scatter(f, rows, &batch, g, c->a + from + g, false);
            for (size_t g = block; g < block + DEM_BLOCK_LANES && !wall; g += DEM_WIDTH)
                scatter(f, rows, &batch, g, c->target + from + g, true);
        }
    }
    tally.overlap_ratio = largest;
    *given->tally = tally;
}

#endif
