// Plain lines x y z r, as CLUMP, ours and many scripts write them. What exporters of ours say in comments is kept.
#include <string.h>

#include "clump/import_text.h"

static bool recognise_xyzr(const char *text, size_t size)
{
    dem_word word = dem_import_first_word(text, size);
    double number;
    const char *end = word.text + word.length, *stop = dem_parse_double(word.text, end, &number);
    return stop && (stop == end || strchr(",;", *stop));
}

static dem_status read_xyzr(dem_import *import, const char *text, size_t size, dem_error *error)
{
    dem_import_text t;
    DEM_TRY(dem_import_remarks(import, text, size, error));
    DEM_TRY(dem_import_text_begin(&t, import, text, size, "#", ",;", error));
    dem_status status = dem_import_text_rows(&t, import, false);
    dem_import_text_end(&t);
    return status;
}

extern const dem_importer dem_import_xyzr;
const dem_importer dem_import_xyzr = {
    .name = "xyzr",
    .suffixes = "xyzr txt",
    .about = "lines x y z r, separated by blanks, commas or semicolons, with # comments",
    .recognise = recognise_xyzr,
    .read = read_xyzr,
};
