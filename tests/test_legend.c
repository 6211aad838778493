#include "check.h"

#include "out/legend.h"

static bool is_round(double step)
{
    double lead = step / pow(10, floor(log10(step) + 1e-9));
    return fabs(lead - 1) < 1e-9 || fabs(lead - 2) < 1e-9 || fabs(lead - 5) < 1e-9;
}

static void ticks_are_round_numbers_within_the_range(void **state)
{
    (void)state;
    static const double ranges[][2] = {{0, 1},      {0.002073, 0.19871}, {-98.11, 98.11},
                                       {3, 3.0001}, {-7e-9, -2e-9},      {1e12, 9e12},
                                       {0, 0.3},    {-1, 1e6},           {99.9, 100.1}};
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        for (size_t most = 2; most <= 12; most++) {
            double ticks[DEM_TICKS], step, low = ranges[i][0], high = ranges[i][1];
            size_t count = dem_ticks(low, high, most, false, ticks, &step);
            check(count >= 1 && count <= most && is_round(step));
            check(most < 4 || count >= 2);
            for (size_t k = 0; k < count; k++) {
                check(ticks[k] >= low - 1e-9 * step && ticks[k] <= high + 1e-9 * step);
                check_near(ticks[k] / step, round(ticks[k] / step), 1e-6);
                if (k)
                    check_near(ticks[k] - ticks[k - 1], step, 1e-6 * step);
            }
        }
}

static void ticks_of_whole_numbers_are_whole(void **state)
{
    (void)state;
    double ticks[DEM_TICKS], step;
    check(dem_ticks(0, 2, 8, true, ticks, &step) == 3 && step == 1 && ticks[2] == 2);
    check(dem_ticks(0, 17, 8, true, ticks, &step) == 4 && step == 5 && ticks[3] == 15);
    check(dem_ticks(4, 4, 8, true, ticks, &step) == 1 && ticks[0] == 4);
}

static void a_range_without_extent_has_one_tick(void **state)
{
    (void)state;
    static const double values[] = {0, 5, -3e-7, 1e20};
    for (size_t i = 0; i < 4; i++) {
        double ticks[DEM_TICKS], step;
        char text[DEM_LABEL_TEXT];
        check(dem_ticks(values[i], values[i], 8, false, ticks, &step) == 1 && ticks[0] == values[i] && step > 0);
        check(strlen(dem_tick_text(ticks[0], step, text)) > 0);
    }
    double ticks[DEM_TICKS], step;
    check(dem_ticks(0, INFINITY, 8, false, ticks, &step) == 1);
}

static void says(double tick, double step, const char *want)
{
    char text[DEM_LABEL_TEXT];
    assert_string_equal(dem_tick_text(tick, step, text), want);
}

static void ticks_have_the_decimals_of_their_step(void **state)
{
    (void)state;
    says(0.5, 0.1, "0.5");
    says(1, 0.25, "1.0");
    says(-0.05, 0.01, "-0.05");
    says(-1e-12, 0.1, "0.0");
    says(150, 50, "150");
    says(20000, 5000, "20000");
    says(0.0002, 2e-4, "0.0002");
    says(12.345, 1e-3, "12.345");
    says(0, 5, "0");
    says(3e20, 1e20, "3e+20");
}

static void unit_is(const char *unit, double largest, double want, const char *text)
{
    char got[DEM_LABEL_TEXT];
    double factor;
    assert_string_equal(dem_unit_for(unit, largest, &factor, got), text);
    check_close(factor, want, 1e-12);
}

static void units_suit_the_numbers(void **state)
{
    (void)state;
    unit_is("m", 0.014, 1e-3, "mm");
    unit_is("m", 0.6, 1, "m");
    unit_is("m", 3e-5, 1e-6, "µm");
    unit_is("m/s", 0.2, 1e-3, "mm/s");
    unit_is("kg", 1.4e-6, 1e-6, "mg");
    unit_is("kg", 12, 1, "kg");
    unit_is("s", 0.02, 1e-3, "ms");
    unit_is("s", 4000, 1, "s");
    unit_is("rad/s", 300, 1, "rad/s");
    unit_is("rad/s", 3e-6, 1e-6, "10⁻⁶ rad/s");
    unit_is("", 12, 1, "");
    unit_is(NULL, 2.5e7, 1e7, "10⁷");
    unit_is("m", 0, 1, "m");
    char text[DEM_LABEL_TEXT];
    assert_string_equal(dem_quantity_text(0.0125, "s", 0.0125, text), "12.5 ms");
    assert_string_equal(dem_quantity_text(0, "s", 0.1, text), "0 ms");
    assert_string_equal(dem_quantity_text(3, NULL, 3, text), "3");
}

enum { WIDTH = 300, HEIGHT = 400 };

static dem_image blank(void)
{
    dem_image image;
    dem_error error;
    check_ok(dem_image_create(WIDTH, HEIGHT, &image, &error), error);
    memset(image.pixels, 255, 3 * WIDTH * HEIGHT);
    return image;
}

static const uint8_t *pixel(const dem_image *image, int x, int y)
{
    return image->pixels + 3 * (y * WIDTH + x);
}

static void check_colour(const uint8_t *got, dem_colour want, int tolerance)
{
    check(abs(got[0] - dem_colour_srgb(want.r)) <= tolerance && abs(got[1] - dem_colour_srgb(want.g)) <= tolerance &&
          abs(got[2] - dem_colour_srgb(want.b)) <= tolerance);
}

static void the_bar_shows_the_colours_of_its_ends(void **state)
{
    (void)state;
    for (dem_picture_map map = DEM_PICTURE_MAP_RAMP; map <= DEM_PICTURE_MAP_GREY; map++) {
        dem_palette palette;
        dem_error error;
        dem_palette_make(map, &palette);
        dem_image image = blank();
        dem_legend legend = {.low = 0, .high = 1, .palette = &palette};
        check_ok(dem_legend_draw(&image, &legend, 20, 20, 360, 14, (dem_rgb){0, 0, 0}, &error), error);
        // without a title, half a letter is free above and below
        int top = 27, bottom = 373;
        check(pixel(&image, 25, top - 1)[0] == 255 && pixel(&image, 25, bottom)[0] == 255);
        for (int y = top; y < bottom; y++)
            check_colour(pixel(&image, 25, y), dem_palette_at(&palette, (bottom - y - 0.5) / (bottom - top)), 1);
        // the line of the tick at 0.4
        int black = 0;
        for (int y = 233; y <= 236; y++)
            black += pixel(&image, 41, y)[0] == 0;
        check(black == 1);
        dem_image_free(&image);
    }
}

static void a_bar_that_goes_on_is_pointed(void **state)
{
    (void)state;
    dem_palette palette;
    dem_error error;
    dem_palette_make(DEM_PICTURE_MAP_RAMP, &palette);
    dem_image image = blank();
    dem_legend legend = {.low = 0, .high = 1, .above = true, .palette = &palette};
    check_ok(dem_legend_draw(&image, &legend, 20, 20, 360, 14, (dem_rgb){0, 0, 0}, &error), error);
    int rows[2] = {0};
    for (int y = 27; y < 60; y++)
        for (int k = 0; k < 2; k++)
            rows[k] += pixel(&image, k ? 29 : 21, y)[0] != 255;
    check(rows[1] > rows[0] + 8);  // its middle begins higher than its side
    check_colour(pixel(&image, 29, 40), dem_palette_at(&palette, 1), 1);
    check_colour(pixel(&image, 21, 372), dem_palette_at(&palette, 0), 2);
    dem_image_free(&image);
}

static void names_stand_beside_their_colours(void **state)
{
    (void)state;
    static const char *const names[] = {"sand", "gravel", "clay"};
    const dem_colour colours[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    dem_legend legend = {.names = names, .colours = colours, .count = 3};
    dem_error error;
    dem_image image = blank();
    check_ok(dem_legend_draw(&image, &legend, 20, 20, 360, 14, (dem_rgb){0, 0, 0}, &error), error);
    int met[3] = {0}, ink = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const uint8_t *p = pixel(&image, x, y);
            for (int k = 0; k < 3; k++)
                met[k] += p[k] == 255 && p[(k + 1) % 3] == 0 && p[(k + 2) % 3] == 0;
            ink += p[0] + p[1] + p[2] == 0;
            check(memcmp(p, "\xff\xff\xff", 3) == 0 || x <= 20 + dem_legend_width(&legend, 14));
        }
    check(met[0] > 250 && abs(met[0] - met[1]) < 20 && abs(met[1] - met[2]) < 20 && ink > 100);
    dem_image_free(&image);
}

static void the_scale_bar_is_as_long_as_it_says(void **state)
{
    (void)state;
    for (double breadth = 1e-7; breadth < 10; breadth *= 3.7) {
        dem_image image = blank();
        dem_error error;
        check_ok(dem_scale_bar_draw(&image, 10, 100, 150, breadth, "m", 14, (dem_rgb){0, 0, 0}, &error), error);
        int length = 0;
        while (pixel(&image, 10 + length, 93)[0] == 0)
            length++;
        check(length <= 150 && length >= 40);
        double metres = length * breadth, power = pow(10, floor(log10(metres) + 0.02)), lead = metres / power;
        // to half a pixel at either end
        double off = fmin(fabs(lead - 1), fmin(fabs(lead - 2), fmin(fabs(lead - 5), fabs(lead - 10))));
        check(off * power <= breadth);
        dem_image_free(&image);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ticks_are_round_numbers_within_the_range),
        cmocka_unit_test(ticks_of_whole_numbers_are_whole),
        cmocka_unit_test(a_range_without_extent_has_one_tick),
        cmocka_unit_test(ticks_have_the_decimals_of_their_step),
        cmocka_unit_test(units_suit_the_numbers),
        cmocka_unit_test(the_bar_shows_the_colours_of_its_ends),
        cmocka_unit_test(a_bar_that_goes_on_is_pointed),
        cmocka_unit_test(names_stand_beside_their_colours),
        cmocka_unit_test(the_scale_bar_is_as_long_as_it_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
