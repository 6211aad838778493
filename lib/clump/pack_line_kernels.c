// Lines through the union of balls, strip by strip; compiled once per instruction set as pack_kernels.c.
//
// A strip meets some dozen to a hundred balls, and on each line only two or three of them end at the surface. A ball is
// left out of a strip's list as long as no move within the slack can bring it to the surface: raised by the slack it
// must lie in the union of others that are lowered by it, and these others stay in the list. So results are the same
// with and without, but for balls that end at the same place to the last bit: of these the first in the list counts.
#include <string.h>

#include "base/level.h"
#include "base/simd.h"
#include "clump/pack_kernels.h"

enum { MOST_INTERVALS = 6 };  // of a cover: a strip with more of them keeps all its balls
enum { WIDTH = DEM_WIDTH_FLOAT, PARTS = DEM_LINE_LANES / WIDTH };  // of the lines of a strip, taken together

static const float nowhere = 1e9f;
static const float ramp[DEM_LINE_LANES] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

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
    float ball[DEM_LINE_LANES];
} strip_front;

/// The same in registers.
typedef struct front {
    widef at[PARTS], ball[PARTS];
} front;

DEM_INLINE front front_load(const strip_front *f)
{
    front out;
    for (int p = 0; p < PARTS; p++) {
        out.at[p] = widef_load(f->at + p * WIDTH);
        out.ball[p] = widef_load(f->ball + p * WIDTH);
    }
    return out;
}

DEM_INLINE void front_store(strip_front *f, const front *in)
{
    for (int p = 0; p < PARTS; p++) {
        widef_store(f->at + p * WIDTH, in->at[p]);
        widef_store(f->ball + p * WIDTH, in->ball[p]);
    }
}

// the lines whose bits are set
DEM_INLINE uint32_t lines_of(const widef_mask *m)
{
    uint32_t bits = 0;
    for (int p = 0; p < PARTS; p++)
        bits |= widef_bits(m[p]) << (p * WIDTH);
    return bits;
}

static uint32_t lines_below(const float *a, float limit)
{
    widef_mask m[PARTS];
    for (int p = 0; p < PARTS; p++)
        m[p] = widef_below(widef_load(a + p * WIDTH), widef_all(limit));
    return lines_of(m);
}

// half a ball's length on some lines, 0 where it does not meet them
DEM_INLINE widef half_length(strip_ball ball, float step, int part, widef_mask *meets)
{
    widef off = widef_load(ramp + part * WIDTH) * widef_all(step) - widef_all(ball.u);
    widef rest = widef_all(ball.reach2) - off * off;
    *meets = widef_below(widef_all(0), rest);
    return widef_sqrt(widef_select(*meets, rest, widef_all(0)));
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

// The intervals of all balls on each line, their radii raised by `grow`; empty ones are inside out and far away.
// `begin` gets where the first ones begin.
static void set_ends(const strip_place *place, float grow, strip_front *begin)
{
    const dem_line_task *task = place->task;
    const widef far = widef_all(nowhere), back = widef_all(-nowhere);
    front f;
    for (int p = 0; p < PARTS; p++) {
        f.at[p] = far;
        f.ball[p] = widef_all(0);
    }
    for (size_t k = 0; k < place->count; k++) {
        strip_ball ball = strip_view(place->balls, task->field->axis, place->list[k], place->x, place->y, grow);
        widef who = widef_all((float)k), w = widef_all(ball.w);
        for (int p = 0; p < PARTS; p++) {
            widef_mask meets;
            widef half = half_length(ball, task->field->step, p, &meets);
            widef from = widef_select(meets, w - half, far);
            widef_store(task->from[k] + p * WIDTH, from);
            widef_store(task->to[k] + p * WIDTH, widef_select(meets, w + half, back));
            f.ball[p] = widef_select(widef_below(from, f.at[p]), who, f.ball[p]);
            f.at[p] = widef_min(from, f.at[p]);
        }
    }
    front_store(begin, &f);
}

// moves the end of the union's interval on as far as the balls reach, seen in their order
static void move_end(const dem_line_task *task, size_t count, strip_front *end)
{
    const widef back = widef_all(-nowhere);
    front f = front_load(end);
    for (size_t j = 0; j < count; j++) {
        widef who = widef_all((float)j);
        for (int p = 0; p < PARTS; p++) {
            widef from = widef_load(task->from[j] + p * WIDTH), to = widef_load(task->to[j] + p * WIDTH);
            to = widef_select(widef_up_to(from, f.at[p]), to, back);
            f.ball[p] = widef_select(widef_below(f.at[p], to), who, f.ball[p]);
            f.at[p] = widef_max(to, f.at[p]);
        }
    }
    front_store(end, &f);
}

// the lowest begin of an interval beyond `end`; false: it is not the end, a ball goes on from there
static bool next_begin(const dem_line_task *task, size_t count, const strip_front *end, strip_front *begin)
{
    const widef far = widef_all(nowhere);
    front f, passed = front_load(end);
    widef_mask on[PARTS];
    for (int p = 0; p < PARTS; p++) {
        f.at[p] = far;
        f.ball[p] = widef_all(0);
        on[p] = widef_below(far, far);
    }
    for (size_t j = 0; j < count; j++) {
        widef who = widef_all((float)j);
        for (int p = 0; p < PARTS; p++) {
            widef from = widef_load(task->from[j] + p * WIDTH), to = widef_load(task->to[j] + p * WIDTH);
            on[p] = widef_either(on[p], widef_and(widef_up_to(from, passed.at[p]), widef_below(passed.at[p], to)));
            from = widef_select(widef_below(passed.at[p], from), from, far);
            f.ball[p] = widef_select(widef_below(from, f.at[p]), who, f.ball[p]);
            f.at[p] = widef_min(from, f.at[p]);
        }
    }
    front_store(begin, &f);
    return !lines_of(on);
}

// The end of the union's interval that begins at `begin`, and where the next one begins. Balls come by their centres
// along the lines, so one pass reaches the end nearly always.
static void find_end(const dem_line_task *task, size_t count, const strip_front *begin, strip_front *end,
                     strip_front *next)
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

static void compare_spans(const dem_line_field *field, uint32_t strip, const float *end, strip_inside *result)
{
    for (int p = 0; p < PARTS; p++) {
        widef before = widef_all(0), inside = widef_all(0), z = widef_load(end + p * WIDTH);
        for (uint32_t s = field->span[strip]; s < field->span[strip + 1]; s++) {
            widef enter = widef_load(field->spans[s][0] + p * WIDTH);
            widef leave = widef_load(field->spans[s][1] + p * WIDTH);
            widef_mask in = widef_and(widef_below(enter, z), widef_below(z, leave));
            before = before + (widef_min(widef_max(z, enter), leave) - enter);
            inside = inside + widef_select(in, widef_all(1), widef_all(0));
        }
        widef_store(result->before + p * WIDTH, before);
        widef_store(result->inside + p * WIDTH, inside);
    }
}

// What ends that lie on the line add to the sums of their balls. Neighbouring lines mostly end at the same ball.
static void add_sums(const strip_place *place, const strip_front *ends, const strip_inside *against)
{
    const dem_line_field *field = place->task->field;
    const float *axes[3] = {place->balls->x, place->balls->y, place->balls->z};
    const float *u = axes[(field->axis + 1) % 3], *v = axes[(field->axis + 2) % 3], *w = axes[field->axis];
    const widef outside = widef_all(place->task->protruding), inside = widef_all(-place->task->uncovered);
    float(*sums)[4] = place->task->sums, *into = NULL, sum[4], weight[DEM_LINE_LANES];
    for (int p = 0; p < PARTS; p++) {
        widef_mask in = widef_below(widef_all(0), widef_load(against->inside + p * WIDTH));
        widef_store(weight + p * WIDTH, widef_select(in, inside, outside));
    }
    for (uint32_t there = lines_below(ends->at, nowhere); there; there &= there - 1) {
        int l = __builtin_ctz(there);
        uint32_t i = place->list[(uint32_t)ends->ball[l]];
        if (into != sums[i]) {
            if (into)
                memcpy(into, sum, sizeof sum);
            into = sums[i];
            memcpy(sum, into, sizeof sum);
        }
        float across = place->x + (float)l * field->step - u[i], along = ends->at[l] - w[i];
        float s = weight[l] * fabsf(along);
        const float by[4] = {across, place->y - v[i], along, 1};
        for (int k = 0; k < 4; k++)
            sum[k] += s * by[k];
    }
    if (into)
        memcpy(into, sum, sizeof sum);
}

typedef struct strip_sums {
    float covered[DEM_LINE_LANES], common[DEM_LINE_LANES];
} strip_sums;

static void add_strip(const strip_place *place, strip_sums *sums, bool gradient)
{
    const dem_line_task *task = place->task;
    strip_front begin, end, next;
    set_ends(place, 0, &begin);
    for (; lines_below(begin.at, nowhere); begin = next) {
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

static strip_place place_strip(const dem_ball_columns *balls, const dem_line_task *task, const dem_strip_lists *lists,
                               int32_t row, uint32_t strip)
{
    const dem_line_field *field = task->field;
    uint32_t at = strip - field->strip[task->begin];
    int32_t column = field->first[row] + (int32_t)(strip - field->strip[row]) * DEM_LINE_LANES;
    return (strip_place){balls, task, lists->list + lists->start[at], lists->start[at + 1] - lists->start[at], strip,
                         field->origin[0] + (float)column * field->step, field->origin[1] + (float)row * field->step};
}

static void measure(const dem_ball_columns *balls, dem_line_task *task, const dem_strip_lists *lists, bool gradient)
{
    const dem_line_field *field = task->field;
    double covered = 0, common = 0;
    for (int32_t row = task->begin; row < task->end; row++) {
        strip_sums sums = {{0}, {0}};
        for (uint32_t s = field->strip[row]; s < field->strip[row + 1]; s++) {
            strip_place place = place_strip(balls, task, lists, row, s);
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
    float core[MOST_INTERVALS][2];  // what an interval holds of all lines of the strip; ends far away: nothing
    size_t count;
} strip_cover;

static void set_core(strip_cover *cover, size_t m)
{
    float *core = cover->core[m];
    core[0] = -nowhere;
    core[1] = nowhere;
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        core[0] = cover->begin[m].at[l] > core[0] ? cover->begin[m].at[l] : core[0];
        core[1] = cover->end[m].at[l] < core[1] ? cover->end[m].at[l] : core[1];
    }
}

static void keep(const float *ball, uint32_t lines, unsigned char *kept)
{
    for (; lines; lines &= lines - 1)
        kept[(uint32_t)ball[__builtin_ctz(lines)]] = 1;
}

// Moves `end` on as far as the balls reach, by as few of them as it takes, and keeps these: each goes on to the
// farthest end of those that begin before the last one ends. Balls come by their centres, not by where they begin, so
// it may stop early.
static void chain_on(const dem_line_task *task, size_t count, strip_front *end)
{
    const widef back = widef_all(-nowhere);
    front f = front_load(end);  // the farthest that balls reach which begin before `at`
    widef at[PARTS];
    widef_mask next[PARTS];
    memcpy(at, f.at, sizeof at);
    for (size_t j = 0; j < count; j++) {
        widef who = widef_all((float)j), from[PARTS];
        for (int p = 0; p < PARTS; p++) {
            from[p] = widef_load(task->from[j] + p * WIDTH);
            next[p] = widef_and(widef_below(at[p], from[p]), widef_up_to(from[p], f.at[p]));
        }
        uint32_t lines = lines_of(next);
        if (lines) {
            front_store(end, &f);
            keep(end->ball, lines, task->kept);
            for (int p = 0; p < PARTS; p++)
                at[p] = widef_select(next[p], f.at[p], at[p]);
        }
        for (int p = 0; p < PARTS; p++) {
            widef to = widef_select(widef_up_to(from[p], at[p]), widef_load(task->to[j] + p * WIDTH), back);
            f.ball[p] = widef_select(widef_below(f.at[p], to), who, f.ball[p]);
            f.at[p] = widef_max(to, f.at[p]);
        }
    }
    front_store(end, &f);
    for (int p = 0; p < PARTS; p++)
        next[p] = widef_below(at[p], f.at[p]);
    keep(end->ball, lines_of(next), task->kept);
}

// The union of the balls of `task->from` and `to`, made up from as few of them as it takes: those are kept. False: too
// many intervals.
static bool find_cover(const dem_line_task *task, size_t count, const strip_front *first, strip_cover *cover)
{
    strip_front begin = *first, next;
    uint32_t lines;
    cover->count = 0;
    for (; (lines = lines_below(begin.at, nowhere)); begin = next) {
        if (cover->count == MOST_INTERVALS)
            return false;
        strip_front *end = &cover->end[cover->count];
        keep(begin.ball, lines, task->kept);
        cover->begin[cover->count] = *end = begin;
        do
            chain_on(task, count, end);
        while (!next_begin(task, count, end, &next));
        set_core(cover, cover->count++);
    }
    return true;
}

// The same as is_covered, without looking at the lines one by one; false: they must be looked at.
static bool is_in_core(const strip_cover *cover, strip_ball ball, float step)
{
    float last = ramp[DEM_LINE_LANES - 1] * step;
    float off = ball.u < 0 ? ball.u : ball.u > last ? last - ball.u : 0, rest = ball.reach2 - off * off;
    if (!(rest > 0))
        return true;
    float half = sqrtf(rest);
    for (size_t m = 0; m < cover->count; m++)
        if (ball.w - half > cover->core[m][0] && ball.w + half < cover->core[m][1])
            return true;
    return false;
}

// does a ball lie within the cover on all lines?
static bool is_covered(const strip_cover *cover, strip_ball ball, float step)
{
    uint32_t beyond = 0;
    for (int p = 0; p < PARTS; p++) {
        widef_mask meets;
        widef half = half_length(ball, step, p, &meets);
        widef from = widef_all(ball.w) - half, to = widef_all(ball.w) + half;
        uint32_t bits = widef_bits(meets);
        for (size_t m = 0; m < cover->count; m++)
            bits &= ~widef_bits(widef_and(widef_below(widef_load(cover->begin[m].at + p * WIDTH), from),
                                          widef_below(to, widef_load(cover->end[m].at + p * WIDTH))));
        beyond |= bits;
    }
    return !beyond;
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
        if (!found || task->kept[k] ||
            !(is_in_core(&cover, grown, task->field->step) || is_covered(&cover, grown, task->field->step)))
            list[count++] = i;
    }
    return count;
}

static void cull(const dem_ball_columns *balls, dem_line_task *task, const dem_strip_lists *from, dem_strip_lists *to,
                 float slack)
{
    const dem_line_field *field = task->field;
    uint32_t at = 0;
    for (int32_t row = task->begin; row < task->end; row++)
        for (uint32_t s = field->strip[row]; s < field->strip[row + 1]; s++) {
            strip_place place = place_strip(balls, task, from, row, s);
            to->start[s - field->strip[task->begin]] = at;
            at += cull_strip(&place, slack, to->list + at);
        }
    to->start[field->strip[task->end] - field->strip[task->begin]] = at;
}

const dem_line_kernels DEM_LEVEL_OF(dem_line_kernels) = {.measure = measure, .cull = cull};
