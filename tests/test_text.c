#include "check.h"

#include <locale.h>

#include "base/random.h"
#include "base/text.h"

static double parsed(const char *text)
{
    double value = -12345;
    const char *end = text + strlen(text);
    check(dem_parse_double(text, end, &value) == end);
    return value;
}

static void numbers_are_read_as_strtod_reads_them(void **state)
{
    (void)state;
    const char *cases[] = {"0", "-0.0", "1", "3.14159", "1e-9", "123456789012345678", "0.1234567890123456789", "1e22",
                           "1e23", "4.9e-324", "1.7976931348623157e308", "1e400", "-1e-400", "0.000000000000000000001", ".5", "5."};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double want = strtod(cases[i], NULL), got = parsed(cases[i]);
        assert_memory_equal(&got, &want, sizeof got);
    }
    check(isnan(parsed("nan")));
    check(isinf(parsed("-inf")));
}

static void random_numbers_survive_printing_and_reading(void **state)
{
    (void)state;
    dem_random r = random_stream(1, 2);
    for (int i = 0; i < 20000; i++) {
        double want = (random_uniform(&r) - 0.5) * pow(10, 40 * (random_uniform(&r) - 0.5));
        char text[64];
        double got = parsed(dem_format_double(text, sizeof text, want, i % 2 ? 17 : 9));
        double same = strtod(text, NULL);
        assert_memory_equal(&got, &same, sizeof got);
        if (i % 2)
            assert_memory_equal(&got, &want, sizeof got);
    }
}

static void the_shortest_text_is_read_back_without_loss(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0, "0"},
                 {-0.0, "-0"},
                 {0.1, "0.1"},
                 {1e-5, "1e-05"},
                 {1.0 / 3, "0.3333333333333333"},
                 {NAN, "nan"},
                 {-NAN, "nan"},
                 {INFINITY, "inf"},
                 {0.005, "0.005"},
                 {-1e300, "-1e+300"},
                 {2e-3, "0.002"},
                 {0.1 + 0.2, "0.30000000000000004"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_buffer out = {0};
        dem_buffer_shortest(&out, cases[i].value);
        assert_string_equal(out.data, cases[i].text);
        dem_buffer_release(&out);
    }
    dem_random r = random_stream(3, 4);
    for (int i = 0; i < 20000; i++) {
        double want = (random_uniform(&r) - 0.5) * pow(10, 600 * (random_uniform(&r) - 0.5));
        dem_buffer out = {0};
        dem_buffer_shortest(&out, want);
        double got = parsed(out.data);
        assert_memory_equal(&got, &want, sizeof got);
        dem_buffer_release(&out);
    }
}

// the last digit decides between two doubles: halfway cases, and 19 digits at any power strtod is asked for as well
static void the_last_digits_round_as_strtod_rounds_them(void **state)
{
    (void)state;
    const char *ties[] = {"9007199254740993", "9007199254740995", "4503599627370497.5", "4503599627370498.5",
                          "9007199254740992.9", "1.00000000000000011102230246251565", "0.1e-27", "9999999999999999999e27",
                          "1e-27", "1234567890123456789e-27", "5e27", "18014398509481989e0", "1801439850948198.5"};
    for (size_t i = 0; i < sizeof ties / sizeof *ties; i++) {
        double want = strtod(ties[i], NULL), got = parsed(ties[i]);
        assert_memory_equal(&got, &want, sizeof got);
    }
    dem_random r = random_stream(5, 2);
    for (int i = 0; i < 100000; i++) {
        char text[64];
        long long digits = (long long)(random_bits(&r) >> random_below(&r, 60)) & INT64_MAX;
        snprintf(text, sizeof text, "%lld%s%de%d", digits, i % 3 ? "." : "", (int)random_below(&r, 10),
                 (int)random_below(&r, 70) - 35);
        double want = strtod(text, NULL), got = parsed(text);
        assert_memory_equal(&got, &want, sizeof got);
    }
}

static void what_is_no_number_is_refused(void **state)
{
    (void)state;
    const char *cases[] = {"", "-", "e5", ".", "+-1", "v"};
    double value;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check(!dem_parse_double(cases[i], cases[i] + strlen(cases[i]), &value));
    const char *comma = "1,5";
    check(dem_parse_double(comma, comma + 3, &value) == comma + 1);
}

static void a_number_ends_where_the_text_ends(void **state)
{
    (void)state;
    double value;
    const char *text = "12345";
    check(dem_parse_double(text, text + 2, &value) == text + 2);
    check_near(value, 12, 0);
    const char *longer = "1.23456789012345678901234";
    check(dem_parse_double(longer, longer + 4, &value) == longer + 4);
    check_near(value, 1.23, 0);
}

static void a_german_locale_changes_nothing(void **state)
{
    (void)state;
    if (!setlocale(LC_ALL, "de_DE.UTF-8"))
        skip();
    double value = parsed("1.2345678901234567890");
    char text[64];
    dem_format_double(text, sizeof text, 0.5, 17);
    setlocale(LC_ALL, "C");
    check_near(value, 1.2345678901234567890, 0);
    assert_string_equal(text, "0.5");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_read_as_strtod_reads_them),
        cmocka_unit_test(random_numbers_survive_printing_and_reading),
        cmocka_unit_test(the_shortest_text_is_read_back_without_loss),
        cmocka_unit_test(the_last_digits_round_as_strtod_rounds_them),
        cmocka_unit_test(what_is_no_number_is_refused),
        cmocka_unit_test(a_number_ends_where_the_text_ends),
        cmocka_unit_test(a_german_locale_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
