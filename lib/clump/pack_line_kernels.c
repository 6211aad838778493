// Lines through the union of balls, strip by strip; compiled once per instruction set as pack_kernels.c.
//
// A strip meets some dozen to a hundred balls, and on each line only two or three of them end at the surface. A ball is
// left out of a strip's list as long as no move within the slack can bring it to the surface: raised by the slack it
// must lie in the union of others that are lowered by it, and these others stay in the list. So results are the same
// with and without, to the last bit.
#include <string.h>

#include "base/level.h"
#include "clump/pack_kernels.h"

enum { MOST_INTERVALS = 6 };  // of a cover: a strip with more of them keeps all its balls

static const float nowhere = 1e9f;

/// A ball as a strip of lines sees it.
typedef struct strip_ball {
    float u, v, w;    ///< from the first line to the centre across, from the centre to the row, centre along
    float reach2;     ///< r^2 - v^2
} strip_ball;

// `grow` is added to its radius
static strip_ball strip_view(const dem_ball_columns *balls, int axis, uint32_t i, float x, float y, float grow)
{
    const float *at[3] = {balls->x, balls->y, balls->z};
    float u = at[(axis + 1) % 3][i] - x, v = y - at[(axis + 2) % 3][i], r = balls->r[i] + grow;
    return (strip_ball){u, v, at[axis][i], r > 0 ? r * r - v * v : 0};
}

/// One end of the union on each line of a strip, and whose end it is (an index into the strip's balls).
typedef struct strip_front {
    float at[DEM_LINE_LANES];
    int32_t ball[DEM_LINE_LANES];
} strip_front;

static bool any_below(const float *restrict a, float limit)
{
    int32_t any = 0;
    for (int l = 0; l < DEM_LINE_LANES; l++)
        any |= a[l] < limit;
    return any;
}

static bool any_above(const float *restrict a, float limit)
{
    int32_t any = 0;
    for (int l = 0; l < DEM_LINE_LANES; l++)
        any |= a[l] > limit;
    return any;
}

// The interval of one ball on each line of a strip; empty ones are inside out and far away. Lowers `begin` to where it
// begins.
static void strip_ends(strip_ball ball, int32_t who, float step, float *restrict from, float *restrict to,
                       strip_front *restrict begin)
{
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        float off = (float)l * step - ball.u, rest = ball.reach2 - off * off;
        float half = sqrtf(rest > 0 ? rest : 0);
        from[l] = rest > 0 ? ball.w - half : nowhere;
        to[l] = rest > 0 ? ball.w + half : -nowhere;
        begin->ball[l] = from[l] < begin->at[l] ? who : begin->ball[l];
        begin->at[l] = from[l] < begin->at[l] ? from[l] : begin->at[l];
    }
}

static void front_nowhere(strip_front *front)
{
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        front->at[l] = nowhere;
        front->ball[l] = 0;
    }
}

// moves the end of the union's interval on as far as the balls reach, seen in their order
static void move_end(const dem_line_task *task, size_t count, strip_front *restrict end)
{
    float at[DEM_LINE_LANES];
    int32_t ball[DEM_LINE_LANES];
    memcpy(at, end->at, sizeof at);
    memcpy(ball, end->ball, sizeof ball);
    for (size_t j = 0; j < count; j++) {
        const float *restrict from = task->from[j], *restrict to = task->to[j];
        int32_t who = (int32_t)j;
        for (int l = 0; l < DEM_LINE_LANES; l++) {
            float t = from[l] <= at[l] ? to[l] : -nowhere;
            ball[l] = t > at[l] ? who : ball[l];
            at[l] = t > at[l] ? t : at[l];
        }
    }
    memcpy(end->at, at, sizeof at);
    memcpy(end->ball, ball, sizeof ball);
}

// the lowest begin of an interval beyond `end`; false: it is not the end, a ball goes on from there
static bool next_begin(const dem_line_task *task, size_t count, const strip_front *restrict end,
                       strip_front *restrict begin)
{
    float at[DEM_LINE_LANES], passed[DEM_LINE_LANES];
    int32_t ball[DEM_LINE_LANES], on[DEM_LINE_LANES], any = 0;
    memcpy(passed, end->at, sizeof passed);
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        at[l] = nowhere;
        ball[l] = on[l] = 0;
    }
    for (size_t j = 0; j < count; j++) {
        const float *restrict from = task->from[j], *restrict to = task->to[j];
        int32_t who = (int32_t)j;
        for (int l = 0; l < DEM_LINE_LANES; l++) {
            float f = from[l] > passed[l] ? from[l] : nowhere;
            on[l] |= (from[l] <= passed[l]) & (to[l] > passed[l]);
            ball[l] = f < at[l] ? who : ball[l];
            at[l] = f < at[l] ? f : at[l];
        }
    }
    for (int l = 0; l < DEM_LINE_LANES; l++)
        any |= on[l];
    memcpy(begin->at, at, sizeof at);
    memcpy(begin->ball, ball, sizeof ball);
    return !any;
}

// The end of the union's interval that begins at `begin`, and where the next one begins. Balls come by their centres
// along the lines, so one pass reaches the end nearly always.
static void find_end(const dem_line_task *task, size_t count, const strip_front *begin, strip_front *restrict end,
                     strip_front *restrict next)
{
    *end = *begin;
    do
        move_end(task, count, end);
    while (!next_begin(task, count, end, next));
}

/// Ends against the grain: the length of the line inside it before the end, and whether the end itself is.
typedef struct strip_inside {
    float before[DEM_LINE_LANES], inside[DEM_LINE_LANES];
} strip_inside;

static void compare_spans(const dem_line_field *field, uint32_t strip, const float *restrict end,
                          strip_inside *restrict result)
{
    for (int l = 0; l < DEM_LINE_LANES; l++)
        result->before[l] = result->inside[l] = 0;
    for (uint32_t s = field->span[strip]; s < field->span[strip + 1]; s++) {
        const float *restrict enter = field->spans[s][0], *restrict leave = field->spans[s][1];
        for (int l = 0; l < DEM_LINE_LANES; l++) {
            float z = end[l], up = z > enter[l] ? z : enter[l];
            up = up < leave[l] ? up : leave[l];
            result->before[l] += up - enter[l];
            result->inside[l] += ((z > enter[l]) & (z < leave[l])) ? 1.0f : 0.0f;
        }
    }
}

/// A strip and the balls it meets.
typedef struct strip_place {
    const dem_ball_columns *balls;
    const dem_line_task *task;
    const uint32_t *list;
    size_t count;
    uint32_t strip;
    float x, y;       ///< of the first line
} strip_place;

// the intervals of all balls, their radii raised by `grow`; `begin` gets where the first ones begin
static void set_ends(const strip_place *place, float grow, strip_front *restrict begin)
{
    const dem_line_task *task = place->task;
    front_nowhere(begin);
    for (size_t k = 0; k < place->count; k++) {
        strip_ball ball = strip_view(place->balls, task->field->axis, place->list[k], place->x, place->y, grow);
        strip_ends(ball, (int32_t)k, task->field->step, task->from[k], task->to[k], begin);
    }
}

// what ends that lie on the line add to the sums of their balls
static void add_sums(const strip_place *place, const strip_front *front, const strip_inside *against)
{
    const dem_line_field *field = place->task->field;
    const float *axes[3] = {place->balls->x, place->balls->y, place->balls->z};
    const float *u = axes[(field->axis + 1) % 3], *v = axes[(field->axis + 2) % 3], *w = axes[field->axis];
    float outside = place->task->protruding, inside = -place->task->uncovered;
    float sums[4][DEM_LINE_LANES];
    uint32_t ball[DEM_LINE_LANES];
    for (int l = 0; l < DEM_LINE_LANES; l++)
        ball[l] = place->list[front->ball[l]];
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        uint32_t i = ball[l];
        float across = place->x + (float)l * field->step - u[i], along = front->at[l] - w[i];
        float s = front->at[l] < nowhere ? (against->inside[l] > 0 ? inside : outside) * fabsf(along) : 0;
        sums[0][l] = s * across;
        sums[1][l] = s * (place->y - v[i]);
        sums[2][l] = s * (front->at[l] < nowhere ? along : 0);
        sums[3][l] = s;
    }
    for (int l = 0; l < DEM_LINE_LANES; l++)
        for (int k = 0; k < 4; k++)
            place->task->sums[ball[l]][k] += sums[k][l];
}

typedef struct strip_sums {
    float covered[DEM_LINE_LANES], common[DEM_LINE_LANES];
} strip_sums;

static void add_strip(const strip_place *place, strip_sums *restrict sums, bool gradient)
{
    const dem_line_task *task = place->task;
    strip_front begin, end, next;
    set_ends(place, 0, &begin);
    for (; any_below(begin.at, nowhere); begin = next) {
        strip_inside low, high;
        find_end(task, place->count, &begin, &end, &next);
        compare_spans(task->field, place->strip, begin.at, &low);
        compare_spans(task->field, place->strip, end.at, &high);
        for (int l = 0; l < DEM_LINE_LANES; l++) {
            sums->covered[l] += end.at[l] - begin.at[l];
            sums->common[l] += high.before[l] - low.before[l];
        }
        if (gradient) {
            add_sums(place, &begin, &low);
            add_sums(place, &end, &high);
        }
    }
}

static strip_place place_strip(const dem_ball_columns *balls, const dem_line_task *task, int32_t row, uint32_t strip)
{
    const dem_line_field *field = task->field;
    uint32_t at = strip - field->strip[task->begin];
    int32_t column = field->first[row] + (int32_t)(strip - field->strip[row]) * DEM_LINE_LANES;
    return (strip_place){balls, task, task->list + task->start[at], task->start[at + 1] - task->start[at], strip,
                         field->origin[0] + (float)column * field->step, field->origin[1] + (float)row * field->step};
}

static void measure(const dem_ball_columns *balls, dem_line_task *task, bool gradient)
{
    const dem_line_field *field = task->field;
    double covered = 0, common = 0;
    for (int32_t row = task->begin; row < task->end; row++) {
        strip_sums sums = {{0}, {0}};
        for (uint32_t s = field->strip[row]; s < field->strip[row + 1]; s++) {
            strip_place place = place_strip(balls, task, row, s);
            if (place.count)
                add_strip(&place, &sums, gradient);
        }
        for (int l = 0; l < DEM_LINE_LANES; l++) {
            covered += (double)sums.covered[l];
            common += (double)sums.common[l];
        }
    }
    task->covered = covered;
    task->common = common;
}

// ---- leaving balls out

/// Intervals of the union on the lines of a strip that hold whatever balls do within the slack.
typedef struct strip_cover {
    strip_front begin[MOST_INTERVALS], end[MOST_INTERVALS];
    size_t count;
} strip_cover;

static void keep(const strip_front *front, const int32_t *restrict which, unsigned char *kept)
{
    for (int l = 0; l < DEM_LINE_LANES; l++)
        if (which[l])
            kept[front->ball[l]] = 1;
}

// Moves `end` on to the farthest end of a ball that it lies in; keeps the balls that did. False: none did.
static bool reach_on(const dem_line_task *task, size_t count, strip_front *restrict end)
{
    float at[DEM_LINE_LANES], passed[DEM_LINE_LANES];
    int32_t ball[DEM_LINE_LANES], farther[DEM_LINE_LANES], any = 0;
    memcpy(at, end->at, sizeof at);
    memcpy(passed, end->at, sizeof passed);
    memcpy(ball, end->ball, sizeof ball);
    for (size_t j = 0; j < count; j++) {
        const float *restrict from = task->from[j], *restrict to = task->to[j];
        int32_t who = (int32_t)j;
        for (int l = 0; l < DEM_LINE_LANES; l++) {
            float t = from[l] <= passed[l] ? to[l] : -nowhere;
            ball[l] = t > at[l] ? who : ball[l];
            at[l] = t > at[l] ? t : at[l];
        }
    }
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        farther[l] = at[l] > passed[l];
        any |= farther[l];
    }
    memcpy(end->at, at, sizeof at);
    memcpy(end->ball, ball, sizeof ball);
    keep(end, farther, task->kept);
    return any;
}

// The union of the balls of `task->from` and `to`, made up from as few of them as it takes: those are kept. False: too
// many intervals.
static bool find_cover(const dem_line_task *task, size_t count, const strip_front *first, strip_cover *restrict cover)
{
    strip_front begin = *first, end, next;
    cover->count = 0;
    for (; any_below(begin.at, nowhere); begin = next) {
        int32_t there[DEM_LINE_LANES];
        if (cover->count == MOST_INTERVALS)
            return false;
        for (int l = 0; l < DEM_LINE_LANES; l++)
            there[l] = begin.at[l] < nowhere;
        keep(&begin, there, task->kept);
        end = begin;
        while (reach_on(task, count, &end))
            ;
        next_begin(task, count, &end, &next);
        cover->begin[cover->count] = begin;
        cover->end[cover->count++] = end;
    }
    return true;
}

// does a ball lie within the cover on all lines?
static bool is_covered(const strip_cover *restrict cover, strip_ball ball, float step)
{
    float from[DEM_LINE_LANES], to[DEM_LINE_LANES], beyond[DEM_LINE_LANES];
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        float off = (float)l * step - ball.u, rest = ball.reach2 - off * off;
        float half = sqrtf(rest > 0 ? rest : 0);
        from[l] = ball.w - half;
        to[l] = ball.w + half;
        beyond[l] = rest > 0 ? 1.0f : 0.0f;
    }
    for (size_t m = 0; m < cover->count; m++) {
        const float *restrict begin = cover->begin[m].at, *restrict end = cover->end[m].at;
        for (int l = 0; l < DEM_LINE_LANES; l++)
            beyond[l] = ((from[l] > begin[l]) & (to[l] < end[l])) ? 0.0f : beyond[l];
    }
    return !any_above(beyond, 0.5f);
}

// the balls of the strip that are needed, written to `list`; returns their number
static uint32_t cull_strip(const strip_place *place, float slack, uint32_t *list)
{
    const dem_line_task *task = place->task;
    strip_front begin;
    strip_cover cover;
    uint32_t count = 0;
    memset(task->kept, 0, place->count);
    set_ends(place, -slack, &begin);
    bool found = find_cover(task, place->count, &begin, &cover);
    for (size_t k = 0; k < place->count; k++) {
        uint32_t i = place->list[k];
        strip_ball grown = strip_view(place->balls, task->field->axis, i, place->x, place->y, slack);
        if (!found || task->kept[k] || !is_covered(&cover, grown, task->field->step))
            list[count++] = i;
    }
    return count;
}

static void cull(const dem_ball_columns *balls, dem_line_task *task, float slack)
{
    const dem_line_field *field = task->field;
    uint32_t at = 0;
    for (int32_t row = task->begin; row < task->end; row++)
        for (uint32_t s = field->strip[row]; s < field->strip[row + 1]; s++) {
            strip_place place = place_strip(balls, task, row, s);
            task->start[s - field->strip[task->begin]] = at;
            at += cull_strip(&place, slack, task->list + at);
        }
    task->start[field->strip[task->end] - field->strip[task->begin]] = at;
}

const dem_line_kernels DEM_LEVEL_OF(dem_line_kernels) = {.measure = measure, .cull = cull};
