#include "check.h"

#include "base/random.h"
#include "sim/sizes.h"

enum { DRAWS = 100000 };

static const double CURVE_SIZES[] = {0.5e-3, 1e-3, 1e-3, 2e-3, 8e-3};
static const double CURVE_PASSING[] = {0, 0.2, 0.3, 0.6, 1};

static const dem_size_def LAWS[] = {
    {DEM_SIZE_UNIFORM, 1e-3, 4e-3, 0, INFINITY, false, NULL, NULL, 0},
    {DEM_SIZE_UNIFORM, 1e-3, 4e-3, 1.5e-3, 3e-3, false, NULL, NULL, 0},
    {DEM_SIZE_NORMAL, 2e-3, 0.2e-3, 0, INFINITY, false, NULL, NULL, 0},
    {DEM_SIZE_NORMAL, 2e-3, 1e-3, 1e-3, 2.5e-3, false, NULL, NULL, 0},
    {DEM_SIZE_NORMAL, 2e-3, 0.1e-3, 2.8e-3, INFINITY, false, NULL, NULL, 0},
    {DEM_SIZE_NORMAL, 2e-3, 0.1e-3, 0.5e-3, 1.1e-3, false, NULL, NULL, 0},
    {DEM_SIZE_LOGNORMAL, 1e-3, 0.5, 0, INFINITY, false, NULL, NULL, 0},
    {DEM_SIZE_LOGNORMAL, 1e-3, 0.3, 0.8e-3, 1.6e-3, false, NULL, NULL, 0},
    {DEM_SIZE_TABLE, NAN, NAN, 0, INFINITY, false, CURVE_SIZES, CURVE_PASSING, 5},
    {DEM_SIZE_TABLE, NAN, NAN, 0.7e-3, 3e-3, false, CURVE_SIZES, CURVE_PASSING, 5},
};
enum { LAW_COUNT = sizeof LAWS / sizeof LAWS[0] };

// share of the law, without its limits, below d; `below` leaves a step at d out
static double share_below(const dem_size_def *law, double d, bool below)
{
    switch (law->law) {
    case DEM_SIZE_UNIFORM:
        return fmin(fmax((d - law->a) / (law->b - law->a), 0), 1);
    case DEM_SIZE_NORMAL:
        // far above the mean counted from the end, where digits are left
        return law->smallest > law->a ? -erfc((d - law->a) / law->b / sqrt(2)) / 2
                                      : erfc((law->a - d) / law->b / sqrt(2)) / 2;
    case DEM_SIZE_LOGNORMAL:
        return erfc(log(law->a / d) / law->b / sqrt(2)) / 2;
    default:
        break;
    }
    double share = 0;
    for (size_t i = 1; i < law->table_count; i++) {
        double a = law->sizes[i - 1], b = law->sizes[i], w = law->passing[i] - law->passing[i - 1];
        share += a == b ? (d > a || (d == a && !below) ? w : 0) : w * fmin(fmax((d - a) / (b - a), 0), 1);
    }
    return share;
}

static double share_in_limits(const dem_size_def *law, double d, bool below)
{
    double low = law->smallest > 0 ? share_below(law, law->smallest, true) : 0;
    double high = share_below(law, fmin(law->largest, 1e300), false);
    return (share_below(law, d, below) - low) / (high - low);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// the largest distance between the shares of the draws and those of the law; `noise` its scale for random draws,
// `step` the share of the largest body
static double kolmogorov(const dem_size_def *law, bool random, double *noise, double *step)
{
    dem_sizes sizes;
    dem_error error;
    check_ok(dem_sizes_create(law, NAN, &sizes, &error), error);
    double *d = malloc(DRAWS * sizeof *d), total = 0, squares = 0, sum = 0, worst = 0;
    check(d);
    dem_random r = random_stream(11, 0);
    for (int i = 0; i < DRAWS; i++) {
        d[i] = dem_sizes_draw(&sizes, random ? random_uniform(&r) : (i + 0.5) / DRAWS);
        check(d[i] >= law->smallest && d[i] <= law->largest);
        double w = law->by_mass ? d[i] * d[i] * d[i] : 1;
        total += w;
        squares += w * w;
    }
    qsort(d, DRAWS, sizeof *d, ascending);
    for (int i = 0; i < DRAWS;) {
        // equal draws are one step
        double at = d[i], before = sum;
        for (; i < DRAWS && d[i] == at; i++)
            sum += law->by_mass ? at * at * at : 1;
        worst = fmax(worst, fabs(share_in_limits(law, at, true) - before / total));
        worst = fmax(worst, fabs(share_in_limits(law, at, false) - sum / total));
    }
    *noise = sqrt(squares) / total;
    *step = (law->by_mass ? d[DRAWS - 1] * d[DRAWS - 1] * d[DRAWS - 1] : 1) / total;
    free(d);
    dem_sizes_release(&sizes);
    return worst;
}

static void draws_follow_the_law_by_number_and_by_mass(void **state)
{
    (void)state;
    for (int i = 0; i < LAW_COUNT; i++)
        for (int by_mass = 0; by_mass < 2; by_mass++) {
            dem_size_def law = LAWS[i];
            law.by_mass = by_mass;
            double noise, step;
            // Kolmogorov's 1 % level, with the number of draws that count in a sum of masses
            double drawn = kolmogorov(&law, true, &noise, &step);
            check_near(drawn, 0, 1.63 * noise);
            // evenly spread shares are off by the last body at most; in the lognormal law by mass that one stands for a
            // tail without end. A segment of a tail at 8 deviations falls by exp(-8 * 8.3 / 4096), of which straight
            // lines leave 3e-5
            double curved = law.law == DEM_SIZE_NORMAL ? 5e-5 : 1e-6;
            double spread = kolmogorov(&law, false, &noise, &step);
            check_near(spread, 0, curved + (law.law == DEM_SIZE_LOGNORMAL ? 3 : 1) * step);
        }
}

static void a_law_by_mass_is_the_reweighted_law_by_number(void **state)
{
    (void)state;
    // shares of the number below d from int n(x) dx, n = f / x^3, by the midpoint rule
    dem_size_def law = {DEM_SIZE_NORMAL, 2e-3, 0.8e-3, 0.5e-3, 4e-3, true, NULL, NULL, 0};
    dem_sizes sizes;
    dem_error error;
    check_ok(dem_sizes_create(&law, NAN, &sizes, &error), error);
    enum { STEPS = 200000 };
    double h = 3.5e-3 / STEPS, total = 0, sum = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < STEPS; i++) {
            double x = 0.5e-3 + (i + 0.5) * h, z = (x - law.a) / law.b, n = exp(-z * z / 2) / (x * x * x);
            if (pass == 0)
                total += n;
            else if ((i + 1) % 20000 == 0)
                // x of the curve is good to h^2 of its 4096 segments
                check_close(dem_sizes_draw(&sizes, (sum + n) / total), x + h / 2, 2e-6);
            if (pass == 1)
                sum += n;
        }
    dem_sizes_release(&sizes);
}

static void single_sizes_are_exact(void **state)
{
    (void)state;
    const dem_size_def laws[] = {
        {DEM_SIZE_AS_IS, NAN, NAN, 0, INFINITY, false, NULL, NULL, 0},
        {DEM_SIZE_FIXED, 0.0123, NAN, 0, INFINITY, true, NULL, NULL, 0},
        {DEM_SIZE_UNIFORM, 0.0123, 0.0123, 0, INFINITY, true, NULL, NULL, 0},
        {DEM_SIZE_NORMAL, 0.0123, 0, 0, INFINITY, false, NULL, NULL, 0},
        {DEM_SIZE_LOGNORMAL, 0.0123, 0, 0, INFINITY, true, NULL, NULL, 0},
    };
    for (int i = 0; i < 5; i++)
        for (double u = 0; u <= 1; u += 0.25) {
            dem_sizes sizes;
            dem_error error;
            check_ok(dem_sizes_create(&laws[i], 0.0123, &sizes, &error), error);
            check(dem_sizes_draw(&sizes, u) == 0.0123);
            dem_sizes_release(&sizes);
        }
}

static void draws_ascend_with_the_share_and_reach_the_limits(void **state)
{
    (void)state;
    for (int i = 0; i < LAW_COUNT; i++)
        for (int by_mass = 0; by_mass < 2; by_mass++) {
            dem_size_def law = LAWS[i];
            law.by_mass = by_mass;
            dem_sizes sizes;
            dem_error error;
            check_ok(dem_sizes_create(&law, NAN, &sizes, &error), error);
            double before = 0;
            for (int n = 0; n <= 10000; n++) {
                double d = dem_sizes_draw(&sizes, n / 10000.0);
                check(d >= before && d > 0);
                before = d;
            }
            if (law.smallest > 0.5e-3)
                check_close(dem_sizes_draw(&sizes, 0), law.smallest, 1e-14);
            if (isfinite(law.largest))
                check_close(before, law.largest, 1e-14);
            dem_sizes_release(&sizes);
        }
}

static void refused(dem_size_def def, const char *why)
{
    dem_sizes sizes;
    dem_error error = {0};
    check(dem_sizes_create(&def, 1e-3, &sizes, &error) == DEM_USAGE && !sizes.segments);
    if (!strstr(error.text, why))
        print_error("%s\n", error.text);
    check(strstr(error.text, why));
}

static void unusable_laws_are_refused_with_the_reason(void **state)
{
    (void)state;
    const double down[] = {2e-3, 1e-3}, up[] = {1e-3, 2e-3}, from_0[] = {0, 1e-3}, shares[] = {0, 1}, half[] = {0, 0.5};
    double inf = INFINITY;
    refused((dem_size_def){.law = DEM_SIZE_FIXED, .a = -1, .largest = inf}, "size: must be positive");
    refused((dem_size_def){.law = DEM_SIZE_FIXED, .a = NAN, .largest = inf}, "size: must be positive");
    refused((dem_size_def){.law = DEM_SIZE_UNIFORM, .a = 2, .b = 1, .largest = inf}, "the smaller one first");
    refused((dem_size_def){.law = DEM_SIZE_UNIFORM, .a = 0, .b = 1, .largest = inf}, "starts at 0; give the smallest");
    refused((dem_size_def){.law = DEM_SIZE_NORMAL, .a = 1, .b = NAN, .largest = inf}, "a deviation that is not");
    refused((dem_size_def){.law = DEM_SIZE_NORMAL, .a = 1, .b = 0.5, .largest = inf, .by_mass = true},
            "endless numbers of them; give the smallest size");
    refused((dem_size_def){.law = DEM_SIZE_AS_IS, .smallest = 2e-3, .largest = 1}, "no sizes between 0.002 and 1 m");
    refused((dem_size_def){.law = DEM_SIZE_NORMAL, .a = 1, .b = 0.01, .smallest = 2, .largest = 3}, "no sizes between");
    refused((dem_size_def){.law = DEM_SIZE_FIXED, .a = 1, .smallest = 2, .largest = 1}, "the limits must be positive");
    refused((dem_size_def){DEM_SIZE_TABLE, NAN, NAN, 0, inf, false, down, shares, 2}, "must ascend");
    refused((dem_size_def){DEM_SIZE_TABLE, NAN, NAN, 0, inf, false, up, half, 2}, "end at 1");
    refused((dem_size_def){DEM_SIZE_TABLE, NAN, NAN, 0, inf, false, up, shares, 1}, "at least two points");
    refused((dem_size_def){DEM_SIZE_TABLE, NAN, NAN, 0, inf, true, from_0, shares, 2}, "starts at 0");
    refused((dem_size_def){DEM_SIZE_TABLE, NAN, NAN, 0, inf, true, from_0, up, 2}, "end at 1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draws_follow_the_law_by_number_and_by_mass),
        cmocka_unit_test(a_law_by_mass_is_the_reweighted_law_by_number),
        cmocka_unit_test(single_sizes_are_exact),
        cmocka_unit_test(draws_ascend_with_the_share_and_reach_the_limits),
        cmocka_unit_test(unusable_laws_are_refused_with_the_reason),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
