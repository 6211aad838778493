#include "mesh/reader.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"

enum { PROGRESS_EVERY = 1 << 16 };  // vertices or triangles

dem_reader dem_reader_begin(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                            dem_error *error)
{
    *mesh = (dem_mesh){0};
    dem_reader r = {
        .ctx = ctx, .name = name, .bytes = bytes, .end = bytes + size, .passes = 1, .error = error, .mesh = mesh};
    dem_reader_rewind(&r);
    return r;
}

void dem_reader_rewind(dem_reader *r)
{
    r->line = 0;
    r->next = r->newline = r->at = r->stop = r->bytes;
    if (r->end - r->bytes >= 3 && memcmp(r->bytes, "\xef\xbb\xbf", 3) == 0)
        r->next = r->newline = r->at = r->stop = r->bytes + 3;
    if (r->newline < r->end && *r->newline != '\n') {
        const char *found = memchr(r->newline, '\n', (size_t)(r->end - r->newline));
        r->newline = found ? found : r->end;
    }
}

static void give_back(dem_mesh *mesh)
{
    dem_vec3 *vertices = realloc(mesh->vertices, mesh->vertex_count * sizeof *vertices);
    uint32_t *triangles = realloc(mesh->triangles, mesh->triangle_count * 3 * sizeof *triangles);
    if (vertices)
        mesh->vertices = vertices;
    if (triangles)
        mesh->triangles = triangles;
}

dem_status dem_reader_end(dem_reader *r, dem_status status)
{
    free(r->corners);
    dem_polygon_work_release(&r->work);
    if (status == DEM_OK && r->mesh->triangle_count == 0) {
        r->line = 0;
        if (r->mesh->vertex_count)
            status = dem_reader_fail(r,
                                     "%zu vertices but no faces: points alone enclose no volume; make a surface of "
                                     "them first, or export the mesh with its faces",
                                     r->mesh->vertex_count);
        else
            status = dem_reader_fail(r, "no vertices and no faces; export the mesh again");
    }
    if (status == DEM_OK)
        give_back(r->mesh);
    else
        dem_mesh_free(r->mesh);
    return status;
}

dem_status dem_reader_fail(const dem_reader *r, const char *format, ...)
{
    char text[sizeof((dem_error *)0)->text];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return dem_fail_at(r->error, DEM_BAD_INPUT, r->name, r->line, "%s", text);
}

bool dem_reader_line(dem_reader *r)
{
    if (r->next >= r->end)
        return false;
    r->at = r->next;
    r->line++;
    if (r->newline < r->at) {
        const char *found = memchr(r->at, '\n', (size_t)(r->end - r->at));
        r->newline = found ? found : r->end;
    }
    const char *cr = memchr(r->at, '\r', (size_t)(r->newline - r->at));
    r->stop = cr ? cr : r->newline;
    r->next = cr && cr + 1 < r->newline ? cr + 1 : r->newline < r->end ? r->newline + 1 : r->end;
    return true;
}

dem_word dem_reader_word(dem_reader *r)
{
    reader_skip_blanks(r);
    const char *begin = r->at;
    while (r->at < r->stop && !text_is_blank(*r->at))
        r->at++;
    return (dem_word){begin, (size_t)(r->at - begin)};
}

dem_word dem_reader_word_beyond(dem_reader *r)
{
    dem_word word;
    do
        word = dem_reader_word(r);
    while (word.length == 0 && dem_reader_line(r));
    return word;
}

bool dem_word_is(dem_word word, const char *text)
{
    return word.length == strlen(text) && strncasecmp(word.text, text, word.length) == 0;
}

dem_shown dem_word_show(dem_word word)
{
    dem_shown shown;
    size_t room = sizeof shown.text - 1, length = word.length < room ? word.length : room;
    for (size_t i = 0; i < length; i++)
        shown.text[i] = word.text[i] >= ' ' && word.text[i] <= '~' ? word.text[i] : '?';
    shown.text[length] = 0;
    if (word.length > room)
        memcpy(shown.text + room - 3, "...", 3);
    return shown;
}

dem_status dem_reader_unexpected(const dem_reader *r, dem_word word, const char *wanted)
{
    if (word.length == 0 && r->next < r->end)
        return dem_reader_fail(r, "the line ends where %s should stand; the file is damaged, export it again", wanted);
    if (word.length == 0)
        return dem_reader_fail(
            r, "unexpected end of file where %s should stand; the file is cut short, export it again", wanted);
    dem_shown shown = dem_word_show(word);
    if (word.text + word.length == r->end)
        return dem_reader_fail(
            r,
            "unexpected end of file after '%s', where %s should stand; the file is cut short, export "
            "it again",
            shown.text, wanted);
    return dem_reader_fail(r, "'%s' where %s should stand; the file is damaged, export it again", shown.text, wanted);
}

static dem_status no_number(dem_reader *r, const char *wanted)
{
    dem_word word = dem_reader_word(r);
    if (word.length && memchr(word.text, ',', word.length))
        return dem_reader_fail(r, "'%s' has a comma; write numbers with a decimal point, and blanks between them",
                               dem_word_show(word).text);
    return dem_reader_unexpected(r, word, wanted);
}

dem_status dem_reader_number(dem_reader *r, double *value)
{
    reader_skip_blanks(r);
    const char *p = dem_parse_double(r->at, r->stop, value);
    if (!p || (p < r->stop && !text_is_blank(*p) && !(*p == '\\' && p + 1 == r->stop)))
        return no_number(r, "a number");
    r->at = p;
    return DEM_OK;
}

dem_status dem_reader_whole(dem_reader *r, int64_t *value)
{
    reader_skip_blanks(r);
    long number;
    const char *p = dem_parse_long(r->at, r->stop, &number);
    if (!p || (p < r->stop && !text_is_blank(*p)))
        return no_number(r, "a whole number");
    r->at = p;
    *value = number;
    return DEM_OK;
}

dem_status dem_reader_point(dem_reader *r, dem_vec3 *point)
{
    DEM_TRY(dem_reader_number(r, &point->x));
    DEM_TRY(dem_reader_number(r, &point->y));
    return dem_reader_number(r, &point->z);
}

static dem_status go_on(const dem_reader *r)
{
    double done = (double)(r->at - r->bytes) / (double)(r->end - r->bytes);
    if (dem_progress(r->ctx, "reading", (r->pass + done) / r->passes))
        return dem_fail(r->error, DEM_INTERRUPTED, "interrupted while reading %s", r->name);
    return DEM_OK;
}

dem_status dem_reader_vertex(dem_reader *r, dem_vec3 p)
{
    dem_mesh *mesh = r->mesh;
    if (!point_is_usable(p))
        return dem_reader_fail(
            r, "vertex %zu is not finite (nan, inf or beyond 1e60); correct it or export the mesh again",
            mesh->vertex_count + 1);
    if (mesh->vertex_count == UINT32_MAX)
        return dem_reader_fail(r, "more than %" PRIu32 " vertices; reduce the mesh first", UINT32_MAX);
    if (!dem_grow(&mesh->vertices, &r->vertex_capacity, mesh->vertex_count, sizeof *mesh->vertices))
        return dem_fail_memory(r->error);
    mesh->vertices[mesh->vertex_count++] = p;
    return mesh->vertex_count % PROGRESS_EVERY ? DEM_OK : go_on(r);
}

dem_status dem_reader_corner(dem_reader *r, int64_t index, int64_t first)
{
    if (index < first || (uint64_t)(index - first) >= r->mesh->vertex_count)
        return dem_reader_fail(r,
                               "face %zu refers to vertex %" PRId64 " of %zu (counted from %d); the file is damaged "
                               "or cut short, export it again",
                               r->face_count + 1, index, r->mesh->vertex_count, (int)first);
    if (!dem_grow(&r->corners, &r->corner_capacity, r->corner_count, sizeof *r->corners))
        return dem_fail_memory(r->error);
    r->corners[r->corner_count++] = (uint32_t)(index - first);
    return DEM_OK;
}

// a corner named twice in a row, or at both ends, adds nothing to a polygon
static size_t without_repeats(uint32_t *corners, size_t count)
{
    size_t kept = 1, spare = count - 3;
    for (size_t i = 1; i < count; i++) {
        if (spare && (corners[i] == corners[kept - 1] || (i + 1 == count && corners[i] == corners[0])))
            spare--;
        else
            corners[kept++] = corners[i];
    }
    return kept;
}

dem_status dem_reader_face(dem_reader *r)
{
    dem_mesh *mesh = r->mesh;
    size_t count = r->corner_count;
    r->corner_count = 0;
    r->face_count++;
    if (count < 3)
        return dem_reader_fail(r, "face %zu has %zu corners, 3 are needed; remove it or export the mesh again",
                               r->face_count, count);
    if (count > 3)
        count = without_repeats(r->corners, count);
    size_t used = 3 * mesh->triangle_count, wanted = used + 3 * (count - 2);
    while (r->index_capacity < wanted)
        if (!dem_grow(&mesh->triangles, &r->index_capacity, r->index_capacity, sizeof *mesh->triangles))
            return dem_fail_memory(r->error);
    dem_status status = dem_polygon_split(&r->work, mesh->vertices, r->corners, count, mesh->triangles + used);
    if (status == DEM_BAD_INPUT)
        return dem_reader_fail(r,
                               "face %zu is concave and has %zu corners, at most %d can be cut into triangles; "
                               "triangulate the mesh before export",
                               r->face_count, count, DEM_POLYGON_MOST_CORNERS);
    if (status != DEM_OK)
        return dem_fail_memory(r->error);
    mesh->triangle_count += count - 2;
    bool rest = used / 3 / PROGRESS_EVERY == mesh->triangle_count / PROGRESS_EVERY;
    return rest ? DEM_OK : go_on(r);
}
