// On a line along axis w the union of the balls is a set of intervals; where an end of one is exposed, moving the ball
// moves it. The flux of that motion through the plane across w, weighted by n_w^2, sums over the three axes to the
// surface integral, because n_x^2 + n_y^2 + n_z^2 = 1, and stays finite where a line grazes a ball.
#include "clump/pack_lines.h"

#include "base/status.h"

static const double margin = 0.1;                      // lines are kept this far around the grain's shadow [d_eq]
static const double offsets[2] = {0.38197, 0.2764};    // generic place of the grids
static const float far_away = 1e9f;

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

static dem_status take_work_space(dem_lines *lines, dem_error *error)
{
    for (int k = 0; k < DEM_LINE_TASKS; k++) {
        dem_line_task *task = &lines->tasks[k];
        task->lanes = dem_arena_take(&lines->arena, lines->capacity, sizeof *task->lanes);
        task->active = dem_arena_take(&lines->arena, lines->capacity, sizeof *task->active);
        task->strip_balls = dem_arena_take(&lines->arena, lines->capacity, sizeof *task->strip_balls);
        task->from = dem_arena_take(&lines->arena, lines->capacity, sizeof *task->from);
        task->to = dem_arena_take(&lines->arena, lines->capacity, sizeof *task->to);
    }
    return lines->arena.failed ? dem_fail_memory(error) : DEM_OK;
}

dem_status dem_lines_build(const dem_pack_grain *grain, const dem_pack_kernels *kernels, double step, size_t capacity,
                           int threads, dem_lines *lines, dem_error *error)
{
    *lines = (dem_lines){.kernels = kernels, .capacity = capacity, .threads = threads};
    dem_status status = DEM_OK;
    for (int axis = 0; axis < 3 && status == DEM_OK; axis++) {
        dem_columns columns;
        status = dem_columns_build(grain, axis, step, margin, offsets, &columns, error);
        if (status != DEM_OK)
            break;
        status = fill_field(lines, &columns, &lines->fields[axis], error);
        lines->grain_length[axis] = length_inside(&columns);
        dem_columns_release(&columns);
        if (status == DEM_OK)
            share_rows(lines, axis);
    }
    if (status == DEM_OK)
        status = take_work_space(lines, error);
    if (status != DEM_OK)
        dem_lines_release(lines);
    return status;
}

void dem_lines_release(dem_lines *lines)
{
    dem_arena_release(&lines->arena);
    *lines = (dem_lines){0};
}

static double lane_sum(const float lanes[DEM_LINE_LANES])
{
    double sum = 0;
    for (int l = 0; l < DEM_LINE_LANES; l++)
        sum += (double)lanes[l];
    return sum;
}

static void add_gradient(const dem_line_task *task, const dem_ball_columns *balls, double (*gradient)[4])
{
    int w = task->field->axis, u = (w + 1) % 3, v = (w + 2) % 3;
    double cell = (double)task->field->step * (double)task->field->step;
    for (size_t i = 0; i < balls->count; i++) {
        const dem_line_lanes *lanes = &task->lanes[i];
        double r = (double)balls->r[i], scale = cell / r;
        gradient[i][u] += scale / r * lane_sum(lanes->across[0]);
        gradient[i][v] += scale / r * lane_sum(lanes->across[1]);
        gradient[i][w] += scale / r * lane_sum(lanes->along);
        gradient[i][3] += scale * lane_sum(lanes->radial);
    }
}

dem_line_volumes dem_lines_measure(dem_lines *lines, const dem_ball_columns *balls, double (*gradient)[4])
{
    DEM_ASSERT(balls->count <= lines->capacity);
#pragma omp parallel for num_threads(lines->threads) schedule(dynamic, 1) if (lines->threads > 1)
    for (int k = 0; k < DEM_LINE_TASKS; k++) {
        dem_line_task task = lines->tasks[k];
        for (size_t i = 0; i < balls->count; i++)
            task.lanes[i] = (dem_line_lanes){0};
        task.lanes = gradient ? task.lanes : NULL;
        lines->kernels->lines(balls, &task);
        lines->tasks[k].covered = task.covered;
        lines->tasks[k].common = task.common;
    }
    double length[3] = {0, 0, 0};
    for (size_t i = 0; i < balls->count && gradient; i++)
        gradient[i][0] = gradient[i][1] = gradient[i][2] = gradient[i][3] = 0;
    for (int k = 0; k < DEM_LINE_TASKS; k++) {
        length[1] += lines->tasks[k].covered;
        length[2] += lines->tasks[k].common;
        if (gradient)
            add_gradient(&lines->tasks[k], balls, gradient);
    }
    for (int axis = 0; axis < 3; axis++)
        length[0] += lines->grain_length[axis];
    double cell = (double)lines->fields[0].step * (double)lines->fields[0].step / 3;
    dem_line_volumes volumes = {.grain = cell * length[0], .covered = cell * length[1], .common = cell * length[2]};
    volumes.difference = volumes.grain + volumes.covered - 2 * volumes.common;
    volumes.gap = 1 - volumes.common / (volumes.grain + volumes.covered - volumes.common);
    return volumes;
}
