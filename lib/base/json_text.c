#include "base/json_text.h"

#include <string.h>

#include "base/json.h"

static const char byte_order_mark[] = "\xef\xbb\xbf";

typedef struct scanner {
    const char *at, *end;
} scanner;

static bool starts(const scanner *s, const char *what)
{
    size_t length = strlen(what);
    return (size_t)(s->end - s->at) >= length && memcmp(s->at, what, length) == 0;
}

static void skip_to(scanner *s, const char *what)
{
    while (s->at < s->end && !starts(s, what))
        s->at++;
}

// true: there was one; one that is not closed ends the text
static bool skip_comment(scanner *s)
{
    if (starts(s, "//"))
        skip_to(s, "\n");
    else if (starts(s, "/*")) {
        s->at += 2;
        skip_to(s, "*/");
        s->at = s->end - s->at >= 2 ? s->at + 2 : s->end;
    } else
        return false;
    return true;
}

static bool is_space(char sign)
{
    return sign == ' ' || sign == '\t' || sign == '\r' || sign == '\n';
}

static void skip_space(scanner *s)
{
    while (s->at < s->end && (skip_comment(s) || is_space(*s->at)))
        if (s->at < s->end && is_space(*s->at))
            s->at++;
}

// from a quote to behind the closing one
static void skip_string(scanner *s)
{
    for (s->at++; s->at < s->end && *s->at != '"'; s->at++)
        if (*s->at == '\\' && s->end - s->at > 1)
            s->at++;
    if (s->at < s->end)
        s->at++;
}

static void blank(char *begin, const char *end)
{
    for (; begin < end; begin++)
        if (*begin != '\n')
            *begin = ' ';
}

void dem_json_blank(char *text, size_t size)
{
    scanner s = {text, text + size};
    char *comma = NULL;  // the last sign, if it is a comma behind a value
    char last = '[';     // the last sign that is no space
    if (starts(&s, byte_order_mark))
        blank(text, text + 3);
    while (s.at < s.end) {
        char *sign = text + (s.at - text);
        if (skip_comment(&s)) {
            blank(sign, s.at);
            continue;
        }
        if (*sign == '"')
            skip_string(&s);
        else
            s.at++;
        if (is_space(*sign))
            continue;
        if (comma && (*sign == ']' || *sign == '}'))
            *comma = ' ';
        comma = *sign == ',' && !strchr("[{,:", last) ? sign : NULL;
        last = *sign ? *sign : ',';
    }
}

static bool is_bracket(char sign)
{
    return sign == '{' || sign == '[' || sign == '}' || sign == ']';
}

static void skip_value(scanner *s)
{
    size_t depth = 0;
    do {
        skip_space(s);
        if (s->at >= s->end)
            return;
        char sign = *s->at;
        depth += sign == '{' || sign == '[';
        depth -= (sign == '}' || sign == ']') && depth > 0;
        if (sign == '"')
            skip_string(s);
        else if (is_bracket(sign) || sign == ',' || sign == ':')
            s->at++;
        else
            do
                s->at++;
            while (s->at < s->end && !is_bracket(*s->at) && !is_space(*s->at) && *s->at != ',' && *s->at != ':' &&
                   *s->at != '/');
    } while (depth);
}

// a quoted text against a key; escapes are rare and left to the parser
static bool same_key(const char *quoted, size_t size, const char *key)
{
    if (!memchr(quoted, '\\', size))
        return size == strlen(key) + 2 && memcmp(quoted + 1, key, size - 2) == 0;
    dem_json *string;
    if (dem_json_parse(quoted, size, NULL, &string, NULL) != DEM_OK)
        return false;
    bool same = dem_json_string(string) && strcmp(dem_json_string(string), key) == 0;
    dem_json_release(string);
    return same;
}

// over a comma to the next member or item; false: there is none
static bool next_part(scanner *s)
{
    skip_space(s);
    if (s->at >= s->end || *s->at != ',')
        return false;
    s->at++;
    skip_space(s);
    return s->at < s->end;
}

static bool find_member(scanner *s, const char *wanted, const char **key)
{
    do {
        if (s->at >= s->end || *s->at != '"')
            return false;
        *key = s->at;
        skip_string(s);
        size_t size = (size_t)(s->at - *key);
        skip_space(s);
        if (s->at >= s->end || *s->at != ':')
            return false;
        s->at++;
        skip_space(s);
        if (same_key(*key, size, wanted))
            return s->at < s->end;
        skip_value(s);
    } while (next_part(s));
    return false;
}

static bool find_item(scanner *s, size_t index)
{
    for (; s->at < s->end && *s->at != ']'; index--) {
        if (index == 0)
            return true;
        skip_value(s);
        if (!next_part(s))
            return false;
    }
    return false;
}

// from the start of the text to the value; `key` then stands at its key, if it has one
static bool find(scanner *s, const dem_json_place *place, const char **key)
{
    if (!place->in) {
        skip_space(s);
        *key = NULL;
        return s->at < s->end;
    }
    if (!find(s, place->in, key) || *s->at != (place->key ? '{' : '['))
        return false;
    s->at++;
    skip_space(s);
    *key = NULL;
    return place->key ? find_member(s, place->key, key) : find_item(s, place->index);
}

bool dem_json_locate(const char *text, size_t size, const dem_json_place *place, dem_json_part part, long *line,
                     long *column)
{
    scanner s = {text, text + size};
    const char *key = NULL;
    if (starts(&s, byte_order_mark))
        s.at += 3;
    const char *begin = s.at;
    if (!find(&s, place, &key))
        return false;
    const char *found = part == DEM_JSON_KEY && key ? key : s.at;
    *line = *column = 1;
    for (const char *p = begin; p < found; p++)
        if (*p == '\n') {
            ++*line;
            *column = 1;
        } else if ((*p & 0xc0) != 0x80)  // not in the middle of a character of UTF-8
            ++*column;
    return true;
}
