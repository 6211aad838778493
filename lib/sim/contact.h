/// The loop over contacts, for kernels.c: rows in, transpose, a law without branches, transpose, rows out.
///
/// A batch of contacts goes through four short loops by way of a buffer that stays in the first cache. Impulses are
/// added to the momenta directly, in blocks of 8: first all of the a side, then all of the b side, whatever the width.
#ifndef DEM_SIM_CONTACT_H
#define DEM_SIM_CONTACT_H

#include "sim/kernels.h"
#include "sim/law/adhesion.h"
#include "sim/law/turning.h"

enum { BATCH = 64 };

// what the loops hand on, by lane
enum {
    AT_NORMAL = 0,  // out of a
    AT_OVERLAP = 3,
    AT_A = 4,  // contact point from the centre of a, and of b
    AT_B = 7,
    AT_VELOCITY = 10,  // of b's surface over a's
    AT_TURN = 13,      // rate about the normal [rad/s]
    AT_MASS = 14,      // 1 / m_eff
    AT_REDUCED = 15,   // R*
    AT_AREA = 16,      // R_min^2 / (R_i + R_j)
    AT_FORCE = 17,     // on a
    AT_WALL = 20,      // velocity of the wall's surface
    AT_STRAIN = 23,    // of the time step, times the mass
    AT_LEAST_A = 24,   // 1 / least mass of a, and of b
    AT_LEAST_B = 25,
    AT_AREA_SHARED = 26,  // of the lens, over pi
    AT_VOLUME_SHARED = 27,
    AT_SPIN = 28,          // of b over a
    AT_MOMENT = 31,        // on a
    AT_ROLL_INERTIA = 34,  // 1 / I_r
    AT_BRISK_A = 35,       // 1 / least moment of a, and of b
    AT_BRISK_B = 36,
    AT_TURN_STRAIN = 37,  // of the time step, times the moment of inertia
    AT_WALL_SPIN = 38,
    AT_RADIUS = 41,  // the smaller one
    AT_BOUND = 42,   // of what is taken off the spin
    AT_COUNT = 43
};

typedef struct contact_batch {
    double at[AT_COUNT][BATCH] __attribute__((aligned(64)));
} contact_batch;

DEM_INLINE wide3 get3(const contact_batch *b, int at, size_t g)
{
    return (wide3){wide_load(b->at[at] + g), wide_load(b->at[at + 1] + g), wide_load(b->at[at + 2] + g)};
}
DEM_INLINE void put3(contact_batch *b, int at, size_t g, wide3 v)
{
    wide_store(b->at[at] + g, v.x);
    wide_store(b->at[at + 1] + g, v.y);
    wide_store(b->at[at + 2] + g, v.z);
}

/// R(q) v of the rows' quaternions q0..q3 = q[0..3]
DEM_INLINE wide3 turned(const wide q[4], wide3 v)
{
    wide3 u = {q[1], q[2], q[3]}, t = cross3(u, v);
    t = (wide3){t.x + t.x, t.y + t.y, t.z + t.z};
    v = along3(v, q[0], t);
    return (wide3){wide_fma(u.y, t.z, wide_fnma(u.z, t.y, v.x)), wide_fma(u.z, t.x, wide_fnma(u.x, t.z, v.y)),
                   wide_fma(u.x, t.y, wide_fnma(u.y, t.x, v.z))};
}
DEM_INLINE wide3 turned_back(const wide q[4], wide3 v)
{
    const wide back[4] = {q[0], wide_all(0) - q[1], wide_all(0) - q[2], wide_all(0) - q[3]};
    return turned(back, v);
}

typedef struct contact_side {
    wide pose[8];
    wide3 arm;  // centre of the sphere from that of the body, axes of space
    wide sphere[4];
} contact_side;

DEM_INLINE void load_side(const dem_features f, const dem_rows *rows, const uint32_t *body, const uint32_t *sphere,
                          contact_side *side)
{
    rows_load(rows->bodies, DEM_BODY_ROW, body, side->pose);
    rows_load4(rows->spheres, DEM_SPHERE_ROW, sphere, side->sphere);
    if (f.scaled)
        for (int k = 0; k < 4; k++)
            side->sphere[k] = side->sphere[k] * side->pose[7];
    wide zero = wide_all(0);
    side->arm = (wide3){zero, zero, zero};
    if (f.offset)
        side->arm = turned(side->pose + 3, (wide3){side->sphere[0], side->sphere[1], side->sphere[2]});
}

/// What the surface at the end of the arm adds to 1/m along n: (c x n)^T I^-1 (c x n).
DEM_INLINE wide inverse_local_mass(const dem_features f, const dem_rows *rows, const uint32_t *body,
                                   const contact_side *side, wide3 n)
{
    wide inertia[4];
    rows_load4(rows->inertia, DEM_ROW, body, inertia);
    wide sum = inertia[0];
    if (f.offset) {
        wide3 own = turned_back(side->pose + 3, n);
        wide3 c = cross3((wide3){side->sphere[0], side->sphere[1], side->sphere[2]}, own);
        sum = wide_fma(c.x * c.x, inertia[1], wide_fma(c.y * c.y, inertia[2], wide_fma(c.z * c.z, inertia[3], sum)));
    }
    return sum;
}

DEM_INLINE bool damped(const dem_features f)
{
    return f.rate || f.restitution;
}
DEM_INLINE bool turns(const dem_features f)
{
    return f.rolling || f.roll_constant || f.twisting || f.twist_constant;
}
DEM_INLINE bool adheres(const dem_features f)
{
    return f.sjkr || f.dmt;
}
DEM_INLINE bool needs_reduced(const dem_features f)
{
    return f.hertz || turns(f) || f.dmt;
}

/// 1 / (I + m r^2) of a body that rolls on a surface of radius r, with its mean moment I, and 1 / its least moment.
DEM_INLINE wide inverse_rolling(const dem_rows *rows, const uint32_t *body, wide radius, wide *brisk)
{
    wide inertia[8];
    rows_load(rows->inertia, DEM_ROW, body, inertia);
    wide mean = (inertia[1] + inertia[2] + inertia[3]) * wide_all(1.0 / 3);
    *brisk = wide_max(inertia[1], wide_max(inertia[2], inertia[3]));
    return inertia[0] * mean / wide_fma(radius * radius, mean, inertia[0]);
}

/// Remembers the largest overlap over the smaller radius; rarely a new one.
DEM_INLINE void note_overlap(double *largest, wide overlap, wide radius)
{
    unsigned bits = wide_bits(wide_less(wide_all(*largest) * radius, overlap));
    if (__builtin_expect(bits != 0, 0)) {
        double d[DEM_WIDTH], r[DEM_WIDTH];
        wide_store(d, overlap);
        wide_store(r, radius);
        for (int i = 0; i < DEM_WIDTH; i++)
            if (d[i] > *largest * r[i])
                *largest = d[i] / r[i];
    }
}

DEM_INLINE void put_lens(contact_batch *batch, size_t g, lens shared)
{
    wide_store(batch->at[AT_AREA_SHARED] + g, shared.area);
    wide_store(batch->at[AT_VOLUME_SHARED] + g, shared.volume);
}

DEM_INLINE void pair_geometry(const dem_features f, const dem_rows *rows, const dem_contact_columns *c, size_t at,
                              size_t g, contact_batch *batch, double *largest)
{
    contact_side a, b;
    load_side(f, rows, c->a + at, c->sphere_a + at, &a);
    load_side(f, rows, c->b + at, c->sphere_b + at, &b);
    wide3 d = {b.pose[0] - a.pose[0], b.pose[1] - a.pose[1], b.pose[2] - a.pose[2]};
    if (f.periodic) {
        wide shift[4];
        rows_load4(rows->shifts, 4, c->shift + at, shift);
        d = (wide3){d.x + shift[0], d.y + shift[1], d.z + shift[2]};
    }
    if (f.offset)
        d = (wide3){d.x + (b.arm.x - a.arm.x), d.y + (b.arm.y - a.arm.y), d.z + (b.arm.z - a.arm.z)};
    wide distance = wide_sqrt(dot3(d, d) + wide_all(1e-300));
    wide overlap = a.sphere[3] + b.sphere[3] - distance, half = wide_all(0.5) * overlap;
    wide3 n = scale3(d, wide_all(1) / distance);
    put3(batch, AT_NORMAL, g, n);
    wide_store(batch->at[AT_OVERLAP] + g, overlap);
    put3(batch, AT_A, g, along3(a.arm, a.sphere[3] - half, n));
    put3(batch, AT_B, g, along3(b.arm, half - b.sphere[3], n));
    note_overlap(largest, overlap, wide_min(a.sphere[3], b.sphere[3]));
    if (damped(f) && f.local_mass)
        wide_store(batch->at[AT_MASS] + g,
                   inverse_local_mass(f, rows, c->a + at, &a, n) + inverse_local_mass(f, rows, c->b + at, &b, n));
    if (needs_reduced(f))
        wide_store(batch->at[AT_REDUCED] + g, reduced_radius(a.sphere[3], b.sphere[3]));
    if (f.young) {
        wide least = wide_min(a.sphere[3], b.sphere[3]);
        wide_store(batch->at[AT_AREA] + g, least * least / (a.sphere[3] + b.sphere[3]));
    }
    if (f.sjkr)
        put_lens(batch, g, lens_of_balls(a.sphere[3], b.sphere[3], distance, overlap));
    if (f.roll_bound)
        wide_store(batch->at[AT_RADIUS] + g, wide_min(a.sphere[3], b.sphere[3]));
    if (turns(f)) {
        wide brisk_a, brisk_b,
            inverse = inverse_rolling(rows, c->a + at, a.sphere[3], &brisk_a) +
                      inverse_rolling(rows, c->b + at, b.sphere[3], &brisk_b);
        wide_store(batch->at[AT_ROLL_INERTIA] + g, inverse);
        wide_store(batch->at[AT_BRISK_A] + g, brisk_a);
        wide_store(batch->at[AT_BRISK_B] + g, brisk_b);
    }
}

DEM_INLINE void pair_velocity(const dem_features f, const dem_rows *rows, const dem_contact_columns *c, size_t at,
                              size_t g, contact_batch *batch)
{
    wide a[8], b[8];
    rows_load(rows->bodies + 8, DEM_BODY_ROW, c->a + at, a);
    rows_load(rows->bodies + 8, DEM_BODY_ROW, c->b + at, b);
    wide3 p = get3(batch, AT_A, g), q = get3(batch, AT_B, g);
    wide3 spin_a = {a[3], a[4], a[5]}, spin_b = {b[3], b[4], b[5]};
    wide3 va = cross3(spin_a, p), vb = cross3(spin_b, q);
    put3(batch, AT_VELOCITY, g,
         (wide3){(b[0] - a[0]) + (vb.x - va.x), (b[1] - a[1]) + (vb.y - va.y), (b[2] - a[2]) + (vb.z - va.z)});
    if (turns(f))
        put3(batch, AT_SPIN, g, (wide3){b[3] - a[3], b[4] - a[4], b[5] - a[5]});
    if (f.friction || f.rolling)
        wide_store(batch->at[AT_TURN] + g,
                   wide_all(0.5) * dot3((wide3){a[3] + b[3], a[4] + b[4], a[5] + b[5]}, get3(batch, AT_NORMAL, g)));
    if (damped(f) && !f.local_mass)
        wide_store(batch->at[AT_MASS] + g, a[6] + b[6]);
    if (f.watch) {
        wide_store(batch->at[AT_LEAST_A] + g, a[7]);
        wide_store(batch->at[AT_LEAST_B] + g, b[7]);
    }
}

/// Walls by form. The normal points from the body into the wall; the contact point is the wall's nearest.
DEM_INLINE void wall_geometry(const dem_features f, const dem_rows *rows, const dem_contact_columns *c,
                              const dem_wall_form form, size_t at, size_t g, contact_batch *batch, double *largest)
{
    contact_side a;
    load_side(f, rows, c->a + at, c->sphere_a + at, &a);
    wide3 n, point;
    wide overlap;
    if (form == DEM_FORM_MESH) {
        n = (wide3){wide_load(c->geometry[0] + at), wide_load(c->geometry[1] + at), wide_load(c->geometry[2] + at)};
        overlap = wide_load(c->geometry[3] + at);
        point = (wide3){wide_load(c->geometry[4] + at), wide_load(c->geometry[5] + at), wide_load(c->geometry[6] + at)};
    } else {
        wide wall[8];
        rows_load(rows->walls, 16, c->sphere_b + at, wall);
        wide3 x = {a.pose[0] + a.arm.x, a.pose[1] + a.arm.y, a.pose[2] + a.arm.z};
        wide distance;
        if (form == DEM_FORM_PLANE) {
            n = (wide3){wide_all(0) - wall[0], wide_all(0) - wall[1], wide_all(0) - wall[2]};
            distance = wide_all(0) - (dot3(x, n) + wall[3]);
        } else {
            // wall[3]: the radius, negative where the bodies are outside
            wide3 from = {x.x - wall[4], x.y - wall[5], x.z - wall[6]}, axis = {wall[0], wall[1], wall[2]};
            wide3 out = along3(from, wide_all(0) - dot3(from, axis), axis);
            wide r = wide_sqrt(dot3(out, out) + wide_all(1e-300));
            wide side = wide_select(wide_less(wall[3], wide_all(0)), wide_all(-1), wide_all(1));
            n = scale3(out, side / r);
            distance = wall[3] - side * r;
        }
        overlap = a.sphere[3] - distance;
        point = along3(a.arm, distance, n);
    }
    put3(batch, AT_NORMAL, g, n);
    wide_store(batch->at[AT_OVERLAP] + g, overlap);
    put3(batch, AT_A, g, point);
    note_overlap(largest, overlap, a.sphere[3]);
    if (damped(f) && f.local_mass)
        wide_store(batch->at[AT_MASS] + g, inverse_local_mass(f, rows, c->a + at, &a, n));
    if (needs_reduced(f))
        wide_store(batch->at[AT_REDUCED] + g, a.sphere[3]);
    if (f.young)
        wide_store(batch->at[AT_AREA] + g, a.sphere[3]);
    if (f.sjkr)
        put_lens(batch, g, lens_at_wall(a.sphere[3], overlap));
    if (f.roll_bound)
        wide_store(batch->at[AT_RADIUS] + g, a.sphere[3]);
    if (turns(f)) {
        wide brisk;
        wide_store(batch->at[AT_ROLL_INERTIA] + g, inverse_rolling(rows, c->a + at, a.sphere[3], &brisk));
        wide_store(batch->at[AT_BRISK_A] + g, brisk);
    }
}

DEM_INLINE void wall_velocity(const dem_features f, const dem_rows *rows, const dem_contact_columns *c, size_t at,
                              size_t g, contact_batch *batch)
{
    wide a[8];
    rows_load(rows->bodies + 8, DEM_BODY_ROW, c->a + at, a);
    wide3 spin = {a[3], a[4], a[5]}, p = get3(batch, AT_A, g), v = cross3(spin, p);
    v = (wide3){wide_all(0) - (a[0] + v.x), wide_all(0) - (a[1] + v.y), wide_all(0) - (a[2] + v.z)};
    wide3 turning = spin, over = {wide_all(0) - spin.x, wide_all(0) - spin.y, wide_all(0) - spin.z};
    if (f.moving) {
        wide wall[8], pose[4];
        rows_load(rows->walls + 8, 16, c->sphere_b + at, wall);
        rows_load4(rows->bodies, DEM_BODY_ROW, c->a + at, pose);
        // wall: velocity of the point that passes the origin, then angular velocity
        wide3 x = {pose[0] + p.x, pose[1] + p.y, pose[2] + p.z}, spin_wall = {wall[3], wall[4], wall[5]};
        wide3 w = cross3(spin_wall, x);
        w = (wide3){wall[0] + w.x, wall[1] + w.y, wall[2] + w.z};
        v = (wide3){v.x + w.x, v.y + w.y, v.z + w.z};
        turning = (wide3){spin.x + spin_wall.x, spin.y + spin_wall.y, spin.z + spin_wall.z};
        put3(batch, AT_WALL, g, w);
        over = (wide3){spin_wall.x - spin.x, spin_wall.y - spin.y, spin_wall.z - spin.z};
        if (turns(f))
            put3(batch, AT_WALL_SPIN, g, spin_wall);
    }
    put3(batch, AT_VELOCITY, g, v);
    if (turns(f))
        put3(batch, AT_SPIN, g, over);
    if (f.friction || f.rolling)
        wide_store(batch->at[AT_TURN] + g, wide_all(0.5) * dot3(turning, get3(batch, AT_NORMAL, g)));
    if (damped(f) && !f.local_mass)
        wide_store(batch->at[AT_MASS] + g, a[6]);
    if (f.watch)
        wide_store(batch->at[AT_LEAST_A] + g, a[7]);
}

DEM_INLINE void load_law(const dem_features f, const dem_rows *rows, const uint32_t *row, wide law[LAW_SLOTS])
{
    const bool more = turns(f) || adheres(f) || f.roll_bound || f.jkr;
    if (f.mixed) {
        for (int k = 0; k < (more ? LAW_SLOTS : LAW_MORE); k += 8)
            rows_load(rows->laws + k, LAW_SLOTS, row, law + k);
        return;
    }
    // in two short loops, which compilers unroll, so that what is not needed is not even loaded
    for (int k = 0; k < LAW_MORE; k++)
        law[k] = wide_all(rows->laws[k]);
    for (int k = LAW_MORE; more && k < LAW_SLOTS; k++)
        law[k] = wide_all(rows->laws[k]);
}

/// Sums in lanes of 8 whatever the width.
DEM_INLINE void tally_add(double sum[DEM_BLOCK_LANES], size_t g, wide x)
{
    double *lane = sum + g % DEM_BLOCK_LANES;
    wide_store(lane, wide_load(lane) + x);
}

// energy dissipated since the last step [J]
typedef struct contact_loss {
    wide friction, viscous;
} contact_loss;

// power of a moving wall [W], for measuring
DEM_INLINE void put_losses(const contact_loss *loss, wide power, size_t g, dem_contact_record *records)
{
    double friction[DEM_WIDTH], viscous[DEM_WIDTH], work[DEM_WIDTH];
    wide_store(friction, loss->friction);
    wide_store(viscous, loss->viscous);
    wide_store(work, power);
    for (size_t i = 0; i < DEM_WIDTH; i++) {
        records[g + i].lost_friction = friction[i];
        records[g + i].lost_viscous = viscous[i];
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
DEM_INLINE wide contact_strain(const dem_features f, const wide *law, const normal_law *n, wide mass, wide step,
                               const bool wall)
{
    wide k = n->stiffness, c = wide_all(0);
    if (f.friction) {
        wide slide = wide_fma(law[LAW_SLIDE_RATIO], k, law[LAW_SLIDE_STIFFNESS]);
        if (f.mindlin)
            slide = wide_fma(law[LAW_SLIDE_HERTZ], n->radius, slide);
        k = wide_fma(wide_all(2), slide, k);
        if (f.slide_damping && f.rate)
            c = wide_all(2) * (law[LAW_SLIDE_RATE] * mass);
        if (f.slide_damping && f.restitution)
            c = wide_fma(wide_all(2) * law[LAW_SLIDE_ZETA], wide_sqrt(slide * mass), c);
    }
    if (f.rate)
        c = wide_fma(law[LAW_RATE], mass, c);
    if (f.restitution)
        c = wide_fma(law[LAW_ZETA], wide_sqrt(n->stiffness * mass), c);
    return wide_all(wall ? 1 : 2) * (step * wide_fma(step, k, c + c));
}

DEM_INLINE wide3 load3(double *const column[3], size_t at)
{
    return (wide3){wide_load(column[0] + at), wide_load(column[1] + at), wide_load(column[2] + at)};
}
DEM_INLINE void store3(double *const column[3], size_t at, wide3 v)
{
    wide_store(column[0] + at, v.x);
    wide_store(column[1] + at, v.y);
    wide_store(column[2] + at, v.z);
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
DEM_INLINE wide_mask jkr_holds(const wide *law, wide reduced, wide overlap, wide attached, wide *gone, wide *held)
{
    wide modulus = wide_all(0.5) * law[LAW_HERTZ], k = jkr_softness(law[LAW_JKR], modulus, reduced), end;
    *held = jkr(k, modulus, reduced, jkr_parting(k, &end)).energy;
    *gone = wide_fnma(end, reduced, overlap);
    return wide_less(wide_or_zero(wide_less(wide_all(0), attached), end * reduced), overlap);
}

DEM_INLINE void contact_law(const dem_features f, const dem_rows *rows, const dem_contact_job *job, size_t at, size_t g,
                            contact_batch *batch, const bool wall, const bool record)
{
    const dem_contact_columns *c = &job->columns;
    wide law[LAW_SLOTS], zero = wide_all(0), reduced = zero;
    load_law(f, rows, f.mixed ? c->law + at : NULL, law);
    wide overlap = wide_load(batch->at[AT_OVERLAP] + g);
    wide_mask on = wide_less(zero, overlap);
    wide held = zero, gone = overlap;
    if (needs_reduced(f))
        reduced = wide_load(batch->at[AT_REDUCED] + g);
    if (f.jkr)
        on = jkr_holds(law, reduced, overlap, wide_load(c->attached + at), &gone, &held);
    wide3 n = get3(batch, AT_NORMAL, g), v = get3(batch, AT_VELOCITY, g);
    // at the start nothing has passed; the step to come is as good
    wide per_step = wide_all(1 / (job->last_step > 0 ? job->last_step : job->next_step));
    wide vn = dot3(v, n), inverse_mass = zero, mass = zero, area = zero, step = wide_all(job->last_step);
    if (damped(f)) {
        inverse_mass = wide_load(batch->at[AT_MASS] + g);
        mass = wide_all(1) / inverse_mass;
    }
    if (f.young)
        area = wide_load(batch->at[AT_AREA] + g);
    normal_law normal = normal_elastic(f, law, overlap, reduced, area);
    normal_damp(f, law, &normal, inverse_mass, mass, gone, vn, step, per_step);

    wide weight = f.weighted ? wide_load(c->weight + at) : wide_all(1);
    wide3 force = {zero, zero, zero}, spring = force;
    wide slide = zero;
    wide slide_before = zero, slide_damping = zero;
    contact_loss loss = {zero, zero};
    if (f.friction) {
        wide turn = step * wide_load(batch->at[AT_TURN] + g);
        spring = spring_turn(load3(c->spring, at), n, turn);
        wide3 slip = along3(v, zero - vn, n);
        friction_law t = friction(f, law, &normal, reduced, overlap, vn, mass, spring, slip, step, on);
        force = t.force;
        spring = t.spring;
        slide = t.stiffness;
        slide_before = t.old_stiffness;
        slide_damping = t.damping;
        if (!record)
            store3(c->spring, at, spring);
        loss.friction = t.lost;
        if (f.ledger && f.slide_damping) {
            wide3 was = load3(c->dash, at);
            wide3 both = {was.x + t.dash.x, was.y + t.dash.y, was.z + t.dash.z};
            loss.viscous = wide_all(0.5) * step * dot3(both, slip);
            if (!record)
                store3(c->dash, at, t.dash);
        }
    }
    wide net = normal.force, pulled = zero;
    if (adheres(f)) {
        lens shared = {zero, zero};
        if (f.sjkr)
            shared = (lens){wide_load(batch->at[AT_AREA_SHARED] + g), wide_load(batch->at[AT_VOLUME_SHARED] + g)};
        adhesion_law pull = adhesion(f, law, shared, reduced, overlap);
        net = net - pull.force;
        pulled = pull.energy;
    }
    force = or_zero3(on, along3(force, zero - net, n));
    if (f.ledger && damped(f)) {
        wide now = wide_or_zero(on, normal.elastic - normal.force), was = wide_load(c->loss + at);
        loss.viscous = loss.viscous + wide_all(0.5) * (was + now) * (vn * step);
        if (!record)
            wide_store(c->loss + at, now);
    }
    if (f.jkr) {
        // what the jump together sets free, and what is held where they part, is lost
        wide was = wide_load(c->attached + at), now = wide_or_zero(on, wide_all(1));
        wide jumps = wide_or_zero(wide_less(was, now), zero - normal.energy);
        loss.viscous = loss.viscous + (jumps + wide_or_zero(wide_less(now, was), held));
        if (!record)
            wide_store(c->attached + at, now);
    }
    if (f.weighted) {
        force = scale3(force, weight);
        loss = (contact_loss){loss.friction * weight, loss.viscous * weight};
    }
    dem_contact_record *records = job->records + (at - g - job->begin);
    if (record)
        put_records(f, batch, g, &normal, net, pulled, &force, &spring, slide, mass, weight, on, records);
    wide power = zero;  // of a moving wall
    if (turns(f)) {
        wide before = wide_fma(vn, step, overlap), patch = normal.radius;
        if (!f.hertz)
            patch = wide_sqrt(reduced * wide_max(overlap, zero));
        turning_state s = {.n = n,
                           .reduced = reduced,
                           .patch = patch,
                           .patch_before = radius_before(f, &normal, reduced, overlap, before),
                           .step = step,
                           .slide = slide,
                           .slide_before = slide_before,
                           .slide_damping = slide_damping};
        contact_moment m = contact_turning(f, job, at, g, batch, law, &normal, &s, weight, on, wall, record);
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
    if (f.roll_bound) {
        wide bound = law[LAW_ROLL_BOUND] * wide_load(batch->at[AT_RADIUS] + g) * normal_grip(f, &normal) * weight;
        wide_store(batch->at[AT_BOUND] + g, wide_or_zero(on, bound * wide_all(job->kick)));
    }
    if (f.watch) {
        wide strain = contact_strain(f, law, &normal, mass, wide_all(job->next_step), wall);
        wide_store(batch->at[AT_STRAIN] + g, wide_or_zero(on, strain));
    }
    force = scale3(force, wide_all(job->kick));
    put3(batch, AT_FORCE, g, force);
    if (wall && f.moving && f.ledger) {
        wide work = dot3(force, get3(batch, AT_WALL, g));
        if (turns(f))
            work = wide_fma(wide_all(job->kick), power, work);
        tally_add(job->tally->work, g, work);
    }
}

/// `least`, `brisk`: lanes of the body's 1 / least mass and 1 / least moment; `sign`: of its share of the moment.
DEM_INLINE void scatter(const dem_features f, const dem_rows *rows, const contact_batch *batch, size_t g, int least,
                        int brisk, const uint32_t *row, wide3 impulse, wide3 arm, const double sign)
{
    wide3 moment = cross3(arm, impulse);
    wide strain = wide_all(0), bound = strain;
    if (turns(f))
        moment = along3(moment, wide_all(sign), get3(batch, AT_MOMENT, g));
    if (f.watch)
        strain = wide_load(batch->at[AT_STRAIN] + g) * wide_load(batch->at[least] + g);
    if (f.watch && turns(f))
        strain = wide_fma(wide_load(batch->at[AT_TURN_STRAIN] + g), wide_load(batch->at[brisk] + g), strain);
    if (f.roll_bound)
        bound = wide_load(batch->at[AT_BOUND] + g);
    wide columns[8] = {impulse.x, impulse.y, impulse.z, moment.x, moment.y, moment.z, strain, bound};
    rows_add(rows->momentum, row, columns);
}

DEM_INLINE void contact_batches(const dem_features f, const dem_rows *rows, const dem_contact_job *job, const bool wall,
                                const dem_wall_form form, const bool record)
{
    const dem_contact_columns *c = &job->columns;
    contact_batch batch;
    double largest = job->tally->overlap_ratio;
    for (size_t from = job->begin; from < job->end; from += BATCH) {
        size_t count = job->end - from < BATCH ? job->end - from : BATCH;
        for (size_t g = 0; g < count; g += DEM_WIDTH)
            if (wall)
                wall_geometry(f, rows, c, form, from + g, g, &batch, &largest);
            else
                pair_geometry(f, rows, c, from + g, g, &batch, &largest);
        for (size_t g = 0; g < count; g += DEM_WIDTH)
            if (wall)
                wall_velocity(f, rows, c, from + g, g, &batch);
            else
                pair_velocity(f, rows, c, from + g, g, &batch);
        for (size_t g = 0; g < count; g += DEM_WIDTH)
            contact_law(f, rows, job, from + g, g, &batch, wall, record);
        if (record)
            continue;
        for (size_t block = 0; block < count; block += DEM_BLOCK_LANES) {
            for (size_t g = block; g < block + DEM_BLOCK_LANES; g += DEM_WIDTH)
                scatter(f, rows, &batch, g, AT_LEAST_A, AT_BRISK_A, c->a + from + g, get3(&batch, AT_FORCE, g),
                        get3(&batch, AT_A, g), 1);
            if (wall)
                continue;
            for (size_t g = block; g < block + DEM_BLOCK_LANES; g += DEM_WIDTH) {
                wide3 force = get3(&batch, AT_FORCE, g);
                force = (wide3){wide_all(0) - force.x, wide_all(0) - force.y, wide_all(0) - force.z};
                scatter(f, rows, &batch, g, AT_LEAST_B, AT_BRISK_B, c->target + from + g, force, get3(&batch, AT_B, g),
                        -1);
            }
        }
    }
    job->tally->overlap_ratio = largest;
}

#endif
