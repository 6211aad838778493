#include "check.h"

#include "base/digits.h"
#include "base/random.h"

// true where it was printed; then as printf prints it
static bool agrees(double value, int digits)
{
    char got[DEM_DIGITS_TEXT] = "unchanged", want[64];
    if (!dem_digits_print(got, sizeof got, value, digits)) {
        assert_string_equal(got, "unchanged");
        return false;
    }
    snprintf(want, sizeof want, "%.*g", digits, value);
    assert_string_equal(got, want);
    return true;
}

static void numbers_of_ordinary_size_are_printed_as_printf_does(void **state)
{
    (void)state;
    dem_random r = random_stream(1, 1);
    for (int i = 0; i < 300000; i++) {
        double value = (random_uniform(&r) + 0x1p-60) * pow(10, 1 + (i % 22)) * 1e-12;
        check(agrees(i % 3 ? value : -value, 17));
        agrees(value, 1 + i % 17);
    }
}

static void any_bits_are_printed_as_printf_does_or_left_alone(void **state)
{
    (void)state;
    dem_random r = random_stream(2, 1);
    for (int i = 0; i < 300000; i++) {
        uint64_t bits = random_bits(&r);
        double value;
        memcpy(&value, &bits, sizeof value);
        agrees(value, 1 + i % 17);
        // exponents about those that are in reach
        bits = (bits & ~(2047ull << 52)) | ((1023 - 90 + random_below(&r, 160)) << 52);
        memcpy(&value, &bits, sizeof value);
        agrees(value, 1 + i % 17);
    }
}

static void ties_and_powers_of_ten_are_exact(void **state)
{
    (void)state;
    // 0.5, 2.5, 0.125, ...: exactly between two of fewer digits
    for (int i = 1; i < 4096; i++)
        for (int shift = 0; shift < 40; shift++)
            for (int digits = 1; digits <= 4; digits++)
                agrees(ldexp(i, -shift), digits);
    for (int power = -30; power < 25; power++) {
        double ten = strtod(
            (char[]){'1', 'e', power < 0 ? '-' : '+', (char)('0' + abs(power) / 10), (char)('0' + abs(power) % 10), 0},
            NULL);
        for (int digits = 1; digits <= 17; digits++) {
            agrees(ten, digits);
            agrees(nextafter(ten, 0), digits);
            agrees(nextafter(ten, INFINITY), digits);
        }
    }
    check(agrees(1, 17) && agrees(-1, 17) && agrees(0.1, 17) && agrees(1e-5, 17) && agrees(9.9999999999999999e15, 17));
    check(agrees(0.0001, 17) && agrees(123456789012345678.0, 17) == false);
}

static void what_it_cannot_print_is_left_alone(void **state)
{
    (void)state;
    char small[DEM_DIGITS_TEXT - 1];
    check(!agrees(0, 17) && !agrees(-0.0, 17) && !agrees(NAN, 17) && !agrees(INFINITY, 17) && !agrees(5e-324, 17));
    check(!agrees(1e300, 17) && !agrees(1, 0) && !agrees(1, 18));
    check(!dem_digits_print(small, sizeof small, 1, 17));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_of_ordinary_size_are_printed_as_printf_does),
        cmocka_unit_test(any_bits_are_printed_as_printf_does_or_left_alone),
        cmocka_unit_test(ties_and_powers_of_ten_are_exact),
        cmocka_unit_test(what_it_cannot_print_is_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
