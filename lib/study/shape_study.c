#include "study/shape_study.h"

#include <math.h>
#include <string.h>

#include "base/status.h"

size_t dem_shape_cells(const dem_shape_study *s)
{
    return s->variant_count * s->test_count * s->seeds;
}

dem_shape_cell dem_shape_cell_at(const dem_shape_study *s, size_t cell)
{
    return (dem_shape_cell){cell % s->variant_count, cell / s->variant_count % s->test_count,
                            s->seed + cell / (s->variant_count * s->test_count)};
}

static void describe(void *user, size_t cell, dem_buffer *inputs)
{
    const dem_shape_study *s = user;
    dem_shape_cell c = dem_shape_cell_at(s, cell);
    const dem_clump *clump = s->variants[c.variant].clump;
    const dem_parameter *p;
    double standard;
    dem_buffer_print(inputs, "%s seed %llu, contacts %d, grain %llx:", s->tests[c.test]->name,
                     (unsigned long long)c.seed, s->multiple, (unsigned long long)(clump ? dem_clump_hash(clump) : 0));
    for (size_t i = 0; (p = dem_lab_param(s->tests[c.test], i, &standard)); i++) {
        double value = s->values[c.test][i];
        dem_buffer_print(inputs, " %s ", p->name);
        dem_buffer_shortest(inputs, isnan(value) ? standard : value);
    }
}

static dem_status run(void *user, size_t cell, const dem_ctx *ctx, dem_json_writer *found, dem_error *error)
{
    const dem_shape_study *s = user;
    dem_shape_cell c = dem_shape_cell_at(s, cell);
    dem_lab lab;
    const dem_lab_grain grain = {.clump = s->variants[c.variant].clump, .multiple = s->multiple};
    DEM_TRY(dem_lab_begin(&lab, ctx, s->tests[c.test], &grain, s->values[c.test], c.seed, error));
    dem_status status = dem_lab_run(&lab, error);
    if (status == DEM_OK) {
        dem_json_put_string(found, "test", lab.test->name);
        dem_json_put_string(found, "grain", s->variants[c.variant].name);
        dem_json_put_whole(found, "seed", (int64_t)c.seed);
        for (size_t i = 0; i < lab.test->figure_count; i++)
            dem_json_put_number(found, lab.test->figures[i].name, lab.figures[i]);
        dem_json_put_whole(found, "steps", (int64_t)lab.steps);
        dem_json_put_number(found, "seconds", lab.seconds);
    }
    dem_lab_end(&lab);
    return status;
}

dem_status dem_shape_run(const dem_ctx *ctx, const dem_shape_study *s, dem_cell_result *results, dem_error *error)
{
    const dem_cells_def def = {.directory = s->directory,
                               .count = dem_shape_cells(s),
                               .only = s->only,
                               .user = (void *)s,
                               .describe = describe,
                               .run = run};
    return dem_cells_run(ctx, &def, results, error);
}

// ---- over the seeds

dem_mean dem_shape_mean(const dem_shape_study *s, const dem_cell_result *results, size_t variant, size_t test,
                        const char *name)
{
    enum { MOST = 1000 };
    double values[MOST];
    size_t count = s->seeds < MOST ? s->seeds : MOST;
    for (size_t i = 0; i < count; i++)
        values[i] = dem_cell_number(&results[(i * s->test_count + test) * s->variant_count + variant], name);
    return dem_mean_of(values, count);
}

// Figures whose bars are wider than this part of them agree with anything: that says nothing.
static const double telling = 0.25;

size_t dem_shape_enough(const dem_shape_study *s, const dem_cell_result *results, size_t test, const char *name)
{
    size_t last = s->variant_count - 1, enough = last;
    dem_mean finest = dem_shape_mean(s, results, last, test, name);
    if (finest.count < 2)
        return s->variant_count;
    for (size_t i = last; i-- > 0;) {
        dem_mean m = dem_shape_mean(s, results, i, test, name);
        if (m.count < 2)
            return s->variant_count;
        double bar = hypot(m.error, finest.error);
        if (!(fabs(m.mean - finest.mean) <= bar))
            break;
        if (bar > telling * fabs(finest.mean))
            return s->variant_count;
        enough = i;
    }
    return enough;
}
