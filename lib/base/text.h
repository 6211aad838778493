/// Text: numbers read and written the same in every locale, and a growing buffer.
#ifndef DEM_BASE_TEXT_H
#define DEM_BASE_TEXT_H

#include "base/status.h"

/// Reads a decimal number (sign, digits, point, exponent, "nan", "inf") at `text`, not past `end`.
/// Correctly rounded, independent of the locale. Returns the first character behind it, or NULL where none
/// starts. Overflow gives an infinity, so callers check isfinite.
const char *dem_parse_double(const char *text, const char *end, double *value);

/// Reads a signed whole number; NULL where none starts or it does not fit.
const char *dem_parse_long(const char *text, const char *end, long *value);

/// Text or bytes built up piece by piece; zero-initialise. After a failed append `failed` is set.
typedef struct dem_buffer {
    char *data;  ///< always ends in a 0 behind `size` once something was appended
    size_t size, capacity;
    bool failed;
} dem_buffer;

void dem_buffer_bytes(dem_buffer *buffer, const void *bytes, size_t size);
void dem_buffer_text(dem_buffer *buffer, const char *text);
/// printf for everything but floating-point numbers, which follow the locale there.
void dem_buffer_print(dem_buffer *buffer, const char *format, ...) DEM_PRINTF(2, 3);
/// `digits` significant digits (17: read back without loss), point as decimal mark.
void dem_buffer_number(dem_buffer *buffer, double value, int digits);
/// As few digits, from 15 on, as are read back without loss; "nan" without a sign.
void dem_buffer_shortest(dem_buffer *buffer, double value);
void dem_buffer_release(dem_buffer *buffer);

/// Writes a number as dem_buffer_number does; returns `text`.
char *dem_format_double(char *text, size_t size, double value, int digits);

#endif
