#include "check.h"

#include "out/grid.h"

static void cells_fill_the_sheet_without_overlap(void **state)
{
    (void)state;
    for (size_t count = 1; count < 40; count++)
        for (int width = 300; width < 2000; width += 570) {
            dem_grid s = dem_grid_divide(count, width, 900, 0, 1, true, 0);
            check(s.columns * s.rows >= count && s.columns * (s.rows - 1) < count);
            unsigned char *seen = calloc((size_t)width * 900, 1);
            for (size_t i = 0; i < count; i++) {
                int left, top;
                dem_grid_cell(&s, i, &left, &top);
                check(left >= 0 && top >= 0 && left + s.cell_width <= width &&
                      top + s.cell_height + s.name_height <= 900);
                for (int y = top; y < top + s.cell_height + s.name_height; y++)
                    for (int x = left; x < left + s.cell_width; x++)
                        check(seen[y * width + x]++ == 0);
            }
            free(seen);
        }
}

static void cells_are_as_large_as_they_can_be(void **state)
{
    (void)state;
    dem_grid s = dem_grid_divide(12, 1600, 900, 0, 1, false, 0);
    check(s.columns == 4 && s.rows == 3 && s.cell_height == 300 && s.name_height == 0);
    for (size_t columns = 1; columns <= 12; columns++) {
        dem_grid other = dem_grid_divide(12, 1600, 900, columns, 1, false, 0);
        check(other.columns == columns);
        check(fmin(other.cell_width, other.cell_height) <= fmin(s.cell_width, s.cell_height));
    }
    check(dem_grid_divide(2, 900, 900, 7, 1, true, 0).columns == 2);
}

static void what_is_pasted_is_cut_at_the_edges(void **state)
{
    (void)state;
    dem_image image, part;
    dem_error error;
    check_ok(dem_image_create(10, 8, &image, &error), error);
    check_ok(dem_image_create(4, 4, &part, &error), error);
    dem_image_fill(&part, (dem_rgb){9, 8, 7});
    for (int top = -5; top < 10; top++)
        for (int left = -5; left < 12; left++) {
            dem_image_fill(&image, (dem_rgb){1, 2, 3});
            dem_image_paste(&image, &part, left, top);
            for (int y = 0; y < 8; y++)
                for (int x = 0; x < 10; x++) {
                    bool in = x >= left && x < left + 4 && y >= top && y < top + 4;
                    check(image.pixels[3 * (y * 10 + x) + 2] == (in ? 7 : 3));
                }
        }
    dem_image_free(&image);
    dem_image_free(&part);
}

static void names_stand_under_their_pictures(void **state)
{
    (void)state;
    dem_grid s = dem_grid_divide(2, 400, 240, 2, 1, true, 12);
    dem_image image;
    dem_error error;
    check_ok(dem_image_create(400, 240, &image, &error), error);
    dem_image_fill(&image, (dem_rgb){255, 255, 255});
    check_ok(dem_grid_name(&s, &image, 1, "a name that is much too long for a picture of this size.json",
                           (dem_rgb){0, 0, 0}, &error),
             error);
    int ink = 0;
    for (int y = 0; y < 240; y++)
        for (int x = 0; x < 400; x++)
            if (image.pixels[3 * (y * 400 + x)] < 100) {
                check(x >= 200 && y >= s.cell_height);
                ink++;
            }
    check(ink > 100);
    dem_image_free(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_fill_the_sheet_without_overlap),
        cmocka_unit_test(cells_are_as_large_as_they_can_be),
        cmocka_unit_test(what_is_pasted_is_cut_at_the_edges),
        cmocka_unit_test(names_stand_under_their_pictures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
