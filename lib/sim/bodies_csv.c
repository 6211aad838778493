#include "sim/bodies_csv.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/nearest.h"
#include "base/text.h"
#include "math/vec.h"

enum { MOST_COLUMNS = 64, NAME_BYTES = 256 };

// a column is the shape, a number of a body, or passed over
enum { SHAPE, IGNORED, NUMBERS };
typedef struct csv_column {
    const char *name;
    int kind;   // SHAPE, IGNORED, or NUMBERS
    size_t at;  // of the number in the body
} csv_column;

#define NUMBER(name, member)                                                                                           \
    {                                                                                                                  \
        name, NUMBERS, offsetof(dem_body_def, member)                                                                  \
    }
static const csv_column columns[] = {
    {"shape", SHAPE, 0},         NUMBER("x", position.x),      NUMBER("y", position.y),     NUMBER("z", position.z),
    NUMBER("qw", orientation.w), NUMBER("qx", orientation.x),  NUMBER("qy", orientation.y), NUMBER("qz", orientation.z),
    NUMBER("vx", velocity.x),    NUMBER("vy", velocity.y),     NUMBER("vz", velocity.z),    NUMBER("wx", spin.x),
    NUMBER("wy", spin.y),        NUMBER("wz", spin.z),         NUMBER("scale", scale),      {"id", IGNORED, 0},
    {"mass", IGNORED, 0},        {"coordination", IGNORED, 0},
};
enum { COLUMNS = sizeof columns / sizeof *columns, NEEDED = 4, FIRST_TURN = 4, LAST_TURN = 7 };

typedef struct named {
    const char *name;
    size_t length;
    uint32_t index;
} named;

typedef struct csv {
    const char *name;
    const char *at, *end;  // of the present line
    const char *next, *stop;
    long line;
    const csv_column *order[MOST_COLUMNS];
    size_t width;
    named *shapes;  // by name
    size_t shape_count;
    const named *last;  // most lines are of the same shape as the one before
    dem_error *error;
} csv;

static dem_status refuse(const csv *c, const char *what)
{
    return dem_fail_at(c->error, DEM_BAD_INPUT, c->name, c->line, "%s", what);
}

// ---- lines and cells

// false: the file is through. Blank lines and comments are passed over
static bool next_line(csv *c)
{
    while (c->next < c->stop) {
        const char *end = memchr(c->next, '\n', (size_t)(c->stop - c->next));
        c->at = c->next;
        c->end = end ? end : c->stop;
        c->next = end ? end + 1 : c->stop;
        c->line++;
        if (c->end > c->at && c->end[-1] == '\r')
            c->end--;
        while (c->at < c->end && (*c->at == ' ' || *c->at == '\t'))
            c->at++;
        if (c->at < c->end && *c->at != '#')
            return true;
    }
    return false;
}

static void skip_blanks(csv *c)
{
    while (c->at < c->end && (*c->at == ' ' || *c->at == '\t'))
        c->at++;
}

// a text up to the comma, or in quotes, in which "" is a quote; NULL: the quotes are not closed, or it is too long
static const char *take_text(csv *c, char spare[static NAME_BYTES], size_t *length)
{
    skip_blanks(c);
    if (c->at < c->end && *c->at == '"') {
        size_t used = 0;
        for (c->at++; c->at < c->end && used < NAME_BYTES; c->at++) {
            if (*c->at == '"' && c->at + 1 < c->end && c->at[1] == '"')
                c->at++;
            else if (*c->at == '"')
                break;
            spare[used++] = *c->at;
        }
        if (c->at == c->end || *c->at != '"')
            return NULL;
        c->at++;
        skip_blanks(c);
        *length = used;
        return spare;
    }
    const char *begin = c->at;
    while (c->at < c->end && *c->at != ',')
        c->at++;
    const char *end = c->at;
    while (end > begin && (end[-1] == ' ' || end[-1] == '\t'))
        end--;
    *length = (size_t)(end - begin);
    return begin;
}

// ---- the first line

static const char *column_name(const void *user, size_t index)
{
    (void)user;
    return index < COLUMNS ? columns[index].name : NULL;
}

static dem_status refuse_column(const csv *c, const char *name, size_t length)
{
    char typed[60];
    snprintf(typed, sizeof typed, "%.*s", (int)(length < sizeof typed ? length : sizeof typed - 1), name);
    const char *near = dem_nearest(typed, column_name, NULL);
    if (near)
        return dem_fail_at(c->error, DEM_BAD_INPUT, c->name, c->line, "unknown column \"%s\"; did you mean \"%s\"?",
                           typed, near);
    return dem_fail_at(c->error, DEM_BAD_INPUT, c->name, c->line,
                       "unknown column \"%s\"; columns are shape, x, y, z, qw to qz, vx to vz, wx to wz, scale", typed);
}

static dem_status read_column(csv *c)
{
    char spare[NAME_BYTES];
    size_t length;
    const char *name = take_text(c, spare, &length);
    if (!name)
        return refuse(c, "a name in quotes is not closed; add the other quote");
    const csv_column *found = NULL;
    for (size_t i = 0; i < COLUMNS && !found; i++)
        if (strlen(columns[i].name) == length && memcmp(columns[i].name, name, length) == 0)
            found = &columns[i];
    if (!found)
        return refuse_column(c, name, length);
    for (size_t i = 0; i < c->width; i++)
        if (c->order[i] == found)
            return dem_fail_at(c->error, DEM_BAD_INPUT, c->name, c->line, "column \"%s\" stands twice; remove one",
                               found->name);
    if (c->width == MOST_COLUMNS)
        return refuse(c, "too many columns; remove some");
    c->order[c->width++] = found;
    return DEM_OK;
}

static bool has_column(const csv *c, const csv_column *wanted)
{
    for (size_t i = 0; i < c->width; i++)
        if (c->order[i] == wanted)
            return true;
    return false;
}

static dem_status read_header(csv *c)
{
    if (!next_line(c))
        return refuse(c, "has no line of column names; begin with shape,x,y,z");
    for (;;) {
        DEM_TRY(read_column(c));
        if (c->at == c->end)
            break;
        if (*c->at != ',')
            return refuse(c, "a comma is missing behind a name in quotes; separate columns by commas");
        c->at++;
    }
    int turns = 0;
    for (int i = FIRST_TURN; i <= LAST_TURN; i++)
        turns += has_column(c, &columns[i]);
    for (int i = 0; i < COLUMNS; i++) {
        bool needed = i < NEEDED || (turns && i >= FIRST_TURN && i <= LAST_TURN);
        if (needed && !has_column(c, &columns[i]))
            return dem_fail_at(c->error, DEM_BAD_INPUT, c->name, c->line, "column \"%s\" is missing; add it",
                               columns[i].name);
    }
    return DEM_OK;
}

// ---- bodies

static int compare(const char *a, size_t a_length, const char *b, size_t b_length)
{
    int order = memcmp(a, b, a_length < b_length ? a_length : b_length);
    return order ? order : (a_length > b_length) - (a_length < b_length);
}

static int compare_named(const void *a, const void *b)
{
    const named *x = a, *y = b;
    return compare(x->name, x->length, y->name, y->length);
}

static dem_status index_shapes(csv *c, const dem_shape_def *shapes, size_t count)
{
    c->shapes = dem_alloc(count, sizeof *c->shapes);
    if (!c->shapes)
        return dem_fail_memory(c->error);
    for (size_t i = 0; i < count; i++)
        c->shapes[i] = (named){shapes[i].name, strlen(shapes[i].name), (uint32_t)i};
    c->shape_count = count;
    qsort(c->shapes, count, sizeof *c->shapes, compare_named);
    return DEM_OK;
}

static const char *shape_name(const void *user, size_t index)
{
    const csv *c = user;
    return index < c->shape_count ? c->shapes[index].name : NULL;
}

static dem_status refuse_shape(const csv *c, const char *name, size_t length)
{
    char typed[60];
    snprintf(typed, sizeof typed, "%.*s", (int)(length < sizeof typed ? length : sizeof typed - 1), name);
    const char *near = dem_nearest(typed, shape_name, c);
    return dem_fail_at(c->error, DEM_BAD_INPUT, c->name, c->line,
                       "column \"shape\": the scene has no shape \"%s\"; %s%s%s", typed,
                       near ? "did you mean \"" : "add it to shapes", near ? near : "", near ? "\"?" : "");
}

static dem_status read_shape(csv *c, dem_body_def *body)
{
    char spare[NAME_BYTES];
    named wanted = {0};
    wanted.name = take_text(c, spare, &wanted.length);
    if (!wanted.name)
        return refuse(c, "column \"shape\": a name in quotes is not closed; add the other quote");
    if (!c->last || compare_named(c->last, &wanted) != 0)
        c->last = bsearch(&wanted, c->shapes, c->shape_count, sizeof *c->shapes, compare_named);
    if (!c->last)
        return refuse_shape(c, wanted.name, wanted.length);
    body->shape = c->last->index;
    return DEM_OK;
}

static dem_status read_number(csv *c, const csv_column *column, dem_body_def *body)
{
    double *value = (double *)((char *)body + column->at);
    skip_blanks(c);
    const char *begin = c->at, *behind = dem_parse_double(begin, c->end, value);
    if (behind)
        c->at = behind;
    skip_blanks(c);
    if (behind && isfinite(*value) && fabs(*value) <= 1e100 && (c->at == c->end || *c->at == ','))
        return DEM_OK;
    const char *end = begin;
    while (end < c->end && *end != ',' && end - begin < 60)
        end++;
    return dem_fail_at(c->error, DEM_BAD_INPUT, c->name, c->line, "column \"%s\": \"%.*s\" is not a finite number; %s",
                       column->name, (int)(end - begin), begin, "write it in SI units, with a point");
}

static void skip_cell(csv *c)
{
    bool quoted = false;
    for (; c->at < c->end && (quoted || *c->at != ','); c->at++)
        quoted ^= *c->at == '"';
}

bool dem_quat_normalise(dem_quat *q)
{
    double size = fmax(fmax(fabs(q->w), fabs(q->x)), fmax(fabs(q->y), fabs(q->z)));
    if (!(size > 0 && size <= 1e100))
        return false;
    double w = q->w / size, x = q->x / size, y = q->y / size, z = q->z / size;
    double norm = sqrt(w * w + x * x + y * y + z * z);
    if (!(fabs(norm * size - 1) <= 1e-14))
        *q = (dem_quat){w / norm, x / norm, y / norm, z / norm};
    return true;
}

static dem_status read_body(csv *c, dem_body_def *body)
{
    *body = (dem_body_def){.scale = 1, .orientation = {1, 0, 0, 0}};
    for (size_t i = 0; i < c->width; i++) {
        const csv_column *column = c->order[i];
        if (i > 0 && (c->at == c->end || *c->at != ','))
            return dem_fail_at(c->error, DEM_BAD_INPUT, c->name, c->line,
                               "column \"%s\" is missing, the line has %zu of %zu; complete it", column->name, i,
                               c->width);
        c->at += i > 0;
        if (column->kind == SHAPE)
            DEM_TRY(read_shape(c, body));
        else if (column->kind == NUMBERS)
            DEM_TRY(read_number(c, column, body));
        else
            skip_cell(c);
    }
    if (c->at < c->end)
        return refuse(c, "has more columns than the first line; remove what is too much");
    if (!dem_quat_normalise(&body->orientation))
        return refuse(c, "columns \"qw\" to \"qz\": all are 0; write 1,0,0,0 for no rotation");
    return body->scale > 0 ? DEM_OK : refuse(c, "column \"scale\": must be above 0; correct it");
}

dem_status dem_bodies_csv_parse(const char *text, size_t size, const char *name, const dem_shape_def *shapes,
                                size_t shape_count, dem_body_def **bodies, size_t *count, size_t *capacity,
                                dem_error *error)
{
    csv c = {.name = name, .next = text, .stop = text + size, .error = error};
    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0)
        c.next += 3;
    DEM_TRY(read_header(&c));
    DEM_TRY(index_shapes(&c, shapes, shape_count));
    dem_status status = DEM_OK;
    while (status == DEM_OK && next_line(&c)) {
        if (dem_grow(bodies, capacity, *count, sizeof **bodies))
            status = read_body(&c, &(*bodies)[*count]);
        else
            status = dem_fail_memory(error);
        *count += status == DEM_OK;
    }
    free(c.shapes);
    return status;
}
