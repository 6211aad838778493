#include "mesh/read.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "mesh/reader.h"

enum { STL_HEADER = 84, STL_FACET = 50, LOOK_BYTES = 1024 };

static const struct {
    const char *name, *suffix;
    dem_status (*read)(const dem_ctx *, const char *, const char *, size_t, dem_mesh *, dem_error *);
} formats[] = {
    [DEM_FORMAT_STL_BINARY] = {"binary STL", "stl", dem_read_stl_binary},
    [DEM_FORMAT_STL_TEXT] = {"text STL", "stl", dem_read_stl_text},
    [DEM_FORMAT_OBJ] = {"OBJ", "obj", dem_read_obj},
    [DEM_FORMAT_PLY] = {"PLY", "ply", dem_read_ply},
    [DEM_FORMAT_OFF] = {"OFF", "off", dem_read_off},
};

static size_t stl_header_count(const char *bytes)
{
    const unsigned char *b = (const unsigned char *)bytes + 80;
    return (size_t)b[0] | (size_t)b[1] << 8 | (size_t)b[2] << 16 | (size_t)b[3] << 24;
}

static bool is_text(const char *bytes, size_t size)
{
    return !memchr(bytes, 0, size < LOOK_BYTES ? size : LOOK_BYTES);
}

// "OFF" with any of the prefixes for texture, colour, normals and dimension
static bool is_off_header(dem_word word)
{
    static const char *const prefixes[] = {"ST", "C", "N", "4", "n"};
    const char *p = word.text, *end = p + word.length;
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++) {
        size_t length = strlen(prefixes[i]);
        if ((size_t)(end - p) >= length && memcmp(p, prefixes[i], length) == 0)
            p += length;
    }
    return end - p == 3 && memcmp(p, "OFF", 3) == 0;
}

static bool starts_as_number(dem_word word)
{
    double value;
    return dem_parse_double(word.text, word.text + word.length, &value);
}

// maybe with decimal commas: the reader refuses those
static bool three_numbers(dem_reader *r)
{
    for (int k = 0; k < 3; k++)
        if (!starts_as_number(dem_reader_word(r)))
            return false;
    return true;
}

// the first line that is neither blank nor a comment
static bool first_line(dem_reader *r)
{
    while (dem_reader_line(r)) {
        reader_skip_blanks(r);
        if (r->at < r->stop && *r->at != '#')
            return true;
    }
    return false;
}

// text with a vertex line anywhere
static bool is_obj(dem_reader *r)
{
    dem_reader_rewind(r);
    while (first_line(r)) {
        dem_word word = dem_reader_word(r);
        if (word.length == 1 && *word.text == 'v' && three_numbers(r))
            return true;
    }
    return false;
}

// what a file is that surely is no mesh; NULL where that is not known
static const char *known_stranger(const char *bytes, size_t size)
{
    static const struct {
        const char *start, *what;
    } strangers[] = {
        {"\x89PNG", "is a PNG picture, not a mesh"},
        {"\xff\xd8\xff", "is a JPEG picture, not a mesh"},
        {"GIF8", "is a GIF picture, not a mesh"},
        {"II*", "is a TIFF picture, not a mesh; save the stack of labels as NRRD or MetaImage"},
        {"%PDF", "is a PDF document, not a mesh"},
        {"\x7f"
         "ELF",
         "is a program, not a mesh"},
        {"\x1f\x8b", "is compressed; unpack it with gunzip first"},
        {"PK\x03\x04", "is a zip archive; unpack it first"},
        {"glTF", "is a glTF scene, which only the import by assimp reads; export the mesh as STL, OBJ, PLY or OFF"},
        {"BZh", "is compressed; unpack it with bunzip2 first"},
        {"\xfd"
         "7zXZ",
         "is compressed; unpack it with unxz first"},
        {"\xff\xfe", "is UTF-16 text; save it as UTF-8 or ASCII"},
        {"\xfe\xff", "is UTF-16 text; save it as UTF-8 or ASCII"},
    };
    for (size_t i = 0; i < sizeof strangers / sizeof *strangers; i++) {
        size_t length = strlen(strangers[i].start);
        if (size > length && memcmp(bytes, strangers[i].start, length) == 0)
            return strangers[i].what;
    }
    return NULL;
}

dem_mesh_format dem_mesh_sniff(const char *name, const char *bytes, size_t size)
{
    if (size >= STL_HEADER && (size - STL_HEADER) / STL_FACET == stl_header_count(bytes) &&
        (size - STL_HEADER) % STL_FACET == 0)
        return DEM_FORMAT_STL_BINARY;
    if (known_stranger(bytes, size))
        return DEM_FORMAT_UNKNOWN;
    dem_mesh ignored;
    dem_reader r = dem_reader_begin(NULL, name, bytes, size, &ignored, NULL);
    bool text = is_text(bytes, size);
    if (first_line(&r)) {
        dem_word word = dem_reader_word(&r);
        if (word.length == 3 && memcmp(word.text, "ply", 3) == 0)
            return DEM_FORMAT_PLY;
        if (is_off_header(word) || (text && dem_file_has_suffix(name, "off") && starts_as_number(word)))
            return DEM_FORMAT_OFF;
        if (text && dem_word_is(word, "solid"))
            return DEM_FORMAT_STL_TEXT;
        if (text && is_obj(&r))
            return DEM_FORMAT_OBJ;
    }
    if (!text && dem_file_has_suffix(name, "stl"))
        return DEM_FORMAT_STL_BINARY;
    return DEM_FORMAT_UNKNOWN;
}

dem_status dem_mesh_refuse(const char *name, const char *bytes, size_t size, const char *supported, dem_error *error)
{
    const char *what = known_stranger(bytes, size);
    if (what)
        return dem_fail_at(error, DEM_BAD_INPUT, name, 0, "%s%s%s", what,
                           strchr(what, ';') ? "" : "; supported: ", strchr(what, ';') ? "" : supported);
    dem_mesh ignored;
    dem_reader r = dem_reader_begin(NULL, name, bytes, size, &ignored, error);
    bool text = is_text(bytes, size);
    if (text && first_line(&r) && three_numbers(&r))
        return dem_fail_at(error, DEM_BAD_INPUT, name, 0,
                           "not a mesh but a cloud of points, without faces; make a surface "
                           "of it first; supported: %s",
                           supported);
    if (!text && size >= STL_HEADER)
        return dem_fail_at(error, DEM_BAD_INPUT, name, 0,
                           "not a mesh (as binary STL its header would say %zu triangles, "
                           "the file has room for %zu); supported: %s",
                           stl_header_count(bytes), (size - STL_HEADER) / STL_FACET, supported);
    return dem_fail_at(error, DEM_BAD_INPUT, name, 0, "not a mesh; supported: %s", supported);
}

void dem_mesh_warn_precision(const dem_ctx *ctx, const dem_mesh *mesh)
{
    if (!mesh->single_precision)
        return;
    dem_box box = box_empty();
    for (size_t i = 0; i < mesh->vertex_count; i++)
        box = box_with(box, mesh->vertices[i]);
    double size = box_diagonal(box), far = 0;
    for (int axis = 0; axis < 3; axis++)
        far = fmax(far, fmax(fabs(v3_get(box.low, axis)), fabs(v3_get(box.high, axis))));
    if (!(size < 1e-4 * far))
        return;
    char size_text[32], far_text[32], step_text[32];
    dem_log(ctx, DEM_LOG_WARNING,
            "precision is lost: the grain is %s across at coordinates of %s, where the 32-bit numbers "
            "of the file lie %s apart; move it to the origin before export",
            dem_format_double(size_text, sizeof size_text, size, 3),
            dem_format_double(far_text, sizeof far_text, far, 3),
            dem_format_double(step_text, sizeof step_text, ldexp(1, ilogb(far) - 23), 2));
}

static void warn_name(const dem_ctx *ctx, const char *name, dem_mesh_format format)
{
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (formats[i].suffix && dem_file_has_suffix(name, formats[i].suffix) &&
            strcmp(formats[i].suffix, formats[format].suffix) != 0) {
            dem_log(ctx, DEM_LOG_WARNING, "content is %s although the name ends in .%s; read as %s",
                    formats[format].name, formats[i].suffix, formats[format].name);
            return;
        }
}

dem_status dem_mesh_read_bytes(const dem_ctx *ctx, const char *name, dem_mesh_format format, dem_buffer *bytes,
                               dem_mesh *mesh, dem_error *error)
{
    dem_ctx about = ctx ? *ctx : (dem_ctx){0};
    if (!about.subject)
        about.subject = name;
    warn_name(&about, name, format);
    dem_status status = formats[format].read(&about, name, bytes->data, bytes->size, mesh, error);
    dem_buffer_release(bytes);
    if (status == DEM_OK)
        dem_mesh_warn_precision(&about, mesh);
    return status;
}

dem_status dem_mesh_read(const dem_ctx *ctx, const char *path, dem_mesh *mesh, dem_error *error)
{
    *mesh = (dem_mesh){0};
    dem_buffer bytes;
    DEM_TRY(dem_file_read(path, &bytes, error));
    const char *name = strcmp(path, "-") == 0 ? "standard input" : path;
    dem_mesh_format format = dem_mesh_sniff(name, bytes.data, bytes.size);
    if (format != DEM_FORMAT_UNKNOWN)
        return dem_mesh_read_bytes(ctx, name, format, &bytes, mesh, error);
    dem_status status = dem_mesh_refuse(name, bytes.data, bytes.size, "STL, OBJ, PLY, OFF", error);
    dem_buffer_release(&bytes);
    return status;
}
