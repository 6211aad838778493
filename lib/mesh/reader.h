/// What the mesh readers share: walking through text by line and word, refusing with the place, collecting
/// vertices and faces.
#ifndef DEM_MESH_READER_H
#define DEM_MESH_READER_H

#include "base/text.h"
#include "dem/mesh.h"
#include "mesh/polygon.h"

/// One file being read. Text readers use `at`, `stop` and `line`; binary ones `at` and `end`, with line 0.
typedef struct dem_reader {
    const dem_ctx *ctx;
    const char *name;            ///< of the file, for messages
    const char *bytes, *end;     ///< the whole file
    const char *at, *stop;       ///< what is left of the current line
    const char *next, *newline;  ///< the next line; the first '\n' not before `at`
    long line;                   ///< 1-based
    int pass, passes;            ///< how often the file is walked through, for progress
    dem_error *error;
    dem_mesh *mesh;
    size_t vertex_capacity, index_capacity;
    uint32_t *corners;  ///< of the face being collected
    size_t corner_count, corner_capacity;
    size_t face_count;
    dem_polygon_work work;
} dem_reader;

typedef struct dem_word {
    const char *text;
    size_t length;
} dem_word;

/// A UTF-8 byte order mark is passed over.
dem_reader dem_reader_begin(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                            dem_error *error);
/// Releases the work space. On success gives spare memory back and refuses a mesh without triangles; on failure
/// frees the mesh. Returns the status.
dem_status dem_reader_end(dem_reader *r, dem_status status);
/// Back to the first line.
void dem_reader_rewind(dem_reader *r);

/// Fails with DEM_BAD_INPUT at the current line.
dem_status dem_reader_fail(const dem_reader *r, const char *format, ...) DEM_PRINTF(2, 3);

/// Goes to the next line; false at the end of the file. Lines end in LF, CR LF or CR.
bool dem_reader_line(dem_reader *r);
/// The next word of the line; length 0 at its end.
dem_word dem_reader_word(dem_reader *r);
/// The next word of the file, on whatever line.
dem_word dem_reader_word_beyond(dem_reader *r);
/// True where `word` is `text`, letters in any case.
bool dem_word_is(dem_word word, const char *text);
/// A word as it can be shown in a message: short and printable.
typedef struct dem_shown {
    char text[28];
} dem_shown;
dem_shown dem_word_show(dem_word word);

/// The next number of the line.
dem_status dem_reader_number(dem_reader *r, double *value);
dem_status dem_reader_whole(dem_reader *r, int64_t *value);
dem_status dem_reader_point(dem_reader *r, dem_vec3 *point);
/// Fails over the word just read, where something else was wanted.
dem_status dem_reader_unexpected(const dem_reader *r, dem_word word, const char *wanted);

/// Adds a vertex; refuses what is not finite.
dem_status dem_reader_vertex(dem_reader *r, dem_vec3 p);
/// Adds a corner to the face being collected. `index` counts as the file does, from `first`.
dem_status dem_reader_corner(dem_reader *r, int64_t index, int64_t first);
/// Ends the face: cuts it into triangles and adds them.
dem_status dem_reader_face(dem_reader *r);

/// Finite, and small enough for its fifth power (moments of inertia) to be so.
static inline bool point_is_usable(dem_vec3 p)
{
    return fabs(p.x) <= 1e60 && fabs(p.y) <= 1e60 && fabs(p.z) <= 1e60;
}

static inline bool text_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

static inline void reader_skip_blanks(dem_reader *r)
{
    while (r->at < r->stop && text_is_blank(*r->at))
        r->at++;
}

#endif
