// Tables of a wall's motion: CSV with the columns time, x, y, z, angle (SI units), time and one other at least.
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "sim/scene_wall.h"

enum { TIME, SHIFT_X, SHIFT_Y, SHIFT_Z, ANGLE, COLUMNS };
static const char *const names[COLUMNS] = {"time", "x", "y", "z", "angle"};

typedef struct csv {
    const char *name, *at, *end;
    long line;
    int order[COLUMNS];  // of the columns of the file
    int width;
    double (*rows)[COLUMNS];
    size_t count, capacity;
    dem_error *error;
} csv;

static dem_status refuse(const csv *c, const char *what)
{
    return dem_fail_at(c->error, DEM_BAD_INPUT, c->name, c->line, "%s", what);
}

// a line, without blank ones and comments; false: the file is through
static bool next_line(csv *c, const char **line, const char **end)
{
    while (c->at < c->end) {
        const char *stop = memchr(c->at, '\n', (size_t)(c->end - c->at));
        *line = c->at;
        *end = stop ? stop : c->end;
        c->at = stop ? stop + 1 : c->end;
        c->line++;
        while (*line < *end && (**line == ' ' || **line == '\t'))
            ++*line;
        while (*end > *line && ((*end)[-1] == '\r' || (*end)[-1] == ' ' || (*end)[-1] == '\t'))
            --*end;
        if (*line < *end && **line != '#')
            return true;
    }
    return false;
}

static dem_status read_names(csv *c, const char *line, const char *end)
{
    bool found[COLUMNS] = {false};
    for (const char *at = line; at <= end;) {
        const char *comma = at < end ? memchr(at, ',', (size_t)(end - at)) : NULL, *stop = comma ? comma : end;
        while (at < stop && (*at == ' ' || *at == '\t'))
            at++;
        const char *last = stop;
        while (last > at && (last[-1] == ' ' || last[-1] == '\t'))
            last--;
        size_t length = (size_t)(last - at);
        int k = 0;
        while (k < COLUMNS && !(strlen(names[k]) == length && memcmp(names[k], at, length) == 0))
            k++;
        if (k == COLUMNS)
            return refuse(c, "unknown column; the columns are time, x, y, z (m) and angle (rad)");
        if (found[k])
            return refuse(c, "a column stands twice; remove one");
        found[k] = true;
        c->order[c->width++] = k;
        at = stop + 1;
    }
    return found[TIME] && c->width > 1 ? DEM_OK
                                       : refuse(c, "needs the column time and one of x, y, z, angle; add them");
}

static dem_status read_row(csv *c, const char *line, const char *end)
{
    if (!dem_grow(&c->rows, &c->capacity, c->count, sizeof *c->rows))
        return dem_fail_memory(c->error);
    double *row = c->rows[c->count];
    memset(row, 0, sizeof *c->rows);
    const char *at = line;
    for (int k = 0; k < c->width; k++) {
        while (at < end && (*at == ' ' || *at == '\t'))
            at++;
        at = dem_parse_double(at, end, &row[c->order[k]]);
        if (!at || !(fabs(row[c->order[k]]) <= 1e100))
            return refuse(c, "holds something that is no number; write one number for each column");
        while (at < end && (*at == ' ' || *at == '\t'))
            at++;
        if (k + 1 < c->width ? at == end || *at != ',' : at != end)
            return refuse(c, "has another number of columns than the first line; write one number for each column");
        at++;
    }
    if (c->count && !(row[TIME] > c->rows[c->count - 1][TIME]))
        return refuse(c, "times must rise; order the rows by time");
    c->count++;
    return DEM_OK;
}

static dem_status parse(csv *c)
{
    const char *line, *end;
    if (!next_line(c, &line, &end))
        return refuse(c, "is empty; begin with the line time,x,y,z");
    DEM_TRY(read_names(c, line, end));
    while (next_line(c, &line, &end))
        DEM_TRY(read_row(c, line, end));
    return c->count ? DEM_OK : refuse(c, "has no rows; add some");
}

static dem_status keep(dem_scene_reader *r, const csv *c, dem_wall_table *table)
{
    double *time = dem_scene_take(r, c->count, sizeof *time), *turn = dem_scene_take(r, c->count, sizeof *turn);
    dem_vec3 *shift = dem_scene_take(r, c->count, sizeof *shift);
    if (!time || !turn || !shift)
        return dem_fail_memory(r->error);
    bool turns = false;
    for (size_t i = 0; i < c->count; i++) {
        const double *row = c->rows[i];
        time[i] = row[TIME];
        shift[i] = v3(row[SHIFT_X], row[SHIFT_Y], row[SHIFT_Z]);
        turn[i] = row[ANGLE];
        turns |= turn[i] != 0;
    }
    *table = (dem_wall_table){table->file, table->cubic, c->count, time, shift, turns ? turn : NULL};
    return DEM_OK;
}

dem_status dem_wall_read_table(dem_scene_reader *r, const dem_scene_value *v, dem_wall_table *table)
{
    (void)v;
    dem_buffer text;
    DEM_TRY(dem_file_read(table->file, &text, r->error));
    csv c = {.name = table->file, .at = text.data, .end = text.data + text.size, .error = r->error};
    dem_status status = parse(&c);
    if (status == DEM_OK)
        status = keep(r, &c, table);
    free(c.rows);
    dem_buffer_release(&text);
    return status;
}
