/// SHA-256 by nettle.
#ifndef DEM_BASE_HASH_H
#define DEM_BASE_HASH_H

#include <stddef.h>

/// Writes 64 hexadecimal digits and a 0.
void dem_sha256(const void *bytes, size_t size, char text[65]);

#endif
