// Volumes of labels: header, data wherever they lie and however they are coded, voxels of any type into labels.
#define _GNU_SOURCE
#include "mesh/volume.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include <zlib.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "mesh/volume_header.h"

static const int type_bytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
static const char *const type_names[] = {"uint8", "int8",   "uint16", "int16", "uint32",
                                         "int32", "uint64", "int64",  "float", "double"};
static const double THINNEST = 1e-6;      // volume of a voxel over the product of its edges
static const double DEFLATE_MOST = 1040;  // bytes that one byte can hold

// ---- what the headers share

bool dem_header_split(char *line, const char *separator, char **key, char **value)
{
    char *at = strstr(line, separator);
    if (!at)
        return false;
    *at = 0;
    *key = line + strspn(line, " \t");
    for (char *end = *key + strlen(*key); end > *key && text_is_blank(end[-1]);)
        *--end = 0;
    *value = at + strlen(separator);
    *value += strspn(*value, " \t");
    for (char *end = *value + strlen(*value); end > *value && text_is_blank(end[-1]);)
        *--end = 0;
    return true;
}

void dem_header_line(const dem_reader *r, char line[VOLUME_LINE])
{
    size_t length = (size_t)(r->stop - r->at);
    length = length < VOLUME_LINE - 1 ? length : VOLUME_LINE - 1;
    memcpy(line, r->at, length);
    line[length] = 0;
}

int dem_header_numbers(const char *text, double *numbers, int room)
{
    const char *end = text + strlen(text);
    int count = 0;
    for (;;) {
        text += strspn(text, " \t,()");
        if (text == end)
            return count;
        double value;
        const char *after = dem_parse_double(text, end, &value);
        if (!after || count == room)
            return -1;
        numbers[count++] = value;
        text = after;
    }
}

dem_status dem_header_sizes(const dem_reader *r, const double *sizes, dem_volume_header *header)
{
    double count = 1;
    for (int k = 0; k < 3; k++) {
        if (!(sizes[k] >= 1 && sizes[k] == floor(sizes[k])))
            return dem_reader_fail(r, "a size of %g voxels; correct the sizes", sizes[k]);
        count *= sizes[k];
        header->volume.size[k] = sizes[k] < 1e12 ? (size_t)sizes[k] : 0;
    }
    if (!(count < 1e12))
        return dem_reader_fail(r, "%g x %g x %g voxels are more than a computer holds; correct the sizes", sizes[0],
                               sizes[1], sizes[2]);
    return DEM_OK;
}

dem_status dem_header_check(const dem_reader *r, const dem_volume_header *header)
{
    const dem_vec3 *a = header->volume.axes;
    double edges = v3_norm(a[0]) * v3_norm(a[1]) * v3_norm(a[2]), voxel = dem_volume_voxel(&header->volume);
    if (!(voxel > THINNEST * edges) || !(edges < 1e60) || !(edges > 1e-60))
        return dem_reader_fail(r, "the voxels have no volume; correct the spacing or the directions of the axes");
    return DEM_OK;
}

// ---- data

// one volume being read; `bytes` hold the data from `at` on
typedef struct volume_work {
    const dem_ctx *ctx;
    const char *name;  // of the file with the data
    dem_volume_header header;
    dem_buffer bytes;
    size_t at;
    dem_error *error;
} volume_work;

static dem_status refuse(const volume_work *w, const char *format, ...) DEM_PRINTF(2, 3);
static dem_status refuse(const volume_work *w, const char *format, ...)
{
    char text[400];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return dem_fail_at(w->error, DEM_BAD_INPUT, w->name, 0, "%s", text);
}

static size_t needed_bytes(const volume_work *w)
{
    return dem_volume_count(&w->header.volume) * (size_t)type_bytes[w->header.type];
}

// passes lines and bytes over
static dem_status skip(volume_work *w)
{
    const dem_volume_header *h = &w->header;
    for (size_t i = 0; i < h->skip_lines; i++) {
        const char *from = w->bytes.data + w->at, *end = memchr(from, '\n', w->bytes.size - w->at);
        if (!end)
            return refuse(w, "the file ends before its data; correct 'line skip'");
        w->at += (size_t)(end + 1 - from);
    }
    size_t left = w->bytes.size - w->at;
    if (h->skip == -1 && h->coding == DEM_CODING_RAW) {
        if (left < needed_bytes(w))
            return DEM_OK;  // said better by whoever takes the data
        w->at = w->bytes.size - needed_bytes(w);
    } else if (h->skip < 0 || (uint64_t)h->skip > left) {
        return refuse(w, "cannot pass over %lld bytes of the data; correct the header", (long long)h->skip);
    } else {
        w->at += (size_t)h->skip;
    }
    return DEM_OK;
}

static dem_status take_raw(volume_work *w)
{
    size_t have = w->bytes.size - w->at, need = needed_bytes(w);
    const size_t *n = w->header.volume.size;
    if (have < need || (w->header.exact && have != need))
        return refuse(w, "%zu x %zu x %zu voxels of %s are %zu bytes, but the file holds %zu; %s", n[0], n[1], n[2],
                      type_names[w->header.type], need, have,
                      w->header.exact ? "correct sizes, type or skip of --raw" : "it is cut short, copy it again");
    if (have > need + 16)
        dem_log(w->ctx, DEM_LOG_WARNING, "%zu bytes behind the data are not used", have - need);
    memmove(w->bytes.data, w->bytes.data + w->at, need);
    void *data = realloc(w->bytes.data, need);
    w->header.volume.labels = data ? data : w->bytes.data;
    w->bytes = (dem_buffer){0};
    return DEM_OK;
}

static dem_status inflate_all(volume_work *w, z_stream *z, unsigned char *out, size_t need)
{
    const size_t most = 1u << 30;  // zlib counts in 32 bits
    size_t left = w->bytes.size - w->at, done = 0;
    z->next_in = (unsigned char *)w->bytes.data + w->at;
    for (int code = Z_OK; code != Z_STREAM_END;) {
        unsigned char spare;
        uInt in = (uInt)(left < most ? left : most), room = (uInt)(need - done < most ? need - done : most);
        z->avail_in = in;
        z->next_out = room ? out + done : &spare;
        z->avail_out = room ? room : 1;
        code = inflate(z, Z_NO_FLUSH);
        left -= in - z->avail_in;
        done += (room ? room : 1) - z->avail_out;
        if (done > need)
            return refuse(w, "the compressed data are more than the header tells; correct sizes or type");
        if (code == Z_BUF_ERROR || (code == Z_OK && left == 0 && done < need && z->avail_out))
            return refuse(w, "the compressed data end after %zu of %zu bytes; the file is cut short, copy it again",
                          done, need);
        if (code != Z_OK && code != Z_STREAM_END)
            return refuse(w, "the compressed data are damaged (%s); copy the file again", z->msg ? z->msg : "zlib");
        if (dem_progress(w->ctx, "unpacking", (double)done / (double)need))
            return dem_fail(w->error, DEM_INTERRUPTED, "interrupted while reading");
    }
    return done == need ? DEM_OK
                        : refuse(w, "the compressed data hold %zu of %zu bytes; correct sizes or type", done, need);
}

static dem_status take_gzip(volume_work *w)
{
    size_t need = needed_bytes(w);
    // before memory is asked for
    if ((double)need > DEFLATE_MOST * (double)(w->bytes.size - w->at) + 64)
        return refuse(w,
                      "the compressed data cannot hold %zu bytes; the file is cut short or its sizes are wrong, "
                      "write it again",
                      need);
    unsigned char *out = dem_alloc(need, 1);
    z_stream z = {0};
    if (!out || inflateInit2(&z, 15 + 32) != Z_OK) {
        free(out);
        return dem_fail_memory(w->error);
    }
    dem_status status = inflate_all(w, &z, out, need);
    inflateEnd(&z);
    dem_buffer_release(&w->bytes);
    if (status != DEM_OK)
        free(out);
    else
        w->header.volume.labels = out;
    return status;
}

// text becomes doubles as long as they can be told apart, 8 bytes a voxel
static dem_status take_text(volume_work *w)
{
    size_t count = dem_volume_count(&w->header.volume);
    const char *at = w->bytes.data + w->at, *end = w->bytes.data + w->bytes.size;
    if (count > (size_t)(end - at) / 2 + 1)
        return refuse(w, "the text cannot hold %zu voxels; the file is cut short or its sizes are wrong", count);
    double *values = dem_alloc(count, sizeof *values);
    if (!values)
        return dem_fail_memory(w->error);
    dem_status status = DEM_OK;
    for (size_t i = 0; status == DEM_OK && i < count; i++) {
        while (at < end && (text_is_blank(*at) || *at == '\n' || *at == '\r' || *at == ','))
            at++;
        const char *after = dem_parse_double(at, end, &values[i]);
        if (!after)
            status = refuse(w, "voxel %zu of %zu is no number; the file is cut short or damaged", i + 1, count);
        at = after;
    }
    dem_buffer_release(&w->bytes);
    if (status != DEM_OK) {
        free(values);
        return status;
    }
    w->header.volume.labels = values;
    w->header.type = DEM_VOXEL_DOUBLE;
    const uint16_t one = 1;
    w->header.big_endian = *(const uint8_t *)&one == 0;
    return DEM_OK;
}

// ---- voxels to labels, in place

static void swap_bytes(void *data, size_t count, int width)
{
    uint16_t *two = data;
    uint32_t *four = data;
    uint64_t *eight = data;
    for (size_t i = 0; width == 2 && i < count; i++)
        two[i] = __builtin_bswap16(two[i]);
    for (size_t i = 0; width == 4 && i < count; i++)
        four[i] = __builtin_bswap32(four[i]);
    for (size_t i = 0; width == 8 && i < count; i++)
        eight[i] = __builtin_bswap64(eight[i]);
}

// sets what is below 0 to 0; returns how many
static size_t clear_negative(void *data, size_t count, int width)
{
    int8_t *one = data;
    int16_t *two = data;
    int32_t *four = data;
    size_t negative = 0;
    for (size_t i = 0; i < count; i++) {
        bool below = width == 1 ? one[i] < 0 : width == 2 ? two[i] < 0 : four[i] < 0;
        negative += below;
        if (below && width == 1)
            one[i] = 0;
        else if (below && width == 2)
            two[i] = 0;
        else if (below)
            four[i] = 0;
    }
    return negative;
}

static double wide_value(const void *data, size_t at, dem_voxel_type type)
{
    switch (type) {
    case DEM_VOXEL_UINT64:
        return (double)((const uint64_t *)data)[at];
    case DEM_VOXEL_INT64:
        return (double)((const int64_t *)data)[at];
    case DEM_VOXEL_FLOAT:
        return (double)((const float *)data)[at];
    default:
        return ((const double *)data)[at];
    }
}

// numbers of 64 bits and floating-point ones to 32 bits, in place: the new one never lies before the old one is read
static dem_status narrow(volume_work *w, size_t count, size_t *negative)
{
    dem_volume *v = &w->header.volume;
    for (size_t i = 0; i < count; i++) {
        double value = wide_value(v->labels, i, w->header.type);
        if (!(value == floor(value)) || !(value <= UINT32_MAX))
            return refuse(w,
                          "voxel (%zu, %zu, %zu) holds %g, which is no label; segment the image first and save the "
                          "labels as uint8, uint16 or uint32",
                          i % v->size[0], i / v->size[0] % v->size[1], i / v->size[0] / v->size[1], value);
        *negative += value < 0;
        uint32_t label = value > 0 ? (uint32_t)value : 0;
        memcpy((char *)v->labels + 4 * i, &label, sizeof label);
    }
    void *smaller = realloc(v->labels, 4 * count);
    if (smaller)
        v->labels = smaller;
    return DEM_OK;
}

static dem_status to_labels(volume_work *w)
{
    dem_volume *v = &w->header.volume;
    size_t count = dem_volume_count(v), negative = 0;
    int width = type_bytes[w->header.type];
    const uint16_t one = 1;
    if (w->header.big_endian != (*(const uint8_t *)&one == 0))
        swap_bytes(v->labels, count, width);
    v->width = width < 4 ? width : 4;
    if (w->header.type >= DEM_VOXEL_UINT64)
        DEM_TRY(narrow(w, count, &negative));
    else if (w->header.type % 2 == 1)
        negative = clear_negative(v->labels, count, width);
    if (negative)
        dem_log(w->ctx, DEM_LOG_WARNING, "%zu voxels below 0 are taken as background", negative);
    return DEM_OK;
}

// ---- the whole

static dem_status read_header(volume_work *w, const dem_volume_raw *raw)
{
    dem_volume_header *h = &w->header;
    const char *bytes = w->bytes.data;
    if (raw && raw->size[0]) {
        *h = (dem_volume_header){
            .type = raw->type, .big_endian = raw->big_endian, .skip = (int64_t)raw->skip, .exact = true};
        memcpy(h->volume.size, raw->size, sizeof raw->size);
        dem_volume_space(&h->volume, (dem_vec3){1, 1, 1});
        h->volume.spaced = false;
        return DEM_OK;
    }
    if (w->bytes.size > 8 && memcmp(bytes, "NRRD000", 7) == 0)
        DEM_TRY(dem_nrrd_header(w->ctx, w->name, bytes, w->bytes.size, h, w->error));
    else
        DEM_TRY(dem_meta_header(w->ctx, w->name, bytes, w->bytes.size, h, w->error));
    w->at = h->data;
    return DEM_OK;
}

// the file beside the header takes its place
static dem_status open_data(volume_work *w, const char *folder, char path[], size_t room)
{
    const char *file = w->header.file;
    if (!folder)
        return refuse(w, "the data lie in another file; name the header's file");
    if ((size_t)snprintf(path, room, "%s%s", *file == '/' ? "" : folder, file) >= room)
        return refuse(w, "the name of the data file is too long; shorten it");
    dem_buffer_release(&w->bytes);
    w->at = 0;
    if (dem_file_read(path, &w->bytes, w->error) != DEM_OK) {
        w->bytes = (dem_buffer){0};
        return refuse(w, "its data file '%.300s' cannot be read; put it beside the header", path);
    }
    w->name = path;
    return DEM_OK;
}

static dem_status read_all(volume_work *w, const char *folder, const dem_volume_raw *raw)
{
    char path[VOLUME_LINE + 512];
    char sha256[65];
    dem_sha256(w->bytes.data, w->bytes.size, sha256);
    DEM_TRY(read_header(w, raw));
    memcpy(w->header.volume.sha256, sha256, sizeof sha256);
    if (*w->header.file)
        DEM_TRY(open_data(w, folder, path, sizeof path));
    DEM_TRY(skip(w));
    if (w->header.coding == DEM_CODING_RAW)
        DEM_TRY(take_raw(w));
    else if (w->header.coding == DEM_CODING_GZIP)
        DEM_TRY(take_gzip(w));
    else
        DEM_TRY(take_text(w));
    return to_labels(w);
}

dem_status dem_volume_read_bytes(const dem_ctx *ctx, const char *name, const char *folder, dem_buffer *bytes,
                                 const dem_volume_raw *raw, dem_volume *volume, dem_error *error)
{
    volume_work w = {.ctx = ctx, .name = name, .bytes = *bytes, .error = error};
    *bytes = (dem_buffer){0};
    dem_status status = read_all(&w, folder, raw);
    dem_buffer_release(&w.bytes);
    if (status != DEM_OK)
        dem_volume_free(&w.header.volume);
    *volume = w.header.volume;
    return status;
}

dem_status dem_volume_read(const dem_ctx *ctx, const char *path, const dem_volume_raw *raw, dem_volume *volume,
                           dem_error *error)
{
    dem_buffer bytes;
    *volume = (dem_volume){0};
    DEM_TRY(dem_file_read(path, &bytes, error));
    bool piped = strcmp(path, "-") == 0;
    char *folder = piped ? strdup("") : strndup(path, (size_t)(dem_file_name(path) - path));
    dem_ctx about = ctx ? *ctx : (dem_ctx){0};
    if (!about.subject)
        about.subject = path;
    if (!folder) {
        dem_buffer_release(&bytes);
        return dem_fail_memory(error);
    }
    dem_status status =
        dem_volume_read_bytes(&about, piped ? "standard input" : path, folder, &bytes, raw, volume, error);
    free(folder);
    return status;
}

void dem_volume_free(dem_volume *volume)
{
    free(volume->labels);
    *volume = (dem_volume){0};
}

void dem_volume_scale(dem_volume *volume, double factor)
{
    for (int k = 0; k < 3; k++)
        volume->axes[k] = v3_scale(volume->axes[k], factor);
    volume->origin = v3_scale(volume->origin, factor);
}

void dem_volume_space(dem_volume *volume, dem_vec3 spacing)
{
    volume->axes[0] = (dem_vec3){spacing.x, 0, 0};
    volume->axes[1] = (dem_vec3){0, spacing.y, 0};
    volume->axes[2] = (dem_vec3){0, 0, spacing.z};
    volume->spaced = true;
}

bool dem_volume_is_name(const char *path)
{
    return dem_file_has_suffix(path, "nrrd") || dem_file_has_suffix(path, "nhdr") || dem_file_has_suffix(path, "mhd") ||
           dem_file_has_suffix(path, "mha");
}

bool dem_volume_is_file(const char *path)
{
    char start[8] = "";
    if (strcmp(path, "-") == 0)
        return false;
    FILE *file = dem_volume_is_name(path) ? NULL : fopen(path, "rb");
    bool is = dem_volume_is_name(path) || (file && fread(start, 1, 7, file) == 7 && strcmp(start, "NRRD000") == 0);
    if (file)
        fclose(file);
    return is;
}

// "512x512x300 uint16 big skip 512", apart by blanks, commas or colons
dem_status dem_volume_raw_parse(const char *text, dem_volume_raw *raw, dem_error *error)
{
    char copy[128], *rest = NULL;
    snprintf(copy, sizeof copy, "%s", text);
    *raw = (dem_volume_raw){0};
    bool typed = false, fine = strlen(text) < sizeof copy;
    char *word = fine ? strtok_r(copy, " ,:", &rest) : NULL;
    for (int k = 0; fine && k < 3; k++) {
        long size = 0;
        const char *end = word ? dem_parse_long(word, word + strlen(word), &size) : NULL;
        fine = end && size > 0 && size < 1000000000 && *end == (k < 2 ? 'x' : 0);
        raw->size[k] = (size_t)size;
        word = fine ? (char *)end + 1 : word;
    }
    double count = (double)raw->size[0] * (double)raw->size[1] * (double)raw->size[2];
    fine = fine && count < 1e12;
    while (fine && (word = strtok_r(NULL, " ,:", &rest))) {
        bool known = false;
        for (int t = 0; t < 10; t++)
            if (strcasecmp(word, type_names[t]) == 0) {
                raw->type = (dem_voxel_type)t;
                typed = known = true;
            }
        if (strcasecmp(word, "big") == 0 || strcasecmp(word, "little") == 0) {
            raw->big_endian = strcasecmp(word, "big") == 0;
            known = true;
        } else if (strcasecmp(word, "skip") == 0) {
            long bytes = -1;
            word = strtok_r(NULL, " ,:", &rest);
            known = word && dem_parse_long(word, word + strlen(word), &bytes) == word + strlen(word) && bytes >= 0;
            raw->skip = (size_t)bytes;
        }
        fine = known;
    }
    if (fine && typed)
        return DEM_OK;
    *raw = (dem_volume_raw){0};
    return dem_fail(error, DEM_USAGE,
                    "'%.100s' is not as in '512x512x300 uint16' with 'big' and 'skip BYTES' where "
                    "needed; types are uint8, int8, ... uint64, int64, float",
                    text);
}
