/// The forces of a law of the user's, a batch at a time, for contact.h: remembered vectors turn, the law runs as a loop
/// of plain numbers, and what it says is weighed and summed up.
#ifndef DEM_SIM_USER_FORCES_H
#define DEM_SIM_USER_FORCES_H

#include "dem/law.h"
#include "sim/contact_geometry.h"

_Static_assert(DEM_USER_COLUMNS == 3 * DEM_LAW_VECTORS + DEM_LAW_NUMBERS, "room for what laws remember");

// what the plain loop hands on beside the rows of the batch
typedef struct user_batch {
    double vector[3 * DEM_LAW_VECTORS][BATCH] __attribute__((aligned(64)));
    double number[DEM_LAW_NUMBERS][BATCH] __attribute__((aligned(64)));
    double force[3][BATCH] __attribute__((aligned(64)));   // on a [N]
    double moment[3][BATCH] __attribute__((aligned(64)));  // on a [N m]
    double stored[BATCH], slid[BATCH], push[BATCH] __attribute__((aligned(64)));
    double stiffness[BATCH], slide_stiffness[BATCH], strain[BATCH], turn_strain[BATCH], on[BATCH];
    double hardness[BATCH];  // spring and dashpot over a step, as contact_law has it
} user_batch;

DEM_INLINE wide3 user_vector(double (*rows)[BATCH], size_t g)
{
    return (wide3){wide_load(rows[0] + g), wide_load(rows[1] + g), wide_load(rows[2] + g)};
}

DEM_INLINE void user_recall(const dem_features f, const dem_contact_job *job, size_t from, size_t count,
                            const contact_batch *batch, user_batch *u)
{
    double *const *memory = job->columns.user;
    wide step = wide_all(job->last_step);
    for (size_t g = 0; g < count; g += DEM_WIDTH) {
        for (int k = 0; k < f.user_vectors; k++) {
            wide turn = step * wide_load(batch->at[AT_TURN] + g);
            wide3 v = spring_turn(load3(memory + 3 * k, from + g), get3(batch, AT_NORMAL, g), turn);
            wide_store(u->vector[3 * k] + g, v.x);
            wide_store(u->vector[3 * k + 1] + g, v.y);
            wide_store(u->vector[3 * k + 2] + g, v.z);
        }
        for (int k = 0; k < f.user_numbers; k++)
            wide_store(u->number[k] + g, wide_load(memory[3 * f.user_vectors + k] + from + g));
    }
}

/// One lane; it is of the user's law, or not `mine`. All of it is made into vector code, so what does not touch is
/// computed and then left out.
DEM_INLINE void user_lane(const dem_features f, const double *parameters, double step, double next_step,
                          const contact_batch *batch, user_batch *u, size_t i, bool mine, const bool wall)
{
    dem_law_memory m = {0};
    for (int k = 0; k < f.user_vectors; k++)
        m.vector[k] = (dem_vec3){u->vector[3 * k][i], u->vector[3 * k + 1][i], u->vector[3 * k + 2][i]};
    for (int k = 0; k < f.user_numbers; k++)
        m.number[k] = u->number[k][i];
    dem_vec3 n = {batch->at[AT_NORMAL][i], batch->at[AT_NORMAL + 1][i], batch->at[AT_NORMAL + 2][i]};
    dem_vec3 v = {batch->at[AT_VELOCITY][i], batch->at[AT_VELOCITY + 1][i], batch->at[AT_VELOCITY + 2][i]};
    double overlap = batch->at[AT_OVERLAP][i], vn = dem_law_dot(v, n);
    dem_law_contact c = {.overlap = overlap,
                         .overlap_before = overlap + vn * step,
                         .normal = n,
                         .vn = vn,
                         .slip = dem_law_along(v, -vn, n),
                         .radius_a = batch->at[AT_RADIUS_A][i],
                         .radius_b = wall ? INFINITY : batch->at[AT_RADIUS_B][i],
                         .reduced = batch->at[AT_REDUCED][i],
                         .mass = 1 / batch->at[AT_MASS][i],
                         .inverse_mass = batch->at[AT_MASS][i],
                         .step = step,
                         .next_step = next_step};
    if (f.user_turns)
        c.spin = (dem_vec3){batch->at[AT_SPIN][i], batch->at[AT_SPIN + 1][i], batch->at[AT_SPIN + 2][i]};
    dem_law_forces s = dem_user_law(&c, parameters, &m);
    bool on = overlap > 0;
    if (f.user_reaches)
        on = s.holds & (overlap > -dem_user_reach(parameters, c.reduced));
    on = on & mine;
    u->force[0][i] = on ? s.slide.x - s.push * n.x : 0;
    u->force[1][i] = on ? s.slide.y - s.push * n.y : 0;
    u->force[2][i] = on ? s.slide.z - s.push * n.z : 0;
    if (f.user_turns) {
        u->moment[0][i] = on ? s.moment.x : 0;
        u->moment[1][i] = on ? s.moment.y : 0;
        u->moment[2][i] = on ? s.moment.z : 0;
    }
    u->on[i] = on ? 1 : 0;
    u->push[i] = on ? s.push : 0;
    u->stored[i] = on ? s.stored : 0;
    u->slid[i] = on ? s.slid : 0;
    u->stiffness[i] = s.stiffness;
    u->slide_stiffness[i] = s.slide_stiffness;
    if (wall && f.reaction)
        u->hardness[i] = on ? s.stiffness + s.damping / next_step : 0;
    double k = s.stiffness + 2 * s.slide_stiffness, d = s.damping + 2 * s.slide_damping, times = wall ? 1 : 2;
    u->strain[i] = on ? times * next_step * (next_step * k + 2 * d) : 0;
    if (f.user_turns)
        u->turn_strain[i] = on ? times * next_step * 3 * (next_step * s.turn_stiffness + 2 * s.turn_damping) : 0;
    for (int k3 = 0; k3 < f.user_vectors; k3++) {
        u->vector[3 * k3][i] = on ? m.vector[k3].x : 0;
        u->vector[3 * k3 + 1][i] = on ? m.vector[k3].y : 0;
        u->vector[3 * k3 + 2][i] = on ? m.vector[k3].z : 0;
    }
    for (int k1 = 0; k1 < f.user_numbers; k1++)
        u->number[k1][i] = on ? m.number[k1] : 0;
}

DEM_INLINE void user_lanes(const dem_features f, const dem_rows *rows, const dem_contact_job *job, size_t from,
                           size_t count, const contact_batch *batch, user_batch *u, const bool wall)
{
    const double step = job->last_step, next_step = job->next_step, *all = rows->parameters, *laws = rows->laws;
    const uint32_t *row = job->columns.law + from;
    if (f.mixed) {
#pragma omp simd
        for (size_t i = 0; i < count; i++)
            user_lane(f, all + DEM_LAW_PARAMETERS * (size_t)row[i], step, next_step, batch, u, i,
                      laws[LAW_SLOTS * (size_t)row[i] + LAW_USER] > 0, wall);
        return;
    }
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        user_lane(f, all, step, next_step, batch, u, i, true, wall);
}

DEM_INLINE void user_records(const dem_features f, const contact_batch *batch, const user_batch *u, size_t count,
                             const double *shares, dem_contact_record *records)
{
    for (size_t i = 0; i < count; i++) {
        dem_contact_record *r = &records[i];
        if (!(u->on[i] > 0))
            continue;
        double share = shares ? shares[i] : 1;
        r->touches = true;
        r->overlap = batch->at[AT_OVERLAP][i];
        for (int k = 0; k < 3; k++) {
            r->normal[k] = batch->at[AT_NORMAL + k][i];
            r->point_a[k] = batch->at[AT_A + k][i];
            r->point_b[k] = batch->at[AT_B + k][i];
            r->force[k] = u->force[k][i] * share;
            r->turning[k] = f.user_turns ? u->moment[k][i] * share : 0;
        }
        r->normal_force = u->push[i] * share;
        r->elastic_normal = u->stored[i] * share;
        r->elastic_slide = r->elastic_turn = 0;
        r->stiffness = u->stiffness[i] * share;
        r->slide_stiffness = u->slide_stiffness[i];
        r->reduced_mass = 1 / batch->at[AT_MASS][i];
    }
}

typedef struct user_loss {
    wide slid, other;  // since the last step [J]
} user_loss;

/// What went into the contact by the mean force of two steps, and is not stored in it, is lost.
DEM_INLINE user_loss user_lost(const dem_features f, const dem_contact_job *job, size_t at, size_t g,
                               const contact_batch *batch, user_batch *u, const bool record)
{
    double *const *was = job->columns.user_was;
    wide3 force = user_vector(u->force, g), before = load3(was, at), v = get3(batch, AT_VELOCITY, g);
    wide power = dot3((wide3){force.x + before.x, force.y + before.y, force.z + before.z}, v);
    wide stored = wide_load(u->stored + g), slid = wide_load(u->slid + g);
    if (f.user_turns) {
        wide3 moment = user_vector(u->moment, g), last = load3(was + 3, at), spin = get3(batch, AT_SPIN, g);
        power = power + dot3((wide3){moment.x + last.x, moment.y + last.y, moment.z + last.z}, spin);
        if (!record)
            store3(was + 3, at, moment);
    }
    // at the start nothing has passed
    wide begun = wide_all(job->last_step > 0 ? 1 : 0);
    wide lost = wide_fma(wide_all(0.5 * job->last_step), power, wide_load(was[6] + at) - stored) * begun;
    slid = slid * begun;
    if (!record) {
        store3(was, at, force);
        wide_store(was[6] + at, stored);
    }
    return (user_loss){slid, lost - slid};
}

DEM_INLINE void user_strain(double *at, const double *more, const bool others)
{
    wide strain = wide_load(more);
    if (others)
        strain = strain + wide_load(at);
    wide_store(at, strain);
}

DEM_INLINE void user_reaction(const dem_contact_columns *c, size_t at, wide3 force, wide hardness, const bool others)
{
    if (others) {
        force = along3(load3(c->reaction, at), wide_all(1), force);
        hardness = hardness + wide_load(c->hardness + at);
    }
    store3(c->reaction, at, force);
    wide_store(c->hardness + at, hardness);
}

/// Adds to what the built-in laws have said, where a scene has some of these too; their share of a user's row is 0.
DEM_INLINE void user_forces(const dem_features f, const dem_rows *rows, const dem_contact_job *job, size_t from,
                            size_t count, contact_batch *batch, const bool wall, const bool record)
{
    const bool others = f.linear || f.hertz;
    const dem_contact_columns *c = &job->columns;
    user_batch u;
    user_recall(f, job, from, count, batch, &u);
    user_lanes(f, rows, job, from, count, batch, &u, wall);
    dem_contact_record *records = record ? job->records + (from - job->begin) : NULL;
    if (record && !others)
        memset(records, 0, count * sizeof *records);
    for (size_t g = 0; g < count; g += DEM_WIDTH) {
        wide3 force = user_vector(u.force, g), moment = force;
        if (f.user_turns)
            moment = user_vector(u.moment, g);
        wide weight = f.weighted ? wide_load(c->weight + from + g) : wide_all(1), power = wide_all(0);
        user_loss loss = {power, power};
        if (f.ledger)
            loss = user_lost(f, job, from + g, g, batch, &u, record);
        if (wall && f.moving) {
            power = dot3(force, get3(batch, AT_WALL, g));
            if (f.user_turns)
                power = power + dot3(moment, get3(batch, AT_WALL_SPIN, g));
        }
        if (f.weighted) {
            loss = (user_loss){loss.slid * weight, loss.other * weight};
            power = power * weight;
        }
        if (record) {
            double slid[DEM_WIDTH], other[DEM_WIDTH], work[DEM_WIDTH];
            wide_store(slid, loss.slid);
            wide_store(other, loss.other);
            wide_store(work, power);
            for (size_t i = 0; i < DEM_WIDTH; i++) {
                records[g + i].lost_friction += slid[i];
                records[g + i].lost_viscous += other[i];
                records[g + i].wall_power += work[i];
            }
            continue;
        }
        for (int k = 0; k < 3 * f.user_vectors; k++)
            wide_store(c->user[k] + from + g, wide_load(u.vector[k] + g));
        for (int k = 0; k < f.user_numbers; k++)
            wide_store(c->user[3 * f.user_vectors + k] + from + g, wide_load(u.number[k] + g));
        if (wall && f.reaction)
            user_reaction(c, from + g, scale3(force, weight), wide_load(u.hardness + g) * weight, others);
        wide kick = wide_all(job->kick) * weight;
        wide3 impulse = scale3(force, kick);
        put3(batch, AT_FORCE, g, others ? along3(get3(batch, AT_FORCE, g), wide_all(1), impulse) : impulse);
        if (f.user_turns)
            put3(batch, AT_MOMENT, g, others ? along3(get3(batch, AT_MOMENT, g), kick, moment) : scale3(moment, kick));
        if (f.watch)
            user_strain(batch->at[AT_STRAIN] + g, u.strain + g, others);
        if (f.watch && f.user_turns)
            user_strain(batch->at[AT_TURN_STRAIN] + g, u.turn_strain + g, others);
        if (f.ledger) {
            tally_add(job->tally->friction, g, loss.slid);
            tally_add(job->tally->viscous, g, loss.other);
        }
        if (f.ledger && wall && f.moving)
            tally_add(job->tally->work, g, power * wide_all(job->kick));
    }
    if (record)
        user_records(f, batch, &u, count, f.weighted ? c->weight + from : NULL, records);
}

#endif
