#include "mesh/read.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/reader.h"

typedef enum ply_type { PLY_CHAR, PLY_UCHAR, PLY_SHORT, PLY_USHORT, PLY_INT, PLY_UINT, PLY_FLOAT, PLY_DOUBLE } ply_type;
typedef enum ply_role { PLY_X, PLY_Y, PLY_Z, PLY_CORNERS, PLY_UNUSED } ply_role;
typedef enum ply_kind { PLY_VERTEX, PLY_FACE, PLY_OTHER } ply_kind;
typedef enum ply_form { PLY_NONE, PLY_TEXT, PLY_LITTLE, PLY_BIG } ply_form;

static const struct {
    const char *name, *other_name;
    size_t size;
} types[] = {{"char", "int8", 1}, {"uchar", "uint8", 1}, {"short", "int16", 2},   {"ushort", "uint16", 2},
             {"int", "int32", 4}, {"uint", "uint32", 4}, {"float", "float32", 4}, {"double", "float64", 8}};

typedef struct ply_property {
    ply_type type, count_type;
    bool list;
    ply_role role;
} ply_property;

typedef struct ply_element {
    ply_kind kind;
    dem_shown name;
    size_t count;
    size_t first, properties;  // range of the file's properties
    size_t least_bytes;        // of one element, binary; exact without lists
    bool lists;
} ply_element;

typedef struct ply_file {
    dem_reader r;
    ply_form form;
    ply_element *elements;
    size_t element_count, element_capacity;
    ply_property *properties;
    size_t property_count, property_capacity;
} ply_file;

static dem_status read_format(ply_file *ply)
{
    dem_word word = dem_reader_word(&ply->r);
    ply->form = dem_word_is(word, "ascii")                  ? PLY_TEXT
                : dem_word_is(word, "binary_little_endian") ? PLY_LITTLE
                : dem_word_is(word, "binary_big_endian")    ? PLY_BIG
                                                            : PLY_NONE;
    if (ply->form == PLY_NONE)
        return dem_reader_unexpected(&ply->r, word, "the format ascii, binary_little_endian or binary_big_endian");
    return DEM_OK;
}

static dem_status read_element_line(ply_file *ply)
{
    if (!dem_grow(&ply->elements, &ply->element_capacity, ply->element_count, sizeof *ply->elements))
        return dem_fail_memory(ply->r.error);
    ply_element *e = &ply->elements[ply->element_count];
    dem_word name = dem_reader_word(&ply->r);
    *e = (ply_element){.name = dem_word_show(name), .first = ply->property_count};
    e->kind = dem_word_is(name, "vertex") ? PLY_VERTEX : dem_word_is(name, "face") ? PLY_FACE : PLY_OTHER;
    for (size_t i = 0; e->kind != PLY_OTHER && i < ply->element_count; i++)
        if (ply->elements[i].kind == e->kind)
            return dem_reader_fail(&ply->r, "a second element '%s' in the header; export the mesh again", e->name.text);
    int64_t count;
    DEM_TRY(dem_reader_whole(&ply->r, &count));
    if (count < 0)
        return dem_reader_fail(&ply->r, "header says %" PRId64 " of element '%s'; export the mesh again", count,
                               e->name.text);
    e->count = (size_t)count;
    ply->element_count++;
    return DEM_OK;
}

static dem_status read_type(ply_file *ply, dem_word word, ply_type *type)
{
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (dem_word_is(word, types[i].name) || dem_word_is(word, types[i].other_name)) {
            *type = (ply_type)i;
            return DEM_OK;
        }
    return dem_reader_unexpected(&ply->r, word, "a PLY type");
}

static ply_role role_of(const ply_element *e, dem_word name)
{
    if (e->kind == PLY_VERTEX && name.length == 1 && *name.text >= 'x' && *name.text <= 'z')
        return (ply_role)(*name.text - 'x');
    if (e->kind == PLY_FACE && (dem_word_is(name, "vertex_indices") || dem_word_is(name, "vertex_index")))
        return PLY_CORNERS;
    return PLY_UNUSED;
}

static dem_status read_property_line(ply_file *ply)
{
    if (ply->element_count == 0)
        return dem_reader_fail(&ply->r, "a property before the first element; export the mesh again");
    if (!dem_grow(&ply->properties, &ply->property_capacity, ply->property_count, sizeof *ply->properties))
        return dem_fail_memory(ply->r.error);
    ply_element *e = &ply->elements[ply->element_count - 1];
    ply_property property = {0};
    dem_word word = dem_reader_word(&ply->r);
    property.list = dem_word_is(word, "list");
    if (property.list) {
        DEM_TRY(read_type(ply, dem_reader_word(&ply->r), &property.count_type));
        if (property.count_type >= PLY_FLOAT)
            return dem_reader_fail(&ply->r, "a list counted in floating point; export the mesh again");
        word = dem_reader_word(&ply->r);
    }
    DEM_TRY(read_type(ply, word, &property.type));
    property.role = role_of(e, dem_reader_word(&ply->r));
    if (property.role != PLY_UNUSED && property.list != (property.role == PLY_CORNERS))
        return dem_reader_fail(&ply->r, "coordinates must be single numbers and vertex_indices a list; export the mesh "
                                        "again");
    e->lists |= property.list;
    e->least_bytes += types[property.list ? property.count_type : property.type].size;
    e->properties++;
    ply->properties[ply->property_count++] = property;
    return DEM_OK;
}

static dem_status check_header(ply_file *ply)
{
    dem_reader *r = &ply->r;
    unsigned found = 0;
    bool strips = false, faces = false;
    for (size_t i = 0; i < ply->element_count; i++) {
        const ply_element *e = &ply->elements[i];
        for (size_t k = e->first; k < e->first + e->properties; k++)
            found |= 1u << ply->properties[k].role;
        if (e->kind == PLY_VERTEX && ply->form != PLY_TEXT)
            for (size_t k = e->first; k < e->first + e->properties; k++)
                r->mesh->single_precision |= ply->properties[k].role == PLY_X && ply->properties[k].type == PLY_FLOAT;
        faces |= e->kind == PLY_FACE && e->count;
        strips |= strcmp(e->name.text, "tristrips") == 0;
    }
    if (ply->form == PLY_NONE)
        return dem_reader_fail(r, "the PLY header has no 'format' line; export the mesh again");
    if ((found & 7) != 7)
        return dem_reader_fail(r, "the PLY header names no vertices with x, y and z; export the mesh again");
    if (faces && !(found & 1u << PLY_CORNERS))
        return dem_reader_fail(r, "the faces have no 'vertex_indices'; export the mesh again");
    if (!faces && strips)
        return dem_reader_fail(r, "triangle strips instead of faces; convert them to triangles first");
    return DEM_OK;
}

static dem_status read_header(ply_file *ply)
{
    dem_reader *r = &ply->r;
    dem_reader_line(r);
    bool cr_only = r->stop < r->end && *r->stop == '\r' && !(r->stop + 1 < r->end && r->stop[1] == '\n');
    while (dem_reader_line(r)) {
        dem_word word = dem_reader_word(r);
        if (word.length == 0 || dem_word_is(word, "comment") || dem_word_is(word, "obj_info"))
            continue;
        if (dem_word_is(word, "end_header")) {
            if (cr_only)
                r->next = r->stop + 1;  // a '\n' behind it is data
            return check_header(ply);
        }
        if (dem_word_is(word, "format"))
            DEM_TRY(read_format(ply));
        else if (dem_word_is(word, "element"))
            DEM_TRY(read_element_line(ply));
        else if (dem_word_is(word, "property"))
            DEM_TRY(read_property_line(ply));
        else
            return dem_reader_unexpected(r, word, "a line of the PLY header");
    }
    return dem_reader_unexpected(r, (dem_word){0}, "'end_header'");
}

static double binary_value(const char *at, ply_type type, bool big)
{
    uint64_t bits = 0;
    size_t size = types[type].size;
    for (size_t i = 0; i < size; i++)
        bits |= (uint64_t)(unsigned char)at[big ? size - 1 - i : i] << 8 * i;
    uint32_t low = (uint32_t)bits;
    float single;
    double value;
    switch (type) {
    case PLY_CHAR:
        return (int8_t)low;
    case PLY_SHORT:
        return (int16_t)low;
    case PLY_INT:
        return (int32_t)low;
    case PLY_FLOAT:
        memcpy(&single, &low, sizeof single);
        return single;
    case PLY_DOUBLE:
        memcpy(&value, &bits, sizeof value);
        return value;
    default:
        return low;
    }
}

static dem_status cut_short(const dem_reader *r, const ply_element *e)
{
    return dem_reader_fail(r,
                           "unexpected end of file among the %zu elements '%s' of the header; the file is cut short, "
                           "export it again",
                           e->count, e->name.text);
}

static dem_status read_value(ply_file *ply, ply_type type, const ply_element *e, double *value)
{
    if (ply->form == PLY_TEXT)
        return dem_reader_number(&ply->r, value);
    size_t size = types[type].size;
    if ((size_t)(ply->r.end - ply->r.at) < size)
        return cut_short(&ply->r, e);
    *value = binary_value(ply->r.at, type, ply->form == PLY_BIG);
    ply->r.at += size;
    return DEM_OK;
}

static dem_status read_list(ply_file *ply, const ply_element *e, const ply_property *property, bool use)
{
    dem_reader *r = &ply->r;
    double count, value;
    DEM_TRY(read_value(ply, property->count_type, e, &count));
    if (!(count >= 0 && count <= UINT32_MAX) || count != floor(count))
        return dem_reader_fail(r,
                               "a list in element '%s' has a length below 0 or not whole; the file is damaged, export "
                               "it again",
                               e->name.text);
    size_t room = (size_t)(r->end - r->at) / (ply->form == PLY_TEXT ? 1 : types[property->type].size);
    if (count > (double)room)
        return dem_reader_fail(r,
                               "a list of %zu items in element '%s', file has room for %zu; the file is damaged or "
                               "cut short, export it again",
                               (size_t)count, e->name.text, room);
    if (!use && ply->form != PLY_TEXT) {
        r->at += (size_t)count * types[property->type].size;
        return DEM_OK;
    }
    for (size_t i = 0; i < (size_t)count; i++) {
        DEM_TRY(read_value(ply, property->type, e, &value));
        if (!use || property->role != PLY_CORNERS)
            continue;
        if (!(fabs(value) < 0x1p53) || value != floor(value))
            return dem_reader_fail(r,
                                   "face %zu refers to a vertex whose number is not whole; the file is damaged, "
                                   "export it again",
                                   r->face_count + 1);
        DEM_TRY(dem_reader_corner(r, (int64_t)value, 0));
    }
    return DEM_OK;
}

static dem_status read_element(ply_file *ply, const ply_element *e, bool use)
{
    dem_reader *r = &ply->r;
    double point[3], value;
    for (size_t k = e->first; k < e->first + e->properties; k++) {
        const ply_property *property = &ply->properties[k];
        if (property->list) {
            DEM_TRY(read_list(ply, e, property, use));
            continue;
        }
        DEM_TRY(read_value(ply, property->type, e, &value));
        if (property->role <= PLY_Z)
            point[property->role] = value;
    }
    if (use && e->kind == PLY_VERTEX)
        return dem_reader_vertex(r, (dem_vec3){point[0], point[1], point[2]});
    return use ? dem_reader_face(r) : DEM_OK;
}

// the next line that is not blank
static dem_status next_line(dem_reader *r, const ply_element *e)
{
    do {
        if (!dem_reader_line(r))
            return cut_short(r, e);
        reader_skip_blanks(r);
    } while (r->at == r->stop);
    return DEM_OK;
}

static dem_status read_elements(ply_file *ply, const ply_element *e, bool use)
{
    dem_reader *r = &ply->r;
    bool text = ply->form == PLY_TEXT;
    if (e->properties == 0)
        return DEM_OK;
    size_t least = text ? 2 * e->properties : e->least_bytes;
    size_t room = ((size_t)(r->end - (text ? r->next : r->at)) + (text ? 1 : 0)) / least;
    if (e->count > room)
        return dem_reader_fail(r,
                               "header says %zu of element '%s', file has room for %zu; the file is damaged or cut "
                               "short, export it again",
                               e->count, e->name.text, room);
    if (!use && !text && !e->lists) {
        r->at += e->count * e->least_bytes;
        return DEM_OK;
    }
    for (size_t i = 0; i < e->count; i++) {
        if (text)
            DEM_TRY(next_line(r, e));
        if (use || !text)
            DEM_TRY(read_element(ply, e, use));
    }
    return DEM_OK;
}

// more data than the header counts: the counts are wrong, and faces may be missing
static dem_status check_tail(ply_file *ply)
{
    dem_reader *r = &ply->r;
    const char *tail = ply->form == PLY_TEXT ? r->next : r->at;
    for (const char *p = tail; p < r->end; p++)
        if (*p && !text_is_blank(*p) && *p != '\n' && *p != '\r')
            return dem_reader_fail(r,
                                   "%td bytes behind the last element of the header; its counts are too small, export "
                                   "the mesh again",
                                   r->end - tail);
    return DEM_OK;
}

// vertices first and faces in a second pass over the data, whatever their order
static dem_status read_body(ply_file *ply)
{
    dem_reader *r = &ply->r;
    const char *body = r->next;
    long line = r->line;
    r->passes = 2;
    for (r->pass = 0; r->pass < 2; r->pass++) {
        r->next = r->at = r->stop = body;
        r->line = ply->form == PLY_TEXT ? line : 0;
        if (r->newline >= r->next)
            r->newline = body - 1;
        for (size_t i = 0; i < ply->element_count; i++) {
            const ply_element *e = &ply->elements[i];
            bool use = e->kind == (r->pass == 0 ? PLY_VERTEX : PLY_FACE);
            DEM_TRY(read_elements(ply, e, use));
            if (use && r->pass == 0)
                break;
        }
    }
    return check_tail(ply);
}

dem_status dem_read_ply(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                        dem_error *error)
{
    ply_file ply = {.r = dem_reader_begin(ctx, name, bytes, size, mesh, error)};
    dem_status status = read_header(&ply);
    if (status == DEM_OK)
        status = read_body(&ply);
    free(ply.elements);
    free(ply.properties);
    return dem_reader_end(&ply.r, status);
}
