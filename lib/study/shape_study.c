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

// ---- statistics

// how many standard errors to either side hold a mean with 95 %, by degrees of freedom
static double student(size_t freedom)
{
    static const double table[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                   2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086};
    size_t known = sizeof table / sizeof *table;
    // beyond the table by the first terms of its series
    return freedom <= known ? table[freedom - 1] : 1.96 + 2.37 / (double)freedom + 2.8 / pow((double)freedom, 2);
}

dem_mean dem_mean_of(const double *values, size_t count)
{
    dem_mean m = {.mean = NAN, .deviation = NAN, .error = NAN};
    double sum = 0, squares = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i])) {
            sum += values[i];
            m.count++;
        }
    if (m.count == 0)
        return m;
    m.mean = sum / (double)m.count;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i]))
            squares += pow(values[i] - m.mean, 2);
    if (m.count > 1) {
        m.deviation = sqrt(squares / (double)(m.count - 1));
        m.error = student(m.count - 1) * m.deviation / sqrt((double)m.count);
    }
    return m;
}

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
        if (!(fabs(m.mean - finest.mean) <= hypot(m.error, finest.error)))
            break;
        enough = i;
    }
    return enough;
}
