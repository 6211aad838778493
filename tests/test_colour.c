#include "check.h"

#include "out/colour.h"

static double red(dem_colour c)
{
    return (double)c.r;
}
static double green(dem_colour c)
{
    return (double)c.g;
}
static double blue(dem_colour c)
{
    return (double)c.b;
}

static void lightness_chroma_and_hue_become_light(void **state)
{
    (void)state;
    dem_colour white = dem_colour_lch(1, 0, 0.3), black = dem_colour_lch(0, 0, 0), grey = dem_colour_lch(0.5, 0, 0);
    check_near(red(white), 1, 1e-6);
    check_near(blue(white), 1, 1e-6);
    check(red(black) == 0 && green(black) == 0);
    check_near(green(grey), 0.125, 1e-6);  // the cube
    // Ottosson's OKLab of sRGB red, 5 digits: L .62796, a .22486, b .12585
    dem_colour r = dem_colour_lch(0.62796, hypot(0.22486, 0.12585), atan2(0.12585, 0.22486) / (2 * acos(-1)));
    check_near(red(r), 1, 2e-4);
    check_near(green(r), 0, 2e-4);
    check_near(blue(r), 0, 2e-4);
}

static double luminance(dem_colour c)
{
    return 0.2126 * red(c) + 0.7152 * green(c) + 0.0722 * blue(c);
}

static void the_ramp_grows_lighter_all_the_way(void **state)
{
    (void)state;
    for (int i = 0; i < 100; i++)
        check(luminance(dem_colour_ramp(i / 100.0)) < luminance(dem_colour_ramp((i + 1) / 100.0)));
    dem_colour low = dem_colour_ramp(-1), high = dem_colour_ramp(2), none = dem_colour_ramp(NAN);
    check(low.b > 2 * low.r && high.r > high.b && high.g > high.b);
    check(red(low) == red(dem_colour_ramp(0)) && red(high) == red(dem_colour_ramp(1)));
    check_near(red(none), blue(none), 1e-6);
}

static void numbers_keep_their_colours_and_neighbours_differ(void **state)
{
    (void)state;
    int same = 0;
    for (uint64_t i = 0; i < 1000; i++) {
        dem_colour a = dem_colour_of_number(i), again = dem_colour_of_number(i), b = dem_colour_of_number(i + 1);
        check(memcmp(&a, &again, sizeof a) == 0);
        double light = luminance(a);
        check(light > 0.1 && light < 0.8);  // neither black nor white
        same += memcmp(&a, &b, sizeof a) == 0;
    }
    check(same == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lightness_chroma_and_hue_become_light),
        cmocka_unit_test(the_ramp_grows_lighter_all_the_way),
        cmocka_unit_test(numbers_keep_their_colours_and_neighbours_differ),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
