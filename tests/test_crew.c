// Crews of threads: every part once, results seen behind, helpers asleep or busy, more threads than cores.
#include "check.h"

#include <time.h>

#include "base/crew.h"

enum { PARTS = 23 };

typedef struct lots {
    int count[PARTS];
    long sum;
} lots;

static void count_up(void *user, int part)
{
    ((lots *)user)->count[part]++;
}

static void every_part_is_done_once_and_seen_behind_each_lot(void **state)
{
    (void)state;
    for (int size = 1; size <= 7; size += 2) {
        lots l = {{0}, 0};
        dem_crew *crew = dem_crew_create(size);
        for (int i = 1; i <= 2000; i++) {
            int parts = 1 + i % PARTS;
            dem_crew_run(crew, parts, count_up, &l);
            for (int k = 0; k < parts; k++)
                l.sum += l.count[k];
        }
        // alone, the same
        lots want = {{0}, 0};
        for (int i = 1; i <= 2000; i++) {
            int parts = 1 + i % PARTS;
            dem_crew_run(NULL, parts, count_up, &want);
            for (int k = 0; k < parts; k++)
                want.sum += want.count[k];
        }
        check(memcmp(&l, &want, sizeof l) == 0);
        dem_crew_destroy(crew);
    }
}

static void doze(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
}

static void helpers_that_went_to_sleep_are_woken_and_may_go_home(void **state)
{
    (void)state;
    lots l = {{0}, 0};
    dem_crew *crew = dem_crew_create(3);
    for (int i = 0; i < 10; i++) {
        doze();
        dem_crew_run(crew, PARTS, count_up, &l);
    }
    doze();
    for (int k = 0; k < PARTS; k++)
        assert_int_equal(l.count[k], 10);
    dem_crew_destroy(crew);
    for (int i = 0; i < 20; i++)
        dem_crew_destroy(dem_crew_create(3));
    dem_crew_run(NULL, 0, count_up, &l);
}

// each lot uses what the last one left: nobody may still be at an old one
static void lots_follow_one_another(void **state)
{
    (void)state;
    dem_crew *crew = dem_crew_create(4);
    for (int i = 0; i < 1000; i++) {
        lots l = {{0}, 0};
        dem_crew_run(crew, PARTS, count_up, &l);
        for (int k = 0; k < PARTS; k++)
            assert_int_equal(l.count[k], 1);
    }
    dem_crew_destroy(crew);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_part_is_done_once_and_seen_behind_each_lot),
        cmocka_unit_test(helpers_that_went_to_sleep_are_woken_and_may_go_home),
        cmocka_unit_test(lots_follow_one_another),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
