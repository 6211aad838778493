#include "study/lab.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/status.h"
#include "math/vec.h"
#include "sim/scene.h"

const dem_parameter dem_lab_common_params[LAB_COMMON] = {
    [LAB_DIAMETER] = {"diameter", 0.01, 1e-6, 10, "m", "mean diameter of the grains, of the sphere of equal volume"},
    [LAB_SPREAD] = {"spread", 0.2, 0, 0.8, "-", "diameters are spread evenly by this part to either side"},
    [LAB_DENSITY] = {"density", 2650, 1e-3, 1e6, "kg/m^3", "of the grains"},
    [LAB_FRICTION] = {"friction", 0.5, 0, 10, "-", "coefficient between grains"},
    [LAB_RESTITUTION] = {"restitution", 0.4, 0.01, 1, "-", "coefficient of restitution"},
    [LAB_OVERLAP] = {"overlap", 0.002, 1e-6, 0.05, "-", "of grains under the load, of a diameter; sets the stiffness"},
    [LAB_BODIES] = {"bodies", 1000, 20, 1e6, "count", "about so many grains"},
};

static const dem_lab_test *const tests[] = {&dem_lab_pour, &dem_lab_heap, &dem_lab_triaxial, &dem_lab_shear_box,
                                            &dem_lab_drum};

const dem_lab_test *dem_lab_test_at(size_t index)
{
    return index < sizeof tests / sizeof *tests ? tests[index] : NULL;
}

const dem_lab_test *dem_lab_test_find(const char *name)
{
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++)
        if (strcmp(tests[i]->name, name) == 0)
            return tests[i];
    return NULL;
}

const dem_parameter *dem_lab_param(const dem_lab_test *test, size_t index, double *standard)
{
    if (index >= LAB_COMMON + test->param_count)
        return NULL;
    const dem_parameter *p = index < LAB_COMMON ? &dem_lab_common_params[index] : &test->params[index - LAB_COMMON];
    *standard = index == LAB_BODIES ? test->bodies : index == LAB_OVERLAP ? test->overlap : p->standard;
    return p;
}

// ---- begin and end

// the farthest point of a clump from its centre, in radii of the sphere of its volume
static double clump_reach(const dem_clump *clump)
{
    if (!clump)
        return 1;
    dem_clump_def c = dem_clump_view(clump);
    double most = 0;
    for (size_t i = 0; i < c.ball_count; i++)
        most = larger(most, v3_norm(c.balls[i].centre) + c.balls[i].radius);
    return most / cbrt(c.volume * 3 / (4 * DEM_PI));
}

dem_status dem_lab_begin(dem_lab *l, const dem_ctx *ctx, const dem_lab_test *test, const dem_lab_grain *grain,
                         const double *values, uint64_t seed, dem_error *error)
{
    *l = (dem_lab){.ctx = ctx, .test = test, .grain = *grain, .seed = seed};
    const dem_parameter *p;
    for (size_t i = 0; (p = dem_lab_param(test, i, &l->values[i])); i++) {
        if (values && !isnan(values[i]))
            l->values[i] = values[i];
        if (!isnan(l->values[i]) && !(l->values[i] >= p->low && l->values[i] <= p->high))
            return dem_fail(error, DEM_USAGE, "%s of test %s is %g, which is out of its range; take %g to %g [%s]",
                            p->name, test->name, l->values[i], p->low, p->high, p->unit);
    }
    for (size_t i = 0; i < DEM_LAB_FIGURES; i++)
        l->figures[i] = NAN;
    l->scene = dem_scene_defaults();
    return DEM_OK;
}

static void leave_world(dem_lab *l)
{
    if (l->world)
        l->steps += dem_world_steps(l->world);
    dem_world_destroy(l->world);
    l->world = NULL;
    dem_scene_release(&l->scene);
    l->scene = dem_scene_defaults();
}

void dem_lab_end(dem_lab *l)
{
    leave_world(l);
    free(l->sample);
    free(l->path);
    l->sample = NULL;
    l->path = NULL;
}

dem_status dem_lab_run(dem_lab *l, dem_error *error)
{
    double begin = dem_clock();
    dem_buffer text = {0};
    dem_status status = l->test->prepare ? l->test->prepare(l, error) : DEM_OK;
    if (status == DEM_OK) {
        l->test->write(l, &text);
        status = dem_lab_start(l, &text, error);
    }
    dem_buffer_release(&text);
    if (status == DEM_OK)
        status = l->test->run(l, error);
    leave_world(l);
    l->seconds += dem_clock() - begin;
    return status;
}

double dem_lab_figure(const dem_lab *l, const char *name)
{
    for (size_t i = 0; i < l->test->figure_count; i++)
        if (strcmp(l->test->figures[i].name, name) == 0)
            return l->figures[i];
    return NAN;
}

void dem_lab_found(dem_lab *l, const char *name, double value)
{
    for (size_t i = 0; i < l->test->figure_count; i++)
        if (strcmp(l->test->figures[i].name, name) == 0)
            l->figures[i] = value;
}

double dem_lab_peak(const dem_lab *l, size_t column, size_t width, size_t *at)
{
    double most = -INFINITY;
    size_t all = l->test->column_count;
    width = width < 1 ? 1 : width > l->rows ? l->rows : width;
    *at = 0;
    for (size_t i = 0; i + width <= l->rows; i++) {
        double sum = 0;
        for (size_t k = i; k < i + width; k++)
            sum += l->path[k * all + column];
        if (sum / (double)width > most) {
            most = sum / (double)width;
            *at = i + width / 2;
        }
    }
    return l->rows ? most : NAN;
}

double dem_lab_mean(const dem_lab *l, size_t column, size_t from)
{
    double sum = 0;
    for (size_t i = from; i < l->rows; i++)
        sum += l->path[i * l->test->column_count + column];
    return from < l->rows ? sum / (double)(l->rows - from) : NAN;
}

double dem_lab_solid(const dem_lab *l)
{
    double own = dem_shape_diameter(&l->scene.shapes[0]), cubes = 0;
    for (size_t i = 0; i < l->sample_count; i++)
        cubes += pow(l->sample[i].scale, 3);
    return cubes * DEM_PI / 6 * own * own * own;
}

double dem_lab_mean_volume(const dem_lab *l)
{
    // the mean of the cubes of diameters spread evenly
    return 1 + l->values[LAB_SPREAD] * l->values[LAB_SPREAD];
}

double dem_lab_reach(const dem_lab *l)
{
    return clump_reach(l->grain.clump) * (1 + l->values[LAB_SPREAD]) * l->values[LAB_DIAMETER] / 2;
}

// ---- texts

void dem_lab_put(dem_buffer *out, const char *format, ...)
{
    va_list numbers;
    va_start(numbers, format);
    for (const char *from = format;; from++) {
        const char *at = strchr(from, '@');
        dem_buffer_bytes(out, from, at ? (size_t)(at - from) : strlen(from));
        if (!at)
            break;
        // lengths of whole diameters come out with their rounding; twelve digits do not show it
        dem_buffer_number(out, va_arg(numbers, double), 12);
        from = at;
    }
    va_end(numbers);
}

static void put_pair(dem_buffer *out, const char *with, double stiffness, double restitution, double friction,
                     bool last)
{
    dem_buffer_print(out, "    { \"between\": [\"grain\", \"%s\"], ", with);
    dem_lab_put(out, "\"normal\": { \"law\": \"linear\", \"stiffness\": @, \"restitution\": @ }", stiffness,
                restitution);
    if (friction > 0)
        dem_lab_put(out, ", \"friction\": { \"coefficient\": @ }", friction);
    dem_buffer_text(out, last ? " } ],\n" : " },\n");
}

void dem_lab_put_head(dem_lab *l, dem_buffer *out, double pressure, double friction, double rough)
{
    static const char *const multiples[] = {[DEM_MULTIPLE_SUM] = "sum",
                                            [DEM_MULTIPLE_MEAN] = "mean",
                                            [DEM_MULTIPLE_MERGE] = "merge",
                                            [DEM_MULTIPLE_SOFT] = "soft"};
    double d = l->values[LAB_DIAMETER], stiffness = pressure * d / l->values[LAB_OVERLAP];
    double e = l->values[LAB_RESTITUTION];
    dem_buffer_print(out, "{ \"schema\": \"dem-scene/1\", \"title\": \"%s\",\n", l->test->name);
    dem_lab_put(out, "  \"materials\": { \"grain\": { \"density\": @ }, \"rough\": {}, \"smooth\": {} },\n",
                l->values[LAB_DENSITY]);
    dem_buffer_text(out, "  \"contacts\": [\n");
    put_pair(out, "grain", stiffness, e, friction, false);
    put_pair(out, "rough", stiffness, e, rough, false);
    // servo walls are quicker with little damping
    put_pair(out, "smooth", stiffness, larger(e, 0.9), 0, true);
    if (l->grain.multiple != DEM_MULTIPLE_SUM)
        dem_buffer_print(out, "  \"contacts_between_clumps\": \"%s\",\n", multiples[l->grain.multiple]);
    dem_buffer_text(out, "  \"shapes\": { \"grain\": { ");
    if (l->grain.clump_file && !l->grain.clump) {
        dem_json_writer w = dem_json_begin(out);
        w.depth = w.line_depth = 1;
        dem_json_put_string(&w, "clump", l->grain.clump_file);
    } else {
        dem_lab_put(out, "\"sphere\": { \"radius\": @ }", d / 2);
    }
    dem_buffer_text(out, ", \"material\": \"grain\" } },\n");
}

static void put_fill(const dem_lab *l, dem_buffer *out, size_t count, dem_box box)
{
    double d = l->values[LAB_DIAMETER], s = l->values[LAB_SPREAD];
    dem_buffer_text(out, "    { \"fill\": { \"mix\": [ { \"shape\": \"grain\", \"size\": ");
    if (s > 0)
        dem_lab_put(out, "{ \"law\": \"uniform\", \"min\": @, \"max\": @ } } ],\n", d * (1 - s), d * (1 + s));
    else
        dem_lab_put(out, "{ \"law\": \"fixed\", \"value\": @ } } ],\n", d);
    dem_lab_put(out, "      \"box\": [[@, @, @], [@, @, @]],", box.low.x, box.low.y, box.low.z, box.high.x, box.high.y,
                box.high.z);
    dem_buffer_print(out, " \"count\": %zu, \"seed\": %llu } }", count, (unsigned long long)l->seed);
}

void dem_lab_put_bodies(dem_lab *l, dem_buffer *out, size_t count, dem_box box)
{
    if (l->sample_file) {
        dem_buffer_print(out, "  \"bodies\": [ { \"file\": \"%s\" } ],\n", l->sample_file);
    } else if (!l->sample) {
        dem_buffer_text(out, "  \"bodies\": [\n");
        put_fill(l, out, count, box);
        dem_buffer_text(out, " ],\n");
    }
}

// ---- worlds

dem_status dem_lab_start(dem_lab *l, const dem_buffer *text, dem_error *error)
{
    leave_world(l);
    if (text->failed)
        return dem_fail_memory(error);
    DEM_TRY(dem_scene_read_text(l->ctx, text->data, text->size, l->test->name, ".", NULL, &l->scene, error));
    if (l->grain.clump) {
        // the scene's shapes are the reader's; what is told of this one is put into its place
        dem_shape_def *shape = (dem_shape_def *)&l->scene.shapes[0];
        shape->sphere_radius = 0;
        shape->clump_file = NULL;
        shape->clump = l->grain.clump;
    }
    if (l->sample) {
        l->scene.bodies.bodies = l->sample;
        l->scene.bodies.count = l->sample_count;
    }
    return dem_world_create(l->ctx, &l->scene, &l->world, error);
}

static double now(const dem_lab *l)
{
    return dem_world_time(l->world);
}

dem_status dem_lab_to(dem_lab *l, double time, dem_error *error)
{
    enum { UNASKED = 2000 };
    for (double left; (left = time - now(l)) > 0;) {
        double steps = ceil(left / dem_world_step_size(l->world) - 1e-6);
        if (steps < 1)
            break;
        if (dem_progress(l->ctx, l->test->name, now(l) / l->scene.time.end))
            return dem_fail(error, DEM_INTERRUPTED, "interrupted");
        DEM_TRY(dem_world_step(l->world, steps < UNASKED ? (uint64_t)steps : UNASKED, error));
    }
    return dem_world_measure(l->world, error);
}

// the root mean square of the speeds of the bodies above
static double mean_speed(const dem_lab *l, double floor)
{
    dem_body_view v = dem_world_bodies(l->world);
    double mass = 0, sum = 0;
    for (size_t i = 0; i < v.count; i++)
        if (v.position[i].z > floor) {
            mass += v.mass[i];
            sum += v.mass[i] * v3_norm2(v.velocity[i]);
        }
    return mass > 0 ? sqrt(sum / mass) : 0;
}

dem_status dem_lab_settle(dem_lab *l, const dem_lab_rest *rest, dem_error *error)
{
    DEM_TRY(dem_lab_to(l, rest->from, error));
    while (mean_speed(l, rest->floor) > rest->speed && now(l) < rest->until)
        DEM_TRY(dem_lab_to(l, now(l) + rest->every, error));
    return DEM_OK;
}

dem_status dem_lab_keep(dem_lab *l, dem_error *error)
{
    dem_body_view v = dem_world_bodies(l->world);
    dem_body_def *sample = dem_alloc(v.count, sizeof *sample);
    if (!sample)
        return dem_fail_memory(error);
    for (size_t i = 0; i < v.count; i++)
        sample[i] = (dem_body_def){
            .shape = v.shape[i], .scale = v.scale[i], .position = v.position[i], .orientation = v.orientation[i]};
    free(l->sample);
    l->sample = sample;
    l->sample_count = v.count;
    return DEM_OK;
}

dem_status dem_lab_note(dem_lab *l, const double *row, dem_error *error)
{
    size_t width = l->test->column_count;
    if (!dem_grow(&l->path, &l->capacity, l->rows, width * sizeof *l->path))
        return dem_fail_memory(error);
    memcpy(l->path + width * l->rows++, row, width * sizeof *row);
    return DEM_OK;
}

dem_status dem_lab_go(dem_lab *l, const dem_lab_walk *walk, dem_error *error)
{
    enum { SAMPLES = 4 };
    double begin = now(l), span = walk->end - begin;
    for (size_t i = 0; i < walk->rows; i++) {
        double row[DEM_LAB_COLUMNS] = {0}, sample[DEM_LAB_COLUMNS] = {0};
        for (size_t k = 0; k < SAMPLES; k++) {
            DEM_TRY(dem_lab_to(l, begin + span * (double)(SAMPLES * i + k + 1) / (double)(SAMPLES * walk->rows), error));
            walk->look(l, sample);
            for (size_t c = 0; c < l->test->column_count; c++)
                row[c] += sample[c] / SAMPLES;
        }
        if (walk->close)
            walk->close(row);
        DEM_TRY(dem_lab_note(l, row, error));
    }
    return DEM_OK;
}

static void put_sample(const dem_lab *l, dem_buffer *out)
{
    dem_buffer_text(out, "shape,x,y,z,qw,qx,qy,qz,scale\n");
    for (size_t i = 0; i < l->sample_count; i++) {
        const dem_body_def *b = &l->sample[i];
        const double numbers[] = {b->position.x,    b->position.y,    b->position.z,    b->orientation.w,
                                  b->orientation.x, b->orientation.y, b->orientation.z, b->scale};
        dem_buffer_text(out, "grain");
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
            dem_buffer_text(out, ",");
            dem_buffer_shortest(out, numbers[k]);
        }
        dem_buffer_text(out, "\n");
    }
}

dem_status dem_lab_scene(dem_lab *l, const char *bodies_file, dem_buffer *scene, dem_buffer *bodies, dem_error *error)
{
    if (l->test->prepare)
        DEM_TRY(l->test->prepare(l, error));
    if (l->sample) {
        put_sample(l, bodies);
        l->sample_file = bodies_file;
    }
    l->test->write(l, scene);
    return scene->failed || bodies->failed ? dem_fail_memory(error) : DEM_OK;
}
