#include "folder.h"
#include "views.h"

#include <locale.h>
#include <signal.h>
#include <sys/resource.h>

#include "out/series.h"

static dem_series *opened(const char *directory, size_t walls, double resume)
{
    dem_series *series;
    dem_error error;
    check_ok(dem_series_open(&(dem_series_def){directory, false, VIEW_WALL_DEFS, walls, NULL, 0, false, false}, resume, &series, &error), error);
    return series;
}

// row i of a run with a row every millisecond
static dem_figures figures_at(int i)
{
    dem_random r = random_stream(7, (uint64_t)i);
    return (dem_figures){.time = i * 1e-3,
                         .step = (uint64_t)(100 * i),
                         .contacts = (size_t)random_below(&r, 1000),
                         .wall_contacts = (size_t)i,
                         .coordination = random_uniform(&r),
                         .overlap_ratio = 1e-3 * random_uniform(&r),
                         .centre = random_vector(&r),
                         .highest = 1.0 / 3,
                         .energy = {random_uniform(&r), 1, -2, 3, 4, 5, 6, 7, 8, 9, 10, NAN, 0}};
}

static dem_status write_row(dem_series *series, int i, dem_error *error)
{
    dem_figures figures = figures_at(i);
    dem_wall_view walls[VIEW_WALLS];
    view_walls(walls, figures.time);
    return dem_series_write(series, &figures, walls, NULL, error);
}

static void write_rows(dem_series *series, int first, int last)
{
    dem_error error;
    for (int i = first; i < last; i++)
        check_ok(write_row(series, i, &error), error);
}

static void columns_are_named_with_their_units(void **state)
{
    (void)state;
    dem_series_close(opened(in_folder("names"), VIEW_WALLS, NAN));
    dem_buffer text = content(in_folder("names/series.csv"));
    assert_string_equal(text.data,
                        "time_s,step,kinetic_J,rotational_J,potential_J,elastic_J,friction_J,viscous_J,broken_J,"
                        "local_J,drag_J,work_J,energy_error,contacts,wall_contacts,coordination,overlap_ratio,centre_x_m,centre_y_m,"
                        "centre_z_m,highest_m,floor_fx_N,floor_fy_N,floor_fz_N,floor_mx_Nm,floor_my_Nm,floor_mz_Nm,"
                        "drum_fx_N,drum_fy_N,drum_fz_N,drum_mx_Nm,drum_my_Nm,drum_mz_Nm,lid__moving_fx_N,"
                        "lid__moving_fy_N,lid__moving_fz_N,lid__moving_mx_Nm,lid__moving_my_Nm,lid__moving_mz_Nm,"
                        "lid__moving_x_m,lid__moving_y_m,lid__moving_z_m\n");
    dem_buffer_release(&text);
}

static void a_row_is_in_the_file_at_once_and_in_no_locale(void **state)
{
    (void)state;
    setlocale(LC_ALL, "de_DE.UTF-8");  // where the machine has it
    dem_series *series = opened(in_folder("row"), 1, NAN);
    dem_figures f = {.time = 0.001,
                     .step = UINT64_MAX,
                     .contacts = 12,
                     .wall_contacts = 3,
                     .coordination = 4.5,
                     .overlap_ratio = 0.1 + 0.2,
                     .centre = {1, -2, 1e-20},
                     .highest = INFINITY,
                     .energy = {0.5, 0.25, -1, 2, 3, 4, 4.5, 5, 6, 7, 8, -NAN, 0}};
    const dem_wall_view wall = {.force = {1, 2, 3}, .moment = {-0.25, 0, 6}};
    dem_error error;
    check_ok(dem_series_write(series, &f, &wall, NULL, &error), error);
    setlocale(LC_ALL, "C");
    dem_buffer text = content(in_folder("row/series.csv"));
    assert_string_equal(strchr(text.data, '\n') + 1,
                        "0.001,18446744073709551615,0.5,0.25,-1,2,3,4,4.5,5,6,7,nan,12,3,4.5,0.30000000000000004,1,-2,"
                        "1e-20,inf,1,2,3,-0.25,0,6\n");
    check(dem_series_rows(series) == 1);
    dem_buffer_release(&text);
    dem_series_close(series);
}

static void a_resumed_table_is_that_of_a_straight_run(void **state)
{
    (void)state;
    dem_series *series = opened(in_folder("straight"), VIEW_WALLS, NAN);
    write_rows(series, 0, 20);
    dem_series_close(series);
    for (int from = 0; from < 10; from++) {
        series = opened(in_folder("resumed"), VIEW_WALLS, NAN);
        write_rows(series, 0, 10);
        dem_series_close(series);
        series = opened(in_folder("resumed"), VIEW_WALLS, from * 1e-3);
        check((int)dem_series_rows(series) == from + 1);
        write_rows(series, from + 1, 20);
        dem_series_close(series);
        check_same_file(in_folder("straight/series.csv"), in_folder("resumed/series.csv"));
    }
    // into an empty folder: what comes after, under its head
    series = opened(in_folder("elsewhere"), VIEW_WALLS, 0.5);
    check(dem_series_rows(series) == 0);
    dem_series_close(series);
    check(exists(in_folder("elsewhere/series.csv")));
}

static void a_row_torn_by_a_crash_is_cut_off(void **state)
{
    (void)state;
    dem_error error;
    dem_series *series = opened(in_folder("torn"), VIEW_WALLS, NAN);
    write_rows(series, 0, 5);
    dem_series_close(series);
    dem_buffer whole = content(in_folder("torn/series.csv"));
    size_t head = (size_t)(strchr(whole.data, '\n') + 1 - whole.data);
    for (size_t size = head; size < whole.size; size++) {
        check_ok(dem_file_write(in_folder("torn/series.csv"), whole.data, size, &error), error);
        series = opened(in_folder("torn"), VIEW_WALLS, 1);
        int rows = (int)dem_series_rows(series);
        check(rows < 5);
        write_rows(series, rows, 5);
        dem_series_close(series);
        dem_buffer again = content(in_folder("torn/series.csv"));
        check(again.size == whole.size);
        assert_memory_equal(again.data, whole.data, whole.size);
        dem_buffer_release(&again);
    }
    dem_buffer_release(&whole);
}

static void a_full_disk_leaves_whole_rows(void **state)
{
    (void)state;
    dem_series *series = opened(in_folder("full"), VIEW_WALLS, NAN);
    write_rows(series, 0, 3);
    dem_buffer before = content(in_folder("full/series.csv"));
    struct rlimit old, small;
    check(getrlimit(RLIMIT_FSIZE, &old) == 0);
    small = (struct rlimit){before.size + 20, old.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    dem_error error = {0};
    setrlimit(RLIMIT_FSIZE, &small);  // as a full disk would: 20 bytes of the row fit
    dem_status status = write_row(series, 3, &error);
    setrlimit(RLIMIT_FSIZE, &old);
    check(status == DEM_CANNOT_WRITE && strchr(error.text, ';') && strstr(error.file, "series.csv"));
    dem_buffer after = content(in_folder("full/series.csv"));
    check(after.size == before.size);
    check(dem_series_rows(series) == 3);
    write_rows(series, 3, 4);  // and it can go on
    dem_buffer_release(&after);
    after = content(in_folder("full/series.csv"));
    check(after.size > before.size && after.data[after.size - 1] == '\n');
    dem_buffer_release(&before);
    dem_buffer_release(&after);
    dem_series_close(series);
}

static void a_table_of_another_scene_is_refused_and_kept(void **state)
{
    (void)state;
    dem_error error;
    dem_series *series = opened(in_folder("other"), VIEW_WALLS, NAN);
    write_rows(series, 0, 3);
    dem_series_close(series);
    dem_buffer before = content(in_folder("other/series.csv"));
    check(dem_series_open(&(dem_series_def){in_folder("other"), false, VIEW_WALL_DEFS, 1, NULL, 0, false, false}, 1, &series, &error) == DEM_BAD_INPUT);
    check(!series && strstr(error.text, "other columns") && strchr(error.text, ';'));
    dem_buffer after = content(in_folder("other/series.csv"));
    assert_string_equal(before.data, after.data);
    dem_buffer_release(&before);
    dem_buffer_release(&after);
    dem_series_close(opened(in_folder("other"), 1, NAN));  // a new run replaces it
    after = content(in_folder("other/series.csv"));
    check(strchr(after.data, '\n')[1] == 0);
    dem_buffer_release(&after);
    check_ok(dem_file_write(in_folder("file"), "x", 1, &error), error);
    check(dem_series_open(&(dem_series_def){.directory = in_folder("file")}, NAN, &series, &error) == DEM_CANNOT_WRITE && !series);
    dem_series_close(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_are_named_with_their_units),
        cmocka_unit_test(a_row_is_in_the_file_at_once_and_in_no_locale),
        cmocka_unit_test(a_resumed_table_is_that_of_a_straight_run),
        cmocka_unit_test(a_row_torn_by_a_crash_is_cut_off),
        cmocka_unit_test(a_full_disk_leaves_whole_rows),
        cmocka_unit_test(a_table_of_another_scene_is_refused_and_kept),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
