#include "check.h"
#include "shapes.h"

#include "clump/measures.h"
#include "clump/sweep.h"

static const dem_ctx single = {.threads = 1};

static void numbers_of_spheres_are_sorted_and_taken_once(void **state)
{
    (void)state;
    dem_sweep s = {0};
    dem_error error;
    check_ok(dem_sweep_read_counts(&s, "50, 5,20 ,5,100000", &error), error);
    check(s.count_count == 4 && s.counts[0] == 5 && s.counts[1] == 20 && s.counts[2] == 50 && s.counts[3] == 100000);
    static const char *const bad[] = {"", ",", "5,", "5,,6", "5 6", "0", "-3", "5.5", "100001", "ten", "5;6", "1e3"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        check(dem_sweep_read_counts(&s, bad[i], &error) == DEM_USAGE && strstr(error.text, "10,20,50"));
    char many[400] = "1";
    for (int i = 2; i <= DEM_SWEEP_COUNTS + 1; i++)
        snprintf(many + strlen(many), sizeof many - strlen(many), ",%d", i);
    check(dem_sweep_read_counts(&s, many, &error) == DEM_USAGE);
}

static void methods_have_efforts_and_wrong_ones_a_hint(void **state)
{
    (void)state;
    dem_sweep s = {0};
    dem_error error;
    size_t count;
    dem_packers(&count);
    check_ok(dem_sweep_read_series(&s, "optimal:fast,optimal,optimal:best,optimal:default", DEM_EFFORT_DEFAULT, &error),
             error);
    check(s.series_count == 3 && s.series[0].effort == DEM_EFFORT_FAST && s.series[1].effort == DEM_EFFORT_DEFAULT &&
          s.series[2].effort == DEM_EFFORT_BEST && strcmp(s.series[0].name, "optimal:fast") == 0);
    check_ok(dem_sweep_read_series(&s, "all,optimal", DEM_EFFORT_FAST, &error), error);
    check(s.series_count == count && s.series[0].packer == &dem_packer_optimal);
    static const char *const bad[][2] = {{"optmal", "did you mean optimal?"},
                                         {"optimal:quick", "optimal:fast"},
                                         {"zzzzzzz", "--methods"},
                                         {"", "as in"},
                                         {"optimal,", "as in"},
                                         {"optimal:", "no effort"},
                                         {"a_name_that_is_longer_than_any_method_there_ever_was", "as in"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        check(dem_sweep_read_series(&s, bad[i][0], DEM_EFFORT_FAST, &error) == DEM_USAGE);
        if (!strstr(error.text, bad[i][1]))
            fail_msg("%s: said '%s'", bad[i][0], error.text);
    }
}

static dem_sweep sweep_of(const char *methods, const char *counts)
{
    dem_sweep s = {0};
    dem_error error;
    check_ok(dem_sweep_read_series(&s, methods, DEM_EFFORT_FAST, &error), error);
    check_ok(dem_sweep_read_counts(&s, counts, &error), error);
    return s;
}

static void every_cell_is_the_packing_it_stands_for_measured(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    dem_sweep s = sweep_of("optimal,bubble", "4,9");
    dem_pack_options options = dem_pack_defaults();
    dem_error error;
    check_ok(dem_sweep_run(&single, &grain, &options, &s, &error), error);
    double volume = dem_mesh_solid(&grain).volume;
    for (size_t i = 0; i < 2; i++)
        for (size_t k = 0; k < 2; k++) {
            const dem_sweep_cell *c = dem_sweep_at(&s, i, k);
            check(c->ran && c->status == DEM_OK && c->pack.count <= s.counts[k] && c->seconds > 0);
            check_near(c->whole.solid.volume / volume - 1, c->fidelity.volume_error, 1e-12);
            check(fmax(fabs(c->inertia_errors[0]), fmax(fabs(c->inertia_errors[1]), fabs(c->inertia_errors[2]))) <=
                  c->fidelity.inertia_error * 1.000001 + 1e-12);
        }
    // the very balls of a packing of its own
    dem_pack pack;
    options.effort = DEM_EFFORT_FAST;
    options.spheres = 9;
    check_ok(dem_clump_pack(&single, &grain, &options, &pack, &error), error);
    const dem_sweep_cell *c = dem_sweep_at(&s, 0, 1);
    check(pack.count == c->pack.count && memcmp(pack.balls, c->pack.balls, pack.count * sizeof *pack.balls) == 0);
    check(dem_sweep_at(&s, 0, 1)->fidelity.iou_gap < dem_sweep_at(&s, 0, 0)->fidelity.iou_gap);
    dem_pack_free(&pack);
    dem_sweep_release(&s);
    dem_mesh_free(&grain);
}

static void a_method_that_cannot_leaves_its_reason_and_the_others_go_on(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    dem_sweep s = sweep_of("favier,optimal", "5");
    dem_pack_options options = dem_pack_defaults();
    dem_error error;
    options.side = DEM_SIDE_OUTER;
    check_ok(dem_sweep_run(&single, &grain, &options, &s, &error), error);
    check(s.cells[0].ran && s.cells[0].status != DEM_OK && strstr(s.cells[0].message, "favier"));
    check(s.cells[1].ran && s.cells[1].status == DEM_OK && s.cells[1].pack.count <= 5);
    dem_sweep_release(&s);
    dem_mesh_free(&grain);
}

typedef struct watch {
    double last, stop_at;
    bool back;
} watch;

static bool watch_progress(void *user, const char *what, double fraction)
{
    watch *w = user;
    check(strncmp(what, "sweep, ", 7) == 0);
    w->back |= fraction < w->last;
    w->last = fraction;
    return fraction >= w->stop_at;
}

static void progress_never_goes_back_and_what_ran_before_a_stop_is_there(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    for (int k = 0; k < 3; k++) {
        dem_sweep s = sweep_of("bubble,ferellec", "3,6,12");
        dem_pack_options options = dem_pack_defaults();
        dem_error error;
        watch w = {.last = -1, .stop_at = (const double[]){0, 0.6, 2}[k]};
        dem_ctx ctx = {.progress = watch_progress, .user = &w, .threads = 1};
        dem_status status = dem_sweep_run(&ctx, &grain, &options, &s, &error);
        check(status == (k < 2 ? DEM_INTERRUPTED : DEM_OK) && !w.back);
        size_t ran = 0;
        for (size_t i = 0; i < 6; i++) {
            ran += s.cells[i].ran;
            check(s.cells[i].ran == (s.cells[i].pack.balls != NULL));
        }
        check(k == 0 ? ran == 0 : k == 1 ? ran > 1 && ran < 6 : ran == 6);
        dem_sweep_release(&s);
    }
    dem_mesh_free(&grain);
}

static void measures_are_found_by_all_their_names_and_shown_in_their_unit(void **state)
{
    (void)state;
    dem_fidelity f = {0.01, -0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 8, 1.5, 2};
    static const struct {
        const char *name;
        double value, shown;
    } cases[] = {{"gap", 0.01, 1},           {"iou", 0.01, 1},       {"iou_gap", 0.01, 1},    {"volume", 0.02, 2},
                 {"distance_mean", 0.03, 3}, {"hausdorff", 0.04, 4}, {"protrusion", 0.05, 5}, {"center", 0.06, 6},
                 {"inertia_error", 0.07, 7}, {"normal", 8, 8},       {"overlap", 1.5, 1.5},   {"pieces", 2, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const dem_measure *m = dem_measure_find(cases[i].name);
        check(m != NULL);
        check_near(dem_measure_of(m, &f), cases[i].value, 0);
        check_near(dem_measure_shown(m, dem_measure_of(m, &f)), cases[i].shown, 1e-15);
    }
    check(!dem_measure_find("gaps") && !dem_measure_find("") && !dem_measure_find("ga"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_of_spheres_are_sorted_and_taken_once),
        cmocka_unit_test(methods_have_efforts_and_wrong_ones_a_hint),
        cmocka_unit_test(every_cell_is_the_packing_it_stands_for_measured),
        cmocka_unit_test(a_method_that_cannot_leaves_its_reason_and_the_others_go_on),
        cmocka_unit_test(progress_never_goes_back_and_what_ran_before_a_stop_is_there),
        cmocka_unit_test(measures_are_found_by_all_their_names_and_shown_in_their_unit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
