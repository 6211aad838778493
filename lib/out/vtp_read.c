// The reader expects what the writer puts, text by text; so nothing is left to be guessed. The XML is read first, which
// tells the size of every block and so that of the file; only then memory is taken.
#include "out/vtp_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

enum { NAME_BYTES = 64, MOST_COMPONENTS = 1000, MOST_ARRAYS = 1000 };

static const char HEAD[] = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"";
static const char HEAD_END[] = "\" header_type=\"UInt64\">\n<PolyData>\n";
static const char RAW[] = "</PolyData>\n<AppendedData encoding=\"raw\">\n_", TAIL[] = "\n</AppendedData>\n</VTKFile>\n";

// an array as it is declared
typedef struct block {
    char name[NAME_BYTES];
    dem_vtp_type type;
    int width;
    size_t tuples;
} block;

typedef struct parser {
    const char *begin, *at, *end;
    block *blocks;
    size_t block_count, block_capacity;
    uint64_t offset;  // of the next block
    size_t fields, point_arrays, cell_arrays;
    size_t points, vertices, lines, triangles;
    char scalars[NAME_BYTES];
    bool no_memory;
} parser;

// ---- the XML

static bool skip(parser *p, const char *text)
{
    size_t length = strlen(text);
    if ((size_t)(p->end - p->at) < length || memcmp(p->at, text, length) != 0)
        return false;
    p->at += length;
    return true;
}

// a whole number as it is printed: no sign, no zeros in front
static bool read_count(parser *p, size_t *count)
{
    const char *first = p->at;
    *count = 0;
    for (; p->at < p->end && *p->at >= '0' && *p->at <= '9'; p->at++) {
        if (*count > SIZE_MAX / 100)
            return false;
        *count = 10 * *count + (size_t)(*p->at - '0');
    }
    return p->at > first && (*first != '0' || p->at == first + 1);
}

// up to the quote that ends it
static bool read_name(parser *p, char name[NAME_BYTES])
{
    size_t length = 0;
    for (; p->at < p->end && *p->at != '"'; p->at++) {
        if (length + 1 == NAME_BYTES || (unsigned char)*p->at < ' ' || strchr("<>&", *p->at))
            return false;
        name[length++] = *p->at;
    }
    name[length] = 0;
    return length > 0 && skip(p, "\"");
}

static bool read_type(parser *p, dem_vtp_type *type)
{
    for (size_t i = 0; i < DEM_VTP_TYPES; i++)
        if (skip(p, dem_vtp_kinds[i].name)) {
            *type = (dem_vtp_type)i;
            return true;
        }
    return false;
}

static bool read_array(parser *p, bool field, size_t tuples)
{
    block b = {.tuples = tuples};
    size_t width, offset;
    if (!skip(p, "<DataArray type=\"") || !read_type(p, &b.type) || !skip(p, "\" Name=\"") || !read_name(p, b.name) ||
        !skip(p, " NumberOfComponents=\"") || !read_count(p, &width) || !skip(p, "\"") ||
        (field && !skip(p, " NumberOfTuples=\"1\"")) || !skip(p, " format=\"appended\" offset=\"") ||
        !read_count(p, &offset) || !skip(p, "\"/>\n"))
        return false;
    if (width < 1 || width > MOST_COMPONENTS || offset != p->offset || p->block_count == MOST_ARRAYS)
        return false;
    b.width = (int)width;
    p->offset += sizeof(uint64_t) + tuples * width * dem_vtp_kinds[b.type].bytes;
    p->no_memory = !dem_grow(&p->blocks, &p->block_capacity, p->block_count, sizeof *p->blocks);
    if (p->no_memory)
        return false;
    p->blocks[p->block_count++] = b;
    return true;
}

static bool read_arrays(parser *p, bool field, size_t tuples, const char *end, size_t *count)
{
    while (!skip(p, end)) {
        if (!read_array(p, field, tuples))
            return false;
        (*count)++;
    }
    return true;
}

// an array whose name and kind are fixed
static bool read_known(parser *p, const char *name, dem_vtp_type type, int width, size_t tuples)
{
    if (!read_array(p, false, tuples))
        return false;
    const block *b = &p->blocks[p->block_count - 1];
    return strcmp(b->name, name) == 0 && b->type == type && b->width == width;
}

static bool read_cells(parser *p, const char *open, const char *close, size_t count, size_t corners)
{
    return count == 0 || (skip(p, open) && read_known(p, "connectivity", DEM_VTP_INT64, 1, corners * count) &&
                          read_known(p, "offsets", DEM_VTP_INT64, 1, count) && skip(p, close));
}

static bool read_counts(parser *p)
{
    size_t most = (size_t)(p->end - p->begin);  // each takes more than a byte
    return skip(p, "<Piece NumberOfPoints=\"") && read_count(p, &p->points) && skip(p, "\" NumberOfVerts=\"") &&
           read_count(p, &p->vertices) && skip(p, "\" NumberOfLines=\"") && read_count(p, &p->lines) &&
           skip(p, "\" NumberOfStrips=\"0\" NumberOfPolys=\"") && read_count(p, &p->triangles) && skip(p, "\">\n") &&
           p->points <= most && p->lines <= most && p->triangles <= most &&
           (p->vertices == 0 || p->vertices == p->points);
}

static bool read_xml(parser *p)
{
    if (!skip(p, "<FieldData>\n") || !read_arrays(p, true, 1, "</FieldData>\n", &p->fields))
        return false;
    if (!read_counts(p) || !skip(p, "<Points>\n") || !read_known(p, "Points", DEM_VTP_FLOAT64, 3, p->points) ||
        !skip(p, "</Points>\n<PointData"))
        return false;
    if (skip(p, " Scalars=\"") && !read_name(p, p->scalars))
        return false;
    return skip(p, ">\n") && read_arrays(p, false, p->points, "</PointData>\n<CellData>\n", &p->point_arrays) &&
           read_arrays(p, false, p->vertices + p->lines + p->triangles, "</CellData>\n", &p->cell_arrays) &&
           read_cells(p, "<Verts>\n", "</Verts>\n", p->vertices, 1) &&
           read_cells(p, "<Lines>\n", "</Lines>\n", p->lines, 2) &&
           read_cells(p, "<Polys>\n", "</Polys>\n", p->triangles, 3) && skip(p, "</Piece>\n") && skip(p, RAW);
}

// ---- the blocks

// takes the next block; NULL: its size is wrong, or there is no memory
static const void *take_block(parser *p, const block *b, dem_arena *arena)
{
    uint64_t bytes, want = b->tuples * (uint64_t)b->width * dem_vtp_kinds[b->type].bytes;
    memcpy(&bytes, p->at, sizeof bytes);
    p->at += sizeof bytes;
    void *data = bytes == want ? dem_arena_take(arena, (size_t)want + 1, 1) : NULL;
    if (data)
        memcpy(data, p->at, want);
    p->at += want;
    return data;
}

static const dem_vtp_array *take_arrays(parser *p, const block **next, size_t count, dem_arena *arena)
{
    dem_vtp_array *arrays = dem_arena_take(arena, count + 1, sizeof *arrays);
    for (size_t i = 0; arrays && i < count; i++, (*next)++) {
        const block *b = *next;
        char *name = dem_arena_take(arena, NAME_BYTES, 1);
        arrays[i] = (dem_vtp_array){name, b->type, b->width, take_block(p, b, arena)};
        if (!name || !arrays[i].data)
            return NULL;
        memcpy(name, b->name, NAME_BYTES);
    }
    return arrays;
}

// whole numbers first, first + step, ...
static bool in_steps(const int64_t *numbers, size_t count, int64_t first, int64_t step)
{
    for (size_t i = 0; i < count; i++)
        if (numbers[i] != first + step * (int64_t)i)
            return false;
    return true;
}

static const uint32_t *take_cells(parser *p, const block **next, size_t count, size_t corners, dem_arena *arena)
{
    const int64_t *connectivity = take_block(p, (*next)++, arena), *offsets = take_block(p, (*next)++, arena);
    uint32_t *cells = dem_arena_take(arena, corners * count, sizeof *cells);
    if (!connectivity || !offsets || !cells || !in_steps(offsets, count, (int64_t)corners, (int64_t)corners))
        return NULL;
    for (size_t i = 0; i < corners * count; i++) {
        if (connectivity[i] < 0 || (uint64_t)connectivity[i] >= p->points || connectivity[i] > UINT32_MAX)
            return NULL;
        cells[i] = (uint32_t)connectivity[i];
    }
    return cells;
}

static bool take_time(dem_vtp *v)
{
    v->time = NAN;
    if (v->field_count == 0 || strcmp(v->fields[0].name, "TimeValue") != 0)
        return true;
    const dem_vtp_array *a = v->fields++;
    v->field_count--;
    if (a->type != DEM_VTP_FLOAT64 || a->width != 1)
        return false;
    v->time = *(const double *)a->data;
    return !isnan(v->time);
}

static bool take_blocks(parser *p, dem_vtp_file *file)
{
    dem_vtp *v = &file->vtp;
    const block *next = p->blocks;
    *v = (dem_vtp){.field_count = p->fields,
                   .point_count = p->points,
                   .point_array_count = p->point_arrays,
                   .vertices = p->vertices > 0,
                   .line_count = p->lines,
                   .triangle_count = p->triangles,
                   .cell_array_count = p->cell_arrays};
    if (!(v->fields = take_arrays(p, &next, p->fields, &file->arena)) || !take_time(v) ||
        !(v->points = take_block(p, next++, &file->arena)) ||
        !(v->point_arrays = take_arrays(p, &next, p->point_arrays, &file->arena)) ||
        !(v->cell_arrays = take_arrays(p, &next, p->cell_arrays, &file->arena)))
        return false;
    if (p->scalars[0]) {
        char *scalars = dem_arena_take(&file->arena, NAME_BYTES, 1);
        if (!scalars)
            return false;
        v->scalars = memcpy(scalars, p->scalars, NAME_BYTES);
    }
    if (p->vertices) {
        const int64_t *connectivity = take_block(p, next++, &file->arena);
        const int64_t *offsets = take_block(p, next++, &file->arena);
        if (!connectivity || !offsets || !in_steps(connectivity, p->vertices, 0, 1) ||
            !in_steps(offsets, p->vertices, 1, 1))
            return false;
    }
    return (p->lines == 0 || (v->lines = take_cells(p, &next, p->lines, 2, &file->arena))) &&
           (p->triangles == 0 || (v->triangles = take_cells(p, &next, p->triangles, 3, &file->arena)));
}

// ---- the file

static dem_status refuse(const parser *p, const char *name, dem_error *error)
{
    if (p->no_memory)
        return dem_fail_memory(error);
    return dem_fail_at(error, DEM_BAD_INPUT, name, 0,
                       "is not a VTP file as these tools write it (byte %zu); name a file written by dem-run or "
                       "dem-clump",
                       (size_t)(p->at - p->begin));
}

static dem_status decode(parser *p, const char *name, dem_vtp_file *file, dem_error *error)
{
    const uint16_t probe = 1;
    bool little = *(const unsigned char *)&probe, swapped = false;
    bool ours = skip(p, HEAD) && (skip(p, little ? "LittleEndian" : "BigEndian") ||
                                  (swapped = skip(p, little ? "BigEndian" : "LittleEndian")));
    if (swapped)
        return dem_fail_at(error, DEM_BAD_INPUT, name, 0,
                           "was written on a machine of the other byte order; draw it there");
    if (!ours || !skip(p, HEAD_END) || !read_xml(p))
        return refuse(p, name, error);
    uint64_t left = (uint64_t)(p->end - p->at), want = p->offset + strlen(TAIL);
    if (left < want)
        return dem_fail_at(error, DEM_BAD_INPUT, name, 0, "is cut short by %llu bytes; copy it again, or take another",
                           (unsigned long long)(want - left));
    if (!take_blocks(p, file) || !skip(p, TAIL) || p->at != p->end)
        return file->arena.failed ? dem_fail_memory(error) : refuse(p, name, error);
    return DEM_OK;
}

dem_status dem_vtp_decode(const char *bytes, size_t size, const char *name, dem_vtp_file *file, dem_error *error)
{
    parser p = {.begin = bytes, .at = bytes, .end = bytes + size};
    *file = (dem_vtp_file){0};
    dem_status status = decode(&p, name, file, error);
    free(p.blocks);
    if (status != DEM_OK)
        dem_vtp_file_release(file);
    return status;
}

dem_status dem_vtp_read(const char *path, dem_vtp_file *file, dem_error *error)
{
    dem_buffer bytes;
    *file = (dem_vtp_file){0};
    DEM_TRY(dem_file_read(path, &bytes, error));
    dem_status status = dem_vtp_decode(bytes.data, bytes.size, path, file, error);
    dem_buffer_release(&bytes);
    return status;
}

void dem_vtp_file_release(dem_vtp_file *file)
{
    dem_arena_release(&file->arena);
    *file = (dem_vtp_file){0};
}

const dem_vtp_array *dem_vtp_find(const dem_vtp *vtp, const char *name)
{
    for (size_t i = 0; i < vtp->point_array_count; i++)
        if (strcmp(vtp->point_arrays[i].name, name) == 0)
            return &vtp->point_arrays[i];
    return NULL;
}

const void *dem_vtp_cells(const dem_vtp *v, const char *name, dem_vtp_type type, int width)
{
    for (size_t i = 0; i < v->cell_array_count; i++)
        if (strcmp(v->cell_arrays[i].name, name) == 0 && v->cell_arrays[i].type == type &&
            v->cell_arrays[i].width == width)
            return v->cell_arrays[i].data;
    return NULL;
}

double dem_vtp_value(const dem_vtp_array *a, size_t point, int component)
{
    size_t at = point * (size_t)a->width + (size_t)component;
    switch (a->type) {
    case DEM_VTP_FLOAT64:
        return ((const double *)a->data)[at];
    case DEM_VTP_FLOAT32:
        return (double)((const float *)a->data)[at];
    case DEM_VTP_INT32:
        return ((const int32_t *)a->data)[at];
    case DEM_VTP_UINT32:
        return ((const uint32_t *)a->data)[at];
    case DEM_VTP_INT64:
        return (double)((const int64_t *)a->data)[at];
    }
    return NAN;
}
