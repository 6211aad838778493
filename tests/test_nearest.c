#include "check.h"

#include "base/nearest.h"

static const char *const names[] = {"stiffness", "stiffness_from", "restitution", "law", "x", NULL};

static const char *name(const void *user, size_t index)
{
    (void)user;
    return names[index];
}

static void a_mistyped_name_is_recognised(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"stifness", "stiffness"},      {"stiffnes", "stiffness"}, {"stiffness_fron", "stiffness_from"},
        {"restitutoin", "restitution"}, {"rest", "restitution"},   {"lwa", "law"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_string_equal(dem_nearest(cases[i][0], name, NULL), cases[i][1]);
}

static void what_is_far_from_every_name_is_not(void **state)
{
    (void)state;
    char endless[400];
    memset(endless, 'q', sizeof endless);
    endless[sizeof endless - 1] = 0;
    check(!dem_nearest("gravity", name, NULL));
    check(!dem_nearest("", name, NULL));
    check(!dem_nearest("z", name, NULL));
    check(!dem_nearest(endless, name, NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mistyped_name_is_recognised),
        cmocka_unit_test(what_is_far_from_every_name_is_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
