#include "check.h"
#include "shapes.h"

#include "clump/fidelity.h"

static const dem_ctx single = {.threads = 1};

static dem_pack_options gap_below(double gap)
{
    dem_pack_options options = dem_pack_defaults();
    options.gap = gap;
    options.effort = DEM_EFFORT_FAST;
    return options;
}

static double gap_of(const dem_mesh *mesh, const dem_pack *pack)
{
    dem_error error;
    double gap;
    check_ok(dem_fidelity_gap(&single, mesh, pack->balls, pack->count, 0, &gap, NULL, &error), error);
    return gap;
}

static void the_gap_asked_for_is_met_as_measured_independently_and_one_sphere_less_would_not_do(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    dem_pack_options options = gap_below(0.08);
    dem_pack pack, fewer;
    dem_error error;
    check_ok(dem_clump_pack(&single, &grain, &options, &pack, &error), error);
    check(pack.reached && pack.count < 40);
    check(gap_of(&grain, &pack) <= 0.08);
    dem_pack_options less = options;
    less.gap = 0;
    less.spheres = pack.count - 1;
    check_ok(dem_clump_pack(&single, &grain, &less, &fewer, &error), error);
    check(gap_of(&grain, &fewer) > 0.08);
    dem_pack_free(&pack);
    dem_pack_free(&fewer);
    dem_mesh_free(&grain);
}

static void one_sphere_is_enough_for_a_sphere(void **state)
{
    (void)state;
    dem_mesh ball = shape_sphere(16);
    dem_pack_options options = gap_below(0.02);
    dem_pack pack;
    dem_error error;
    check_ok(dem_clump_pack(&single, &ball, &options, &pack, &error), error);
    check(pack.reached && pack.count == 1);
    dem_pack_free(&pack);
    dem_mesh_free(&ball);
}

static void keep_warning(void *user, dem_log_level level, const char *subject, const char *text)
{
    (void)subject;
    if (level == DEM_LOG_WARNING)
        strncpy(user, text, 199);
}

static void a_gap_out_of_reach_gives_the_best_found_with_a_warning(void **state)
{
    (void)state;
    dem_mesh box = shape_box(1, 1, 1);
    dem_pack_options options = gap_below(0.001);
    options.max_spheres = 12;
    char warning[200] = "";
    dem_ctx ctx = {.log = keep_warning, .user = warning, .threads = 1};
    dem_pack pack;
    dem_error error;
    check_ok(dem_clump_pack(&ctx, &box, &options, &pack, &error), error);
    check(!pack.reached && pack.count == 12);
    check(strstr(warning, "12 spheres") && strstr(warning, "0.1 %"));
    check_close(pack.gap_estimate, gap_of(&box, &pack), 0.1);
    dem_pack_free(&pack);
    dem_mesh_free(&box);
}

static void the_search_ends_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    dem_pack_options options = gap_below(0.25);
    dem_pack one, three;
    dem_error error;
    check_ok(dem_clump_pack(&(dem_ctx){.threads = 1}, &grain, &options, &one, &error), error);
    check_ok(dem_clump_pack(&(dem_ctx){.threads = 3}, &grain, &options, &three, &error), error);
    check(one.count == three.count);
    check(memcmp(one.balls, three.balls, one.count * sizeof *one.balls) == 0);
    dem_pack_free(&one);
    dem_pack_free(&three);
    dem_mesh_free(&grain);
}

static void all_targets_hold_together(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    dem_pack_options options = gap_below(0.3);
    dem_target targets[3];
    dem_error error;
    dem_pack pack;
    dem_fidelity f;
    check_ok(dem_target_read("hausdorff=20%", &targets[0], &error), error);
    check_ok(dem_target_read("inertia=0.1", &targets[1], &error), error);
    check_ok(dem_target_read("pieces=1", &targets[2], &error), error);
    options.targets = targets;
    options.target_count = 3;
    check_ok(dem_clump_pack(&single, &grain, &options, &pack, &error), error);
    check_ok(dem_fidelity_measure(&single, &grain, pack.balls, pack.count, 0, &f, &error), error);
    check(pack.reached && f.iou_gap <= 0.3 && f.distance_max <= 0.2 && f.inertia_error <= 1e-3 && f.pieces == 1);
    check(dem_target_ratio(targets, 3, &f) <= 1);
    dem_pack_free(&pack);
    dem_mesh_free(&grain);
}

static void an_error_that_more_spheres_make_worse_is_searched_downwards(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    dem_pack_options options = gap_below(0);
    dem_target target = {"overlap_ratio", 1.001};
    dem_pack pack;
    dem_error error;
    options.targets = &target;
    options.target_count = 1;
    options.max_spheres = 20;
    check_ok(dem_clump_pack(&single, &grain, &options, &pack, &error), error);
    check(pack.reached && pack.count == 1);
    dem_pack_free(&pack);
    dem_mesh_free(&grain);
}

static void targets_are_read_in_their_unit_or_refused_with_a_hint(void **state)
{
    (void)state;
    static const struct {
        const char *text, *measure;
        double bound;
    } good[] = {{"inertia=0.5%", "inertia_error", 0.005},
                {"hausdorff=2 %", "distance_max", 0.02},
                {"iou=3", "iou_gap", 0.03},
                {"gap=.25%", "iou_gap", 0.0025},
                {"distance_mean=1e-1%", "distance_mean", 0.001},
                {"normal=8deg", "normal_deviation_deg", 8},
                {"normal=8.5 deg", "normal_deviation_deg", 8.5},
                {"center=1%", "centre_offset", 0.01},
                {"overlap=1.5", "overlap_ratio", 1.5},
                {"pieces=1", "pieces", 1}};
    static const struct {
        const char *text, *hint;
    } bad[] = {{"inertai=1%", "did you mean inertia?"},
               {"quality=1", "use one of: gap"},
               {"inertia", "MEASURE=VALUE"},
               {"inertia=", "percentage"},
               {"inertia=-1%", "percentage"},
               {"inertia=0", "percentage"},
               {"inertia=nan%", "percentage"},
               {"inertia=200%", "percentage"},
               {"inertia=1 deg", "percentage"},
               {"inertia=1%x", "percentage"},
               {"inertia=0,5%", "percentage"},
               {"normal=8%", "angle"},
               {"overlap=150%", "ratio"},
               {"overlap=0.5", "ratio"},
               {"pieces=1.5", "whole number"},
               {"pieces=0", "whole number"},
               {"=1", "use one of"}};
    dem_target target;
    dem_error error;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        check_ok(dem_target_read(good[i].text, &target, &error), error);
        check(strcmp(target.measure, good[i].measure) == 0);
        check_close(target.bound, good[i].bound, 1e-15);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        check(dem_target_read(bad[i].text, &target, &error) == DEM_USAGE);
        if (!strstr(error.text, bad[i].hint))
            fail_msg("%s: said '%s'", bad[i].text, error.text);
    }
}

typedef struct watch {
    double stop_at, last;
    bool back, asked_again;
} watch;

static bool watch_progress(void *user, const char *what, double fraction)
{
    watch *w = user;
    check(strncmp(what, "packing", 7) == 0 && fraction >= 0 && fraction <= 1);
    w->back |= fraction < w->last;
    w->asked_again |= w->last >= w->stop_at;
    w->last = fraction;
    return fraction >= w->stop_at;
}

static void packing_tells_its_progress_and_stops_where_it_is_asked_to(void **state)
{
    (void)state;
    static const double stops[] = {0, 0.2, 0.9, 2};
    static const double gaps[] = {0, 0.3};
    dem_mesh grain = shape_grain(8);
    for (size_t g = 0; g < 2; g++)
        for (size_t k = 0; k < sizeof stops / sizeof *stops; k++) {
            dem_pack_options options = gap_below(gaps[g]);
            options.spheres = 10;
            watch w = {.stop_at = stops[k], .last = -1};
            dem_ctx ctx = {.progress = watch_progress, .user = &w, .threads = 1};
            dem_pack pack;
            dem_error error;
            dem_status status = dem_clump_pack(&ctx, &grain, &options, &pack, &error);
            // a search may end before its progress comes to the stop, and has something to show once it has packed
            bool stopped = w.last >= stops[k], shown = g == 1 && pack.balls;
            check(status == (stopped && !shown ? DEM_INTERRUPTED : DEM_OK));
            check(shown || !pack.interrupted);
            check(!(g == 1 && stops[k] == 0.9 && stopped) || (shown && pack.interrupted));
            check(!w.back && !w.asked_again);
            dem_pack_free(&pack);
        }
    dem_mesh_free(&grain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_gap_asked_for_is_met_as_measured_independently_and_one_sphere_less_would_not_do),
        cmocka_unit_test(one_sphere_is_enough_for_a_sphere),
        cmocka_unit_test(a_gap_out_of_reach_gives_the_best_found_with_a_warning),
        cmocka_unit_test(the_search_ends_the_same_for_any_number_of_threads),
        cmocka_unit_test(all_targets_hold_together),
        cmocka_unit_test(an_error_that_more_spheres_make_worse_is_searched_downwards),
        cmocka_unit_test(targets_are_read_in_their_unit_or_refused_with_a_hint),
        cmocka_unit_test(packing_tells_its_progress_and_stops_where_it_is_asked_to),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
