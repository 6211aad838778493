#include "out/names.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { LENGTH = 48 };  // of a name, without the number

static bool is_plain(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '+' ||
           c == '.' || c == '_';
}

static bool is_taken(const char *name, const dem_plain_name *before, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcasecmp(name, before[i].text) == 0)
            return true;
    return false;
}

dem_plain_name dem_name_plain(const char *name, const char *instead, const dem_plain_name *before, size_t count)
{
    char base[LENGTH + 1];
    dem_plain_name plain;
    snprintf(base, sizeof base, "%s", name && *name ? name : instead);
    for (char *p = base; *p; p++)
        if (!is_plain(*p) || (p == base && (*p == '.' || *p == '-')))  // neither a hidden file nor an option
            *p = '_';
    snprintf(plain.text, sizeof plain.text, "%s", base);
    for (unsigned long n = 2; is_taken(plain.text, before, count); n++)
        snprintf(plain.text, sizeof plain.text, "%s-%lu", base, n);
    return plain;
}
