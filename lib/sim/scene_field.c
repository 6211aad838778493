// The readers of single values that tables of keys name.
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "math/vec.h"
#include "sim/scene_reader.h"

// squares and products of larger numbers leave the range of doubles
static const double LARGEST = 1e100;

// ---- numbers

static void print_range(dem_range range, char text[static 120])
{
    char low[32], high[32];
    dem_format_double(low, sizeof low, range.low, 15);
    dem_format_double(high, sizeof high, range.high, 15);
    const char *from = range.above ? "above" : "at least", *to = range.below ? "below" : "at most";
    if (isinf(range.high))
        snprintf(text, 120, "must be %s %s", from, low);
    else
        snprintf(text, 120, "must be %s %s and %s %s", from, low, to, high);
}

static dem_status check_range(dem_scene_reader *r, const dem_scene_value *v, dem_range range, double value)
{
    bool any = range.low == 0 && range.high == 0;
    bool low = range.above ? value > range.low : value >= range.low;
    bool high = range.below ? value < range.high : value <= range.high;
    char number[32], must[120];
    dem_format_double(number, sizeof number, value, 15);
    if (!(fabs(value) <= LARGEST))
        return dem_scene_refuse(r, v, "check the number and its unit", "%s is beyond 1e100", number);
    if (any || (low && high))
        return DEM_OK;
    print_range(range, must);
    return dem_scene_refuse(r, v, "correct it", "%s, not %s", must, number);
}

dem_status dem_read_quantity(dem_scene_reader *r, const dem_scene_value *v, dem_dimension dimension, dem_range range,
                             double *value)
{
    const char *text = dem_json_string(v->json);
    dem_error inner;
    if (text && dem_quantity(text, dimension, value, &inner) != DEM_OK)
        return dem_scene_pass_on(r, v, &inner);
    if (!text && !dem_json_number(v->json, value)) {
        char advice[120];
        bool pure = dimension == DEM_DIMENSION_NONE;
        snprintf(advice, sizeof advice,
                 pure ? "write it as in %s" : "write a number in SI units or a text as in \"%s\"",
                 dem_dimension_example(dimension));
        return dem_scene_refuse(r, v, advice, "needs %s", dem_dimension_name(dimension));
    }
    return check_range(r, v, range, *value);
}

dem_status dem_field_quantity(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    return dem_read_quantity(r, v, field->dimension, field->range, into);
}

dem_status dem_read_array(dem_scene_reader *r, const dem_scene_value *v, size_t count, const char *what)
{
    if (dem_json_is_array(v->json) && dem_json_length(v->json) == count)
        return DEM_OK;
    return dem_scene_refuse(r, v, "separate them by commas", "needs a list of %zu: %s", count, what);
}

dem_status dem_field_vector(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    double xyz[3];
    DEM_TRY(dem_read_array(r, v, 3, "[x, y, z]"));
    for (size_t i = 0; i < 3; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(dem_read_quantity(r, &item, field->dimension, field->range, &xyz[i]));
    }
    *(dem_vec3 *)into = v3(xyz[0], xyz[1], xyz[2]);
    return DEM_OK;
}

dem_status dem_field_direction(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_vec3 direction;
    DEM_TRY(dem_field_vector(r, v, field, &direction));
    double size = fmax(fabs(direction.x), fmax(fabs(direction.y), fabs(direction.z)));
    if (!(size > 0))
        return dem_scene_refuse(r, v, "give a direction, as in [0, 0, 1]", "has no length");
    // one that is a unit vector already keeps its bits, so that it can be written and read again
    if (!(fabs(v3_norm(direction) - 1) <= 1e-14))
        direction = v3_unit(v3(direction.x / size, direction.y / size, direction.z / size));
    *(dem_vec3 *)into = direction;
    return DEM_OK;
}

dem_status dem_field_whole(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    int64_t whole;
    double number;
    // 1e6 is a whole number too
    if (!dem_json_whole(v->json, &whole)) {
        if (!dem_json_number(v->json, &number) || number != floor(number) || fabs(number) > 0x1p53)
            return dem_scene_refuse(r, v, "write it without quotes, as in 5", "needs a whole number");
        whole = (int64_t)number;
    }
    DEM_TRY(check_range(r, v, field->range, (double)whole));
    *(uint64_t *)into = (uint64_t)whole;
    return DEM_OK;
}

// ---- flags, texts, names

dem_status dem_field_flag(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)field;
    if (!dem_json_bool(v->json, into))
        return dem_scene_refuse(r, v, "write it without quotes", "must be true or false");
    return DEM_OK;
}

dem_status dem_field_text(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)field;
    const char *text = *(const char **)into = dem_json_string(v->json);
    if (!text)
        return dem_scene_refuse(r, v, "put it in quotes", "needs a text");
    return DEM_OK;
}

static const char *choice_name(const void *user, size_t index)
{
    for (const dem_choice *c = user; c->name; c++)
        if (c->value != DEM_NOT_BUILT && index-- == 0)
            return c->name;
    return NULL;
}

static dem_status refuse_unbuilt(dem_scene_reader *r, const dem_scene_value *v, const char *what)
{
    return dem_scene_refuse(r, v, "leave it out", "%s is not built yet", what);
}

dem_status dem_field_choice(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    const char *text;
    char quoted[80];
    DEM_TRY(dem_field_text(r, v, field, &text));
    for (const dem_choice *c = field->choices; c->name; c++) {
        if (strcmp(c->name, text) != 0)
            continue;
        snprintf(quoted, sizeof quoted, "\"%s\"", text);
        if (c->value == DEM_NOT_BUILT)
            return refuse_unbuilt(r, v, quoted);
        *(int *)into = c->value;
        return DEM_OK;
    }
    return dem_scene_unknown(r, v, DEM_JSON_VALUE, field->name, text, choice_name, field->choices);
}

static const char *material_name(const void *user, size_t index)
{
    const dem_scene *scene = user;
    return index < scene->material_count ? scene->materials[index].name : NULL;
}

static const char *shape_name(const void *user, size_t index)
{
    const dem_scene *scene = user;
    return index < scene->shape_count ? scene->shapes[index].name : NULL;
}

static dem_status read_name(dem_scene_reader *r, const dem_scene_value *v, const char *what,
                            const char *(*next)(const void *user, size_t index), uint32_t *index)
{
    const char *text, *name;
    DEM_TRY(dem_field_text(r, v, NULL, &text));
    for (size_t i = 0; (name = next(r->scene, i)); i++)
        if (strcmp(name, text) == 0) {
            *index = (uint32_t)i;
            return DEM_OK;
        }
    return dem_scene_unknown(r, v, DEM_JSON_VALUE, what, text, next, r->scene);
}

dem_status dem_field_material(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)field;
    return read_name(r, v, "material", material_name, into);
}

dem_status dem_field_shape(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)field;
    return read_name(r, v, "shape", shape_name, into);
}

dem_status dem_field_path(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    const char *path;
    DEM_TRY(dem_field_text(r, v, field, &path));
    if (!r->folder)
        return dem_scene_refuse(r, v, "give the values themselves", "files are not read here");
    if (!*path)
        return dem_scene_refuse(r, v, "name a file", "is empty");
    path = dem_scene_path(r, path);
    if (!path)
        return dem_fail_memory(r->error);
    if (access(path, R_OK) != 0)
        return dem_scene_refuse(r, v, "paths are relative to the folder of the scene", "cannot read %s: %s", path,
                                strerror(errno));
    *(const char **)into = path;
    return DEM_OK;
}

// ---- objects

dem_status dem_field_object(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    return dem_fields_read(r, v, field->fields, into, NULL);
}

dem_status dem_field_not_built(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)field;
    (void)into;
    return dem_json_is_null(v->json) ? DEM_OK : refuse_unbuilt(r, v, "this");
}

dem_status dem_field_nothing(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    bool list = dem_json_is_array(v->json) || dem_json_is_object(v->json);
    bool empty = list && dem_json_length(v->json) == 0 && !dem_json_next(v->json, NULL);
    return empty ? DEM_OK : dem_field_not_built(r, v, field, into);
}
