// An error falls about as a power of the number of spheres: outwards by this law until the bound holds, then inwards by
// interpolation, where that creeps by bisection, until the number taken works and the next smaller one does not.
//
// Errors are no smooth functions of the number. Some rise with it (the overlap of spheres): where more spheres do not
// help, fewer are tried. Neighbours scatter by some percent: where the smaller one failed narrowly, the two below it
// are tried too.
#include "clump/fewest.h"

#include <math.h>

enum { OUTWARD_TRIES = 8, AROUND_TRIES = 6, INWARD_TRIES = 9, BELOW = 2 };
enum { SINGLE_SHOWS = 133 };  // fewer: single spheres show

static const double usual_power = 0.8, least_power = 0.35, most_power = 1.6;
static const double aim = 0.985;         // of the bound: errors scatter by a percent or two
static const double resolution = 0.015;  // of the number of spheres
static const double narrowly = 1.02;
static const double near_bound = 0.05, beyond = 0.03;  // relative, of the error and of the number
static const double dropped = 0.1;                     // a lower error has not come down as a power
static const double most_growth = 8;                   // of the number at a time: slopes learnt from noise lead far

typedef struct search {
    dem_fewest_measure *measure;
    void *user;
    dem_fewest_try tried[DEM_FEWEST_TRIES];
    size_t count;
    dem_fewest_try works, fails;  // the least that works, the largest below that does not; asked 0: none
    dem_fewest_try best;
    double power;
} search;

static bool holds(dem_fewest_try t)
{
    return t.worst <= 1;
}

bool dem_fewest_better(dem_fewest_try a, dem_fewest_try b)
{
    if (holds(a) != holds(b))
        return holds(a);
    if (holds(a) && a.got != b.got)
        return a.got < b.got;
    return a.worst < b.worst;
}

static const dem_fewest_try *find(const search *s, size_t asked)
{
    for (size_t i = 0; i < s->count; i++)
        if (s->tried[i].asked == asked)
            return &s->tried[i];
    return NULL;
}

// the bracket, from everything that was tried
static void set_bracket(search *s)
{
    s->works = s->fails = (dem_fewest_try){0};
    for (size_t i = 0; i < s->count; i++)
        if (holds(s->tried[i]) && (s->works.asked == 0 || s->tried[i].asked < s->works.asked))
            s->works = s->tried[i];
    for (size_t i = 0; i < s->count; i++) {
        dem_fewest_try t = s->tried[i];
        if (!holds(t) && t.asked > s->fails.asked && (s->works.asked == 0 || t.asked < s->works.asked))
            s->fails = t;
    }
}

static bool tells(dem_fewest_try t)
{
    return t.asked > 0 && isfinite(t.worst) && t.worst > 0;
}

static void learn_power(search *s, dem_fewest_try a, dem_fewest_try b)
{
    double apart = log((double)b.asked / (double)a.asked);
    if (tells(a) && tells(b) && fabs(apart) > 0.05)
        s->power = fmin(fmax(log(a.worst / b.worst) / apart, least_power), most_power);
}

static dem_status attempt(search *s, size_t asked, dem_error *error)
{
    dem_fewest_try now = {.asked = asked, .worst = INFINITY};
    DEM_ASSERT(s->count < DEM_FEWEST_TRIES && !find(s, asked));
    DEM_TRY(s->measure(s->user, &now, error));
    if (isnan(now.worst))
        now.worst = INFINITY;
    if (s->count > 0)
        learn_power(s, s->tried[s->count - 1], now);
    if (s->best.asked == 0 || dem_fewest_better(now, s->best))
        s->best = now;
    s->tried[s->count++] = now;
    set_bracket(s);
    return DEM_OK;
}

// the number that a power law through `from` has this `worst` at
static double predict(const search *s, dem_fewest_try from, double worst)
{
    return (double)from.asked * (tells(from) ? pow(from.worst / worst, 1 / s->power) : 2);
}

static dem_fewest_try newest(const search *s)
{
    return s->tried[s->count - 1];
}

// between the best so far and its neighbours on both sides, where the farther one is; below the least: half as many
static size_t next_around(const search *s)
{
    size_t best = s->best.asked, below = 0, above = 0;
    for (size_t i = 0; i < s->count; i++) {
        size_t n = s->tried[i].asked;
        if (n < best && n > below)
            below = n;
        if (n > best && (above == 0 || n < above))
            above = n;
    }
    double down = below ? (double)best / (double)below : best > 1 ? INFINITY : 1;
    double up = above ? (double)above / (double)best : 1;
    double n = down < up ? sqrt((double)best * (double)above) : below ? sqrt((double)best * (double)below) : best / 2;
    size_t whole = (size_t)round(n);
    return whole < 1 || find(s, whole) ? 0 : whole;
}

// more spheres did not help: is there a valley, or do fewer help?
static dem_status look_around(search *s, int tries, dem_error *error)
{
    for (size_t n; tries > 0 && s->works.asked == 0 && (n = next_around(s)) > 0; tries--)
        DEM_TRY(attempt(s, n, error));
    return DEM_OK;
}

static dem_status go_out(search *s, size_t begin, size_t most, dem_error *error)
{
    DEM_TRY(attempt(s, begin, error));
    dem_fewest_try last = newest(s);
    bool looked = false;
    if (last.asked >= most && s->works.asked == 0) {
        DEM_TRY(look_around(s, 1, error));
        return s->best.asked < most ? look_around(s, AROUND_TRIES - 1, error) : DEM_OK;
    }
    for (int k = 1; s->works.asked == 0 && last.asked < most; k++) {
        double n = fmin(fmax(predict(s, last, aim), 1.3 * (double)last.asked + 1), most_growth * (double)last.asked);
        bool end = k >= OUTWARD_TRIES || n >= (double)most;
        DEM_TRY(attempt(s, end ? most : (size_t)ceil(n), error));
        bool in_vain = !(newest(s).worst < last.worst);
        last = newest(s);
        if (in_vain && !looked) {
            looked = true;
            DEM_TRY(look_around(s, AROUND_TRIES, error));
        }
    }
    return DEM_OK;
}

static bool close_enough(const search *s)
{
    double apart = (double)s->works.asked - (double)s->fails.asked;
    return apart <= fmax(1, floor(resolution * (double)s->works.asked));
}

// Between what works and what fails: where the error should meet the bound. Where the last number did not halve the
// bracket (`creeps`) and came close to the bound, a little beyond it, otherwise by bisection.
static size_t next_inward(const search *s, bool creeps)
{
    double low = (double)s->fails.asked, high = (double)s->works.asked, n;
    dem_fewest_try last = newest(s);
    bool close = tells(last) && fabs(log(last.worst)) < near_bound;
    if (creeps && close)
        n = holds(last) ? (1 - beyond) * high : (1 + beyond) * low;
    else if (s->fails.asked == 0)
        n = fmax(tells(s->works) ? predict(s, s->works, 1) : 0, high / most_growth);
    else if (creeps || !tells(s->fails) || !(s->works.worst > dropped))
        n = sqrt(low * high);
    else
        n = low * pow(high / low, log(s->fails.worst) / log(s->fails.worst / s->works.worst));
    return (size_t)fmin(fmax(round(n), low + 1), high - 1);
}

static dem_status go_in(search *s, dem_error *error)
{
    bool creeps = holds(newest(s)) && s->fails.asked == 0;
    for (int k = 0; k < INWARD_TRIES && !close_enough(s) && s->count < DEM_FEWEST_TRIES; k++) {
        double width = log((double)s->works.asked / fmax(0.5, (double)s->fails.asked));
        DEM_TRY(attempt(s, next_inward(s, creeps), error));
        creeps = log((double)s->works.asked / fmax(0.5, (double)s->fails.asked)) > width / 2;
    }
    return DEM_OK;
}

// neighbours below what failed narrowly
static dem_status look_below(search *s, dem_error *error)
{
    bool found = true;
    while (found && s->works.asked < SINGLE_SHOWS && s->works.asked - s->fails.asked == 1 &&
           s->fails.worst <= narrowly) {
        size_t top = s->fails.asked;
        found = false;
        for (size_t k = 1; k <= BELOW && k < top && !found && s->count < DEM_FEWEST_TRIES; k++) {
            if (find(s, top - k))
                continue;
            DEM_TRY(attempt(s, top - k, error));
            found = s->works.asked == top - k;
        }
        if (found)
            DEM_TRY(go_in(s, error));
    }
    return DEM_OK;
}

dem_status dem_fewest_search(size_t first, size_t most, dem_fewest_measure *measure, void *user, dem_fewest_try *best,
                             dem_error *error)
{
    search s = {.measure = measure, .user = user, .power = usual_power};
    dem_status status = go_out(&s, first < 1 ? 1 : first > most ? most : first, most, error);
    if (status == DEM_OK && s.works.asked)
        status = go_in(&s, error);
    if (status == DEM_OK && s.works.asked)
        status = look_below(&s, error);
    *best = s.best;
    return status;
}
