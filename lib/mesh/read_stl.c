#include "mesh/read.h"

#include <string.h>

#include "base/memory.h"
#include "mesh/reader.h"

enum { STL_HEADER = 84, STL_FACET = 50, STL_NORMAL = 12 };

static uint32_t little_u32(const char *at)
{
    const unsigned char *b = (const unsigned char *)at;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static double little_float(const char *at)
{
    uint32_t bits = little_u32(at);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static dem_status read_binary_facet(dem_reader *r)
{
    dem_mesh *mesh = r->mesh;
    for (const char *at = r->at + STL_NORMAL; at < r->at + STL_NORMAL + 36; at += 12) {
        dem_vec3 p = {little_float(at), little_float(at + 4), little_float(at + 8)};
        if (!point_is_usable(p))
            return dem_reader_fail(r,
                                   "triangle %zu (byte %td) has a corner that is not finite; the file is damaged, "
                                   "export it again",
                                   mesh->triangle_count + 1, at - r->bytes);
        mesh->triangles[mesh->vertex_count] = (uint32_t)mesh->vertex_count;
        DEM_TRY(dem_reader_vertex(r, p));
    }
    mesh->triangle_count++;
    return DEM_OK;
}

dem_status dem_read_stl_binary(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                               dem_error *error)
{
    dem_reader r = dem_reader_begin(ctx, name, bytes, size, mesh, error);
    if (size < STL_HEADER)
        return dem_reader_fail(&r, "%zu bytes are too few for a binary STL; export it again", size);
    size_t count = little_u32(bytes + 80), room = (size - STL_HEADER) / STL_FACET;
    if (size - STL_HEADER != count * STL_FACET)
        return dem_reader_fail(&r,
                               "header says %zu triangles, file has room for %zu; the file is damaged or cut short, "
                               "export it again",
                               count, room);
    if (count > UINT32_MAX / 3)
        return dem_reader_fail(&r, "%zu triangles are more than can be counted; reduce the mesh first", count);
    mesh->vertices = dem_alloc(3 * count, sizeof *mesh->vertices);
    mesh->triangles = dem_alloc(3 * count, sizeof *mesh->triangles);
    if (!mesh->vertices || !mesh->triangles)
        return dem_reader_end(&r, dem_fail_memory(error));
    r.vertex_capacity = r.index_capacity = 3 * count;
    mesh->single_precision = true;
    dem_status status = DEM_OK;
    r.at = bytes + STL_HEADER;
    for (size_t i = 0; i < count && status == DEM_OK; i++, r.at += STL_FACET)
        status = read_binary_facet(&r);
    return dem_reader_end(&r, status);
}

static dem_status expect(dem_reader *r, const char *text, const char *wanted)
{
    dem_word word = dem_reader_word_beyond(r);
    return dem_word_is(word, text) ? DEM_OK : dem_reader_unexpected(r, word, wanted);
}

// a number may stand on the next line
static dem_status number_beyond(dem_reader *r, double *value)
{
    reader_skip_blanks(r);
    while (r->at == r->stop && dem_reader_line(r))
        reader_skip_blanks(r);
    return dem_reader_number(r, value);
}

// behind "facet": the normal, which is ignored whatever stands there, and the corners
static dem_status read_facet(dem_reader *r)
{
    dem_word word;
    do {
        word = dem_reader_word_beyond(r);
        if (word.length == 0 || dem_word_is(word, "vertex") || dem_word_is(word, "facet") ||
            dem_word_is(word, "endfacet"))
            return dem_reader_unexpected(r, word, "'outer loop'");
    } while (!dem_word_is(word, "outer"));
    DEM_TRY(expect(r, "loop", "'loop'"));
    for (;;) {
        word = dem_reader_word_beyond(r);
        if (dem_word_is(word, "endloop"))
            break;
        if (!dem_word_is(word, "vertex"))
            return dem_reader_unexpected(r, word, "'vertex' or 'endloop'");
        dem_vec3 p;
        DEM_TRY(number_beyond(r, &p.x));
        DEM_TRY(number_beyond(r, &p.y));
        DEM_TRY(number_beyond(r, &p.z));
        DEM_TRY(dem_reader_vertex(r, p));
        DEM_TRY(dem_reader_corner(r, (int64_t)r->mesh->vertex_count - 1, 0));
    }
    DEM_TRY(expect(r, "endfacet", "'endfacet'"));
    return dem_reader_face(r);
}

// behind "solid" and "endsolid" the rest of the line is a name, unless a facet follows on the same line
static void skip_name(dem_reader *r)
{
    for (;;) {
        dem_word word = dem_reader_word(r);
        if (word.length == 0)
            return;
        if (dem_word_is(word, "facet")) {
            const char *behind = r->at;
            bool facet = dem_word_is(dem_reader_word(r), "normal");
            r->at = facet ? word.text : behind;
            if (facet)
                return;
        }
    }
}

static dem_status read_solids(dem_reader *r)
{
    bool open = false;
    for (;;) {
        dem_word word = dem_reader_word_beyond(r);
        if (word.length == 0)
            break;
        if (dem_word_is(word, "facet")) {
            DEM_TRY(read_facet(r));
        } else if (dem_word_is(word, "solid")) {
            skip_name(r);
            open = true;
        } else if (dem_word_is(word, "endsolid")) {
            skip_name(r);
            open = false;
        } else {
            return dem_reader_unexpected(r, word, "'facet' or 'endsolid'");
        }
    }
    if (open)
        dem_log(r->ctx, DEM_LOG_WARNING, "line %ld: file ends without 'endsolid', it may be cut short", r->line);
    return DEM_OK;
}

dem_status dem_read_stl_text(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                             dem_error *error)
{
    dem_reader r = dem_reader_begin(ctx, name, bytes, size, mesh, error);
    return dem_reader_end(&r, read_solids(&r));
}
