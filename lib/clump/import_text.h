/// What the readers of clump texts share: lines without comments, rows of numbers, and the remarks that exporters of
/// ours leave in comments.
#ifndef DEM_CLUMP_IMPORT_TEXT_H
#define DEM_CLUMP_IMPORT_TEXT_H

#include "clump/import.h"
#include "mesh/reader.h"

/// A text being walked through by the words of `r`. Stays where it is.
typedef struct dem_import_text {
    dem_reader r;
    dem_mesh none;  // the reader wants one
    char *copy;
} dem_import_text;

/// Comments (from `comment`, "#" or "//", to the end of the line) and the characters of `separators` become blanks.
dem_status dem_import_text_begin(dem_import_text *t, const dem_import *import, const char *text, size_t size,
                                 const char *comment, const char *separators, dem_error *error);
void dem_import_text_end(dem_import_text *t);

/// Goes to the next line that holds something; false at the end.
bool dem_import_text_line(dem_import_text *t);
/// True where the line goes on; a "&" at its end goes to the next one.
bool dem_import_text_more(dem_import_text *t);
/// The next number, finite.
dem_status dem_import_text_number(dem_import_text *t, double *value);
/// `count` numbers, on this line or on following ones.
dem_status dem_import_text_numbers(dem_import_text *t, int count, double *values);

/// Spheres to the end of the text, one x y z r a line; `types`: with a fifth column that is passed over.
dem_status dem_import_text_rows(dem_import_text *t, dem_import *import, bool types);

/// Name, density, mass, inertia and frame where comments of ours tell them.
dem_status dem_import_remarks(dem_import *import, const char *text, size_t size, dem_error *error);

/// For recognising: the first word that is no comment; a text that is found anywhere, in any case, but not in comments
/// (`comment` NULL: there are none).
dem_word dem_import_first_word(const char *text, size_t size);
bool dem_import_holds(const char *text, size_t size, const char *wanted, const char *comment);

#endif
