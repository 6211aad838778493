#include "study/convergence_plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/random.h"
#include "base/status.h"

static const double TINY = 1e-12, SMALL = 1e-6;
static const double CHAOTIC = 1e6;      // distance over that at the start
static const double MOST_STEPS = 1e12;  // of the finest run: a month and more
enum { LEAST_SAMPLES = 16 };

// ---- what a result depends on

static uint64_t hash_text(uint64_t hash, const char *text)
{
    for (; *text; text++)
        hash = random_mix(hash ^ (unsigned char)*text);
    return hash;
}

static dem_status identify(dem_convergence_plan *p, dem_error *error)
{
    char *text;
    dem_scene scene = p->scene;
    scene.output.directory = NULL;
    scene.integrator = (dem_integrator_def){0};
    DEM_TRY(dem_scene_resolved(&scene, &text, error));
    p->same = hash_text(hash_text(1, p->def->name), text);
    free(text);
    // files that are named may have changed: how it starts tells most of it
    dem_world *world;
    DEM_TRY(dem_world_create(&(dem_ctx){.threads = 1}, &p->scene, &world, error));
    p->same = random_mix(p->same ^ dem_world_hash(world));
    dem_world_destroy(world);
    return DEM_OK;
}

// ---- the probe

static void describe_probe(void *user, size_t cell, dem_buffer *inputs)
{
    dem_convergence_plan *p = user;
    (void)cell;
    char name[48];
    dem_method_name(p->scene.integrator, name, sizeof name);
    dem_buffer_print(inputs, "probe, scene %016llx, %s", (unsigned long long)p->same, name);
}

// a number of equal steps of about this size and how often to look: at each 1/samples of the time
static void choose_steps(dem_convergence_plan *p, double step)
{
    double coarsest = p->scene.time.end / (2 * step);
    if (!(coarsest > 1))
        coarsest = 1;
    uint64_t whole = (uint64_t)llround(coarsest);
    p->samples = whole < DEM_CONVERGENCE_SAMPLES ? (size_t)whole : DEM_CONVERGENCE_SAMPLES;
    // a step that was given is kept where it can be looked at evenly often enough
    if (p->scene.time.step > 0 && fabs(coarsest - (double)whole) < 1e-6 * coarsest) {
        size_t samples = p->samples;
        while (whole % samples)
            samples--;
        if (samples >= LEAST_SAMPLES || samples == whole)
            p->samples = samples;
    }
    p->coarsest = (uint64_t)ceil(coarsest / (double)p->samples - 1e-6) * p->samples;
}

static dem_status check_steps(const dem_convergence_plan *p, double step, dem_error *error)
{
    double finest = p->scene.time.end / step * exp2((double)p->def->levels);
    if (finest < MOST_STEPS)
        return DEM_OK;
    return dem_fail(error, DEM_USAGE, "the finest run would take %.1e steps; take a larger time.step or less levels",
                    finest);
}

// three runs, each a third of the way
typedef struct thirds {
    const dem_ctx *ctx;
    int run;
} thirds;

static bool third_progress(void *user, const char *what, double fraction)
{
    const thirds *t = user;
    return dem_progress(t->ctx, what, (t->run + fraction) / 3);
}

// the runs: as the scene is (which tells its step), at an even step, and beside that
static dem_status run_three(dem_convergence_plan *p, const dem_ctx *ctx, dem_course courses[3], dem_error *error)
{
    dem_course_def def = {.scene = &p->scene, .push = p->def->push, .samples = DEM_CONVERGENCE_SAMPLES, .seed = 1};
    thirds t = {ctx, 0};
    const dem_ctx part = {.progress = third_progress, .user = &t};
    // a step that is given is known
    if (p->scene.time.step > 0)
        courses[0] = (dem_course){.least_step = p->scene.time.step, .contact = INFINITY};
    else
        DEM_TRY(dem_course_run(&part, &def, &courses[0], error));
    DEM_TRY(check_steps(p, courses[0].least_step, error));
    for (t.run = 1; t.run < 3 && !*courses[0].failed; t.run++) {
        choose_steps(p, courses[0].least_step);
        def.samples = p->samples;
        def.steps = 2 * p->coarsest;
        def.nudge = t.run == 1 ? 0 : TINY;
        DEM_TRY(dem_course_run(&part, &def, &courses[t.run], error));
    }
    for (int i = 0; i < 3; i++)
        if (*courses[i].failed)
            return dem_fail(error, DEM_FAILED, "the scene does not run at its own step: %s", courses[i].failed);
    return DEM_OK;
}

static dem_status run_probe(void *user, size_t cell, const dem_ctx *ctx, dem_json_writer *w, dem_error *error)
{
    dem_convergence_plan *p = user;
    dem_course courses[3];
    (void)cell;
    memset(courses, 0, sizeof courses);
    dem_status status = run_three(p, ctx, courses, error);
    if (status == DEM_OK) {
        double apart[DEM_CONVERGENCE_SAMPLES + 1];
        for (size_t i = 0; i <= p->samples; i++) {
            dem_apart a = dem_course_apart(&courses[2], &courses[1], &p->scene.domain, i);
            apart[i] = fmax(a.place, a.turn);
        }
        dem_json_put_number(w, "step", courses[0].least_step);
        dem_json_put_number(w, "contact", fmin(courses[0].contact, courses[1].contact));
        dem_json_put_bool(w, "flows", courses[1].flows);
        dem_json_put_numbers(w, "apart", apart, p->samples + 1);
    }
    for (int i = 0; i < 3; i++)
        dem_course_release(&courses[i]);
    return status;
}

// by least squares, from the first distance on until it is of the size of things
static double rate_of(const dem_convergence *c)
{
    double n = 0, t = 0, y = 0, tt = 0, ty = 0;
    for (size_t i = 0; i <= c->samples; i++) {
        double ln = log(c->apart[i]), time = c->end * (double)i / (double)c->samples;
        if (!isfinite(ln) || c->apart[i] > 1e-3)
            break;
        n++;
        t += time;
        y += ln;
        tt += time * time;
        ty += time * ln;
    }
    return n > 2 ? (n * ty - t * y) / (n * tt - t * t) : NAN;
}

static void judge(const dem_cell_result *r, dem_convergence *c)
{
    c->step = dem_cell_number(r, "step");
    c->contact = dem_cell_number(r, "contact");
    if (isnan(c->contact))
        c->contact = INFINITY;
    dem_json_bool(dem_json_member(r->found, "flows"), &c->flows);
    size_t count = dem_cell_numbers(r, "apart", c->apart, DEM_CONVERGENCE_SAMPLES + 1);
    c->samples = count ? count - 1 : 0;
    c->growth = 0;
    for (size_t i = 1; i < count; i++)
        if (c->apart[i] / c->apart[0] > c->growth)
            c->growth = c->apart[i] / c->apart[0];
    c->chaotic = c->flows || c->growth > CHAOTIC;
    c->rate = rate_of(c);
}

dem_status dem_convergence_probe(const dem_ctx *ctx, dem_convergence_plan *p, dem_convergence *found, dem_error *error)
{
    const dem_convergence_def *d = p->def;
    found->end = p->scene.time.end;
    DEM_TRY(identify(p, error));
    char *folder = d->directory ? dem_path_join(d->directory, "probe") : NULL;
    if (d->directory && !folder)
        return dem_fail_memory(error);
    dem_cells_def cells = {.directory = folder,
                           .count = 1,
                           .only = DEM_ALL_CELLS,
                           .user = p,
                           .describe = describe_probe,
                           .run = run_probe};
    dem_cell_result result;
    dem_status status = dem_cells_run(ctx, &cells, &result, error);
    if (status == DEM_OK && result.status != DEM_OK) {
        status = result.status;
        if (error)
            *error = result.error;
    }
    if (status == DEM_OK) {
        judge(&result, found);
        choose_steps(p, found->step);
        p->ensemble = found->chaotic;
        p->references = p->ensemble ? 1 : DEM_REFERENCES;
        p->members = p->ensemble ? d->members : 1;
        p->methods = p->ensemble && !d->each_method ? 1 : d->method_count;
        // of an ensemble the order of rotation does not matter, of a trajectory order 4 costs little
        p->reference =
            (dem_integrator_def){DEM_TRANSLATION_CENTRAL, p->ensemble ? DEM_ROTATION_LSYM : DEM_ROTATION_LSYM4};
    }
    dem_cells_release(&result, 1);
    free(folder);
    return status;
}

// ---- cells

size_t dem_plan_points(const dem_convergence_plan *p)
{
    return p->methods * p->def->levels + p->references;
}

size_t dem_plan_cells(const dem_convergence_plan *p)
{
    return dem_plan_points(p) * p->members;
}

size_t dem_plan_cell(const dem_convergence_plan *p, size_t point)
{
    return point * p->members;
}

uint64_t dem_plan_steps(const dem_convergence_plan *p, size_t point)
{
    size_t ladder = p->methods * p->def->levels;
    if (point < ladder)
        return p->coarsest << point % p->def->levels;
    // an ensemble's reference is at half of the finest step
    return p->coarsest << (p->def->levels - 1 + (p->ensemble ? 1 : point - ladder));
}

static dem_integrator_def method_of(const dem_convergence_plan *p, size_t point)
{
    return point < p->methods * p->def->levels ? p->def->methods[point / p->def->levels] : p->reference;
}

static void describe(void *user, size_t cell, dem_buffer *inputs)
{
    const dem_convergence_plan *p = user;
    size_t point = cell / p->members;
    char name[48];
    dem_method_name(method_of(p, point), name, sizeof name);
    dem_buffer_print(inputs, "scene %016llx, %s, %llu steps, %zu times, member %zu%s", (unsigned long long)p->same,
                     name, (unsigned long long)dem_plan_steps(p, point), p->samples, cell % p->members,
                     point < p->methods * p->def->levels ? "" : ", reference");
}

static dem_status run(void *user, size_t cell, const dem_ctx *ctx, dem_json_writer *w, dem_error *error)
{
    const dem_convergence_plan *p = user;
    size_t point = cell / p->members;
    dem_scene scene = p->scene;
    scene.integrator = method_of(p, point);
    dem_course_def def = {.scene = &scene,
                          .push = p->def->push,
                          .samples = p->samples,
                          .steps = dem_plan_steps(p, point),
                          .nudge = p->ensemble ? SMALL : 0,
                          .seed = 1 + cell % p->members,
                          .series_alone = p->ensemble};
    dem_course course;
    DEM_TRY(dem_course_run(ctx, &def, &course, error));
    dem_course_put(w, &course);
    dem_course_release(&course);
    return DEM_OK;
}

dem_status dem_plan_run(const dem_ctx *ctx, dem_convergence_plan *p, dem_cell_result *results, dem_error *error)
{
    dem_cells_def cells = {.directory = p->def->directory,
                           .count = dem_plan_cells(p),
                           .only = p->def->only,
                           .user = p,
                           .describe = describe,
                           .run = run};
    return dem_cells_run(ctx, &cells, results, error);
}
