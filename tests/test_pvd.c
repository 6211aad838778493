#include "folder.h"

#include "out/pvd.h"

static dem_pvd opened(double resume)
{
    dem_pvd index;
    dem_error error;
    check_ok(dem_pvd_open(folder, "run.pvd", resume, &index, &error), error);
    return index;
}

static void add(dem_pvd *index, double time, const char *file, const char *other)
{
    dem_error error;
    check_ok(dem_pvd_add(index, time, file, other, &error), error);
}

static void the_index_names_every_file_with_its_time(void **state)
{
    (void)state;
    dem_pvd index = opened(NAN);
    check(!exists(in_folder("new.pvd")));
    add(&index, 0, "frames/0.vtp", NULL);
    add(&index, 0.1, "still.vtp", "moving.vtp");
    dem_pvd_release(&index);
    dem_buffer text = content(in_folder("run.pvd"));
    assert_string_equal(text.data,
                        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n"
                        "<DataSet timestep=\"0\" part=\"0\" file=\"frames/0.vtp\"/>\n"
                        "<DataSet timestep=\"0.1\" part=\"0\" file=\"still.vtp\"/>\n"
                        "<DataSet timestep=\"0.1\" part=\"1\" file=\"moving.vtp\"/>\n"
                        "</Collection>\n</VTKFile>\n");
    dem_buffer_release(&text);
}

static void it_goes_on_up_to_the_time_of_resuming(void **state)
{
    (void)state;
    const double late = nextafter(0.3, 1);  // a bit behind the time counts as behind
    dem_pvd index = opened(NAN);
    add(&index, 0.1 + 0.2, "a", NULL);
    add(&index, 0.3, "b", "c");
    add(&index, late, "d", NULL);
    dem_pvd_release(&index);
    index = opened(0.3);
    check(index.count == 1);  // 0.1 + 0.2 > 0.3
    check(index.entries[0].time == 0.3);
    assert_string_equal(index.entries[0].files[0], "b");
    assert_string_equal(index.entries[0].files[1], "c");
    dem_pvd_release(&index);
    index = opened(late);
    check(index.count == 3 && index.entries[2].time == late);
    dem_pvd_release(&index);
    index = opened(NAN);
    check(index.count == 0);
    dem_pvd_release(&index);
}

static void a_resumed_index_is_that_of_a_straight_run(void **state)
{
    (void)state;
    dem_pvd index = opened(NAN);
    for (int i = 0; i < 5; i++)
        add(&index, i * 0.01, "f", i % 2 ? "g" : NULL);
    dem_pvd_release(&index);
    dem_buffer want = content(in_folder("run.pvd"));
    index = opened(0.02);
    for (int i = 3; i < 5; i++)
        add(&index, i * 0.01, "f", i % 2 ? "g" : NULL);
    dem_pvd_release(&index);
    dem_buffer got = content(in_folder("run.pvd"));
    assert_string_equal(got.data, want.data);
    dem_buffer_release(&got);
    dem_buffer_release(&want);
}

static void a_file_of_another_kind_is_refused_and_kept(void **state)
{
    (void)state;
    dem_pvd index = opened(NAN);
    add(&index, 0.5, "a", NULL);
    dem_pvd_release(&index);
    dem_buffer good = content(in_folder("run.pvd"));
    dem_error error;
    // cut short anywhere, or with more behind it
    for (size_t size = 1; size <= good.size; size++) {
        dem_buffer bad = {0};
        dem_buffer_bytes(&bad, good.data, size < good.size ? size : good.size);
        if (size == good.size)
            dem_buffer_text(&bad, "more");
        check_ok(dem_file_write(in_folder("run.pvd"), bad.data, bad.size, &error), error);
        check(dem_pvd_open(folder, "run.pvd", 1, &index, &error) == DEM_BAD_INPUT);
        check(strstr(error.text, "; remove it") && !index.path && !index.entries);
        dem_buffer kept = content(in_folder("run.pvd"));
        check(kept.size == bad.size);
        dem_buffer_release(&kept);
        dem_buffer_release(&bad);
    }
    dem_buffer_release(&good);
    check_ok(dem_pvd_open(folder, "run.pvd", NAN, &index, &error), error);  // a new run does not look
    dem_pvd_release(&index);
    check(dem_pvd_open(in_folder("run.pvd"), "x", NAN, &index, &error) == DEM_OK);
    check(dem_pvd_add(&index, 0, "a", NULL, &error) == DEM_CANNOT_WRITE);
    dem_pvd_release(&index);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_index_names_every_file_with_its_time),
        cmocka_unit_test(it_goes_on_up_to_the_time_of_resuming),
        cmocka_unit_test(a_resumed_index_is_that_of_a_straight_run),
        cmocka_unit_test(a_file_of_another_kind_is_refused_and_kept),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
