/// JSON: read by jansson, written to a buffer.
#ifndef DEM_BASE_JSON_H
#define DEM_BASE_JSON_H

#include "base/text.h"

typedef struct json_t dem_json;

/// Parses one JSON value; `file` is for messages. NaN and infinities do not exist in JSON.
dem_status dem_json_parse(const char *text, size_t size, const char *file, dem_json **root, dem_error *error);
/// The same with comments and trailing commas allowed (base/json_text.h).
dem_status dem_json_parse_lenient(const char *text, size_t size, const char *file, dem_json **root, dem_error *error);
void dem_json_release(dem_json *root);

/// The getters take NULL and a value of another type; they then return NULL, 0 or false.
const dem_json *dem_json_member(const dem_json *object, const char *key);
const dem_json *dem_json_item(const dem_json *array, size_t index);
size_t dem_json_length(const dem_json *array);
/// The keys of an object in the order of the file: the one behind `key`, the first for NULL; NULL: no more.
const char *dem_json_next(const dem_json *object, const char *key);
bool dem_json_is_object(const dem_json *value);
bool dem_json_is_array(const dem_json *value);
bool dem_json_is_null(const dem_json *value);
bool dem_json_number(const dem_json *value, double *number);
bool dem_json_whole(const dem_json *value, int64_t *number);
bool dem_json_bool(const dem_json *value, bool *flag);
const char *dem_json_string(const dem_json *value);
/// The value as compact text; free it.
char *dem_json_text(const dem_json *value);

/// Changing a parsed value. All take over `value` (NULL: failed to be made) and return false without memory.
dem_json *dem_json_new_object(void);
dem_json *dem_json_new_string(const char *text);
bool dem_json_set_member(dem_json *object, const char *key, dem_json *value);
bool dem_json_set_item(dem_json *array, size_t index, dem_json *value);

/// Writes nested values in order. Members of the outermost object stand on lines of their own, as do the
/// items of an array opened with `lines`; everything deeper is compact.
typedef struct dem_json_writer {
    dem_buffer *out;
    int depth, line_depth;
    bool first;
} dem_json_writer;

dem_json_writer dem_json_begin(dem_buffer *out);
/// `key` is NULL for array items and the outermost value.
void dem_json_open_object(dem_json_writer *w, const char *key);
void dem_json_open_array(dem_json_writer *w, const char *key, bool lines);
void dem_json_close(dem_json_writer *w, char bracket);
/// A number with 17 digits; null when it is not finite.
void dem_json_put_number(dem_json_writer *w, const char *key, double value);
void dem_json_put_whole(dem_json_writer *w, const char *key, int64_t value);
void dem_json_put_bool(dem_json_writer *w, const char *key, bool value);
void dem_json_put_string(dem_json_writer *w, const char *key, const char *value);
/// Text that is JSON already.
void dem_json_put_raw(dem_json_writer *w, const char *key, const char *json);
void dem_json_put_numbers(dem_json_writer *w, const char *key, const double *values, size_t count);

#endif
