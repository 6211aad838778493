#include "out/scale.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

enum { FEWEST_LABELS = 3, MANY_LABELS = 7, LINEAR_LABELS = 6 };

static const double room = 0.04;        // of the range on both sides
static const double least_range = 0.3;  // decades

bool dem_scale_takes(bool log, double value)
{
    return isfinite(value) && (!log || value > 0);
}

// values as they lie along the axis
static double along(bool log, double value)
{
    return log ? log10(value) : value;
}

static double back(bool log, double value)
{
    return log ? pow(10, value) : value;
}

dem_scale dem_scale_fit(bool log, const double *values, size_t count)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < count; i++)
        if (dem_scale_takes(log, values[i])) {
            low = fmin(low, along(log, values[i]));
            high = fmax(high, along(log, values[i]));
        }
    if (!(low <= high))
        return (dem_scale){log, log ? 1 : 0, log ? 10 : 1};
    double least = log ? least_range : fmax(1e-9 * fmax(fabs(low), fabs(high)), 1e-300);
    double range = fmax(high - low, least), middle = (low + high) / 2;
    double half = range * (0.5 + room);
    // an axis of lengths or counts begins at zero where that is near
    bool from_zero = !log && low >= 0 && low < 0.4 * high;
    return (dem_scale){log, back(log, from_zero ? 0 : middle - half), back(log, middle + half)};
}

double dem_scale_map(const dem_scale *scale, double value)
{
    double low = along(scale->log, scale->low), high = along(scale->log, scale->high);
    return (along(scale->log, value) - low) / (high - low);
}

void dem_tick_label(double value, char *text, size_t size)
{
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    double size_of = fabs(value);
    if (value == 0 || (size_of > 0.99e-3 && size_of < 0.99e5)) {
        dem_format_double(text, size, value, 6);
        return;
    }
    int power = (int)floor(log10(size_of) + 1e-9);
    double first = value / pow(10, power);
    char digits[16] = "", number[16];
    if (fabs(first - 1) > 1e-6)
        dem_format_double(digits, sizeof digits, first, 3);
    snprintf(number, sizeof number, "%d", power < 0 ? -power : power);
    snprintf(text, size, "%s%s10%s", digits, *digits ? "·" : "", power < 0 ? "⁻" : "");
    for (const char *c = number; *c; c++)
        snprintf(text + strlen(text), size - strlen(text), "%s", raised[*c - '0']);
}

static size_t add_tick(dem_tick *ticks, size_t count, double value, bool labelled)
{
    if (count == DEM_MOST_TICKS)
        return count;
    ticks[count] = (dem_tick){.value = value};
    if (labelled)
        dem_tick_label(value, ticks[count].label, sizeof ticks[count].label);
    return count + 1;
}

static size_t linear_ticks(double low, double high, dem_tick *ticks)
{
    static const double steps[] = {1, 2, 5, 10};
    double rough = (high - low) / LINEAR_LABELS, power = pow(10, floor(log10(rough))), step = power;
    for (int k = 0; k < 4 && step < rough; k++)
        step = steps[k] * power;
    size_t count = 0;
    for (double k = ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++)
        count = add_tick(ticks, count, k * step + 0.0, true);
    return count;
}

// which of 1..9 times a power of ten have labels, every how many decades
typedef struct labels {
    unsigned digits;  // bit d: d has one
    int every;
} labels;

static bool in_range(const dem_scale *s, double value)
{
    return value >= s->low * (1 - 1e-9) && value <= s->high * (1 + 1e-9);
}

static int count_labels(const dem_scale *s, int first, int last, labels l)
{
    int count = 0;
    for (int p = first; p <= last; p++)
        for (int d = 1; d < 10; d++)
            count += (l.digits >> d & 1) && p % l.every == 0 && in_range(s, d * pow(10, p));
    return count;
}

static labels choose_labels(const dem_scale *s, int first, int last)
{
    static const unsigned sets[] = {1u << 1, 1u << 1 | 1u << 2 | 1u << 5,
                                    1u << 1 | 1u << 2 | 1u << 3 | 1u << 4 | 1u << 6 | 1u << 8, 0x3fe};
    labels l = {sets[0], 1};
    while (count_labels(s, first, last, l) > MANY_LABELS)
        l.every++;
    for (int k = 1; k < 4 && count_labels(s, first, last, l) < FEWEST_LABELS; k++)
        l.digits = sets[k];
    return l;
}

size_t dem_scale_ticks(const dem_scale *s, dem_tick ticks[DEM_MOST_TICKS])
{
    if (!s->log)
        return linear_ticks(s->low, s->high, ticks);
    int first = (int)floor(log10(s->low) + 1e-9), last = (int)floor(log10(s->high) + 1e-9);
    labels l = choose_labels(s, first, last);
    if (count_labels(s, first, last, l) < FEWEST_LABELS)
        return linear_ticks(s->low, s->high, ticks);
    size_t count = 0;
    for (int p = first; p <= last; p++)
        for (int d = 1; d < (l.every > 1 ? 2 : 10); d++)
            if (in_range(s, d * pow(10, p)))
                count = add_tick(ticks, count, d * pow(10, p), (l.digits >> d & 1) && p % l.every == 0);
    return count;
}
