#include "sim/wall_motion.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

// ---- tables

// value and slope at x between 0 and 1 of a cubic with values a, b and slopes over the whole length
static double cubic(double a, double b, double slope_a, double slope_b, double x, double *slope)
{
    double d = b - a, p = 3 * d - 2 * slope_a - slope_b, q = slope_a + slope_b - 2 * d;
    *slope = slope_a + x * (2 * p + 3 * q * x);
    return a + x * (slope_a + x * (p + q * x));
}

// the largest slope in between
static double cubic_steepest(double a, double b, double slope_a, double slope_b)
{
    double d = b - a, p = 3 * d - 2 * slope_a - slope_b, q = slope_a + slope_b - 2 * d;
    double most = larger(fabs(slope_a), fabs(slope_b)), at = q != 0 ? -p / (3 * q) : -1, slope;
    if (at > 0 && at < 1) {
        cubic(a, b, slope_a, slope_b, at, &slope);
        most = larger(most, fabs(slope));
    }
    return most;
}

// component 0 to 2 of the shift, 3 the turn
static double entry(const dem_wall_table *t, size_t row, int component)
{
    return component < 3 ? v3_get(t->shift[row], component) : t->turn ? t->turn[row] : 0;
}

// the slope at a row, of its neighbours; 0 at the ends, where it begins and ends to stand still
static double slope_at(const dem_wall_table *t, size_t row, int component)
{
    if (row == 0 || row + 1 == t->count)
        return 0;
    return (entry(t, row + 1, component) - entry(t, row - 1, component)) / (t->time[row + 1] - t->time[row - 1]);
}

// rows around a time: the last one that is not behind it
static size_t row_before(const dem_wall_table *t, double time)
{
    size_t low = 0, high = t->count - 1;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        *(t->time[middle] <= time ? &low : &high) = middle;
    }
    return low;
}

static double look_up(const dem_wall_table *t, double time, int component, double *rate)
{
    *rate = 0;
    size_t last = t->count - 1;
    if (time < t->time[0] || t->count == 1)
        return entry(t, 0, component);
    if (time >= t->time[last])
        return entry(t, last, component);
    size_t row = row_before(t, time);
    double length = t->time[row + 1] - t->time[row], x = (time - t->time[row]) / length, slope;
    double a = entry(t, row, component), b = entry(t, row + 1, component), value = a + x * (b - a);
    slope = b - a;
    if (t->cubic)
        value = cubic(a, b, length * slope_at(t, row, component), length * slope_at(t, row + 1, component), x, &slope);
    *rate = slope / length;
    return value;
}

// the largest rate of a component
static double table_steepest(const dem_wall_table *t, int component)
{
    double most = 0;
    for (size_t row = 0; row + 1 < t->count; row++) {
        double length = t->time[row + 1] - t->time[row];
        double a = entry(t, row, component), b = entry(t, row + 1, component), steepest = fabs(b - a);
        if (t->cubic)
            steepest =
                cubic_steepest(a, b, length * slope_at(t, row, component), length * slope_at(t, row + 1, component));
        most = larger(most, steepest / length);
    }
    return most;
}

// ---- bounds

// keeps the one direction of all shifts, if there is one
static void note_shift(dem_wall_motion *m, dem_vec3 shift)
{
    if (!(v3_norm2(shift) > 0))
        return;
    dem_vec3 direction = v3_unit(shift);
    if (!m->shifts)
        m->shift_only = direction;
    else if (!(v3_norm2(v3_cross(m->shift_only, direction)) < 1e-24))
        m->shift_only = v3(0, 0, 0);
    m->shifts = true;
}

static void set_bounds(dem_wall_motion *m)
{
    m->speed_most = v3_norm(m->velocity);
    m->rate_most = v3_norm(m->spin);
    note_shift(m, m->velocity);
    for (size_t i = 0; i < m->oscillation_count; i++) {
        const dem_oscillation *o = &m->oscillations[i];
        m->speed_most += 2 * DEM_PI * fabs(o->frequency) * v3_norm(o->shift);
        m->rate_most += 2 * DEM_PI * fabs(o->frequency * o->turn);
        m->range += 2 * v3_norm(o->shift);
        note_shift(m, o->shift);
    }
    if (m->table.count) {
        dem_vec3 most = v3(table_steepest(&m->table, 0), table_steepest(&m->table, 1), table_steepest(&m->table, 2));
        m->speed_most += v3_norm(most);
        m->rate_most += table_steepest(&m->table, 3);
        double farthest = 0;
        for (size_t i = 0; i < m->table.count; i++) {
            note_shift(m, m->table.shift[i]);
            farthest = larger(farthest, v3_norm(m->table.shift[i]));
        }
        m->range += 2 * farthest;
    }
    m->turns = m->rate_most > 0;
    m->steady = !(m->start > 0) && isinf(m->stop) && !m->oscillation_count && !m->table.count;
}

dem_wall_motion dem_wall_motion_of(const dem_wall_def *wall)
{
    dem_wall_motion m = {.velocity = wall->velocity,
                         .through = wall->through,
                         .spin = wall->spin,
                         .axis = v3_norm2(wall->spin) > 0 ? v3_unit(wall->spin) : v3_unit(wall->axis),
                         .start = wall->start,
                         .stop = wall->stop > 0 ? wall->stop : INFINITY,
                         .oscillations = wall->oscillations,
                         .oscillation_count = wall->oscillation_count,
                         .table = wall->table};
    set_bounds(&m);
    return m;
}

static bool own(void *array, size_t count, size_t size)
{
    const void *from = *(void **)array;
    void *copy = from ? dem_alloc(count, size) : NULL;
    if (copy)
        memcpy(copy, from, count * size);
    *(void **)array = copy;
    return copy || !from;
}

bool dem_wall_motion_own(dem_wall_motion *m)
{
    bool good = own(&m->oscillations, m->oscillation_count, sizeof *m->oscillations);
    good &= own(&m->table.time, m->table.count, sizeof *m->table.time);
    good &= own(&m->table.shift, m->table.count, sizeof *m->table.shift);
    good &= own(&m->table.turn, m->table.count, sizeof *m->table.turn);
    m->table.file = NULL;
    return good;
}

void dem_wall_motion_release(dem_wall_motion *m)
{
    free((void *)m->oscillations);
    free((void *)m->table.time);
    free((void *)m->table.shift);
    free((void *)m->table.turn);
}

// ---- by time

dem_wall_moment dem_wall_motion_at(const dem_wall_motion *m, double time)
{
    bool runs = time >= m->start && time < m->stop;
    double t = smaller(larger(time, m->start), m->stop) - m->start;
    dem_wall_moment now = {.shift = v3_scale(m->velocity, t), .angle = v3_norm(m->spin) * t};
    if (runs) {
        now.velocity = m->velocity;
        now.spin = m->spin;
    }
    double turning = 0;
    for (size_t i = 0; i < m->oscillation_count; i++) {
        const dem_oscillation *o = &m->oscillations[i];
        // whole periods are taken off first: exact for long runs
        double phase = 2 * DEM_PI * remainder(o->frequency * t, 1) + o->phase, x = sin(phase) - sin(o->phase);
        double rate = runs ? 2 * DEM_PI * o->frequency * cos(phase) : 0;
        now.shift = v3_along(now.shift, x, o->shift);
        now.velocity = v3_along(now.velocity, rate, o->shift);
        now.angle += x * o->turn;
        turning += rate * o->turn;
    }
    for (int k = 0; k < 4 && m->table.count; k++) {
        double rate, value = look_up(&m->table, time, k, &rate);
        if (k == 3) {
            now.angle += value;
            turning += rate;
            break;
        }
        v3_set(&now.shift, k, v3_get(now.shift, k) + value);
        v3_set(&now.velocity, k, v3_get(now.velocity, k) + rate);
    }
    if (turning != 0)
        now.spin = v3_along(now.spin, turning, m->axis);
    return now;
}

dem_vec3 dem_wall_pose(const dem_wall_motion *m, const dem_wall_moment *now, dem_vec3 more, dem_quat *orientation)
{
    dem_vec3 through = v3_add(v3_add(m->through, now->shift), more);
    // whole turns are taken off first: exact for long runs
    double angle = remainder(now->angle, 2 * DEM_PI);
    dem_vec3 e = v3_scale(m->axis, sin(angle / 2));
    *orientation = (dem_quat){cos(angle / 2), e.x, e.y, e.z};
    return v3_sub(through, quat_rotate(*orientation, m->through));
}

bool dem_wall_def_moves(const dem_wall_def *wall)
{
    dem_wall_motion m = dem_wall_motion_of(wall);
    return dem_wall_motion_any(&m) || wall->servo.on;
}
