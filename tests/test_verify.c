// Every case of `dem-study verify`, as a test of its own.
#include "cases.h"

#include "study/verify.h"

static void cases_are_found_by_name_and_by_what_their_names_begin_with(void **state)
{
    (void)state;
    dem_case c = {.name = "chung-ooi-1"}, other = {.name = "chung-ooi-10"};
    check(dem_case_meant(&c, "chung-ooi-1") && !dem_case_meant(&other, "chung-ooi-1"));
    check(dem_case_meant(&c, "chung") && dem_case_meant(&c, "chung-ooi") && !dem_case_meant(&c, "chu"));
    check(dem_case_meant(&other, "chung-ooi-1*") && dem_case_meant(&c, "*") && !dem_case_meant(&c, "chung-ooi-"));
}

static void names_are_words_and_each_is_there_once(void **state)
{
    (void)state;
    check_names(dem_verify_case);
}

// what a case whose world cannot be made, or fails, comes to
static void broken(dem_trial *t)
{
    model *m = dem_trial_model(t);
    model_body(m, model_clump(m, (dem_ball[]){{{0, 0, 0}, 1}}, 1, -1, (double[]){1, 1, 1}), v3(0, 0, 0));
    dem_trial_start(t);
    check(!dem_trial_step(t, 10));
    check(isnan(dem_trial_body(t, 0).velocity.x) && isnan(dem_trial_time(t)));
    check(dem_trial_figures(t)->contacts == 0);
    dem_expect(t, 1, 1, 0, "", "nothing");
}
static void wrong(dem_trial *t)
{
    dem_expect(t, 1, 1, 0, "", "right");
    dem_expect(t, NAN, 1, INFINITY, "", "no number");
    dem_expect_most(t, NAN, 1, "", "no number");
    dem_expect_least(t, NAN, 1, "", "no number");
    dem_expect_most(t, 1, 1, "", "right");
}
static void empty(dem_trial *t)
{
    (void)t;
}

static void a_case_that_breaks_or_finds_something_else_has_not_passed(void **state)
{
    (void)state;
    void (*const bad[])(dem_trial *) = {broken, wrong, empty};
    for (int i = 0; i < 3; i++) {
        dem_trial t;
        dem_trial_run(NULL, &(dem_case){.name = "bad", .run = bad[i]}, &t);
        check(!dem_trial_passed(&t));
        check((t.status != DEM_OK) == (i == 0) && t.count == (size_t)(i == 1 ? 5 : 0));
        for (size_t k = 0; k < t.count; k++)
            check(t.findings[k].passed == (k == 0 || k == 4));
        dem_trial_release(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cases_are_found_by_name_and_by_what_their_names_begin_with),
        cmocka_unit_test(names_are_words_and_each_is_there_once),
        cmocka_unit_test(a_case_that_breaks_or_finds_something_else_has_not_passed),
    };
    return run_with_cases(tests, sizeof tests / sizeof *tests, dem_verify_case, SLOW_BUILD);
}
