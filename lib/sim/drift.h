/// The motion of bodies, for kernels.c: central differences with momenta at half steps, and the free rotor by symmetric
/// splitting (`lsym`): an exact symmetric top between two half turns about axis b. Axes (a, b, c) = (x, y, z) of the
/// run frame, c chosen in template.c. L stays as it is in space, so it is kept to the last bit (Fasso 2003; Dullweber,
/// Leimkuhler & McLachlan 1997).
#ifndef DEM_SIM_DRIFT_H
#define DEM_SIM_DRIFT_H

#include "sim/contact.h"

/// What turns more than this in a step [rad] is turned in several.
static const double TURN_AT_ONCE = 0.3;
enum { TURNS_MOST = 1024 };

// sin(x) / x and cos x by u = x^2, to the last bit for |x| < 0.4
DEM_INLINE wide sine_over(wide u)
{
    wide s = wide_fma(u, wide_all(-1.0 / 39916800), wide_all(1.0 / 362880));
    s = wide_fma(u, wide_fma(u, s, wide_all(-1.0 / 5040)), wide_all(1.0 / 120));
    return wide_fma(u, wide_fma(u, s, wide_all(-1.0 / 6)), wide_all(1));
}
DEM_INLINE wide cosine(wide u)
{
    wide c = wide_fma(u, wide_all(-1.0 / 3628800), wide_all(1.0 / 40320));
    c = wide_fma(u, wide_fma(u, c, wide_all(-1.0 / 720)), wide_all(1.0 / 24));
    return wide_fma(u, wide_fma(u, c, wide_all(-0.5)), wide_all(1));
}

// a bound of (a + b)^2 by their squares, at most 1.25 times as much: (1 + t) a^2 + (1 + 1/t) b^2 for t = 1/4, 1, 4
DEM_INLINE wide square_of_sum(wide a2, wide b2)
{
    wide sum = a2 + b2, even = sum + sum, more = wide_all(3.75);
    wide uneven = wide_fma(more, wide_min(a2, b2), wide_all(1.25) * sum);
    return wide_min(even, uneven);
}

typedef struct rotor {
    wide q[4];
    wide3 body;  // angular momentum in the body
} rotor;

// turns about b by twice the half angle `k` body.y
DEM_INLINE void turn_b(rotor *r, wide k)
{
    wide half = k * r->body.y, u = half * half, s = half * sine_over(u), c = cosine(u);
    wide q0 = wide_fms(r->q[0], c, r->q[2] * s), q1 = wide_fms(r->q[1], c, r->q[3] * s);
    wide q2 = wide_fma(r->q[2], c, r->q[0] * s), q3 = wide_fma(r->q[3], c, r->q[1] * s);
    wide cosine2 = wide_fms(c, c, s * s), sine2 = (s + s) * c, x = r->body.x, z = r->body.z;
    *r = (rotor){{q0, q1, q2, q3}, {wide_fms(cosine2, x, sine2 * z), r->body.y, wide_fma(cosine2, z, sine2 * x)}};
}

DEM_INLINE void turn_c(rotor *r, wide k)
{
    wide half = k * r->body.z, u = half * half, s = half * sine_over(u), c = cosine(u);
    wide q0 = wide_fms(r->q[0], c, r->q[3] * s), q1 = wide_fma(r->q[1], c, r->q[2] * s);
    wide q2 = wide_fms(r->q[2], c, r->q[1] * s), q3 = wide_fma(r->q[3], c, r->q[0] * s);
    wide cosine2 = wide_fms(c, c, s * s), sine2 = (s + s) * c, x = r->body.x, y = r->body.y;
    *r = (rotor){{q0, q1, q2, q3}, {wide_fma(cosine2, x, sine2 * y), wide_fms(cosine2, y, sine2 * x), r->body.z}};
}

DEM_INLINE void quat_product(const wide a[4], const wide b[4], wide out[4])
{
    out[0] = wide_fnma(a[3], b[3], wide_fnma(a[2], b[2], wide_fnma(a[1], b[1], a[0] * b[0])));
    out[1] = wide_fnma(a[3], b[2], wide_fma(a[2], b[3], wide_fma(a[1], b[0], a[0] * b[1])));
    out[2] = wide_fma(a[3], b[1], wide_fma(a[2], b[0], wide_fnma(a[1], b[3], a[0] * b[2])));
    out[3] = wide_fma(a[3], b[0], wide_fnma(a[2], b[1], wide_fma(a[1], b[2], a[0] * b[3])));
}

// q exp(k body): a turn about L itself, which leaves `body` as it is
DEM_INLINE void turn_whole(rotor *r, wide k)
{
    wide3 half = scale3(r->body, k);
    wide u = dot3(half, half), s = sine_over(u), e0 = cosine(u), e1 = s * half.x, e2 = s * half.y, e3 = s * half.z;
    wide e[4] = {e0, e1, e2, e3}, q[4] = {r->q[0], r->q[1], r->q[2], r->q[3]};
    quat_product(q, e, r->q);
}

// one turn by `step`; `inverse` 1/I
DEM_INLINE void turn_free(rotor *r, const wide inverse[3], wide step)
{
    wide kb = wide_all(0.25) * step * (inverse[1] - inverse[0]), kc = wide_all(0.5) * step * (inverse[2] - inverse[0]);
    turn_b(r, kb);
    turn_whole(r, wide_all(0.5) * step * inverse[0]);
    turn_c(r, kc);
    turn_b(r, kb);
}

// number of equal turns, so that none is too large; the squared angle of the step is given
DEM_INLINE unsigned turns_needed(wide angle2, double turns[DEM_WIDTH])
{
    unsigned most = 1;
    double a[DEM_WIDTH];
    wide_store(a, angle2);
    for (int i = 0; i < DEM_WIDTH; i++) {
        double n = ceil(sqrt(a[i]) / TURN_AT_ONCE);
        turns[i] = n >= 1 && n <= TURNS_MOST ? n : n > TURNS_MOST ? TURNS_MOST : 1;
        most = turns[i] > most ? (unsigned)turns[i] : most;
    }
    return most;
}

DEM_INLINE wide larger_square(wide a, wide b)
{
    return wide_max(a * a, b * b);
}

// q exp(k spin) from the left: a turn in space
DEM_INLINE void turn_in_space(const wide q[4], wide3 spin, wide k, wide out[4])
{
    wide3 half = scale3(spin, k);
    wide u = dot3(half, half), s = sine_over(u), e0 = cosine(u), e1 = s * half.x, e2 = s * half.y, e3 = s * half.z;
    wide e[4] = {e0, e1, e2, e3};
    quat_product(e, q, out);
}

// spheres and other bodies with three equal moments: exact
DEM_INLINE wide3 drift_isotropic(wide q[4], wide3 momentum, wide inverse, wide step)
{
    wide3 spin = scale3(momentum, inverse);
    wide angle2 = dot3(spin, spin) * (step * step), next[4];
    if (__builtin_expect(wide_bits(wide_less(wide_all(TURN_AT_ONCE * TURN_AT_ONCE), angle2)) != 0, 0)) {
        double count[DEM_WIDTH];
        unsigned turns = turns_needed(angle2, count);
        wide part = step / wide_load(count);
        for (unsigned i = 0; i < turns; i++) {
            turn_in_space(q, spin, wide_all(0.5) * part, next);
            wide_mask goes = wide_less(wide_all((double)i), wide_load(count));
            for (int j = 0; j < 4; j++)
                q[j] = wide_select(goes, next[j], q[j]);
        }
    } else {
        turn_in_space(q, spin, wide_all(0.5) * step, next);
        for (int j = 0; j < 4; j++)
            q[j] = next[j];
    }
    return spin;
}

DEM_INLINE wide3 drift_rotor(wide q[4], wide3 momentum, const wide inverse[3], wide step)
{
    rotor r = {{q[0], q[1], q[2], q[3]}, turned_back(q, momentum)};
    wide angle2 = wide_max(dot3(r.body, r.body) * inverse[0] * inverse[0],
                           larger_square(r.body.y * inverse[1], r.body.z * inverse[2]));
    angle2 = angle2 * (step * step);
    if (__builtin_expect(wide_bits(wide_less(wide_all(TURN_AT_ONCE * TURN_AT_ONCE), angle2)) != 0, 0)) {
        double count[DEM_WIDTH];
        unsigned turns = turns_needed(angle2, count);
        wide part = step / wide_load(count);
        for (unsigned i = 0; i < turns; i++) {
            rotor next = r;
            turn_free(&next, inverse, part);
            wide_mask goes = wide_less(wide_all((double)i), wide_load(count));
            for (int j = 0; j < 4; j++)
                r.q[j] = wide_select(goes, next.q[j], r.q[j]);
            r.body = select3(goes, next.body, r.body);
        }
    } else
        turn_free(&r, inverse, step);
    for (int j = 0; j < 4; j++)
        q[j] = r.q[j];
    return turned(q, (wide3){r.body.x * inverse[0], r.body.y * inverse[1], r.body.z * inverse[2]});
}

DEM_INLINE wide3 drift(wide q[4], wide3 momentum, const wide inertia[8], wide step)
{
    unsigned all = (unsigned)((1u << DEM_WIDTH) - 1);
    wide_mask isotropic = wide_less(wide_all(0.5), inertia[7]);
    unsigned bits = wide_bits(isotropic);
    if (bits == all)
        return drift_isotropic(q, momentum, inertia[1], step);
    if (bits == 0)
        return drift_rotor(q, momentum, inertia + 1, step);
    // both, so that a body does not depend on its neighbours in the rows
    wide other[4] = {q[0], q[1], q[2], q[3]};
    wide3 spin = drift_isotropic(q, momentum, inertia[1], step);
    wide3 other_spin = drift_rotor(other, momentum, inertia + 1, step);
    for (int j = 0; j < 4; j++)
        q[j] = wide_select(isotropic, q[j], other[j]);
    return select3(isotropic, spin, other_spin);
}

/// Local damping of one vector of impulse against a velocity, componentwise or as vectors (Cundall 1987).
DEM_INLINE wide3 damp_locally(wide3 impulse, wide3 velocity, wide alpha, const bool vector)
{
    wide zero = wide_all(0);
    if (vector) {
        wide size2 = dot3(impulse, impulse), speed2 = dot3(velocity, velocity);
        wide s = alpha * wide_sqrt(size2) * wide_rsqrt(speed2 + wide_all(1e-300));
        return scale3(velocity, zero - wide_or_zero(wide_less(zero, speed2), s));
    }
    wide j[3] = {impulse.x, impulse.y, impulse.z}, v[3] = {velocity.x, velocity.y, velocity.z};
    for (int k = 0; k < 3; k++) {
        wide size = alpha * wide_abs(j[k]);
        j[k] = wide_or_zero(wide_less(v[k], zero), size) - wide_or_zero(wide_less(zero, v[k]), size);
    }
    return (wide3){j[0], j[1], j[2]};
}

typedef struct damping {
    wide3 local[2], drag[2];  // impulses of force and moment
} damping;

DEM_INLINE void damp(const dem_motion_job *job, const wide before[8], const wide motion[8], wide3 weight,
                     wide momentum[8], damping *d)
{
    wide zero = wide_all(0);
    wide3 none = {zero, zero, zero}, v = {motion[0], motion[1], motion[2]}, w = {motion[3], motion[4], motion[5]};
    *d = (damping){{none, none}, {none, none}};
    if (job->local > 0) {
        wide3 force = {momentum[0] - before[0], momentum[1] - before[1], momentum[2] - before[2]};
        wide3 moment = {momentum[3] - before[3], momentum[4] - before[4], momentum[5] - before[5]};
        if (!job->exclude_gravity)
            force = along3(force, wide_all(1), weight);
        wide alpha = wide_all(job->local);
        d->local[0] = damp_locally(force, v, alpha, job->vector);
        d->local[1] = damp_locally(moment, w, alpha, job->vector);
    }
    if (job->viscous > 0) {
        wide c = wide_all(-job->kick * job->viscous);
        d->drag[0] = scale3((wide3){before[0], before[1], before[2]}, c);
        d->drag[1] = scale3((wide3){before[3], before[4], before[5]}, c);
    }
    for (int k = 0; k < 2; k++) {
        momentum[3 * k] = momentum[3 * k] + (d->local[k].x + d->drag[k].x);
        momentum[3 * k + 1] = momentum[3 * k + 1] + (d->local[k].y + d->drag[k].y);
        momentum[3 * k + 2] = momentum[3 * k + 2] + (d->local[k].z + d->drag[k].z);
    }
}

/// Takes the damping back of what is held, which nothing slows. One body at a time: see motion.c.
DEM_INLINE void spare_held(const dem_motion_job *job, size_t row, wide momentum[8], damping *d)
{
    uint32_t hold = job->hold[row];
    for (int k = 0; k < 2; k++) {
        if (!(hold & (k ? DEM_HOLD_SPIN : DEM_HOLD_VELOCITY)))
            continue;
        wide3 *parts[2] = {&d->local[k], &d->drag[k]};
        for (int i = 0; i < 2; i++) {
            momentum[3 * k] = momentum[3 * k] - parts[i]->x;
            momentum[3 * k + 1] = momentum[3 * k + 1] - parts[i]->y;
            momentum[3 * k + 2] = momentum[3 * k + 2] - parts[i]->z;
            *parts[i] = scale3(*parts[i], wide_all(0));
        }
    }
}

/// Rolling resistance that contacts bound (Irazabal, Salazar & Onate 2017): takes what it may of the angular momentum,
/// at most all of it, so that it never turns a spin round. Returns the impulse.
DEM_INLINE wide3 hold_spin(wide momentum[8])
{
    wide3 spin = {momentum[3], momentum[4], momentum[5]};
    wide size2 = dot3(spin, spin), zero = wide_all(0);
    wide part = wide_min(wide_all(1), momentum[7] * wide_rsqrt(size2 + wide_all(1e-300)));
    wide3 impulse = scale3(spin, zero - wide_or_zero(wide_less(zero, size2), part));
    momentum[3] = momentum[3] + impulse.x;
    momentum[4] = momentum[4] + impulse.y;
    momentum[5] = momentum[5] + impulse.z;
    momentum[7] = zero;
    return impulse;
}

// twice the energy taken out by impulses: against the mean of the velocities before and after
DEM_INLINE wide taken(const wide3 impulse[2], const wide was[8], const wide now[8])
{
    wide3 v = {was[0] + now[0], was[1] + now[1], was[2] + now[2]};
    wide3 w = {was[3] + now[3], was[4] + now[4], was[5] + now[5]};
    return wide_all(0) - (dot3(impulse[0], v) + dot3(impulse[1], w));
}

DEM_INLINE void note_strained(dem_motion_job *job, size_t i, wide strain)
{
    unsigned bits = wide_bits(wide_less(wide_load(job->strain_limit + i), strain));
    double lane[DEM_WIDTH];
    if (bits)
        wide_store(lane, strain);
    for (; bits; bits &= bits - 1) {
        uint32_t k = (uint32_t)__builtin_ctz(bits);
        job->strained[job->strained_count++] = (dem_strained){(uint32_t)i + k, lane[k]};
    }
}

/// Takes the rows of one batch from their momenta to the next pose and velocity, with `was` the motion before.
typedef void motion_advance(const dem_motion_job *job, size_t row, const wide was[8], const wide inertia[8],
                            wide pose[8], wide motion[8], wide momentum[8]);

/// `other`: how to move on, where that is not by central differences and lsym; the kernels know only these. What holds
/// the loop are the 27 rows of 64 bytes that eight bodies bring and take: cut into short loops it is no faster.
DEM_INLINE void move_bodies(const dem_rows *rows, dem_motion_job *job, const bool damped, const bool bounded,
                            motion_advance *const other)
{
    wide step = wide_all(job->step);
    for (size_t i = job->begin; i < job->end; i += DEM_WIDTH) {
        wide pose[8], motion[8], momentum[8], inertia[8], was[8];
        double *body = rows->bodies + DEM_BODY_ROW * i;
        rows_load_next(body, DEM_BODY_ROW, pose);
        rows_load_next(rows->momentum + DEM_ROW * i, DEM_ROW, momentum);
        rows_load_next(rows->inertia + DEM_ROW * i, DEM_ROW, inertia);
        wide kick = wide_all(job->kick) * inertia[5];
        wide3 weight = {kick * wide_all(job->gravity[0]), kick * wide_all(job->gravity[1]),
                        kick * wide_all(job->gravity[2])};
        damping d;
        wide3 held[2] = {{wide_all(0), wide_all(0), wide_all(0)}};
        if (damped || bounded || other)
            rows_load_next(body + 8, DEM_BODY_ROW, was);
        if (damped) {
            wide before[8];
            rows_load_next(job->before + DEM_ROW * i, DEM_ROW, before);
            damp(job, before, was, weight, momentum, &d);
            if (other && job->hold)
                spare_held(job, i, momentum, &d);
        }
        if (bounded && other && job->hold && job->hold[i] & DEM_HOLD_SPIN)
            momentum[7] = wide_all(0);
        if (bounded)
            held[1] = hold_spin(momentum);
        momentum[0] = momentum[0] + weight.x;
        momentum[1] = momentum[1] + weight.y;
        momentum[2] = momentum[2] + weight.z;
        wide3 spin;
        if (other) {
            other(job, i, was, inertia, pose, motion, momentum);
            spin = (wide3){motion[3], motion[4], motion[5]};
        } else {
            for (int k = 0; k < 3; k++) {
                motion[k] = momentum[k] * inertia[0];
                pose[k] = wide_fma(step, motion[k], pose[k]);
            }
            spin = drift(pose + 3, (wide3){momentum[3], momentum[4], momentum[5]}, inertia, step);
        }
        // to the first order: what a step adds to |q| - 1 is of the last bits
        wide norm = wide_all(1.5) -
                    wide_all(0.5) * (pose[3] * pose[3] + pose[4] * pose[4] + pose[5] * pose[5] + pose[6] * pose[6]);
        for (int k = 3; k < 7; k++)
            pose[k] = pose[k] * norm;
        motion[3] = spin.x;
        motion[4] = spin.y;
        motion[5] = spin.z;
        motion[6] = inertia[0];
        motion[7] = inertia[6];
        wide turning = dot3(spin, spin) * (inertia[4] * inertia[4]);
        wide3 v = {motion[0], motion[1], motion[2]};
        wide path = wide_fma(step, wide_sqrt(square_of_sum(dot3(v, v), turning)), wide_load(job->path + i));
        wide_store(job->path + i, path);
        unsigned bits = wide_bits(wide_not_le(path, wide_load(job->limit + i)));
        if (job->wall_limit)
            bits |= wide_bits(wide_not_le(path + wide_all(job->wall_path), wide_load(job->wall_limit + i)));
        for (; bits; bits &= bits - 1)
            job->asked[job->asked_count++] = (uint32_t)i + (uint32_t)__builtin_ctz(bits);
        if (job->strain_limit) {
            note_strained(job, i, momentum[6]);
            momentum[6] = wide_all(0);
        }
        if (damped && job->tally) {
            tally_add(job->tally->local, i, wide_all(0.5) * taken(d.local, was, motion));
            tally_add(job->tally->drag, i, wide_all(0.5) * taken(d.drag, was, motion));
        }
        if (bounded && job->tally)
            tally_add(job->tally->rolling, i, wide_all(0.5) * taken(held, was, motion));
        rows_store_next(body, DEM_BODY_ROW, pose);
        rows_store_next(body + 8, DEM_BODY_ROW, motion);
        rows_store_next4(rows->momentum + DEM_ROW * i, DEM_ROW, momentum);
        // only these change more than the momentum itself
        if (damped || bounded || other || job->strain_limit)
            rows_store_next4(rows->momentum + DEM_ROW * i + 4, DEM_ROW, momentum + 4);
    }
}

#endif
