#include "study/course.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/status.h"
#include "math/quat.h"
#include "out/series.h"
#include "sim/population.h"
#include "sim/state.h"
#include "sim/timestep.h"

enum { STEPS_UNASKED = 2000 };

// ---- memory

static bool make_rows(dem_course *c, size_t rows)
{
    c->size = dem_alloc(c->bodies, sizeof *c->size);
    c->place = dem_alloc(3 * rows * c->bodies, sizeof *c->place);
    c->turn = dem_alloc(4 * rows * c->bodies, sizeof *c->turn);
    return c->size && c->place && c->turn;
}

void dem_course_release(dem_course *c)
{
    free(c->names);
    free(c->size);
    free(c->place);
    free(c->turn);
    free(c->series);
    *c = (dem_course){0};
}

// ---- running

typedef struct runner {
    const dem_ctx *ctx;
    const dem_course_def *def;
    dem_world *w;
    dem_series *series;
    dem_course *c;
    size_t start_bodies;
} runner;

static size_t followed(const runner *r, size_t k)
{
    return k * r->start_bodies / r->c->bodies;
}

// shifts and turns what is free; paths are used up by it, so that the lists stay right
static void nudge(runner *r)
{
    dem_bodies *b = &r->w->bodies;
    dem_random random = random_stream(r->def->seed, 77);
    for (size_t i = 0; i < b->living; i++) {
        size_t row = b->place[i];
        double *pose = body_pose(b, row), size = 2 * b->radius[row], n[7];
        for (int k = 0; k < 6; k++)
            n[k] = 2 * random_uniform(&random) - 1;
        if (body_hold(b, row))
            continue;
        for (int k = 0; k < 3; k++)
            pose[k] += r->def->nudge * size * n[k];
        dem_quat turn = {1, r->def->nudge / 2 * n[3], r->def->nudge / 2 * n[4], r->def->nudge / 2 * n[5]};
        dem_quat q = quat_unit(quat_multiply(turn, body_orientation(b, row)));
        memcpy(pose + 3, (double[]){q.w, q.x, q.y, q.z}, 4 * sizeof *pose);
        b->path[row] += 3 * r->def->nudge * size;
    }
}

static dem_status look(runner *r, dem_error *error)
{
    dem_course *c = r->c;
    DEM_TRY(dem_world_measure(r->w, error));
    dem_body_view v = dem_world_bodies(r->w);
    const dem_figures *f = dem_world_figures(r->w);
    size_t walls, measures;
    const dem_wall_view *wall = dem_world_walls(r->w, &walls);
    const dem_measure_view *measure = dem_world_measures(r->w, &measures);
    DEM_TRY(dem_series_write(r->series, f, wall, measure, error));
    c->flows |= f->came > 0 || f->left > 0;
    for (size_t k = 0; k < c->bodies; k++) {
        size_t i = followed(r, k), at = c->rows * c->bodies + k;
        bool there = i < v.count && !c->flows;
        dem_vec3 x = there ? v.position[i] : v3(NAN, NAN, NAN);
        dem_quat q = there ? v.orientation[i] : (dem_quat){NAN, NAN, NAN, NAN};
        memcpy(c->place + 3 * at, (double[]){x.x, x.y, x.z}, 3 * sizeof(double));
        memcpy(c->turn + 4 * at, (double[]){q.w, q.x, q.y, q.z}, 4 * sizeof(double));
    }
    double steps = r->def->scene->time.contact_steps;
    if (v.count > 1 || walls)
        c->contact = fmin(c->contact, dem_step_accurate(r->w) * (steps > 0 ? steps : DEM_PI));
    c->least_step = fmin(c->least_step, dem_world_step_size(r->w));
    c->rows++;
    return DEM_OK;
}

static dem_status step(runner *r, uint64_t steps, dem_error *error)
{
    double begin = dem_clock_thread();
    dem_status status = DEM_OK;
    if (!r->def->push)
        status = dem_world_step(r->w, steps, error);
    for (uint64_t i = 0; r->def->push && i < steps && status == DEM_OK; i++) {
        r->def->push(r->w);
        status = dem_world_step(r->w, 1, error);
    }
    r->c->seconds += dem_clock_thread() - begin;
    return status;
}

static bool asked_to_stop(const runner *r)
{
    return dem_progress(r->ctx, "running", dem_world_time(r->w) / r->def->scene->time.end);
}

static dem_status go_on(runner *r, size_t row, dem_error *error)
{
    const dem_course_def *d = r->def;
    double to = d->scene->time.end * (double)row / (double)d->samples;
    uint64_t last = d->steps / d->samples * row;
    for (;;) {
        double left = d->steps ? (double)(last - dem_world_steps(r->w))
                               : ceil((to - dem_world_time(r->w)) / dem_world_step_size(r->w) - 1e-6);
        if (!(left > 0))
            return DEM_OK;
        DEM_TRY(step(r, left < STEPS_UNASKED ? (uint64_t)left : STEPS_UNASKED, error));
        if (asked_to_stop(r))
            return dem_fail(error, DEM_INTERRUPTED, "interrupted");
    }
}

static dem_status run_all(runner *r, dem_error *error)
{
    dem_scene scene = *r->def->scene;
    if (r->def->steps)
        scene.time.step = scene.time.end / (double)r->def->steps;
    // what many runs warn of is of no use; one thread: there are many runs
    DEM_TRY(dem_world_create(&(dem_ctx){.threads = 1}, &scene, &r->w, error));
    dem_course *c = r->c;
    r->start_bodies = dem_world_bodies(r->w).count;
    c->bodies = r->start_bodies < DEM_COURSE_BODIES ? r->start_bodies : DEM_COURSE_BODIES;
    if (r->def->series_alone)
        c->bodies = 0;
    if (!make_rows(c, r->def->samples + 1))
        return dem_fail_memory(error);
    for (size_t k = 0; k < c->bodies; k++)
        c->size[k] = 2 * r->w->bodies.radius[r->w->bodies.place[followed(r, k)]];
    dem_series_def def = dem_series_def_of(&scene, NULL, r->w->population != NULL);
    DEM_TRY(dem_series_open(&def, NAN, &r->series, error));
    if (r->def->nudge > 0)
        nudge(r);
    DEM_TRY(look(r, error));
    for (size_t row = 1; row <= r->def->samples; row++) {
        DEM_TRY(go_on(r, row, error));
        DEM_TRY(look(r, error));
    }
    return DEM_OK;
}

// ---- the series

static size_t count_commas(const char *line, const char *end)
{
    size_t count = 0;
    for (; line < end; line++)
        count += *line == ',';
    return count;
}

static dem_status read_heads(dem_course *c, const char *line, const char *end, dem_error *error)
{
    c->columns = count_commas(line, end) + 1;
    c->names = dem_alloc_zero(c->columns, sizeof *c->names);
    c->series = dem_alloc(c->rows * c->columns, sizeof *c->series);
    if (!c->names || !c->series)
        return dem_fail_memory(error);
    for (size_t k = 0; k < c->columns; k++) {
        size_t length = strcspn(line, ",\n");
        snprintf(c->names[k], sizeof *c->names, "%.*s", (int)length, line);
        line += length + 1;
    }
    return DEM_OK;
}

static dem_status read_series(dem_course *c, const char *text, dem_error *error)
{
    const char *end = text + strlen(text), *next = strchr(text, '\n');
    DEM_TRY(read_heads(c, text, next, error));
    const char *at = next + 1;
    for (size_t i = 0; i < c->rows * c->columns && at < end; i++) {
        const char *behind = dem_parse_double(at, end, &c->series[i]);
        if (!behind)
            c->series[i] = NAN;
        at += strcspn(at, ",\n") + 1;
    }
    return DEM_OK;
}

dem_status dem_course_run(const dem_ctx *ctx, const dem_course_def *def, dem_course *c, dem_error *error)
{
    *c = (dem_course){.least_step = INFINITY, .contact = INFINITY};
    runner r = {.ctx = ctx, .def = def, .c = c};
    dem_error why = {0};
    dem_status status = run_all(&r, &why);
    if (status != DEM_OK && status != DEM_INTERRUPTED && status != DEM_NO_MEMORY) {
        snprintf(c->failed, sizeof c->failed, "%.199s", why.text);
        status = DEM_OK;
    }
    const char *text = r.series ? dem_series_text(r.series) : NULL;
    if (status == DEM_OK && text)
        status = read_series(c, text, &why);
    dem_series_close(r.series);
    dem_world_destroy(r.w);
    if (status != DEM_OK) {
        if (error)
            *error = why;
        dem_course_release(c);
    }
    return status;
}

// ---- results

void dem_course_put(dem_json_writer *w, const dem_course *c)
{
    if (*c->failed)
        dem_json_put_string(w, "failed", c->failed);
    dem_json_put_whole(w, "rows", (int64_t)c->rows);
    dem_json_put_whole(w, "bodies", (int64_t)c->bodies);
    dem_json_open_array(w, "columns", false);
    for (size_t k = 0; k < c->columns; k++)
        dem_json_put_string(w, NULL, c->names[k]);
    dem_json_close(w, ']');
    dem_json_put_numbers(w, "size", c->size, c->size ? c->bodies : 0);
    dem_json_put_numbers(w, "place", c->place, 3 * c->rows * c->bodies);
    dem_json_put_numbers(w, "turn", c->turn, 4 * c->rows * c->bodies);
    dem_json_put_numbers(w, "series", c->series, c->rows * c->columns);
    dem_json_put_number(w, "steps_seconds", c->seconds);
    dem_json_put_number(w, "least_step", c->least_step);
    dem_json_put_number(w, "contact", c->contact);
    dem_json_put_bool(w, "flows", c->flows);
}

dem_status dem_course_get(const dem_cell_result *cell, dem_course *c, dem_error *error)
{
    const dem_json *found = cell->found;
    const char *failed = dem_json_string(dem_json_member(found, "failed"));
    int64_t rows = 0, bodies = 0;
    *c = (dem_course){0};
    if (failed)
        snprintf(c->failed, sizeof c->failed, "%s", failed);
    dem_json_whole(dem_json_member(found, "rows"), &rows);
    dem_json_whole(dem_json_member(found, "bodies"), &bodies);
    const dem_json *names = dem_json_member(found, "columns");
    // a run that was refused at once has followed nothing
    c->rows = rows > 0 ? (size_t)rows : 0;
    c->bodies = bodies > 0 ? (size_t)bodies : 0;
    c->columns = dem_json_length(names);
    c->names = dem_alloc_zero(c->columns, sizeof *c->names);
    c->series = dem_alloc(c->rows * c->columns, sizeof *c->series);
    if (!c->names || !c->series || !make_rows(c, c->rows)) {
        dem_course_release(c);
        return dem_fail_memory(error);
    }
    for (size_t k = 0; k < c->columns; k++)
        snprintf(c->names[k], sizeof *c->names, "%s", dem_json_string(dem_json_item(names, k)));
    size_t places = c->rows * c->bodies;
    bool whole = (*c->failed || dem_cell_numbers(cell, "size", c->size, c->bodies) == c->bodies) &&
                 dem_cell_numbers(cell, "place", c->place, 3 * places) == 3 * places &&
                 dem_cell_numbers(cell, "turn", c->turn, 4 * places) == 4 * places &&
                 dem_cell_numbers(cell, "series", c->series, c->rows * c->columns) == c->rows * c->columns;
    c->seconds = dem_cell_number(cell, "steps_seconds");
    c->least_step = dem_cell_number(cell, "least_step");
    c->contact = dem_cell_number(cell, "contact");
    if (isnan(c->contact))
        c->contact = INFINITY;
    dem_json_bool(dem_json_member(found, "flows"), &c->flows);
    if (!whole) {
        dem_course_release(c);
        return dem_fail(error, DEM_BAD_INPUT, "a cell's result is not whole; remove the folder cells and run again");
    }
    return DEM_OK;
}

size_t dem_course_column(const dem_course *c, const char *name)
{
    for (size_t k = 0; k < c->columns; k++)
        if (strcmp(c->names[k], name) == 0)
            return k;
    return SIZE_MAX;
}

// ---- comparing

static double shorter_way(double d, double low, double high, bool periodic)
{
    return periodic ? remainder(d, high - low) : d;
}

// NAN goes through
static double worse(double a, double b)
{
    return isnan(a) || b <= a ? a : b;
}

dem_apart dem_course_apart(const dem_course *a, const dem_course *b, const dem_domain_def *domain, size_t row)
{
    if (row >= a->rows || row >= b->rows || a->bodies != b->bodies)
        return (dem_apart){NAN, NAN};
    dem_apart apart = {0};
    for (size_t k = 0; k < a->bodies; k++) {
        size_t at = row * a->bodies + k;
        double sum = 0;
        for (int i = 0; i < 3; i++) {
            double d = a->place[3 * at + i] - b->place[3 * at + i];
            d = shorter_way(d, v3_get(domain->low, i), v3_get(domain->high, i), domain->periodic[i]);
            sum += d * d;
        }
        const double *p = a->turn + 4 * at, *q = b->turn + 4 * at;
        dem_quat d = quat_multiply((dem_quat){p[0], p[1], p[2], p[3]}, (dem_quat){q[0], -q[1], -q[2], -q[3]});
        double place = sqrt(sum) / b->size[k], turn = 2 * atan2(sqrt(d.x * d.x + d.y * d.y + d.z * d.z), fabs(d.w));
        apart.place = worse(apart.place, place);
        apart.turn = worse(apart.turn, turn);
    }
    return apart;
}
