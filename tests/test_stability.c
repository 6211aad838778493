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

// a table of bodies with a line twice; but what stands around another one is no such case
static void two_bodies_in_one_place_are_refused(void **state)
{
    (void)state;
    for (int other = 0; other < 3; other++) {
        model *m = calloc(1, sizeof *m);
        model_begin(m);
        uint32_t first = other == 1 ? model_dumbbell(m, 0.01, 0.01) : model_sphere(m, 0.01);
        uint32_t second = other == 2 ? model_dumbbell(m, 0.01, 0.05) : first;
        model_body(m, first, v3(1, 2, 3));
        model_body(m, second, v3(1, 2, 3));
        dem_world *w;
        dem_error error;
        dem_status status = dem_world_create(NULL, &m->scene, &w, &error);
        check(status == (other == 2 ? DEM_OK : DEM_BAD_INPUT));
        if (status != DEM_OK)
            check(strstr(error.text, "bodies 0 and 1 stand in one place (1, 2, 3) m"));
        dem_world_destroy(w);
        model_end(m);
        free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_words_and_each_is_there_once),
        cmocka_unit_test(two_bodies_in_one_place_are_refused),
        cmocka_unit_test(a_limit_that_is_not_found_is_no_number),
    };
    return run_with_cases(tests, sizeof tests / sizeof *tests, dem_stability_case, true);
}
