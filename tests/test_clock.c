// Stages and their seconds.
#include "check.h"

#include <time.h>

#include "base/clock.h"

static void keep_line(void *user, dem_log_level level, const char *subject, const char *text)
{
    (void)subject;
    check(level == DEM_LOG_DEBUG);
    snprintf(user, 200, "%s", text);
}

static void stages_of_the_same_name_add_up_and_are_told_in_one_line(void **state)
{
    (void)state;
    char line[200] = "";
    dem_ctx ctx = {.log = keep_line, .user = line};
    dem_laps laps;
    double begin = dem_clock();
    dem_laps_begin(&laps);
    for (int i = 0; i < 3; i++) {
        nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
        dem_laps_end(&laps, "dozing");
        dem_laps_end(&laps, "nothing");
    }
    double all = dem_clock() - begin;
    assert_int_equal(laps.count, 2);
    check(laps.seconds[0] >= 0.006 && laps.seconds[1] >= 0 && laps.seconds[0] + laps.seconds[1] <= all);
    dem_laps_log(&laps, &ctx, "night");
    check(strncmp(line, "night: dozing 0.0", 17) == 0 && strstr(line, " s, nothing 0.0"));
    dem_laps_log(&laps, NULL, "night");
}

static void more_stages_than_there_is_room_for_are_left_out(void **state)
{
    (void)state;
    static const char *const names[DEM_LAPS + 1] = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m"};
    dem_laps laps;
    dem_laps_begin(&laps);
    for (int i = 0; i <= DEM_LAPS; i++)
        dem_laps_end(&laps, names[i]);
    assert_int_equal(laps.count, DEM_LAPS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stages_of_the_same_name_add_up_and_are_told_in_one_line),
        cmocka_unit_test(more_stages_than_there_is_room_for_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
