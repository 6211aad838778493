// The cases of `dem-study stability` that are not slow, as tests.
#include "cases.h"

#include "study/stability.h"

static void names_are_words_and_each_is_there_once(void **state)
{
    (void)state;
    check_names(dem_stability_case);
}

// a case may be said to be in bounds by mistake; the limit itself is looked for where there is none
static void make_nothing(dem_trial *t, const void *user)
{
    (void)user;
    model_body(t->model, model_sphere(t->model, 0.01), v3(0, 0, 0));
}
static void no_limit(dem_trial *t)
{
    dem_limit l = dem_limit_find(t, &(dem_limit_def){make_nothing, NULL, 1e-6, 0.01, 100, NULL});
    check(!(l.predicted < INFINITY) && isnan(l.measured));
    dem_expect_least(t, l.measured, 0, "s", "none");
}
static void a_limit_that_is_not_found_is_no_number(void **state)
{
    (void)state;
    dem_trial t;
    dem_trial_run(NULL, &(dem_case){.name = "none", .run = no_limit}, &t);
    check(t.status == DEM_OK && !dem_trial_passed(&t));
    dem_trial_release(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_words_and_each_is_there_once),
        cmocka_unit_test(a_limit_that_is_not_found_is_no_number),
    };
    return run_with_cases(tests, sizeof tests / sizeof *tests, dem_stability_case, true);
}
