/// A reader of VTP files for tests: finds arrays by section and name, and checks that the raw blocks fill the file.
#ifndef DEM_TESTS_VTP_H
#define DEM_TESTS_VTP_H

#include "check.h"

#include "base/text.h"

static const char VTP_RAW[] = "<AppendedData encoding=\"raw\">\n_";
static const char VTP_END[] = "\n</AppendedData>\n</VTKFile>\n";

/// The whole number of an attribute in the tag that starts at `tag`; -1: there is none.
static inline long vtp_attribute(const char *tag, const char *name)
{
    char key[64];
    snprintf(key, sizeof key, " %s=\"", name);
    const char *at = strstr(tag, key), *end = strchr(tag, '>');
    long value = -1;
    if (at && at < end)
        check(dem_parse_long(at + strlen(key), end, &value) != NULL);
    return value;
}

/// Where the named array of a section ("PointData", "Polys", ...) is declared; NULL: there is none.
static inline const char *vtp_tag(const dem_buffer *file, const char *section, const char *name)
{
    char open[64], close[64], key[96];
    snprintf(open, sizeof open, "<%s", section);
    snprintf(close, sizeof close, "</%s>", section);
    snprintf(key, sizeof key, " Name=\"%s\" ", name);
    const char *raw = strstr(file->data, VTP_RAW), *from = strstr(file->data, open);
    check(raw != NULL);
    if (!from || from > raw)
        return NULL;
    const char *to = strstr(from, close), *tag = strstr(from, key);
    check(to && to < raw);
    return tag && tag < to ? tag : NULL;
}

/// The block of an array, whose kind and size in bytes are checked.
static inline const void *vtp_array(const dem_buffer *file, const char *section, const char *name, const char *type,
                                    long width, size_t bytes)
{
    const char *tag = vtp_tag(file, section, name);
    if (!tag)
        print_error("no array %s in %s\n", name, section);
    check(tag != NULL);
    char kind[64];
    snprintf(kind, sizeof kind, "<DataArray type=\"%s\"", type);
    check(strncmp(tag - strlen(kind), kind, strlen(kind)) == 0);
    check(vtp_attribute(tag, "NumberOfComponents") == width);
    long offset = vtp_attribute(tag, "offset");
    const char *at = strstr(file->data, VTP_RAW) + strlen(VTP_RAW) + offset;
    uint64_t size;
    check(offset >= 0 && at + sizeof size <= file->data + file->size);
    memcpy(&size, at, sizeof size);
    check(size == bytes && at + sizeof size + size <= file->data + file->size);
    return at + sizeof size;
}

static inline long vtp_count(const dem_buffer *file, const char *what)
{
    return vtp_attribute(strstr(file->data, "<Piece"), what);
}

/// The arrays are declared in the order of their blocks, which follow each other to the file's end.
static inline void vtp_check_blocks(const dem_buffer *file)
{
    const char *raw = strstr(file->data, VTP_RAW), *end = file->data + file->size - strlen(VTP_END);
    check(raw && end > raw && strcmp(end, VTP_END) == 0);
    raw += strlen(VTP_RAW);
    const char *at = raw, *tag = file->data;
    while ((tag = strstr(tag, "<DataArray")) && tag < raw) {
        uint64_t size;
        check(vtp_attribute(tag, "offset") == at - raw);
        memcpy(&size, at, sizeof size);
        at += sizeof size + size;
        check(at <= end);
        tag++;
    }
    check(at == end);
}

#endif
