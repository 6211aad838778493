/// JSON as people write it: comments and trailing commas, and where in the text a value stands.
#ifndef DEM_BASE_JSON_TEXT_H
#define DEM_BASE_JSON_TEXT_H

#include "base/text.h"

/// Overwrites `//` and `/* */` comments, commas before a closing bracket and a byte order mark with spaces, so that
/// plain JSON remains and everything keeps its line and offset.
void dem_json_blank(char *text, size_t size);

/// The way from the outermost value to one inside: each step is a key of an object, or an item of an array.
typedef struct dem_json_place {
    const struct dem_json_place *in;  ///< of the object or array; NULL: this is the outermost value
    const char *key;                  ///< NULL: an item
    size_t index;
} dem_json_place;

typedef enum dem_json_part { DEM_JSON_VALUE, DEM_JSON_KEY } dem_json_part;

/// Line and column, from 1, of a value or of its key; columns are counted in characters. The text is one that could be
/// parsed, with or without its comments. False: it has no such value.
bool dem_json_locate(const char *text, size_t size, const dem_json_place *place, dem_json_part part, long *line,
                     long *column);

#endif
