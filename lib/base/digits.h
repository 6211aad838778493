/// Decimal digits of numbers of ordinary size, exactly rounded, several times faster than printf.
#ifndef DEM_BASE_DIGITS_H
#define DEM_BASE_DIGITS_H

#include <stdbool.h>
#include <stddef.h>

enum { DEM_DIGITS_TEXT = 32 };  // room that any number needs

/// Writes what printf("%.*g") would in the C locale. False: not a number of this kind (nothing is written): zero, too
/// large or too small for whole 192-bit arithmetic, not finite, `digits` outside of 1..17, or less than DEM_DIGITS_TEXT
/// of room.
bool dem_digits_print(char *text, size_t size, double value, int digits);

#endif
