/// For the tests of the mesh readers: meshes read from memory, what they say, and a cube to compare with.
#ifndef DEM_TESTS_READ_CHECK_H
#define DEM_TESTS_READ_CHECK_H

#include "check.h"

#include "base/text.h"
#include "mesh/read.h"

/// What the library told its caller.
typedef struct heard {
    int warnings;
    char last[1024];
} heard;

static inline void hear(void *user, dem_log_level level, const char *subject, const char *text)
{
    heard *all = user;
    check(subject != NULL);
    all->warnings += level == DEM_LOG_WARNING;
    snprintf(all->last, sizeof all->last, "%s", text);
}

/// Reads from a block of exactly `size` bytes, so that a sanitizer sees every step beyond it.
static inline dem_status parse(const char *name, const char *bytes, size_t size, heard *all, dem_mesh *mesh,
                               dem_error *error)
{
    dem_ctx ctx = {.log = hear, .user = all};
    dem_buffer buffer = {.data = malloc(size + !size), .size = size, .capacity = size};
    assert_non_null(buffer.data);
    memcpy(buffer.data, bytes, size);
    *all = (heard){0};
    *error = (dem_error){0};
    memset(mesh, 0xab, sizeof *mesh);
    dem_mesh_format format = dem_mesh_sniff(name, buffer.data, buffer.size);
    if (format != DEM_FORMAT_UNKNOWN)
        return dem_mesh_read_bytes(&ctx, name, format, &buffer, mesh, error);
    *mesh = (dem_mesh){0};
    dem_status status = dem_mesh_refuse(name, buffer.data, buffer.size, "STL, OBJ, PLY, OFF", error);
    dem_buffer_release(&buffer);
    return status;
}

/// The unit cube, maybe with more vertices than it needs, with `warnings` lines of warning.
static inline void check_cube_(const char *name, const char *bytes, size_t size, int warnings, const char *file,
                               int line)
{
    dem_mesh mesh;
    dem_error error;
    heard all;
    if (parse(name, bytes, size, &all, &mesh, &error) != DEM_OK) {
        print_error("%s:%ld: %s\n", error.file, error.line, error.text);
        _fail(file, line);
    }
    if (all.warnings != warnings)
        print_error("%d warnings, the last: %s\n", all.warnings, all.last);
    _assert_int_equal((uintmax_t)all.warnings, (uintmax_t)warnings, file, line);
    _assert_int_equal(mesh.triangle_count, 12, file, line);
    dem_solid solid = dem_mesh_solid(&mesh);
    check_near_(solid.volume, 1, 1e-12, "volume", file, line);
    check_vec_(solid.centre, (dem_vec3){0.5, 0.5, 0.5}, 1e-12, "centre", file, line);
    check_near_(solid.area, 6, 1e-12, "area", file, line);
    dem_mesh_free(&mesh);
}
#define check_cube(name, bytes, size, warnings) check_cube_((name), (bytes), (size), (warnings), __FILE__, __LINE__)
#define check_cube_text(name, text) check_cube_((name), (text), strlen(text), 0, __FILE__, __LINE__)

/// DEM_BAD_INPUT at `at_line` of the file, with `words` in a text that also says what to do; nothing is left behind.
static inline void check_refused_(const char *name, const char *bytes, size_t size, long at_line, const char *words,
                                  const char *file, int line)
{
    dem_mesh mesh;
    dem_error error;
    heard all;
    dem_status status = parse(name, bytes, size, &all, &mesh, &error);
    if (status != DEM_BAD_INPUT || error.code != DEM_BAD_INPUT || error.line != at_line ||
        strcmp(error.file, name) != 0 || !strstr(error.text, words) || !strchr(error.text, ';') ||
        strchr(error.text, '\n')) {
        print_error("status %d: %s:%ld: %s\nwant line %ld: %s\n", status, error.file, error.line, error.text, at_line,
                    words);
        _fail(file, line);
    }
    check_true_(!mesh.vertices && !mesh.triangles && !mesh.vertex_count, "an empty mesh", file, line);
}
#define check_refused(name, bytes, size, at_line, words)                                                               \
    check_refused_((name), (bytes), (size), (at_line), (words), __FILE__, __LINE__)
#define check_refused_text(name, text, at_line, words)                                                                 \
    check_refused_((name), (text), strlen(text), (at_line), (words), __FILE__, __LINE__)

/// The text with every `from` replaced, to be freed.
static inline char *replaced(const char *text, const char *from, const char *to)
{
    dem_buffer out = {0};
    for (const char *found; (found = strstr(text, from)); text = found + strlen(from)) {
        dem_buffer_bytes(&out, text, (size_t)(found - text));
        dem_buffer_text(&out, to);
    }
    dem_buffer_text(&out, text);
    assert_false(out.failed);
    return out.data;
}

#define CUBE_VERTICES "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
#define CUBE_FACES "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
#define CUBE_OBJ CUBE_VERTICES CUBE_FACES

static const dem_vec3 cube_corners[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                         {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const int cube_sides[6][4] = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                     {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
static const int quad_halves[2][3] = {{0, 1, 2}, {0, 2, 3}};

#endif
