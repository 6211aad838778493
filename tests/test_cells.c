#include "folder.h"

#include <math.h>
#include <stdatomic.h>

#include "base/status.h"
#include "study/cells.h"

enum { CELLS = 12 };

typedef struct sums {
    int power;
    atomic_int ran, stop_after;
    int fails;  // this cell; -1: none
    int threads[CELLS];
} sums;

static void describe(void *user, size_t cell, dem_buffer *inputs)
{
    dem_buffer_print(inputs, "cell %zu, power %d", cell, ((sums *)user)->power);
}

static dem_status run(void *user, size_t cell, const dem_ctx *ctx, dem_json_writer *found, dem_error *error)
{
    sums *s = user;
    if (dem_progress(ctx, "adding", 0.5))
        return dem_fail(error, DEM_INTERRUPTED, "interrupted");
    s->threads[cell] = ctx->threads;
    s->ran++;
    if ((int)cell == s->fails)
        return dem_fail(error, DEM_FAILED, "cell %zu cannot be", cell);
    double third = pow((double)cell, s->power) / 3, list[3] = {third, NAN, -third};
    dem_json_put_number(found, "third", third);
    dem_json_put_number(found, "none", INFINITY);
    dem_json_put_numbers(found, "list", list, 3);
    return DEM_OK;
}

static bool enough(void *user, const char *what, double fraction)
{
    sums *s = user;
    (void)what;
    (void)fraction;
    return s->ran >= s->stop_after;
}

static dem_cells_def def_of(sums *s, const char *directory)
{
    return (dem_cells_def){
        .directory = directory, .count = CELLS, .only = DEM_ALL_CELLS, .user = s, .describe = describe, .run = run};
}

static void check_results(dem_cell_result *results, bool kept)
{
    for (size_t i = 0; i < CELLS; i++) {
        double third = (double)i * (double)i / 3, list[4];
        check(results[i].status == DEM_OK && results[i].kept == kept);
        check(dem_cell_number(&results[i], "third") == third);
        check(isnan(dem_cell_number(&results[i], "none")) && isnan(dem_cell_number(&results[i], "missing")));
        check(dem_cell_numbers(&results[i], "list", list, 4) == 3);
        check(list[0] == third && isnan(list[1]) && list[2] == -third);
        check(dem_cell_numbers(&results[i], "list", list, 2) == 2);
    }
    dem_cells_release(results, CELLS);
}

static void cells_that_have_a_result_are_not_run_again(void **state)
{
    (void)state;
    sums s = {.power = 2, .fails = -1};
    dem_cells_def def = def_of(&s, in_folder("kept"));
    dem_cell_result results[CELLS];
    dem_error error;
    dem_ctx two = {.threads = 2};
    check_ok(dem_cells_run(&two, &def, results, &error), error);
    check(s.ran == CELLS && s.threads[3] == 1);
    check_results(results, false);
    check_ok(dem_cells_run(&two, &def, results, &error), error);
    check(s.ran == CELLS);
    check_results(results, true);
}

static void other_inputs_and_broken_files_are_run_again(void **state)
{
    (void)state;
    sums s = {.power = 3, .fails = -1};
    char *directory = in_folder("other");
    dem_cells_def def = def_of(&s, directory);
    dem_cell_result results[CELLS];
    dem_error error;
    check_ok(dem_cells_run(NULL, &def, results, &error), error);
    dem_cells_release(results, CELLS);
    s.power = 2;
    check_ok(dem_cells_run(NULL, &def, results, &error), error);
    check(s.ran == 2 * CELLS);
    check_results(results, false);
    check_ok(dem_file_write(in_folder("other/cells/0005.json"), "{\"schema\":", 10, &error), error);
    check_ok(dem_cells_run(NULL, &def, results, &error), error);
    check(s.ran == 2 * CELLS + 1 && !results[5].kept && results[4].kept);
    dem_cells_release(results, CELLS);
}

static void an_interrupted_study_goes_on_where_it_stopped(void **state)
{
    (void)state;
    sums s = {.power = 2, .fails = -1, .stop_after = 5};
    dem_cells_def def = def_of(&s, in_folder("interrupted"));
    dem_cell_result results[CELLS];
    dem_error error;
    dem_ctx ctx = {.threads = 2, .progress = enough, .user = &s};
    check(dem_cells_run(&ctx, &def, results, &error) == DEM_INTERRUPTED);
    int ran = s.ran;
    check(ran >= 5 && ran < CELLS);
    dem_cells_release(results, CELLS);
    s.stop_after = 1000;
    check_ok(dem_cells_run(&ctx, &def, results, &error), error);
    check(s.ran == CELLS);
    dem_cells_release(results, CELLS);
}

static void one_cell_can_be_run_by_its_number_with_all_threads(void **state)
{
    (void)state;
    sums s = {.power = 2, .fails = -1};
    dem_cells_def def = def_of(&s, in_folder("one"));
    dem_cell_result results[CELLS];
    dem_error error;
    dem_ctx two = {.threads = 2};
    def.only = 7;
    check_ok(dem_cells_run(&two, &def, results, &error), error);
    check(s.ran == 1 && s.threads[7] == 2);
    check(results[7].status == DEM_OK && results[6].status == DEM_INTERRUPTED && !results[6].found);
    dem_cells_release(results, CELLS);
    def.only = DEM_ALL_CELLS;
    check_ok(dem_cells_run(&two, &def, results, &error), error);
    check(s.ran == CELLS && results[7].kept && !results[6].kept);
    dem_cells_release(results, CELLS);
}

static void a_cell_that_fails_is_told_and_tried_again(void **state)
{
    (void)state;
    sums s = {.power = 2, .fails = 4};
    dem_cells_def def = def_of(&s, in_folder("failing"));
    dem_cell_result results[CELLS];
    dem_error error;
    check_ok(dem_cells_run(NULL, &def, results, &error), error);
    check(results[4].status == DEM_FAILED && strcmp(results[4].error.text, "cell 4 cannot be") == 0);
    check(isnan(dem_cell_number(&results[4], "third")) && results[5].status == DEM_OK);
    dem_cells_release(results, CELLS);
    s.fails = -1;
    check_ok(dem_cells_run(NULL, &def, results, &error), error);
    check(s.ran == CELLS + 1);
    dem_cells_release(results, CELLS);
    def.directory = in_folder("failing/cells/0001.json");
    check(dem_cells_run(NULL, &def, results, &error) == DEM_CANNOT_WRITE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_that_have_a_result_are_not_run_again),
        cmocka_unit_test(other_inputs_and_broken_files_are_run_again),
        cmocka_unit_test(an_interrupted_study_goes_on_where_it_stopped),
        cmocka_unit_test(one_cell_can_be_run_by_its_number_with_all_threads),
        cmocka_unit_test(a_cell_that_fails_is_told_and_tried_again),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
