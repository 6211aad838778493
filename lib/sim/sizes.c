// A law by mass with density f(d) has the number density f(d) / d^3. In a segment [a, b] of uniform f the number is
// f (1/a^2 - 1/b^2) / 2, and its cumulated share v is reached at 1/d^2 = 1/a^2 - v (1/a^2 - 1/b^2). The lognormal law
// stays lognormal, with the median times exp(-3 sigma^2) (Hatch & Choate 1929).
#include "sim/sizes.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

// [low, high] [m]; `end` is the share, not yet divided by the total, of this and all segments before
struct dem_size_segment {
    double low, high, end;
};
typedef struct dem_size_segment segment;

enum { NORMAL_SEGMENTS = 4096 };
// in standard deviations; 1e-16 of a normal law lies beyond
static const double WIDEST = 8.3;

static dem_status refuse(dem_error *error, const char *what)
{
    return dem_fail(error, DEM_USAGE, "size: %s", what);
}

// adds what lies between the limits of a segment with this share
static void add(dem_sizes *s, const dem_size_def *def, double low, double high, double share)
{
    double a = fmax(low, def->smallest), b = fmin(high, def->largest);
    if (!(share > 0) || a > b || (a == b && low < high))
        return;
    if (low < high)
        share *= (b - a) / (high - low);
    if (s->by_mass)
        share *= (a + b) / 2 / (a * a) / (b * b);
    double before = s->count ? s->segments[s->count - 1].end : 0;
    s->segments[s->count++] = (segment){a, b, before + share};
}

// share of the standard normal law between x and y; accurate in both tails
static double normal_share(double x, double y)
{
    double s = sqrt(0.5);
    return x > 0 ? (erfc(x * s) - erfc(y * s)) / 2 : (erfc(-y * s) - erfc(-x * s)) / 2;
}

// the diameter at z standard deviations
static double at_deviation(const dem_size_def *def, double median, double z)
{
    return def->law == DEM_SIZE_NORMAL ? median + z * def->b : median * exp(z * def->b);
}

static double deviation_of(const dem_size_def *def, double median, double d)
{
    return def->law == DEM_SIZE_NORMAL ? (d - median) / def->b : log(d / median) / def->b;
}

static void add_normal(dem_sizes *s, const dem_size_def *def, double median)
{
    double lowest = deviation_of(def, median, def->smallest), highest = deviation_of(def, median, def->largest);
    // limits in a tail leave what lies next to them
    double from = fmax(lowest, fmin(-WIDEST, highest - WIDEST)), to = fmin(highest, fmax(WIDEST, lowest + WIDEST));
    double before = from, low = at_deviation(def, median, from);
    for (int i = 1; i <= NORMAL_SEGMENTS && from < to; i++) {
        double z = from + (to - from) * i / NORMAL_SEGMENTS, high = at_deviation(def, median, z);
        add(s, def, low, high, normal_share(before, z));
        before = z;
        low = high;
    }
}

static dem_status check_table(const dem_size_def *def, dem_error *error)
{
    size_t n = def->table_count;
    if (n < 2)
        return refuse(error, "a grading curve needs at least two points");
    for (size_t i = 0; i < n; i++) {
        if (!(def->sizes[i] >= 0 && isfinite(def->sizes[i])) || !(def->passing[i] >= 0 && def->passing[i] <= 1))
            return refuse(error, "the sizes of a grading curve must be positive and its shares from 0 to 1");
        if (i > 0 && (def->sizes[i] < def->sizes[i - 1] || def->passing[i] < def->passing[i - 1]))
            return refuse(error, "a grading curve must ascend, from the finest size to the coarsest");
    }
    if (def->passing[0] != 0 || def->passing[n - 1] != 1)
        return refuse(error, "a grading curve must start at a share of 0 and end at 1; add the missing points");
    return DEM_OK;
}

static dem_status check(const dem_size_def *def, dem_error *error)
{
    if (!(def->smallest >= 0) || !(def->largest > 0) || def->smallest > def->largest)
        return refuse(error, "the limits must be positive and the smallest below the largest size");
    switch (def->law) {
    case DEM_SIZE_AS_IS:
        return DEM_OK;
    case DEM_SIZE_TABLE:
        return check_table(def, error);
    case DEM_SIZE_UNIFORM:
        if (!(def->a >= 0 && def->b >= def->a && isfinite(def->b)))
            return refuse(error, "a uniform law needs two positive sizes, the smaller one first");
        return DEM_OK;
    case DEM_SIZE_FIXED:
        if (!(def->a > 0 && isfinite(def->a)))
            return refuse(error, "must be positive");
        return DEM_OK;
    default:
        if (!(def->a > 0 && isfinite(def->a) && def->b >= 0 && isfinite(def->b)))
            return refuse(error, "a normal law needs a positive size and a deviation that is not negative");
        return DEM_OK;
    }
}

// the law's segments into `s`, which has room; `def` has usable limits
static void add_law(dem_sizes *s, const dem_size_def *def, double as_is)
{
    switch (def->law) {
    case DEM_SIZE_AS_IS:
        add(s, def, as_is, as_is, 1);
        break;
    case DEM_SIZE_FIXED:
        add(s, def, def->a, def->a, 1);
        break;
    case DEM_SIZE_UNIFORM:
        add(s, def, def->a, def->b, 1);
        break;
    case DEM_SIZE_TABLE:
        for (size_t i = 1; i < def->table_count; i++)
            add(s, def, def->sizes[i - 1], def->sizes[i], def->passing[i] - def->passing[i - 1]);
        break;
    default:
        if (def->b == 0)
            add(s, def, def->a, def->a, 1);
        else if (def->law == DEM_SIZE_LOGNORMAL && s->by_mass) {
            s->by_mass = false;
            add_normal(s, def, def->a * exp(-3 * def->b * def->b));
        } else
            add_normal(s, def, def->a);
    }
}

dem_status dem_sizes_create(const dem_size_def *def, double as_is, dem_sizes *sizes, dem_error *error)
{
    *sizes = (dem_sizes){.by_mass = def->by_mass};
    DEM_TRY(check(def, error));
    dem_size_def limited = *def;
    if (def->law == DEM_SIZE_NORMAL && def->smallest == 0) {
        double lowest = def->a - WIDEST * def->b;
        if (def->by_mass && lowest <= 0)
            return refuse(error, "a normal law by mass that reaches sizes of 0 has endless numbers of them; give the "
                                 "smallest size");
        limited.smallest = fmax(lowest, def->a / 1000);
    }
    sizes->segments = dem_alloc(NORMAL_SEGMENTS + def->table_count, sizeof *sizes->segments);
    if (!sizes->segments)
        return dem_fail_memory(error);
    add_law(sizes, &limited, as_is);
    bool none = sizes->count == 0, zero = !none && !(sizes->segments[0].low > 0);
    if (none || zero || !isfinite(sizes->segments[sizes->count - 1].end))
        dem_sizes_release(sizes);
    if (none)
        return dem_fail(error, DEM_USAGE, "size: the law has no sizes between %g and %g m; widen the limits",
                        def->smallest, def->largest);
    if (zero)
        return refuse(error, "the law starts at 0; give the smallest size");
    return sizes->segments ? DEM_OK : refuse(error, "the law has sizes too small to count; give the smallest size");
}

void dem_sizes_release(dem_sizes *sizes)
{
    free(sizes->segments);
    *sizes = (dem_sizes){0};
}

double dem_sizes_draw(const dem_sizes *sizes, double u)
{
    const segment *s = sizes->segments;
    double want = u * s[sizes->count - 1].end;
    size_t low = 0, high = sizes->count - 1;
    // the first segment that ends at or above it
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (s[middle].end < want)
            low = middle + 1;
        else
            high = middle;
    }
    double start = low ? s[low - 1].end : 0, a = s[low].low, b = s[low].high;
    if (a == b)
        return a;
    double v = fmin(fmax((want - start) / (s[low].end - start), 0), 1);
    if (!sizes->by_mass)
        return a + v * (b - a);
    double ratio = a / b;
    return fmin(a / sqrt(1 - v * (1 - ratio * ratio)), b);
}
