#include "study/trial.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "sim/state.h"

enum { STEPS_UNASKED = 20000 };

void dem_trial_run(const dem_ctx *ctx, const dem_case *c, dem_trial *t)
{
    double begin = dem_clock();
    *t = (dem_trial){.ctx = ctx, .model = dem_alloc_zero(1, sizeof *t->model)};
    if (!t->model) {
        t->status = dem_fail_memory(&t->error);
        return;
    }
    c->run(t);
    dem_world_destroy(t->world);
    t->world = NULL;
    model_end(t->model);
    free(t->model);
    t->model = NULL;
    t->seconds = dem_clock() - begin;
}

bool dem_trial_passed(const dem_trial *t)
{
    bool passed = t->status == DEM_OK && (t->count > 0 || t->skipped);
    for (size_t i = 0; i < t->count; i++)
        passed = passed && t->findings[i].passed;
    return passed;
}

bool dem_case_meant(const dem_case *c, const char *word)
{
    size_t length = strlen(word);
    if (length && word[length - 1] == '*')
        return strncmp(c->name, word, length - 1) == 0;
    return strncmp(c->name, word, length) == 0 && (c->name[length] == 0 || c->name[length] == '-');
}

void dem_trial_release(dem_trial *t)
{
    free(t->findings);
    for (size_t i = 0; i < t->curve_count; i++) {
        free(t->curves[i].x);
        free(t->curves[i].y);
    }
    *t = (dem_trial){0};
}

// ---- worlds

model *dem_trial_model(dem_trial *t)
{
    model_end(t->model);
    model_begin(t->model);
    return t->model;
}

dem_mesh *dem_trial_mesh(dem_trial *t, size_t vertices, size_t triangles)
{
    size_t i = t->model->scene.wall_count++;
    DEM_ASSERT(i < MODEL_WALLS);
    dem_wall_def *wall = &t->model->walls[i];
    *wall = (dem_wall_def){.name = "mesh", .kind = DEM_WALL_MESH};
    wall->mesh.vertices = dem_alloc_zero(vertices, sizeof *wall->mesh.vertices);
    wall->mesh.triangles = dem_alloc_zero(3 * triangles, sizeof *wall->mesh.triangles);
    wall->mesh.vertex_count = vertices;
    wall->mesh.triangle_count = triangles;
    if ((!wall->mesh.vertices || !wall->mesh.triangles) && t->status == DEM_OK)
        t->status = dem_fail_memory(&t->error);
    return t->status == DEM_OK ? &wall->mesh : NULL;
}

bool dem_trial_start(dem_trial *t)
{
    dem_world_destroy(t->world);
    t->world = NULL;
    t->looked = false;
    if (t->status == DEM_OK && t->model->status != DEM_OK) {
        t->status = t->model->status;
        t->error = t->model->error;
    }
    if (t->status == DEM_OK) {
        // one thread: they are small, and what they find does not depend on it
        dem_ctx ctx = t->ctx ? *t->ctx : (dem_ctx){0};
        ctx.threads = 1;
        t->status = dem_world_create(&ctx, &t->model->scene, &t->world, &t->error);
        if (t->status == DEM_UNAVAILABLE) {
            t->status = DEM_OK;
            t->skipped = "needs something that this build does not have: mesh walls need Embree";
        }
    }
    return t->status == DEM_OK && t->world;
}

static bool ready(const dem_trial *t)
{
    return t->status == DEM_OK && t->world;
}

bool dem_trial_step(dem_trial *t, uint64_t steps)
{
    t->looked = false;
    while (steps && ready(t)) {
        uint64_t part = steps < STEPS_UNASKED ? steps : STEPS_UNASKED;
        t->status = dem_world_step(t->world, part, &t->error);
        steps -= part;
        t->unasked += part;
        if (t->status == DEM_OK && t->unasked >= STEPS_UNASKED) {
            t->unasked = 0;
            if (dem_progress(t->ctx, "verify", 0))
                t->status = dem_fail(&t->error, DEM_INTERRUPTED, "interrupted");
        }
    }
    return ready(t);
}

static bool look(dem_trial *t)
{
    if (ready(t) && !t->looked) {
        t->status = dem_world_measure(t->world, &t->error);
        t->looked = true;
    }
    return ready(t);
}

dem_motion dem_trial_body(dem_trial *t, size_t body)
{
    const dem_vec3 none = {NAN, NAN, NAN};
    if (!look(t) || body >= dem_world_bodies(t->world).count)
        return (dem_motion){none, none, none, {NAN, NAN, NAN, NAN}};
    dem_body_view v = dem_world_bodies(t->world);
    return (dem_motion){v.position[body], v.velocity[body], v.spin[body], v.orientation[body]};
}

dem_vec3 dem_motion_own_spin(const dem_motion *m)
{
    return quat_unrotate(m->orientation, m->spin);
}

const dem_figures *dem_trial_figures(dem_trial *t)
{
    static const dem_figures none;
    return look(t) ? dem_world_figures(t->world) : &none;
}

const dem_contact *dem_trial_contacts(dem_trial *t, size_t *count)
{
    *count = 0;
    const dem_contact *contacts = look(t) ? dem_world_contacts(t->world, count) : NULL;
    return *count ? contacts : NULL;
}

double dem_trial_time(const dem_trial *t)
{
    return ready(t) ? dem_world_time(t->world) : NAN;
}

dem_wall_view dem_trial_wall(dem_trial *t, size_t wall)
{
    size_t count = 0;
    const dem_wall_view *walls = look(t) ? dem_world_walls(t->world, &count) : NULL;
    return wall < count ? walls[wall] : (dem_wall_view){.force = {NAN, NAN, NAN}, .worn = NAN};
}

// ---- findings

static void note(dem_trial *t, dem_finding f, const char *format, va_list arguments)
{
    if (t->status != DEM_OK || t->skipped)
        return;
    if (!dem_grow(&t->findings, &t->capacity, t->count, sizeof *t->findings)) {
        t->status = dem_fail_memory(&t->error);
        return;
    }
    vsnprintf(f.what, sizeof f.what, format, arguments);
    t->findings[t->count++] = f;
}

void dem_expect(dem_trial *t, double got, double want, double tolerance, const char *unit, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    note(t, (dem_finding){"", unit, DEM_BOUND_NEAR, want, got, tolerance, fabs(got - want) <= tolerance}, format,
         arguments);
    va_end(arguments);
}

void dem_expect_most(dem_trial *t, double got, double bound, const char *unit, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    note(t, (dem_finding){"", unit, DEM_BOUND_MOST, bound, got, 0, got <= bound}, format, arguments);
    va_end(arguments);
}

void dem_expect_least(dem_trial *t, double got, double bound, const char *unit, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    note(t, (dem_finding){"", unit, DEM_BOUND_LEAST, bound, got, 0, got >= bound}, format, arguments);
    va_end(arguments);
}

void dem_trial_plot(dem_trial *t, dem_plot_axis x, dem_plot_axis y)
{
    t->axes[0] = x;
    t->axes[1] = y;
}

void dem_trial_point(dem_trial *t, const char *curve, double x, double y)
{
    dem_curve *c = t->curve_count ? &t->curves[t->curve_count - 1] : NULL;
    if (t->status != DEM_OK)
        return;
    if (!c || strcmp(c->name, curve) != 0) {
        DEM_ASSERT(t->curve_count < DEM_CURVES);
        c = &t->curves[t->curve_count++];
        snprintf(c->name, sizeof c->name, "%s", curve);
    }
    if (!dem_grow(&c->x, &c->capacity[0], c->count, sizeof *c->x) ||
        !dem_grow(&c->y, &c->capacity[1], c->count, sizeof *c->y)) {
        t->status = dem_fail_memory(&t->error);
        return;
    }
    size_t at = c->count++;
    for (; at > 0 && c->x[at - 1] > x; at--) {
        c->x[at] = c->x[at - 1];
        c->y[at] = c->y[at - 1];
    }
    c->x[at] = x;
    c->y[at] = y;
}
