/// Reference curves that may lie beside the project as CSV; tests that need them are skipped where they do not.
#ifndef DEM_TESTS_REFERENCE_H
#define DEM_TESTS_REFERENCE_H

#include "check.h"

#define REFERENCE(name) SHARED_DATA(name ".csv")

enum { REFERENCE_ROWS = 64, REFERENCE_COLUMNS = 10 };

typedef struct reference {
    int rows, columns;
    double at[REFERENCE_ROWS][REFERENCE_COLUMNS];
} reference;

/// The rows of numbers; where `series` is given, of the lines that begin with it, without it.
static inline reference reference_read(const char *path, const char *series)
{
    reference r = {0};
    FILE *f = fopen(path, "r");
    check(f);
    char line[512];
    while (fgets(line, sizeof line, f)) {
        char *s = line;
        size_t skipped = series ? strlen(series) : 0;
        if (line[0] == '#' || (series && (strncmp(line, series, skipped) != 0 || line[skipped] != ',')))
            continue;
        s += series ? skipped + 1 : 0;
        int columns = 0;
        for (char *end; columns < REFERENCE_COLUMNS; columns++, s = end + 1) {
            double value = strtod(s, &end);
            if (end == s)
                break;
            check(r.rows < REFERENCE_ROWS);
            r.at[r.rows][columns] = value;
            if (*end != ',') {
                columns++;
                break;
            }
        }
        r.rows += columns > 0;
        r.columns = columns > r.columns ? columns : r.columns;
    }
    fclose(f);
    check(r.rows > 0);
    return r;
}

#endif
