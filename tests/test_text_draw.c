#include "check.h"

#include "out/glyphs.h"
#include "out/text_draw.h"

enum { WIDTH = 400, HEIGHT = 120 };

static const dem_rgb BLACK = {0, 0, 0}, WHITE = {255, 255, 255};

static dem_image blank(void)
{
    dem_image image;
    dem_error error;
    check_ok(dem_image_create(WIDTH, HEIGHT, &image, &error), error);
    memset(image.pixels, 255, 3 * WIDTH * HEIGHT);
    return image;
}

static void draw(dem_image *image, double x, double y, double size, dem_align align, const char *text)
{
    dem_error error;
    dem_text_style style = {.size = size, .ink = BLACK, .align = align};
    check_ok(dem_text_draw(image, x, y, &style, text, &error), error);
}

static int grey(const dem_image *image, int x, int y)
{
    return image->pixels[3 * (y * WIDTH + x)];
}

// the box of all pixels darker than `below`: left, top, right, bottom
static void ink_box(const dem_image *image, int below, int box[4])
{
    box[0] = WIDTH, box[1] = HEIGHT, box[2] = box[3] = -1;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            if (grey(image, x, y) < below) {
                box[0] = x < box[0] ? x : box[0], box[1] = y < box[1] ? y : box[1];
                box[2] = x > box[2] ? x : box[2], box[3] = y > box[3] ? y : box[3];
            }
}

static void stems_and_bars_fill_whole_pixels(void **state)
{
    (void)state;
    static const double sizes[] = {9, 12, 14, 17.3, 20};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        dem_image image = blank();
        draw(&image, 20, 80, sizes[i], DEM_ALIGN_LEFT, "L");
        int box[4], darkest = 255, x;
        ink_box(&image, 128, box);
        check(box[3] == 79);  // stands on the line of writing
        check_near(box[3] - box[1] + 1, sizes[i], 1);
        // the left edge of the stem: white beside black
        for (x = 0; x < WIDTH && grey(&image, x, 75) == 255; x++)
            ;
        check(grey(&image, x, 75) == 0 && grey(&image, x - 1, 75) == 255);
        for (int y = 0; y < HEIGHT; y++)
            darkest = grey(&image, x, y) < darkest ? grey(&image, x, y) : darkest;
        check(darkest == 0);
        dem_image_free(&image);
    }
}

static void text_is_as_broad_as_it_says(void **state)
{
    (void)state;
    static const char text[] = "HNEH";
    for (double size = 8; size < 40; size += 3.7) {
        dem_image image = blank();
        double width = dem_text_width(text, size);
        draw(&image, 200, 60, size, DEM_ALIGN_CENTRE, text);
        int box[4];
        ink_box(&image, 200, box);
        // between the outermost strokes and the ends there is the bearing on either side
        check_near(box[2] - box[0] + 1, width - 3.4 * size / 14 + 1.62 * size / 14, 3);
        check_near((box[0] + box[2] + 1) / 2.0, 200, 2);
        dem_image_free(&image);
    }
    check(dem_text_width("", 20) == 0);
    check_near(dem_text_width("11111", 14), dem_text_width("80436", 14), 0);  // digits stand in columns
}

static void aligned_text_ends_where_it_shall(void **state)
{
    (void)state;
    int left[4], right[4];
    dem_image image = blank();
    draw(&image, 100, 60, 14, DEM_ALIGN_LEFT, "H");
    ink_box(&image, 128, left);
    dem_image_free(&image);
    image = blank();
    draw(&image, 100, 60, 14, DEM_ALIGN_RIGHT, "H");
    ink_box(&image, 128, right);
    dem_image_free(&image);
    check(left[0] >= 100 && left[0] <= 103 && right[2] < 100 && right[2] >= 96);
}

static void superscripts_are_small_and_high(void **state)
{
    (void)state;
    int plain[4], raised[4];
    dem_image image = blank();
    draw(&image, 50, 80, 28, DEM_ALIGN_LEFT, "2");
    ink_box(&image, 128, plain);
    dem_image_free(&image);
    image = blank();
    draw(&image, 50, 80, 28, DEM_ALIGN_LEFT, "\xC2\xB2");
    ink_box(&image, 128, raised);
    dem_image_free(&image);
    check(raised[3] < plain[3] - 10 && raised[3] - raised[1] < 0.75 * (plain[3] - plain[1]));
}

static void every_sign_is_drawn_and_differs(void **state)
{
    (void)state;
    for (char c = '!'; c <= '~'; c++) {
        char text[2] = {c, 0};
        dem_image image = blank();
        int box[4];
        draw(&image, 50, 80, 28, DEM_ALIGN_LEFT, text);
        ink_box(&image, 128, box);
        check(box[2] >= box[0]);
        check(dem_glyph_of((uint32_t)c)->code == (uint32_t)c);
        // nothing reaches beyond the room that lines of text leave
        check(box[1] >= 80 - 2 * DEM_GLYPH_ASCENT - 2 && box[3] <= 80 + 2 * DEM_GLYPH_DESCENT + 2);
        check(box[0] >= 50 && box[2] <= 50 + dem_text_width(text, 28));
        dem_image_free(&image);
    }
}

static void text_is_read_as_utf8(void **state)
{
    (void)state;
    const char *at = "a\xC2\xB5\xE2\x89\xA4\xF0\x9F\x8C\x8D\xFF\xC2z";
    static const uint32_t want[] = {'a', 0xB5, 0x2264, 0x1F30D, 0xFFFD, 0xFFFD, 'z', 0};
    for (size_t i = 0; i < sizeof want / sizeof *want; i++)
        check(dem_utf8_next(&at) == want[i]);
    check(dem_glyph_of(0x1F30D)->code == 0xFFFD);  // a box
}

static void drawing_outside_is_left_out(void **state)
{
    (void)state;
    static const double places[][2] = {{-1000, 60}, {395, 60}, {50, -3}, {50, 125}, {1e9, 5}, {-8, 4}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        dem_image image = blank();
        draw(&image, places[i][0], places[i][1], 30, DEM_ALIGN_LEFT, "Wide text jg|");
        dem_fill_box(&image, places[i][0], places[i][1], places[i][0] + 20, places[i][1] + 20, BLACK);
        dem_image_free(&image);
    }
}

static void a_halo_lies_under_the_ink(void **state)
{
    (void)state;
    dem_image image = blank();
    dem_error error;
    memset(image.pixels, 90, 3 * WIDTH * HEIGHT);
    dem_text_style style = {.size = 28, .ink = BLACK, .halo = 4, .rim = WHITE};
    check_ok(dem_text_draw(&image, 50, 80, &style, "I", &error), error);
    int box[4], y = 66;
    ink_box(&image, 20, box);
    check(grey(&image, box[0] - 2, y) == 255 && grey(&image, box[2] + 2, y) == 255);
    check(grey(&image, box[0] - 7, y) == 90 && grey(&image, box[2] + 7, y) == 90);
    dem_image_free(&image);
}

static void long_texts_are_shortened_in_the_middle(void **state)
{
    (void)state;
    char room[64];
    const char *name = "a_long_name_of_a_grain_\xC2\xB5\xC2\xB5\xC2\xB5_017.json";
    check(dem_text_fit(name, 14, 1e4, room, sizeof room) == name);
    for (double width = 20; width < 400; width += 7) {
        const char *shorter = dem_text_fit(name, 14, width, room, sizeof room);
        check(dem_text_width(shorter, 14) <= fmax(width, 14));
        for (const char *at = shorter; *at;)
            check(dem_utf8_next(&at) != 0xFFFD);  // never half a character
    }
    const char *fit = dem_text_fit(name, 14, 150, room, sizeof room);
    check(strncmp(fit, "a_lo", 4) == 0 && strcmp(fit + strlen(fit) - 5, ".json") == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stems_and_bars_fill_whole_pixels),
        cmocka_unit_test(text_is_as_broad_as_it_says),
        cmocka_unit_test(aligned_text_ends_where_it_shall),
        cmocka_unit_test(superscripts_are_small_and_high),
        cmocka_unit_test(every_sign_is_drawn_and_differs),
        cmocka_unit_test(text_is_read_as_utf8),
        cmocka_unit_test(drawing_outside_is_left_out),
        cmocka_unit_test(a_halo_lies_under_the_ink),
        cmocka_unit_test(long_texts_are_shortened_in_the_middle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
