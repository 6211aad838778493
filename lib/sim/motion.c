#include "sim/motion.h"

#include "sim/bodies.h"
#include "sim/drift.h"
#include "sim/rotate.h"
#include "sim/schemes.h"

_Static_assert(DEM_WIDTH == 1, "body by body");

// Suzuki (1990): five steps of order 2 make one of order 4
static void drift_fourth(double q[4], wide3 momentum, const double inertia[8], double step, wide3 *spin)
{
    const double outer = 1 / (4 - cbrt(4.0));
    for (int i = 0; i < 5; i++)
        *spin = drift(q, momentum, inertia, (i == 2 ? 1 - 4 * outer : outer) * step);
}

static rotor_body rotor_of(const dem_motion_job *job, size_t row, const double q[4], const double momentum[8],
                           const double inertia[8])
{
    const double *before = job->before + DEM_ROW * row + 3;
    dem_vec3 old = v3(before[0], before[1], before[2]);
    // the contacts' impulse is of the translation's kick
    double share = job->turn_kick / job->kick;
    return (rotor_body){.q = {q[0], q[1], q[2], q[3]},
                        .momentum = old,
                        .impulse = v3_scale(v3_sub(v3(momentum[3], momentum[4], momentum[5]), old), share),
                        .inverse = {inertia[1], inertia[2], inertia[3]},
                        .step = job->step,
                        .kick = job->turn_kick,
                        .last = job->last_step,
                        .turning = job->turning ? job->turning + 3 * row : NULL};
}

static void rotate_momentum(const dem_motion_job *job, rotor_body *b, const double inertia[8])
{
    b->momentum = v3_add(b->momentum, b->impulse);
    double q[4] = {b->q.w, b->q.x, b->q.y, b->q.z};
    wide3 l = {b->momentum.x, b->momentum.y, b->momentum.z}, spin;
    if (job->schemes.rotation == DEM_ROTATION_LSYM4)
        drift_fourth(q, l, inertia, job->step, &spin);
    else
        drift(q, l, inertia, job->step);
    b->q = (dem_quat){q[0], q[1], q[2], q[3]};
}

static void rotate(const dem_motion_job *job, rotor_body *b, const double inertia[8])
{
    if (carries_spin(job->schemes.rotation))
        rotate_by_spin(b, job->schemes.rotation);
    else if (job->schemes.rotation == DEM_ROTATION_FINCHAM)
        rotate_fincham(b);
    else if (job->schemes.rotation == DEM_ROTATION_NO_SQUISH)
        rotate_no_squish(b);
    else if (job->schemes.rotation == DEM_ROTATION_PCDM)
        rotate_pcdm(b);
    else
        rotate_momentum(job, b, inertia);
}

static void put_rotor(const rotor_body *b, double q[4], double motion[8], double momentum[8])
{
    dem_vec3 spin = quat_rotate(b->q, spin_in_body(b, b->q, b->momentum));
    memcpy(q, (double[]){b->q.w, b->q.x, b->q.y, b->q.z}, 4 * sizeof *q);
    memcpy(momentum + 3, (double[]){b->momentum.x, b->momentum.y, b->momentum.z}, 3 * sizeof *momentum);
    memcpy(motion + 3, (double[]){spin.x, spin.y, spin.z}, 3 * sizeof *motion);
}

// ---- bodies that are held

// keeps a velocity or a spin (`at` of six) against the impulse, which is gone then
static void keep(const dem_motion_job *job, size_t row, int at, double motion[8], double momentum[8])
{
    double work = 0;
    for (int k = at; k < at + 3; k++) {
        motion[k] = job->kept[6 * row + (size_t)k];
        work -= momentum[k] * motion[k];
        momentum[k] = 0;
    }
    if (job->tally)
        tally_add(job->tally->work, row, work);
}

// turns about the free axes, for the spin of the middle of the step
static void rotate_locked(rotor_body *b, uint32_t hold)
{
    b->momentum = v3_add(b->momentum, b->impulse);
    dem_vec3 spin = locked_spin(b->q, b->inverse, b->momentum, hold);
    if (b->inverse[0] != b->inverse[1] || b->inverse[1] != b->inverse[2]) {
        dem_quat middle = quat_multiply(turn_by(v3_scale(spin, b->step / 2)), b->q);
        spin = locked_spin(middle, b->inverse, b->momentum, hold);
    }
    b->q = quat_multiply(turn_by(v3_scale(spin, b->step)), b->q);
    spin = locked_spin(b->q, b->inverse, b->momentum, hold);
    b->momentum = quat_rotate(b->q, over_axes(quat_unrotate(b->q, spin), b->inverse));
}

// ---- one body

static void translate(const dem_motion_job *job, size_t row, uint32_t hold, const double was[8],
                      const double inertia[8], double pose[8], double motion[8], double momentum[8])
{
    double share = dem_translations[job->schemes.translation].number;
    for (int k = 0; k < 3; k++) {
        if (hold & (uint32_t)(DEM_LOCK_X << k))
            momentum[k] = 0;
        motion[k] = momentum[k] * inertia[0];
    }
    if (hold & DEM_HOLD_VELOCITY)
        keep(job, row, 0, motion, momentum);
    for (int k = 0; k < 3; k++)
        pose[k] = fma(job->step, share * motion[k] + (1 - share) * was[k], pose[k]);
}

static void advance(const dem_motion_job *job, size_t row, const double was[8], const double inertia[8], double pose[8],
                    double motion[8], double momentum[8])
{
    uint32_t hold = job->hold ? job->hold[row] : 0;
    translate(job, row, hold, was, inertia, pose, motion, momentum);
    if (hold & DEM_HOLD_SPIN) {
        keep(job, row, 3, motion, momentum);
        dem_quat q = {pose[3], pose[4], pose[5], pose[6]};
        q = quat_multiply(turn_by(v3_scale(v3(motion[3], motion[4], motion[5]), job->step)), q);
        memcpy(pose + 3, (double[]){q.w, q.x, q.y, q.z}, 4 * sizeof *pose);
        return;
    }
    rotor_body b = rotor_of(job, row, pose + 3, momentum, inertia);
    if (hold & DEM_LOCK_TURNS)
        rotate_locked(&b, hold);
    else if (inertia[1] > 0)
        rotate(job, &b, inertia);  // rows that fill up have no moments, and stay
    put_rotor(&b, pose + 3, motion, momentum);
}

void dem_motion_any(const dem_rows *rows, dem_motion_job *job)
{
    move_bodies(rows, job, job->local > 0 || job->viscous > 0, job->bounded, advance);
}

// ---- times

static double kick_of(const dem_world *w, const dem_scheme *scheme)
{
    return scheme->half ? (w->last_step + w->next_step) / 2 : w->next_step;
}

double dem_motion_kick(const dem_world *w)
{
    return kick_of(w, &dem_translations[w->integrator.translation]);
}

double dem_motion_turn_kick(const dem_world *w)
{
    return kick_of(w, &dem_rotations[w->integrator.rotation]);
}

// ---- the time of the positions

static dem_vec3 body_kept(const dem_world *w, size_t row, size_t at)
{
    const double *kept = w->bodies.kept + 6 * row + at;
    return v3(kept[0], kept[1], kept[2]);
}

dem_vec3 dem_motion_velocity(const dem_world *w, size_t row, dem_vec3 force)
{
    const double *p = w->bodies.momentum + DEM_ROW * row;
    double half = dem_translations[w->integrator.translation].half ? w->last_step / 2 : 0;
    uint32_t hold = body_hold(&w->bodies, row);
    if (hold & DEM_HOLD_VELOCITY)
        return body_kept(w, row, 0);
    dem_vec3 v = v3_scale(v3_along(v3(p[0], p[1], p[2]), half, force), w->bodies.inertia[DEM_ROW * row]);
    return unlocked_velocity(v, hold);
}

dem_vec3 dem_motion_spin(const dem_world *w, size_t row, dem_vec3 moment)
{
    const double *p = w->bodies.momentum + DEM_ROW * row + 3, *inertia = w->bodies.inertia + DEM_ROW * row;
    dem_rotation scheme = w->integrator.rotation;
    dem_vec3 momentum = v3(p[0], p[1], p[2]);
    double half = dem_rotations[scheme].half ? w->last_step / 2 : 0;
    const double inverse[3] = {inertia[1], inertia[2], inertia[3]};
    dem_quat q = body_orientation(&w->bodies, row);
    uint32_t hold = body_hold(&w->bodies, row);
    if (hold & DEM_HOLD_SPIN)
        return body_kept(w, row, 3);
    if (hold & DEM_LOCK_TURNS)
        return locked_spin(q, inverse, v3_along(momentum, half, moment), hold);
    if (!carries_spin(scheme))
        return dem_body_spin(&w->bodies, row, v3_along(momentum, half, moment));
    double turning[3] = {0};
    if (w->bodies.turning)
        memcpy(turning, w->bodies.turning + 3 * row, sizeof turning);
    dem_vec3 spin = by_axes(quat_unrotate(q, momentum), inverse);
    spin = kicked_spin(scheme, inverse, spin, quat_unrotate(q, moment), half, w->last_step, turning);
    return quat_rotate(q, spin);
}
