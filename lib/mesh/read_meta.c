// MetaImage of ITK: lines "Key = value", the last one names the data: LOCAL (mha) or another file (mhd).
#include <stdio.h>
#include <strings.h>

#include "mesh/volume_header.h"

typedef struct meta {
    dem_reader r;
    dem_volume_header *header;
    int axes, sizes_given, spacings_given, elements_given, matrix_given;
    double sizes[4], spacings[4], elements[4], matrix[16];
    bool has_type, big_endian, compressed, text, ended;
} meta;

static dem_status wrong(const meta *m, const char *key, const char *value)
{
    return dem_reader_fail(&m->r, "'%.40s = %.60s' cannot be read; write the image again", key, value);
}

static dem_status read_type(meta *m, const char *value)
{
    static const struct {
        const char *name;
        dem_voxel_type type;
    } types[] = {
        {"MET_UCHAR", DEM_VOXEL_UINT8},     {"MET_CHAR", DEM_VOXEL_INT8},   {"MET_USHORT", DEM_VOXEL_UINT16},
        {"MET_SHORT", DEM_VOXEL_INT16},     {"MET_UINT", DEM_VOXEL_UINT32}, {"MET_INT", DEM_VOXEL_INT32},
        {"MET_ULONG", DEM_VOXEL_UINT32},    {"MET_LONG", DEM_VOXEL_INT32},  {"MET_ULONG_LONG", DEM_VOXEL_UINT64},
        {"MET_LONG_LONG", DEM_VOXEL_INT64}, {"MET_FLOAT", DEM_VOXEL_FLOAT}, {"MET_DOUBLE", DEM_VOXEL_DOUBLE}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcasecmp(value, types[i].name) == 0) {
            m->header->type = types[i].type;
            m->has_type = true;
            return DEM_OK;
        }
    return dem_reader_fail(
        &m->r, "voxels of type '%.40s' are no labels; save them as MET_UCHAR, MET_USHORT or MET_UINT", value);
}

static dem_status read_data_file(meta *m, const char *value)
{
    m->ended = true;
    if (strcasecmp(value, "LOCAL") == 0)
        return DEM_OK;
    if (!*value || strncasecmp(value, "LIST", 4) == 0 || strchr(value, '%'))
        return dem_reader_fail(&m->r, "the data lie in many files; save the image in one");
    snprintf(m->header->file, sizeof m->header->file, "%s", value);
    return DEM_OK;
}

static bool is_one_of(const char *key, const char *a, const char *b, const char *c)
{
    return strcasecmp(key, a) == 0 || strcasecmp(key, b) == 0 || strcasecmp(key, c) == 0;
}

static dem_status read_numbers(meta *m, const char *key, const char *value)
{
    double x[16];
    int count = dem_header_numbers(value, x, 16);
    if (count < 1)
        return wrong(m, key, value);
    int four = count < 4 ? count : 4;
    if (strcasecmp(key, "NDims") == 0) {
        if (!(x[0] >= 1 && x[0] <= 10))
            return wrong(m, key, value);
        m->axes = (int)x[0];
    } else if (strcasecmp(key, "DimSize") == 0) {
        m->sizes_given = count;
        memcpy(m->sizes, x, (size_t)four * sizeof *x);
    } else if (strcasecmp(key, "ElementSpacing") == 0) {
        m->spacings_given = count;
        memcpy(m->spacings, x, (size_t)four * sizeof *x);
    } else if (strcasecmp(key, "ElementSize") == 0) {
        m->elements_given = count;
        memcpy(m->elements, x, (size_t)four * sizeof *x);
    } else if (strcasecmp(key, "HeaderSize") == 0) {
        if (!(fabs(x[0]) < 0x1p53))
            return wrong(m, key, value);
        m->header->skip = (int64_t)x[0];
    } else if (strcasecmp(key, "ElementNumberOfChannels") == 0) {
        if (x[0] != 1)
            return dem_reader_fail(&m->r, "the voxels have %g values each; save one label per voxel", x[0]);
    } else if (is_one_of(key, "TransformMatrix", "Rotation", "Orientation")) {
        m->matrix_given = count;
        memcpy(m->matrix, x, sizeof x);
    } else {  // where the image lies
        if (count != 3 || !point_is_usable((dem_vec3){x[0], x[1], x[2]}))
            return wrong(m, key, value);
        m->header->volume.origin = (dem_vec3){x[0], x[1], x[2]};
    }
    return DEM_OK;
}

static bool is_true(const char *value)
{
    return *value == 'T' || *value == 't' || *value == '1';
}

static dem_status read_key(meta *m, const char *key, const char *value)
{
    static const char *const numbers[] = {"NDims",      "DimSize",         "ElementSpacing", "ElementSize",
                                          "HeaderSize", "TransformMatrix", "Rotation",       "Orientation",
                                          "Offset",     "Position",        "Origin",         "ElementNumberOfChannels"};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (strcasecmp(key, numbers[i]) == 0)
            return read_numbers(m, key, value);
    if (strcasecmp(key, "ElementType") == 0)
        return read_type(m, value);
    if (strcasecmp(key, "ElementDataFile") == 0)
        return read_data_file(m, value);
    if (strcasecmp(key, "BinaryDataByteOrderMSB") == 0 || strcasecmp(key, "ElementByteOrderMSB") == 0)
        m->big_endian = is_true(value);
    else if (strcasecmp(key, "CompressedData") == 0)
        m->compressed = is_true(value);
    else if (strcasecmp(key, "BinaryData") == 0)
        m->text = !is_true(value);
    return DEM_OK;  // others say nothing about the shape
}

static dem_status finish(meta *m)
{
    dem_volume_header *h = m->header;
    dem_volume *v = &h->volume;
    if (!m->ended)
        return dem_reader_fail(&m->r, "no 'ElementDataFile' at the end of the header; write the image again");
    if (!m->has_type)
        return dem_reader_fail(&m->r, "'ElementType' is missing; write the image again");
    if (m->axes != 3 || m->sizes_given != 3)
        return dem_reader_fail(&m->r, "NDims is %d with %d sizes; save one image of labels in three dimensions",
                               m->axes, m->sizes_given);
    h->big_endian = m->big_endian;
    h->coding = m->text ? DEM_CODING_TEXT : m->compressed ? DEM_CODING_GZIP : DEM_CODING_RAW;
    const double *spacing = m->spacings_given ? m->spacings : m->elements;
    int given = m->spacings_given ? m->spacings_given : m->elements_given;
    v->spaced = given > 0;
    if ((given && given != 3) || (m->matrix_given && m->matrix_given != 9))
        return dem_reader_fail(&m->r, "spacing or orientation have not three axes; write the image again");
    for (int k = 0; k < 3; k++) {
        double step = given ? spacing[k] : 1;
        const double *row = m->matrix + 3 * k;
        if (!(step > 0 && step < 1e60))
            return dem_reader_fail(&m->r, "a spacing is not positive; correct 'ElementSpacing'");
        v->axes[k] = m->matrix_given ? v3_scale((dem_vec3){row[0], row[1], row[2]}, step)
                                     : (dem_vec3){k == 0 ? step : 0, k == 1 ? step : 0, k == 2 ? step : 0};
    }
    DEM_TRY(dem_header_sizes(&m->r, m->sizes, h));
    return dem_header_check(&m->r, h);
}

dem_status dem_meta_header(const dem_ctx *ctx, const char *name, const char *bytes, size_t size,
                           dem_volume_header *header, dem_error *error)
{
    dem_mesh none;
    meta m = {.r = dem_reader_begin(ctx, name, bytes, size, &none, error), .header = header};
    while (!m.ended && dem_reader_line(&m.r)) {
        char line[VOLUME_LINE], *key, *value;
        dem_header_line(&m.r, line);
        if (!*line || *line == '#')
            continue;
        if (!dem_header_split(line, "=", &key, &value))
            return dem_reader_fail(&m.r,
                                   "not a line 'Key = value' of a MetaImage header; name the header file (mhd), or "
                                   "give the sizes with --raw");
        DEM_TRY(read_key(&m, key, value));
    }
    header->data = m.r.next ? (size_t)(m.r.next - bytes) : size;
    return finish(&m);
}
