// The search for the fewest spheres, on errors made up as functions of the number.
#include "check.h"

#include "base/random.h"
#include "clump/fewest.h"

typedef struct made_up {
    double (*error)(const struct made_up *self, double count);
    double bound, noise;
    double share;  // of the number asked for that a clump gets
    int tries, stop_at;
    bool seen[100001];
} made_up;

static made_up field;

static double falls(const made_up *self, double n)
{
    (void)self;
    return pow(n, -0.8);
}
static double falls_with_noise(const made_up *self, double n)
{
    dem_random r = random_stream(17, (uint64_t)n);
    return pow(n, -0.8) * (1 + self->noise * (random_uniform(&r) - 0.5));
}
static double rises(const made_up *self, double n)
{
    (void)self;
    return 0.01 * n;
}
static double stays(const made_up *self, double n)
{
    (void)self, (void)n;
    return 1;
}
// fine at once, but not with fewer than twelve
static double steps(const made_up *self, double n)
{
    (void)self;
    return n < 12 ? 0.2 : 1e-12;
}
static double is_best_between(const made_up *self, double n)
{
    (void)self;
    return fabs(log(n / 40)) + 0.05;
}
static double cannot_be_made_of_odd_numbers(const made_up *self, double n)
{
    (void)self;
    return fmod(n, 2) > 0 ? NAN : pow(n, -0.8);
}

static dem_status measure(void *user, dem_fewest_try *now, dem_error *error)
{
    made_up *m = user;
    if (m->stop_at && m->tries >= m->stop_at)
        return dem_fail(error, DEM_INTERRUPTED, "stopped");
    check(now->asked >= 1 && now->asked <= 100000 && !m->seen[now->asked]);
    m->seen[now->asked] = true;
    m->tries++;
    now->got = (size_t)ceil((double)now->asked * m->share);
    now->worst = m->error(m, (double)now->asked) / m->bound;
    return DEM_OK;
}

static dem_fewest_try search_of(double (*error_of)(const made_up *, double), double bound, size_t first, size_t most)
{
    dem_fewest_try best;
    dem_error error;
    double noise = field.noise;
    field = (made_up){.error = error_of, .bound = bound, .noise = noise, .share = 1};
    check_ok(dem_fewest_search(first, most, measure, &field, &best, &error), error);
    check(field.tries <= DEM_FEWEST_TRIES);
    return best;
}

static void a_falling_error_gives_the_very_number_or_one_within_its_resolution(void **state)
{
    (void)state;
    for (size_t first = 1; first <= 64; first *= 4)
        for (double wanted = 1; wanted < 50000; wanted = ceil(wanted * 1.7)) {
            // the bound between the numbers `wanted` - 1 and `wanted`
            dem_fewest_try best = search_of(falls, pow(wanted - 0.5, -0.8), first, 100000);
            check(best.worst <= 1);
            check((double)best.asked >= wanted && (double)best.asked <= fmax(wanted, wanted * 1.016));
            check(field.tries <= 16);
        }
}

static void noise_costs_a_few_percent_at_most_and_neighbours_below_are_looked_at(void **state)
{
    (void)state;
    field.noise = 0.04;
    int beaten = 0;
    for (double wanted = 5; wanted < 5000; wanted = ceil(wanted * 1.3)) {
        dem_fewest_try best = search_of(falls_with_noise, pow(wanted, -0.8), 16, 100000);
        check(best.worst <= 1 && (double)best.asked < 1.06 * wanted + 1);
        beaten += (double)best.asked < wanted;
    }
    check(beaten > 0);  // lucky ones are taken
    field.noise = 0;
}

static void what_more_spheres_make_worse_is_found_below(void **state)
{
    (void)state;
    dem_fewest_try best = search_of(rises, 0.035, 16, 2000);
    check(best.worst <= 1 && best.asked == 1);  // 0.01 to begin with
    best = search_of(rises, 0.005, 16, 2000);
    check(best.worst > 1 && best.asked == 1);
    best = search_of(is_best_between, 0.3, 8, 2000);
    check(best.worst <= 1 && best.asked >= 32 && best.asked <= 35);
    best = search_of(is_best_between, 0.3, 64, 2000);
    check(best.worst <= 1 && best.asked >= 32 && best.asked <= 35);
}

static void a_step_is_found(void **state)
{
    (void)state;
    for (size_t first = 1; first < 64; first += 9)
        check(search_of(steps, 0.1, first, 2000).asked == 12);
}

static void out_of_reach_ends_with_the_one_that_comes_nearest(void **state)
{
    (void)state;
    dem_fewest_try best = search_of(falls, 1e-9, 16, 2000);
    check(best.worst > 1 && best.asked == 2000);
    best = search_of(falls, 1e-9, 64, 1);
    check(best.worst > 1 && best.asked == 1 && field.tries == 1);
    best = search_of(stays, 0.5, 16, 100000);
    check_near(best.worst, 2, 0);
    best = search_of(is_best_between, 0.01, 16, 2000);
    check(best.worst > 1 && best.worst < 100);
}

static void numbers_that_cannot_be_made_are_passed_over(void **state)
{
    (void)state;
    dem_fewest_try best = search_of(cannot_be_made_of_odd_numbers, pow(99.5, -0.8), 16, 2000);
    check(best.worst <= 1 && best.asked % 2 == 0 && best.asked >= 100 && best.asked <= 104);
}

static void stopped_it_has_the_best_so_far(void **state)
{
    (void)state;
    dem_fewest_try best;
    dem_error error;
    for (int stop = 1; stop < 5; stop++) {
        field = (made_up){.error = falls, .bound = 0.01, .share = 1, .stop_at = stop};
        check(dem_fewest_search(8, 2000, measure, &field, &best, &error) == DEM_INTERRUPTED);
        check(best.asked > 0 && field.tries == stop);
    }
    field = (made_up){.error = falls, .bound = 0.01, .share = 1, .stop_at = -1};
    check(dem_fewest_search(8, 2000, measure, &field, &best, &error) == DEM_INTERRUPTED && best.asked == 0);
}

static void of_those_that_hold_the_fewest_spheres_count_not_the_number_asked_for(void **state)
{
    (void)state;
    check(dem_fewest_better((dem_fewest_try){20, 9, 0.9}, (dem_fewest_try){10, 10, 0.2}));
    check(dem_fewest_better((dem_fewest_try){20, 10, 0.1}, (dem_fewest_try){10, 10, 0.2}));
    check(dem_fewest_better((dem_fewest_try){20, 30, 1}, (dem_fewest_try){10, 10, 1.01}));
    check(dem_fewest_better((dem_fewest_try){20, 30, 1.2}, (dem_fewest_try){10, 10, 1.3}));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_falling_error_gives_the_very_number_or_one_within_its_resolution),
        cmocka_unit_test(noise_costs_a_few_percent_at_most_and_neighbours_below_are_looked_at),
        cmocka_unit_test(what_more_spheres_make_worse_is_found_below),
        cmocka_unit_test(a_step_is_found),
        cmocka_unit_test(out_of_reach_ends_with_the_one_that_comes_nearest),
        cmocka_unit_test(numbers_that_cannot_be_made_are_passed_over),
        cmocka_unit_test(stopped_it_has_the_best_so_far),
        cmocka_unit_test(of_those_that_hold_the_fewest_spheres_count_not_the_number_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
