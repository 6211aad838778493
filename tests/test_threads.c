// Teams of threads: every part once, all together at each meeting, more threads than cores.
#include "check.h"

#include "base/threads.h"

enum { MOST = 9 };

typedef struct rounds {
    dem_team *team;
    int count[MOST], early;
    long sum;
} rounds;

static void count_up(void *user, int part)
{
    ((rounds *)user)->count[part]++;
}

static void every_part_runs_once_a_time(void **state)
{
    (void)state;
    for (int size = 1; size <= MOST; size += 2) {
        rounds r = {.team = dem_team_create(size)};
        check(r.team && dem_team_size(r.team) == size);
        for (int i = 0; i < 300; i++)
            dem_team_run(r.team, count_up, &r);
        for (int part = 0; part < MOST; part++)
            assert_int_equal(r.count[part], part < size ? 300 : 0);
        dem_team_destroy(r.team);
    }
}

// each part writes its own number, then reads those of all others: someone who goes ahead would see an old one
static void step_and_look(void *user, int part)
{
    rounds *r = user;
    for (int i = 1; i <= 100; i++) {
        r->count[part] = i;
        dem_team_meet(r->team);
        for (int other = 0; other < dem_team_size(r->team); other++)
            if (r->count[other] != i)
                r->early = 1;
        dem_team_meet(r->team);
    }
}

static void nobody_passes_a_meeting_alone(void **state)
{
    (void)state;
    for (int size = 1; size <= 5; size += 2) {
        rounds r = {.team = dem_team_create(size)};
        for (int i = 0; i < 20; i++)
            dem_team_run(r.team, step_and_look, &r);
        assert_int_equal(r.early, 0);
        dem_team_destroy(r.team);
    }
}

static void what_parts_wrote_is_seen_behind_a_run(void **state)
{
    (void)state;
    rounds r = {.team = dem_team_create(4)};
    for (int i = 0; i < 500; i++) {
        dem_team_run(r.team, count_up, &r);
        for (int part = 0; part < 4; part++)
            r.sum += r.count[part];
    }
    assert_int_equal(r.sum, 4 * 500 * 501 / 2);
    dem_team_destroy(r.team);
}

static void a_team_may_go_home_without_work(void **state)
{
    (void)state;
    for (int i = 0; i < 20; i++)
        dem_team_destroy(dem_team_create(3));
    dem_team_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_part_runs_once_a_time),
        cmocka_unit_test(nobody_passes_a_meeting_alone),
        cmocka_unit_test(what_parts_wrote_is_seen_behind_a_run),
        cmocka_unit_test(a_team_may_go_home_without_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
