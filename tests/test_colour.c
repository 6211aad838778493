#include "check.h"

#include "out/palette.h"

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

// the lightness, a and b of OKLab (Ottosson 2020) of linear light
static void lab_of(dem_colour c, double lab[3])
{
    double l = cbrt(0.4122214708 * red(c) + 0.5363325363 * green(c) + 0.0514459929 * blue(c));
    double m = cbrt(0.2119034982 * red(c) + 0.6806995451 * green(c) + 0.1073969566 * blue(c));
    double s = cbrt(0.0883024619 * red(c) + 0.2817188376 * green(c) + 0.6299787005 * blue(c));
    lab[0] = 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
    lab[1] = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s;
    lab[2] = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s;
}

static double difference(dem_colour a, dem_colour b)
{
    double x[3], y[3];
    lab_of(a, x);
    lab_of(b, y);
    return hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]);
}

static void equal_steps_of_a_map_look_equal(void **state)
{
    (void)state;
    for (dem_picture_map map = DEM_PICTURE_MAP_AUTO; map <= DEM_PICTURE_MAP_GREY; map++) {
        dem_palette p;
        double least = INFINITY, most = 0;
        dem_palette_make(map, &p);
        for (int i = 0; i < 32; i++) {
            double step = difference(dem_palette_at(&p, i / 32.0), dem_palette_at(&p, (i + 1) / 32.0));
            least = fmin(least, step);
            most = fmax(most, step);
        }
        // chords of a curve are shorter where it bends; the two halves of the diverging map differ a little in length
        check(most < (map == DEM_PICTURE_MAP_DIVERGING ? 1.12 : 1.03) * least);
    }
}

static void maps_grow_lighter_all_the_way(void **state)
{
    (void)state;
    static const dem_picture_map maps[] = {DEM_PICTURE_MAP_RAMP, DEM_PICTURE_MAP_WARM, DEM_PICTURE_MAP_GREY};
    for (size_t k = 0; k < 3; k++) {
        dem_palette p;
        dem_palette_make(maps[k], &p);
        for (int i = 0; i < 100; i++)
            check(luminance(dem_palette_at(&p, i / 100.0)) < luminance(dem_palette_at(&p, (i + 1) / 100.0)));
    }
    dem_palette p;
    dem_palette_make(DEM_PICTURE_MAP_RAMP, &p);
    dem_colour low = dem_palette_at(&p, -1), high = dem_palette_at(&p, 2), none = dem_palette_at(&p, NAN);
    check(low.b > 2 * low.r && high.r > high.b && high.g > high.b);
    check(red(low) == red(dem_palette_at(&p, 0)) && red(high) == red(dem_palette_at(&p, 1)));
    check_near(red(none), blue(none), 1e-6);
    // the ends are the outermost knots
    check(difference(low, dem_colour_lch(.36, .135, .79)) < 1e-4);
    check(difference(high, dem_colour_lch(.92, .16, .295)) < 1e-4);
}

static void the_diverging_map_is_white_in_the_middle(void **state)
{
    (void)state;
    dem_palette p;
    dem_palette_make(DEM_PICTURE_MAP_DIVERGING, &p);
    dem_colour low = dem_palette_at(&p, 0), middle = dem_palette_at(&p, 0.5), high = dem_palette_at(&p, 1);
    check(low.b > 4 * low.r && high.r > 4 * high.b);
    check_near(red(middle), blue(middle), 0.01);
    check(luminance(middle) > 0.75);
    for (int i = 0; i < 50; i++) {
        check(luminance(dem_palette_at(&p, i / 100.0)) < luminance(dem_palette_at(&p, (i + 1) / 100.0)));
        check(luminance(dem_palette_at(&p, 1 - i / 100.0)) < luminance(dem_palette_at(&p, 0.99 - i / 100.0)));
    }
}

static void bytes_and_light_turn_into_each_other(void **state)
{
    (void)state;
    for (int i = 0; i < 256; i++) {
        dem_colour c = dem_colour_of_srgb((uint8_t)i, 0, 255);
        check(dem_colour_srgb(c.r) == i && dem_colour_srgb(c.g) == 0 && dem_colour_srgb(c.b) == 255);
    }
    check_near(red(dem_colour_of_srgb(188, 0, 0)), 0.5, 3e-3);  // half the light
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
        cmocka_unit_test(equal_steps_of_a_map_look_equal),
        cmocka_unit_test(maps_grow_lighter_all_the_way),
        cmocka_unit_test(the_diverging_map_is_white_in_the_middle),
        cmocka_unit_test(bytes_and_light_turn_into_each_other),
        cmocka_unit_test(numbers_keep_their_colours_and_neighbours_differ),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
