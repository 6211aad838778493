#include "base/json.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/json_text.h"
#include "base/memory.h"

dem_status dem_json_parse(const char *text, size_t size, const char *file, dem_json **root, dem_error *error)
{
    json_error_t where;
    *root = json_loadb(text, size, JSON_REJECT_DUPLICATES | JSON_DECODE_ANY, &where);
    if (*root)
        return DEM_OK;
    return dem_fail_at(error, DEM_BAD_INPUT, file, where.line > 0 ? where.line : 0, "not valid JSON: %s (column %d)",
                       where.text, where.column);
}

dem_status dem_json_parse_lenient(const char *text, size_t size, const char *file, dem_json **root, dem_error *error)
{
    *root = NULL;
    char *plain = dem_alloc(size, 1);
    if (!plain)
        return dem_fail_memory(error);
    memcpy(plain, text, size);
    dem_json_blank(plain, size);
    dem_status status = dem_json_parse(plain, size, file, root, error);
    free(plain);
    return status;
}

void dem_json_release(dem_json *root)
{
    json_decref(root);
}

const dem_json *dem_json_member(const dem_json *object, const char *key)
{
    return json_object_get(object, key);
}

const dem_json *dem_json_item(const dem_json *array, size_t index)
{
    return json_array_get(array, index);
}

size_t dem_json_length(const dem_json *array)
{
    return json_array_size(array);
}

const char *dem_json_next(const dem_json *object, const char *key)
{
    json_t *o = (json_t *)object; // iterators are not const
    return json_object_iter_key(key ? json_object_iter_next(o, json_object_key_to_iter(key)) : json_object_iter(o));
}

bool dem_json_is_object(const dem_json *value)
{
    return json_is_object(value);
}

bool dem_json_is_array(const dem_json *value)
{
    return json_is_array(value);
}

bool dem_json_is_null(const dem_json *value)
{
    return json_is_null(value);
}

bool dem_json_number(const dem_json *value, double *number)
{
    if (!json_is_number(value))
        return false;
    *number = json_number_value(value);
    return true;
}

bool dem_json_whole(const dem_json *value, int64_t *number)
{
    if (!json_is_integer(value))
        return false;
    *number = json_integer_value(value);
    return true;
}

bool dem_json_bool(const dem_json *value, bool *flag)
{
    if (!json_is_boolean(value))
        return false;
    *flag = json_is_true(value);
    return true;
}

const char *dem_json_string(const dem_json *value)
{
    return json_string_value(value);
}

char *dem_json_text(const dem_json *value)
{
    return json_dumps(value, JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(17));
}

dem_json *dem_json_new_object(void)
{
    return json_object();
}

dem_json *dem_json_new_string(const char *text)
{
    return json_string(text);
}

bool dem_json_set_member(dem_json *object, const char *key, dem_json *value)
{
    return json_object_set_new(object, key, value) == 0;
}

bool dem_json_set_item(dem_json *array, size_t index, dem_json *value)
{
    return json_array_set_new(array, index, value) == 0;
}

dem_json_writer dem_json_begin(dem_buffer *out)
{
    return (dem_json_writer){.out = out, .line_depth = 1, .first = true};
}

// JSON strings are UTF-8; bytes that are not (file names) become '?'
static void put_quoted(dem_buffer *out, const char *text)
{
    json_t *string = json_string(text ? text : "");
    char *quoted = string ? json_dumps(string, JSON_ENCODE_ANY) : NULL;
    if (quoted)
        dem_buffer_text(out, quoted);
    else {
        dem_buffer_text(out, "\"");
        for (const char *p = text; p && *p; p++) {
            bool plain = (unsigned char)*p >= ' ' && (unsigned char)*p < 127 && *p != '"' && *p != '\\';
            dem_buffer_bytes(out, plain ? p : "?", 1);
        }
        dem_buffer_text(out, "\"");
    }
    free(quoted);
    json_decref(string);
}

static void put_lead(dem_json_writer *w, const char *key)
{
    if (w->depth > 0) {
        if (!w->first)
            dem_buffer_text(w->out, w->depth <= w->line_depth ? "," : ", ");
        if (w->depth <= w->line_depth) {
            dem_buffer_text(w->out, "\n");
            for (int i = 0; i < w->depth; i++)
                dem_buffer_text(w->out, "  ");
        }
    }
    if (key) {
        put_quoted(w->out, key);
        dem_buffer_text(w->out, ": ");
    }
    w->first = false;
}

void dem_json_open_object(dem_json_writer *w, const char *key)
{
    put_lead(w, key);
    dem_buffer_text(w->out, "{");
    w->depth++;
    w->first = true;
}

void dem_json_open_array(dem_json_writer *w, const char *key, bool lines)
{
    put_lead(w, key);
    dem_buffer_text(w->out, "[");
    w->depth++;
    w->first = true;
    if (lines)
        w->line_depth = w->depth;
}

void dem_json_close(dem_json_writer *w, char bracket)
{
    bool lines = w->depth <= w->line_depth && !w->first;
    w->depth--;
    if (lines) {
        dem_buffer_text(w->out, "\n");
        for (int i = 0; i < w->depth; i++)
            dem_buffer_text(w->out, "  ");
    }
    if (w->line_depth > w->depth)
        w->line_depth = w->depth > 1 ? w->depth : 1;
    dem_buffer_bytes(w->out, &bracket, 1);
    if (w->depth == 0)
        dem_buffer_text(w->out, "\n");
    w->first = false;
}

void dem_json_put_number(dem_json_writer *w, const char *key, double value)
{
    put_lead(w, key);
    if (value == 0 && signbit(value))
        dem_buffer_text(w->out, "-0.0"); // "-0" is a whole number, which has no sign
    else if (isfinite(value))
        dem_buffer_number(w->out, value, 17);
    else
        dem_buffer_text(w->out, "null");
}

void dem_json_put_whole(dem_json_writer *w, const char *key, int64_t value)
{
    put_lead(w, key);
    dem_buffer_print(w->out, "%lld", (long long)value);
}

void dem_json_put_bool(dem_json_writer *w, const char *key, bool value)
{
    put_lead(w, key);
    dem_buffer_text(w->out, value ? "true" : "false");
}

void dem_json_put_string(dem_json_writer *w, const char *key, const char *value)
{
    put_lead(w, key);
    put_quoted(w->out, value);
}

void dem_json_put_raw(dem_json_writer *w, const char *key, const char *json)
{
    put_lead(w, key);
    dem_buffer_text(w->out, json);
}

void dem_json_put_numbers(dem_json_writer *w, const char *key, const double *values, size_t count)
{
    dem_json_open_array(w, key, false);
    for (size_t i = 0; i < count; i++)
        dem_json_put_number(w, NULL, values[i]);
    dem_json_close(w, ']');
}
