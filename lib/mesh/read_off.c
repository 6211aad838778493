#include "mesh/read.h"

#include <inttypes.h>
#include <string.h>

#include "mesh/reader.h"

// shortest lines: "0 0 0\n" and "3 0 0 0\n"
enum { VERTEX_BYTES = 6, FACE_BYTES = 8 };

// the next line with something on it; what follows '#' is a comment
static bool next_line(dem_reader *r)
{
    while (dem_reader_line(r)) {
        const char *comment = memchr(r->at, '#', (size_t)(r->stop - r->at));
        if (comment)
            r->stop = comment;
        reader_skip_blanks(r);
        if (r->at < r->stop)
            return true;
    }
    return false;
}

// leaves `at` where the counts begin
static dem_status read_header(dem_reader *r)
{
    if (!next_line(r))
        return dem_reader_unexpected(r, (dem_word){0}, "'OFF'");
    const char *begin = r->at;
    dem_word word = dem_reader_word(r);
    if (word.length < 3 || memcmp(word.text + word.length - 3, "OFF", 3) != 0) {
        r->at = begin;  // the header may be left out
        return DEM_OK;
    }
    if (memchr(word.text, '4', word.length) || memchr(word.text, 'n', word.length))
        return dem_reader_fail(r, "'%s' has vertices of other than 3 dimensions; export plain OFF",
                               dem_word_show(word).text);
    begin = r->at;
    word = dem_reader_word(r);
    if (dem_word_is(word, "BINARY"))
        return dem_reader_fail(r, "binary OFF cannot be read; export OFF as text, or binary PLY or STL");
    r->at = begin;
    if (word.length == 0 && !next_line(r))
        return dem_reader_unexpected(r, (dem_word){0}, "the counts");
    return DEM_OK;
}

static dem_status read_counts(dem_reader *r, size_t *vertices, size_t *faces)
{
    int64_t v, f;
    DEM_TRY(dem_reader_whole(r, &v));
    DEM_TRY(dem_reader_whole(r, &f));
    if (v < 0 || f < 0)
        return dem_reader_fail(r, "negative counts in the OFF header; export the mesh again");
    size_t room = (size_t)(r->end - r->at) + 1;
    if ((uint64_t)v > room / VERTEX_BYTES)
        return dem_reader_fail(r,
                               "header says %" PRId64 " vertices, file has room for %zu; the file is damaged or cut "
                               "short, export it again",
                               v, room / VERTEX_BYTES);
    if ((uint64_t)f > (room - (size_t)v * VERTEX_BYTES) / FACE_BYTES)
        return dem_reader_fail(r,
                               "header says %" PRId64
                               " faces, file has room for %zu; the file is damaged or cut short, "
                               "export it again",
                               f, (room - (size_t)v * VERTEX_BYTES) / FACE_BYTES);
    *vertices = (size_t)v;
    *faces = (size_t)f;
    return DEM_OK;
}

// "3 0 1 2", maybe followed by a colour
static dem_status read_face(dem_reader *r)
{
    int64_t count, index;
    DEM_TRY(dem_reader_whole(r, &count));
    if (count < 0)
        return dem_reader_fail(r, "face %zu has %" PRId64 " corners; the file is damaged, export it again",
                               r->face_count + 1, count);
    for (int64_t k = 0; k < count; k++) {
        DEM_TRY(dem_reader_whole(r, &index));
        DEM_TRY(dem_reader_corner(r, index, 0));
    }
    return dem_reader_face(r);
}

static dem_status read_all(dem_reader *r)
{
    size_t vertices = 0, faces = 0;
    DEM_TRY(read_header(r));
    DEM_TRY(read_counts(r, &vertices, &faces));
    for (size_t i = 0; i < vertices; i++) {
        if (!next_line(r))
            return dem_reader_fail(
                r, "unexpected end of file: header says %zu vertices, %zu are there; export it again", vertices, i);
        dem_vec3 p;
        DEM_TRY(dem_reader_point(r, &p));
        DEM_TRY(dem_reader_vertex(r, p));
    }
    for (size_t i = 0; i < faces; i++) {
        if (!next_line(r))
            return dem_reader_fail(r, "unexpected end of file: header says %zu faces, %zu are there; export it again",
                                   faces, i);
        DEM_TRY(read_face(r));
    }
    if (next_line(r))
        return dem_reader_fail(r,
                               "data behind the %zu vertices and %zu faces of the header; its counts are too small, "
                               "export the mesh again",
                               vertices, faces);
    return DEM_OK;
}

dem_status dem_read_off(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                        dem_error *error)
{
    dem_reader r = dem_reader_begin(ctx, name, bytes, size, mesh, error);
    return dem_reader_end(&r, read_all(&r));
}
