#include "folder.h"

#include "out/sheet.h"

static dem_image tile(uint8_t shade)
{
    dem_image image;
    dem_error error;
    check_ok(dem_image_create(240, 120, &image, &error), error);
    memset(image.pixels, shade, 240 * 120 * 3);
    return image;
}

// breadth and height as a PNG's header has them
static void check_size(const char *path, unsigned width, unsigned height)
{
    dem_buffer png = content(path);
    check(png.size > 24);
    const unsigned char *b = (const unsigned char *)png.data + 16;
    assert_int_equal(b[2] << 8 | b[3], width);
    assert_int_equal(b[6] << 8 | b[7], height);
    dem_buffer_release(&png);
}

static void a_sheet_is_as_large_as_its_cells_need(void **state)
{
    (void)state;
    dem_error error;
    dem_sheet *sheet = dem_sheet_create(in_folder("sheet.png"));
    for (int i = 0; i < 5; i++) {
        dem_image picture = i == 3 ? (dem_image){0} : tile(200);  // one that failed
        check_ok(
            dem_sheet_add(sheet, &picture, "a name that is longer than what the cell under it has room for", "", &error),
            error);
        check(picture.pixels == NULL);
    }
    check_ok(dem_sheet_finish(sheet, &error), error);
    check_size(in_folder("sheet.png"), 2 * 248 + 8, 3 * 158 + 8);
}

static void many_cells_take_pages(void **state)
{
    (void)state;
    dem_error error;
    dem_sheet *sheet = dem_sheet_create(in_folder("many.png"));
    for (int i = 0; i < 401; i++) {
        dem_image none = {0};
        check_ok(dem_sheet_add(sheet, &none, "name", "note", &error), error);
    }
    check_ok(dem_sheet_finish(sheet, &error), error);
    check_size(in_folder("many.png"), 16 * 248 + 8, 25 * 158 + 8);
    check_size(in_folder("many-2.png"), 248 + 8, 158 + 8);
    check(!exists(in_folder("many-3.png")));
    sheet = dem_sheet_create(in_folder("none.png"));
    check_ok(dem_sheet_finish(sheet, &error), error);
    check(!exists(in_folder("none.png")));
    dem_image none = {0};
    sheet = dem_sheet_create(in_folder("no/such/folder.png"));
    check_ok(dem_sheet_add(sheet, &none, "", "", &error), error);
    check(dem_sheet_finish(sheet, &error) == DEM_CANNOT_WRITE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sheet_is_as_large_as_its_cells_need),
        cmocka_unit_test(many_cells_take_pages),
    };
    return cmocka_run_group_tests_name("sheet", tests, make_folder, remove_folder);
}
