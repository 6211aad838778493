/// Studies that are a table of cases, each as a test of its own.
#ifndef DEM_TESTS_CASES_H
#define DEM_TESTS_CASES_H

#include "check.h"

#include "study/trial.h"

enum { CASES = 200 };

static inline void a_case(void **state)
{
    const dem_case *c = *state;
    dem_trial t;
    dem_trial_run(NULL, c, &t);
    const char *bounds[] = {"", "at most ", "at least "};
    for (size_t i = 0; i < t.count; i++) {
        const dem_finding *f = &t.findings[i];
        if (!f->passed)
            print_error("%s: %s = %.12g %s, want %s%.12g within %g\n", c->name, f->what, f->got, f->unit,
                        bounds[f->bound], f->expected, f->tolerance);
    }
    check_ok(t.status, t.error);
    bool passed = dem_trial_passed(&t), skipped = t.skipped != NULL;
    dem_trial_release(&t);
    check(passed);
    if (skipped)
        skip();
}

static inline void check_names(const dem_case *(*at)(size_t index))
{
    const dem_case *c, *other;
    for (size_t i = 0; (c = at(i)); i++) {
        check(c->about && *c->about && c->source && *c->source && c->run);
        check(strspn(c->name, "abcdefghijklmnopqrstuvwxyz0123456789-") == strlen(c->name));
        for (size_t k = 0; k < i && (other = at(k)); k++)
            check(strcmp(c->name, other->name) != 0);
    }
}

/// The tests, and then every case; without those that are slow where `quick`.
static inline int run_with_cases(const struct CMUnitTest *tests, size_t count, const dem_case *(*at)(size_t index),
                                 bool quick)
{
    struct CMUnitTest all[CASES];
    memcpy(all, tests, count * sizeof *tests);
    const dem_case *c;
    for (size_t i = 0; count < CASES && (c = at(i)); i++)
        if (!quick || !c->slow)
            all[count++] = (struct CMUnitTest){c->name, a_case, NULL, NULL, (void *)c};
    return _cmocka_run_group_tests("cases", all, count, NULL, NULL);
}

#endif
