// What the texts of the command line mean.
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/vec.h"
#include "out/field.h"
#include "view.h"

// ---- the picture

static dem_status choose_size(const view_arguments *a, view_choices *c, dem_error *error)
{
    c->width = (int)a->width;
    c->height = (int)a->height;
    if (!a->size)
        return DEM_OK;
    const char *end = a->size + strlen(a->size);
    long width, height;
    const char *at = dem_parse_long(a->size, end, &width);
    at = at && (*at == 'x' || *at == 'X') ? dem_parse_long(at + 1, end, &height) : NULL;
    if (!at || *at || width < 16 || height < 16 || width > 16384 || height > 16384)
        return dem_fail(error, DEM_USAGE,
                        "--size '%.40s' is no size; write WIDTHxHEIGHT in pixels from 16 to 16384, as in 1600x900",
                        a->size);
    c->width = (int)width;
    c->height = (int)height;
    return DEM_OK;
}

static int hex(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

static dem_status choose_background(const char *text, uint8_t rgb[3], dem_error *error)
{
    static const struct {
        const char *name;
        uint8_t rgb[3];
    } names[] = {
        {"white", {255, 255, 255}}, {"black", {0, 0, 0}}, {"grey", {128, 128, 128}}, {"gray", {128, 128, 128}}};
    if (!text)
        text = "white";
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(text, names[i].name) == 0) {
            memcpy(rgb, names[i].rgb, 3);
            return DEM_OK;
        }
    bool good = text[0] == '#' && strlen(text) == 7;
    for (int k = 0; k < 3 && good; k++) {
        int high = hex(text[1 + 2 * k]), low = hex(text[2 + 2 * k]);
        good = high >= 0 && low >= 0;
        rgb[k] = good ? (uint8_t)(16 * high + low) : 0;
    }
    if (!good)
        return dem_fail(error, DEM_USAGE, "--background '%.40s' is no colour; take white, black, grey or \"#f4f1ea\"",
                        text);
    return DEM_OK;
}

static dem_status choose_up(const char *text, view_choices *c, dem_error *error)
{
    c->up = v3(0, 0, 1);
    c->up_given = text;
    if (!text)
        return DEM_OK;
    double sign = *text == '-' ? -1 : 1;
    const char *axis = *text == '-' || *text == '+' ? text + 1 : text;
    if (strlen(axis) != 1 || !strchr("xyz", *axis))
        return dem_fail(error, DEM_USAGE, "--up must be x, y, z, -x, -y or -z, not '%.40s'", text);
    c->up = v3_scale(v3(*axis == 'x', *axis == 'y', *axis == 'z'), sign);
    return DEM_OK;
}

// three lengths; a unit behind the last is also that of bare ones
static dem_status choose_point(const char *text, dem_vec3 *point, dem_error *error)
{
    *point = v3(NAN, NAN, NAN);
    if (!text)
        return DEM_OK;
    char parts[3][64], unit[32] = "";
    const char *at = text;
    for (int k = 0; k < 3; k++) {
        size_t length = strcspn(at, ",");
        if (length >= sizeof parts[k] - sizeof unit || (at[length] == ',') != (k < 2))
            return dem_fail(error, DEM_USAGE, "--look-at '%.60s' is no point; write \"0,0,5mm\"", text);
        snprintf(parts[k], sizeof parts[k], "%.*s", (int)length, at);
        at += length + (k < 2);
    }
    double number;
    const char *rest = dem_parse_double(parts[2], parts[2] + strlen(parts[2]), &number);
    if (rest)
        snprintf(unit, sizeof unit, "%.31s", rest);
    for (int k = 0; k < 3; k++) {
        double value;
        rest = dem_parse_double(parts[k], parts[k] + strlen(parts[k]), &number);
        if (rest && !*rest)
            strcat(parts[k], unit);
        DEM_TRY(dem_quantity(parts[k], DEM_DIMENSION_LENGTH, &value, error));
        v3_set(point, k, value);
    }
    return DEM_OK;
}

dem_status view_choose(const view_arguments *a, view_choices *c, dem_error *error)
{
    *c = (view_choices){.arguments = a, .unit = NAN};
    DEM_TRY(choose_size(a, c, error));
    DEM_TRY(choose_background(a->background, c->background, error));
    DEM_TRY(choose_up(a->up, c, error));
    DEM_TRY(choose_point(a->look_at, &c->look_at, error));
    c->light = dem_colour_of_srgb(c->background[0], c->background[1], c->background[2]);
    c->camera_given = c->up_given || !isnan(a->azimuth) || !isnan(a->elevation);
    return a->unit ? dem_unit(a->unit, DEM_DIMENSION_LENGTH, &c->unit, error) : DEM_OK;
}

// ---- values

// a number with a unit of the field; `borrowed`: the unit of a bare one
static dem_status read_value(const char *text, size_t length, const char *unit, const char *borrowed, double *value,
                             dem_error *error)
{
    char one[96];
    double number;
    snprintf(one, sizeof one, "%.*s", (int)(length < 60 ? length : 60), text);
    const char *rest = dem_parse_double(one, one + strlen(one), &number);
    while (rest && isspace((unsigned char)*rest))
        rest++;
    if (borrowed && rest && !*rest)
        snprintf(one + strlen(one), sizeof one - strlen(one), " %.30s", borrowed);
    return dem_quantity(one, dem_field_dimension(unit), value, error);
}

dem_status view_range(const char *text, const char *unit, double *low, double *high, dem_error *error)
{
    *low = *high = NAN;
    if (!text)
        return DEM_OK;
    const char *dots = strstr(text, "..");
    if (!dots)
        return dem_fail(error, DEM_USAGE, "--range '%.40s' is no range; write LOW..HIGH, as in \"0..2 mm\"", text);
    const char *second = dots + 2, *end = second + strlen(second), *borrowed = NULL;
    while (*second == ' ')
        second++;
    if (*second) {
        double number;
        DEM_TRY(read_value(second, strlen(second), unit, NULL, high, error));
        borrowed = dem_parse_double(second, end, &number);
    }
    if (dots > text)
        DEM_TRY(read_value(text, (size_t)(dots - text), unit, borrowed, low, error));
    if (*low > *high || *low == *high)
        return dem_fail(error, DEM_USAGE, "--range '%.40s' ends before it begins; write LOW..HIGH", text);
    return DEM_OK;
}

dem_status view_clip(const char *text, const dem_field_source *source, unsigned char *hidden, dem_error *error)
{
    size_t length = strcspn(text, "<>"), from = 0, to = length;
    char name[96];
    double limit;
    while (from < to && text[from] == ' ')
        from++;
    while (to > from && text[to - 1] == ' ')
        to--;
    if (!text[length] || to == from || to - from >= sizeof name)
        return dem_fail(error, DEM_USAGE,
                        "--clip '%.60s' is no condition; write FIELD<VALUE or FIELD>VALUE, as in "
                        "\"x<5mm\"",
                        text);
    snprintf(name, sizeof name, "%.*s", (int)(to - from), text + from);
    bool below = text[length] == '<', equal = text[length + 1] == '=';
    dem_field field;
    DEM_TRY(dem_field_make(name, source, &field, error));
    const char *value = text + length + 1 + equal;
    while (*value == ' ')
        value++;
    dem_status status = read_value(value, strlen(value), field.unit, NULL, &limit, error);
    for (size_t i = 0; i < source->bodies->count && status == DEM_OK; i++) {
        double v = field.values[i];
        hidden[i] |= below ? v < limit || (equal && v == limit) : v > limit || (equal && v == limit);
    }
    free(field.values);
    return status;
}

// "A", "A-B" or "A-" at *at, numbers up to `last`
static bool read_span(const char **at, size_t last, size_t *from, size_t *to)
{
    long a, b;
    const char *end = *at + strlen(*at), *next = **at >= '0' && **at <= '9' ? dem_parse_long(*at, end, &a) : NULL;
    if (!next)
        return false;
    *from = (size_t)a;
    *to = *from;
    if (*next == '-') {
        next++;
        *to = last;
        if (*next >= '0' && *next <= '9') {
            next = dem_parse_long(next, end, &b);
            *to = (size_t)b;
        }
    }
    *at = next;
    return next && *from <= *to;
}

dem_status view_subset(const char *text, size_t count, unsigned char *hidden, dem_error *error)
{
    unsigned char *kept = dem_alloc_zero(count, 1);
    if (!kept)
        return dem_fail_memory(error);
    const char *at = text;
    size_t from, to, last = count ? count - 1 : 0;
    bool good = true;
    while ((good = read_span(&at, last, &from, &to))) {
        for (size_t i = from; i <= to && i < count; i++)
            kept[i] = 1;
        if (*at != ',')
            break;
        at++;
    }
    for (size_t i = 0; i < count; i++)
        hidden[i] |= !kept[i];
    free(kept);
    if (!good || *at)
        return dem_fail(error, DEM_USAGE, "--bodies '%.60s' is no list of numbers; write \"0-99,200,300-\"", text);
    return DEM_OK;
}

// ---- frames

dem_status view_frames(const char *text, size_t count, size_t **numbers, size_t *selected, dem_error *error)
{
    const char *at = text;
    size_t from = 0, to = count ? count - 1 : 0;
    long every = 1;
    bool good = true;
    if (strncmp(at, "all", 3) == 0)
        at += 3;
    else if (*at >= '0' && *at <= '9')
        good = read_span(&at, to, &from, &to);
    while (good && *at == ' ')
        at++;
    if (good && strncmp(at, "every", 5) == 0) {
        at += 5;
        while (*at == ' ')
            at++;
        at = dem_parse_long(at, at + strlen(at), &every);
        good = at && every >= 1;
    }
    if (!good || *at || at == text)
        return dem_fail(error, DEM_USAGE,
                        "--frames '%.40s' tells no frames; write all, 10-50, \"every 5\" or \"10-50 every 5\"", text);
    if (count == 0)
        return dem_fail(error, DEM_BAD_INPUT, "the run has no frames; give its scene an interval (output.frames)");
    if (to >= count)
        return dem_fail(error, DEM_USAGE, "--frames '%.40s': the run has only %zu frames, counted from 0", text, count);
    *numbers = dem_alloc((to - from) / (size_t)every + 1, sizeof **numbers);
    if (!*numbers)
        return dem_fail_memory(error);
    *selected = 0;
    for (size_t i = from; i <= to; i += (size_t)every)
        (*numbers)[(*selected)++] = i;
    return DEM_OK;
}

// the place of "%d", "%4d" or "%04d"; NULL: there is none
static const char *find_place(const char *name, size_t *length, int *digits)
{
    const char *at = strchr(name, '%');
    if (!at)
        return NULL;
    const char *end = at + 1;
    *digits = 0;
    for (; *end >= '0' && *end <= '9' && *digits < 100; end++)
        *digits = 10 * *digits + (*end - '0');
    *length = (size_t)(end + 1 - at);
    return *end == 'd' && *digits <= 20 && !strchr(end, '%') ? at : NULL;
}

bool view_is_pattern(const char *name)
{
    size_t length;
    int digits;
    return find_place(name, &length, &digits);
}

char *view_numbered(const char *pattern, size_t number)
{
    size_t length = 0;
    int digits = 0;
    const char *place = find_place(pattern, &length, &digits);
    dem_buffer name = {0};
    if (!place)
        return strdup(pattern);
    dem_buffer_bytes(&name, pattern, (size_t)(place - pattern));
    dem_buffer_print(&name, "%0*zu%s", digits, number, place + length);
    return name.data;
}
