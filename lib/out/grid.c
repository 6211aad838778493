#include "out/grid.h"

#include <math.h>
#include <string.h>

static const double NAME_SIZE = 1.0 / 24;  // of a name, over the breadth of its picture
static const double LEAST = 8, MOST = 30;  // [pixels]

static dem_grid grid_of(size_t count, int width, int height, size_t columns, bool names, double text_size)
{
    dem_grid s = {.count = count, .columns = columns, .width = width, .height = height};
    s.rows = (count + columns - 1) / columns;
    s.cell_width = width / (int)columns;
    s.text_size = text_size > 0 ? text_size : fmin(fmax(round(s.cell_width * NAME_SIZE), LEAST), MOST);
    s.name_height = names ? (int)ceil(2.4 * s.text_size) : 0;
    s.cell_height = height / (int)s.rows - s.name_height;
    return s;
}

dem_grid dem_grid_divide(size_t count, int width, int height, size_t columns, double aspect, bool names,
                         double text_size)
{
    count = count ? count : 1;
    if (columns)
        return grid_of(count, width, height, columns < count ? columns : count, names, text_size);
    dem_grid best = {0};
    double best_size = -1;
    for (size_t n = 1; n <= count && n <= (size_t)width; n++) {
        dem_grid s = grid_of(count, width, height, n, names, text_size);
        double size = fmin(s.cell_width, aspect * s.cell_height);
        if (size > best_size)
            best = s, best_size = size;
    }
    return best;
}

void dem_grid_cell(const dem_grid *s, size_t cell, int *left, int *top)
{
    *left = (int)(cell % s->columns) * s->cell_width + (s->width - (int)s->columns * s->cell_width) / 2;
    *top = (int)(cell / s->columns) * (s->cell_height + s->name_height);
}

void dem_image_paste(dem_image *image, const dem_image *part, int left, int top)
{
    int from = left < 0 ? -left : 0, to = part->width < image->width - left ? part->width : image->width - left;
    for (int y = 0; y < part->height && from < to; y++) {
        if (top + y < 0 || top + y >= image->height)
            continue;
        memcpy(image->pixels + 3 * ((size_t)(top + y) * (size_t)image->width + (size_t)(left + from)),
               part->pixels + 3 * ((size_t)y * (size_t)part->width + (size_t)from), 3 * (size_t)(to - from));
    }
}

void dem_image_fill(dem_image *image, dem_rgb colour)
{
    dem_fill_box(image, 0, 0, image->width, image->height, colour);
}

dem_status dem_grid_name(const dem_grid *s, dem_image *image, size_t cell, const char *name, dem_rgb ink,
                         dem_error *error)
{
    int left, top;
    char room[256];
    dem_text_style style = {.size = s->text_size, .ink = ink, .align = DEM_ALIGN_CENTRE};
    dem_grid_cell(s, cell, &left, &top);
    const char *text = dem_text_fit(name, s->text_size, s->cell_width - s->text_size, room, sizeof room);
    return dem_text_draw(image, left + s->cell_width / 2.0, top + s->cell_height + 1.35 * s->text_size, &style, text,
                         error);
}
