/// What contacts see of bodies and walls, for contact.h: rows in, transposed; where they touch and how fast the surfaces
/// move over each other, handed on by lane.
#ifndef DEM_SIM_CONTACT_GEOMETRY_H
#define DEM_SIM_CONTACT_GEOMETRY_H

#include "sim/kernels.h"
#include "sim/law/adhesion.h"
#include "sim/law/friction.h"

enum { BATCH = 64 };  // 32 to 128 are within 4 % of it

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
    AT_RADIUS_A = 43,  // both
    AT_RADIUS_B = 44,
    AT_CENTRE = 45,    // of a
    AT_POSE_A = 48,    // turns of a and of b
    AT_POSE_B = 52,
    AT_SPRING = 56,       // turned with the contact
    AT_MASS_ITSELF = 59,  // m_eff (rate) and its root (restitution)
    AT_MASS_ROOT = 60,
    // between the halves of the law, partly where what geometry has used was
    AT_TRIAL = 45,  // friction without its cap
    AT_STRETCHED = 48,
    AT_PART = 51,  // that the cap leaves of it
    AT_CAP = 52,   // its square
    AT_DAMPING = 53,
    AT_NET = 54,   // normal force
    AT_LOST = 55,  // by it
    AT_SLIDE = 61,  // tangential stiffness, now and a step ago
    AT_OLD_SLIDE = 62,
    AT_COUNT = 63
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

/// Sums in lanes of 8 whatever the width.
DEM_INLINE void tally_add(double sum[DEM_BLOCK_LANES], size_t g, wide x)
{
    double *lane = sum + ((int)DEM_WIDTH == (int)DEM_BLOCK_LANES ? 0 : g % DEM_BLOCK_LANES);
    wide_store(lane, wide_load(lane) + x);
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
    wide3 u = {q[1], q[2], q[3]}, t = cross3(v, u);
    t = (wide3){t.x + t.x, t.y + t.y, t.z + t.z};
    v = along3(v, q[0], t);
    return (wide3){wide_fnma(u.y, t.z, wide_fma(u.z, t.y, v.x)), wide_fnma(u.z, t.x, wide_fma(u.x, t.z, v.y)),
                   wide_fnma(u.x, t.y, wide_fma(u.y, t.x, v.z))};
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

/// What the surface at the end of the arm adds to 1/m along n: (c x n)^T I^-1 (c x n), of the body's turn `q`.
DEM_INLINE wide inverse_local_mass(const dem_features f, const dem_rows *rows, const uint32_t *body, const wide q[4],
                                   wide3 arm, wide3 n)
{
    wide inertia[4];
    rows_load4(rows->inertia, DEM_ROW, body, inertia);
    wide sum = inertia[0];
    if (f.offset) {
        wide3 c = turned_back(q, cross3(arm, n));
        sum = wide_fma(c.x * c.x, inertia[1], wide_fma(c.y * c.y, inertia[2], wide_fma(c.z * c.z, inertia[3], sum)));
    }
    return sum;
}

DEM_INLINE bool damped(const dem_features f)
{
    return f.rate || f.restitution;
}
DEM_INLINE bool needs_mass(const dem_features f)
{
    return damped(f) || f.user;
}
/// The mass is made where the processor waits for rows, not where it waits for divisions.
DEM_INLINE void put_mass(const dem_features f, contact_batch *b, size_t g, wide inverse)
{
    wide_store(b->at[AT_MASS] + g, inverse);
    contact_mass m = contact_mass_of(f, inverse);
    if (f.rate)
        wide_store(b->at[AT_MASS_ITSELF] + g, m.mass);
    if (f.restitution)
        wide_store(b->at[AT_MASS_ROOT] + g, m.root);
}
DEM_INLINE contact_mass get_mass(const dem_features f, const contact_batch *b, size_t g)
{
    contact_mass m = {wide_load(b->at[AT_MASS] + g), wide_all(0), wide_all(0)};
    if (f.restitution) {
        m.root = wide_load(b->at[AT_MASS_ROOT] + g);
        m.mass = m.root * m.root;
    }
    if (f.rate)
        m.mass = wide_load(b->at[AT_MASS_ITSELF] + g);
    return m;
}
DEM_INLINE bool turns(const dem_features f)
{
    return features_turning(f);
}
DEM_INLINE bool adheres(const dem_features f)
{
    return f.sjkr || f.dmt;
}
DEM_INLINE bool needs_reduced(const dem_features f)
{
    return f.hertz || turns(f) || f.dmt || f.bonded || f.user;
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

/// One side of a pair: its arm, radius and, where it counts, its turn. The loops are short, so that the processor, which
/// looks about a hundred waiting instructions ahead, has several turns of each under way: 18 % of the pass. (Loops that
/// take the next turn of one step beside this turn of the next, or two turns at once, were slower; asking for the rows
/// of the next loop ahead is 1 % faster for clumps and 2 % slower for spheres.)
DEM_INLINE void pair_side(const dem_features f, const contact_side *side, size_t g, contact_batch *batch, int arm,
                          int radius, int pose)
{
    if (f.offset)
        put3(batch, arm, g, side->arm);
    wide_store(batch->at[radius] + g, side->sphere[3]);
    for (int k = 0; k < 4 && f.offset && f.local_mass; k++)
        wide_store(batch->at[pose + k] + g, side->pose[3 + k]);
}

DEM_INLINE void pair_first(const dem_features f, const dem_rows *rows, const dem_contact_columns *c, size_t at,
                           size_t g, contact_batch *batch)
{
    contact_side a;
    load_side(f, rows, c->a + at, c->sphere_a + at, &a);
    pair_side(f, &a, g, batch, AT_A, AT_RADIUS_A, AT_POSE_A);
    put3(batch, AT_CENTRE, g, (wide3){a.pose[0], a.pose[1], a.pose[2]});
}

DEM_INLINE void pair_second(const dem_features f, const dem_rows *rows, const dem_contact_columns *c, size_t at,
                            size_t g, contact_batch *batch)
{
    contact_side b;
    load_side(f, rows, c->b + at, c->sphere_b + at, &b);
    pair_side(f, &b, g, batch, AT_B, AT_RADIUS_B, AT_POSE_B);
    wide3 from = get3(batch, AT_CENTRE, g), d = {b.pose[0] - from.x, b.pose[1] - from.y, b.pose[2] - from.z};
    if (f.periodic) {
        wide shift[4];
        rows_load4(rows->shifts, 4, c->shift + at, shift);
        d = (wide3){d.x + shift[0], d.y + shift[1], d.z + shift[2]};
    }
    if (f.offset) {
        wide3 arm = get3(batch, AT_A, g);
        d = (wide3){d.x + (b.arm.x - arm.x), d.y + (b.arm.y - arm.y), d.z + (b.arm.z - arm.z)};
    }
    put3(batch, AT_NORMAL, g, d);
}

DEM_INLINE void pair_geometry(const dem_features f, const dem_rows *rows, const dem_contact_columns *c, size_t at,
                              size_t g, contact_batch *batch, double *largest)
{
    wide3 d = get3(batch, AT_NORMAL, g), arm_a = {wide_all(0), wide_all(0), wide_all(0)}, arm_b = arm_a;
    wide radius_a = wide_load(batch->at[AT_RADIUS_A] + g), radius_b = wide_load(batch->at[AT_RADIUS_B] + g);
    if (f.offset) {
        arm_a = get3(batch, AT_A, g);
        arm_b = get3(batch, AT_B, g);
    }
    wide distance, inverse = wide_roots(square3(d), &distance);
    wide overlap = radius_a + radius_b - distance, half = wide_all(0.5) * overlap;
    wide3 n = scale3(d, inverse);
    put3(batch, AT_NORMAL, g, n);
    wide_store(batch->at[AT_OVERLAP] + g, overlap);
    put3(batch, AT_A, g, along3(arm_a, radius_a - half, n));
    put3(batch, AT_B, g, against3(arm_b, radius_b - half, n));
    note_overlap(largest, overlap, wide_min(radius_a, radius_b));
    if (needs_reduced(f))
        wide_store(batch->at[AT_REDUCED] + g, reduced_radius(radius_a, radius_b));
    if (f.young) {
        wide least = wide_min(radius_a, radius_b);
        wide_store(batch->at[AT_AREA] + g, least * least / (radius_a + radius_b));
    }
    if (f.sjkr)
        put_lens(batch, g, lens_of_balls(radius_a, radius_b, distance, overlap));
    if (f.roll_bound)
        wide_store(batch->at[AT_RADIUS] + g, wide_min(radius_a, radius_b));
    if (turns(f)) {
        wide brisk_a, brisk_b,
            rolling = inverse_rolling(rows, c->a + at, radius_a, &brisk_a) +
                      inverse_rolling(rows, c->b + at, radius_b, &brisk_b);
        wide_store(batch->at[AT_ROLL_INERTIA] + g, rolling);
        wide_store(batch->at[AT_BRISK_A] + g, brisk_a);
        wide_store(batch->at[AT_BRISK_B] + g, brisk_b);
    }
}

DEM_INLINE void load_pose(const contact_batch *batch, int pose, size_t g, wide q[4])
{
    for (int k = 0; k < 4; k++)
        q[k] = wide_load(batch->at[pose + k] + g);
}

/// The mass that the contact sees, from the bodies' inertia.
DEM_INLINE void pair_mass(const dem_features f, const dem_rows *rows, const dem_contact_columns *c, size_t at, size_t g,
                          contact_batch *batch)
{
    wide3 n = get3(batch, AT_NORMAL, g);
    wide q[4], p[4];
    if (f.offset) {
        load_pose(batch, AT_POSE_A, g, q);
        load_pose(batch, AT_POSE_B, g, p);
    }
    put_mass(f, batch, g,
             inverse_local_mass(f, rows, c->a + at, q, get3(batch, AT_A, g), n) +
                 inverse_local_mass(f, rows, c->b + at, p, get3(batch, AT_B, g), n));
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
    if (f.friction || f.rolling || f.user_vectors)
        wide_store(batch->at[AT_TURN] + g,
                   wide_all(0.5) * dot3((wide3){a[3] + b[3], a[4] + b[4], a[5] + b[5]}, get3(batch, AT_NORMAL, g)));
    if (needs_mass(f) && !f.local_mass)
        put_mass(f, batch, g, a[6] + b[6]);
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
            wide3 out = against3(from, dot3(from, axis), axis);
            wide r, per_r = wide_roots(square3(out), &r);
            wide side = wide_select(wide_less(wall[3], wide_all(0)), wide_all(-1), wide_all(1));
            n = scale3(out, side * per_r);
            distance = wall[3] - side * r;
        }
        overlap = a.sphere[3] - distance;
        point = along3(a.arm, distance, n);
    }
    put3(batch, AT_NORMAL, g, n);
    wide_store(batch->at[AT_OVERLAP] + g, overlap);
    put3(batch, AT_A, g, point);
    note_overlap(largest, overlap, a.sphere[3]);
    if (needs_mass(f) && f.local_mass)
        put_mass(f, batch, g, inverse_local_mass(f, rows, c->a + at, a.pose + 3, point, n));
    if (needs_reduced(f))
        wide_store(batch->at[AT_REDUCED] + g, a.sphere[3]);
    if (f.young)
        wide_store(batch->at[AT_AREA] + g, a.sphere[3]);
    if (f.sjkr)
        put_lens(batch, g, lens_at_wall(a.sphere[3], overlap));
    if (f.roll_bound)
        wide_store(batch->at[AT_RADIUS] + g, a.sphere[3]);
    if (f.user)
        wide_store(batch->at[AT_RADIUS_A] + g, a.sphere[3]);
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
    if (f.friction || f.rolling || f.user_vectors)
        wide_store(batch->at[AT_TURN] + g, wide_all(0.5) * dot3(turning, get3(batch, AT_NORMAL, g)));
    if (needs_mass(f) && !f.local_mass)
        put_mass(f, batch, g, a[6]);
    if (f.watch)
        wide_store(batch->at[AT_LEAST_A] + g, a[7]);
}

#endif
