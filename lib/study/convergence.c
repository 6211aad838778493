#include "study/convergence.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/status.h"
#include "math/vec.h"
#include "study/convergence_plan.h"

// ---- quantities

static const char *const quantity_names[DEM_QUANTITIES] = {"state", "position", "orientation", "energy"};

// what a mean of an ensemble is taken of; of trajectories too, for these show where a scene is
static bool column_counts(const char *name)
{
    return strcmp(name, "time_s") != 0 && strcmp(name, "step") != 0 && strcmp(name, "energy_error") != 0;
}

static dem_status name_quantities(dem_convergence *c, const dem_course *sample, dem_error *error)
{
    c->quantities = dem_alloc_zero(DEM_QUANTITIES + sample->columns, sizeof *c->quantities);
    if (!c->quantities)
        return dem_fail_memory(error);
    for (size_t i = 0; i < DEM_QUANTITIES; i++)
        snprintf(c->quantities[c->quantity_count++], DEM_CONVERGENCE_NAME, "%s", quantity_names[i]);
    for (size_t k = 0; k < sample->columns; k++)
        if (column_counts(sample->names[k]))
            snprintf(c->quantities[c->quantity_count++], DEM_CONVERGENCE_NAME, "%s", sample->names[k]);
    return DEM_OK;
}

static size_t quantity_named(const dem_convergence *c, const char *name)
{
    for (size_t i = 0; i < c->quantity_count; i++)
        if (strcmp(c->quantities[i], name) == 0)
            return i;
    return SIZE_MAX;
}

static dem_status choose_quantity(const dem_convergence_def *def, dem_convergence *c, dem_error *error)
{
    const char *name = def->of;
    if (!name)
        name = !c->chaotic ? "state" : v3_norm(def->scene->gravity) > 0 ? "potential_J" : "kinetic_J";
    c->of = quantity_named(c, name);
    if (c->of == SIZE_MAX)
        return dem_fail(error, DEM_USAGE,
                        "the series has no column '%s'; take state, position, orientation, energy or one of the heads "
                        "of series.csv",
                        name);
    if (c->chaotic && c->of <= DEM_QUANTITY_TURN)
        return dem_fail(error, DEM_USAGE,
                        "%s is of a trajectory, and this scene has none that could be right; take a column of the "
                        "series",
                        name);
    return DEM_OK;
}

// ---- trajectories

static double worst_of(double a, double b)
{
    return isnan(a) || b <= a ? a : b;
}

// the range of a column, or what it is about where it stands still
static double range_of(const dem_course *c, size_t column)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < c->rows; i++) {
        low = fmin(low, c->series[i * c->columns + column]);
        high = fmax(high, c->series[i * c->columns + column]);
    }
    double size = fmax(fabs(low), fabs(high));
    return high - low > 1e-9 * size ? high - low : size;
}

static double column_off(const dem_course *a, const dem_course *b, size_t column)
{
    double off = 0;
    for (size_t i = 0; i < b->rows; i++)
        off = worst_of(off, fabs(a->series[i * a->columns + column] - b->series[i * b->columns + column]));
    double range = range_of(b, column);
    return range > 0 ? off / range : off > 0 ? INFINITY : 0;
}

static double ledger_off(const dem_course *c)
{
    size_t column = dem_course_column(c, "energy_error");
    double off = 0;
    for (size_t i = 0; column != SIZE_MAX && i < c->rows; i++)
        off = worst_of(off, fabs(c->series[i * c->columns + column]));
    return column == SIZE_MAX ? NAN : off;
}

// errors of a against b, all quantities
static void compare(const dem_convergence *c, const dem_convergence_plan *p, const dem_course *a, const dem_course *b,
                    double *errors)
{
    bool comparable = !*a->failed && !*b->failed && a->rows == b->rows && a->columns == b->columns;
    double place = 0, turn = 0;
    for (size_t i = 0; comparable && i < b->rows; i++) {
        dem_apart apart = dem_course_apart(a, b, &p->scene.domain, i);
        place = worst_of(place, apart.place);
        turn = worst_of(turn, apart.turn);
    }
    for (size_t q = 0; q < c->quantity_count; q++)
        errors[q] = NAN;
    if (!comparable)
        return;
    errors[DEM_QUANTITY_PLACE] = place;
    errors[DEM_QUANTITY_TURN] = turn;
    errors[DEM_QUANTITY_STATE] = worst_of(place, turn);
    errors[DEM_QUANTITY_ENERGY] = p->def->push ? NAN : ledger_off(a);
    for (size_t q = DEM_QUANTITIES; q < c->quantity_count; q++)
        errors[q] = column_off(a, b, dem_course_column(b, c->quantities[q]));
}

// how far the reference is from the truth: it is as far from the run at twice its step as that would be from it by the
// order that these and the run before show
static double doubt_of(double coarse, double fine)
{
    double order = log2(coarse / fine);
    if (!(order > 0.5))
        order = 0.5;
    if (order > 4)
        order = 4;
    return fine / (exp2(order) - 1);
}

static dem_status judge_trajectories(const dem_convergence_plan *p, const dem_cell_result *results, dem_convergence *c,
                                     dem_error *error)
{
    size_t count = c->quantity_count, ladder = c->method_count * c->levels;
    dem_course refs[DEM_REFERENCES], course;
    double *doubt = dem_alloc(3 * count, sizeof *doubt);
    memset(refs, 0, sizeof refs);
    dem_status status = doubt ? DEM_OK : dem_fail_memory(error);
    for (size_t i = 0; i < DEM_REFERENCES && status == DEM_OK; i++)
        status = dem_course_get(&results[dem_plan_cell(p, ladder + i)], &refs[i], error);
    const dem_course *finest = &refs[DEM_REFERENCES - 1];
    if (status == DEM_OK) {
        compare(c, p, &refs[0], &refs[1], doubt + count);
        compare(c, p, &refs[1], finest, doubt + 2 * count);
        for (size_t q = 0; q < count; q++)
            doubt[q] = q == DEM_QUANTITY_ENERGY ? 0 : doubt_of(doubt[count + q], doubt[2 * count + q]);
    }
    for (size_t i = 0; i < ladder && status == DEM_OK; i++) {
        status = dem_course_get(&results[dem_plan_cell(p, i)], &course, error);
        if (status != DEM_OK)
            break;
        dem_convergence_point *point = &c->points[i];
        double *errors = doubt + count;  // no longer needed
        compare(c, p, &course, finest, errors);
        for (size_t q = 0; q < count; q++)
            point->errors[q] = (dem_error_found){errors[q], doubt[q]};
        point->seconds = course.seconds;
        memcpy(point->failed, course.failed, sizeof point->failed);
        dem_course_release(&course);
    }
    c->finest.seconds = finest->seconds;
    memcpy(c->finest.failed, finest->failed, sizeof c->finest.failed);
    for (size_t i = 0; i < DEM_REFERENCES; i++)
        dem_course_release(&refs[i]);
    free(doubt);
    return status;
}

// ---- ensembles

// of the members at a point, by quantity
typedef struct statistics {
    double *mean, *deviation, *range;
    double seconds;
    char failed[200];
} statistics;

static bool statistics_make(statistics *s, size_t count)
{
    *s = (statistics){.mean = dem_alloc_zero(3 * count, sizeof *s->mean)};
    if (!s->mean)
        return false;
    s->deviation = s->mean + count;
    s->range = s->deviation + count;
    return true;
}

// the mean over the last quarter; of the ledger the worst
static double outcome(const dem_convergence *c, const dem_course *course, size_t quantity)
{
    if (quantity == DEM_QUANTITY_ENERGY)
        return ledger_off(course);
    size_t column = dem_course_column(course, c->quantities[quantity]),
           from = course->rows - 1 - (course->rows - 1) / 4;
    double sum = 0;
    for (size_t i = from; i < course->rows; i++)
        sum += course->series[i * course->columns + column];
    return sum / (double)(course->rows - from);
}

// means and squares by Welford's recurrence
static dem_status gather(const dem_convergence_plan *p, const dem_cell_result *results, size_t point,
                         const dem_convergence *c, statistics *s, dem_error *error)
{
    for (size_t m = 0; m < p->members; m++) {
        dem_course course;
        DEM_TRY(dem_course_get(&results[dem_plan_cell(p, point) + m], &course, error));
        s->seconds += course.seconds / (double)p->members;
        if (*course.failed)
            memcpy(s->failed, course.failed, sizeof s->failed);
        for (size_t q = DEM_QUANTITY_ENERGY; q < c->quantity_count && !*course.failed; q++) {
            double x = outcome(c, &course, q), d = x - s->mean[q];
            s->mean[q] += d / (double)(m + 1);
            s->deviation[q] += d * (x - s->mean[q]);
            if (m == 0 && q >= DEM_QUANTITIES)
                s->range[q] = range_of(&course, dem_course_column(&course, c->quantities[q]));
        }
        dem_course_release(&course);
    }
    for (size_t q = DEM_QUANTITY_ENERGY; q < c->quantity_count; q++)
        s->deviation[q] = p->members > 1 ? sqrt(s->deviation[q] / (double)(p->members - 1)) : INFINITY;
    return DEM_OK;
}

static void compare_means(const dem_convergence *c, const statistics *a, const statistics *b, dem_convergence_point *p)
{
    memcpy(p->failed, a->failed, sizeof p->failed);
    p->seconds = a->seconds;
    for (size_t q = 0; q < c->quantity_count; q++) {
        p->errors[q] = (dem_error_found){NAN, NAN};
        if (q < DEM_QUANTITY_ENERGY || *a->failed || *b->failed)
            continue;
        double half = dem_confidence(a->deviation[q], b->deviation[q], c->members);
        if (q == DEM_QUANTITY_ENERGY)
            p->errors[q] = (dem_error_found){a->mean[q], dem_confidence(a->deviation[q], 0, c->members)};
        else if (b->range[q] > 0)
            p->errors[q] = (dem_error_found){fabs(a->mean[q] - b->mean[q]) / b->range[q], half / b->range[q]};
        else
            p->errors[q] = (dem_error_found){a->mean[q] == b->mean[q] ? 0 : INFINITY, 0};
    }
}

static dem_status judge_ensembles(const dem_convergence_plan *p, const dem_cell_result *results, dem_convergence *c,
                                  dem_error *error)
{
    size_t ladder = c->method_count * c->levels;
    statistics reference;
    if (!statistics_make(&reference, c->quantity_count))
        return dem_fail_memory(error);
    dem_status status = gather(p, results, ladder, c, &reference, error);
    c->finest.seconds = reference.seconds;
    memcpy(c->finest.failed, reference.failed, sizeof c->finest.failed);
    for (size_t i = 0; i < ladder && status == DEM_OK; i++) {
        statistics s;
        status = statistics_make(&s, c->quantity_count) ? DEM_OK : dem_fail_memory(error);
        if (status == DEM_OK)
            status = gather(p, results, i, c, &s, error);
        if (status == DEM_OK)
            compare_means(c, &s, &reference, &c->points[i]);
        free(s.mean);
    }
    free(reference.mean);
    return status;
}

// ---- the whole

static dem_status make_points(const dem_convergence_plan *p, dem_convergence *c, dem_error *error)
{
    size_t ladder = c->method_count * c->levels;
    c->points = dem_alloc_zero(ladder, sizeof *c->points);
    c->orders = dem_alloc_zero(c->method_count * c->quantity_count, sizeof *c->orders);
    if (!c->points || !c->orders)
        return dem_fail_memory(error);
    for (size_t i = 0; i < ladder; i++) {
        c->points[i].steps = dem_plan_steps(p, i);
        c->points[i].step = c->end / (double)c->points[i].steps;
        c->points[i].errors = dem_alloc_zero(c->quantity_count, sizeof *c->points[i].errors);
        if (!c->points[i].errors)
            return dem_fail_memory(error);
    }
    c->finest.steps = dem_plan_steps(p, dem_plan_points(p) - 1);
    c->finest.step = c->end / (double)c->finest.steps;
    return DEM_OK;
}

static void fit_orders(dem_convergence *c)
{
    double steps[DEM_CONVERGENCE_LEVELS];
    dem_error_found errors[DEM_CONVERGENCE_LEVELS];
    for (size_t m = 0; m < c->method_count; m++)
        for (size_t q = 0; q < c->quantity_count; q++) {
            for (size_t l = 0; l < c->levels; l++) {
                steps[l] = c->points[m * c->levels + l].step;
                errors[l] = c->points[m * c->levels + l].errors[q];
            }
            c->orders[m * c->quantity_count + q] = dem_order_fit(steps, errors, c->levels);
        }
}

static dem_status first_failure(const dem_cell_result *results, size_t count, dem_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (results[i].status != DEM_OK && results[i].status != DEM_INTERRUPTED) {
            if (error)
                *error = results[i].error;
            return results[i].status;
        }
    return DEM_OK;
}

static dem_status judge(const dem_convergence_plan *p, const dem_cell_result *results, dem_convergence *c,
                        dem_error *error)
{
    const dem_convergence_def *d = p->def;
    dem_course sample;
    // the reference knows all columns
    DEM_TRY(dem_course_get(&results[dem_plan_cells(p) - 1], &sample, error));
    dem_status status = name_quantities(c, &sample, error);
    if (status == DEM_OK && *sample.failed)
        status = dem_fail(error, DEM_FAILED, "the reference does not run: %s", sample.failed);
    dem_course_release(&sample);
    DEM_TRY(status);
    DEM_TRY(choose_quantity(d, c, error));
    DEM_TRY(make_points(p, c, error));
    DEM_TRY((c->chaotic ? judge_ensembles : judge_trajectories)(p, results, c, error));
    fit_orders(c);
    if (!isnan(d->asked))
        c->best = dem_convergence_cheapest(c, c->of, d->asked);
    return DEM_OK;
}

static dem_status run_cells(const dem_ctx *ctx, dem_convergence_plan *p, dem_convergence *c, dem_error *error)
{
    size_t count = c->cells = dem_plan_cells(p);
    if (p->def->only != DEM_ALL_CELLS && p->def->only >= count)
        return dem_fail(error, DEM_USAGE, "there is no cell %zu; there are 0 to %zu", p->def->only, count - 1);
    dem_cell_result *results = dem_alloc_zero(count, sizeof *results);
    if (!results)
        return dem_fail_memory(error);
    dem_status status = dem_plan_run(ctx, p, results, error);
    if (status == DEM_OK)
        status = first_failure(results, count, error);
    for (size_t i = 0; i < count; i++)
        c->undone += results[i].status != DEM_OK;
    if (status == DEM_OK && c->undone == 0)
        status = judge(p, results, c, error);
    dem_cells_release(results, count);
    free(results);
    return status;
}

static dem_status check(const dem_convergence_def *d, dem_error *error)
{
    if (!(d->scene->time.end > 0))
        return dem_fail(error, DEM_USAGE, "the scene has no end; give one with -D time.end=SECONDS");
    DEM_ASSERT(d->method_count >= 1 && d->method_count <= DEM_CONVERGENCE_METHODS);
    DEM_ASSERT(d->levels >= 2 && d->levels <= DEM_CONVERGENCE_LEVELS);
    DEM_ASSERT(d->members >= 1 && d->members <= DEM_CONVERGENCE_MEMBERS);
    return DEM_OK;
}

dem_status dem_convergence_run(const dem_ctx *ctx, const dem_convergence_def *def, dem_convergence *c, dem_error *error)
{
    *c = (dem_convergence){.best = SIZE_MAX, .asked = def->asked, .levels = def->levels};
    DEM_TRY(check(def, error));
    dem_convergence_plan plan = {.def = def, .scene = *def->scene};
    dem_status status = dem_convergence_probe(ctx, &plan, c, error);
    if (status == DEM_OK) {
        c->method_count = plan.methods;
        c->members = plan.members;
        memcpy(c->methods, def->methods, plan.methods * sizeof *c->methods);
        for (size_t m = 0; m < plan.methods; m++)
            dem_method_name(c->methods[m], c->names[m], sizeof c->names[m]);
        c->reference = plan.reference;
        dem_method_name(c->reference, c->reference_name, sizeof c->reference_name);
        status = run_cells(ctx, &plan, c, error);
    }
    if (status != DEM_OK)
        dem_convergence_release(c);
    return status;
}

void dem_convergence_release(dem_convergence *c)
{
    for (size_t i = 0; c->points && i < c->method_count * c->levels; i++)
        free(c->points[i].errors);
    free(c->points);
    free(c->orders);
    free(c->quantities);
    c->points = NULL;
    c->orders = NULL;
    c->quantities = NULL;
}
