/// Names as they can stand in file names and in the heads of columns.
#ifndef DEM_OUT_NAMES_H
#define DEM_OUT_NAMES_H

#include <stddef.h>

typedef struct dem_plain_name {
    char text[72];
} dem_plain_name;

/// Letters, digits, '-', '.' and '_' of a name, '_' for everything else; `instead` where nothing is left. A number is
/// added where one of the `count` names given before is the same but for upper and lower case.
dem_plain_name dem_name_plain(const char *name, const char *instead, const dem_plain_name *before, size_t count);

#endif
