#include "base/nearest.h"

#include <string.h>

enum { LONGEST = 48 };

// edits (insert, delete, replace, swap neighbours) that turn a into b, for short names (Damerau 1964)
static size_t edits(const char *a, const char *b)
{
    size_t rows[3][LONGEST + 1], m = strlen(a), n = strlen(b);
    if (m > LONGEST || n > LONGEST)
        return LONGEST;
    size_t *before = rows[0], *last = rows[1], *now = rows[2];
    for (size_t j = 0; j <= n; j++)
        last[j] = j;
    for (size_t i = 1; i <= m; i++) {
        now[0] = i;
        for (size_t j = 1; j <= n; j++) {
            size_t best = last[j - 1] + (a[i - 1] != b[j - 1]);
            best = last[j] + 1 < best ? last[j] + 1 : best;
            best = now[j - 1] + 1 < best ? now[j - 1] + 1 : best;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && before[j - 2] + 1 < best)
                best = before[j - 2] + 1;
            now[j] = best;
        }
        size_t *spare = before;
        before = last;
        last = now;
        now = spare;
    }
    return last[n];
}

const char *dem_nearest(const char *typed, const char *(*next)(const void *user, size_t index), const void *user)
{
    const char *best = NULL, *name;
    size_t length = strlen(typed);
    if (length > LONGEST)
        return NULL;
    size_t nearest = 2 * (length / 3 + 2);  // in half edits
    for (size_t i = 0; (name = next(user, i)); i++) {
        // what was typed may also be a name cut short, or one with a tail: farther than one edit, nearer than two
        size_t shorter = strlen(name) < length ? strlen(name) : length, far = 2 * edits(typed, name);
        if (shorter >= 3 && strncmp(name, typed, shorter) == 0 && far > 3)
            far = 3;
        if (far < nearest && far < 2 * length) {
            nearest = far;
            best = name;
        }
    }
    return best;
}
