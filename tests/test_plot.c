#include "check.h"

#include <locale.h>

#include "out/plot.h"
#include "out/scale.h"
#include "out/xml.h"

static void labels_of(dem_scale scale, char *text, size_t size)
{
    dem_tick ticks[DEM_MOST_TICKS];
    size_t count = dem_scale_ticks(&scale, ticks);
    *text = 0;
    for (size_t i = 0; i < count; i++) {
        check(i == 0 || ticks[i].value > ticks[i - 1].value);
        double at = dem_scale_map(&scale, ticks[i].value);
        check(at >= -1e-9 && at <= 1 + 1e-9);
        if (*ticks[i].label)
            snprintf(text + strlen(text), size - strlen(text), "%s%s", *text ? " " : "", ticks[i].label);
    }
}

static void ticks_are_decades_or_one_two_five_of_them_or_even_steps(void **state)
{
    (void)state;
    static const struct {
        dem_scale scale;
        const char *labels;
    } cases[] = {{{true, 0.0009, 130}, "0.001 0.01 0.1 1 10 100"},
                 {{true, 4.8, 520}, "5 10 20 50 100 200 500"},
                 {{true, 0.3, 25}, "0.5 1 2 5 10 20"},
                 {{true, 3.1, 16}, "4 6 8 10"},
                 {{true, 14, 27}, "15 20 25"},
                 {{true, 1.9, 8.2}, "2 3 4 6 8"},
                 {{true, 1e-7, 2e-2}, "10⁻⁷ 10⁻⁶ 10⁻⁵ 10⁻⁴ 0.001 0.01"},
                 {{true, 1e-15, 1}, "10⁻¹⁵ 10⁻¹² 10⁻⁹ 10⁻⁶ 0.001 1"},
                 {{true, 100, 120}, "100 105 110 115 120"},
                 {{false, 0, 10}, "0 2 4 6 8 10"},
                 {{false, -1.1, 1.1}, "-1 -0.5 0 0.5 1"},
                 {{false, 0, 3e6}, "0 5·10⁵ 10⁶ 1.5·10⁶ 2·10⁶ 2.5·10⁶ 3·10⁶"}};
    char text[400];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        labels_of(cases[i].scale, text, sizeof text);
        if (strcmp(text, cases[i].labels) != 0)
            fail_msg("case %zu: '%s'", i, text);
    }
}

static void every_range_has_two_labels_and_room_for_its_ticks(void **state)
{
    (void)state;
    char text[4000];
    for (double low = 1e-12; low < 1e12; low *= 3.7)
        for (double ratio = 1.001; ratio < 1e20; ratio *= 1.9)
            for (int log = 0; log < 2; log++) {
                labels_of((dem_scale){log, low, low * ratio}, text, sizeof text);
                check(strchr(text, ' '));
            }
}

static void values_map_linearly_or_by_their_logarithm(void **state)
{
    (void)state;
    dem_scale line = {false, 2, 6}, log = {true, 0.01, 100};
    check_near(dem_scale_map(&line, 3), 0.25, 1e-15);
    check_near(dem_scale_map(&line, 6), 1, 1e-15);
    check_near(dem_scale_map(&log, 1), 0.5, 1e-15);
    check_near(dem_scale_map(&log, 10), 0.75, 1e-15);
    check_near(dem_scale_map(&log, 0.001), -0.25, 1e-15);
}

static void a_scale_holds_its_values_and_leaves_out_what_cannot_stand_on_it(void **state)
{
    (void)state;
    const double values[] = {NAN, 0, -3, 5, INFINITY, 80, -INFINITY};
    dem_scale log = dem_scale_fit(true, values, 7), line = dem_scale_fit(false, values, 7);
    check(log.low < 5 && log.low > 4 && log.high > 80 && log.high < 100);
    check(line.low < -3 && line.low > -7 && line.high > 80 && line.high < 84);
    dem_scale from_zero = dem_scale_fit(false, (double[]){1, 10}, 2);
    check(from_zero.low == 0);
    for (int k = 0; k < 2; k++) {
        dem_scale none = dem_scale_fit(k, values, 1), same = dem_scale_fit(k, (double[]){7, 7}, 2);
        check(none.low < none.high && isfinite(none.high) && same.low <= 7 && same.high >= 7 && same.low < same.high);
        dem_scale zero = dem_scale_fit(k, (double[]){0, 0}, 2);
        check(zero.low < zero.high);
    }
}

static void text_is_escaped_and_what_xml_may_not_hold_is_replaced(void **state)
{
    (void)state;
    dem_buffer out = {0};
    dem_xml_text(&out, "a<b & \"c\">d\x01\x1b µ≤\xff\xc3(\xed\xa0\x80|");
    assert_string_equal(out.data, "a&lt;b &amp; &quot;c&quot;&gt;d?? µ≤?"
                                  "?(???|");
    dem_buffer_release(&out);
}

static void base64_is_that_of_the_standard(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {{"f", "Zg=="},        {"fo", "Zm8="},        {"foo", "Zm9v"},
                                           {"foob", "Zm9vYg=="}, {"fooba", "Zm9vYmE="}, {"foobar", "Zm9vYmFy"}};
    for (size_t i = 0; i < 6; i++) {  // RFC 4648, 10
        dem_buffer out = {0};
        dem_base64(&out, pairs[i][0], strlen(pairs[i][0]));
        assert_string_equal(out.data, pairs[i][1]);
        dem_buffer_release(&out);
    }
}

static size_t count_of(const dem_buffer *text, const char *what)
{
    size_t count = 0;
    for (const char *at = text->data; (at = strstr(at, what)); at++)
        count++;
    return count;
}

static const double X[5] = {10, 20, 50, 100, 200};

static dem_buffer drawn(const dem_plot_series *series, size_t count, double floor)
{
    dem_plot plot = {{"spheres", true, 0}, {"error [%]", true, floor}, series, count};
    dem_plot_sheet sheet = {.title = "errors & more", .note = "a note", .plots = &plot, .count = 1, .columns = 3};
    dem_buffer out = {0};
    dem_plot_sheet_draw(&out, &sheet);
    check(!out.failed && strstr(out.data, "nan") == NULL && strstr(out.data, "inf") == NULL);
    check(count_of(&out, "<g") == count_of(&out, "</g>") && count_of(&out, "<text") == count_of(&out, "</text>"));
    return out;
}

static void points_that_cannot_be_drawn_are_left_out_and_small_ones_stand_on_the_floor(void **state)
{
    (void)state;
    const double y[5] = {8, NAN, 2, 0, 1e-9};
    dem_plot_series one = {.name = "one", .x = X, .y = y, .count = 5};
    dem_buffer out = drawn(&one, 1, 0);
    check(count_of(&out, "<circle") == 3);
    check(!strstr(out.data, "≤"));
    dem_buffer_release(&out);
    out = drawn(&one, 1, 1e-4);
    check(count_of(&out, "<circle") == 4 && count_of(&out, "fill=\"#fff\" stroke") == 2);
    check(count_of(&out, "≤ 10⁻⁴") == 1);
    dem_buffer_release(&out);
    const double none[5] = {0, 0, NAN, -1, 0};
    one.y = none;
    out = drawn(&one, 1, 0);
    check(count_of(&out, "<circle") == 0 && strstr(out.data, "nothing to show"));
    dem_buffer_release(&out);
}

static void names_are_escaped_stand_at_the_lines_and_in_the_legend_and_apart(void **state)
{
    (void)state;
    const double y[5] = {8, 5, 3, 2, 1};
    dem_plot_series same[9];
    for (size_t k = 0; k < 9; k++)
        same[k] = (dem_plot_series){.name = k ? "b" : "<a&b>", .x = X, .y = y, .count = 5};
    dem_buffer out = drawn(same, 9, 0);
    check(count_of(&out, ">&lt;a&amp;b&gt;<") == 2 && count_of(&out, ">b<") == 16);
    check(strstr(out.data, "errors &amp; more") && strstr(out.data, "error [%]"));
    // heights of the names at the right: no two within ten pixels
    double heights[32];
    size_t count = 0;
    for (const char *at = out.data; (at = strstr(at, "<text x=\"")) && count < 32; at++) {
        const char *end = strchr(at, '>'), *fill = strstr(at, " fill=\"#");
        const char *height = strstr(at, " y=\"");
        if (end[1] == 'b' && fill && fill < end)
            dem_parse_double(height + 4, end, &heights[count++]);
    }
    check(count == 8);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < i; k++)
            check(fabs(heights[i] - heights[k]) > 10);
    dem_buffer_release(&out);
}

static void bars_reach_as_far_as_the_errors(void **state)
{
    (void)state;
    const double y[5] = {8, 5, 3, 2, 1}, error[5] = {1, 0, NAN, 5, 0.5};
    dem_plot_series one = {.name = "one", .x = X, .y = y, .error = error, .count = 5};
    dem_buffer out = drawn(&one, 1, 0);
    // two of three lines, and one of two that has no lower end on a logarithmic axis
    check(count_of(&out, "stroke-width=\"1.2\"") == 3 + 2 + 3);
    dem_buffer_release(&out);
}

static void numbers_have_points_in_every_locale(void **state)
{
    (void)state;
    const double y[5] = {8.5, 5.25, 3.125, 2, 1.5};
    dem_plot_series one = {.name = "one", .x = X, .y = y, .count = 5};
    if (!setlocale(LC_NUMERIC, "de_DE.UTF-8") && !setlocale(LC_NUMERIC, "de_DE"))
        skip();
    setlocale(LC_NUMERIC, "C");
    dem_buffer plain = drawn(&one, 1, 0);
    if (!setlocale(LC_NUMERIC, "de_DE.UTF-8"))
        setlocale(LC_NUMERIC, "de_DE");
    dem_buffer german = drawn(&one, 1, 0);
    setlocale(LC_NUMERIC, "C");
    assert_string_equal(plain.data, german.data);
    dem_buffer_release(&plain);
    dem_buffer_release(&german);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ticks_are_decades_or_one_two_five_of_them_or_even_steps),
        cmocka_unit_test(every_range_has_two_labels_and_room_for_its_ticks),
        cmocka_unit_test(values_map_linearly_or_by_their_logarithm),
        cmocka_unit_test(a_scale_holds_its_values_and_leaves_out_what_cannot_stand_on_it),
        cmocka_unit_test(text_is_escaped_and_what_xml_may_not_hold_is_replaced),
        cmocka_unit_test(base64_is_that_of_the_standard),
        cmocka_unit_test(points_that_cannot_be_drawn_are_left_out_and_small_ones_stand_on_the_floor),
        cmocka_unit_test(names_are_escaped_stand_at_the_lines_and_in_the_legend_and_apart),
        cmocka_unit_test(bars_reach_as_far_as_the_errors),
        cmocka_unit_test(numbers_have_points_in_every_locale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
