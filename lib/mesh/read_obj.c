#include "mesh/read.h"

#include <string.h>

#include "mesh/reader.h"

typedef struct obj_counts {
    size_t curves;     // free-form, lines and points: ignored
    size_t strangers;  // lines of no known keyword
    long first_stranger;
    dem_shown stranger;
} obj_counts;

// of names the rest of the line is free text
static const char *const names[] = {"o", "g", "usemtl", "mtllib", "usemap", "maplib", "shadow_obj", "trace_obj"};
static const char *const curves[] = {"p", "l", "curv", "curv2", "surf", "bzp", "bsp", "cdc", "cdp", "res"};
static const char *const ignored[] = {
    "vn",   "vt",   "v",  "f",   "s",   "vp",    "mg",       "cstype",   "deg", "bmat",  "step",  "parm", "trim",
    "hole", "scrv", "sp", "end", "con", "bevel", "c_interp", "d_interp", "lod", "ctech", "stech", "call", "csh"};

static bool is_one_of(dem_word word, const char *const *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strlen(list[i]) == word.length && memcmp(list[i], word.text, word.length) == 0)
            return true;
    return false;
}
#define IS_ONE_OF(word, list) is_one_of((word), (list), sizeof(list) / sizeof *(list))

// goes on to the next line where this one ends in a backslash; true where something is left on it
static bool anything_left(dem_reader *r)
{
    reader_skip_blanks(r);
    while (r->at < r->stop && *r->at == '\\' && r->at + 1 == r->stop) {
        if (!dem_reader_line(r))
            return false;
        reader_skip_blanks(r);
    }
    return r->at < r->stop && *r->at != '#';
}

static void skip_continued(dem_reader *r)
{
    while (r->stop > r->at && r->stop[-1] == '\\')
        if (!dem_reader_line(r))
            return;
}

// the rest of a "v" line: further numbers are a weight or a colour
static dem_status read_vertex(dem_reader *r)
{
    double xyz[3];
    for (int k = 0; k < 3; k++) {
        anything_left(r);
        DEM_TRY(dem_reader_number(r, &xyz[k]));
    }
    skip_continued(r);
    return dem_reader_vertex(r, (dem_vec3){xyz[0], xyz[1], xyz[2]});
}

// one corner, "5", "5/2", "5//3" or "5/2/3"; negative numbers count back from the last vertex so far
static dem_status read_corner(dem_reader *r, size_t so_far)
{
    const char *begin = r->at;
    long index, other;
    const char *p = dem_parse_long(r->at, r->stop, &index);
    for (int k = 0; p && k < 2 && p < r->stop && *p == '/'; k++) {
        const char *behind = dem_parse_long(p + 1, r->stop, &other);
        p = behind ? behind : p + 1;
    }
    if (!p || (p < r->stop && !text_is_blank(*p) && *p != '\\')) {
        dem_word word = dem_reader_word(r);
        bool comma = memchr(word.text, ',', word.length);
        return dem_reader_fail(r, "'%s' is no corner of a face (5, 5/2, 5//3 or 5/2/3)%s", dem_word_show(word).text,
                               comma ? "; put blanks instead of commas" : "; export the mesh again");
    }
    r->at = p;
    if (index == 0)
        return dem_reader_fail(r,
                               "face %zu refers to vertex 0, but OBJ counts from 1; add 1 to all, or export the mesh "
                               "again",
                               r->face_count + 1);
    if (index < 0 && (size_t)-index > so_far)
        return dem_reader_fail(r,
                               "face %zu refers to vertex %.*s, counted back from the last, but only %zu came before; "
                               "export the mesh again",
                               r->face_count + 1, (int)(p - begin), begin, so_far);
    return dem_reader_corner(r, index < 0 ? (int64_t)so_far + index + 1 : index, 1);
}

static dem_status read_face(dem_reader *r, size_t so_far)
{
    while (anything_left(r))
        DEM_TRY(read_corner(r, so_far));
    return dem_reader_face(r);
}

// a line that holds neither vertex nor face
static void pass_over(dem_reader *r, dem_word word, obj_counts *counts)
{
    if (IS_ONE_OF(word, ignored)) {
        skip_continued(r);
    } else if (IS_ONE_OF(word, curves)) {
        counts->curves++;
        skip_continued(r);
    } else if (!IS_ONE_OF(word, names) && counts->strangers++ == 0) {  // names never continue: paths end in a backslash
        counts->first_stranger = r->line;
        counts->stranger = dem_word_show(word);
    }
}

static dem_status read_lines(dem_reader *r, obj_counts *counts)
{
    size_t so_far = 0;
    dem_reader_rewind(r);
    while (dem_reader_line(r)) {
        reader_skip_blanks(r);
        if (r->at == r->stop || *r->at == '#')
            continue;
        dem_word word = dem_reader_word(r);
        bool vertex = word.length == 1 && *word.text == 'v';
        bool face = word.length == 1 && *word.text == 'f';
        so_far += vertex;
        if (vertex && r->pass == 0)
            DEM_TRY(read_vertex(r));
        else if (face && r->pass == 1)
            DEM_TRY(read_face(r, so_far));
        else
            pass_over(r, word, counts);
    }
    return DEM_OK;
}

dem_status dem_read_obj(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                        dem_error *error)
{
    dem_reader r = dem_reader_begin(ctx, name, bytes, size, mesh, error);
    r.passes = 2;
    obj_counts counts = {0};
    dem_status status = read_lines(&r, &counts);  // vertices
    r.pass = 1;
    counts = (obj_counts){0};
    if (status == DEM_OK)
        status = read_lines(&r, &counts);  // faces: they may refer to vertices behind them
    if (status == DEM_OK && counts.curves)
        dem_log(ctx, DEM_LOG_WARNING, "%zu lines, points or free-form curves and surfaces are ignored", counts.curves);
    if (status == DEM_OK && counts.strangers)
        dem_log(ctx, DEM_LOG_WARNING, "line %ld starts with '%s', which OBJ does not know; %zu such lines are ignored",
                counts.first_stranger, counts.stranger.text, counts.strangers);
    return dem_reader_end(&r, status);
}
