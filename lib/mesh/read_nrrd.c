// NRRD, the "nearly raw raster data" of teem: lines "field: value", a blank line, the data.
#include <stdio.h>
#include <strings.h>

#include "base/units.h"
#include "mesh/volume_header.h"

// what the fields say, axis by axis, before it is known which three axes count
typedef struct nrrd {
    dem_reader r;
    const dem_ctx *ctx;
    dem_volume_header *header;
    int axes, given_sizes;
    double sizes[VOLUME_AXES], spacings[VOLUME_AXES];
    dem_vec3 directions[VOLUME_AXES];
    bool has_type, has_coding, has_endian, has_spacings, has_directions;
    char unit[32];
} nrrd;

static dem_status wrong(const nrrd *n, const char *field, const char *value)
{
    return dem_reader_fail(&n->r, "'%.40s: %.60s' cannot be read; write the image again", field, value);
}

static dem_status read_type(nrrd *n, const char *value)
{
    static const struct {
        const char *names;
        dem_voxel_type type;
    } types[] = {
        {"|signed char|int8|int8_t|", DEM_VOXEL_INT8},
        {"|uchar|unsigned char|uint8|uint8_t|", DEM_VOXEL_UINT8},
        {"|short|short int|signed short|signed short int|int16|int16_t|", DEM_VOXEL_INT16},
        {"|ushort|unsigned short|unsigned short int|uint16|uint16_t|", DEM_VOXEL_UINT16},
        {"|int|signed int|int32|int32_t|", DEM_VOXEL_INT32},
        {"|uint|unsigned int|uint32|uint32_t|", DEM_VOXEL_UINT32},
        {"|longlong|long long|long long int|signed long long|signed long long int|int64|int64_t|", DEM_VOXEL_INT64},
        {"|ulonglong|unsigned long long|unsigned long long int|uint64|uint64_t|", DEM_VOXEL_UINT64},
        {"|float|", DEM_VOXEL_FLOAT},
        {"|double|", DEM_VOXEL_DOUBLE}};
    char wanted[64];
    snprintf(wanted, sizeof wanted, "|%.60s|", value);
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strstr(types[i].names, wanted)) {
            n->header->type = types[i].type;
            n->has_type = true;
            return DEM_OK;
        }
    return dem_reader_fail(&n->r, "voxels of type '%.40s' are no labels; save the labels as uint8, uint16 or uint32",
                           value);
}

static dem_status read_coding(nrrd *n, const char *value)
{
    n->has_coding = true;
    if (strcasecmp(value, "raw") == 0)
        n->header->coding = DEM_CODING_RAW;
    else if (strcasecmp(value, "gzip") == 0 || strcasecmp(value, "gz") == 0)
        n->header->coding = DEM_CODING_GZIP;
    else if (strcasecmp(value, "ascii") == 0 || strcasecmp(value, "text") == 0 || strcasecmp(value, "txt") == 0)
        n->header->coding = DEM_CODING_TEXT;
    else
        return dem_reader_fail(&n->r, "encoding '%.40s' is not known; save the image as raw, gzip or ascii", value);
    return DEM_OK;
}

// "(1,0,0) (0,1,0) none (0,0,1)"
static dem_status read_directions(nrrd *n, const char *value)
{
    int axis = 0;
    for (const char *at = value; *at; axis++) {
        if (axis == VOLUME_AXES)
            return wrong(n, "space directions", value);
        at += strspn(at, " \t");
        if (strncasecmp(at, "none", 4) == 0) {
            n->directions[axis] = (dem_vec3){0};
            at += 4;
        } else {
            const char *end = *at == '(' ? strchr(at, ')') : NULL;
            char vector[128];
            double x[4];
            if (!end || end - at > 120)
                return wrong(n, "space directions", value);
            snprintf(vector, sizeof vector, "%.*s", (int)(end + 1 - at), at);
            if (dem_header_numbers(vector, x, 4) != 3)
                return dem_reader_fail(
                    &n->r, "the direction %.60s has not three numbers; write an image in three dimensions", vector);
            n->directions[axis] = (dem_vec3){x[0], x[1], x[2]};
            at = end + 1;
        }
        at += strspn(at, " \t");
    }
    n->has_directions = true;
    return DEM_OK;
}

// the first unit that is a length: "\"mm\" \"mm\" \"mm\""
static void read_unit(nrrd *n, const char *value)
{
    while ((value = strchr(value, '"'))) {
        const char *end = strchr(++value, '"');
        if (!end)
            return;
        if (end > value && !*n->unit && (size_t)(end - value) < sizeof n->unit)
            snprintf(n->unit, sizeof n->unit, "%.*s", (int)(end - value), value);
        value = end + 1;
    }
}

static dem_status read_file_name(nrrd *n, const char *value)
{
    if (strncmp(value, "LIST", 4) == 0 || strchr(value, '%'))
        return dem_reader_fail(&n->r, "the data lie in many files; save the image in one");
    snprintf(n->header->file, sizeof n->header->file, "%s", value);
    return *value ? DEM_OK : dem_reader_fail(&n->r, "no name behind 'data file'; write the image again");
}

static dem_status read_numbers(nrrd *n, const char *field, const char *value)
{
    double x[VOLUME_AXES];
    int count = dem_header_numbers(value, x, VOLUME_AXES);
    if (count < 1)
        return wrong(n, field, value);
    if (strcasecmp(field, "sizes") == 0) {
        n->given_sizes = count;
        memcpy(n->sizes, x, sizeof x);
    } else if (strcasecmp(field, "spacings") == 0) {
        n->has_spacings = true;
        for (int i = count; i < VOLUME_AXES; i++)
            x[i] = 1;
        memcpy(n->spacings, x, sizeof x);
    } else if (strcasecmp(field, "space origin") == 0) {
        if (count != 3 || !point_is_usable((dem_vec3){x[0], x[1], x[2]}))
            return wrong(n, field, value);
        n->header->volume.origin = (dem_vec3){x[0], x[1], x[2]};
    } else if (strcasecmp(field, "dimension") == 0) {
        if (count != 1 || !(x[0] >= 1 && x[0] <= VOLUME_AXES))
            return wrong(n, field, value);
        n->axes = (int)x[0];
    } else if (!(fabs(x[0]) < 0x1p53)) {
        return wrong(n, field, value);
    } else if (field[0] == 'b' || field[0] == 'B') {
        n->header->skip = (int64_t)x[0];
    } else {
        n->header->skip_lines = x[0] > 0 ? (size_t)x[0] : 0;
    }
    return DEM_OK;
}

static dem_status read_field(nrrd *n, const char *field, const char *value)
{
    static const char *const numbers[] = {"sizes",     "spacings", "space origin", "dimension",
                                          "byte skip", "byteskip", "line skip",    "lineskip"};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (strcasecmp(field, numbers[i]) == 0)
            return read_numbers(n, field, value);
    if (strcasecmp(field, "type") == 0)
        return read_type(n, value);
    if (strcasecmp(field, "encoding") == 0)
        return read_coding(n, value);
    if (strcasecmp(field, "space directions") == 0)
        return read_directions(n, value);
    if (strcasecmp(field, "data file") == 0 || strcasecmp(field, "datafile") == 0)
        return read_file_name(n, value);
    if (strcasecmp(field, "space units") == 0 || strcasecmp(field, "units") == 0)
        read_unit(n, value);
    if (strcasecmp(field, "endian") == 0) {
        n->has_endian = true;
        n->header->big_endian = strcasecmp(value, "big") == 0;
        if (!n->header->big_endian && strcasecmp(value, "little") != 0)
            return wrong(n, field, value);
    }
    return DEM_OK;  // others say nothing about the shape
}

// the three axes that count: of more than three those of one voxel go
static dem_status choose_axes(nrrd *n)
{
    if (n->axes == 0 || n->given_sizes != n->axes)
        return dem_reader_fail(&n->r, "'dimension' and 'sizes' do not agree or are missing; write the image again");
    int kept[3], count = 0, spare = n->axes - 3;
    if (spare < 0)
        return dem_reader_fail(&n->r, "the image has %d axes; stack the slices to one in three dimensions", n->axes);
    for (int i = 0; i < n->axes; i++) {
        if (spare > 0 && n->sizes[i] == 1) {
            spare--;
            continue;
        }
        if (count == 3)
            return dem_reader_fail(&n->r, "the image has %d axes; save one image of labels in three dimensions",
                                   n->axes);
        kept[count++] = i;
    }
    double sizes[3];
    dem_volume *v = &n->header->volume;
    v->spaced = n->has_directions || n->has_spacings;
    for (int k = 0; k < 3; k++) {
        sizes[k] = n->sizes[kept[k]];
        double step = n->has_spacings ? n->spacings[kept[k]] : 1;
        if (!n->has_directions && !(step > 0 && step < 1e60))
            return dem_reader_fail(&n->r, "a spacing is not positive; correct 'spacings'");
        v->axes[k] = n->has_directions ? n->directions[kept[k]]
                                       : (dem_vec3){k == 0 ? step : 0, k == 1 ? step : 0, k == 2 ? step : 0};
    }
    return dem_header_sizes(&n->r, sizes, n->header);
}

static dem_status finish(nrrd *n)
{
    dem_volume_header *h = n->header;
    if (!n->has_type || !n->has_coding)
        return dem_reader_fail(&n->r, "'%s' is missing; write the image again", n->has_type ? "encoding" : "type");
    if (!n->has_endian && h->coding != DEM_CODING_TEXT && h->type != DEM_VOXEL_INT8 && h->type != DEM_VOXEL_UINT8)
        return dem_reader_fail(&n->r, "'endian' is missing; add 'endian: little' or 'endian: big'");
    DEM_TRY(choose_axes(n));
    DEM_TRY(dem_header_check(&n->r, h));
    dem_error unknown;
    memcpy(h->volume.unit_name, n->unit, sizeof n->unit);
    if (*n->unit && dem_unit(n->unit, DEM_DIMENSION_LENGTH, &h->volume.unit, &unknown) != DEM_OK) {
        h->volume.unit = 0;
        h->volume.unit_name[0] = 0;
        dem_log(n->ctx, DEM_LOG_WARNING, "the header's unit '%s' is not known; give it with --unit", n->unit);
    }
    return DEM_OK;
}

dem_status dem_nrrd_header(const dem_ctx *ctx, const char *name, const char *bytes, size_t size,
                           dem_volume_header *header, dem_error *error)
{
    dem_mesh none;
    nrrd n = {.r = dem_reader_begin(ctx, name, bytes, size, &none, error), .ctx = ctx, .header = header};
    bool ended = false;
    dem_reader_line(&n.r);  // the magic
    while (!ended && dem_reader_line(&n.r)) {
        char line[VOLUME_LINE], *field, *value;
        dem_header_line(&n.r, line);
        ended = !*line;
        if (ended || *line == '#')
            continue;
        char *key = strstr(line, ":="), *colon = strchr(line, ':');
        if (key && key == colon)
            continue;
        if (!dem_header_split(line, ":", &field, &value))
            return dem_reader_fail(&n.r, "neither 'field: value' nor the blank line that ends the header; "
                                         "write the image again");
        DEM_TRY(read_field(&n, field, value));
    }
    if (!ended && !*header->file)
        return dem_reader_fail(&n.r, "the header does not end in a blank line; write the image again");
    header->data = n.r.next ? (size_t)(n.r.next - bytes) : size;
    return finish(&n);
}
