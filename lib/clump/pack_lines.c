// On a line along axis w the union of the balls is a set of intervals; where an end of one is exposed, moving the ball
// moves it. The flux of that motion through the plane across w, weighted by n_w^2, sums over the three axes to the
// surface integral, because n_x^2 + n_y^2 + n_z^2 = 1, and stays finite where a line grazes a ball.
#include "clump/pack_lines.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

static const double margin = 0.1;                      // lines are kept this far around the grain's shadow [d_eq]
static const float far_away = 1e9f;
static const float rounding = 1e-6f;

// The lists of strips hold while no ball changes by more than the slack [d_eq]. With little of it they are short, with
// much they last: between the two it goes by how many evaluations the last lists served. Those with little are made
// from those with much.
typedef struct slack_range {
    float first, least, most;
    int short_lived, long_lived;
} slack_range;
static const slack_range wide_slack = {0.03f, 0.01f, 0.04f, 10, 60}, close_slack = {0.006f, 0.001f, 0.02f, 4, 10};
static const float slack_factor = 1.5f;
enum { FEW_BALLS = 8 };  // on a strip: none is worth leaving out

static uint32_t strips_of(const dem_columns *c, int32_t row)
{
    return (c->line[row + 1] - c->line[row] + DEM_LINE_LANES - 1) / DEM_LINE_LANES;
}

static uint32_t spans_on(const dem_columns *c, uint32_t line, uint32_t end)
{
    return line < end ? (c->start[line + 1] - c->start[line]) / 2 : 0;
}

// the spans of one strip, lane by lane
static uint32_t fill_strip(const dem_columns *c, uint32_t line, uint32_t end, float (*spans)[2][DEM_LINE_LANES])
{
    uint32_t most = 0;
    for (uint32_t l = 0; l < DEM_LINE_LANES; l++) {
        uint32_t n = spans_on(c, line + l, end);
        most = n > most ? n : most;
    }
    for (uint32_t s = 0; s < most && spans; s++)
        for (uint32_t l = 0; l < DEM_LINE_LANES; l++) {
            bool has = s < spans_on(c, line + l, end);
            const float *crossing = has ? c->crossing + c->start[line + l] + 2 * s : NULL;
            spans[s][0][l] = has ? crossing[0] : far_away;
            spans[s][1][l] = has ? crossing[1] : far_away;
        }
    return most;
}

static dem_status fill_field(dem_lines *lines, const dem_columns *c, dem_line_field *field, dem_error *error)
{
    *field = (dem_line_field){.axis = c->axis, .step = (float)c->step, .row_count = c->row_count,
                              .origin = {(float)c->origin[0], (float)c->origin[1]}};
    field->first = dem_arena_take(&lines->arena, (size_t)c->row_count, sizeof *field->first);
    field->strip = dem_arena_take(&lines->arena, (size_t)c->row_count + 1, sizeof *field->strip);
    if (lines->arena.failed)
        return dem_fail_memory(error);
    field->strip[0] = 0;
    for (int32_t j = 0; j < c->row_count; j++) {
        field->first[j] = c->first[j];
        field->strip[j + 1] = field->strip[j] + strips_of(c, j);
    }
    field->span = dem_arena_take(&lines->arena, (size_t)field->strip[c->row_count] + 1, sizeof *field->span);
    if (lines->arena.failed)
        return dem_fail_memory(error);
    for (int pass = 0; pass < 2; pass++) {
        uint32_t at = 0;
        for (int32_t j = 0; j < c->row_count; j++)
            for (uint32_t s = field->strip[j]; s < field->strip[j + 1]; s++) {
                uint32_t line = c->line[j] + (s - field->strip[j]) * DEM_LINE_LANES;
                field->span[s] = at;
                at += fill_strip(c, line, c->line[j + 1], pass ? field->spans + at : NULL);
            }
        field->span[field->strip[c->row_count]] = at;
        if (pass == 0)
            field->spans = dem_arena_take(&lines->arena, at, sizeof *field->spans);
        if (lines->arena.failed)
            return dem_fail_memory(error);
    }
    return DEM_OK;
}

static double length_inside(const dem_columns *c)
{
    double length = 0;
    for (size_t k = 0; k < c->start[columns_lines(c)]; k += 2)
        length += (double)c->crossing[k + 1] - (double)c->crossing[k];
    return length;
}

// equal numbers of strips for each task of an axis
static void share_rows(dem_lines *lines, int axis)
{
    enum { SHARES = DEM_LINE_TASKS / 3 };
    const dem_line_field *field = &lines->fields[axis];
    uint32_t strips = field->strip[field->row_count];
    int32_t row = 0;
    for (uint32_t k = 0; k < SHARES; k++) {
        dem_line_task *task = &lines->tasks[(uint32_t)axis * SHARES + k];
        task->field = field;
        task->begin = row;
        while (row < field->row_count && field->strip[row] < (k + 1) * (uint64_t)strips / SHARES)
            row++;
        task->end = k + 1 == SHARES ? field->row_count : row;
    }
}

static uint32_t strips_of_task(const dem_line_task *task)
{
    return task->field->strip[task->end] - task->field->strip[task->begin];
}

static dem_status take_work_space(dem_lines *lines, dem_error *error)
{
    for (int k = 0; k < DEM_LINE_TASKS; k++) {
        dem_line_task *task = &lines->tasks[k];
        task->sums = dem_arena_take(&lines->arena, lines->capacity, sizeof *task->sums);
        task->wide.start = dem_arena_take(&lines->arena, strips_of_task(task) + 1, sizeof *task->wide.start);
        task->close.start = dem_arena_take(&lines->arena, strips_of_task(task) + 1, sizeof *task->close.start);
        task->from = dem_arena_take(&lines->arena, lines->capacity, sizeof *task->from);
        task->to = dem_arena_take(&lines->arena, lines->capacity, sizeof *task->to);
        task->kept = dem_arena_take(&lines->arena, lines->capacity, sizeof *task->kept);
    }
    dem_ball_columns *w = &lines->wide.then, *c = &lines->close.then;
    float **columns[8] = {&w->x, &w->y, &w->z, &w->r, &c->x, &c->y, &c->z, &c->r};
    for (int k = 0; k < 8; k++)
        *columns[k] = dem_arena_take(&lines->arena, lines->capacity, sizeof(float));
    for (int axis = 0; axis < 3; axis++)
        lines->order[axis] = dem_arena_take(&lines->arena, lines->capacity, sizeof *lines->order[axis]);
    return lines->arena.failed ? dem_fail_memory(error) : DEM_OK;
}

// what the crew shares: the lines of each axis
typedef struct columns_of {
    const dem_pack_grain *grain;
    double step;
    const double *offsets;
    dem_columns columns[3];
    dem_status status[3];
    dem_error error[3];
} columns_of;

static void build_columns(void *user, int axis)
{
    columns_of *c = user;
    c->status[axis] =
        dem_columns_build(c->grain, axis, c->step, margin, c->offsets, &c->columns[axis], &c->error[axis]);
}

dem_status dem_lines_build(const dem_pack_grain *grain, const dem_pack_kernels *kernels, double step,
                           const double offsets[2], size_t capacity, dem_crew *crew, dem_lines *lines, dem_error *error)
{
    *lines = (dem_lines){.kernels = kernels, .capacity = capacity, .crew = crew,
                         .uncovered = 1, .protruding = 1, .wide.slack = wide_slack.first,
                         .close.slack = close_slack.first};
    columns_of of = {.grain = grain, .step = step, .offsets = offsets};
    dem_status status = DEM_OK;
    dem_crew_run(crew, 3, build_columns, &of);
    for (int axis = 0; axis < 3; axis++) {
        if (status == DEM_OK && of.status[axis] != DEM_OK) {
            status = of.status[axis];
            *error = of.error[axis];
        }
        if (status == DEM_OK)
            status = fill_field(lines, &of.columns[axis], &lines->fields[axis], error);
        if (status == DEM_OK) {
            lines->grain_length[axis] = length_inside(&of.columns[axis]);
            share_rows(lines, axis);
        }
        dem_columns_release(&of.columns[axis]);
    }
    if (status == DEM_OK)
        status = take_work_space(lines, error);
    if (status != DEM_OK)
        dem_lines_release(lines);
    return status;
}

void dem_lines_release(dem_lines *lines)
{
    for (int k = 0; k < DEM_LINE_TASKS; k++) {
        free(lines->tasks[k].wide.list);
        free(lines->tasks[k].close.list);
    }
    dem_arena_release(&lines->arena);
    *lines = (dem_lines){0};
}

// Counts the balls of each strip of the task, or with `fill` writes them. start[s] is where the balls of strip s end
// before, and begin after.
static void visit_strips(const dem_lines *lines, const dem_ball_columns *balls, dem_line_task *task, bool fill)
{
    const dem_placed_ball *order = lines->order[task->field->axis];
    const dem_line_field *field = task->field;
    const float *at[3] = {balls->x, balls->y, balls->z};
    const float *u = at[(field->axis + 1) % 3], *v = at[(field->axis + 2) % 3];
    float per_row = 1 / field->step, per_strip = 1 / (field->step * DEM_LINE_LANES);
    for (size_t k = balls->count; k-- > 0;) {
        uint32_t i = order[k].ball;
        float r = balls->r[i] + lines->wide.slack, from_row = (v[i] - r - field->origin[1]) * per_row;
        float to_row = (v[i] + r - field->origin[1]) * per_row;
        int32_t begin = from_row > (float)task->begin ? (int32_t)from_row : task->begin;
        int32_t end = to_row < (float)(task->end - 1) ? (int32_t)to_row + 1 : task->end;
        for (int32_t row = begin; row < end; row++) {
            float off = field->origin[1] + (float)row * field->step - v[i], reach2 = r * r - off * off;
            int32_t strips = (int32_t)(field->strip[row + 1] - field->strip[row]);
            if (reach2 <= 0 || strips == 0)
                continue;
            float reach = sqrtf(reach2), x = field->origin[0] + (float)field->first[row] * field->step;
            float from = (u[i] - reach - x) * per_strip, to = (u[i] + reach - x) * per_strip;
            if (to < 0 || from >= (float)strips)
                continue;
            int32_t first = from > 0 ? (int32_t)from : 0, last = to < (float)strips ? (int32_t)to : strips - 1;
            uint32_t *start = task->wide.start + (field->strip[row] - field->strip[task->begin]);
            for (int32_t s = first; s <= last; s++) {
                if (fill)
                    task->wide.list[--start[s]] = i;
                else
                    start[s]++;
            }
        }
    }
}

static bool reserve_list(dem_strip_lists *lists, size_t count)
{
    if (count <= lists->capacity && lists->list)
        return true;
    size_t capacity = count + count / 4 + 64;
    uint32_t *grown = realloc(lists->list, capacity * sizeof *grown);
    if (!grown)
        return false;
    lists->list = grown;
    lists->capacity = capacity;
    return true;
}

// which balls each strip of a task meets: a counting sort
static bool list_strips(const dem_lines *lines, const dem_ball_columns *balls, dem_line_task *task)
{
    uint32_t strips = strips_of_task(task), *start = task->wide.start;
    memset(start, 0, (strips + 1) * sizeof *start);
    visit_strips(lines, balls, task, false);
    for (uint32_t s = 1; s <= strips; s++)
        start[s] += start[s - 1];
    if (!reserve_list(&task->wide, start[strips]))
        return false;
    visit_strips(lines, balls, task, true);
    return true;
}

static bool comes_before(dem_placed_ball a, dem_placed_ball b)
{
    return a.along != b.along ? a.along < b.along : a.ball < b.ball;
}

// by insertion: from one evaluation to the next the order hardly changes
static void set_order(dem_lines *lines, const dem_ball_columns *balls)
{
    const float *at[3] = {balls->x, balls->y, balls->z};
    for (int axis = 0; axis < 3; axis++) {
        dem_placed_ball *order = lines->order[axis];
        for (size_t i = 0; i < balls->count; i++) {
            uint32_t ball = balls->count == lines->order_count ? order[i].ball : (uint32_t)i;
            dem_placed_ball placed = {at[axis][ball], ball};
            size_t k = i;
            for (; k > 0 && comes_before(placed, order[k - 1]); k--)
                order[k] = order[k - 1];
            order[k] = placed;
        }
    }
    lines->order_count = balls->count;
}

static void add_gradient(const dem_line_task *task, const dem_ball_columns *balls, double (*gradient)[4])
{
    int w = task->field->axis, u = (w + 1) % 3, v = (w + 2) % 3;
    double cell = (double)task->field->step * (double)task->field->step;
    for (size_t i = 0; i < balls->count; i++) {
        double r = (double)balls->r[i];
        gradient[i][u] += cell / (r * r) * (double)task->sums[i][0];
        gradient[i][v] += cell / (r * r) * (double)task->sums[i][1];
        gradient[i][w] += cell / (r * r) * (double)task->sums[i][2];
        gradient[i][3] += cell / r * (double)task->sums[i][3];
    }
}

static bool lists_hold(const dem_listing *listing, const dem_ball_columns *balls)
{
    const dem_ball_columns *then = &listing->then;
    bool hold = then->count == balls->count;
    for (size_t i = 0; i < balls->count && hold; i++) {
        float x = balls->x[i] - then->x[i], y = balls->y[i] - then->y[i], z = balls->z[i] - then->z[i];
        hold = sqrtf(x * x + y * y + z * z) + fabsf(balls->r[i] - then->r[i]) < listing->slack - rounding;
    }
    return hold;
}

// lists will be made of the balls as they are now
static void begin_lists(dem_listing *listing, const slack_range *range, const dem_ball_columns *balls)
{
    dem_ball_columns *then = &listing->then;
    if (then->count == balls->count && listing->served < range->short_lived)
        listing->slack = fminf(listing->slack * slack_factor, range->most);
    else if (then->count == balls->count && listing->served > range->long_lived)
        listing->slack = fmaxf(listing->slack / slack_factor, range->least);
    listing->served = 0;
    float *const to[4] = {then->x, then->y, then->z, then->r};
    float *const from[4] = {balls->x, balls->y, balls->z, balls->r};
    for (int k = 0; k < 4; k++)
        memcpy(to[k], from[k], balls->count * sizeof(float));
    then->count = balls->count;
}

static bool has_many_balls(const dem_line_task *task)
{
    uint32_t strips = strips_of_task(task);
    return task->wide.start[strips] > FEW_BALLS * strips;
}

// the lists that are to be made; false: no memory
static bool make_lists(const dem_lines *lines, const dem_ball_columns *balls, dem_line_task *task)
{
    const dem_line_kernels *kernels = lines->kernels->lines;
    if (lines->make_wide) {
        if (!list_strips(lines, balls, task))
            return false;
        if (has_many_balls(task))
            kernels->cull(balls, task, &task->wide, &task->wide, lines->wide.slack);
    }
    if (lines->make_close && has_many_balls(task)) {
        if (!reserve_list(&task->close, task->wide.start[strips_of_task(task)]))
            return false;
        kernels->cull(balls, task, &task->wide, &task->close, lines->close.slack);
    }
    return true;
}

static void run_task(const dem_lines *lines, const dem_ball_columns *balls, dem_line_task *task, bool gradient)
{
    if (gradient)
        memset(task->sums, 0, balls->count * sizeof *task->sums);
    task->uncovered = (float)lines->uncovered;
    task->protruding = (float)lines->protruding;
    task->failed = !make_lists(lines, balls, task);
    if (!task->failed)
        lines->kernels->lines->measure(balls, task, has_many_balls(task) ? &task->close : &task->wide, gradient);
}

// what the crew shares
typedef struct shared {
    dem_lines *lines;
    const dem_ball_columns *balls;
    bool gradient;
} shared;

static void run_part(void *user, int part)
{
    const shared *s = user;
    run_task(s->lines, s->balls, &s->lines->tasks[part], s->gradient);
}

dem_status dem_lines_measure(dem_lines *lines, const dem_ball_columns *balls, double (*gradient)[4],
                             dem_line_volumes *volumes, dem_error *error)
{
    DEM_ASSERT(balls->count <= lines->capacity);
    lines->make_wide = !lists_hold(&lines->wide, balls);
    lines->make_close = lines->make_wide || !lists_hold(&lines->close, balls);
    if (lines->make_wide) {
        begin_lists(&lines->wide, &wide_slack, balls);
        set_order(lines, balls);
    }
    if (lines->make_close)
        begin_lists(&lines->close, &close_slack, balls);
    lines->wide.served++;
    lines->close.served++;
    dem_crew_run(lines->crew, DEM_LINE_TASKS, run_part, &(shared){lines, balls, gradient != NULL});
    for (size_t i = 0; i < balls->count && gradient; i++)
        gradient[i][0] = gradient[i][1] = gradient[i][2] = gradient[i][3] = 0;
    double grain = lines->grain_length[0] + lines->grain_length[1] + lines->grain_length[2], covered = 0, common = 0;
    for (int k = 0; k < DEM_LINE_TASKS; k++) {
        if (lines->tasks[k].failed) {
            lines->wide.then.count = 0;
            return dem_fail_memory(error);
        }
        covered += lines->tasks[k].covered;
        common += lines->tasks[k].common;
        if (gradient)
            add_gradient(&lines->tasks[k], balls, gradient);
    }
    double cell = (double)lines->fields[0].step * (double)lines->fields[0].step / 3;
    *volumes = (dem_line_volumes){.grain = cell * grain, .covered = cell * covered, .common = cell * common,
                                  .difference = cell * (lines->uncovered * (grain - common) +
                                                        lines->protruding * (covered - common)),
                                  .gap = 1 - common / (grain + covered - common)};
    return DEM_OK;
}
