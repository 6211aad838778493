// The fuzz target of the repair on random bytes: a few hundred meshes with every test run.
#include "check.h"

#include "fuzz/fuzz_repair.c"

static void random_meshes_come_out_closed_or_are_refused(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 300; seed++) {
        dem_random r = random_stream(seed, 0);
        uint8_t data[100];
        size_t size = 10 + random_below(&r, sizeof data - 10);
        for (size_t i = 0; i < size; i++)
            data[i] = (uint8_t)random_below(&r, 256);
        LLVMFuzzerTestOneInput(data, size);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_meshes_come_out_closed_or_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
