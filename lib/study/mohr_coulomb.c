#include "study/mohr_coulomb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/units.h"
#include "math/vec.h"

// ---- the fit

void dem_mohr_coulomb_complete(dem_mohr_coulomb *fit)
{
    double s = sin(fit->friction_angle), c = cos(fit->friction_angle);
    fit->shear_strength = fit->cohesion * c / (1 - s);
    fit->axial_strength = 2 * fit->shear_strength;
    fit->tensile_cutoff = 2 * fit->cohesion * c / (1 + s);
}

dem_status dem_mohr_coulomb_fit(const dem_failure *tests, size_t count, dem_mohr_coulomb *fit, dem_error *error)
{
    double n = (double)count, s_mean = 0, t_mean = 0, s_s = 0, s_t = 0, largest = 0;
    *fit = (dem_mohr_coulomb){.count = count, .angle_error = NAN, .cohesion_error = NAN};
    if (count < 2)
        return dem_fail(error, DEM_BAD_INPUT, "a line needs two tests and should have three or more; there %s %zu",
                        count == 1 ? "is" : "are", count);
    for (size_t i = 0; i < count; i++) {
        s_mean += (tests[i].sigma1 + tests[i].sigma3) / 2 / n;
        t_mean += (tests[i].sigma1 - tests[i].sigma3) / 2 / n;
        largest = fmax(largest, fmax(fabs(tests[i].sigma1), fabs(tests[i].sigma3)));
    }
    for (size_t i = 0; i < count; i++) {
        double s = (tests[i].sigma1 + tests[i].sigma3) / 2 - s_mean;
        s_s += s * s;
        s_t += s * ((tests[i].sigma1 - tests[i].sigma3) / 2 - t_mean);
    }
    if (!(s_s > 1e-20 * largest * largest))
        return dem_fail(error, DEM_BAD_INPUT,
                        "all tests have the same mean stress, which tells no angle; add tests of other confinements");
    double slope = s_t / s_s, intercept = t_mean - slope * s_mean, square = 0;
    char rise[32];
    if (!(fabs(slope) < 1))
        return dem_fail(error, DEM_BAD_INPUT,
                        "the strengths rise by %s of the mean stress, more than any friction; check which column is "
                        "sigma1 and which sigma3",
                        dem_format_double(rise, sizeof rise, slope, 3));
    for (size_t i = 0; i < count; i++) {
        double t = (tests[i].sigma1 - tests[i].sigma3) / 2, s = (tests[i].sigma1 + tests[i].sigma3) / 2;
        square += pow(t - slope * s - intercept, 2);
    }
    double cosine = sqrt(1 - slope * slope);
    fit->friction_angle = asin(slope);
    fit->cohesion = intercept / cosine;
    fit->residual = sqrt(square / n);
    if (count > 2) {
        double variance = square / (n - 2);
        fit->angle_error = sqrt(variance / s_s) / cosine;
        fit->cohesion_error = sqrt(variance * (1 / n + s_mean * s_mean / s_s)) / cosine;
    }
    dem_mohr_coulomb_complete(fit);
    return DEM_OK;
}

// ---- the file

enum { NO_COLUMN = -1 };

typedef struct table {
    const char *name;
    long line;
    double unit;
    long columns[2];  // of sigma1 and sigma3
    double units[2];  // [Pa]
} table;

static const char *const names[2] = {"sigma1", "sigma3"};

// the next field of a line without blanks about it; where the one behind it starts, NULL: it was the last
static const char *take_field(const char *at, const char *end, const char **from, size_t *length)
{
    const char *comma = memchr(at, ',', (size_t)(end - at)), *to = comma ? comma : end;
    while (at < to && (*at == ' ' || *at == '\t' || *at == '"'))
        at++;
    *from = at;
    while (to > at && (to[-1] == ' ' || to[-1] == '\t' || to[-1] == '\r' || to[-1] == '"'))
        to--;
    *length = (size_t)(to - at);
    return comma ? comma + 1 : NULL;
}

static dem_status read_head(table *t, const char *line, const char *end, dem_error *error)
{
    long column = 0;
    t->columns[0] = t->columns[1] = NO_COLUMN;
    for (const char *at = line, *from; at; column++) {
        size_t length;
        at = take_field(at, end, &from, &length);
        for (int k = 0; k < 2; k++) {
            if (length < 6 || strncmp(from, names[k], 6) != 0 || (length > 6 && from[6] != '_'))
                continue;
            char unit[32] = "";
            if (length > 7 && length < 7 + sizeof unit)
                memcpy(unit, from + 7, length - 7);
            if (t->columns[k] != NO_COLUMN)
                return dem_fail_at(error, DEM_BAD_INPUT, t->name, t->line, "has two columns %s; rename one", names[k]);
            t->columns[k] = column;
            t->units[k] = t->unit;
            dem_error inner;
            if (length > 6 && dem_unit(unit, DEM_DIMENSION_PRESSURE, &t->units[k], &inner) != DEM_OK)
                return dem_fail_at(error, DEM_BAD_INPUT, t->name, t->line, "column %.*s: %s", (int)length, from,
                                   inner.text);
        }
    }
    for (int k = 0; k < 2; k++)
        if (t->columns[k] == NO_COLUMN)
            return dem_fail_at(error, DEM_BAD_INPUT, t->name, t->line,
                               "has no column %s; begin the table with a line of names, as in sigma1,sigma3 or "
                               "sigma1_kPa,sigma3_kPa",
                               names[k]);
    return DEM_OK;
}

static dem_status read_row(const table *t, const char *line, const char *end, dem_failure *test, dem_error *error)
{
    double values[2] = {NAN, NAN};
    long column = 0;
    for (const char *at = line, *from; at; column++) {
        size_t length;
        at = take_field(at, end, &from, &length);
        for (int k = 0; k < 2; k++)
            if (column == t->columns[k] && dem_parse_double(from, from + length, &values[k]) != from + length)
                values[k] = NAN;
    }
    for (int k = 0; k < 2; k++)
        if (!(fabs(values[k]) < 1e100))
            return dem_fail_at(error, DEM_BAD_INPUT, t->name, t->line, "%s is no number; correct or remove the line",
                               names[k]);
    *test = (dem_failure){values[0] * t->units[0], values[1] * t->units[1]};
    if (test->sigma1 < test->sigma3)
        return dem_fail_at(error, DEM_BAD_INPUT, t->name, t->line,
                           "sigma1 is below sigma3; pressure is positive and sigma1 the larger, exchange them");
    return DEM_OK;
}

dem_status dem_failures_parse(const char *text, size_t size, const char *name, double unit, dem_failure **tests,
                              size_t *count, dem_error *error)
{
    table t = {.name = name, .unit = unit};
    size_t capacity = 0;
    bool headed = false;
    dem_status status = DEM_OK;
    *tests = NULL;
    *count = 0;
    for (const char *at = text, *end = text + size; at < end && status == DEM_OK;) {
        const char *newline = memchr(at, '\n', (size_t)(end - at)), *stop = newline ? newline : end;
        const char *next = newline ? newline + 1 : end;
        size_t blank = strspn(at, " \t\r");
        t.line++;
        if (at[blank] == '#' || at + blank >= stop) {
            at = next;
            continue;
        }
        if (!headed)
            status = read_head(&t, at, stop, error);
        else if (!dem_grow(tests, &capacity, *count, sizeof **tests))
            status = dem_fail_memory(error);
        else
            status = read_row(&t, at, stop, &(*tests)[*count], error);
        *count += headed && status == DEM_OK;
        headed = true;
        at = next;
    }
    if (status == DEM_OK && !headed)
        status = dem_fail_at(error, DEM_BAD_INPUT, name, 0, "holds no table; begin it with sigma1,sigma3");
    if (status != DEM_OK) {
        free(*tests);
        *tests = NULL;
        *count = 0;
    }
    return status;
}
