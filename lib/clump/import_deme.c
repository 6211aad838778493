// A table with a line of column names, x,y,z,r in any order: Chrono DEM-Engine and most scripts that write CSV.
#include <string.h>

#include "clump/import_text.h"

enum { COLUMNS = 64 };

// 0 to 3 for x y z r, 4 for another one
static int column_of(dem_word word)
{
    static const char *const names[] = {"x", "y", "z", "r"};
    if (word.length >= 2 && *word.text == '"' && word.text[word.length - 1] == '"')
        word = (dem_word){word.text + 1, word.length - 2};
    for (int i = 0; i < 4; i++)
        if (dem_word_is(word, names[i]))
            return i;
    return dem_word_is(word, "radius") ? 3 : 4;
}

static bool recognise_deme(const char *text, size_t size)
{
    dem_word word = dem_import_first_word(text, size);
    const char *end = word.text;
    while (end < text + size && *end != '\n' && *end != '\r')
        end++;
    int seen = 0;
    for (const char *p = word.text; p < end;) {
        const char *begin = p;
        while (p < end && !text_is_blank(*p) && !strchr(",;", *p))
            p++;
        seen |= p > begin ? 1 << column_of((dem_word){begin, (size_t)(p - begin)}) : 0;
        p++;
    }
    return (seen & 15) == 15;
}

static dem_status read_header(dem_import_text *t, int *order, int *count)
{
    int seen = 0;
    if (!dem_import_text_line(t))
        return dem_reader_fail(&t->r, "has no line of column names; begin with x,y,z,r");
    for (*count = 0; dem_import_text_more(t); ++*count) {
        dem_word word = dem_reader_word(&t->r);
        if (*count == COLUMNS)
            return dem_reader_fail(&t->r, "more than %d columns; only x,y,z,r are wanted, remove the rest", COLUMNS);
        int column = order[*count] = column_of(word);
        if (column < 4 && seen & 1 << column)
            return dem_reader_fail(&t->r, "column '%s' stands twice; remove one", dem_word_show(word).text);
        seen |= 1 << column;
    }
    for (int i = 0; i < 4; i++)
        if (!(seen & 1 << i))
            return dem_reader_fail(&t->r, "the line of column names has no '%c'; begin with x,y,z,r", "xyzr"[i]);
    return DEM_OK;
}

static dem_status read_rows(dem_import_text *t, dem_import *import, dem_error *error)
{
    int order[COLUMNS], count = 0;
    DEM_TRY(read_header(t, order, &count));
    while (dem_import_text_line(t)) {
        double v[5] = {0};
        for (int i = 0; i < count; i++) {
            if (order[i] < 4)
                DEM_TRY(dem_import_text_number(t, &v[order[i]]));
            else if (dem_reader_word(&t->r).length == 0)
                return dem_reader_fail(&t->r, "the line has %d of %d columns; complete it", i, count);
        }
        if (dem_import_text_more(t))
            return dem_reader_fail(&t->r, "the line has more columns than the first one; remove the rest");
        DEM_TRY(dem_import_ball(import, t->r.line, (dem_ball){{v[0], v[1], v[2]}, v[3]}, error));
    }
    return DEM_OK;
}

static dem_status read_deme(dem_import *import, const char *text, size_t size, dem_error *error)
{
    dem_import_text t;
    DEM_TRY(dem_import_remarks(import, text, size, error));
    DEM_TRY(dem_import_text_begin(&t, import, text, size, "#", ",;", error));
    dem_status status = read_rows(&t, import, error);
    dem_import_text_end(&t);
    return status;
}

extern const dem_importer dem_import_deme;
const dem_importer dem_import_deme = {
    .name = "deme",
    .suffixes = "csv",
    .about = "table with a line of names x,y,z,r: Chrono DEM-Engine and others",
    .recognise = recognise_deme,
    .read = read_deme,
};
