#include "out/sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "out/grid.h"

enum { PAGE_CELLS = 400, WIDTH = 240, HEIGHT = 120, GAP = 8, CAPTION = 30 };
enum { TITLE_LINE = 12, NOTE_LINE = 26 };  // of writing, under the picture

static const double TITLE_SIZE = 8, NOTE_SIZE = 7;
static const dem_rgb INK = {40, 40, 40}, PALE = {120, 120, 120}, ALARM = {180, 40, 30}, WHITE = {255, 255, 255};

typedef struct sheet_cell {
    dem_image picture;
    char title[128], note[128];
} sheet_cell;

struct dem_sheet {
    char *path;
    size_t pages, count;
    sheet_cell cells[PAGE_CELLS];
};

dem_sheet *dem_sheet_create(const char *path)
{
    dem_sheet *sheet = dem_alloc_zero(1, sizeof *sheet);
    if (sheet && !(sheet->path = strdup(path))) {
        free(sheet);
        return NULL;
    }
    return sheet;
}

static dem_status put_line(dem_image *page, int x, int y, double size, dem_rgb ink, const char *text, dem_error *error)
{
    char room[160];
    const dem_text_style style = {.size = size, .ink = ink, .align = DEM_ALIGN_CENTRE};
    return dem_text_draw(page, x + WIDTH / 2.0, y, &style, dem_text_fit(text, size, WIDTH, room, sizeof room), error);
}

static dem_status put_cell(dem_image *page, const sheet_cell *cell, int x, int y, dem_error *error)
{
    if (cell->picture.pixels)
        dem_image_paste(page, &cell->picture, x, y);
    DEM_TRY(put_line(page, x, y + HEIGHT + TITLE_LINE, TITLE_SIZE, INK, cell->title, error));
    return put_line(page, x, y + HEIGHT + NOTE_LINE, NOTE_SIZE, cell->picture.pixels ? PALE : ALARM, cell->note, error);
}

static dem_status write_page(const dem_sheet *sheet, const dem_image *page, dem_error *error)
{
    dem_buffer png = {0};
    dem_status status = dem_png_encode(page, &png, error);
    if (status != DEM_OK) {
        dem_buffer_release(&png);
        return status;
    }
    if (sheet->pages == 0)
        return dem_file_write_buffer(sheet->path, &png, error);
    const char *dot = strrchr(dem_file_name(sheet->path), '.');
    size_t stem = dot ? (size_t)(dot - sheet->path) : strlen(sheet->path), room = strlen(sheet->path) + 24;
    char *path = malloc(room);
    if (path) {
        snprintf(path, room, "%.*s-%zu%s", (int)stem, sheet->path, sheet->pages + 1, dot ? dot : "");
        status = dem_file_write_buffer(path, &png, error);
    } else {
        dem_buffer_release(&png);
        status = dem_fail_memory(error);
    }
    free(path);
    return status;
}

// about as wide as high
static dem_status finish_page(dem_sheet *sheet, dem_error *error)
{
    int count = (int)sheet->count, cell_height = HEIGHT + CAPTION + GAP;
    int columns = (int)ceil(sqrt((double)count * cell_height / (WIDTH + GAP))), rows = (count + columns - 1) / columns;
    dem_image page;
    dem_status status = dem_image_create(columns * (WIDTH + GAP) + GAP, rows * cell_height + GAP, &page, error);
    if (status == DEM_OK)
        dem_image_fill(&page, WHITE);
    for (int i = 0; i < count; i++) {
        sheet_cell *cell = &sheet->cells[i];
        int x = GAP + i % columns * (WIDTH + GAP), y = GAP + i / columns * cell_height;
        if (status == DEM_OK)
            status = put_cell(&page, cell, x, y, error);
        dem_image_free(&cell->picture);
    }
    if (status == DEM_OK)
        status = write_page(sheet, &page, error);
    dem_image_free(&page);
    sheet->pages++;
    sheet->count = 0;
    return status;
}

dem_status dem_sheet_add(dem_sheet *sheet, dem_image *picture, const char *title, const char *note, dem_error *error)
{
    // a page is finished when the next cell comes, so that the last one is never empty
    dem_status status = sheet->count == PAGE_CELLS ? finish_page(sheet, error) : DEM_OK;
    sheet_cell *cell = &sheet->cells[sheet->count++];
    cell->picture = *picture;
    *picture = (dem_image){0};
    snprintf(cell->title, sizeof cell->title, "%s", title);
    snprintf(cell->note, sizeof cell->note, "%s", note);
    return status;
}

dem_status dem_sheet_finish(dem_sheet *sheet, dem_error *error)
{
    dem_status status = sheet->count ? finish_page(sheet, error) : DEM_OK;
    free(sheet->path);
    free(sheet);
    return status;
}
